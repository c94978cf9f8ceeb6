"""How near ground is to failure under its weight: factor of safety by strength reduction, and yield acceleration.

The body settles in its static stage with all strengths divided by F: friction, rolling, tensile strength, cohesion, the
tangent of the bonds' friction angle. F is doubled or halved from 1 until one state stands and one fails, then bisected.
Each trial begins with the body as built, so a case with all strengths doubled has exactly twice the factor. From the
state at full strength a horizontal acceleration of the whole body is raised to each tried value, from the last value at
which it stood, as slowly as all loads of a static stage (`disks.rest.loading`); under the supports of that stage.

**What fails.** A trial fails if it finds no equilibrium: the stage stalls or does not end within `static.max_steps`. Or
by a jump of displacements, however it might end: more than `SHARE` of the disks (`trial.py`) are farther than `JUMP`
diameters, and than `TIMES` the largest elastic displacement, from their places in the elastic state under the same
loads, in which nothing opens, slides or breaks. Beyond half a diameter disks have other neighbours; the second limit is
for soft ground, which settles by diameters. Fewer disks that fall or roll off are no failure, if all others are at rest
by the force ratio of elastic bodies.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from math import atan, degrees, inf, radians, tan
from typing import Any, TypeVar

import numpy as np

from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.load import gravity
from dembound.casefile.disks.material import HISTORY_KEYS, Material
from dembound.casefile.disks.static import can_break
from dembound.casefile.disks.targets import with_history
from dembound.casefile.reader import parsed
from dembound.casefile.types import LAWS, linear_law
from dembound.disks.rest.settled import Settled
from dembound.disks.rest.stage import require_stages, settle, settle_on
from dembound.disks.scene import DiskScene
from dembound.errors import CaseError
from dembound.kinds import kind_of, with_changes
from dembound.motion.kind import OnLook, StalledError
from dembound.motion.state import Arrays
from dembound.studies.strength.trial import NO_REST, Places, Tried
from dembound.table import Table

GRAVITY = 9.81
"""m/s², the unit of accelerations in results."""

FACTORS, PUSHES = (1.0, 1.0 / 64.0, 64.0), (0.25, 1.0 / 128.0, 8.0)
"""First, least and largest value that is tried: of F, and of horizontal accelerations over `GRAVITY`."""

WEAK = " ".join(f"--set material.{each}" for each in ("law=linearpbond", "pb_ten=1e5", "pb_coh=1e5", "pb_fa=30"))
"""Example of what a case whose bonds do not break needs: the law, two strengths (Pa) and an angle (degrees)."""

LEAST_TOLERANCE = 1e-4
"""Smallest relative width of a bracket: dozens of trials."""


@dataclass
class Search:
    """The states tried for one number.

    name, unit : of the number. stands, fails : the largest value that stands and the least that fails, without sign; 0
    or infinite if none does.
    """

    name: str
    unit: str
    tried: list[Tried] = field(default_factory=list)
    stands: float = 0.0
    fails: float = inf

    @property
    def value(self) -> float:
        """The middle of the bracket, infinite if nothing fails."""
        return 0.5 * (self.stands + self.fails)

    def bisect(self, attempt: Callable[[float], Tried], limits: tuple[float, float, float], within: float) -> None:
        """Bracket the number by doubling or halving the first of the `limits`, then bisect to a relative width."""
        value, least, most = limits
        while least <= value <= most and (self.fails == inf or self.fails - self.stands > within * self.value):
            self.tried.append(attempt(value))
            if self.tried[-1].stands:
                self.stands = value
            else:
                self.fails = value
            value = 2.0 * value if self.fails == inf else 0.5 * (self.stands + self.fails)


@dataclass
class Strength:
    """The searches of a case, the first one for the factor of safety, and what is to be known of them, in words."""

    searches: list[Search]
    words: list[str]

    @property
    def holds(self) -> bool:
        """Whether the body stands at full strength."""
        return self.searches[0].tried[0].stands

    @property
    def rows(self) -> Iterator[list[Any]]:
        """A head, and a row for each state that was tried."""
        yield ["search", "value", "unit", "stands", "ended by", "moved (m)", "disks moved", "broken bonds", "steps"]
        for search in self.searches:
            for each in search.tried:
                numbers = each.moved, each.left, each.broken, each.steps
                yield [search.name, each.value, search.unit, "yes" if each.stands else "no", each.ended, *numbers]


T = TypeVar("T", bound=Table)

STRENGTHS = ("fric", "rr_fric", "ten", "coh", "pb_ten", "pb_coh", "pb_fa")
"""Keys of [material], layers, joints and groups that are strengths."""

ANGLES = ("pb_fa", "dilation")
"""Keys of angles whose tangents are divided: of friction, and of dilation, which must stay below it."""


def weaker(case: DiskCase, factor: float) -> DiskCase:
    """The case with all strengths, of [material], layers, joints and groups, divided by a factor."""

    def divided(table: T) -> T:
        given = {key: getattr(table, key, None) for key in STRENGTHS}
        changes = {key: value / factor for key, value in given.items() if value}
        angles = {key: getattr(table, key, None) for key in ANGLES}
        changes |= {key: degrees(atan(tan(radians(angle)) / factor)) for key, angle in angles.items() if angle}
        return table.model_copy(update=changes)

    layers, joints = tuple(map(divided, case.layer)), tuple(map(divided, case.joint))
    groups = tuple(map(divided, case.group))
    return replace(case, material=divided(case.material), layer=layers, joint=joints, group=groups)


def require_strengths(case: DiskCase) -> None:
    """Raise CaseError for a case without weight, without a static stage, or in which nothing breaks or slides."""
    problems, law = [], LAWS[case.material.law]
    if not law.has_history:
        said = f'is "{law.name}", under which nothing breaks or slides'
        needed = f"--strength needs {with_history()} and strengths, {WEAK}"
        problems.append(f"material.law: {said}; {needed}")
    elif not can_break(case.all_materials) and not any(each.fric > 0.0 for each in case.all_materials):
        problems.append("material.fric: is 0, and bonds have no strength; --strength needs fric, pb_ten or pb_coh")
    if case.static is None:
        problems.append("static: is missing; --strength brings the body to rest under its weight")
    if not any(gravity(case.load)):
        advice = "give a [[load]] with acceleration = [0.0, -9.81] and no wave"
        problems.append(f"load: has no weight, which --strength needs; {advice}")
    if problems:
        raise CaseError(problems)


def measure(
    case: DiskCase, tolerance: float = 0.02, begins: Callable[[str], None] | None = None, on_look: OnLook | None = None
) -> Strength:
    """Factor of safety of a case, and its yield accelerations to both sides if it stands at full strength.

    tolerance : relative width of the brackets. begins : is told the name of each trial. on_look : of its progress.

    Raises CaseError for a tolerance below `LEAST_TOLERANCE` or above 1, and as `require_strengths`; the errors of
    building a scene; RunError if the motion grows without bound.
    """
    if not LEAST_TOLERANCE <= tolerance <= 1.0:
        raise CaseError([f"--tolerance: is {tolerance:g}, must be from {LEAST_TOLERANCE:g} to 1"])
    require_strengths(case)
    ground = _Ground(case, begins or (lambda name: None), on_look)
    safety = Search("factor of safety", "1")
    safety.bisect(ground.weakened, FACTORS, tolerance)
    found = Strength([safety], ground.words)
    if why_not := "the body does not stand at full strength" if not found.holds else ground.refused:
        ground.words.append(f"no yield acceleration: {why_not}")
    else:
        for name, sign in (("to the right", 1.0), ("to the left", -1.0)):
            search = Search(f"yield acceleration {name}", "g")
            ground.begin_push(sign)
            search.bisect(ground.pushed, PUSHES, tolerance)
            found.searches.append(search)
    ground.words += _no_rest(found.searches)
    return found


class _Ground:
    """A case whose states are tried.

    Attributes
    ----------
    words : what is to be known, in sentences. refused : why it cannot be pushed; empty if it can.
    """

    def __init__(self, case: DiskCase, begins: Callable[[str], None], on_look: OnLook | None) -> None:
        self._case, self._begins, self._on_look = case, begins, on_look
        self.words, self.refused = list(_about(self._build(case))), ""
        self._elastic = self._along = self._elastic_state(case, "elastic state")
        self._rest: tuple[Arrays, int] = ({}, 0)
        self._now: tuple[Arrays, int] = ({}, 0)
        self._sign = 1.0
        try:
            pushed = self._under(GRAVITY)
            require_stages(self._build(pushed))
        except CaseError as error:
            self.refused = error.problems[0]
            return
        self.refused = "motion.held holds the body along x" if "x" in case.motion.held else ""
        if not self.refused:
            self._along = self._elastic_state(pushed, "elastic state under a push") - self._elastic

    def weakened(self, factor: float) -> Tried:
        """Settle the body as built with strengths divided by a factor."""
        self._begins(f"strengths divided by {factor:.4g}")
        scene = self._build(weaker(self._case, factor))
        places = Places(scene, self._elastic)
        try:
            settled = settle(scene, self._on_look, places)
        except StalledError as error:
            if factor == 1.0:
                self.refused = "single disks go on falling at full strength, so there is no state to push"
            return places.stalled(factor, 0, error)
        found = places.settled(factor, 0, settled)
        if factor == 1.0:
            self._rest = settled.saved_arrays(), found.broken
        return found

    def begin_push(self, sign: float) -> None:
        """Go back to the state at full strength, to be pushed along x in the direction of a sign."""
        self._now, self._sign = self._rest, sign

    def pushed(self, share: float) -> Tried:
        """Push the body from the last state in which it stood, up to a share of `GRAVITY`."""
        share *= self._sign
        self._begins(f"pushed by {share:+.4g} g")
        scene = self._build(self._under(share * GRAVITY))
        places = Places(scene, self._elastic + share * self._along)
        arrays, broken = self._now
        try:
            settled = settle_on(scene, Settled.restored(scene, arrays).start, self._on_look, places)
        except StalledError as error:
            return places.stalled(share, broken, error)
        found = places.settled(share, broken, settled)
        if found.stands:
            self._now = settled.saved_arrays(), found.broken
        return found

    def _under(self, push: float) -> DiskCase:
        """The case under an acceleration (m/s²) along x of all particles, beside its own loads."""
        loads = parsed(self._case.text)["load"]
        names = {each["name"] for each in loads}
        name = next(each for each in ("push", *(f"push_{k}" for k in range(len(names) + 1))) if each not in names)
        return with_changes(self._case, {"load": [*loads, {"name": name, "acceleration": [push, 0.0]}]})

    def _build(self, case: DiskCase) -> DiskScene:
        scene: DiskScene = kind_of(case).build(case)
        return scene

    def _elastic_state(self, case: DiskCase, name: str) -> np.ndarray:
        """Displacements (2, m) m of the body's disks in the elastic state; zero where there is none."""
        self._begins(name)
        scene = self._build(case)
        if LAWS[case.material.law].starts_elastic:
            given = {key: value for key, value in case.material.given().items() if key not in HISTORY_KEYS}
            material = Material(**given | {"law": linear_law(case.material.law)})
            try:
                settled = settle(self._build(replace(case, material=material)), self._on_look)
                return settled.start.displacement[:2, scene.parts["body"]]
            except StalledError:
                pass
        said = "displacements count from the body as built, which has no elastic state at rest"
        self.words += [said] if said not in self.words else []
        return np.zeros((2, scene.disk_count - scene.column_count))


def _about(scene: DiskScene) -> Iterator[str]:
    """The size of a scene, and what holds it and is not reduced."""
    yield f"{scene.size[0]:.4g} m × {scene.size[1]:.4g} m, {scene.disk_count:,} disks"
    if scene.case.intact:
        yield f"bonds beside {' and '.join(scene.case.intact)} do not break (intact), nor are they reduced"
    if later := [group.name for group in scene.case.group if group.time is not None]:
        yield f"group {' and '.join(later)} is as before its time, of the run; leave time out for the state after it"
    static = scene.case.static
    sides = static.boundary if static is not None else {}
    if holding := [side for side in ("left", "right") if side in sides and 0 in sides[side].prescribed(0)]:
        yield f"{' and '.join(holding)} hold the body along x in the static stage, and bear a part of the push"


def _no_rest(searches: Sequence[Search]) -> Iterator[str]:
    """Brackets that end with a state without rest in which a few disks alone moved away."""
    for search in searches:
        last = next((each for each in search.tried if abs(each.value) == search.fails), None)
        if last is not None and last.ended == NO_REST and last.left > 0 and not last.has_jumped:
            left = f"only {last.left:,} disks have left their places; the body may stand without these"
            yield f"{search.name}: no rest at {last.value:.4g}, but {left}"
