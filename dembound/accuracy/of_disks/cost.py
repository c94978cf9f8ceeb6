"""Cost of a run of disks, counted from the case's tables in a few milliseconds, without building it.

Disks are those of whole bricks less the area of holes, nodes those of the mesh in the tables, ties the contacts cut by
the sides of bricks, and the time step is computed by `steps.Steps`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dembound.accuracy.of_disks.steps import Steps
from dembound.boundaries.edge import normal_axis
from dembound.casefile.disks import DiskCase
from dembound.continuum.medium import Ground
from dembound.continuum.sizing import GridSizes
from dembound.disks import step_cost
from dembound.disks.memory import stands_in_rows
from dembound.disks.reduced import OneRow
from dembound.disks.scene import DiskScene
from dembound.disks.surroundings.mesh import medium_of
from dembound.disks.surroundings.settings import expected_tops, mesh_of, settings_of
from dembound.motion.kind import Plan
from dembound.packings.tiling import count_disks

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
    column = 0 if stepped.seam is None else stepped.seam.count
    nodes = sum(beyond.count for beyond in stepped.continua)
    ties = sum(len(beyond.wall.element) for beyond in stepped.continua)
    seconds = 1e-9 * planned.steps * sum(step_cost.times_of_scene(stepped).values())
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
        step = self._step(case, element)
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
        packing, sides = case.packing, case.outside_sides
        box, diameter = packing.box, self._diameter * packing.radius / self.given.scene.case.packing.radius
        settings = settings_of(case, self._medium, diameter, box, sides)
        surface = case.box[3] if "top" in sides and "top" in packing.gaps(case.box) else None
        tops = None if any(case.periodic) else expected_tops(case, box)
        mesh = mesh_of(settings, box, sides, surface=surface, tops=tops, periodic=case.periodic)
        grid = GridSizes.of(mesh)
        if case.column_sides and "bottom" in sides:  # one element wide below the column
            more, order = settings.margin + settings.layers, settings.order
            grid = GridSizes(
                grid.nodes + order * (order * more + 1), grid.elements + more, grid.absorbing + settings.layers, order
            )
        element = settings.sides(packing.extent[0], packing.extent[1])
        return grid, element

    def _step(self, case: DiskCase, element: tuple[float, float] | None) -> float:
        """The time step, s; the planned one scaled where only the size of the disks differs."""
        return self._steps.of(case, element)

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
    def _medium(self) -> Ground:
        return medium_of(self.given.scene.ground)

    @property
    def _diameter(self) -> float:
        return self.given.scene.ground.brick.mean_diameter


def _hollow(case: DiskCase) -> float:
    """Area (m²) of the holes within the disks' box."""
    area, low, high = 0.0, np.array(case.packing.box[:2]), np.array(case.packing.box[2:])
    for number, hole in enumerate(case.hole):
        start, end = np.maximum(hole.box[:2], low), np.minimum(hole.box[2:], high)
        if hole.is_shape:
            start, end = low, high
        if (end <= start).any():
            continue
        along = (np.arange(SAMPLES) + 0.5) / SAMPLES
        grid = np.stack(np.meshgrid(*(start[:, None] + np.outer(end - start, along))), axis=-1).reshape(-1, 2)
        inside = hole.takes(grid, case.packing.span)
        for other in case.hole[:number]:
            inside &= ~other.takes(grid, case.packing.span)
        area += float(np.prod(end - start)) * float(inside.mean())
    return area
