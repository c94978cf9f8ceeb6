"""The forces with which the packing beyond the sides of a body holds it under a uniform stress."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from dembound.boundaries.sides import SIDES, normal_axis
from dembound.disks.beyond.cut_bonds import CutBonds
from dembound.disks.body import DiskBody
from dembound.disks.contacts.forces import PIECE, Piece
from dembound.disks.material.constants import brick_constants
from dembound.packings.cut import CutContacts, cut_contacts


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
        forces: np.ndarray = self.per_stress @ stress + self.as_built
        return forces


def side_forces(scene: DiskBody) -> dict[str, SideForces]:
    """Forces on all sides of a body that are not periodic, by side."""
    ends, part = _ends(scene)
    per_stress, as_built = _through(scene, ends)
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


def packing_pieces(scene: DiskBody, stress: np.ndarray) -> Iterator[Piece]:
    """The contacts of a body with the forces that they have in the endless packing under a stress (3,) Pa."""
    brick, body = scene.ground.brick, scene.assembly
    whole = len(brick.pairs)
    (first, second), zero = brick.pairs.T.astype(np.int64), np.zeros(whole, dtype=np.int64)
    none = np.zeros((whole, 2), dtype=np.int64)
    each = CutContacts(zero, np.arange(whole), zero > 0, second, none, none, zero)
    per_stress, as_built = _through(scene, each)
    force = (per_stress @ stress + as_built)[:2]
    force = np.concatenate([force, 0.5 * force], axis=1)  # of half cells
    vectors = np.concatenate([brick.vectors, brick.vectors])
    for begin in range(0, len(body.pairs), PIECE):
        part = slice(begin, begin + PIECE)
        kind, (first, second) = body.contact_type[part], body.pairs[part].T
        every = np.ones(len(kind), dtype=np.bool_)
        yield Piece(first, second, every, every, vectors[kind].T, np.full(len(kind), 0.5), force[:, kind])


def _through(scene: DiskBody, cut: CutContacts) -> tuple[np.ndarray, np.ndarray]:
    """Forces (3, e, 3) per stress and (3, e) as built, see `SideForces`, of contacts on the disks of one end."""
    ground, brick, locked_in = scene.ground, scene.ground.brick, scene.case.material.locked_in
    bonds = CutBonds.of(ground, cut, scene.assembly.positions)
    per_stress = np.einsum("cgt,gs->cts", bonds.on_disks, _gradients(ground.continuum.tensor))
    as_built = np.zeros(per_stress.shape[:2])
    if locked_in is not None:
        share = locked_in / ground.packed_pressure
        constants = brick_constants(ground, gaps_close=False, locked_in=share)[cut.contact_type]
        overlap = np.maximum(constants[:, 3] - constants[:, 2], 0.0)
        as_built[:2] = -constants[:, 5] * overlap * bonds.normal
        as_built -= per_stress @ (share * ground.moduli.emod * brick.stress)
    return per_stress, as_built


def _gradients(tensor: np.ndarray) -> np.ndarray:
    """Displacement gradients (4, 3), in the order of `GRADIENTS`, of unit stresses xx, yy, xy; tensor (4, 4) Pa.

    The smallest of those that differ by a rotation, which the packing does not resist.
    """
    stresses = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]])
    found: np.ndarray = np.linalg.lstsq(tensor, stresses, rcond=1e-9)[0]
    return found


def _ends(scene: DiskBody) -> tuple[CutContacts, np.ndarray]:
    """The contacts that end at sides, and the share (e,) of each that does.

    All of a contact cut by a side, and half of a contact along a side of half cells, at both disks.
    """
    brick, body = scene.ground.brick, scene.assembly
    cut = cut_contacts(brick, body, tuple(scene.edges), scene.case.periodic)
    found = [cut]
    halved = np.flatnonzero(body.contact_type % (2 * len(brick.pairs)) >= len(brick.pairs))
    kind = body.contact_type[halved].astype(np.int64) % len(brick.pairs)
    first, second = body.pairs[halved].T.astype(np.int64)
    side = _side_along(scene, first, second)
    for near, far, is_second in ((first, second, False), (second, first, True)):
        found.append(
            CutContacts(
                node=near,
                contact_type=kind,
                is_second=np.full(len(kind), is_second),
                other=body.brick_particle[far].astype(np.int64),
                tile=body.tile[far].astype(np.int64),
                image=(body.tile[far] - body.tile[near]).astype(np.int64),
                side=side,
            )
        )
    joined = {name: np.concatenate([getattr(each, name) for each in found]) for name in vars(cut)}
    return CutContacts(**joined), np.repeat([1.0, 0.5], [len(cut.node), 2 * len(kind)])


def _side_along(scene: DiskBody, first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Number (h,) of the side along which contacts of half cells run, between disks first and second (h,)."""
    side = np.full(len(first), -1)
    way = np.abs(scene.assembly.positions[second] - scene.assembly.positions[first])
    for number, name in enumerate(SIDES):
        if name in scene.edges:
            axis, nodes = normal_axis(name), scene.edges[name].nodes
            along = (way[:, 1 - axis] > way[:, axis]) & np.isin(first, nodes) & np.isin(second, nodes)
            side[along & (side < 0)] = number
    return side
