"""Pairs of disks with their history, in the places where kernels hold them."""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from dembound.disks.contacts.pair_rows import PairPlan
from dembound.kernels.common import CHUNKS
from dembound.kernels.compiler.lanes import LANES
from dembound.kernels.compiler.start_strain import began_of
from dembound.kernels.contacts import NONE
from dembound.kernels.listing import ends_of, keys_of
from dembound.kernels.near import CODES
from dembound.kernels.tables.contacts import Contacts
from dembound.motion.state import aligned_zeros
from dembound.pairwise import of_law

NO_DASHPOTS: dict[str, Any] = {"viscosity": np.zeros((2, 0)), "drag": np.zeros((2, 0)), "damps_bonds": True}
"""Fields of `Contacts` without dashpots."""

NO_ARMS: dict[str, Any] = {"lag": np.zeros((0, 0))}
"""Fields of `Contacts` without relaxation arms."""

NO_ROLLING: dict[str, Any] = {"rolled": np.zeros(0)}
"""Field of `Contacts` where no contact resists rolling."""


NOTHING = np.array([1e6, 0.0, 1e6, -1e100, 0.0])
"""Where a place without a pair is: far apart. The other constants there are 0."""


@dataclass(frozen=True)
class Pairs:
    """Pairs: first, second (b,) particles, image (b, 2) int8 whole periods between them, contact_type (b,)."""

    first: np.ndarray
    second: np.ndarray
    image: np.ndarray
    contact_type: np.ndarray


class ContactHistory(NamedTuple):
    """The history variables of pairs (b,), see `Contacts`; place (b, 2): None without broken bonds.

    kept : None where all bonds may break. force (b, 4), and drag (b, 2) N; None before they have acted. lag : (b, 3K);
    None before relaxation arms have acted, or without any. rolled : None before contacts roll, or where none resists.
    """

    state: np.ndarray
    shear: np.ndarray
    slip: np.ndarray
    closed: np.ndarray
    cracked: np.ndarray
    kept: np.ndarray | None = None
    place: np.ndarray | None = None
    force: np.ndarray | None = None
    drag: np.ndarray | None = None
    lag: np.ndarray | None = None
    rolled: np.ndarray | None = None


class Placed(NamedTuple):
    """Pairs in their places.

    arrays : see `PairList`. live : (b,) places of the pairs, those in rows of copies first, ascending; in_rows : number
    of these. images : (places, 2) int8, see `Pairs`. keys : (b,) int64 of the pairs, of which those in no row ascend,
    see near.near_keys; their disks are given by slots.
    """

    arrays: Contacts
    live: np.ndarray
    in_rows: int
    images: np.ndarray
    keys: np.ndarray


def numbers_of(keys: np.ndarray, among: np.ndarray, order: np.ndarray) -> np.ndarray:
    """Number (k,) of each key among others (b,), in the order (b,) of which these ascend; −1 for none."""
    if len(among) == 0:
        return np.full(len(keys), -1)
    at = order[np.minimum(np.searchsorted(among, keys, sorter=order), len(among) - 1)]
    return np.where(among[at] == keys, at, -1)


SPARE = 8
"""One in so many places for pairs in no row is spare at least, for pairs that are met."""


def in_places(
    pairs: Pairs, history: ContactHistory, slot: np.ndarray, constants: np.ndarray, plan: PairPlan | None, room: int = 0
) -> Placed:
    """Assign places to pairs, and list the contact ends of each particle of those in no row.

    slot : (m,) of each particle. constants : (p, c + 3) of the types of contacts. plan : rows of copies, whose places
    come first; None: there are none. room : places for pairs in no row that are needed.
    """
    first, second = (slot[particles].astype(np.int64) for particles in (pairs.first, pairs.second))
    begin, stop = int(slot.min()), int(slot.max()) + 1
    in_rows = np.full(len(first), -1)
    if plan is not None:
        in_rows = plan.place(pairs.first, pairs.second, pairs.contact_type)
    keys = keys_of(first, second, pairs.image, stop)
    order = np.argsort(np.where(in_rows >= 0, in_rows - 2**62, keys), kind="stable")
    first, second, in_rows, keys = first[order], second[order], in_rows[order], keys[order]
    places = 0 if plan is None else plan.count
    shared = int(np.count_nonzero(in_rows >= 0))
    singles = len(order) - shared
    live = np.concatenate([in_rows[:shared], places + np.arange(singles)])
    count = places + max(singles, room)
    count = -(-(count + (count - places) // SPARE + LANES) // LANES) * LANES  # each row of forces is aligned
    nothing = np.pad(NOTHING, (0, constants.shape[1] - len(NOTHING)))
    constants = np.vstack([constants, nothing])  # the last type is that of places without a pair

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
        contact_type=placed(pairs.contact_type[order].astype(np.uint32), len(constants) - 1),
        constants=of_law(constants),
        began=began_of(constants),
        state=placed(history.state[order], NONE),
        shear=placed(history.shear[order]),
        slip=placed(history.slip[order]),
        closed=placed(history.closed[order]),
        cracked=placed(history.cracked[order], -1),
        place=np.zeros((count, 2)) if history.place is None else placed(history.place[order]),
        kept=np.zeros(count, dtype=np.uint8) if history.kept is None else placed(history.kept[order]),
        force=aligned_zeros(4, count),
        **NO_DASHPOTS,
        **NO_ARMS,
        **NO_ROLLING,
        start=np.zeros(0, np.uint32),
        end=np.zeros(0, np.uint32),
        bound=np.zeros(0, np.int64),
    )
    if history.force is not None:
        arrays.force[:, live] = history.force[order].T
    if history.drag is not None:
        drag = aligned_zeros(2, count)
        drag[:, live] = history.drag[order].T
        arrays = arrays._replace(drag=drag)
    if history.lag is not None:
        lag = aligned_zeros(history.lag.shape[1], count)
        lag[:, live] = history.lag[order].T
        arrays = arrays._replace(lag=lag)
    if history.rolled is not None:
        arrays = arrays._replace(rolled=placed(history.rolled[order]))
    arrays = with_ends(arrays, keys[shared:], places, stop)
    return Placed(arrays, live, shared, placed(pairs.image[order]), keys)


LEAST_DISKS = 256
"""Disks whose pairs in no row are one chunk at least: the last pairs of each do not fill their lanes."""


def with_ends(arrays: Contacts, keys: np.ndarray, begin: int, stop: int) -> Contacts:
    """Contacts with the ends of their pairs in no row, whose keys (k,) ascend and whose places start at `begin`.

    stop : end of the slots of their disks.
    """
    singles = slice(begin, begin + len(keys))
    start, end = ends_of(arrays.first[singles], arrays.second[singles], begin, arrays.begin, stop)
    shares = min(max((stop - arrays.begin) // LEAST_DISKS, 1), CHUNKS)
    bounds = arrays.begin + np.arange(CHUNKS + 1) * shares // CHUNKS * (stop - arrays.begin) // shares
    return arrays._replace(start=start, end=end, bound=begin + np.searchsorted(keys, bounds * stop * CODES))
