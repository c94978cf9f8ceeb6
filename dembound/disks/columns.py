"""Free-field columns of a case: for which sides they stand, their feet, and how they are at rest."""

from collections.abc import Mapping, Sequence
from itertools import zip_longest

import numpy as np

from dembound.boundaries import Boundary
from dembound.boundaries.fixed import Fixed
from dembound.boundaries.roller import Roller
from dembound.casefile.disks.model import DiskCase
from dembound.disks.material.at_rest import AtRest, levels_of, stress_at_rest
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.surroundings.continuum import Surroundings, surroundings_of
from dembound.disks.surroundings.edges import ON_IT
from dembound.disks.surroundings.mesh import Level, Outline
from dembound.holes.hole import Floor
from dembound.motion.state import Layout
from dembound.packings.column import Seam, Standing, columns_end
from dembound.packings.tiling import Assembly

UPRIGHT = (True, False)
"""Along which axes a free-field column is periodic."""

COLUMNS = ("column", "right_column")
"""The names of the parts that are free-field columns."""


def side_of(seam: Seam) -> str:
    """The side of whose ground a column is: the right one of the second of two, else the left one."""
    return "right" if seam.sides == ("right",) else "left"


def level_at(surface: np.ndarray, seam: Seam) -> np.ndarray:
    """The point (2, 1) m of a surface (2, k) at the side for which a column stands."""
    return surface[:, [-1]] if seam.sides == ("right",) else surface[:, [0]]


def rest_beside(case: DiskCase, ground: PackedMaterial, seam: Seam, surface: np.ndarray | None) -> AtRest | None:
    """The stress at rest of a column: of the ground of its side below its own surface; None without one."""
    side, own = side_of(seam), None if surface is None else level_at(surface, seam)
    return stress_at_rest(case.beside(side), ground.beside(side), own)


def parts_of(count: int, seams: Sequence[Seam]) -> dict[str, slice]:
    """The particle ranges of `count` particles by part: the free-field columns, if there are any, and the body."""
    columns = {name: seam.disks for name, seam in zip(COLUMNS, seams, strict=False)}
    return {**columns, "body": slice(columns_end(seams), count)}


def levels_in(case: DiskCase, ground: PackedMaterial, assembly: Assembly, at_rest: AtRest | None) -> np.ndarray | None:
    """A number (n,) of each disk, the same for copies with the same constants; None if all copies have.

    Rows of bricks have constants of their own in layers, or under a history-dependent law with K0, and bricks of a row
    where its layers differ at both sides.
    """
    has_k0 = ground.law.has_history and case.static is not None and case.static.k0 is not None
    if not (ground.is_layered or has_k0):
        return None
    return levels_of(assembly, ground, at_rest if has_k0 else None)


def levels_by_part(
    case: DiskCase, ground: PackedMaterial, assembly: Assembly, seams: tuple[Seam, ...], surface: np.ndarray | None
) -> dict[str, np.ndarray | None]:
    """Levels of the disks of each part, see `levels_in`; those of columns under their own stress at rest."""
    found = {}
    for (name, disks), seam in zip_longest(parts_of(len(assembly.radii), seams).items(), seams):
        own = stress_at_rest(case, ground, surface) if seam is None else rest_beside(case, ground, seam, surface)
        found[name] = levels_in(case, ground, assembly.part(disks), own)
    return found


def standing_of(
    case: DiskCase, ground: PackedMaterial, body: Assembly, floors: Mapping[str, Floor]
) -> tuple[Standing, ...]:
    """The free-field columns of a body: one, or one for each side where the ground left and right differs."""
    sides = case.column_sides
    tops = {side: Level.of(ground.beside(side), body, floors[side], side).height for side in sides if side in floors}
    highest, lowest = (of(tops.get(side, case.box[3]) for side in ("left", "right")) for of in (max, min))
    same = not case.is_unlike and highest - lowest <= ON_IT * ground.brick.mean_diameter
    if same or not {"left", "right"} <= {*sides}:
        return (Standing(sides, next(iter(tops.values()), None)),) if sides else ()
    left = tuple(side for side in sides if side != "right")
    return Standing(left, tops.get("left")), Standing(("right",), tops.get("right"))


def foot_of(
    case: DiskCase, ground: PackedMaterial, assembly: Assembly, seam: Seam, layout: Layout, beside: Outline | None
) -> Surroundings:
    """The continuum below a free-field column, of equal width; layout : of all nodes before its own.

    beside : the continuum round the body, if its elements have the same heights, as below two columns.
    """
    case, ground = case.beside(side_of(seam)), ground.beside(side_of(seam))
    column, ground = assembly.part(seam.disks), ground_beneath(case, ground)
    if beside is None:
        outline, inner = Outline.of(case, ground, column, ("bottom",), UPRIGHT), None
    else:
        outline, inner = Outline.below(case, ground, column, beside), beside.mesh.inner
    return surroundings_of(ground, column, outline, layout, seam.disks.start, inner=inner)


def ground_beneath(case: DiskCase, ground: PackedMaterial) -> PackedMaterial:
    """The ground below the box of a case: one material, or all layers if some begin below."""
    deeper = ground.is_layered and case.layer_planes[-1] < case.box[1]
    return ground if deeper else ground.at(case.box[1])


def columns_stand_fast(case: DiskCase, seams: Sequence[Seam]) -> bool:
    """Whether columns are fixed at rest where their body is on rollers: beside unlike ones, and of uneven packings."""
    return len(seams) > 1 or not case.packing.is_lattice


def standing_fast(table: Boundary) -> Boundary:
    """The support of a column at rest in place of that of its body: one on rollers would slide under what is left."""
    return Fixed(type="fixed") if isinstance(table, Roller) else table


def free_field_attributes(
    case: DiskCase, seams: Sequence[Seam], outside: Surroundings | None, place: np.ndarray
) -> dict[str, float | str]:
    """The side whose ground a free field at a place (2,) m is in, "left" if both are one, and y (m) of its surface."""
    unlike = len(seams) > 1 or (not seams and (case.is_unlike or (outside is not None and bool(outside.levels))))
    side = "right" if unlike and place[0] > case.middle else "left"
    top = seams[-1 if side == "right" else 0].top if seams else None
    if top is None and outside is not None and (outside.levels or outside.free_surface):
        top = outside.surface_at(side)[0]
    return {"side": side, "surface": case.packing.box[3] if top is None else top}
