"""Scenes at rest without loads and waves, in which noise is stepped to measure the largest stable time step."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np

from dembound.casefile import Case
from dembound.motion.part import System
from dembound.motion.scene import Scene

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
