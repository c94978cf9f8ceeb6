"""Pressures on sides of a body, as by a membrane, and on walls of holes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from dembound.boundaries.edge import exposed, is_far, normal_axis, plane_of
from dembound.boundaries.half_mass import half_contacts, half_edges
from dembound.casefile.disks.load import Load
from dembound.disks.body import DiskBody
from dembound.disks.material.constants import limits_of
from dembound.disks.surroundings.cut_bonds import CutBonds
from dembound.disks.surroundings.mesh import box_of
from dembound.errors import CaseError
from dembound.holes.hole import Hole
from dembound.holes.outline import Outline
from dembound.kernels.contacts import UPDATED
from dembound.packings.cut import CutContacts, contacts_into
from dembound.packings.tiling import Assembly
from dembound.table import Box

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


FAR = 4.0
"""Largest distance from a disk to the ends of its part of an outline, in largest diameters.

In dense packings it is below two, and in the corner of a hole with an angle θ, into which disks of radius R do not fit,
R/tan(θ/2): 4 diameters at 14°.
"""


def pressure_on(load: Load, scene: DiskBody) -> tuple[np.ndarray, np.ndarray]:
    """Disks (k,) of the wall that a load presses on, and its forces and moments on them (k, 3) N and N·m per metre.

    There are none while the hole still has its disks, before it is excavated.

    Raises CaseError for holes that cut no bonds, for those that cut bonds across periodic sides, and for those without
    disks along some part of their outline, as beside another hole.
    """
    hole = scene.case.hole_of(load)
    first = scene.column_count
    body = scene.assembly.part(slice(first, scene.disk_count))
    if hole.takes(body.positions, float(body.size.max())).any():
        return np.zeros(0, dtype=np.int64), np.zeros((0, 3))
    cut = contacts_into(scene.ground.brick, body, hole)
    if _is_beside_its_image(scene, body, hole):
        raise _error(load, "is so near a periodic side that it cuts bonds across it; move it, or make the body larger")
    if len(cut.node) == 0:
        raise _error(load, "cuts no bonds of the body, so there is no wall to press on")
    assert load.pressure is not None
    disks, of = np.unique(cut.node, return_inverse=True)
    if load.on == "bonds":
        forces = np.zeros((len(disks), 3))
        np.add.at(forces, of, _on_bonds(scene, body, cut))
    else:
        forces = _on_outline(load, hole, _edges_of(scene, body), body, disks)
    return first + disks, load.pressure * forces


def _is_beside_its_image(scene: DiskBody, body: Assembly, hole: Hole) -> bool:
    """Whether a hole is nearer to a periodic side than bonds are long."""
    reach = np.abs(scene.ground.brick.vectors).max(axis=0)
    low, high = np.array(hole.box).reshape(2, 2) - np.array(box_of(body)).reshape(2, 2)
    return bool(np.any(scene.case.periodic & ((low < reach) | (-high < reach))))


def _edges_of(scene: DiskBody, body: Assembly) -> Box:
    """Left, bottom, right and top (m) of a body; at sides of half cells the line of their centres."""
    box = list(box_of(body))
    for edge in half_edges(scene.edges, scene.case.boundary):
        at_high_end = is_far(edge.side)
        box[edge.axis + 2 * at_high_end] = float(np.median(edge.positions[:, edge.axis]))
    return box[0], box[1], box[2], box[3]


def _on_outline(load: Load, hole: Hole, box: Box, body: Assembly, disks: np.ndarray) -> np.ndarray:
    """Forces and moments (k, 3) on the disks (k,) of a wall under 1 Pa; box : left, bottom, right, top of the body."""
    outline, places = hole.outline, body.positions[disks]
    assert outline is not None
    nearest, parts, forces = outline.nearest(places), outline.within(box), np.zeros((len(disks), 3))
    if not parts:
        raise _bare(load, places[0])
    beyond = np.array([outline.beyond(nearest, part) for part in parts])
    for number, part in enumerate(parts):
        own = np.flatnonzero(np.argmin(beyond, axis=0) == number)
        if len(own) == 0:
            raise _bare(load, outline.at(np.array([part[0] + 0.5 * part[1]]))[0])
        begin, end = shares_of(outline, part, nearest[own])
        far = [np.hypot(*(piece - places[own]).T) for piece in (begin, end)]
        for piece, distance in zip((begin, end), far, strict=True):
            if distance.max() > FAR * 2.0 * body.radii.max():
                raise _bare(load, piece[np.argmax(distance)])
        arms = far[1] ** 2 - far[0] ** 2
        forces[own] = np.column_stack([end[:, 1] - begin[:, 1], begin[:, 0] - end[:, 0], -0.5 * arms])
    return forces


def shares_of(outline: Outline, part: tuple[float, float], nearest: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Begin and end (k, 2) m of the shares of disks in a part of an outline, counter-clockwise round the hole.

    part : its begin and length. nearest : (k,) the points nearest to the disks; all in the parameter of
    the outline. Shares meet in the middle between these, and the outer ones go on to the ends of the part.
    """
    (start, length), period = part, outline.period
    along = (nearest - start) % period
    if length < period:  # what lies beyond the part belongs to its nearer end
        along = np.where(along <= length, along, np.where(along - length < period - along, length, 0.0))
    order = np.argsort(along, kind="stable")
    middle = 0.5 * (along[order][1:] + along[order][:-1])
    low, high = 0.0, length
    if length == period:
        high = 0.5 * (along[order[0]] + period + along[order[-1]])
        low = high - period
    begin, end = np.empty((2, len(along)))
    begin[order], end[order] = np.append(low, middle), np.append(middle, high)
    return outline.at(start + begin), outline.at(start + end)


def _on_bonds(scene: DiskBody, body: Assembly, cut: CutContacts) -> np.ndarray:
    """Forces and moments (e, 3) of cut bonds on their disks where the packing is under 1 Pa everywhere."""
    forces, layer = np.empty((len(cut.node), 3)), scene.ground.layer_of(body.positions[cut.node])
    for number, ground in enumerate(scene.ground.undamped.materials):
        gradient = np.linalg.lstsq(ground.material_tensor, np.array([-1.0, -1.0, 0.0, 0.0]), rcond=None)[0]
        on_disks = CutBonds.of(ground, cut, body.positions).on_disks
        forces[layer == number] = np.einsum("cge,g->ec", on_disks, gradient)[layer == number]
    first = scene.disk_count - len(body.radii)
    vectors = cut.vectors(scene.ground.brick)
    halved = half_contacts(first + cut.node, first + cut.node, vectors, scene.edges, scene.case.boundary)
    return forces * np.where(halved, 0.5, 1.0)[:, None]


def _bare(load: Load, place: np.ndarray) -> CaseError:
    """The error for an outline without disks near a place (2,) m."""
    x, y = place
    return _error(load, f"has no wall near ({x:.4g}, {y:.4g}) m of its outline; holes that join need to be one polygon")


def _error(load: Load, problem: str) -> CaseError:
    """The error for a hole on whose wall a load cannot press."""
    return CaseError([f'load.{load.name}.hole: "{load.hole}" {problem}'])
