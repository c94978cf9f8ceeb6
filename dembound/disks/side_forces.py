"""The forces with which the packing beyond the sides of a body holds it under a uniform stress."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from dembound.boundaries.edge import SIDES, normal_axis
from dembound.boundaries.support import Edge
from dembound.disks.body import DiskBody
from dembound.disks.columns import COLUMNS
from dembound.disks.contacts.pairs import PIECE, Piece
from dembound.disks.material.at_rest import AtRest, gradients_of_stresses, rest_forces
from dembound.disks.material.constants import brick_constants
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.surroundings.cut_bonds import CutBonds
from dembound.laws.law import K
from dembound.packings.column import Seam
from dembound.packings.cut import CutContacts, cut_contacts
from dembound.packings.tiling import Assembly


@dataclass(frozen=True, eq=False)
class SideForces:
    """Forces through the contacts that end at a side of a body, which is cut out of an endless packing under stress.

    With them every disk has the forces that it has in the packing, so that bricks are under the same stress up to the
    sides. Uniform tractions on the outer disks, without these moments, disturb the stress as deep as the body is wide.

    Attributes
    ----------
    node : (k,) disks on which the contacts act, ascending. per_stress : (3, k, 3) N and N·m, forces along x and y and
    moment about the disk's centre, per Pa of the elastic stress xx, yy, xy. as_built : (3, k) forces of the packing as
    built.
    """

    node: np.ndarray
    per_stress: np.ndarray
    as_built: np.ndarray

    def under(self, stress: np.ndarray) -> np.ndarray:
        """Forces and moments (3, k) under a stress (3,) Pa, including the stress of the packing as built."""
        return np.asarray(self.per_stress @ stress + self.as_built)


def side_forces(scene: DiskBody) -> dict[str, SideForces]:
    """Forces on all sides of a body that are not periodic, by side."""
    ends, part = _ends(scene, scene.assembly, scene.edges, scene.case.periodic)
    per_stress, as_built = _through(scene, scene.assembly, ends)
    per_stress, as_built = per_stress * part[:, None], as_built * part
    found = {}
    for number, side in enumerate(SIDES):
        if side in scene.edges:
            here = np.flatnonzero(ends.side == number)
            here = here[np.argsort(ends.node[here], kind="stable")]
            node, first = np.unique(ends.node[here], return_index=True)
            sums = np.add.reduceat(np.dstack([per_stress[:, here], as_built[:, here]]), first, axis=1)
            found[side] = SideForces(node, sums[..., :3], sums[..., 3])
    return found


def forces_at_rest(scene: DiskBody) -> np.ndarray:
    """Forces and moments (3, n) N and N·m of the contacts that the sides cut, under the scene's stress at rest.

    Without those through the seam of a free field, which the column's contacts exert.
    """
    force = np.zeros((3, scene.count))
    if scene.at_rest is None:
        return force
    for name, nodes in scene.parts.items():
        body, upright = scene.assembly.part(nodes), name in COLUMNS
        sides = SIDES[2:] if upright else tuple(scene.edges)
        edges = {side: _among(scene.edges[side], nodes) for side in sides if side in scene.edges}
        ends, part = _ends(scene, body, edges, (True, False) if upright else scene.case.periodic)
        for seam in () if upright else scene.seams:
            part = np.where(_in_seam(scene, seam, ends, nodes.start), 0.0, part)
        x, heights = (body.positions[ends.node] + 0.5 * ends.vectors(scene.ground.brick)).T
        at_rest = scene.at_rest_of(name)
        assert at_rest is not None
        layer, each = scene.ground.layer_of(np.column_stack([x, heights])), np.zeros((3, len(heights)))
        for number in np.unique(layer):
            own = layer == number
            ground = scene.ground.at(float(heights[own][0]), float(x[own][0])).undamped
            bonds = CutBonds.of(ground, ends.only(own), body.positions)
            each[:, own] = part[own] * _at_rest(ground, at_rest, ends.only(own), bonds, heights[own], x[own])
        for component in range(3):
            np.add.at(force[component], nodes.start + ends.node, each[component])
    return force


def _at_rest(
    ground: PackedMaterial,
    at_rest: AtRest,
    ends: CutContacts,
    bonds: CutBonds,
    heights: np.ndarray,
    x: np.ndarray | None = None,
) -> np.ndarray:
    """Forces and moments (3, e) of contact ends at heights (e,) m on their disks, in ground of one material.

    x : (e,) m, their places, see `AtRest.at`.
    """
    if not at_rest.slides:
        return np.asarray(np.einsum("cts,st->ct", _per_stress(ground, bonds), at_rest.at(heights, x)))
    pull, shear, bending, _ = rest_forces(ground, at_rest, ends.contact_type, heights, x)
    bending = np.where(ends.is_second, -bending, bending)
    (nx, ny), arm = bonds.normal, bonds.arm
    return np.stack([pull * nx - shear * ny, pull * ny + shear * nx, bending + arm * shear])


def _among(edge: Edge, nodes: slice) -> Edge:
    """The nodes of an edge in a part of the scene, numbered from its first one."""
    own = edge.only((edge.nodes >= nodes.start) & (edge.nodes < nodes.stop), edge.length)
    return replace(own, nodes=own.nodes - nodes.start)


def _in_seam(scene: DiskBody, seam: Seam, ends: CutContacts, begin: int) -> np.ndarray:
    """Whether a free-field column exerts the forces of contact ends (e,); begin : number of the body's first disk."""
    whole = len(scene.ground.brick.pairs)
    owner = np.repeat(seam.node - begin, seam.contact_counts)
    across = (2 * owner + seam.twin_is_second) * whole + seam.contact_type % whole
    return np.asarray(np.isin((2 * ends.node + ends.is_second) * whole + ends.contact_type, across))


def packing_pieces(scene: DiskBody, stress: np.ndarray) -> Iterator[Piece]:
    """The contacts of a body with the forces that they have in the endless packing under a stress (3,) Pa."""
    brick, body = scene.ground.brick, scene.assembly
    whole = len(brick.pairs)
    (first, second), zero = brick.pairs.T.astype(np.int64), np.zeros(whole, dtype=np.int64)
    none = np.zeros((whole, 2), dtype=np.int64)
    each = CutContacts(zero, np.arange(whole), zero > 0, second, none, none, zero)
    if scene.at_rest is not None and scene.at_rest.slides:
        ground = scene.ground.at(float(body.positions[0, 1])).undamped
        bonds = CutBonds.of(ground, each, body.positions)
        force = _at_rest(ground, scene.at_rest, each, bonds, np.full(whole, body.positions[0, 1]))[:2]
    else:
        per_stress, as_built = _through(scene, body, each)
        force = (per_stress @ stress + as_built)[:2]
    force = np.concatenate([force, 0.5 * force], axis=1)  # of half cells
    vectors = np.concatenate([brick.vectors, brick.vectors])
    for begin in range(0, len(body.pairs), PIECE):
        part = slice(begin, begin + PIECE)
        kind, (first, second) = body.contact_type[part] % (2 * whole), body.pairs[part].T
        every = np.ones(len(kind), dtype=np.bool_)
        yield Piece(first, second, every, every, vectors[kind].T, np.full(len(kind), 0.5), force[:, kind])


def _through(scene: DiskBody, body: Assembly, cut: CutContacts) -> tuple[np.ndarray, np.ndarray]:
    """Forces (3, e, 3) per stress and (3, e) as built, see `SideForces`, of contacts on the disks of one end."""
    ground, brick, locked_in = scene.ground.stepped, scene.ground.brick, scene.case.material.locked_in
    bonds = CutBonds.of(ground.undamped, cut, body.positions)
    per_stress = _per_stress(ground, bonds)
    as_built = np.zeros(per_stress.shape[:2])
    if locked_in is not None:
        share = locked_in / ground.packed_pressure
        constants = brick_constants(ground, gaps_close=False, locked_in=share)[cut.contact_type]
        overlap = np.maximum(constants[:, K.touch] - constants[:, K.rest], 0.0)
        as_built[:2] = -constants[:, K.kn] * overlap * bonds.normal
        as_built -= per_stress @ (share * ground.contact_modulus * brick.stress)
    return per_stress, as_built


def _per_stress(ground: PackedMaterial, bonds: CutBonds) -> np.ndarray:
    """Forces (3, e, 3) of cut bonds on their disks per stress of the endless packing."""
    return np.einsum("cgt,gs->cts", bonds.on_disks, gradients_of_stresses(ground.continuum.tensor))


def _ends(
    scene: DiskBody, body: Assembly, edges: Mapping[str, Edge], periodic: tuple[bool, bool]
) -> tuple[CutContacts, np.ndarray]:
    """The contacts that end at sides, and the share (e,) of each that does.

    All of a contact cut by a side, and half of a contact along a side of half cells, at both disks.
    """
    brick = scene.ground.brick
    cut = cut_contacts(brick, body, tuple(edges), periodic)
    found = [cut]
    halved = np.flatnonzero(body.contact_type % (2 * len(brick.pairs)) >= len(brick.pairs))
    kind = body.contact_type[halved].astype(np.int64) % len(brick.pairs)
    first, second = body.pairs[halved].T.astype(np.int64)
    side = _side_along(body, edges, first, second)
    for near, far, is_second in ((first, second, False), (second, first, True)):
        image = (body.tile[far] - body.tile[near]).astype(np.int64)
        other, tile = body.brick_particle[far].astype(np.int64), body.tile[far].astype(np.int64)
        found.append(CutContacts(near, kind, np.full(len(kind), is_second), other, tile, image, side))
    joined = {name: np.concatenate([getattr(each, name) for each in found]) for name in vars(cut)}
    return CutContacts(**joined), np.repeat([1.0, 0.5], [len(cut.node), 2 * len(kind)])


def _side_along(body: Assembly, edges: Mapping[str, Edge], first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Number (h,) of the side along which contacts of half cells run, between disks first and second (h,)."""
    side = np.full(len(first), -1)
    way = np.abs(body.positions[second] - body.positions[first])
    for number, name in enumerate(SIDES):
        if name in edges:
            axis, nodes = normal_axis(name), edges[name].nodes
            along = (way[:, 1 - axis] > way[:, axis]) & np.isin(first, nodes) & np.isin(second, nodes)
            side[along & (side < 0)] = number
    return side
