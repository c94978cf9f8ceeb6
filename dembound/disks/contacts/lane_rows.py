"""The contacts between rows of copies, for kernels/elastic_lanes.py."""

import numpy as np

from dembound.disks.contacts.lane_entries import Ends, entries_of
from dembound.disks.contacts.row_plan import RowPlan
from dembound.disks.contacts.rows import elastic_constants
from dembound.disks.material.packed_material import PackedMaterial
from dembound.kernels.lanes import LANES
from dembound.kernels.tables import LaneRows
from dembound.packings.tiling import Assembly


def lane_rows(
    assembly: Assembly, ground: PackedMaterial, plan: RowPlan, begin: int, slots: int, fraction: np.ndarray
) -> LaneRows:
    """The contacts of an assembly between its rows.

    begin : slot of the first block; slots : number of slots of the scene; fraction (n,) of its mass that each disk has.
    """
    table, row_of = elastic_constants(ground)
    constants = matrices(table)
    first_block, rows = begin // LANES, int(plan.group_row[-1])
    joined, ends = entries_of(Ends.of(assembly, plan.slot, row_of), plan)
    whole = joined.mask < 0
    order = np.lexsort((~whole, joined.row))
    own = np.zeros((rows, 3))
    np.add.at(own, joined.row[whole], constants[joined.line[whole], 8:])
    start = np.zeros((rows + 1, 2), dtype=np.int64)
    start[1:, 0] = np.cumsum(np.bincount(joined.row, minlength=rows))
    start[:-1, 1] = start[:-1, 0] + np.bincount(joined.row[whole], minlength=rows)
    special = np.zeros(first_block + plan.group_block[-1], dtype=np.bool_)
    slot = begin + plan.slot
    special[slot[fraction != 1.0] // LANES] = True
    special[(begin + ends.slot) // LANES] = True
    mass, inertia = np.zeros(rows), np.zeros(rows)
    mass[plan.row], inertia[plan.row] = ground.disk_masses(assembly)
    return LaneRows(
        group_row=plan.group_row,
        group_block=first_block + plan.group_block,
        inverse_mass=1.0 / mass,
        inverse_inertia=1.0 / inertia,
        start=start,
        shift=joined.shift[order],
        mask=joined.mask[order],
        masks=joined.masks,
        constants=np.ascontiguousarray(constants[joined.line[order], :8]),
        turn=np.ascontiguousarray(constants[joined.line[order], 8:]),
        own=own,
        special=special,
        **_strays(ends, begin),
        stray_constants=table,
        extra=np.zeros((3, slots if len(ends.line) else LANES)),
    )


def matrices(table: np.ndarray) -> np.ndarray:
    """Constants (p, 11) of contacts as matrices, from rows (p, 6) of elastic.py.

    Force on i by Δx, Δy of j relative to i and by θ_j: [xx, xy, yy, xθ, yθ], its moment by these [θx, θy, θθ], and
    force and moment by θ_i, [x, y, θ].
    """
    x, y, ratio, arm_i, arm_j, bending = table.T
    across, up = -ratio * y, ratio * x  # √k_s t
    return np.stack(
        [
            x * x + across * across,
            x * y + across * up,
            y * y + up * up,
            -across * arm_j,
            -up * arm_j,
            arm_i * across,
            arm_i * up,
            bending - arm_i * arm_j,
            -across * arm_i,
            -up * arm_i,
            -bending - arm_i * arm_i,
        ],
        axis=1,
    )


def _strays(ends: Ends, begin: int) -> dict[str, np.ndarray]:
    """The contact ends that are in no entry, by their owners, see `LaneRows`."""
    ends = ends.at(np.lexsort((ends.other, ends.line, ends.slot)))
    slot, start = np.unique(ends.slot, return_index=True)
    return {
        "stray": begin + slot,
        "stray_start": np.append(start, len(ends.slot)),
        "stray_neighbour": (begin + ends.other).astype(np.uint32),
        "stray_type": ends.line.astype(np.uint32),
    }
