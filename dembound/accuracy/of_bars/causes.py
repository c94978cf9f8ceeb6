"""The error of a bar: contributions of its ends, nodes and steps to the motion at its monitors.

Up to the first change of its bonds a bar is linear, and its motion is known at every frequency, without a run:

- own: the bar as it is stepped, with its own ends (formulas/bars/chain.py).
- endless: the same nodes and steps, but beyond an absorbing end the bar goes on, and the wave that enters there is the
  one that the case gives.
- exact time: the endless bar with Δt = 0.
- exact: rods without nodes (formulas/bars/rods.py), whose absorbing ends absorb everything. The stress of a node at an
  end is taken half a spacing inside, and compared with the exact stress there.

The difference own − endless is the error of the ends, endless − exact time the error of the time step, exact time −
exact the error of the grid. So all reflections are included, also of ends softer than the bar, and losses at
interfaces between ranges. Where nodes are not at the places of monitors, the exact motion at both is compared, too.

At Courant number 1 finite differences are exact: with h = sΔt/2 the half node and the spring at the end of an endless
row need the force ρcA (sinh h + e^{−h}) v = ρcA cosh h v, and pass on e^{−2h} of it from node to node. The recorded
velocity is the mean of two half steps, μv = cosh h v, so that a force F on the end makes the velocity F/ρcA of a rod. A
dashpot ρcA takes ρcA μv, all that arrives, and interfaces between ranges reflect as those of rods. What remains is the
displacement, a sum of steps: Δt/sinh 2h in place of 1/s, another one by (ωΔt)²/6.

Whether the bar was linear is checked against the record: where the record differs from `own`, as the method has changed
bonds, the error is unknown.

Cases under one pulse have an exact solution, with which charts compare.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from dembound.accuracy.of_bars.options import FACTORS
from dembound.accuracy.reference import Exact
from dembound.bar.body import ROUNDING
from dembound.bar.layers import ENDS
from dembound.bar.scene import BarScene, build_bar
from dembound.bar.stability import own_step
from dembound.casefile.bar.model import BarCase
from dembound.exact.bar import End, bar_stress, bar_velocity, triangle_spall
from dembound.formulas.bars.ends import WIDEST
from dembound.formulas.bars.motions import FINER, BarMotions, places_of
from dembound.formulas.bars.rods import Window
from dembound.formulas.cause import GRID, QUANTITIES, SIDES, STEP, Cause, Causes
from dembound.formulas.history import LEAST, History, Motions, along
from dembound.kinds.bar.kind import SPALL_PLACE, SPALL_TIME
from dembound.waves.triangle import Triangle
from dembound.waves.wave import Wave
from dembound.words import percent

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline


@dataclass(frozen=True)
class PulseInBar(Exact[BarCase]):
    """A pulse on the left end of a bar without attenuation, up to the first spall.

    pressure : Pa, factor of the wave; far_end : its type, which determines the reflection.
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
    def of(cls, case: BarCase) -> PulseInBar | None:
        """The solution of a case; None if it is another problem."""
        if case.bar.attenuation > 0.0 or case.bar.range or len(case.load) != 1 or case.driving:
            return None
        load, far = case.load[0], case.side("right")
        end: End | None = "absorbing" if far.absorbs else "free" if far.is_free else None
        end = "fixed" if 0 in far.prescribed(0) else end
        if load.side != "left" or not case.side("left").is_free or end is None:
            return None
        bar, wave = case.bar, case.wave[load.wave]
        found = cls(bar.length, bar.speed, bar.density * bar.speed, load.pressure, wave, end)
        return found._until_it_breaks(bar.breaking_stretch * bar.modulus)

    def _until_it_breaks(self, strength: float) -> PulseInBar | None:
        """The solution up to the first spall, if the bar may break; None where its place has no closed form."""
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
        sentence = f"{self.sentence}, up to the first spall at {1e3 * at:.4g} ms"
        return replace(self, until=at, findings={SPALL_PLACE: place, SPALL_TIME: at}, sentence=sentence)

    def motions(self, case: BarCase, recorded: Motions) -> dict[str, History]:
        """The motion and stress at the nodes of the monitors, at the same times."""
        length, speed, found = self.bar_length, self.speed, {}

        def pressure(time: np.ndarray) -> np.ndarray:
            return np.where(time >= 0.0, self.pressure * self.wave.velocity(time), 0.0)

        for name, own in recorded.items():
            place, time = float(own.place[0]), own.time
            velocity = bar_velocity(place, time, pressure, length, speed, self.impedance, self.far_end)
            displacement = np.concatenate([[0.0], np.cumsum(0.5 * (velocity[1:] + velocity[:-1]) * np.diff(time))])
            stress = bar_stress(place, time, pressure, length, speed, self.far_end)
            found[name] = History.of(own.place, time, along(displacement, 0), along(velocity, 0), stress)
        return found


CLEARLY = 2.0
"""Largest motion of a monitor that surely counts, over the smallest that does."""


class ExactMotion:
    """The motion of rods at the places of the monitors of a scene's case.

    The stress at the ends of the bar is taken half a spacing of this scene inside.
    """

    def __init__(self, scene: BarScene) -> None:
        self._scene = scene
        self._found: dict[int, dict[str, dict[str, CubicSpline]]] = {}

    @cached_property
    def step(self) -> float:
        """The time step (s) of the case."""
        return own_step(self._scene, self._scene.step_limit())

    @cached_property
    def places(self) -> dict[str, float]:
        """Monitor -> its place in the case, m, which need not be at a node."""
        return places_of(self._scene.case)

    def at(self, window: Window) -> Motions:
        """The motions at the times of a window; computed once for all steps between two powers of 2 s."""
        octave = math.floor(math.log2(window.step))
        if octave not in self._found:
            self._found[octave] = self._splines(2.0**octave)
        found = {}
        for name, each in self._found[octave].items():
            values = {quantity: spline(window.time) for quantity, spline in each.items()}
            found[name] = History(np.array([self.places[name], 0.0]), window.time, values)
        return found

    def surely_counted(self, window: Window) -> dict[str, set[str]]:
        """By monitor the quantities that count for all choices.

        Nearly negligible quantities are left out, and stresses that some choices record at end nodes.
        """
        motion, found = self.at(window), {name: set[str]() for name in self.places}
        for quantity in QUANTITIES:
            peaks = {name: float(np.abs(each.values[quantity]).max()) for name, each in motion.items()}
            for name, peak in peaks.items():
                is_loud = peak > CLEARLY * LEAST[quantity] * max(peaks.values())
                if is_loud and (quantity != "stress" or self._inside(name)):
                    found[name].add(quantity)
        return found

    def _inside(self, name: str) -> bool:
        """Whether the node of a monitor is no end node with any spacing that is tried."""
        rod, place = self._scene.rod, self.places[name]
        away = {"left": place, "right": rod.ranges[-1].end - place}
        reach = 0.5 * max(FACTORS) * (1.0 + ROUNDING)
        return all(away[side] > reach * rod.end(side).spacing for side in ENDS)

    def _splines(self, step: float) -> dict[str, dict[str, CubicSpline]]:
        """Splines of the motions for steps (s) of up to twice this length; the last may begin before the end."""
        from scipy.interpolate import CubicSpline

        window = Window.up_to(self._scene.case.run.duration + 2.0 * step, step)
        time = window.finer(FINER).time
        found = BarMotions(self._scene.case, self._scene, window, dict.fromkeys(self.places, time)).exact(self.places)
        return {
            name: {q: CubicSpline(time, values) for q, values in each.values.items()} for name, each in found.items()
        }


UNEXPLAINED = 1.0 / 3.0
"""Largest difference of a record from the linear bar, over its estimated error, with which this is given."""

SMALLEST = 1e-3
"""RMS of this difference over that of the record below which it does not matter."""

QUIET = 1e-6
"""RMS of a record over the largest motion that sources make, below which it is rounding errors and far precursors."""

FACTOR = 1.05
"""Factor of these errors: true ones differ by up to 3 % (tests/unit/accuracy/of_bars/test_causes.py)."""

HOW = "from the waves of the linear bar at each frequency"
"""How these errors are found, in words."""

NO_GRID = "exact: at Courant number 1 finite differences pass a wave on by one spacing in each step"
NO_ECHO = "exact: at Courant number 1 dashpots ρcA take all of a wave that comes to them through finite differences"
"""Why some errors are zero."""

PLACES, LOADS = "places", "near loads"
"""Causes of errors: monitors that are not at nodes, and loads on several nodes."""

EQUAL = 1e-9
"""Relative difference up to which steps, places and dashpots are equal, for rounding."""


def causes_of_bar(case: BarCase, recorded: Motions, time_step: float) -> Causes:
    """The causes of the errors of a bar, whose cost is 0, as nothing is run.

    recorded : of the run, by monitor, up to the first break. time_step : s, of the run.

    Raises the errors of building a scene.
    """
    if (refused := not_linear(case)) or not recorded:
        return Causes([], refused)
    times = {name: each.time for name, each in recorded.items()}
    window = Window.up_to(max(float(time[-1]) for time in times.values()), time_step)
    motions = BarMotions(case, build_bar(case), window, times)
    own, exact = motions.own(), motions.exact()
    lines = {name: _unknown(case, each, own[name], exact[name]) for name, each in recorded.items()}
    known = [name for name, line in lines.items() if not line]
    found = split(motions, own, exact, {name: recorded[name] for name in known})
    missing = [f"{name}: {line}" for name, line in lines.items() if line]
    return Causes(found if known else [], missing, echo_free=bool(motions.absorbing))


def split(motions: BarMotions, own: Motions, exact: Motions, recorded: Motions) -> list[Cause]:
    """Causes: grid, time step, absorbing ends and places, from the motions of the stepped bar and of rods.

    own, exact : motions at the nodes of the monitors, by monitor.
    """
    step = motions.window.step
    endless = motions.endless(step)
    found = list(_inside(motions, endless, exact, recorded))
    if motions.absorbing and _takes_all(motions):
        found.append(_none(SIDES, NO_ECHO, recorded))
    elif motions.absorbing:
        found.append(difference(SIDES, own, endless, recorded))
    if motions.beside_places:
        found.append(difference(PLACES, exact, motions.exact(motions.places), recorded))
    return found


def _inside(motions: BarMotions, endless: Motions, exact: Motions, recorded: Motions) -> Iterator[Cause]:
    """Errors of grid and time step, where they do not cancel out."""
    if not _passes_all(motions):
        exact_time = motions.endless(0.0)
        yield difference(GRID, exact_time, exact, recorded)
        yield difference(STEP, endless, exact_time, recorded)
        return
    yield _none(GRID, NO_GRID, recorded)
    if any(load.nodes > 1 for load in motions.case.load):
        at_ends = motions.loaded_at_ends.endless(motions.window.step)
        yield difference(LOADS, endless, at_ends, recorded)
        endless = at_ends
    yield difference(STEP, endless, exact, recorded)


def _passes_all(motions: BarMotions) -> bool:
    """Whether grid and time step together transmit all waves exactly: finite differences at Courant number 1."""
    rod = motions.scene.rod
    return not motions.case.method.begin(rod).bond.any() and all(
        part.drag_rate == 0.0 and math.isclose(motions.window.step * part.speed, part.spacing, rel_tol=EQUAL)
        for part in rod.ranges
    )


def _takes_all(motions: BarMotions) -> bool:
    """Whether absorbing ends reflect nothing: dashpots with the bar's impedance at Courant number 1, see above."""
    return _passes_all(motions) and all(
        math.isclose(dashpot, part.density * part.speed * part.section, rel_tol=EQUAL)
        for dashpot, part in motions.dashpots
    )


def _none(cause: str, words: str, recorded: Motions) -> Cause:
    """A cause that adds nothing."""
    zero = {name: {q: np.zeros(v.shape) for q, v in own.values.items()} for name, own in recorded.items()}
    return Cause(cause, words, zero)


def difference(cause: str, of: Motions, less: Motions, recorded: Motions) -> Cause:
    """A cause that adds the difference of two motions, along the bar, to what is recorded."""
    parts: dict[str, dict[str, np.ndarray]] = {}
    for name, own in recorded.items():
        parts[name] = {quantity: np.zeros(values.shape) for quantity, values in own.values.items()}
        for quantity, error in parts[name].items():
            error[:, 0] = (of[name].values[quantity] - less[name].values[quantity])[:, 0]
    return Cause(cause, HOW, parts, factor=FACTOR)


def not_linear(case: BarCase) -> list[str]:
    """Reasons why no error can be estimated, as the bar is not linear; empty if it is."""
    bar = case.bar
    if any(given.interface == "contact" for given in bar.range):
        return ["bars with contacts, which open and close"]
    if any(given.velocity for given in bar.range):
        return ["bars whose ranges move at the start"]
    if case.method.largest_horizon > WIDEST:
        return [f"bars with a horizon of more than {WIDEST} spacings"]
    return []


def _unknown(case: BarCase, recorded: History, own: History, exact: History) -> str:
    """Why the error at a monitor is unknown: the bar is not linear, or the monitor at rest; empty if it is known."""
    worst, largest = 0.0, largest_motion(case, float(recorded.time[-1]))
    for quantity, values in recorded.values.items():
        seen = values[:, 0]
        size = float(np.linalg.norm(seen))
        if size <= QUIET * largest[quantity] * math.sqrt(len(seen)):
            return "hardly moves"
        rest = float(np.linalg.norm(seen - own.values[quantity][:, 0]))
        error = float(np.linalg.norm(own.values[quantity] - exact.values[quantity]))
        if rest > max(SMALLEST * size, UNEXPLAINED * error):
            worst = max(worst, rest / size)
    return f"its record differs by {percent(worst)} from that of a bar whose bonds stay as they are" if worst else ""


def largest_motion(case: BarCase, last: float) -> dict[str, float]:
    """By quantity the sum of the largest motions that the sources cause up to a time (s)."""
    impedance = max(part.density * part.speed for part in case.bar.parts)
    waves = [case.wave[name].peak() for driven in case.driving.values() for name in driven.values()]
    loads = [abs(load.pressure) * case.wave[load.wave].peak() / impedance for load in case.load]
    velocity = math.fsum([*waves, *loads])
    return {"velocity": velocity, "displacement": velocity * last, "stress": velocity * impedance}
