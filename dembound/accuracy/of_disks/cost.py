"""Cost and time step of a run of disks, counted from the case's tables in a few milliseconds, without building it.

Disks are those of whole bricks less the area of holes, nodes those of the mesh in the tables, ties the contacts cut by
the sides of bricks. The time step is found on small pieces of the same ground, which serve all cases.

A lattice of larger disks has steps longer by the ratio of the diameters, as all stiffnesses and masses of a plane body
scale alike. Beside a continuum the light nodes at the edges of its elements limit the step, by the ties that pull them:
by how much depends only on the sides of the elements in bricks, and on where bricks meet the nodes. It is found on a
box of a few elements.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from dembound.boundaries import Boundary, Periodic
from dembound.boundaries.edge import SIDES, normal_axis
from dembound.boundaries.outside import Outside
from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.ground import Ground
from dembound.casefile.disks.layer import OutsideTable
from dembound.continuum.medium import Ground as Beyond
from dembound.continuum.sizing import GridSizes
from dembound.disks import step_cost
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.memory import stands_in_rows
from dembound.disks.reduced import OneRow
from dembound.disks.scene import DiskScene, build
from dembound.disks.stability import own_step, step_limit
from dembound.disks.surroundings.elements import mesh_of
from dembound.disks.surroundings.media import medium_of
from dembound.disks.surroundings.settings import expected_tops, settings_of
from dembound.errors import DemboundError
from dembound.motion.kind import Plan
from dembound.packings.tiling import count_disks

LEAST, NARROW = 4, 10
"""Fewest disks along a periodic piece, as those of a square lattice move against their neighbours in the fastest
motion; copies of the brick across a body below which its free edges make steps longer, by 1 % or more."""

LAYERS = 2
"""Elements that absorb beyond each side of a piece."""

MOST = 4
"""Largest number of elements along a piece whose bricks meet nodes as in the case; with more, bricks are everywhere
beside them, nearly as with so many."""

FINE, WIDE, COARSE = 12.0, 24.0, 1.15
"""Sides of elements, in diameters, from which on it hardly matters where bricks meet nodes, and from which on steps
grow by less than 1 %; ratio of the sides between both for which there are pieces."""


class Along(NamedTuple):
    """Numbers of bricks and elements along an axis."""

    bricks: int
    elements: int

    def shorter(self, brick: float) -> Along:
        """The numbers along a short piece in which bricks, `brick` diameters long, meet nodes in the same way."""
        ratio = Fraction(self.bricks, self.elements)
        if (side := float(ratio) * brick) > FINE:
            side = min(FINE * COARSE ** round(math.log(side / FINE, COARSE)), WIDE)
            bricks = max(1, round(side / brick))
            return Along(bricks, max(1, round(bricks * brick / side)))
        if ratio.denominator > MOST:
            tried = [Fraction(bricks, MOST) for bricks in _beside(ratio * MOST)]
            tried += [Fraction(bricks, MOST - 1) for bricks in _beside(ratio * (MOST - 1))]
            ratio = min((each for each in tried if each.denominator >= MOST - 1), key=lambda each: abs(each - ratio))
        times = 2 if ratio.denominator == 1 else 1
        return Along(times * ratio.numerator, times * ratio.denominator)


def _beside(number: Fraction) -> range:
    """Whole numbers about a number, from one on."""
    return range(max(1, math.floor(number) - 1), math.ceil(number) + 2)


@dataclass
class Steps:
    """Time steps of cases that differ from a given one in the size of their disks, their sides and continuum.

    case, ground : given. limits : stability limits of pieces of the given ground, s, by properties of the piece.
    """

    case: DiskCase
    ground: PackedMaterial
    limits: dict[tuple[object, ...], float] = field(default_factory=dict)

    def of(self, case: DiskCase, element: tuple[float, float] | None) -> float:
        """The step (s) of a case whose continuum has elements of a width and height (m); None: it has none.

        Raises CaseError for an automatic step where nothing can vibrate.
        """
        limit = self._inside(case)
        if element is not None:
            limit = min(limit, self._in_continuum(case, element))
        return own_step(case, case.packing.radius / self.case.packing.radius * limit)

    def _inside(self, case: DiskCase) -> float:
        """Stability limit (s) of the given ground inside a body; of a narrow one also by its long sides."""
        least = max(1, math.ceil(LEAST / math.sqrt(len(self.ground.brick.radii))))
        is_narrow = [
            count < NARROW and not wraps for count, wraps in zip(case.packing.copies, case.periodic, strict=True)
        ]
        copies = [count if one else least for count, one in zip(case.packing.copies, is_narrow, strict=True)]
        if all(is_narrow) or len(self.ground.brick.radii) > 1:
            is_narrow, copies = [False, False], [least, least]
        sides: dict[str, Boundary] = {}
        for side in SIDES:
            table = case.side(side)
            if not is_narrow[normal_axis(side)]:
                sides[side] = Periodic(type="periodic")
            elif not table.is_artificial and not table.is_free:
                sides[side] = table.at_rest()
        return self._limit((*copies, *is_narrow, *map(repr, sides.values())), copies, sides, None)

    def _in_continuum(self, case: DiskCase, element: tuple[float, float]) -> float:
        """Stability limit (s) of the given ground in a continuum with as many elements for each brick."""
        packing, outside = case.packing, case.outside
        brick = [length / self.ground.brick.mean_diameter for length in self.case.packing.brick_size]
        along = [
            Along(count, max(1, round(length / side))).shorter(each)
            for count, length, side, each in zip(packing.copies, packing.extent, element, brick, strict=True)
        ]
        sizes = zip(along, self.case.packing.brick_size, strict=True)
        side = max(each.bricks * own / each.elements for each, own in sizes)
        same = {key: getattr(outside, key) for key in ("order", "shift", "delay", "damping")}
        table = OutsideTable(element=side * (1.0 + 1e-9), margin=1, layers=LAYERS, **same)
        sides: dict[str, Boundary] = {
            each: Periodic(type="periodic") if case.periodic[normal_axis(each)] else Outside(type="outside")
            for each in SIDES
        }
        key = (*along, outside.order, outside.damping, outside.delay, case.periodic)
        return self._limit(key, [each.bricks for each in along], sides, table)

    def _limit(
        self, key: tuple[object, ...], copies: list[int], sides: Mapping[str, Boundary], outside: OutsideTable | None
    ) -> float:
        """Stability limit (s) of `copies` bricks of the given ground, found once; infinite if they make no scene.

        Of layers that of the stiffest.
        """
        if key not in self.limits:
            packing = self.case.packing.with_copies(*copies).model_copy(update={"origin": (0.0, 0.0)})
            none: dict[str, Any] = dict.fromkeys(("group", "hole", "wall", "joint", "load", "monitor"), ())
            piece = replace(self.case, packing=packing, boundary=sides, outside=outside or self.case.outside)
            piece = replace(piece, ground=Ground(), wave={}, static=None, incident=None, **none)
            heights = [top - self.case.packing.radius for top in (self.case.box[3], *self.case.layer_planes)]
            layers = [self.case.uniform_at(height).layer for height in heights]
            try:
                self.limits[key] = min(step_limit(build(replace(piece, layer=layer))) for layer in layers)
            except DemboundError:
                self.limits[key] = math.inf
        return self.limits[key]


SAMPLES = 64
"""Places along each side of the rectangle round a hole by which its area is found."""


@dataclass(frozen=True)
class Cost:
    """The cost of a run.

    time_step : s; steps : their number. disks : stepped disks, column : those of the free-field column among them.
    nodes, ties : of the continuum. seconds : CPU time of the steps, s.
    """

    time_step: float
    steps: int
    disks: float
    column: float
    nodes: float
    ties: float
    seconds: float


def planned_cost(planned: Plan[DiskScene]) -> Cost:
    """The cost of a plan."""
    stepped = planned.stepped
    column = stepped.column_count
    nodes = sum(beyond.count for beyond in stepped.continua)
    ties = sum(len(beyond.wall.element) for beyond in stepped.continua)
    seconds = step_cost.seconds_of(stepped, planned.steps)
    return Cost(planned.time_step, planned.steps, stepped.disk_count, column, nodes, ties, seconds)


@dataclass
class Counted:
    """Counts the costs of cases that differ from a given, planned case in disks, sides and continuum."""

    given: Plan[DiskScene]

    def of(self, case: DiskCase) -> Cost:
        """The cost of a case; raises CaseError for a continuum without a mesh."""
        brick = self.given.scene.ground.brick
        column = self._column(case)
        disks = self._disks(case) + column
        ties, grid, element = 0.0, GridSizes(0, 0, 0, case.outside.order), None
        if case.outside_sides:
            cut = [int(np.count_nonzero(brick.images[:, axis])) for axis in (0, 1)]
            axes = [normal_axis(side) for side in case.outside_sides]
            ties = sum(cut[axis] * case.packing.copies[1 - axis] for axis in axes) + (cut[1] if column else 0)
            grid, element = self._grid(case)
        elif (axis := self._rows_alike) is not None:
            disks /= case.packing.copies[axis]
        step = self._steps.of(case, element)
        steps = max(1, math.ceil(case.run.duration / step - 1e-9))
        in_rows = stands_in_rows(case)
        absorbing = grid.nodes * grid.absorbing / grid.elements if grid.elements else 0.0
        each = step_cost.DISK[in_rows, self.given.scene.has_history]
        parts = [*step_cost.times_of_continuum(grid.nodes, absorbing, ties).values(), each * disks, self._drives(ties)]
        return Cost(step, steps, disks, column, grid.nodes, ties, 1e-9 * steps * sum(parts))

    def _disks(self, case: DiskCase) -> float:
        """Number of disks of the body."""
        packing, brick = case.packing, self.given.scene.ground.brick
        width, height = packing.brick_size
        return count_disks(brick, packing.copies, case.periodic) - len(brick.radii) / (width * height) * _hollow(case)

    def _column(self, case: DiskCase) -> float:
        """Number of disks of the free-field column."""
        if not case.column_sides:
            return 0.0
        return float(count_disks(self.given.scene.ground.brick, (1, case.column_rows[1]), (True, False)))

    def _grid(self, case: DiskCase) -> tuple[GridSizes, tuple[float, float]]:
        """Numbers of nodes and ties of the continuum, and width and height (m) of its elements beside the disks."""
        packing, sides, given = case.packing, case.outside_sides, self.given.scene
        box, diameter = packing.box, given.ground.brick.mean_diameter * packing.radius / given.case.packing.radius
        settings = settings_of(case, self._medium, diameter, box, sides)
        surface = case.box[3] if "top" in sides and "top" in packing.gaps(case.box) else None
        tops = None if any(case.periodic) else expected_tops(case, box)
        mesh = mesh_of(settings, box, sides, surface=surface, tops=tops, periodic=case.periodic)
        grid = GridSizes.of(mesh)
        if case.column_sides and "bottom" in sides:  # one element wide below the column
            more, order = settings.margin + settings.layers, settings.order
            nodes, absorbing = grid.nodes + order * (order * more + 1), grid.absorbing + settings.layers
            grid = GridSizes(nodes, grid.elements + more, absorbing, order)
        element = settings.sides(packing.extent[0], packing.extent[1])
        return grid, element

    def _drives(self, ties: float) -> float:
        """Nanoseconds per step of the forces by which an oblique wave enters, in proportion to the ties."""
        scene = self.given.stepped
        if scene.ground_waves is None:
            return 0.0
        own = sum(len(beyond.wall.element) for beyond in scene.continua)
        return step_cost.times_of_scene(scene)["incident wave"] * ties / own

    @cached_property
    def _rows_alike(self) -> int | None:
        """The axis across identical rows, of which only one is stepped; None if rows differ."""
        stepped = self.given.stepped
        return stepped.axis if isinstance(stepped, OneRow) else None

    @cached_property
    def _steps(self) -> Steps:
        return Steps(self.given.scene.case, self.given.scene.ground)

    @cached_property
    def _medium(self) -> Beyond:
        return medium_of(self.given.scene.ground)


def _hollow(case: DiskCase) -> float:
    """Area (m²) of the holes within the disks' box."""
    area, low, high = 0.0, np.array(case.packing.box[:2]), np.array(case.packing.box[2:])
    for number, hole in enumerate(case.holes):
        start, end = np.maximum(hole.box[:2], low), np.minimum(hole.box[2:], high)
        if hole.is_shape:
            start, end = low, high
        if (end <= start).any():
            continue
        along = (np.arange(SAMPLES) + 0.5) / SAMPLES
        grid = np.stack(np.meshgrid(*(start[:, None] + np.outer(end - start, along))), axis=-1).reshape(-1, 2)
        inside = hole.takes(grid, case.packing.span)
        for other in case.holes[:number]:
            inside &= ~other.takes(grid, case.packing.span)
        area += float(np.prod(end - start)) * float(inside.mean())
    return area
