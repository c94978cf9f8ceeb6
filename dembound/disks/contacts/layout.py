"""The order of a scene's disks in RAM, and the contacts of the elastic law in that order."""

from collections.abc import Mapping

import numpy as np

from dembound.disks.contacts.lane_rows import lane_rows
from dembound.disks.contacts.row_plan import RowPlan, plan_rows
from dembound.disks.contacts.rows import contact_rows
from dembound.disks.material.packed_material import PackedMaterial
from dembound.kernels.lanes import LANES
from dembound.kernels.tables import LaneRows, NeighbourTable
from dembound.motion.layout import Layout
from dembound.packings.tiling import Assembly

LEAST_FILL = 0.3
"""Share of the lanes that have to hold disks for rows of copies to be worth it; two copies of a brick fill 0.25 and are
as fast one by one."""

Rows = NeighbourTable | LaneRows


def lay_out(
    assembly: Assembly,
    ground: PackedMaterial,
    parts: Mapping[str, slice],
    fraction: np.ndarray,
    *,
    by_level: bool = False,
) -> tuple[Layout, tuple[Rows, ...]]:
    """The slots of the disks of a scene, and the contacts of each part between them.

    A part of many copies of the brick is held in rows of copies (lane_rows.py); one of few keeps its order.
    parts : their disks, in order; fraction : (n,) of its mass that each disk has. by_level : see `plan_rows`.
    """
    each = [assembly.part(disks) for disks in parts.values()]
    plans = [_plan(part, by_level=by_level) for part in each]
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


def _plan(part: Assembly, *, by_level: bool) -> RowPlan | None:
    """The rows of a part, if enough of their lanes would hold disks."""
    if np.prod(part.copies) == 1:
        return None
    plan = plan_rows(part, by_level=by_level)
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
