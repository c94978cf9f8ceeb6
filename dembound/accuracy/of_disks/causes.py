"""Causes of the error of a case of disks: by formulas, and by companions of larger disks."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache, cached_property

import numpy as np

from dembound.accuracy.of_disks.affordable import require_short
from dembound.accuracy.of_disks.companions import Companions
from dembound.accuracy.of_disks.enlarged import sides_of_pair
from dembound.accuracy.of_disks.measured import (
    errors_of_held_side,
    errors_of_places,
    errors_of_steps,
    is_moved,
    settled_of,
)
from dembound.accuracy.proposal import Watch
from dembound.accuracy.runner import Runner
from dembound.casefile.disks import DiskCase
from dembound.disks.scene import DiskScene, build
from dembound.disks.step_cost import seconds_of
from dembound.errors import DemboundError
from dembound.formulas.cause import MOTIONS, SIDES, STEP, USUAL, Cause, Causes
from dembound.formulas.disks.continuum import causes_of_continuum
from dembound.formulas.disks.dispersion import Dispersion, causes_of_kinks
from dembound.formulas.disks.entry import late_by
from dembound.formulas.disks.held_sides import DrivenSides, HeldSides
from dembound.formulas.disks.near_disks import causes_at_edges, causes_at_surface, causes_near_loads, causes_of_walls
from dembound.formulas.disks.reflections import Reflections
from dembound.formulas.disks.rest import REST, causes_of_rest
from dembound.formulas.history import Motions
from dembound.results.compare import at_times


@dataclass(frozen=True)
class Formulas:
    """The formulas of one scene, which runs at a time step (s); reflections : of its sides."""

    scene: DiskScene
    time_step: float
    reflections: Reflections = field(default_factory=Reflections, repr=False)

    def causes(self, motions: Motions) -> list[Cause]:
        """All causes but absorbing sides without waves; motions : by monitor."""
        scene = self.scene
        return [
            *causes_of_continuum(scene, {name: own.place for name, own in motions.items()}),
            *DrivenSides(scene, self.time_step, self.held_sides, self.reflections).causes(motions),
            *self.dispersion.causes(motions),
            *causes_of_walls(scene, motions),
            *causes_near_loads(scene, motions),
            *causes_at_edges(scene, motions),
            *causes_at_surface(scene, motions),
            *self.held_sides.causes(motions),
        ]

    def without_motion(self, names: Sequence[str]) -> list[Cause]:
        """The causes that do not depend on the motion, at monitors of these names."""
        places = {name: self.scene.monitored[name] for name in names}
        return [*causes_of_continuum(self.scene, places), *causes_of_walls(self.scene, names)]

    @cached_property
    def held_sides(self) -> HeldSides:
        """Sides of the problem itself that hold disks."""
        return HeldSides(self.scene)

    @cached_property
    def dispersion(self) -> Dispersion:
        """Delays of waves by the disks and by the steps."""
        return Dispersion(self.scene, self.time_step)


LEAST_LATE = 1e-4
"""Shift of all motion over the duration of a run from which on it is said."""

PLACES = "places"
"""Cause of errors: monitors and loads at other places than those given."""

MOVED, AT_PLACES = "by the motion between the disks of companions", "monitors and loads are at the places given"
"""How these errors are found, and why there are none."""

HELD = "how much earlier waves come back from disks that are held at their centres: {}"
"""Text on the unknown error of sides that hold disks, with the reason."""

HELD_FACTOR = 1.6
"""Factor of errors of problem sides that hold disks: true errors were 0.54 to 1.47 times as large at 14 monitors of
five scenes with a force, fixed sides and rollers (for a fixed side with 0.64 D in place of D/2 for P and 0.77 D
for S waves)."""

BY_HALF = "by runs with half the step, as contacts open or slide"
"""How errors of the time step are found under laws with a history."""

CONTACTS_FACTOR = 1.8
"""Factor of time-step errors where contacts open or slide, in gravel under weight on a shaken base: true errors of
30 velocities were 0.78 to 2.0 times as large as found by the given disks, one above 1.8, and 0.13 to 2.05 times
as large as found by larger disks, two above 1.8 (lattices and random packings, friction of 0.2 and 0.6)."""


def causes_of_run(
    case: DiskCase,
    recorded: Motions,
    time_step: float,
    work: float,
    most: float,
    watch: Watch | None = None,
    longest: float | None = None,
) -> Causes:
    """The causes of the error of a run, from the far companion's motion if there is one, else from the recorded motion.

    case : to the end of the run. recorded : by monitor. time_step (s), work (particle-steps) : of the run. most :
    particle-steps that companions take, if possible. watch : told of what is done. longest : CPU seconds that they may
    take, if that is more than by default, see `require_short`.
    """
    scene, watch = build(case), watch or Watch()
    companions = Companions(case, scene, time_step, most, Runner(shown=watch.run), Reflections(watch.begins))
    formulas = Formulas(scene, time_step, companions.reflections)

    @cache
    def require() -> None:
        own = seconds_of(scene, case.run.duration / time_step)
        require_short(companions, own, longest, watch, command="dembound estimate ")

    moved = " and ".join(sides_of_pair(case)) if case.monitor else ""
    reason = ""
    if moved and (case.ground.size is not None or case.incident is not None):
        reason = f"of {moved}: beside a continuum no companions are run"
    elif moved:
        _tell(watch, formulas.causes(recorded), scene, recorded)
        try:
            require()
            found = causes_of_choice(companions, scene, time_step, 0.0)
            return found + Causes([], [], entry_notes(scene), companions.runner.work / work)
        except DemboundError as error:
            reason = "; ".join(str(error).splitlines())
    unknown = [Cause.unknown(SIDES, reason)] if reason else []
    known, cost = _of_ground_of_run(companions, formulas, recorded, watch, require)
    return Causes([*unknown, *known], _not_counted(scene), entry_notes(scene), cost / work)


def _tell(watch: Watch, causes: Sequence[Cause], scene: DiskScene, motions: Motions) -> None:
    """Tell of the causes found by formula, before companions are run; motions : by monitor."""
    missing = [SIDES] if sides_of_pair(scene.case) else []
    missing += [f"{side} side" for side in HeldSides(scene).among_others]
    missing += [f"{STEP} where contacts open or slide"] if scene.has_history else []
    if missing:
        watch.knows(causes, motions, f"errors from companions ({', '.join(missing)})")


def _of_ground_of_run(
    companions: Companions, formulas: Formulas, recorded: Motions, watch: Watch, require: Callable[[], None]
) -> tuple[list[Cause], float]:
    """All causes but artificial sides, at the recorded times, and the work (particle-steps) of their companions.

    Companions are needed for monitors and loads that are not at their places, for sides that hold disks, and for
    contacts that open or slide. The causes are those of `ground_causes` but for kinks, which records have. require :
    raises CaseError where companions take too long.
    """
    case, scene, time_step = companions.case, companions.scene, companions.time_step
    known = formulas.causes(recorded)
    sides = HeldSides(scene).among_others
    if not case.monitor:
        return known, 0.0
    at = {name: own.time for name, own in recorded.items()}
    places = _places(companions, scene, at, require)
    if not (sides or scene.has_history):
        return [*known, places], float(companions.runner.work)
    reason = ""
    if case.ground.size is not None or case.incident is not None:
        reason = "beside a continuum no companions are run"
    else:
        _tell(watch, known, scene, recorded)
        try:
            require()
            time = next(iter(companions.far.values())).time
        except DemboundError as error:
            reason = "; ".join(str(error).splitlines())
            if scene.has_history:
                known = _with_steps(known, Cause.unknown(STEP, f"{BY_HALF}: {reason}"))
    if reason:
        unknown = [Cause.unknown(f"{side} side", HELD.format(reason), True) for side in sides]
        return [*known, places, *unknown], float(companions.runner.work)
    known = _with_steps_of_contacts(known, companions, scene, time_step)
    causes = [
        _at_times(cause, time, at) if cause.how == "companion" else cause
        for cause in (*known, *_held(companions, scene))
    ]
    return [*causes, places], float(companions.runner.work)


def _places(
    companions: Companions, scene: DiskScene, at: Mapping[str, np.ndarray], require: Callable[[], None]
) -> Cause:
    """Errors by monitors and loads at other places than those given, at the times (k,) s of each monitor.

    No companion is run where all are at their places.
    """
    if not is_moved(scene):
        return Cause(PLACES, AT_PLACES, {name: dict.fromkeys(MOTIONS, 0.0) for name in at}, of_disks=True)
    try:
        require()
        found, time = errors_of_places(companions, scene), next(iter(companions.far.values())).time
    except DemboundError as error:
        return Cause.unknown(PLACES, "; ".join(str(error).splitlines()), of_disks=True)
    return _at_times(Cause(PLACES, MOVED, found, of_disks=True, factor=USUAL), time, at)


def _at_times(cause: Cause, time: np.ndarray, at: Mapping[str, np.ndarray]) -> Cause:
    """A cause given at times (k,) s, interpolated at the times of each monitor."""
    parts = {
        name: {quantity: at_times(time, np.asarray(part), at[name]) for quantity, part in parts.items()}
        for name, parts in cause.parts.items()
        if name in at
    }
    return replace(cause, parts=parts)


def entry_notes(scene: DiskScene) -> list[str]:
    """Lines on the shift of all motion relative to waves through the planes of sides, which is no error."""
    late = late_by(scene)
    if abs(late) < LEAST_LATE * scene.case.run.duration:
        return []
    shift = f"{abs(late):.2g} s {'later' if late > 0.0 else 'earlier'}"
    return [f"waves enter {shift} than through the plane of their side; errors are without this shift"]


def quick_causes(scene: DiskScene) -> Causes:
    """Causes of errors of a scene; those that need the motion of the monitors are unknown."""
    names = [monitor.name for monitor in scene.case.monitor]
    found = Formulas(scene, math.nan).without_motion(names)
    if sides := sides_of_pair(scene.case):
        found.append(Cause.unknown(SIDES, " and ".join(sides)))
    return Causes(found)


def causes_of_choice(
    companions: Companions, scene: DiskScene, time_step: float, wider: float, ground: Sequence[Cause] | None = None
) -> Causes:
    """The causes of the error of a choice, from the far companion's motion; see `Companions.of_sides`.

    ground : the result of `ground_causes`, if known.
    """
    ground = ground or ground_causes(companions, scene, time_step)
    found = Causes(ground, _not_counted(scene), motions=companions.recorded(scene))
    if sides_of_pair(scene.case):
        sides, missing, notes = sides_cause(companions, scene, time_step, wider), [], []
        if math.isfinite(companions.first_break):
            missing = [f"{SIDES} after {companions.first_break:.3g} s, when bonds break in the companion"]
        if not companions.echo_free:
            notes = [f"{SIDES}: the larger scene, {companions.far_size}, has echoes of its own"]
        found += Causes([sides], missing, notes, 0.0, companions.echo_free)
    return found


def ground_causes(
    companions: Companions, scene: DiskScene, time_step: float, watch: Watch | None = None
) -> list[Cause]:
    """All causes of the error of a choice but artificial sides, which would need companions of its own.

    watch : told of those by formula as soon as they are known.
    """
    motions = companions.recorded(scene)
    places = Cause(PLACES, MOVED, errors_of_places(companions, scene), of_disks=True, factor=USUAL)
    formulas = Formulas(scene, time_step, companions.reflections)
    kinks = causes_of_kinks(formulas.dispersion, motions, companions.diameter)
    known = formulas.causes(motions)
    if watch is not None:
        _tell(watch, known, scene, motions)
    known = _with_steps_of_contacts(known, companions, scene, time_step)
    return [*known, *kinks, places, *_held(companions, scene)]


def rest_causes(companions: Companions, scene: DiskScene) -> Causes:
    """The errors of a choice by its static stage, which ends as that of the given case or its companion."""
    try:
        static = settled_of(companions)
    except DemboundError as error:
        return Causes([Cause.unknown(REST, "; ".join(str(error).splitlines()))])
    return Causes([]) if static is None else causes_of_rest(scene, companions.recorded(scene), static)


def _with_steps_of_contacts(
    causes: list[Cause], companions: Companions, scene: DiskScene, time_step: float
) -> list[Cause]:
    """The causes, with the time step's error from companions where contacts open or slide.

    The formula for the time step holds for elastic contacts only; if a companion cannot run, the error is unknown.
    """
    if not scene.has_history:
        return causes
    try:
        parts = errors_of_steps(companions, scene, time_step)
    except DemboundError as error:
        found = Cause.unknown(STEP, f"{BY_HALF}: {'; '.join(str(error).splitlines())}")
    else:
        if not parts:
            return causes
        found = Cause(STEP, BY_HALF, parts, "companion", factor=CONTACTS_FACTOR, is_sample=True)
    return _with_steps(causes, found)


def _with_steps(causes: Sequence[Cause], steps: Cause) -> list[Cause]:
    """The causes, with another one of the time step."""
    return [steps if cause.name == STEP else cause for cause in causes]


def _held(companions: Companions, scene: DiskScene) -> Iterator[Cause]:
    """Errors of problem sides that hold disks at their centres, under waves from all directions."""
    for side in HeldSides(scene).among_others:
        words = "by companions whose disks are held elsewhere"
        try:
            parts = errors_of_held_side(companions, scene, side)
        except DemboundError as error:
            yield Cause.unknown(f"{side} side", HELD.format("; ".join(str(error).splitlines())), True)
        else:
            yield Cause(f"{side} side", words, parts, "companion", of_disks=True, factor=HELD_FACTOR)


def sides_cause(companions: Companions, scene: DiskScene, time_step: float, wider: float) -> Cause:
    """Errors of absorbing sides; see `Companions.of_sides`."""
    parts = companions.of_sides(scene.case, scene, time_step, wider)
    return Cause(SIDES, companions.words, parts, "companion", factor=USUAL)


def _not_counted(scene: DiskScene) -> list[str]:
    """A line on sides that hold disks at their centres and meet waves whose early return is not counted."""
    held = HeldSides(scene).driven_under_loads
    words = "disks are held at centres, inside of the plane, so that waves of loads come back a little early"
    return [f"{' and '.join(held)}: {words}: not counted"] if held else []
