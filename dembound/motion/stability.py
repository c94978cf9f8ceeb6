"""The largest eigenvalue of M⁻¹K of a scene, and scenes at rest in which noise is stepped."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np

from dembound.casefile.model import Case
from dembound.errors import RunError
from dembound.interrupts import look
from dembound.kernels.lanczos import next_vector, work
from dembound.motion.memory import threads_for
from dembound.motion.part import System
from dembound.motion.scene import Scene
from dembound.motion.state import Layout, aligned_zeros

TOLERANCE = 1e-3
"""Relative residual at which the iteration for the eigenvalue ends.

The residual is added to the eigenvalue, so the step is too small by at most 0.05 %. Lattices need this tolerance, as
their largest eigenvalues are close to each other.
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


def largest_eigenvalue(
    layout: Layout,
    mass: np.ndarray,
    inertia: np.ndarray,
    free: np.ndarray,
    moves: np.ndarray,
    fill_forces: Callable[[np.ndarray, np.ndarray], None],
) -> float:
    """The largest eigenvalue of M⁻¹K (1/s²), too large by at most `TOLERANCE`.

    layout : the slots of n nodes. mass (n,) kg, inertia (n,) kg·m². free : (3,) 1, or 0 for a component held
    everywhere; moves : (3, n) bool, False for components that are held or prescribed. fill_forces : fills its second
    argument (3, slots) with the forces at displacements, its first one, zero where nothing moves.

    Lanczos iteration with three vectors, 88 bytes a slot in all, without orthogonalising again: vectors only lose their
    orthogonality once an eigenvalue has converged, which gives copies of it but none that are too large (Paige 1980,
    Linear Algebra Appl. 34, 235–258). The vectors are not scaled to unit size, which would take another pass; their
    sizes go into the factors of the next step. The start is random but fixed: the result is the same in every run.

    An eigenvalue lies within the residual of the computed one. It is very likely (`LEAST`), but not certain, that this
    is the largest one.

    Raises RunError when the iteration does not converge.
    """
    u, size = _start(layout, mass, inertia, free[:, None] * moves)
    before, force = aligned_zeros(*u.shape), aligned_zeros(*u.shape)
    mass, inertia = layout.spread(mass), layout.spread(inertia)
    diagonal: list[float] = []
    beside: list[float] = []  # the diagonal
    size_before = 1.0
    with threads_for(len(layout.slot)):
        while size > 0.0 and len(diagonal) < MOST:
            look()
            fill_forces(u, force)
            diagonal.append(-work(u, force) / size**2)
            factors = -1.0 / size, diagonal[-1] / size, size / size_before
            size_before = size
            size = float(np.sqrt(next_vector(u, before, force, mass, inertia, free, *factors)))
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


def _start(layout: Layout, mass: np.ndarray, inertia: np.ndarray, moves: np.ndarray) -> tuple[np.ndarray, float]:
    """Random displacements (3, slots) m and their size √⟨u, u⟩, zero for components that cannot move, moves (3, n).

    All directions of displacements times the root of the mass are equally likely. They are drawn node by node.
    """
    start = np.random.default_rng(0).standard_normal(moves.shape)
    start *= moves
    size = float(np.sqrt(sum(np.sum(row * row) for row in start)))
    start[:2] /= np.sqrt(mass)
    start[2] /= np.sqrt(inertia)
    return layout.spread(start), size


def _largest_of(diagonal: list[float], beside: list[float], size: float) -> tuple[float, float]:
    """Largest eigenvalue of a symmetric tridiagonal matrix (k diagonal, k − 1 entries beside it), and its residual.

    size : norm of the vector after the last one, whose share in the eigenvector gives the residual.
    """
    from scipy.linalg import eigh_tridiagonal

    last = len(diagonal) - 1
    value, vector = eigh_tridiagonal(diagonal, beside, select="i", select_range=(last, last))
    return float(value[0]), size * abs(float(vector[last, 0]))


C = TypeVar("C", bound=Case)

NOISE = 1e-5
"""Root mean square velocity (m/s) of the noise: strains of 1e-8, at which no bond breaks."""


@dataclass(frozen=True)
class Trial:
    """A scene under one law, or a bar at one stage of its method, at rest and without loads and waves.

    Attributes
    ----------
    name : of the law or stage.
    scene : its arrays.
    limit : s, the stability limit computed from the largest eigenvalue; step : s, of the case.
    system : its parts and ties for a time step (s); new for every run.
    is_linear : whether forces are linear, so that central differences conserve an energy exactly.
    step_cost : estimated time of a step on one core, ns.
    """

    name: str
    scene: Scene
    limit: float
    step: float
    system: Callable[[float], System]
    is_linear: bool
    step_cost: float

    def noise(self, part: str | None = None) -> np.ndarray:
        """Random velocities (3, n), m/s and rad/s, of all nodes or of those of one part; the same in every call.

        All directions of velocities times the root of the mass are equally likely, so every mode of vibration has the
        same expected energy. Momentum and angular momentum are zero, as a free body would drift and rotate, and the
        rounding error of its displacements would grow. A body of which a component is held cannot rotate as a whole.
        """
        scene = self.scene
        mass = np.stack([scene.mass, scene.mass, scene.inertia])
        velocity = np.random.default_rng(0).standard_normal(mass.shape) * scene.moves
        velocity *= NOISE * np.sqrt(scene.mass.mean() / mass)
        moves = scene.moves.astype(float)
        if part is not None:
            chosen = np.zeros(scene.count, dtype=bool)
            chosen[next(each.nodes for each in self.system(self.step).parts if each.name == part)] = True
            velocity[:, ~chosen] = moves[:, ~chosen] = 0.0
        for c in range(2):
            if np.sum(moves[c]) > 1:
                velocity[c] -= moves[c] * (np.sum(mass[c] * velocity[c]) / np.sum(mass[c] * moves[c]))
        noisy = moves.any(axis=0)
        if noisy.any() and moves[:, noisy].all():
            arm = (scene.positions - np.average(scene.positions, axis=0, weights=mass[0] * noisy)).T
            turn = np.stack([-arm[1], arm[0], np.ones(scene.count)]) * noisy
            velocity -= turn * (np.sum(mass * turn * velocity) / np.sum(mass * turn**2))
        return velocity

    @property
    def parts(self) -> Iterator[str]:
        """Names of the parts in which noise is put: all parts, each of which moves independently of those after it.

        A body and its continuum are tied: the energy of each is at most that of the noise in it. Under a
        history-dependent law noise is put only in the last recorded part, the body, as a ledger has the energies of all
        parts.
        """
        system = self.system(self.step)
        parts = system.parts if self.is_linear else system.recorded_parts[-1:]
        yield from (part.name for part in parts)


def at_rest(case: C) -> C:
    """The case without loads and waves; its sides keep their dashpots and springs."""
    boundary = {side: table.at_rest() for side, table in case.boundary.items()}
    return replace(case, boundary=boundary, wave={}, load=())


def left_out(case: Case) -> list[str]:
    """Features of a case that `at_rest` leaves out, in words."""
    return ["no loads and waves"] * bool(case.load or case.wave)
