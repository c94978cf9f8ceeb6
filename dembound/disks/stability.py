"""The largest stable time step, from the largest eigenfrequency of the scene."""

import numpy as np

from dembound.disks.scene import DiskScene
from dembound.errors import CaseError, RunError
from dembound.kernels.contacts import CLOSING
from dembound.kernels.elastic import contact_forces
from dembound.motion.threads import threads_for

TOLERANCE = 1e-3
"""Relative residual at which the iteration for the eigenvalue ends.

It is added to the eigenvalue, so the step is too small by at most 0.05 %, never too large. Lattices need it, as their
largest eigenvalues are close to each other.
"""

OPENING = 0.75 / CLOSING
"""Largest ω² over 4/Δt² where contacts open and close: sin²(π/3), for first pushes multiplied by CLOSING.

A contact that opens and closes creates overtones of every motion. At ωΔt = 2 sin(π/3) a motion has three steps per
period, and its overtone, sampled at whole steps, equals the motion running backwards. They amplify each other, and
energy grows by orders of magnitude within a thousand steps. Below this limit the loss at closing
(`kernels.contacts.CLOSING`) exceeds the gain.
"""

LANCZOS_VECTORS = 8
"""Krylov vectors stored: few, as they are the largest arrays."""


def step_limit(scene: DiskScene, tolerance: float = TOLERANCE, damp: float | None = None) -> float:
    """Largest stable step 2/(ω_max √(1 + damp)) of central differences (s), for a relative residual `tolerance`.

    damp is the local damping coefficient, None: the material's. At the limit, forces are opposite to velocities at
    every step, so local damping multiplies them by 1 + damp.

    ω_max² is the largest eigenvalue of M⁻¹K of the assembled scene, found by Lanczos iteration on M^(-1/2) K
    M^(-1/2) with held and prescribed components taken out; centred dashpots do not change it. The start vector is
    fixed, so the step is the same in every run. Under a history-dependent law the limit also holds for loose disks, and
    ω_max² is multiplied by 1.4 where contacts may open (`OPENING`).

    Raises RunError when the iteration does not converge.
    """
    from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigsh

    root = np.sqrt(_inverse_mass(scene))
    stiffness = _support_stiffness(scene)
    force = np.empty((3, scene.count))

    def apply(vector: np.ndarray) -> np.ndarray:
        u = root * vector.reshape(3, -1)
        with threads_for(scene.count):
            for rows in scene.rows:
                contact_forces(u, rows, force)
        return (root * (stiffness * u - force)).ravel()

    size = 3 * scene.count
    operator = LinearOperator((size, size), matvec=apply, dtype=float)
    start = np.random.default_rng(0).standard_normal(size) * (root.ravel() > 0.0)
    if not start.any():
        largest = 0.0
    elif size < 20:
        matrix = np.stack([apply(column) for column in np.eye(size)], axis=1)
        largest = np.linalg.eigvalsh(0.5 * (matrix + matrix.T))[-1]
    else:
        try:
            largest = eigsh(
                operator, k=1, which="LA", v0=start, ncv=LANCZOS_VECTORS, tol=tolerance, return_eigenvectors=False
            )[0]
        except ArpackNoConvergence as error:
            raise RunError(f"the stability limit was not found ({error})") from None
        largest *= 1.0 + tolerance  # the computed value is too small, by less than its residual
    if scene.has_history:
        opens = scene.ground.moduli.emod > 0.0
        largest = max(largest, _loose_eigenvalue(scene)) / (OPENING if opens else 1.0)
    damp = scene.case.material.damp if damp is None else damp
    return float(2.0 / np.sqrt(largest * (1.0 + damp))) if largest > 0.0 else np.inf


def _loose_eigenvalue(scene: DiskScene) -> float:
    """Bound of ω² (1/s²) for the smallest disks, each rolling on six neighbours, as in broken or loose ground.

    Only contacts, no bonds. On the hexagonal lattice the normal springs give at most 6k_n/m, and the tangential ones
    24k_s/m, when all disks rotate in the same way; the sum is a bound for both together.
    """
    moduli = scene.ground.moduli
    shear = moduli.emod / moduli.kratio if moduli.fric > 0.0 else 0.0
    return (6.0 * moduli.emod + 24.0 * shear) / float(scene.ground.mass.min())


def _inverse_mass(scene: DiskScene) -> np.ndarray:
    """(3, n): 1/m, 1/m, 1/I, and 0 for components that cannot move."""
    inverse = scene.free[:, None] / np.stack([scene.mass, scene.mass, scene.inertia])
    fixed = scene.supports.prescribed
    inverse[scene.supports.component[fixed], scene.supports.node[fixed]] = 0.0
    return inverse


def _support_stiffness(scene: DiskScene) -> np.ndarray:
    """(3, n) N/m that the supports add to the diagonal."""
    stiffness = np.zeros((3, scene.count))
    stiffness[scene.supports.component, scene.supports.node] = scene.supports.stiffness
    return stiffness


def _rounded_down(step: float) -> float:
    """The step cut to four digits: the last bits of an eigenvalue may depend on the libraries' threads."""
    unit = 10.0 ** (np.floor(np.log10(step)) - 3)
    return float(np.floor(step / unit) * unit)


def choose_step(scene: DiskScene) -> tuple[float, float]:
    """Time step to run with and the stability limit (s).

    Raises CaseError when the case gives a step above the limit.
    """
    limit = step_limit(scene)
    wanted = scene.case.run.time_step
    if wanted == "auto":
        step = scene.case.run.safety * limit
        if not np.isfinite(step):
            raise CaseError(["run.time_step: is auto but nothing in the scene can vibrate, give a step in s"])
        return _rounded_down(step), limit
    assert isinstance(wanted, float | int)
    if wanted > limit:
        raise CaseError([f"run.time_step: is {wanted:g} s, must not be above the stability limit {limit:.6g} s"])
    return float(wanted), limit
