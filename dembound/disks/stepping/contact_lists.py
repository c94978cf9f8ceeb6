"""The lists of the pairs of a scene under a history-dependent law, one for each part."""

import numpy as np

from dembound.disks.body import DiskBody, differs_by_level
from dembound.disks.contacts.contact_list import ContactList
from dembound.disks.contacts.dashpots import Dashpots
from dembound.disks.contacts.row_plan import RowPlan, plan_rows
from dembound.disks.material.constants import ground_limits
from dembound.disks.material.layered import LayeredGround
from dembound.disks.material.scatter import bond_factors
from dembound.kernels.tables import LaneRows, Limits
from dembound.packings.tiling import Assembly


def contact_lists(scene: DiskBody) -> dict[str, ContactList]:
    """The pairs of each part of a scene by its name, as built and without history."""
    return {name: _contact_list(scene, name, nodes) for name, nodes in scene.parts.items()}


def _contact_list(scene: DiskBody, name: str, nodes: slice) -> ContactList:
    """The pairs of one part's particles `nodes`; across its sides a column also has the pairs of the seam."""
    wide, high = scene.assembly.size.tolist()
    sides = zip((wide, high), scene.case.periodic, strict=True)
    along_x, along_y = (length if wraps else None for length, wraps in sides)
    held = None
    if scene.seam is not None and name == "column":
        along_x, held = scene.seam.width, scene.seam.pairs(scene.ground.brick)
    part = scene.assembly.part(nodes)
    return ContactList(
        scene.ground,
        scene.case.material,
        part,
        (along_x, along_y),
        nodes.start,
        held,
        scene.disk_layout,
        _row_plan(scene, name, part),
        _layers(scene, part),
        scene.at_rest,
        bond_factors(scene.case, scene.ground, part, alike=name == "column"),
        Dashpots.of(scene.case.material, scene.disk_layout.spread(scene.mass[: scene.disk_count])),
        None if scene.intact is None else scene.intact[nodes],
    )


def _layers(scene: DiskBody, part: Assembly) -> tuple[Limits, np.ndarray] | None:
    """In layered ground the limits of contacts in columns and the friction of each particle; None in other ground."""
    ground, materials = scene.ground, scene.case.materials
    if not isinstance(ground, LayeredGround):
        return None
    friction = np.array([each.fric for each in materials])[ground.layer_of(part.positions[:, 1])]
    return ground_limits(ground, materials), friction


def _row_plan(scene: DiskBody, name: str, part: Assembly) -> tuple[RowPlan, int] | None:
    """The rows of copies that a part's particles are held in and their first block; None if held one by one."""
    rows = scene.rows[list(scene.parts).index(name)]
    if not isinstance(rows, LaneRows):
        return None
    return plan_rows(part, by_level=differs_by_level(scene.case, scene.ground)), int(rows.group_block[0])
