"""Facts about groups and holes, and supports that let go in the run; a warning about groups beside a free field."""

from collections.abc import Iterator

import numpy as np

from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.group import Group
from dembound.casefile.disks.material import Material
from dembound.disks.scene import DiskScene
from dembound.words import Entries, with_unit


def group_facts(scene: DiskScene) -> Entries:
    """Of every group its disks, its own keys, and from when on they hold."""
    places = scene.positions[scene.column_count : scene.disk_count]
    for group in scene.case.group:
        count = int(np.count_nonzero(group.has(places, scene.case.packing.span)))
        since = "" if group.time is None else f" from t = {group.time:g} s of the run on"
        yield f"group {group.name}", f"{count:,} disks: {', '.join(_keys(group))}{since}"


def _keys(group: Group) -> list[str]:
    """The keys of a group with their values."""
    units = {key: str(Material.described(key)["unit"]) for key in group.own}
    return [
        f"{key} {value if isinstance(value, str) else with_unit(value, unit) if unit == 'Pa' else f'{value:g}'}"
        for (key, value), unit in zip(group.own.items(), units.values(), strict=True)
    ]


def group_warnings(scene: DiskScene) -> Iterator[str]:
    """Friction that reaches a free-field side of ground without bonds, whose column slides by that of the ground."""
    case = scene.case
    if not scene.has_history or all(material.no_bonds is None for material in case.materials):
        return
    for group in case.group:
        given = {key: group.own[key] for key in ("fric", "rr_fric") if key in group.own}
        own = [key for key, value in given.items() if any(getattr(each, key) != value for each in case.materials)]
        reached = [
            f"boundary.{side}"
            for side in case.free_field_sides
            if group.has(scene.edges[side].positions, case.packing.span).any()
        ]
        if own and reached:
            yield (
                f"group.{group.name}.{own[0]}: reaches {' and '.join(reached)}, beyond which the free-field column "
                "slides by the friction of ground without groups; let it end before, or give a [[layer]] its friction"
            )


def hole_facts(case: DiskCase) -> Entries:
    """Shape of every hole, and the stage in which it is made."""
    for hole in case.hole:
        made = {
            "before": "present from the start",
            "after": "excavated once the body has settled",
            "run": f"excavated at t = {hole.time} s of the run",
        }
        yield f"hole {hole.name}", f"{hole.type}, {'shape of the sample' if hole.is_shape else made[hole.stage]}"


def later_facts(case: DiskCase) -> Entries:
    """The supports of the static stage whose reactions end during the run."""
    sides = {} if case.static is None else case.static.boundary
    ends = {side: getattr(table, "until", None) for side, table in sides.items()}
    if found := [f"{side} at t = {until:g} s" for side, until in ends.items() if until is not None]:
        yield "supports let go", ", ".join(found)
