"""The mesh of the continuum round a body: sizes of elements, and where it begins and ends at free surfaces."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from dembound.boundaries.edge import SIDES, is_far, normal_axis
from dembound.casefile.disks import DiskCase
from dembound.continuum.axis import WHOLE, Around, divided
from dembound.continuum.layer import LONG_WAVES
from dembound.continuum.mesh import Mesh
from dembound.disks.material.free_surface import inset
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.surroundings.edges import ON_IT
from dembound.disks.surroundings.elements import mesh_of
from dembound.disks.surroundings.media import medium_of
from dembound.disks.surroundings.settings import Settings, least_element, settings_of
from dembound.errors import CaseError
from dembound.holes.hole import Floor
from dembound.packings.tiling import Assembly
from dembound.table import Box

NARROW = 2.0
"""Width, in elements, up to which waves only run straight away from a periodic body."""

NO_FLOORS: Mapping[str, Floor] = MappingProxyType({})


class ElementSizes(NamedTuple):
    """Sizes of the elements round a body.

    From a body that is periodic and narrow, no wider than `NARROW` elements or half of the shortest wave, waves run
    straight away only: one element is as wide as it, and ties have its mean motion. If the body is narrower than the
    smallest useful element, the continuum is as wide as this, and less thick in proportion. Such a continuum is small,
    so that its elements may be up to half as high.

    settings : of the continuum. box : (2,) m, size of the body in the continuum. element : largest width and height, m.
    narrow : along x and y.
    """

    settings: Settings
    box: np.ndarray
    element: tuple[float, float]
    narrow: tuple[bool, bool]

    @classmethod
    def of(
        cls, case: DiskCase, ground: PackedMaterial, body: Assembly, sides: Sequence[str], periodic: tuple[bool, bool]
    ) -> ElementSizes:
        """Sizes of the elements of a body with a continuum beyond some sides.

        Raises CaseError if no size is given and nothing in the case makes waves.
        """
        diameter, extent = ground.brick.mean_diameter, mass_extent(ground, body)
        settings = settings_of(case, medium_of(ground), diameter, box_of(body), sides)
        largest, least = settings.element, least_element(case, diameter)
        narrow = np.array(periodic) & (extent <= max(NARROW * largest, least) * (1.0 + WHOLE))
        if narrow.any():
            settings = settings._replace(absorption=replace(settings.absorption, shift=LONG_WAVES))
            if not case.outside.element:  # lower ones would only shorten the step
                settings = settings._replace(element=_below_column(largest, least))
        box = np.where(narrow, np.maximum(extent, least), extent)
        each = settings.sides(*box.tolist()) if not any(periodic) else [settings.side(side) for side in box.tolist()]
        width, height = (side if one else own for side, own, one in zip(box.tolist(), each, narrow, strict=True))
        across, up = narrow.tolist()
        return cls(settings, box, (width, height), (across, up))


class Level(NamedTuple):
    """The ground beyond a side that is lower than the disks.

    floor : height y of the hole's floor, m. height : floor with tolerance for rounding, m: disks beyond with centres
    below it exist. mass_end, surface : heights at which the mass of the packing and its continuum end, m.
    """

    floor: float
    height: float
    mass_end: float
    surface: float

    @classmethod
    def of(cls, ground: PackedMaterial, body: Assembly, floor: Floor, side: str) -> Level:
        """The level beyond a side of a body in front of a floor; disks of the body that remain on it count as below."""
        near, rounding = float(np.abs(ground.brick.vectors[:, 0]).max()), ON_IT * ground.brick.mean_diameter
        x, y = body.positions.T
        highest = float(y[x < x.min() + near if side == "left" else x > x.max() - near].max())
        height = floor.height + float(np.copysign(rounding, highest - floor.height + rounding))
        mass_end, surface = ground.at(floor.height - near).cut(height - float(body.origin[1]))
        return cls(floor.height, height, height + mass_end, height + surface)


class Rim(NamedTuple):
    """Where the continuum round a body begins, and where it ends at free surfaces.

    Beyond tied sides it begins where the mass of the packing ends (`Brick.mass_offset`). Free edges lie deeper than
    those of the body by the depth of the packing's skin there, and bear the mass beyond them.

    box : left, bottom, right and top of the cut-out for the body, m. surface : height of the free surface above a body
    in the ground, m; None: the body reaches up to the ground's end. skins : depth (m) of free edges below those of the
    packing, by side. massless : depth of free edges below the end of the mass, by side. levels : lower ground beyond
    left and right sides.
    """

    box: Box
    surface: float | None
    skins: dict[str, float]
    massless: dict[str, float]
    levels: dict[str, Level]

    @classmethod
    def of(
        cls,
        case: DiskCase,
        ground: PackedMaterial,
        body: Assembly,
        sides: Sequence[str],
        size: ElementSizes,
        floors: Mapping[str, Floor],
    ) -> Rim:
        """The rim of a body with a continuum beyond some sides, and with floors at its left and right side.

        Raises CaseError if no element of the least useful height fits between a body and the surface above it.
        """
        low = body.origin + ground.brick.mass_offset
        mass = [*low.tolist(), *(low + size.box).tolist()]
        rim, box, skins, massless = box_of(body), [*mass], {}, {}
        for side in SIDES:
            continues = any(normal_axis(each) != normal_axis(side) for each in sides)  # along the continuum there
            if case.side(side).is_free and continues:
                number, outwards = normal_axis(side) + 2 * is_far(side), 1.0 if is_far(side) else -1.0
                height = box[3 if side == "top" else 1]  # left and right: of what is below
                skins[side] = _skin(ground, side, height, floors)
                box[number] = inset(rim, skins)[number]
                massless[side] = outwards * (mass[number] - box[number])
        surface = None
        if (gap := _gap_above(case, body)) > WHOLE * case.size[1] and "top" in sides:
            if gap < (least := least_element(case, ground.brick.mean_diameter)):
                ends = f"the disks end {gap:.4g} m below the surface of the ground; they must reach it, or end"
                raise CaseError([f"packing.origin: {ends} at least {least:.4g} m below, the smallest useful element"])
            skins["top"] = _skin(ground, "top", case.box[3], floors)
            surface = rim[3] + gap - skins["top"]
            massless["top"] = mass[3] + gap - surface
        levels = {
            side: Level.of(ground.beside(side), body, floor, side) for side, floor in floors.items() if side in sides
        }
        heights = [level.height for level in levels.values()]
        if len(heights) == 2 and np.ptp(heights) <= ON_IT * ground.brick.mean_diameter:  # skins of unlike layers differ
            mean = 0.5 * sum(level.surface for level in levels.values())
            levels = {side: level._replace(surface=mean) for side, level in levels.items()}
        left, bottom, right, top = box
        return cls((left, bottom, right, top), surface, skins, massless, levels)

    @property
    def ends(self) -> dict[str, float]:
        """Heights (m) above which no disks are beyond a side, by side."""
        return {side: level.height for side, level in self.levels.items()}

    @property
    def tops(self) -> tuple[float, float] | None:
        """Heights (m) of the free surface beyond the left and the right side; None: as high as the body."""
        if not self.levels:
            return None
        left, right = (self.levels[side].surface if side in self.levels else self.box[3] for side in ("left", "right"))
        return left, right


class Outline(NamedTuple):
    """The continuum beyond some sides of a body, before anything is tied to it.

    sides : of the body, with a continuum beyond. size : of its elements. rim : where it begins and ends. mesh : its
    elements, up to the free surface of the ground.
    """

    sides: tuple[str, ...]
    size: ElementSizes
    rim: Rim
    mesh: Mesh

    @classmethod
    def of(
        cls,
        case: DiskCase,
        ground: PackedMaterial,
        body: Assembly,
        sides: Sequence[str],
        periodic: tuple[bool, bool],
        floors: Mapping[str, Floor] = NO_FLOORS,
        *,
        slit: bool = False,
    ) -> Outline:
        """The outline of a body that is periodic along some axes, with floors at its left and right side.

        slit : whether the mesh has one, see `Mesh`; rows below the body are then up to half as high, as those below a
        column, which have the same heights.

        Raises CaseError for settings with which there is no mesh.
        """
        size = ElementSizes.of(case, ground, body, sides, periodic)
        rim = Rim.of(case, ground, body, sides, size, floors)
        key = "ground.surface" if case.ground.points else "hole"
        _refuse_low(key, rim, min(least_element(case, ground.brick.mean_diameter), case.outside.element or np.inf))
        mirrors = [side for side in SIDES if case.side(side).is_mirror and not periodic[normal_axis(side)]]
        mesh = mesh_of(
            size.settings,
            rim.box,
            sides,
            size.element,
            surface=rim.surface,
            tops=rim.tops,
            periodic=periodic,
            mirrors=mirrors,
            ground=medium_of(ground),
        )
        if slit:
            height = _below_column(size.settings.element, least_element(case, ground.brick.mean_diameter))
            mesh = replace(_lower_below(mesh, height), slit=True)
        return cls(tuple(sides), size, rim, mesh)

    @classmethod
    def below(cls, case: DiskCase, ground: PackedMaterial, column: Assembly, beside: Outline) -> Outline:
        """The outline below a free-field column, with rows and layers as those below a body beside it."""
        mesh, size = beside.mesh, ElementSizes.of(case, ground, column, ("bottom",), (True, False))
        assert mesh.box is not None
        size = size._replace(settings=beside.size.settings)
        rim, rows = Rim.of(case, ground, column, ("bottom",), size, NO_FLOORS), mesh.box[1]
        widths = divided(float(size.box[0]), size.element[0])
        own = Mesh(
            order=mesh.order,
            widths=widths,
            heights=(*mesh.heights[:rows], rim.box[3] - rim.box[1]),
            origin=(rim.box[0], mesh.origin[1]),
            box=(0, rows, len(widths), rows + 1),
            layer=Around(bottom=mesh.layer.bottom),
            periodic=(True, False),
        )
        return cls(("bottom",), size, rim, own)


def _skin(ground: PackedMaterial, side: str, height: float, floors: Mapping[str, Floor]) -> float:
    """Depth (m) of the skin at a side at a height, m.

    Where layers differ, those of the side without a floor, or the mean of both: the edge of the continuum is level.
    """
    each = [beside for beside in ("left", "right") if beside not in floors] or ["left", "right"]
    return sum(ground.beside(beside).at(height).skin(side) for beside in each) / len(each)


def on_top(mesh: Mesh, at_top: float, at_levels: Mapping[str, float]) -> np.ndarray:
    """Values (n,) on the top of a mesh for all its nodes; beyond sides in `at_levels` their own values."""
    left, right, *_ = mesh.sides
    x, values = mesh.positions[:, 0], np.full(mesh.count, at_top)
    for side, value in at_levels.items():
        values[x <= left if side == "left" else x >= right] = value
    return values


def _below_column(largest: float, least: float) -> float:
    """Height (m) of elements below a column: half the largest one, or more if they were lower than useful twice."""
    return max(0.5 * largest, min(largest, 2.0 * least))


def _lower_below(mesh: Mesh, height: float) -> Mesh:
    """A mesh with equal rows up to a height (m) below its box, and an absorbing layer as thick there.

    Unchanged where its rows have several heights, as in ground with layers there.
    """
    assert mesh.box is not None
    left, rows, right, top = mesh.box
    each, margin = mesh.heights[0], rows - mesh.layer.bottom
    if each <= height or np.ptp(mesh.heights[:rows]) > WHOLE * each:
        return mesh
    layer = divided(mesh.layer.bottom * each, height)
    more = len(layer) - mesh.layer.bottom
    return replace(
        mesh,
        heights=(*layer, *(height,) * margin, *mesh.heights[rows:]),
        origin=(mesh.origin[0], mesh.origin[1] + margin * (each - height)),
        box=(left, rows + more, right, top + more),
        levels=None if mesh.levels is None else (mesh.levels[0] + more, mesh.levels[1] + more),
        layer=mesh.layer._replace(bottom=len(layer)),
    )


def _gap_above(case: DiskCase, body: Assembly) -> float:
    """Height (m) of the ground above a body, 0 if the ground is the body."""
    if case.ground.size is None:
        return 0.0
    return case.box[3] + 0.5 * float((body.extent - body.size)[1]) - box_of(body)[3]  # with rows that close it


def _refuse_low(key: str, rim: Rim, least: float) -> None:
    """Raise CaseError for ground lower beyond a side if no useful element (m) fits between its heights.

    key : that gives them, in messages.
    """
    if not rim.levels:
        return
    surfaces = {f"the surface beyond the {side} side": level.surface for side, level in rim.levels.items()}
    highest = max(rim.tops) if rim.tops else rim.box[3]
    heights = {"the lower side of the disks": rim.box[1], **surfaces}
    heights |= {"the surface beside the disks": rim.box[3]} if highest == rim.box[3] else {}
    order = sorted(heights, key=lambda name: heights[name])
    least_is = f"at least {least:.4g} m above it, the smallest useful element"
    for low, high in pairwise(order):
        apart = heights[high] - heights[low]
        if WHOLE * (rim.box[3] - rim.box[1]) < apart < least:
            allowed = f"{'as high, or ' if low in surfaces else ''}{least_is}"
            said = f"{high}, y = {heights[high]:.4g} m, is {apart:.4g} m above {low}"
            raise CaseError([f"{key}: {said}; must be {allowed}"])


def mass_extent(ground: PackedMaterial, body: Assembly) -> np.ndarray:
    """Width and height (2,) m of a continuum with the mass of a body."""
    return body.size + np.where(body.extent > body.size, ground.brick.row_widths, 0.0)


def box_of(body: Assembly) -> Box:
    """Left, bottom, right and top (m) of a body, with rows that close its frame."""
    low = body.origin + 0.5 * (body.size - body.extent)
    left, bottom, right, top = np.concatenate([low, low + body.extent]).tolist()
    return left, bottom, right, top
