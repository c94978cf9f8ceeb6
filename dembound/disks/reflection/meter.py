"""Reflection of plane waves by a side of a case, by angle and frequency.

The side is that of the case, with its supports, on the packing of the case, at the steps of its scheme. Of the waves of
the packing (modes.py) the incident one is the wave whose motion at the interface is most like a plane wave of the
equivalent continuum; reflected power in any wave is assigned to the type, P or S, that it is most like.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np

from dembound.boundaries import normal_axis
from dembound.disks.material.homogenise import GRADIENTS
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.reflection.bricks import BrickInRow, end_of, is_outwards
from dembound.disks.reflection.modes import Modes, Oscillation, modes_of, modes_of_copies, sent_back
from dembound.disks.scene import DiskScene

Kind = Literal["p", "s"]

ALIKE = 0.5
"""Share of a wave's motion common with a plane wave, below which there is no such wave: in gaps of the packing."""

ROUNDS = 8
"""Iterations for the direction of a wave whose speed depends on it; each gains a digit or more in rock."""


@dataclass(frozen=True)
class HomogenisedWave:
    """A plane wave of the equivalent continuum.

    kind : "p" or "s"; slowness, polarisation : (2,) s/m and 1, along x and y.
    """

    kind: Kind
    slowness: np.ndarray
    polarisation: np.ndarray


@dataclass(frozen=True)
class Reflections:
    """Reflected energy over the energy of the incident wave; nan where the incident wave does not run.

    angles : (a,) degrees from the normal; frequencies : (f,) Hz; same, converted : kind -> (f, a), as the same type of
    waves and as the other one.
    """

    side: str
    angles: np.ndarray
    frequencies: np.ndarray
    same: dict[Kind, np.ndarray]
    converted: dict[Kind, np.ndarray]

    @property
    def kinds(self) -> tuple[Kind, ...]:
        """The incident types of waves."""
        return tuple(self.same)

    def total(self, kind: Kind) -> np.ndarray:
        """Reflected energy of P and S waves together (f, a)."""
        return self.same[kind] + self.converted[kind]


def homogenised_wave(ground: PackedMaterial, kind: Kind, direction: np.ndarray) -> HomogenisedWave | None:
    """The wave of a type along a direction (2,) in the equivalent continuum (Christoffel's equation), None if held."""
    free = [component for component in (0, 1) if component not in ground.held]
    matrix = contracted(ground, direction, direction)[np.ix_(free, free)]
    squares, shapes = np.linalg.eigh(0.5 * (matrix + matrix.T))
    polarisations = np.zeros((2, len(free)))
    polarisations[free] = shapes
    along = np.abs(direction @ polarisations)
    is_p = along > math.sqrt(0.5) if len(free) == 1 else np.arange(2) == np.argmax(along)
    found = np.flatnonzero(is_p == (kind == "p"))
    if len(found) == 0 or not squares[found[0]] > 0.0:
        return None
    speed = math.sqrt(squares[found[0]] / ground.density)
    return HomogenisedWave(kind, direction / speed, polarisations[:, found[0]])


def contracted(ground: PackedMaterial, first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """C_abcd of the equivalent continuum contracted with two vectors on b and d, (2, 2) Pa."""
    gradients = np.array([[GRADIENTS.index(a + b) for b in "xy"] for a in "xy"])
    tensor = np.nan_to_num(ground.material_tensor)[gradients[:, :, None, None], gradients]
    return np.einsum("abcd,b,d->ac", tensor, first, second)


class End(Protocol):
    """The end of a row of bricks."""

    def at(self, oscillation: Oscillation) -> None:
        """Condense at a frequency."""

    def stiffness(self, phase: complex) -> np.ndarray:
        """Dynamic stiffness (k, k) of the interface for waves of a phase from period to period along the side."""


class Meter:
    """Sides at the end of a row of bricks.

    Parameters
    ----------
    row : the bricks. time_step : of the run, s. ends : of the row, one or more.
    """

    def __init__(self, row: BrickInRow, time_step: float, *ends: End) -> None:
        self.side, self.ground, self._step = row.side, row.ground, time_step
        self._row, self._ends = row, ends
        self._waves: dict[tuple[str | float, ...], HomogenisedWave | None] = {}

    @classmethod
    def of(cls, side: str, time_step: float, *scenes: DiskScene) -> Meter:
        """The meter of a side with supports, or of a free one; scenes : of the same packing, see `bricks.end_scene`.

        Raises CaseError for a scene in which disks of the end are missing.
        """
        row = BrickInRow(scenes[0].ground, side)
        return cls(row, time_step, *(end_of(scene, row) for scene in scenes))

    def measure(
        self,
        frequencies: Sequence[float] | np.ndarray,
        angles: Sequence[float] | np.ndarray,
        kinds: Sequence[Kind] = ("p", "s"),
        report: Callable[[float], None] | None = None,
    ) -> list[Reflections]:
        """Reflections of every end at frequencies (Hz) and angles (degrees, below 90).

        report : receives each frequency before it is computed. Types that cannot move are left out, and so are angles
        but 0 where a component of motion is held.
        """
        ground = self.ground
        if set(ground.held) & {0, 1}:
            angles = [angle for angle in angles if angle == 0.0]
        kinds = [kind for kind in kinds if self._plane_wave(kind, self._direction(0.0)) is not None]
        shape = 2, len(self._ends), len(frequencies), len(angles)
        shares = {kind: np.full(shape, np.nan) for kind in kinds}
        for f, frequency in enumerate(frequencies):
            if report is not None:
                report(frequency)
            oscillation = Oscillation(2.0 * math.pi * frequency, self._step)
            for body in (self._row.condensed, *self._ends):
                body.at(oscillation)
            for a, angle in enumerate(angles):
                for kind in kinds:
                    shares[kind][:, :, f, a] = self._at(oscillation, kind, angle)
        every = np.array(angles), np.array(frequencies)
        return [
            Reflections(self.side, *every, *({kind: shares[kind][part, end] for kind in kinds} for part in (0, 1)))
            for end in range(len(self._ends))
        ]

    def _plane_wave(self, kind: Kind, direction: np.ndarray) -> HomogenisedWave | None:
        """`homogenised_wave` of the packing, found once for each direction."""
        key = kind, *direction.tolist()
        if key not in self._waves:
            self._waves[key] = homogenised_wave(self.ground, kind, direction)
        return self._waves[key]

    def _direction(self, angle: float) -> np.ndarray:
        """Unit vector (2,) of a wave towards the side at an angle (degrees)."""
        axis, way = normal_axis(self.side), np.radians(angle)
        direction = np.empty(2)
        direction[axis], direction[1 - axis] = is_outwards(self.side) * np.cos(way), np.sin(way)
        return direction

    def _at(self, oscillation: Oscillation, kind: Kind, angle: float) -> np.ndarray:
        """Energy (2, e) reflected by the ends as the same and as the other type."""
        wave = self._plane_wave(kind, self._direction(angle))
        assert wave is not None
        trace = wave.slowness[1 - normal_axis(self.side)]
        period = self.ground.brick.size[1 - normal_axis(self.side)]
        phase = complex(np.exp(-1j * oscillation.omega * trace * period))
        stiffness = self._row.condensed.stiffness(phase)
        row = self._row
        modes = modes_of(stiffness) if row.copies == 1 else modes_of_copies(stiffness, row.shifts(phase))
        likeness = np.where(modes.outgoing, self._likeness(modes, wave, oscillation.omega), 0.0)
        incident = int(np.argmax(likeness))
        if not likeness[incident] > ALIKE:
            return np.full((2, len(self._ends)), np.nan)
        as_p, as_s = (self._like_returning(modes, of, trace, oscillation.omega) for of in ("p", "s"))
        is_same = (as_p > as_s) == (kind == "p")
        powers = [sent_back(modes, incident, stiffness, end.stiffness(phase)) for end in self._ends]
        return np.array([[power[is_same].sum(), power[~is_same].sum()] for power in powers]).T

    def _like_returning(self, modes: Modes, kind: Kind, trace: float, omega: float) -> np.ndarray:
        """Likeness (m,) of waves to the inward wave of a type with a slowness (s/m) along the side."""
        axis, sign = normal_axis(self.side), is_outwards(self.side)
        direction = -self._direction(0.0)
        wave = self._plane_wave(kind, direction)
        for _ in range(ROUNDS):
            if wave is None:
                return np.zeros(len(modes.factor))
            sine = trace / np.hypot(*wave.slowness)
            if abs(sine) >= 1.0:
                return np.zeros(len(modes.factor))
            direction = np.empty(2)
            direction[axis], direction[1 - axis] = -sign * math.sqrt(1.0 - sine**2), sine
            wave = self._plane_wave(kind, direction)
        assert wave is not None
        return self._likeness(modes, wave, omega)

    def _likeness(self, modes: Modes, wave: HomogenisedWave, omega: float) -> np.ndarray:
        """Share (m,) of the translations at the interface that is the motion of a plane wave."""
        row = self._row
        moving = row.components < 2
        plane = wave.polarisation[row.components[moving]] * np.exp(-1j * omega * (row.places[moving] @ wave.slowness))
        motion = modes.motion[moving]
        size = np.sum(np.abs(motion) ** 2, axis=0) * np.sum(np.abs(plane) ** 2)
        return np.divide(np.abs(plane.conj() @ motion) ** 2, size, out=np.zeros(len(size)), where=size > 0.0)
