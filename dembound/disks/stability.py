"""The largest stable time step, from the largest eigenfrequency of the scene."""

import numpy as np

from dembound.disks.scene import DiskScene
from dembound.errors import CaseError, RunError
from dembound.kernels.contacts import CLOSING
from dembound.kernels.elastic import contact_forces
from dembound.kernels.lanczos import next_vector, work
from dembound.motion.layout import aligned_zeros
from dembound.motion.threads import threads_for

TOLERANCE = 1e-3
"""Relative residual at which the iteration for the eigenvalue ends.

The residual is added to the eigenvalue, so the step is too small by at most 0.05 %. Lattices need it, as their largest
eigenvalues are close to each other.
"""

LEAST, MOST = 40, 1000
"""Smallest and largest number of iterations.

With a random start, the eigenvalue found after k iterations for d components of motion is below 1 − ε of the largest
one with a probability of at most 1.648 √d exp(−(2k − 1)√ε) (Kuczyński & Woźniakowski 1992, SIAM J. Matrix Anal. Appl.
13(4), 1094–1122), whatever the matrix. A step of 0.9 of the limit found is unstable at ε = 1 − 0.9² = 0.19: after 40
iterations with a probability below 2e-11 for ten million particles, d = 3e7.
"""

INVARIANT = 1e-12
"""Size of the next vector, over the eigenvalue, below which it only has rounding errors: all eigenvalues are found."""

OPENING = 0.75 / CLOSING
"""Largest ω² over 4/Δt² where contacts open and close: sin²(π/3), for first pushes multiplied by CLOSING.

A contact that opens and closes creates overtones of every motion. At ωΔt = 2 sin(π/3) a motion has three steps per
period, and its overtone, sampled at whole steps, equals the motion running backwards. They amplify each other, and
energy grows by orders of magnitude within a thousand steps. Below this limit the loss at closing
(`kernels.contacts.CLOSING`) exceeds the gain.
"""


def step_limit(scene: DiskScene, damp: float | None = None) -> float:
    """Largest stable step 2/(ω_max √(1 + damp)) of central differences (s).

    damp is the local damping coefficient, None: the material's. At the limit, forces are opposite to velocities at
    every step, so local damping multiplies them by 1 + damp.

    ω_max² is the largest eigenvalue of M⁻¹K of the assembled scene with held and prescribed components taken out;
    centred dashpots do not change it. Under a history-dependent law the limit also holds for loose disks, and ω_max² is
    multiplied by 1.4 where contacts may open (`OPENING`).

    Raises RunError when the iteration for the eigenvalue does not converge.
    """
    largest = _largest_eigenvalue(scene)
    if scene.has_history:
        opens = scene.ground.moduli.emod > 0.0
        largest = max(largest, _loose_eigenvalue(scene)) / (OPENING if opens else 1.0)
    damp = scene.case.material.damp if damp is None else damp
    return float(2.0 / np.sqrt(largest * (1.0 + damp))) if largest > 0.0 else np.inf


def _largest_eigenvalue(scene: DiskScene) -> float:
    """The largest eigenvalue of M⁻¹K (1/s²), too large by at most `TOLERANCE`.

    Lanczos iteration with three vectors, 88 bytes a slot in all, without orthogonalising again: vectors only lose their
    orthogonality once an eigenvalue has converged, which gives copies of it but none that are too large (Paige 1980,
    Linear Algebra Appl. 34, 235–258). The vectors are not scaled to unit size, which would take another pass; their
    sizes go into the factors of the next step. The start is random but fixed: the result is the same in every run.

    An eigenvalue lies within the residual of the one found. That this is the largest one is not certain, but very
    likely (`LEAST`).
    """
    u, size = _start(scene)
    before, force = aligned_zeros(*u.shape), aligned_zeros(*u.shape)
    mass, inertia = scene.layout.spread(scene.mass), scene.layout.spread(scene.inertia)
    diagonal: list[float] = []
    beside: list[float] = []  # the diagonal
    size_before = 1.0
    with threads_for(scene.count):
        while size > 0.0 and len(diagonal) < MOST:
            fill_forces(scene, u, force)
            diagonal.append(-work(u, force) / size**2)
            factors = -1.0 / size, diagonal[-1] / size, size / size_before
            size_before = size
            size = float(np.sqrt(next_vector(u, before, force, mass, inertia, scene.free, *factors)))
            u, before = before, u
            is_last = size <= INVARIANT * max(diagonal)
            if is_last or len(diagonal) >= LEAST:
                value, residual = _largest_of(diagonal, beside, size)
                if is_last or residual <= TOLERANCE * value:
                    return value + residual
            beside.append(size)
    if diagonal:
        raise RunError(f"the stability limit was not found in {MOST} iterations")
    return 0.0


def _start(scene: DiskScene) -> tuple[np.ndarray, float]:
    """Random displacements (3, slots) m and their size √⟨u, u⟩, zero for components that cannot move.

    Times the root of the mass, all directions are equally likely. They are drawn particle by particle.
    """
    start = np.random.default_rng(0).standard_normal((3, scene.count))
    start *= scene.free[:, None]
    fixed = scene.supports.prescribed
    start[scene.supports.component[fixed], scene.supports.node[fixed]] = 0.0
    size = float(np.sqrt(sum(np.sum(row * row) for row in start)))
    start[:2] /= np.sqrt(scene.mass)
    start[2] /= np.sqrt(scene.inertia)
    return scene.layout.spread(start), size


def fill_forces(scene: DiskScene, u: np.ndarray, force: np.ndarray) -> None:
    """Fill force (3, slots) with the forces at displacements u: of contacts, of supports, none where prescribed."""
    for rows in scene.rows:
        contact_forces(u, rows, force)
    supports = scene.supports
    place = supports.component, scene.layout.slot[supports.node]
    force[place] = np.where(supports.prescribed, 0.0, force[place] - supports.stiffness * u[place])


def _largest_of(diagonal: list[float], beside: list[float], size: float) -> tuple[float, float]:
    """Largest eigenvalue of a symmetric tridiagonal matrix (k diagonal, k − 1 entries beside it), and its residual.

    size : that of the vector after the last one, by whose share in the eigenvector the residual is found.
    """
    from scipy.linalg import eigh_tridiagonal

    last = len(diagonal) - 1
    value, vector = eigh_tridiagonal(diagonal, beside, select="i", select_range=(last, last))
    return float(value[0]), size * abs(float(vector[last, 0]))


def _loose_eigenvalue(scene: DiskScene) -> float:
    """Bound of ω² (1/s²) for the smallest disks, each rolling on six neighbours, as in broken or loose ground.

    Only contacts, no bonds. On the hexagonal lattice the normal springs give at most 6k_n/m, and the tangential ones
    24k_s/m, when all disks rotate in the same way; the sum is a bound for both together.
    """
    moduli = scene.ground.moduli
    shear = moduli.emod / moduli.kratio if moduli.fric > 0.0 else 0.0
    return (6.0 * moduli.emod + 24.0 * shear) / float(scene.ground.mass.min())


def _rounded_down(step: float) -> float:
    """The step cut to four digits: the last bits of an eigenvalue depend on the machine's instructions."""
    unit = 10.0 ** (np.floor(np.log10(step)) - 3)
    return float(np.floor(step / unit) * unit)


def own_step(scene: DiskScene, limit: float) -> float:
    """The time step (s) of the case at a stability limit (s): a share of it, or the one given, even above it.

    Raises CaseError when the step is automatic and nothing can vibrate.
    """
    wanted = scene.case.run.time_step
    if wanted != "auto":
        return float(wanted)
    step = scene.case.run.safety * limit
    if not np.isfinite(step):
        raise CaseError(["run.time_step: is auto but nothing in the scene can vibrate, give a step in s"])
    return _rounded_down(step)


def choose_step(scene: DiskScene) -> tuple[float, float]:
    """Time step to run with and the stability limit (s).

    Raises CaseError when the case gives a step above the limit.
    """
    limit = step_limit(scene)
    step = own_step(scene, limit)
    if step > limit:
        raise CaseError([f"run.time_step: is {step:g} s, must not be above the stability limit {limit:.6g} s"])
    return step, limit
