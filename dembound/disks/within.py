"""The incident wave whose motion within the ground, at the plane where it enters, is given.

Level ground of depth H and impedance ρc on rock of α times that moves at that plane by v = U(t) + U(t − τ), τ = 2H/c:
what runs up, and what the free surface returns. So U(t) = v(t) − U(t − τ) = Σ (−1)ⁿ v(t − nτ), which needs no sampling
and no window. The rock pulls with ρc(U(t) − U(t − τ)); its incident wave is half of v plus that over α ρc. Dashpots of
disks move with the ground at a depth s below their plane, and their mass begins at m (entry.py).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from dembound.boundaries import Motion, normal_axis
from dembound.boundaries.sides import OPPOSITE
from dembound.boundaries.signals import Incident, Signal
from dembound.disks.entry import entries_of, mass_begins, side_ends
from dembound.disks.matching import factors_in, homogenised_beta
from dembound.disks.scene import DiskScene, with_waves
from dembound.waves import Wave


@dataclass(frozen=True)
class Level:
    """Level ground from the plane where a wave enters up to the free surface.

    height : m; speed : m/s; alpha : impedance of the rock below over that of the ground; mass, stiffness : m above the
    plane, where the mass of the disks begins, and where their dashpots act.
    """

    height: float
    speed: float
    alpha: float = 1.0
    mass: float = 0.0
    stiffness: float = 0.0

    @classmethod
    def of(cls, scene: DiskScene, side: str, motion: Motion) -> Level:
        """The ground of a scene above a side where waves of a kind enter."""
        entry = entries_of(scene)[side][motion]
        height = scene.case.size[normal_axis(side)] - mass_begins(scene, OPPOSITE[side]) + entry.late
        if not scene.case.side(side).factors:
            return cls(height, entry.speed)
        alpha = factors_in(scene, side)[motion] / homogenised_beta(scene, side, motion)
        mass, stiffness = side_ends(scene, side)[motion]
        return cls(height, entry.speed, alpha, mass + entry.late, stiffness + entry.late)

    @property
    def trip(self) -> float:
        """Time (s) to the free surface and back."""
        return 2.0 * self.height / self.speed

    @property
    def echoes(self) -> list[tuple[float, float]]:
        """The incident wave as a sum of what runs up at the plane: by how much it is late (s), and its factor."""
        stiff, heavy, pull = self.stiffness / self.speed, self.mass / self.speed, 0.5 / self.alpha
        return [(stiff, 0.5), (self.trip - stiff, 0.5), (heavy, pull), (self.trip - heavy, -pull)]


@dataclass(frozen=True)
class OfMotionWithin:
    """The incident wave that moves level ground as a wave at the plane where it enters."""

    wave: Wave
    ground: Level

    def velocity(self, t: np.ndarray) -> np.ndarray:
        """Particle velocity, m/s, at the times t, s; same shape as t."""
        return self._incident(self.wave.velocity, np.asarray(t, dtype=float))

    def displacement(self, t: np.ndarray) -> np.ndarray:
        """Particle displacement, m, at the times t, s; same shape as t."""
        return self._incident(self.wave.displacement, np.asarray(t, dtype=float))

    def _incident(self, within: Signal, t: np.ndarray) -> np.ndarray:
        """The incident wave at times t (s) from the motion within the ground."""
        each = [factor * self._rising(within, t - late) for late, factor in self.ground.echoes]
        return np.asarray(sum(each))

    def _rising(self, within: Signal, t: np.ndarray) -> np.ndarray:
        """What runs up at the plane, at times t (s)."""
        trip, rising = self.ground.trip, np.zeros_like(t)
        trips = (float(t.max(initial=-math.inf)) - self.wave.begin()) / trip
        for number in range(math.floor(trips) + 1 if trips >= 0.0 else 0):
            rising += (-1.0) ** number * within(t - number * trip)
        return rising


def with_incident_waves(scene: DiskScene) -> DiskScene:
    """The scene with incident waves in place of those that are motion within the ground at sides that absorb."""
    case, found = scene.case, dict[str, Incident]()
    for side, waves in case.driving.items():
        held = {0, 1} & {*case.side(side).prescribed(normal_axis(side))}
        for motion, name in waves.items():
            if case.wave[name].motion == "within" and not held:
                found[name] = OfMotionWithin(case.wave[name], Level.of(scene, side, motion))
    return with_waves(scene, {**case.wave, **found}) if found else scene
