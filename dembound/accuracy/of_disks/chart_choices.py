"""Choices for the chart of a case of disks where neither the command nor the case gives any."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from dembound.accuracy.choice import COARSER, OWN, Named, is_valid, label, valid
from dembound.accuracy.of_disks.arrangements import box_tables, cheapest_box, continuum_beyond, may_be_boxed
from dembound.boundaries import Motion
from dembound.boundaries.boundary import Boundary
from dembound.casefile.disks import DiskCase
from dembound.disks.matching import factors_in, homogenised_beta
from dembound.disks.scene import DiskScene, build

FRACTION = 0.5
"""Factor of the second step fraction."""

EXTENT = ("packing.size", "packing.bricks")
"""Keys of the extent of a scene, which choices keep."""

UNMATCHED = 0.01
"""Relative difference of β from the matched one from which on that is another choice: it reflects half of it."""


def disk_choices(case: DiskCase) -> Named:
    """The case itself, and single changes of it.

    Coarser radii; half the step; matched factors β; each other type for its absorbing sides; the smallest box of disks
    in the ground.
    """
    yield OWN, {}
    for changes in valid(case, (_coarser(case, factor) for factor in COARSER)):
        yield label(case, {key: size for key, size in changes.items() if key not in EXTENT}), changes
    step = "run.safety" if case.run.time_step == "auto" else "run.time_step"
    changes = {step: FRACTION * (case.run.safety if case.run.time_step == "auto" else case.run.time_step)}
    yield label(case, changes), changes
    yield from _matched_factors(case)
    yield from _other_sides(case)


def _coarser(case: DiskCase, factor: float) -> dict[str, Any]:
    """Changes to disks larger by a factor, in the same extent."""
    sizes: dict[str, Any] = {f"packing.{key}": size for key, size in case.packing.scaled(factor).items()}
    if case.packing.bricks is None:
        return sizes
    return sizes | {"packing.size": case.packing.larger(factor)["size"], "packing.bricks": None}


def _matched_factors(case: DiskCase) -> Named:
    """Matched factors β for all sides with other factors, but not for sides where a wave enters, which would change."""
    absorbing = {side: table for side, table in case.boundary.items() if table.factors and table.may_move}
    if not absorbing:
        return
    scene = build(case)
    found = [(side, motion) for side in absorbing for motion in _unmatched(scene, side)]
    sides = " and ".join(dict.fromkeys(side for side, _ in found))
    if found:
        yield f"{sides}, matched β", {f"boundary.{side}.beta_{motion}": "matched" for side, motion in found}


def _unmatched(scene: DiskScene, side: str) -> Iterator[Motion]:
    """Kinds of waves (P, S) for which a side's factor differs from the matched one, nan where the motion is held."""
    for motion, beta in factors_in(scene, side).items():
        matched = homogenised_beta(scene, side, motion)
        if abs(matched - beta) > UNMATCHED * matched:
            yield motion


def _other_sides(case: DiskCase) -> Named:
    """Other types for all absorbing sides without waves, where allowed; types with factors β keep them."""
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
        if {table.type for table in silent.values()} != {name} and is_valid(case, changes):
            yield f"{_listed(silent)} {name}", changes
    yield from _continuum(case, silent, absorbing)
    yield from _box(case)


def _absorbing(case: DiskCase) -> dict[str, Boundary]:
    """The sides that absorb, with waves or without."""
    return {side: table for side, table in case.boundary.items() if table.absorbs}


def _continuum(case: DiskCase, *choices: Mapping[str, Boundary]) -> Named:
    """A continuum beyond the first of several sets of sides that allows one; waves enter as in the case."""
    for sides in choices:
        changes = {f"boundary.{side}": continuum_beyond(table) for side, table in sides.items()}
        if not all(table.is_outside for table in sides.values()) and is_valid(case, changes):
            yield f"{_listed(sides)} outside", changes
            return


def _box(case: DiskCase) -> Named:
    """The smallest box of disks round holes and loads, if it saves much and all monitors may lie around it."""
    if not may_be_boxed(case) or (best := cheapest_box(build(case))) is None:
        return
    tables = box_tables(case, best.box)
    packing = {key: value for key, value in case.packing.given().items() if key != "bricks"} | tables.pop("packing")
    ground = {f"ground.{key}": value for key, value in tables.pop("ground").items()}
    changes = {**ground, "packing": packing, **tables}
    if is_valid(case, changes, build):
        yield "box of {:g} m × {:g} m, outside".format(*packing["size"]), changes


def _listed(names: Iterable[str]) -> str:
    """Names as in "left, right and bottom"."""
    *others, last = names
    return f"{', '.join(others)} and {last}" if others else last


def _factors(given: Mapping[str, Any]) -> dict[str, Any]:
    """The factors β among the keys of a side."""
    return {key: value for key, value in given.items() if key.startswith("beta_")}
