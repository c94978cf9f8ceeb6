"""The disks at each side of a body, which carry the forces with which the ground beyond held it at rest.

What disks carried that have come off goes to the remaining ones of their side, as the ground beyond would press on
these; and the work of the forces is measured against the mean motion of their side.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from dembound.boundaries.sides import SIDES
from dembound.disks.body import DiskBody
from dembound.packings.cut import cut_contacts


class Carrier(NamedTuple):
    """The disks of one part at one of its sides.

    side, part : names. nodes : (k,) ascending; share : (k,) of the force on each that belongs to this side, one over
    the number of its sides. turns : whether the part can turn, so that torques about the middle of a side are carried.
    """

    side: str
    part: str
    nodes: np.ndarray
    share: np.ndarray
    turns: bool


def carriers_of(scene: DiskBody) -> list[Carrier]:
    """The carriers of all parts of a scene: disks exposed at a side, tied there, or with contacts beyond it."""
    found = []
    for name, nodes in scene.parts.items():
        part, upright = scene.assembly.part(nodes), name == "column"
        periodic = (True, False) if upright else scene.case.periodic
        cut = cut_contacts(scene.ground.brick, part, SIDES[2:] if upright else tuple(scene.edges), periodic)
        at = {}
        for side, edge in scene.edges.items():
            own = np.concatenate([edge.nodes, scene.tied.get(side, edge.nodes[:0])])
            beyond = nodes.start + cut.node[cut.side == SIDES.index(side)]
            own = np.unique(np.concatenate([own[(own >= nodes.start) & (own < nodes.stop)], beyond]))
            if len(own):
                at[side] = own
        sides = np.bincount(np.concatenate([np.zeros(0, np.int64), *at.values()]), minlength=nodes.stop)
        found += [Carrier(side, name, own, 1.0 / sides[own], not any(periodic)) for side, own in at.items()]
    return found


def carried(
    carriers: list[Carrier],
    lost: np.ndarray,
    places: np.ndarray,
    ended: np.ndarray,
    loose: np.ndarray,
    parts: dict[str, slice],
) -> np.ndarray:
    """Forces and moments (3, n) on the remaining disks of each side in place of those lost (3, n) at that side.

    places : (2, n) m. ended : (n,) disks that carry nothing any more; loose : (n,) disks that carry no moments. What
    disks carried inside the body, or at a side without remaining disks, goes to those of all other sides of their part.
    """
    change = np.zeros_like(lost)
    for name, part in parts.items():
        own = [each for each in carriers if each.part == name]
        if not own or not lost[:, part].any():
            continue
        left = np.zeros_like(lost)
        left[:, part] = lost[:, part]
        left[:, np.concatenate([each.nodes for each in own])] = 0.0
        for each in own:
            here = np.zeros_like(lost)
            here[:, each.nodes] = each.share * lost[:, each.nodes]
            if ended[each.nodes].all():
                left += here
            else:
                _share_out(change, here, each.nodes, places, ended, loose, turns=each.turns)
        everywhere = np.unique(np.concatenate([each.nodes for each in own]))
        if left.any() and not ended[everywhere].all():
            _share_out(change, left, everywhere, places, ended, loose, turns=own[0].turns)
    return change


def _share_out(
    change: np.ndarray,
    lost: np.ndarray,
    nodes: np.ndarray,
    places: np.ndarray,
    ended: np.ndarray,
    loose: np.ndarray,
    *,
    turns: bool,
) -> None:
    """Add to change (3, n) equal forces on nodes (k,) that have not ended, with the sum and torque of those lost."""
    nodes, steady = nodes[~ended[nodes]], nodes[~loose[nodes]]
    force, moment = lost[:2].sum(axis=1), float(lost[2].sum())
    change[:2, nodes] += force[:, None] / len(nodes)
    arm = places - places[:, nodes].mean(axis=1, keepdims=True)
    turn = np.stack([-arm[1, nodes], arm[0, nodes]])
    size = float(np.sum(turn**2))
    if turns and size > 0.0:
        torque = float(np.sum(arm[0] * lost[1] - arm[1] * lost[0])) + moment
        change[:2, nodes] += torque / size * turn
    elif len(steady):
        change[2, steady] += moment / len(steady)


def relative_work(carriers: list[Carrier], force: np.ndarray, moved: np.ndarray, ended: np.ndarray) -> np.ndarray:
    """Work (J) of forces and moments (3, n) on the disks of each carrier, less that on the mean motion of its side.

    moved : (3, n) m and rad since the forces began to act; the mean is that of disks that have not ended, (n,).
    """
    work = np.zeros(len(carriers))
    for number, (_, _, nodes, share, _) in enumerate(carriers):
        held = nodes[~ended[nodes]]
        if len(held):
            apart = moved[:, nodes].copy()
            apart[:2] -= moved[:2, held].mean(axis=1, keepdims=True)
            work[number] = float(np.sum(share * force[:, nodes] * apart))
    return work
