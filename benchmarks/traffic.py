"""RAM traffic and arithmetic of one step, counted from the arrays that the kernels are given.

Bytes are the least that has to be moved: every array of particles or pairs once for each pass over it, 8 bytes more
where a number is written without having been read, as its line of the cache is fetched first. Neighbours come from
cache, and so do constants, which are stored once for all copies of a disk. Slots without a particle are moved, too, and
count. Operations are additions and multiplications, a root or quotient counted as one, for existing contacts and
particles only: not for slots or lanes without one.

All numbers are for steps without steady loads, local damping and sliding contacts.
"""

from functools import singledispatch
from typing import Any, NamedTuple

import numpy as np

from dembound.kernels.compiler.lanes import LANES
from dembound.kernels.contacts import UPDATED
from dembound.kernels.tables import Bonded, DampedLinks, LaneBonded, LaneRows, Links, NeighbourTable, WatchedLinks
from dembound.motion.simulation import Simulation

COMPONENT = 40.0
"""Bytes per slot and moving component of a step: u read (8), the next u written (16), v read and written (16)."""

MOVED, MOTION = 3.0 * COMPONENT, 12.0
"""Bytes per slot, and operations per particle, half of them for new velocities, of a step of all three components."""

LANE_FLOPS = {
    (1.0, 1.0, 1.0): (20.0, 26.0, 15.0),
    (1.0, 0.0, 1.0): (9.0, 13.0, 10.0),
    (0.0, 1.0, 1.0): (9.0, 13.0, 10.0),
    (1.0, 1.0, 0.0): (10.0, 10.0, 8.0),
}
"""Which components move → operations of a contact end without and with a mask, and of a particle (elastic_lanes.py,
held_lanes.py); all others are stepped as three."""

UPDATED_BYTES, REFERENCE_BYTES = 121.0, 105.0
"""Bytes per pair: state (1) and slip (8) read, force written (64) and read (32), where the geometry follows the motion
shear read and written (16)."""

UPDATED_PAIR, REFERENCE_PAIR = 72.0, 54.0
"""Operations per pair in rows, its force added at both disks included (bonded_lanes.py): strain 36 or 18, contact and
bond 18, force and moments 12, sums 6."""

UPDATED_STRAY, REFERENCE_STRAY = 91.0, 75.0
"""Operations of pairs that are in no row (single_pairs.py), with updated and with reference geometry."""


class Cost(NamedTuple):
    """Bytes and operations of one step."""

    bytes: float
    flops: float

    def __add__(self, other: "Cost") -> "Cost":  # type: ignore[override]
        return Cost(self.bytes + other.bytes, self.flops + other.flops)


class Ends(NamedTuple):
    """Contact ends of rows of copies: in all copies of a disk, in some, and those computed one by one."""

    whole: int
    masked: int
    strays: int


def cost_of_step(simulation: Simulation) -> Cost:
    """The least bytes and the operations of one step under the law in use."""
    total = Cost(0.0, 0.0)
    free = tuple(float(each) for each in simulation.scene.free)
    for part, law in zip(simulation.system.parts, simulation.system.laws(), strict=True):
        total += law_cost(law, len(part.assembly.radii), 2 * len(part.assembly.pairs), free)
    return total


@singledispatch
def law_cost(law: Any, count: int, ends: int, free: tuple[float, ...]) -> Cost:
    """The step of a part under a law, by the type of its bundle.

    count, ends : particles of the part and ends of its contacts; free : 1, or 0 for a component held everywhere.
    """
    raise NotImplementedError(f"no count of the bytes of {type(law).__name__}")


@law_cost.register
def _(law: Links, count: int, ends: int, free: tuple[float, ...]) -> Cost:
    if isinstance(law.rows, LaneRows):
        return lane_cost(law.rows, count, lane_ends(law.rows, ends), free)
    return table_cost(law.rows, count)


@law_cost.register
def _(law: WatchedLinks, count: int, ends: int, free: tuple[float, ...]) -> Cost:
    return law_cost(law.links, count, ends, free)  # contacts are compared with their limits at few steps


@law_cost.register
def _(law: DampedLinks, count: int, ends: int, free: tuple[float, ...]) -> Cost:
    # every memory is read and written (16), and takes five operations; forces at rest (24) and kinds (4) are read
    memories, rest = law.memories, law.memories.rest.shape[1] > 0
    moved = 16.0 * memories.memory.size + (24.0 if rest else 0.0) * count + 4.0 * memories.kind.size
    return law_cost(law.links, count, ends, free) + Cost(moved, 15.0 * len(memories.mechanisms) * count)


@law_cost.register
def _(law: Bonded, count: int, ends: int, free: tuple[float, ...]) -> Cost:
    pairs = len(law.contacts.first)
    # mobilities (16), rows of ends (4 and 8 per end), u and v once more for the pairs; pairs name disks and type
    moved = (MOVED + 20.0 + 48.0) * count + (UPDATED_BYTES + 12.0 + 16.0) * pairs
    each = UPDATED_STRAY if law.limits.geometry == UPDATED else REFERENCE_STRAY
    return Cost(moved, each * pairs + (MOTION + 3.0) * count)


@law_cost.register
def _(law: LaneBonded, count: int, ends: int, free: tuple[float, ...]) -> Cost:
    places, pairs = LANES * len(law.pairs.exists), int(np.bitwise_count(law.pairs.exists).sum())
    strays = len(law.bonded.contacts.first) - places
    updated = law.bonded.limits.geometry == UPDATED
    flops = (UPDATED_PAIR if updated else REFERENCE_PAIR) * pairs
    flops += (UPDATED_STRAY if updated else REFERENCE_STRAY) * strays
    moved = (MOVED + 48.0) * slots(law.rows) + special_bytes(law.rows, len(law.stray) > 0) + len(law.pairs.masks)
    moved += ((UPDATED_BYTES if updated else REFERENCE_BYTES) + 1.0 / LANES) * places
    moved += (UPDATED_BYTES + 12.0 + 8.0) * strays
    return Cost(moved, flops + (MOTION + 3.0) * count)


def lane_cost(rows: LaneRows, count: int, ends: Ends, free: tuple[float, ...]) -> Cost:
    """Cost of the elastic law in rows of copies; of only the moving components where two move."""
    whole, masked, particle = LANE_FLOPS.get(free, LANE_FLOPS[1.0, 1.0, 1.0])
    moved = COMPONENT * (sum(free) if free in LANE_FLOPS else 3.0) * slots(rows)
    moved += special_bytes(rows, len(rows.stray) > 0) + len(rows.masks) + 8.0 * ends.strays
    return Cost(moved, whole * ends.whole + masked * ends.masked + 29.0 * ends.strays + particle * count)


def table_cost(rows: NeighbourTable, count: int) -> Cost:
    """The elastic law one by one: mobilities (16), start of the row (4), neighbour and type (8) of each end."""
    ends = len(rows.neighbour)
    return Cost((MOVED + 20.0) * count + 8.0 * ends, 29.0 * ends + MOTION * count)


def slots(rows: LaneRows) -> int:
    """Slots in the blocks of the rows."""
    return LANES * int(rows.group_block[-1] - rows.group_block[0])


def special_bytes(rows: LaneRows, strays: bool) -> float:
    """Bytes of the flags of special blocks, and those read by such blocks: mobilities, and forces of strays."""
    special = int(np.count_nonzero(rows.special[rows.group_block[0] :]))
    return slots(rows) / LANES + LANES * special * (16.0 + (72.0 if strays else 0.0))


def lane_ends(rows: LaneRows, ends: int) -> Ends:
    """How the `ends` contact ends of a part are computed."""
    masked = int(np.bitwise_count(rows.masks).sum())
    return Ends(ends - masked - len(rows.stray_neighbour), masked, len(rows.stray_neighbour))
