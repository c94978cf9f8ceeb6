"""The tables in the case file of bonded disks, and mistakes between them."""

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Any

from pydantic import TypeAdapter

from dembound.boundaries.boundary import Boundary
from dembound.boundaries.platen import beside_disks
from dembound.casefile.disks.ground import Ground, ground_problems, hole_problems, lowered_in, lowered_problems, reach
from dembound.casefile.disks.group import Group, group_problems
from dembound.casefile.disks.incident import (
    Damping,
    IncidentWave,
    Motion,
    damping_problems,
    incident_problems,
    is_damped,
    motion_problems,
)
from dembound.casefile.disks.joint import joint_problems
from dembound.casefile.disks.joint_sets import JointTable, without_sets
from dembound.casefile.disks.layer import Layer, OutsideTable, completed_by_layers, layer_problems
from dembound.casefile.disks.load import Load, Monitor, pressed_side_problems, rest_problems
from dembound.casefile.disks.material import BOND_KEYS, ROLLING_KEY, Material
from dembound.casefile.disks.model import DiskCase, DiskRun, Reduce
from dembound.casefile.disks.monitor_rows import MonitorTable, without_rows
from dembound.casefile.disks.static import Static, changes, static_problems
from dembound.casefile.disks.surface import surface_problems
from dembound.casefile.disks.targets import law_problems, with_history
from dembound.casefile.disks.unlike import unlike_problems
from dembound.casefile.disks.wall import Wall, wall_problems
from dembound.casefile.messages import corners, numbered, show
from dembound.casefile.model import (
    Schema,
    driving_waves,
    monitor_problems,
    never_estimated,
    run_problems,
    unknown_waves,
)
from dembound.casefile.tables import Chart, Output, Sweep
from dembound.casefile.types import LAWS, BoundaryTable, HoleTable, PackingTable, StaticSide
from dembound.packings.base import Packing
from dembound.places import is_within
from dembound.table import Box


def problems_between(tables: Mapping[str, Any], given: Collection[str]) -> Iterator[str]:
    """Check the tables of a case against each other.

    `tables` has the fields of `Case` as keys. A table that is invalid on its own is None, and so is an
    invalid entry of `boundary`, `wave`, `hole`, `load` or `monitor`: checks that need it are skipped. `given` are the
    keys that the file has, valid or not.
    """
    named = [(f"{place}.wave", load.wave) for place, load in numbered("load", tables["load"]) if load.wave is not None]
    for place, wall in numbered("wall", tables["wall"]):
        named += [(f"{place}.wave_{'xy'[axis]}", name) for axis, name in wall.waves.items()]
    if incident := tables["incident"]:
        named.append(("incident.wave", incident.wave))
        yield from incident_problems(incident, tables)
    yield from unknown_waves([*driving_waves(tables["boundary"]), *named], tables["wave"])
    yield from motion_problems(tables)
    for side, table in tables["boundary"].items():
        yield from table.problems(side, tables) if table else ()
    for side, table in (tables["static"].boundary if tables["static"] else {}).items():
        yield from beside_disks(f"static.boundary.{side}", side, table, tables)
    if tables["motion"]:
        yield from _loaded_but_held(tables["load"], tables["motion"])
        if tables["material"]:
            yield from _nothing_to_match(tables["material"], tables["motion"])
    if tables["packing"]:
        for place, table in _of_ground(tables):
            yield from _nothing_to_pack_with(place, table, tables["packing"])
    yield from monitor_problems(tables)
    yield from pressed_side_problems(numbered("load", tables["load"]), tables)
    yield from layer_problems(tables)
    yield from group_problems(tables)
    ground, packing = tables["ground"], tables["packing"]
    if ground and packing:
        if ground.points:
            yield from surface_problems(ground.points, packing, tables["boundary"])
        yield from ground_problems(ground, packing, tables["boundary"])
        for key in ("load", "monitor"):
            yield from _places_outside(key, tables[key], ground, packing, tables["boundary"])
    yield from hole_problems(tables, "static" in given)
    yield from joint_problems(tables)
    yield from lowered_problems(tables)
    yield from unlike_problems(tables)
    yield from law_problems(tables)
    yield from wall_problems(tables)
    yield from rest_problems(tables)
    if tables["material"] and tables["material"].locked_in and "static" not in given:
        yield "material.locked_in: is a stress that is not in equilibrium at cut sides; must relax in a [static] stage"
    if tables["damping"] and tables["material"]:
        yield from damping_problems(tables)
    if tables["output"] and tables["material"]:
        yield from _no_load_factor(
            tables["output"], tables["material"], tables["load"], "static" in given, damped=is_damped(tables)
        )
        if not (LAWS[tables["material"].law].has_history or tables["output"].load_factor):
            for place, table in _of_ground(tables):
                yield from _no_strength(place, table)
    if tables["material"] and not LAWS[tables["material"].law].rolls:
        allowed = " or ".join(f'"{name}"' for name, law in LAWS.items() if law.rolls)
        for place, table in _of_ground(tables):
            if ROLLING_KEY in table.model_fields_set:
                yield f"{place}.{ROLLING_KEY}: is only allowed with law = {allowed}"
    if tables["static"]:
        settling = (tables[key] for key in ("static", "boundary", "load", "material", "motion"))
        whole = bool(tables["packing"] and tables["ground"])  # else it is not known whether its ground has two heights
        beside = whole and ground.meet is None and not lowered_in(tables)
        yield from static_problems(*settling, has_column=beside, has_walls=bool(tables["wall"]))
    if tables["run"]:
        yield from run_problems(tables)
        yield from _too_late(tables, tables["run"].duration)
    if tables["output"]:
        yield from never_estimated(tables)


def _of_ground(tables: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    """The tables with keys of [material], by their places; [material] is None if it is invalid."""
    yield "material", tables["material"]
    for key in ("layer", "group"):
        yield from numbered(key, tables[key])


def _too_late(tables: Mapping[str, Any], duration: float) -> Iterator[str]:
    """Times after the end of a run of a duration (s)."""
    for place, time in changes(tables["group"], tables["hole"], tables["static"]):
        if time > duration:
            yield f"{place}: is {time:g} s, after the end of the run at {duration:g} s"


def _loaded_but_held(loads: Sequence[Load | None], motion: Motion) -> Iterator[str]:
    """Loads along a direction in which nothing can move."""
    for place, load in numbered("load", loads):
        for axis in load.axes:
            if "xy"[axis] in motion.held:
                yield f"{place}.{load.key}: acts along {'xy'[axis]}, which motion.held holds for every particle"


def _nothing_to_pack_with(place: str, table: Material | Layer | Group | None, packing: Packing) -> Iterator[str]:
    """Contacts without stiffness in a packing that contacts under stress hold together; an invalid table is None."""
    for key in ("contact_share", "emod") if packing.packed_under_stress else ():
        if getattr(table, key, None) == 0.0:
            held = f"contacts hold pattern {packing.pattern} under stress"
            yield f"{place}.{key}: is 0, but {held}; must be greater than 0"


def _no_strength(place: str, table: Material | Layer | Group) -> Iterator[str]:
    """Strengths without effect."""
    for key in BOND_KEYS:
        if key in table.model_fields_set:
            yield f"{place}.{key}: is only allowed with law = {with_history()} or output.load_factor"


def _nothing_to_match(material: Material, motion: Motion) -> Iterator[str]:
    """A given wave speed for a packing in which no P wave can run."""
    if material.match == "assembly" and {"x", "y"} <= set(motion.held):
        yield 'material.match: is "assembly", but motion.held holds x and y, so the packing has no P-wave speed'


def _no_load_factor(
    output: Output, material: Material, loads: Sequence[Load | None], has_static: bool, *, damped: bool
) -> Iterator[str]:
    """A load factor that cannot be computed; has_static : whether there is a static stage; damped : the ground."""
    if not output.load_factor:
        return
    if not LAWS[material.law].is_linear:
        yield f'output.load_factor: is of linear laws, material.law is "{material.law}"; give "elastic"'
    if material.damp > 0.0:
        yield f"output.load_factor: needs material.damp = 0, as local damping is not linear; it is {material.damp:g}"
    if damped:
        yield "output.load_factor: is of undamped ground; leave material.quality_factor out"
    for place, load in numbered("load", loads):
        if load.wave is None and not has_static:
            yield f"output.load_factor: needs a [static] stage, in which the body comes to rest under {place}"


def _places_outside(
    key: str,
    tables: Sequence[Load | Monitor | None],
    ground: Ground,
    packing: Packing,
    boundary: Mapping[str, Boundary | None],
) -> Iterator[str]:
    """Loads or monitors neither in the scene nor in a continuum round it; an invalid side is None."""
    allowed = reach(ground, packing, boundary)
    for place, table in numbered(key, tables):
        for where in ("position", "region"):
            values = getattr(table, where, None) or ()
            corners = zip(values[::2], values[1::2], strict=True)
            if not all(is_within(allowed, corner, packing.span) for corner in corners):
                yield f"{place}.{where}: is {show(values)}, must be {_within(allowed)}"


def _within(box: Box) -> str:
    """The range of places in a box, in words, with the sides beyond which a continuum goes on."""
    if all(map(math.isfinite, box)):
        return f"in the scene, {corners(*box)}"
    left, bottom, right, top = box
    ends = [*_limits("x", left, right), *_limits("y", bottom, top)]
    return f"in the scene or its continuum, {' and '.join(ends)} (m)"


def _limits(name: str, least: float, largest: float) -> list[str]:
    """The limits of a coordinate (m) that are finite."""
    below, above = math.isfinite(least), math.isfinite(largest)
    if below and above:
        return [f"{least:.10g} <= {name} <= {largest:.10g}"]
    return [f"{name} >= {least:.10g}"] * below + [f"{name} <= {largest:.10g}"] * above


def _single_entries(tables: dict[str, Any]) -> tuple[dict[str, Any], list[str]]:
    """The tables with single monitors in place of rows, and single joints in place of sets; and their mistakes."""
    tables, of_rows = without_rows(tables)
    tables, of_sets = without_sets(tables)
    return tables, [*of_rows, *of_sets]


SCHEMA = Schema(
    case=DiskCase,
    noun="disks",
    new="dembound new",
    marks=("packing",),
    tables={
        "ground": TypeAdapter(Ground),
        "packing": TypeAdapter(PackingTable),
        "material": TypeAdapter(Material),
        "damping": TypeAdapter(Damping),
        "motion": TypeAdapter(Motion),
        "outside": TypeAdapter(OutsideTable),
        "reduce": TypeAdapter(Reduce),
        "run": TypeAdapter(DiskRun),
        "output": TypeAdapter(Output),
        "chart": TypeAdapter(Chart),
        "sweep": TypeAdapter(Sweep),
    },
    side=TypeAdapter(BoundaryTable),
    optional={"incident": TypeAdapter(IncidentWave)},
    staged={"static": (TypeAdapter(Static), TypeAdapter(StaticSide))},
    lists={
        "layer": TypeAdapter(Layer),
        "group": TypeAdapter(Group),
        "hole": TypeAdapter(HoleTable),
        "wall": TypeAdapter(Wall),
        "joint": TypeAdapter(JointTable),
        "load": TypeAdapter(Load),
        "monitor": TypeAdapter(MonitorTable),
    },
    problems=problems_between,
    completed=completed_by_layers,
    completing={"material": "layer"},
    expanded=_single_entries,
)
