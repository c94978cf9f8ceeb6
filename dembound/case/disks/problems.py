"""Mistakes that show only when tables are looked at together."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Any

from dembound.boundaries import OPPOSITE, BoundaryTable, Free, Periodic
from dembound.boundaries.driven import Driven
from dembound.boundaries.viscous import Dashpots
from dembound.case.between import repeated_names, steps_too_long, unknown_waves
from dembound.case.disks.free_field_problems import free_field_problems
from dembound.case.disks.hole_problems import hole_problems
from dembound.case.disks.load import Load
from dembound.case.disks.material import Material
from dembound.case.disks.monitor import Monitor
from dembound.case.disks.motion import Motion
from dembound.case.disks.static_problems import static_problems
from dembound.case.sentences import numbered, show
from dembound.packings import PackingTable

DIRECTIONS = {"left": "xy", "right": "xy", "bottom": "yx", "top": "yx"}
"""Side -> the directions along its normal and across it."""


def problems_between(tables: Mapping[str, Any], given: Collection[str]) -> Iterator[str]:
    """Check the tables of a case against each other.

    `tables` has the fields of `Case` as keys. A table that is invalid on its own is None, and so is an
    invalid entry of `boundary`, `wave`, `hole`, `load` or `monitor`: checks that would need it are left out.
    `given` are the keys that the file has, valid or not.
    """
    named = [(f"boundary.{side}.{key}", name) for side, key, name, _ in _drives(tables["boundary"])]
    named += [(f"{place}.wave", load.wave) for place, load in numbered("load", tables["load"]) if load.wave is not None]
    yield from unknown_waves(named, tables["wave"])
    yield from _lonely_periodic_sides(tables["boundary"])
    yield from free_field_problems(tables["boundary"])
    if tables["motion"]:
        yield from _driven_but_held(tables["boundary"], tables["motion"])
        yield from _loaded_but_held(tables["load"], tables["motion"])
        if tables["material"]:
            yield from _nothing_to_match(tables["material"], tables["motion"])
    if tables["packing"]:
        yield from _half_masses_on_rough_sides(tables["boundary"], tables["packing"])
        if tables["material"]:
            yield from _nothing_to_pack_with(tables["material"], tables["packing"])
    for key in ("hole", "load", "monitor"):
        yield from repeated_names(key, tables[key])
    for key in ("load", "monitor"):
        if tables["packing"]:
            yield from _places_outside(key, tables[key], tables["packing"].size)
    yield from hole_problems(tables, "static" in given)
    if tables["material"] and tables["material"].locked_in and "static" not in given:
        yield "material.locked_in: is a stress that is not in equilibrium at cut sides; must come to rest in [static]"
    if tables["static"]:
        yield from static_problems(*(tables[key] for key in ("static", "boundary", "load", "material", "motion")))
    if tables["run"]:
        yield from steps_too_long(tables["run"], tables["output"])


def _drives(boundaries: Mapping[str, BoundaryTable | None]) -> Iterator[tuple[str, str, str, str]]:
    """All that is driven: side, key, name of the wave and direction, x or y."""
    for side, boundary in boundaries.items():
        if isinstance(boundary, Driven):
            for key, direction in zip(("wave_p", "wave_s"), DIRECTIONS[side], strict=True):
                if (name := getattr(boundary, key)) is not None:
                    yield side, key, name, direction


def _lonely_periodic_sides(boundaries: Mapping[str, BoundaryTable | None]) -> Iterator[str]:
    """Periodic sides whose opposite is something else."""
    for side, boundary in boundaries.items():
        opposite = boundaries.get(OPPOSITE[side], Free())
        if isinstance(boundary, Periodic) and opposite and not isinstance(opposite, Periodic):
            yield f'boundary.{side}.type: is "periodic", so boundary.{OPPOSITE[side]} must be periodic too'


def _driven_but_held(boundaries: Mapping[str, BoundaryTable | None], motion: Motion) -> Iterator[str]:
    """Sides driven along a direction in which nothing can move."""
    for side, key, _, direction in _drives(boundaries):
        if direction in motion.held:
            yield f"boundary.{side}.{key}: drives {direction}, which motion.held holds for every particle"


def _loaded_but_held(loads: Sequence[Load | None], motion: Motion) -> Iterator[str]:
    """Loads along a direction in which nothing can move."""
    for place, load in numbered("load", loads):
        for axis in load.axes:
            if "xy"[axis] in motion.held:
                yield f"{place}.{load.key}: acts along {'xy'[axis]}, which motion.held holds for every particle"


def _half_masses_on_rough_sides(boundaries: Mapping[str, BoundaryTable | None], packing: PackingTable) -> Iterator[str]:
    """Sides whose particles are halved though they do not stand in one row."""
    for side, boundary in boundaries.items():
        if isinstance(boundary, Dashpots) and boundary.half_mass and packing.pattern == "B":
            yield f"boundary.{side}.half_mass: is for regular edges, patterns A and C; the packing is B"


def _nothing_to_pack_with(material: Material, packing: PackingTable) -> Iterator[str]:
    """Contacts without stiffness, asked to hold a packing under stress."""
    key = "contact_share" if material.emod is None else "emod"
    if packing.pattern != "A" and getattr(material, key) == 0.0:
        yield f"material.{key}: is 0, but contacts hold pattern {packing.pattern} under stress; must be greater than 0"


def _nothing_to_match(material: Material, motion: Motion) -> Iterator[str]:
    """A wave speed asked of a packing in which no P wave can run."""
    if material.match == "assembly" and {"x", "y"} <= set(motion.held):
        yield 'material.match: is "assembly", but motion.held holds x and y, so the packing has no P-wave speed'


def _places_outside(key: str, tables: Sequence[Load | Monitor | None], size: tuple[float, float]) -> Iterator[str]:
    """Loads or monitors that lie where no particle can be."""
    for place, table in numbered(key, tables):
        for where in ("position", "region"):
            values = getattr(table, where, None) or ()
            if not all(0.0 <= value <= size[i % 2] for i, value in enumerate(values)):
                yield f"{place}.{where}: is {show(values)}, must be in the scene, [0, 0] to {show(size)} (m)"
