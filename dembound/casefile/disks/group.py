"""The ``[[group]]`` tables: disks of a part of the ground with their own contacts and bonds, and their mistakes."""

from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from pydantic import ValidationError

from dembound.casefile.disks.layer import OF_PARTS, Differing, problems_of_material, with_keys_of_material
from dembound.casefile.disks.material import Material
from dembound.casefile.disks.stiffness import RATIO_KEYS, STIFFNESS_KEYS
from dembound.casefile.disks.targets import with_history
from dembound.casefile.messages import corners, numbered
from dembound.casefile.types import LAWS
from dembound.holes import Polygon, Rectangle
from dembound.holes.polygon import Points
from dembound.places import includes
from dembound.table import Box, FileName, quantity

MODULI = (*STIFFNESS_KEYS, "plane", "along", *RATIO_KEYS)
"""Keys of a group that give it other springs."""

IN_TIME = ("fric", "rr_fric", "pb_ten", "pb_coh", "pb_fa")
"""Keys of a group that may change during a run."""

APART = 4.0
"""Least distance, in diameters of the disks, of other springs from a side beyond which the ground goes on."""

MOST = 32
"""Largest number of groups."""


class GroupTable(Differing):
    """The disks of a part of the ground, with strengths, friction or moduli of their own.

    Absent keys are those of the ground there; of groups that overlap, those of the later one hold.
    """

    name: FileName = quantity()
    """name in messages and pictures"""
    region: Box | None = quantity(None, unit="m", means="place")
    """rectangle [x0, y0, x1, y1] of its disks; or points"""
    points: Points | None = quantity(None, unit="m", means="place")
    """corners [[x, y], …] of a polygon; or region"""
    time: float | None = quantity(None, unit="s", ge=0.0)
    """time of the run from which on its friction and strengths hold; absent: always"""

    def mistakes(self) -> Iterator[str]:
        """Not one place, nothing that differs, or keys that cannot change in time."""
        if self.region is None and self.points is None:
            yield "region: is missing; give either region or points"
        if self.region is not None and self.points is not None:
            yield "points: is not allowed together with region"
        if self.region is not None and not (self.region[0] < self.region[2] and self.region[1] < self.region[3]):
            yield "region: must have x0 < x1 and y0 < y1, in the order x0, y0, x1, y1"
        if self.points is not None and len(self.points) < 3:
            yield f"points: has {len(self.points)}, must have at least three"
        if not self.own:
            yield "pb_ten: is missing, and any other key of the ground; a group must differ from it"
        if self.time is not None and (fixed := [key for key in self.own if key not in IN_TIME]):
            yield f"{fixed[0]}: cannot change in a run; leave time out, or give {', '.join(IN_TIME)} alone"

    @cached_property
    def shape(self) -> Polygon | Rectangle:
        """Its outline."""
        if self.region is not None:
            return Rectangle(type="rectangle", name=self.name, corners=self.region)
        return Polygon(type="polygon", name=self.name, points=self.points or ())

    def has(self, positions: np.ndarray, span: float) -> np.ndarray:
        """Mask (k,) of positions (k, 2) m in it or on its outline; span : size of the scene, m."""
        return includes(self.shape.depth(positions), span)

    @property
    def is_stiff(self) -> bool:
        """Whether its springs are its own."""
        return not self.own.keys().isdisjoint(MODULI)


if TYPE_CHECKING:
    Group = GroupTable
else:
    Group = with_keys_of_material(GroupTable, "Group", OF_PARTS)


def group_problems(tables: Mapping[str, Any]) -> Iterator[str]:
    """Check the groups with all other tables; a table, or an entry, that is invalid on its own is None."""
    groups, material = dict(numbered("group", tables["group"])), tables["material"]
    if len(tables["group"]) > MOST:
        yield f"group: there are {len(tables['group'])}, must be at most {MOST}"
    if not (groups and material):
        return
    law = LAWS[material.law]
    for place, group in groups.items():
        if not (law.is_linear or (law.has_history and law.starts_elastic)):
            yield f'{place}: is for contacts whose stiffness does not change; not for material.law = "{law.name}"'
        if group.time is not None and not law.has_history:
            yield f"{place}.time: is of what breaks and slides, which needs law = {with_history()}"
        for beside in _materials(tables["layer"], material):
            found = [*problems_of_material(place, group, beside)]
            yield from found or _of_springs(place, group, group.merged(beside), beside)
        if group.is_stiff:
            yield from _stiff_beside(place, group, tables)
        if tables["packing"]:
            x0, y0, x1, y1 = group.shape.box
            left, bottom, right, top = tables["packing"].box
            if x1 < left or y1 < bottom or x0 > right or y0 > top:
                yield f"{place}: lies outside the disks, {corners(*tables['packing'].box)}"


def _materials(layers: Sequence[Any], material: Material) -> list[Material]:
    """The valid materials of the layers, without layers [material]."""
    found = []
    for layer in filter(None, layers):
        try:
            found.append(layer.merged(material))
        except ValidationError:
            continue
    return found if layers else [material]


def _of_springs(place: str, group: Group, own: Material, beside: Material) -> Iterator[str]:
    """A friction that gives contacts a shear stiffness, or takes it, and a change of it in time."""
    if "fric" in group.own and (own.fric > 0.0) != (beside.fric > 0.0) and not group.is_stiff:
        yield (
            f"{place}.fric: is {own.fric:g}, and {beside.fric:g} in the ground beside it: without friction contacts "
            "have no shear stiffness; give both some, such as 1e-6"
        )


def _stiff_beside(place: str, group: Group, tables: Mapping[str, Any]) -> Iterator[str]:
    """Other springs where something else stands for the ground of [material]."""
    key = next(key for key in group.own if key in MODULI)
    for what in ("joint", "incident"):
        if tables[what]:
            yield f"{place}.{key}: other springs are not known beside {what}; give strengths and friction alone"
    if any(table and table.quality_factor is not None for table in (tables["material"], *tables["layer"])):
        yield f"{place}.{key}: other springs are for undamped ground; leave quality_factor out"
    if not tables["packing"]:
        return
    packing = tables["packing"]
    least, ends = APART * 2.0 * packing.radius, zip(group.shape.box, packing.box, (1, 1, -1, -1), strict=True)
    away = dict(zip(("left", "bottom", "right", "top"), ((own - end) * way for own, end, way in ends), strict=True))
    for side, table in tables["boundary"].items():
        if table and (table.absorbs or table.needs_column or table.is_outside) and away[side] < least * (1.0 - 1e-9):
            yield (
                f"{place}.{key}: comes within {away[side]:.3g} m of the {side} side, which is of the ground of "
                f"[material]; must be {APART:g} diameters of the disks, {least:.3g} m, away, or give strengths alone"
            )
