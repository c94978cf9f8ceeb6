"""The order of a scene's disks in RAM, and the contacts of the elastic law for its kernels."""

from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np

from dembound.disks.contacts.row_plan import Ends, RowPlan, entries_of, plan_rows
from dembound.disks.material.packed_material import PackedMaterial
from dembound.kernels.compiler.lanes import LANES
from dembound.kernels.tables.contacts import LaneRows, NeighbourTable
from dembound.laws.law import Stiffness
from dembound.motion.state import Layout
from dembound.packings.brick import Brick
from dembound.packings.tiling import Assembly

Springs = Callable[[tuple[int, int]], Stiffness]
"""Constants of the brick's contacts between two zones, see `PackedMaterial.stiffness_of`."""


def contact_rows(
    assembly: Assembly, ground: PackedMaterial, begin: int = 0, springs: Springs | None = None
) -> NeighbourTable:
    """Sort the contacts into one row per particle, with a table of the constants of the brick's contacts.

    begin : number of the assembly's first particle in the scene. springs : in place of those of the ground.

    The rows of the table are in the order in which the particles use them, so that a loop over particles reads the
    table in order as well, and it stays in the cache of the core.
    """
    constants, row_of = elastic_constants(ground, springs)
    i, j = assembly.pairs.T
    owner = np.concatenate([i, j])
    neighbour = np.concatenate([j, i])
    contact_type = row_of[np.concatenate([2 * assembly.contact_type, 2 * assembly.contact_type + 1])]
    order = np.lexsort((neighbour, owner))
    start = np.zeros(begin + len(assembly.radii) + 1, dtype=np.uint32)
    np.cumsum(np.bincount(owner, minlength=len(assembly.radii)), out=start[begin + 1 :])
    return NeighbourTable(
        begin, start, (begin + neighbour[order]).astype(np.uint32), contact_type[order].astype(np.uint32), constants
    )


def elastic_constants(ground: PackedMaterial, springs: Springs | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Constants (4b, 6), and the row in them of contact k for its first (2k) and second disk (2k + 1).

    Contacts from number b on are those of the brick with half their stiffness, for sides of half cells; those of other
    pairings of zones follow in a layered ground.
    """
    found, rows, springs = [], [], springs or ground.stiffness_of
    for number, pairing in enumerate(ground.pairings):
        constants, row_of = _constants_of(ground.brick, springs(pairing))
        found.append(constants)
        rows.append(row_of + number * len(row_of))
    return np.vstack(found), np.concatenate(rows)


def _constants_of(brick: Brick, law: Stiffness) -> tuple[np.ndarray, np.ndarray]:
    """Constants and rows, as of `elastic_constants`, of the brick's contacts with these stiffnesses."""
    vectors = brick.vectors
    n = vectors / np.hypot(*vectors.T)[:, None]
    root_n, root_s = np.sqrt(law.normal), np.sqrt(law.shear)
    ratio = np.divide(root_s, root_n, out=np.zeros_like(root_n), where=root_n > 0.0)  # a gap without bond has neither
    common = [root_n * n[:, 0], root_n * n[:, 1], ratio]
    directed = np.empty((len(vectors), 2, 6))
    directed[:, 0] = np.stack([*common, root_s * law.arm_i, root_s * law.arm_j, law.bending], axis=1)
    directed[:, 1] = np.stack([*common, -root_s * law.arm_j, -root_s * law.arm_i, law.bending], axis=1)
    flat = directed.reshape(-1, 6)
    order = np.lexsort((brick.pairs[:, ::-1].ravel(), brick.pairs.ravel()))
    row_of = np.empty(len(order), dtype=np.int64)
    row_of[order] = np.arange(len(order))
    half = flat[order] * [np.sqrt(0.5), np.sqrt(0.5), 1.0, np.sqrt(0.5), np.sqrt(0.5), 0.5]
    return np.vstack([flat[order], half]), np.concatenate([row_of, row_of + len(order)])


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


LEAST_FILL = 0.3
"""Share of the lanes that have to hold disks for rows of copies to be worth it; two copies of a brick fill 0.25 and are
as fast one by one."""

Rows = NeighbourTable | LaneRows


NO_LEVELS: Mapping[str, np.ndarray | None] = MappingProxyType({})
"""Levels of parts all of whose copies have the same constants."""


def lay_out(
    assembly: Assembly,
    ground: PackedMaterial,
    parts: Mapping[str, slice],
    fraction: np.ndarray,
    levels: Mapping[str, np.ndarray | None] = NO_LEVELS,
) -> tuple[Layout, tuple[Rows, ...]]:
    """The slots of the disks of a scene, and the contacts of each part between them.

    A part of many copies of the brick is held in rows of copies (`lane_rows`); one of few keeps its order.
    parts : their disks, in order; fraction : (n,) of its mass that each disk has. levels : by part, see `plan_rows`.
    """
    each = [assembly.part(disks) for disks in parts.values()]
    plans = [_plan(part, levels.get(name)) for name, part in zip(parts, each, strict=True)]
    if all(plan is None for plan in plans) and not ground.is_damped:  # memories are held in blocks
        layout = Layout.plain(len(assembly.radii))
        return layout, tuple(
            contact_rows(part, ground, disks.start) for part, disks in zip(each, parts.values(), strict=True)
        )
    begins, slots, end = [], [], LANES  # a block before all, as rows reach beyond their ends
    for part, plan in zip(each, plans, strict=True):
        begins.append(end)
        slots.append(end + (np.arange(len(part.radii)) if plan is None else plan.slot))
        end += -(-len(part.radii) // LANES) * LANES if plan is None else LANES * int(plan.group_block[-1])
    layout = Layout(np.concatenate(slots), end + LANES)
    rows: list[Rows] = []
    for part, plan, begin, disks in zip(each, plans, begins, parts.values(), strict=True):
        if plan is None:
            rows.append(contact_rows(part, ground, begin))
        else:
            rows.append(lane_rows(part, ground, plan, begin, layout.count, fraction[disks]))
    return layout, tuple(rows)


def _plan(part: Assembly, levels: np.ndarray | None) -> RowPlan | None:
    """The rows of a part, if enough of their lanes would hold disks."""
    if np.prod(part.copies) == 1:
        return None
    plan = plan_rows(part, levels)
    return plan if len(part.radii) >= LEAST_FILL * LANES * plan.group_block[-1] else None


def with_supports(rows: Rows, slots: np.ndarray) -> Rows:
    """The contacts with the disks in some slots (k,) marked as supported."""
    return rows if isinstance(rows, NeighbourTable) else with_special(rows, slots)


def with_special(rows: LaneRows, slots: np.ndarray) -> LaneRows:
    """The rows with the blocks of some slots (k,) marked as special."""
    special = rows.special.copy()
    blocks = np.unique(slots // LANES)
    special[blocks[blocks < len(special)]] = True
    return rows._replace(special=special)


def fill(layout: Layout) -> float:
    """Share of the slots that hold disks."""
    return len(layout.slot) / layout.count
