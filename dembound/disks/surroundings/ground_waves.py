"""The motion of the undisturbed ground under plane waves, also at the nodes of a continuum."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from dembound.boundaries.support import Incident
from dembound.casefile.disks.incident import IncidentWave
from dembound.casefile.disks.model import DiskCase
from dembound.continuum.axis import Rule
from dembound.continuum.medium import ElasticPlaneWave, Medium, critical_angle, incident_wave, reflected_waves
from dembound.disks.material.layered import ON_JOINT
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.surroundings.continuum import Surroundings
from dembound.disks.surroundings.cut_bonds import GRADIENT
from dembound.errors import CaseError

DELAYS = 8
"""Delays at which a wave is computed for the ties of an element.

Elements of order 3 and 4 are at most two thirds as long as the shortest wave that counts: along a side it differs by
(2π/3)⁸/(2⁷·8!) = 7e-5 from the polynomial at most, its gradient by some ten times as much; of order 5 and 6 they are up
to as long as this wave, where gradients have errors of 3e-4 measured (cosine pulse of 0.1 s). With six, disks of an
undisturbed lattice in elements of 30 m deviate by 0.020 %, with eight by 0.009 %, as far as the lattice disperses
(cosine pulse of 0.5 s).
"""

NO_PART = 1e-12
"""Part of a wave below which it is rounding: in an isotropic medium S waves have no P part."""


class Arriving(Protocol):
    """The motion of the undisturbed ground under an incident wave."""

    @property
    def across(self) -> float:
        """Time (s) of the incident wave, or the slowest part of it, through a mean diameter of the disks."""

    def arrives(self, places: np.ndarray) -> float:
        """Time (s) from the incident wave at its reference to that at the first of places (k, 2) m."""


@dataclass(frozen=True, eq=False)
class GroundWaves:
    """The motion of the undisturbed ground.

    Attributes
    ----------
    medium : of the ground. waves : its plane waves. signals : displacement history g of each. grain : mean diameter of
    the disks, m.
    """

    medium: Medium
    waves: tuple[ElasticPlaneWave, ...]
    signals: tuple[Incident, ...]
    grain: float

    @property
    def across(self) -> float:
        """Time (s) of the incident wave through a mean diameter of the disks."""
        return self.grain * float(np.hypot(*self.waves[0].slowness))

    def arrives(self, places: np.ndarray) -> float:
        """Time (s) from the incident wave at its reference to that at the first of places (k, 2) m."""
        return float(self.waves[0].delays(places).min())

    def near(self, places: np.ndarray) -> NearPlaces:
        """The waves near places (k, 2) m only."""
        spans = []
        for wave in self.waves:
            delays, more = wave.delays(places), 0.5 * self.grain * float(np.hypot(*wave.slowness))
            spans.append((float(delays.min()) - more, float(delays.max()) + more))
        return NearPlaces(self, tuple(spans))

    def motion(self, of: str, times: np.ndarray, places: np.ndarray, corrector: np.ndarray | None = None) -> np.ndarray:
        """Motion (k, d, 3) of disks at places (d, 2) m with correctors (3, 4, d), by default none, at times (k,) s.

        of : "displacement" (m and rad) or "velocity" (m/s and rad/s).
        """
        moved = np.zeros((len(times), len(places), 3))
        for wave, signal in zip(self.waves, self.signals, strict=True):
            at, g = times[:, None] - wave.delays(places), getattr(signal, of)
            moved[:, :, :2] += g(at)[:, :, None] * np.array(wave.motion)
            if corrector is not None:
                step = 0.5 * self.grain * float(np.hypot(*wave.slowness))  # waves have no accelerations
                change = (g(at + step) - g(at - step)) / (2.0 * step)
                moved -= change[:, :, None] * np.einsum("cgd,g->dc", corrector, _gradient(wave))
        return moved


@dataclass(frozen=True, eq=False, kw_only=True)
class UnlikeWaves(GroundWaves):
    """The motion of undisturbed ground that is not as high at both sides; it is itself that at the left and below.

    Attributes
    ----------
    right : the motion at the right. border : x (m) from which on it is that. tops : heights y (m) of the surface at the
    left and right, above which the motion is that at the surface.
    """

    right: GroundWaves
    border: float
    tops: tuple[float, float]

    def motion(self, of: str, times: np.ndarray, places: np.ndarray, corrector: np.ndarray | None = None) -> np.ndarray:
        """Motion (k, d, 3) at places (d, 2) m, right of the border that of the right side, see `GroundWaves.motion`."""
        right, left = (self.beside(side, of, times, places, corrector) for side in ("right", "left"))
        return np.where((places[:, 0] > self.border)[:, None], right, left)

    @property
    def left(self) -> GroundWaves:
        """The motion at the left and below."""
        return GroundWaves(self.medium, self.waves, self.signals, self.grain)

    def beside(
        self, side: str, of: str, times: np.ndarray, places: np.ndarray, corrector: np.ndarray | None = None
    ) -> np.ndarray:
        """Motion (k, d, 3) at places (d, 2) m of the ground at one side, see `GroundWaves.motion`."""
        ground = self.left if side == "left" else self.right
        return ground.motion(of, times, self.in_ground(side, places), corrector)

    def in_ground(self, side: str, places: np.ndarray) -> np.ndarray:
        """Places (d, 2) m, those above the ground at a side on its surface."""
        top = self.tops[0 if side == "left" else 1]
        return np.column_stack([places[:, 0], np.minimum(places[:, 1], top)])


def _gradient(wave: ElasticPlaneWave) -> np.ndarray:
    """(4,) gradients ∂u_a/∂b by their numbers in `homogenise.GRADIENTS`, per unit of −ġ."""
    gradient = np.zeros(4)
    gradient[np.array(GRADIENT)] = np.outer(wave.motion, wave.slowness)
    return gradient


@dataclass(frozen=True, eq=False)
class NearPlaces:
    """The motion of the undisturbed ground near some places, as a sum of amplitudes: g at some delays of each wave.

    Attributes
    ----------
    ground : the motion. spans : smallest and largest delay (s) of each of its waves.
    """

    ground: GroundWaves
    spans: tuple[tuple[float, float], ...]

    @cached_property
    def _rule(self) -> Rule:
        """The points of the delays."""
        return Rule(DELAYS - 1)

    @cached_property
    def _delays(self) -> np.ndarray:
        """Delays (w, DELAYS) s of each wave."""
        low, high = np.array(self.spans).T[:, :, None]
        return 0.5 * (low + high) + 0.5 * (high - low) * self._rule.points

    @property
    def count(self) -> int:
        """Number of amplitudes."""
        return DELAYS * len(self.spans)

    def amplitudes(self, times: np.ndarray, behind: float) -> np.ndarray:
        """Displacements g (k, count) m at times (k,) s and the delays; these are enough for velocities behind."""
        each = zip(self.ground.signals, self._delays, strict=True)
        return np.hstack([signal.displacement(times[:, None] - delays) for signal, delays in each])

    def velocities(self, behind: float) -> np.ndarray:
        """Matrix (count, count) 1/s from the amplitudes to ġ at the same delays, `behind` (s) earlier."""
        matrix = np.zeros((self.count, self.count))
        for number, (low, high) in enumerate(self.spans):
            own = slice(DELAYS * number, DELAYS * (number + 1))
            scale = 2.0 / (high - low)
            matrix[own, own] = -scale * self._rule.slope(self._rule.points + scale * behind)
        return matrix

    def strained(self, places: np.ndarray, values: np.ndarray, heights: np.ndarray | None = None) -> np.ndarray:
        """Values (3, 4, d) per unit gradient at places (d, 2) m, per unit of amplitudes: (3, d, count).

        heights : (d,) m in the layers whose gradients these are, in layered ground.
        """
        each = []
        for wave, (low, high) in zip(self.ground.waves, self.spans, strict=True):
            slope = self._rule.slope(self._places(wave, places, low, high)) * (2.0 / (high - low))
            each.append(np.einsum("cgd,g->cd", values, _gradient(wave))[:, :, None] * slope)
        return np.concatenate(each, axis=2)

    def motion(self, places: np.ndarray, corrector: np.ndarray) -> np.ndarray:
        """Motion (3, d, count) of disks at places (d, 2) m with correctors (3, 4, d), per unit of amplitudes."""
        each = []
        for wave, (low, high) in zip(self.ground.waves, self.spans, strict=True):
            each.append(np.array(wave.motion)[:, None, None] * self._rule.shape(self._places(wave, places, low, high)))
        moved = self.strained(places, corrector)
        moved[:2] += np.concatenate(each, axis=2)
        return moved

    @staticmethod
    def _places(wave: ElasticPlaneWave, places: np.ndarray, low: float, high: float) -> np.ndarray:
        """Delays of a wave at places (d, 2) m, scaled to −1 … 1 within its span."""
        return (2.0 * wave.delays(places) - low - high) / (high - low)


def layer_at(heights: np.ndarray, joints: Sequence[float], grain: float) -> np.ndarray:
    """The number (k,) of the layer at heights (k,) m, from 0 at the surface; on a joint that above.

    joints : heights (m), from the uppermost down. grain : mean diameter of the disks, m.
    """
    return len(joints) - np.searchsorted(np.array(joints[::-1]), heights + ON_JOINT * grain, "right")


def rising_waves(
    medium: Medium, height: float, signals: tuple[Incident | None, Incident | None], grain: float
) -> GroundWaves:
    """Waves that run straight up: the two waves of the medium that together move as given at a height.

    signals : with velocities along x and y at y = height (m); None for none. grain : mean diameter, m.
    """
    speeds, polarisations = medium.plane_waves((0.0, 1.0))
    waves, own = [], []
    for signal, parts in zip(signals, polarisations, strict=True):
        for speed, polarisation, part in zip(speeds.tolist(), polarisations.T, parts.tolist(), strict=True):
            if signal is not None and abs(part) > NO_PART:
                x, y = (part * polarisation).tolist()
                waves.append(ElasticPlaneWave((0.0, 1.0 / speed), (x, y), -height / speed))
                own.append(signal)
    return GroundWaves(medium, tuple(waves), tuple(own), grain)


def ground_waves(case: DiskCase, ground: PackedMaterial, outside: Surroundings) -> GroundWaves | None:
    """The motion of the ground under the incident wave of a case, None without one.

    Raises CaseError for an angle beyond the critical one, and for a wave that is in the body before the run begins.
    """
    table = case.incident
    if table is None:
        return None
    medium, grain = outside.body.ground.only, ground.brick.mean_diameter
    if outside.levels:
        surfaces = [outside.surface_at(side) for side in ("left", "right")]
        left, right = (_below(case, medium, surface, grain) for surface in surfaces)
        tops, border = (surfaces[0][0], surfaces[1][0]), outside.body.mesh.sides[1]
        found: GroundWaves = UnlikeWaves(medium, left.waves, left.signals, grain, right=right, border=border, tops=tops)
    else:
        found = _below(case, medium, outside.free_surface, grain)
    must_not_be_there(case, found, outside)
    return found


def _below(case: DiskCase, medium: Medium, surface: tuple[float, float] | None, grain: float) -> GroundWaves:
    """The motion below a free surface (height, m; mass, kg/m²), None for none, under the incident wave of a case."""
    table = case.incident
    assert table is not None
    waves = [incident_in(case, medium)]
    if surface is not None:
        if (reflected := reflected_waves(medium, waves[0], *surface)) is None:
            raise CaseError([_beyond(medium, table)])
        waves += reflected
    return GroundWaves(medium, tuple(waves), (case.wave[table.wave],) * len(waves), grain)


def incident_in(case: DiskCase, medium: Medium) -> ElasticPlaneWave:
    """The incident wave of a case that has one, in the medium of its ground."""
    assert case.incident is not None
    wave = incident_wave(medium, case.incident.type, case.incident.angle)
    return wave.shifted(-float(wave.delays(np.array([reference_point(case)]))[0]))


def reference_point(case: DiskCase) -> tuple[float, float]:
    """Point (m) at which a case's incident wave has the given velocity: as given, or the first corner of the ground.

    The first corner is the lower one on the side from which the wave comes.
    """
    assert case.incident is not None
    left, bottom, right, _ = case.box
    return case.incident.point or (left if case.incident.angle >= 0.0 else right, bottom)


def _beyond(medium: Medium, table: IncidentWave) -> str:
    """The message about an angle that is not below the critical one."""
    sign = float(np.copysign(1.0, table.angle))
    critical = sign * critical_angle(medium, table.type, sign)
    return (
        f"incident.angle: is {table.angle:g}; from the critical angle of this packing on, {critical:.5g} degrees, the "
        f"free surface changes the form of the wave; must be {'below' if sign > 0.0 else 'above'} that"
    )


def must_not_be_there(case: DiskCase, found: Arriving, outside: Surroundings) -> None:
    """Raise CaseError if the incident wave has reached the body at the beginning of the run."""
    assert case.incident is not None
    left, bottom, right, top = outside.box
    first = found.arrives(np.array([(left, bottom), (right, bottom), (left, top), (right, top)]))
    begins = case.wave[case.incident.wave].start
    if begins + first < -found.across:  # ties are within a diameter of the box
        said = f"the wave would reach the disks {-(begins + first):.3g} s before the run begins; give"
        start = f"wave.{case.incident.wave}.start = {-first:.3g} (s) or more"
        raise CaseError([f"incident.point: {said} {start}, or a point that it passes earlier"])


class GroundMotion:
    """Motion at some heights, from the motion of the disks of a column, in bands of about equal height.

    Parameters
    ----------
    up : (c,) m, heights of the column's disks. mass : (c,) kg. diameter : m, height of a band. heights : (m,) m.
    """

    def __init__(self, up: np.ndarray, mass: np.ndarray, diameter: float, heights: np.ndarray) -> None:
        row = np.floor((up - up.min()) / diameter + 0.5).astype(np.int64)
        _, self._band = np.unique(row, return_inverse=True)  # of each disk
        self._share = mass / np.bincount(self._band, mass)[self._band]  # of each in the mass of its band
        self._height, self._heights = np.bincount(self._band, self._share * up), heights

    def at_heights(self, values: np.ndarray) -> np.ndarray:
        """Displacements or velocities (m, 3) from those of the column's disks (c, 3); rotations are zero.

        Constant beyond the first and last bands.
        """
        motion = np.zeros((len(self._heights), 3))
        for axis in (0, 1):
            mean = np.bincount(self._band, self._share * values[:, axis])
            motion[:, axis] = np.interp(self._heights, self._height, mean)
        return motion
