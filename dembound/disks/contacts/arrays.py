"""Pairs of disks as arrays for the kernels: each has a place, and each disk a row of contact ends."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from dembound.disks.contacts.pair_rows import PairPlan
from dembound.disks.material.at_rest import StressAtRest, stressed
from dembound.disks.material.constants import brick_constants
from dembound.disks.material.packed_material import PackedMaterial
from dembound.kernels.began import began_of
from dembound.kernels.contacts import INTACT, NONE
from dembound.kernels.lanes import LANES
from dembound.kernels.tables import Contacts
from dembound.motion.layout import aligned_zeros
from dembound.packings.tiling import Assembly

NOTHING = np.array([[1e6, 0.0, 1e6, -1e100, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0]])
"""Constants of a place without a pair: far apart, without stiffness."""


@dataclass(frozen=True)
class Pairs:
    """Pairs: first, second (b,) particles, image (b, 2) int8 whole periods between them, contact_type (b,)."""

    first: np.ndarray
    second: np.ndarray
    image: np.ndarray
    contact_type: np.ndarray


class ContactHistory(NamedTuple):
    """The history variables of pairs (b,), see `Contacts`; place (b, 2): None without broken bonds.

    kept : None where all bonds may break.

    drag (b, 2), see `Dashed`; None without dashpots, or before they have acted.
    """

    state: np.ndarray
    shear: np.ndarray
    slip: np.ndarray
    closed: np.ndarray
    cracked: np.ndarray
    kept: np.ndarray | None = None
    place: np.ndarray | None = None
    drag: np.ndarray | None = None


class Placed(NamedTuple):
    """Pairs in their places.

    arrays, live, image : see `ContactList`. in_rows : (k,) places of pairs in rows of copies, ascending. strays : the
    contact ends of all other pairs, see `PairList`; None without rows. drag : (places, 2) N, or (0, 2).
    """

    arrays: Contacts
    live: np.ndarray
    image: np.ndarray
    in_rows: np.ndarray
    strays: tuple[np.ndarray, np.ndarray, np.ndarray] | None
    drag: np.ndarray


def in_places(
    pairs: Pairs, history: ContactHistory, slot: np.ndarray, constants: np.ndarray, plan: PairPlan | None
) -> Placed:
    """Assign places to pairs, and list the contact ends of each particle.

    slot : (m,) of each particle. constants : (p, 15) of the types of contacts. plan : rows of copies, whose places come
    first; None: there are none.
    """
    first, second = (slot[particles].astype(np.int32) for particles in (pairs.first, pairs.second))
    in_rows = np.full(len(first), -1)
    if plan is not None:
        in_rows = plan.place(pairs.first, pairs.second, pairs.contact_type)
    order = np.lexsort((pairs.image[:, 1], pairs.image[:, 0], second, first, in_rows, in_rows < 0))
    first, second, in_rows = first[order], second[order], in_rows[order]
    places = 0 if plan is None else plan.count
    shared = int(np.count_nonzero(in_rows >= 0))
    live = np.concatenate([in_rows[:shared], places + np.arange(len(order) - shared)])
    count, begin, stop = places + len(order) - shared, int(slot.min()), int(slot.max()) + 1
    if plan is not None:
        count = -(-count // LANES) * LANES  # each row of forces is aligned
    owner = np.concatenate([first, second])
    end = np.concatenate([2 * live, 2 * live + 1]).astype(np.uint32)
    start = np.zeros(stop + 1, dtype=np.uint32)
    np.cumsum(np.bincount(owner - begin, minlength=stop - begin), out=start[begin + 1 :])

    def placed(values: np.ndarray, empty: float = 0.0) -> np.ndarray:
        """Values of the pairs in their places."""
        column = aligned_zeros(count, *values.shape[1:], dtype=values.dtype)
        column[...] = empty
        column[live] = values
        return column

    arrays = Contacts(
        begin=begin,
        first=placed(first.astype(np.uint32), int(slot[0])),
        second=placed(second.astype(np.uint32), int(slot[0])),
        contact_type=placed(pairs.contact_type[order].astype(np.uint32), len(constants)),
        constants=np.vstack([constants[:, :12], NOTHING]) if plan is not None else constants[:, :12].copy(),
        began=began_of(constants if plan is None else np.vstack([constants, np.zeros(15)])),
        state=placed(history.state[order], NONE),
        shear=placed(history.shear[order]),
        slip=placed(history.slip[order]),
        closed=placed(history.closed[order]),
        cracked=placed(history.cracked[order], -1),
        place=np.zeros((count, 2)) if history.place is None else placed(history.place[order]),
        kept=np.zeros(count, dtype=np.uint8) if history.kept is None else placed(history.kept[order]),
        force=aligned_zeros(4, count),
        start=start,
        end=end[np.lexsort((end, owner))],
    )
    strays = None if plan is None else _ends_apart(owner, end, 2 * places)
    drag = np.zeros((0, 2)) if history.drag is None else placed(history.drag[order])
    return Placed(arrays, live, pairs.image[order], in_rows[:shared], strays, drag)


def _ends_apart(owner: np.ndarray, end: np.ndarray, first: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Owners (k,) of ends (e,) from number `first` on, the offsets (k + 1,) of each owner's ends, and these ends."""
    others = end >= first
    order = np.lexsort((end[others], owner[others]))
    slot, start = np.unique(owner[others][order], return_index=True)
    return slot, np.append(start, len(order)), end[others][order]


def plain_contacts(
    ground: PackedMaterial, assembly: Assembly, slot: np.ndarray, at_rest: StressAtRest | None = None
) -> Contacts:
    """The contacts of the elastic law, without history, forces and rows, for its strain energy.

    slot : (n,) in which kernels hold the assembly's particles. at_rest : stress that they begin with; None: none.
    """
    plain = brick_constants(ground, gaps_close=False, locked_in=0.0)
    constants, kind, _ = stressed(ground, plain, assembly, at_rest)
    first, second = slot[assembly.pairs.T].astype(np.uint32, order="C")
    nothing = np.zeros(0)
    return Contacts(
        begin=int(slot.min()),
        first=first,
        second=second,
        contact_type=kind.astype(np.uint32),
        constants=np.ascontiguousarray(constants[:, :12]),
        began=began_of(constants),
        state=bonds_of(constants, kind),
        shear=nothing,
        slip=nothing,
        closed=np.zeros(0, dtype=np.uint8),
        cracked=np.zeros(0, dtype=np.int64),
        place=np.zeros((0, 2)),
        kept=np.zeros(0, dtype=np.uint8),
        force=np.zeros((4, 0)),
        start=first[:0],
        end=first[:0],
    )


def bonds_of(constants: np.ndarray, contact_type: np.ndarray) -> np.ndarray:
    """States (b,) of contacts as built: intact where the rows of their types in constants (p, 15) have a bond."""
    return np.where(constants[contact_type, 7] > 0.0, INTACT, NONE).astype(np.uint8)
