"""Exact solutions of the cases of charts: each is a problem that a case must be, and its motion at the monitors."""

import math
from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from dembound.bar.kind import SPALL_PLACE, SPALL_TIME
from dembound.boundaries import OPPOSITE, SIDES, Motion, axis_of_motion, normal_axis
from dembound.boundaries.boundary import Boundary
from dembound.casefile import Case
from dembound.casefile.bar import BarCase
from dembound.casefile.disks import DiskCase
from dembound.casefile.types import LAWS
from dembound.disks.scene import build
from dembound.errors import CaseError
from dembound.exact.bar import End, bar_stress, bar_velocity, triangle_spall
from dembound.kinds import with_changes
from dembound.studies.chart.measure import Gauge, Gauges
from dembound.studies.exact import exact_motions, problem_of
from dembound.waves import Triangle, Wave


class Exact(ABC):
    """An exact solution.

    Attributes
    ----------
    sentence : the solution in words, for pictures.
    until : s, time up to which it is valid. findings : exact numbers by name, see `Kind.findings`.
    """

    sentence: str
    until: float = math.inf
    findings: Mapping[str, float] = {}

    @abstractmethod
    def gauges(self, case: Case, recorded: Gauges) -> dict[str, Gauge]:
        """The exact motion at the recorded positions; case : that of the choice they were recorded for."""


def exact_of(case: Case) -> Exact:
    """The exact solution of a case; raises CaseError, with the reasons, if none is known."""
    found = [problem for problem in (PulseInBar.of(case), PlaneWave.of(case)) if problem]
    if found:
        return found[0]
    if isinstance(case, DiskCase) and (case.load or case.incident):
        return Continuum.of(case)
    raise CaseError(
        [
            "--reference: there is no exact solution of this case; there are for a pulse on the free left end of a bar "
            "without attenuation, for a plane wave that leaves through an absorbing side, and for the problems of "
            "dembound exact"
        ],
        case.name,
    )


@dataclass(frozen=True)
class Continuum(Exact):
    """One of the problems of `studies/exact`, by its name there.

    base : the case whose problem it is. Where rock goes on beyond a side of it, it does so for all choices: what a free
    or fixed side there returns is an error of the choice.
    """

    base: DiskCase
    name: str
    sentence: str
    until: float

    @classmethod
    def of(cls, case: DiskCase) -> "Continuum":
        """The problem of a case; raises CaseError, with the reasons, if it is none."""
        problem = problem_of(build(case))
        return cls(case, problem.name, problem.sentence, min(problem.until.values(), default=math.inf))

    def gauges(self, case: Case, recorded: Gauges) -> dict[str, Gauge]:
        """The motion at the monitors' places; errors as of `exact_motions`."""
        assert isinstance(case, DiskCase)
        _, motions = exact_motions(build(self._without_ends(case)), self.name)
        return {name: Gauge(recorded[name].position, *motion) for name, motion in motions.items()}

    def _without_ends(self, case: DiskCase) -> DiskCase:
        """The case of a choice, with the sides of the base if it ends where the rock of the base goes on."""
        if not any(_goes_on(self.base.side(side)) and _ends(case.side(side)) for side in SIDES):
            return case
        endless = with_changes(case, {"boundary": {side: table.given() for side, table in self.base.boundary.items()}})
        assert isinstance(endless, DiskCase)
        return endless


def _goes_on(side: Boundary) -> bool:
    """Whether the rock goes on beyond a side."""
    return side.is_artificial or side.is_outside


def _ends(side: Boundary) -> bool:
    """Whether the rock ends at a side, instead of going on or being repeated beyond."""
    return not (_goes_on(side) or side.is_mirror or side.is_periodic)


@dataclass(frozen=True)
class PulseInBar(Exact):
    """A pulse on the left end of a bar without attenuation, up to the first spall.

    pressure : Pa, factor of the wave; far_end : what reflects it.
    """

    bar_length: float
    speed: float
    impedance: float
    pressure: float
    wave: Wave
    far_end: End
    until: float = math.inf
    findings: Mapping[str, float] = field(default_factory=dict)
    sentence: str = "exact (d'Alembert)"

    @classmethod
    def of(cls, case: Case) -> "PulseInBar | None":
        """The solution of a case; None if it is another problem."""
        if not isinstance(case, BarCase) or case.bar.attenuation > 0.0 or len(case.load) != 1 or case.driving:
            return None
        if case.bar.range:
            return None
        load, far = case.load[0], case.side("right")
        end: End | None = "absorbing" if far.factors or far.layer else "free" if far.is_free else None
        end = "fixed" if 0 in far.prescribed(0) else end
        if load.side != "left" or not case.side("left").is_free or end is None:
            return None
        bar, wave = case.bar, case.wave[load.wave]
        found = cls(bar.length, bar.speed, bar.density * bar.speed, load.pressure, wave, end)
        return found._until_it_breaks(bar.breaking_stretch * bar.modulus)

    def _until_it_breaks(self, strength: float) -> "PulseInBar | None":
        """The same up to the first spall, by the closed form; None if the bar may break and there is none."""
        crest = abs(self.pressure) * self.wave.peak()
        if strength > crest:
            return self
        wave = self.wave
        if not isinstance(wave, Triangle) or self.far_end != "free" or self.pressure * wave.amplitude < 0.0:
            return None
        if self.speed * (wave.rise + wave.fall) > self.bar_length:
            return None
        place, at = triangle_spall(self.bar_length, self.speed, wave.rise, wave.fall, crest, strength)
        at += wave.start
        return replace(
            self,
            until=at,
            findings={SPALL_PLACE: place, SPALL_TIME: at},
            sentence=f"exact (d'Alembert), up to the first spall at {1e3 * at:.4g} ms",
        )

    def gauges(self, case: Case, recorded: Gauges) -> dict[str, Gauge]:
        """The motion and stress at the nodes of the monitors, at the same times."""
        return {name: self._at(gauge) for name, gauge in recorded.items()}

    def _at(self, gauge: Gauge) -> Gauge:
        place = float(gauge.position[0])
        length, speed, impedance = self.bar_length, self.speed, self.impedance

        def pressure(time: np.ndarray) -> np.ndarray:
            return np.where(time >= 0.0, self.pressure * self.wave.velocity(time), 0.0)

        velocity = bar_velocity(place, gauge.time, pressure, length, speed, impedance, self.far_end)
        displacement = np.concatenate([[0.0], np.cumsum(0.5 * (velocity[1:] + velocity[:-1]) * np.diff(gauge.time))])
        stress = bar_stress(place, gauge.time, pressure, length, speed, self.far_end)
        return replace(gauge, displacement=_along(displacement, 0), velocity=_along(velocity, 0), stress=stress)


@dataclass(frozen=True)
class PlaneWave(Exact):
    """A plane wave that enters at one side of a block of disks and leaves at the opposite one.

    It runs with the homogenised speed of the packing of each choice; whatever a choice has on the opposite side, the
    wave of the solution leaves without reflection.
    """

    side: str
    motion: Motion
    sentence: str = "exact plane wave at the homogenised speed, leaving without reflection"

    @classmethod
    def of(cls, case: Case) -> "PlaneWave | None":
        """The solution of a case; None if it is another problem."""
        if not isinstance(case, DiskCase) or case.hole or case.load or case.static or len(case.driving) != 1:
            return None
        ((side, waves),) = case.driving.items()
        far = case.side(OPPOSITE[side])
        if len(waves) != 1 or not far.factors or far.waves or LAWS[case.material.law].has_history:
            return None
        ((motion, _),) = waves.items()
        return cls(side, motion) if all(_keeps_plane(case, side, motion)) else None

    def gauges(self, case: Case, recorded: Gauges) -> dict[str, Gauge]:
        """The wave at the monitors' particles, at the same times."""
        assert isinstance(case, DiskCase)
        scene, axis = build(case), normal_axis(self.side)
        speed = scene.ground.wave_speeds(axis)[0 if self.motion == "p" else 1]
        start = float(scene.positions[scene.edges[self.side].nodes, axis].mean())
        wave, column = case.wave[case.driving[self.side][self.motion]], axis_of_motion(self.side, self.motion)
        found = {}
        for name, gauge in recorded.items():
            late = gauge.time - abs(float(gauge.position[axis]) - start) / speed
            found[name] = replace(
                gauge,
                displacement=_along(wave.displacement(late), column),
                velocity=_along(wave.velocity(late), column),
            )
        return found


def _keeps_plane(case: DiskCase, side: str, motion: Motion) -> Iterator[bool]:
    """Of the two sides along which the wave runs, whether each leaves a plane wave plane.

    Free sides do so on a lattice only. Those of random packings are softer, also with rows of equal disks along them:
    they slow the wave in a strip 20 disks high by up to 2 %.
    """
    across = 1 - normal_axis(side)
    held = motion == "p" and "xy"[across] in case.motion.held
    for lateral in ("bottom", "top") if across == 1 else ("left", "right"):
        is_even = case.side(lateral).is_free and not case.packing.packed_under_stress
        yield case.side(lateral).is_periodic or (held and is_even)


def _along(values: np.ndarray, column: int) -> np.ndarray:
    """Motion (k, 3) with these values (k,) in one column and zero elsewhere."""
    motion = np.zeros((len(values), 3))
    motion[:, column] = values
    return motion
