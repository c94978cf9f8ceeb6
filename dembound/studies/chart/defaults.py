"""The choices of a chart where neither the command nor the case gives any."""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from itertools import islice
from typing import Any, get_args

from dembound.boundaries import Motion
from dembound.boundaries.boundary import Boundary
from dembound.casefile import Case
from dembound.casefile.bar import BarCase
from dembound.casefile.disks import DiskCase
from dembound.disks.matching import factors_in, homogenised_beta
from dembound.disks.scene import DiskScene, build
from dembound.disks.smallest_box import box_tables, cheapest_box, may_be_boxed
from dembound.errors import CaseError
from dembound.kinds import with_changes
from dembound.methods import FiniteDifference, Method, Patch, Peridynamics, Switch
from dembound.studies.words import label

COARSER = (1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 10.0)
"""Factors tried for radii and spacings; those that do not divide the scene into whole bricks or cells are left out."""

FEW = 2
"""Number of coarser radii or spacings."""

FRACTION = 0.5
"""Factor of the second step fraction."""

UNMATCHED = 0.01
"""Relative difference of β from the matched one from which on that is another choice: it reflects half of it."""

HORIZON = 3
"""Horizon of bars' methods where the case has none."""

STEP_KEYS = ("time_step", "safety", "courant")
"""Keys of ``[run]`` that determine the step of a bar."""

OWN = "as in the case"


Named = Iterator[tuple[str, dict[str, Any]]]
"""Names of choices, and the keys they change."""


def defaults(case: Case) -> dict[str, dict[str, Any]]:
    """Changes of keys by the name of the choice.

    The case itself. Of disks: coarser radii; half the step; matched factors β; for its absorbing sides each other
    type; and the smallest box of disks in the ground, one change at a time. Of a bar: every method with every spacing,
    each at its automatic step, and finite differences at ν = 1.
    """
    return dict(_of_bar(case) if isinstance(case, BarCase) else _of_disks(case))


def _of_disks(case: Case) -> Named:
    """Choices of a case of disks."""
    assert isinstance(case, DiskCase)
    yield OWN, {}
    radii = {f"packing.{key}": size for key, size in case.packing.given().items() if key.endswith("radius")}
    for changes in _valid(case, ({key: factor * size for key, size in radii.items()} for factor in COARSER)):
        yield label(case, changes), changes
    step = "run.safety" if case.run.time_step == "auto" else "run.time_step"
    changes = {step: FRACTION * (case.run.safety if case.run.time_step == "auto" else case.run.time_step)}
    yield label(case, changes), changes
    yield from _matched_factors(case)
    yield from _other_sides(case)


def _matched_factors(case: DiskCase) -> Named:
    """Matched factors β for all sides that have others; where a wave enters, it would change."""
    absorbing = {side: table for side, table in case.boundary.items() if table.factors and not table.waves}
    if not absorbing:
        return
    scene = build(case)
    found = [(side, motion) for side in absorbing for motion in _unmatched(scene, side)]
    sides = " and ".join(dict.fromkeys(side for side, _ in found))
    if found:
        yield f"{sides}, matched β", {f"boundary.{side}.beta_{motion}": "matched" for side, motion in found}


def _unmatched(scene: DiskScene, side: str) -> Iterator[Motion]:
    """Kinds of waves whose factor of a side differs from the matched one, which is nan where the motion is held."""
    for motion, beta in factors_in(scene, side).items():
        matched = homogenised_beta(scene, side, motion)
        if abs(matched - beta) > UNMATCHED * matched:
            yield motion


def _other_sides(case: DiskCase) -> Named:
    """Other types for all sides that absorb without a wave, if they may have them; those with factors β keep them."""
    absorbing = _absorbing(case)
    silent = {side: table for side, table in absorbing.items() if not table.waves}
    tables: dict[str, dict[str, Any]] = {
        "viscous": {},
        "viscoelastic": {"distance": 0.5 * max(case.packing.extent)},
        "free": {},
    }
    for name, extra in tables.items() if silent else ():
        keeps = name in ("viscous", "viscoelastic")
        changes: dict[str, Any] = {
            f"boundary.{side}": {"type": name, **extra} | (_factors(table.given()) if keeps else {})
            for side, table in silent.items()
        }
        if {table.type for table in silent.values()} != {name} and _is_valid(case, changes):
            yield f"{_listed(silent)} {name}", changes
    yield from _continuum(case, silent, absorbing)
    yield from _box(case)


def _absorbing(case: DiskCase) -> dict[str, Boundary]:
    """The sides that absorb, with waves or without."""
    return {side: table for side, table in case.boundary.items() if table.factors or table.is_outside}


def _continuum(case: DiskCase, *choices: Mapping[str, Boundary]) -> Named:
    """A continuum beyond the first of these sides beyond which the case may have one; waves enter as in the case."""
    for sides in choices:
        changes = {f"boundary.{side}": _beyond(table) for side, table in sides.items()}
        if not all(table.is_outside for table in sides.values()) and _is_valid(case, changes):
            yield f"{_listed(sides)} outside", changes
            return


def _box(case: DiskCase) -> Named:
    """The smallest box of disks round holes and loads, if that saves much and all monitors may be around it."""
    if not may_be_boxed(case) or (best := cheapest_box(build(case))) is None:
        return
    tables = box_tables(case, best.box)
    packing = {key: value for key, value in case.packing.given().items() if key != "bricks"} | tables.pop("packing")
    changes = {"ground.size": tables.pop("ground")["size"], "packing": packing, **tables}
    if _is_valid(case, changes, build):
        yield "box of {:g} m × {:g} m, outside".format(*packing["size"]), changes


def _beyond(table: Boundary) -> dict[str, Any]:
    """The table of a side with a continuum, through which the waves of this one enter."""
    return {"type": "outside"} | {f"wave_{motion}": name for motion, name in table.waves.items()}


def _listed(names: Iterable[str]) -> str:
    """Names as in "left, right and bottom"."""
    *others, last = names
    return f"{', '.join(others)} and {last}" if others else last


def _factors(given: Mapping[str, Any]) -> dict[str, Any]:
    """The factors β among the keys of a side."""
    return {key: value for key, value in given.items() if key.startswith("beta_")}


def _of_bar(case: BarCase) -> Named:
    """Choices of the case of a bar; a given step, which would suit one method and spacing only, becomes automatic."""
    yield OWN, {}
    spacing, run = case.bar.spacing, case.run.given()
    coarser = [change["bar.spacing"] for change in _valid(case, ({"bar.spacing": k * spacing} for k in COARSER))]
    automatic = {key: value for key, value in run.items() if key not in ("time_step", "courant") or value == "auto"}
    exact = {key: value for key, value in run.items() if key not in STEP_KEYS} | {"courant": 1.0}
    differences = _method(case, FiniteDifference)
    for size in (spacing, *coarser):
        name = label(case, {"bar.spacing": size, "method": differences, "run.courant": 1.0})
        yield name, {"bar.spacing": size, "method": differences, "run": exact}
        for method in _methods(case):
            changes = {"bar.spacing": size, "method": method}
            yield label(case, changes), changes | ({} if automatic == run else {"run": automatic})


def _methods(case: BarCase) -> Iterator[dict[str, Any]]:
    """The methods, the case's own first if it is another package's; those that wait for a break if it can break."""
    kinds: list[type[Method]] = [FiniteDifference, Peridynamics]
    if case.bar.least_strength < math.inf:
        kinds += [Switch, Patch]
    if type(case.method) not in kinds:
        yield case.method.given()
    yield from (_method(case, kind) for kind in kinds)


def _method(case: BarCase, kind: type[Method]) -> dict[str, Any]:
    """The table of a method, with all keys of the case's own method that it has, too."""
    (name,) = get_args(kind.model_fields["type"].annotation)
    horizon = {"horizon": max(case.method.largest_horizon, HORIZON)} if "horizon" in kind.model_fields else {}
    own = {key: value for key, value in case.method.given().items() if key in kind.model_fields and key != "type"}
    return {"type": name} | horizon | own


def _valid(case: Case, changes: Iterator[dict[str, Any]]) -> Iterator[dict[str, Any]]:
    """The first few of these changes that make valid cases."""
    return islice((change for change in changes if _is_valid(case, change)), FEW)


def _is_valid(case: Case, changes: Mapping[str, Any], use: Callable[[Any], object] = bool) -> bool:
    """Whether the changed case has no mistake; nor has it one that only its use, such as `build`, finds."""
    try:
        use(with_changes(case, changes))
    except CaseError:
        return False
    return True
