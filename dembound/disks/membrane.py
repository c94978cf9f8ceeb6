"""A pressure on sides of a body, as by a membrane: on the line through the centres of the outer disks of each side.

The pressure on a straight piece of this line between two disks acts on both alike. So the force on a disk is p/2 times
the line from its predecessor to its successor, turned inwards: that of a fluid of this pressure on the polygon, whose
work is the pressure times the area that the polygon loses. The ends of a line go on to the corners of the box, which
move with the outermost disks; the force on an end and its moment are those of its disk. So pressures on opposite sides
of a body as built are in balance, whatever its packing.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from dembound.boundaries import is_far, normal_axis, plane_of
from dembound.boundaries.exposed import exposed
from dembound.casefile.disks.load import Load
from dembound.disks.body import DiskBody
from dembound.disks.material.constants import limits_of
from dembound.kernels.contacts import UPDATED

BRIDGED = 2.0
"""Diameter, in mean diameters, of a circle that rolls along a side and touches the disks that a membrane touches.

Disks seen from outside through narrow hollows are left out: their pressure would push their neighbours apart.
"""

OPPOSITES = (("left", "right"), ("bottom", "top"))
"""The sides by the axis of their normal, the near one first."""

ASCENDING_INWARDS = {"left": 1.0, "top": 1.0, "right": -1.0, "bottom": -1.0}
"""Sign with which the line along a side, in ascending order, is turned clockwise to point inwards."""


@dataclass(frozen=True)
class Membrane:
    """A pressure (Pa) on a side, with the disks (k,) of its line in ascending order and its ends (2, 2) m as built."""

    side: str
    pressure: float
    nodes: np.ndarray
    ends: np.ndarray

    def forces(self, positions: np.ndarray, displacement: np.ndarray) -> np.ndarray:
        """Forces and moments (k, 3) N and N·m on its disks, at displacements (3, n) from positions (n, 2) m."""
        moved = displacement[:2, self.nodes].T
        line = np.vstack([self.ends[0] + moved[0], positions[self.nodes] + moved, self.ends[1] + moved[-1]])
        pieces = np.diff(line, axis=0)
        push = ASCENDING_INWARDS[self.side] * self.pressure * np.stack([pieces[:, 1], -pieces[:, 0]], axis=1)
        forces = np.zeros((len(self.nodes), 3))
        forces[:, :2] = 0.5 * (push[:-1] + push[1:])
        forces[[0, -1], :2] += 0.5 * push[[0, -1]]  # the whole of each end is on its disk
        turn = 0.5 * ASCENDING_INWARDS[self.side] * self.pressure * (pieces[[0, -1]] ** 2).sum(axis=1)
        forces[[0, -1], 2] += turn * (1.0, -1.0)
        return forces


def membranes_of(load: Load, body: DiskBody) -> Iterator[Membrane]:
    """The membranes of a pressure on sides; those of adjacent sides meet at the disk of their corner."""
    box, bridged = body.case.packing.box, 0.5 * BRIDGED * body.ground.brick.mean_diameter
    for side in load.sides or ():
        assert load.pressure is not None
        edge, others = body.edges[side], [OPPOSITES[1 - normal_axis(side)][far] for far in (False, True)]
        ends = [_corner(body, side, other) for other in others]
        along = body.positions[:, 1 - edge.axis]
        touched = edge.nodes[exposed(edge.positions, 0.5 * edge.diameters + bridged, side)]
        between = touched[(along[touched] > along[ends[0]]) & (along[touched] < along[ends[1]])]
        corners = [[plane_of(each, box) for each in ((side, other), (other, side))[edge.axis]] for other in others]
        yield Membrane(side, load.pressure, np.array([ends[0], *between, ends[1]]), np.array(corners))


def _corner(body: DiskBody, side: str, other: str) -> int:
    """The outermost disk along the diagonal between two sides."""
    there = [body.edges[each].nodes for each in (side, other) if each in body.edges]
    nodes = np.unique(np.concatenate(there))
    outward = sum((1.0 if is_far(each) else -1.0) * body.positions[nodes, normal_axis(each)] for each in (side, other))
    return int(nodes[np.argmax(outward + np.sqrt(2.0) * body.assembly.radii[nodes])])


def forces_on_sides(load: Load, body: DiskBody) -> tuple[np.ndarray, np.ndarray]:
    """Disks (k,), and forces and moments (k, 3) N and N·m, of a pressure on the sides of a body as built."""
    force, still = np.zeros((3, body.count)), np.zeros((3, body.count))
    for each in membranes_of(load, body):
        force[:, each.nodes] += each.forces(body.positions, still).T
    nodes = np.flatnonzero(force.any(axis=0))
    return nodes, force[:, nodes].T


def in_run(body: DiskBody, displacement: np.ndarray, steady: np.ndarray) -> np.ndarray:
    """The steady loads (3, n) N and N·m of a run, at displacements (3, n); steady : those of the body as built.

    A pressure on sides follows its disks, if the geometry of the law does, and ends where a boundary of the run
    prescribes the motion of the side, as a platen does: its force is then that of the platen from the beginning.
    """
    pressed = [each for load in body.case.load if load.sides for each in membranes_of(load, body)]
    if not pressed or body.whole is not body:
        return steady
    still = np.zeros_like(displacement)
    moved = displacement if follows(body) else still
    force = steady.copy()
    for each in pressed:
        force[:, each.nodes] -= each.forces(body.positions, still).T
    for each in pressed:
        axis = normal_axis(each.side)
        if axis not in body.case.side(each.side).prescribed(axis):
            force[:, each.nodes] += each.forces(body.positions, moved).T
    return force


def follows(body: DiskBody) -> bool:
    """Whether pressures on sides of a body follow its disks in a run."""
    return limits_of(body.case.material).geometry == UPDATED and any(load.sides for load in body.case.load)
