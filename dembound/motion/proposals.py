"""How long a run and how large a scene its monitors need, from travel times of waves."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from dembound.boundaries import SIDES, is_far, normal_axis
from dembound.motion.kind import Plan
from dembound.motion.paths import Front, Source, plane_needed
from dembound.motion.silence import monitored
from dembound.table import EVERYWHERE
from dembound.words import Entries

GAIN = 0.9
"""Share of the duration, or of a length, down to which there is nothing worth a proposal."""

LATE = 1.02
"""Time that waves take over that of long ones: 20 particles in a wavelength delay its energy by (qa)²/8 = 1.2 %."""

ROUNDING = 1e-9
"""Part of a unit by which a length may fall short of whole units, as lengths are rounded."""

RAYLEIGH = 0.87
"""Speed of surface waves over that of S waves, at least: 0.874 for Poisson's ratio 0, more above."""


@dataclass(frozen=True)
class WaveScene:
    """The scene of a plan as seen by waves.

    sources : where motion starts.
    front : its fastest waves.
    places : (k, 2) m of the monitors; names : theirs.
    axes : axes along which waves run: not those across a bar or across identical rows.
    """

    planned: Plan
    sources: Sequence[Source]
    front: Front
    places: np.ndarray
    names: Sequence[str]
    axes: Sequence[int]

    def of_side(self, side: str) -> list[Source]:
        """The sources whose waves the side may reflect: of free-field sides only local ones."""
        all_of_them = not self.planned.scene.case.side(side).needs_column
        return [source for source in self.sources if all_of_them or source.is_local]


def proposals(planned: Plan) -> Entries:
    """Lines for `dembound check`, by name: only where the monitors need less than the case has, and when echoes come.

    No shorter run is proposed where the end of the motion is not known from wave speeds: with steady loads, waves that
    never end, random packings with their coda, laws and bars that break, and between two sides that both reflect. No
    smaller scene is proposed under steady loads and with a static stage.
    """
    scene = planned.scene
    if not scene.case.monitor or not (sources := planned.kind.sources(scene)):
        return
    across = [axis for axis in (0, 1) if axis in planned.stepped.uniform_axes or scene.size[axis] == 0.0]
    seen = WaveScene(
        planned,
        sources,
        planned.kind.front(scene, planned.time_step),
        monitored(scene),
        [monitor.name for monitor in scene.case.monitor],
        [axis for axis in (0, 1) if axis not in across],
    )
    asked = scene.case.run.duration
    passed = _passed(seen)
    needed = passed if passed is not None and passed < GAIN * asked else asked
    if needed < asked:
        passed_by = f"the slowest waves, and what sides reflect of them, have passed all monitors by {needed:.3g} s"
        yield "shorter run", f"{passed_by}; run.duration is {asked:g} s"
    for name, lines in (("echoes", _echoes(seen, needed)), ("smaller scene", _smaller(seen, needed))):
        if line := "; ".join(lines):
            yield name, line


def _passed(seen: WaveScene) -> float | None:
    """Time (s) by which the waves of all sources have passed all monitors, rounded up; None where it is not known."""
    planned, case = seen.planned, seen.planned.scene.case
    if planned.kind.has_coda(planned.scene) or not all(np.isfinite(source.over) for source in seen.sources):
        return None
    mirrors: dict[int, list[float]] = {axis: [] for axis in seen.axes}
    for side in SIDES:
        table, axis = case.side(side), normal_axis(side)
        if axis in mirrors and not (table.layer or any(factor != 0.0 for factor in table.factors.values())):
            mirrors[axis].append(planned.scene.plane(side))
    if any(len(planes) > 1 for planes in mirrors.values()):
        return None  # periodic sides, too
    at_surface = any(case.side(side).is_free and normal_axis(side) in seen.axes for side in SIDES)
    times = [source.over + LATE * _slowest_way(source, seen, mirrors, at_surface) for source in seen.sources]
    return _rounded_up(max(times))


def _slowest_way(source: Source, seen: WaveScene, mirrors: dict[int, list[float]], at_surface: bool) -> float:
    """Time (s) the slowest waves of a source take to the farthest monitor, also over sides that reflect."""
    gaps = np.zeros((2, len(seen.places)))
    for axis, planes in mirrors.items():
        low, high = source.box[axis], source.box[2 + axis]
        if np.isfinite([low, high]).all():
            at = seen.places[:, axis]
            images = [at, *(2.0 * plane - at for plane in planes)]
            gaps[axis] = np.max([np.maximum(abs(image - low), abs(image - high)) for image in images], axis=0)
    slowest = source.slowest * (RAYLEIGH if source.is_local and at_surface and len(seen.axes) > 1 else 1.0)
    return float(np.hypot(*gaps).max()) / slowest


def _movable(seen: WaveScene) -> Iterator[str]:
    """Artificial sides that may reflect and that no wave drives, of the axes along which waves run."""
    case = seen.planned.scene.case
    for side in SIDES:
        table = case.side(side)
        if table.may_move and not table.absorber and normal_axis(side) in seen.axes:
            yield side


def _echoes(seen: WaveScene, needed: float) -> Iterator[str]:
    """When the first echo of each artificial side comes to a monitor, if within the time needed (s)."""
    for side in _movable(seen):
        plane = seen.planned.scene.plane(side)
        times = [
            source.start + source.distance_over(side, plane, seen.places) / seen.front.speed
            for source in seen.of_side(side)
        ]
        first = np.min(times, axis=0, initial=np.inf) if times else np.full(len(seen.places), np.inf)
        k = int(first.argmin())
        if first[k] < needed:
            kind = seen.planned.scene.case.side(side).type
            yield f"{side} ({kind}) may reflect to {seen.names[k]} from {first[k]:.3g} s on"


def _smaller(seen: WaveScene, needed: float) -> Iterator[str]:
    """Lengths of the scene with which still no echo comes within the time needed (s)."""
    planned = seen.planned
    if planned.kind.has_static_stage(planned.scene) or any(source.box == EVERYWHERE for source in seen.sources):
        return
    unit = planned.kind.unit(planned.scene)
    for axis in seen.axes:
        own = float(planned.scene.size[axis])
        spare = {side: _spare(seen, side, needed, unit[axis]) for side in _movable(seen) if normal_axis(side) == axis}
        smaller = own - sum(spare.values())
        if smaller < GAIN * own:
            nearer = " and ".join(f"{side} {length:g} m nearer" for side, length in spare.items() if length > 0.0)
            yield f"{smaller:g} m instead of {own:g} m along {'xy'[axis]} ({nearer}): no echo before {needed:.3g} s"


def _spare(seen: WaveScene, side: str, needed: float, unit: float) -> float:
    """Length (m), of whole units, by which a side may be nearer; at least one unit beyond all monitors and sources."""
    axis, plane = normal_axis(side), seen.planned.scene.plane(side)
    outwards = 1.0 if is_far(side) else -1.0
    there = plane_needed(side, seen.of_side(side), seen.places, seen.front, needed)
    least = max(outwards * there, *(outwards * value + unit for value in _inside(seen, axis)))
    return unit * max(0.0, float(np.floor((outwards * plane - least) / unit + ROUNDING)))


def _inside(seen: WaveScene, axis: int) -> Iterator[float]:
    """Coordinates (m) of what a smaller scene must contain: monitors and sources."""
    yield from seen.places[:, axis]
    for source in seen.sources:
        yield from (value for value in (source.box[axis], source.box[2 + axis]) if np.isfinite(value))


def _rounded_up(time: float) -> float:
    """A time (s) with two digits, not earlier."""
    unit = 10.0 ** (np.floor(np.log10(time)) - 1) if time > 0.0 else 1.0
    return float(unit * np.ceil(time / unit))
