"""The lists of the pairs of a scene under a history-dependent law, one for each part."""

from dembound.disks.body import DiskBody, differs_by_level
from dembound.disks.contacts.contact_list import ContactList
from dembound.disks.contacts.row_plan import RowPlan, plan_rows
from dembound.kernels.tables import LaneRows
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
        scene.at_rest,
    )


def _row_plan(scene: DiskBody, name: str, part: Assembly) -> tuple[RowPlan, int] | None:
    """The rows of copies that a part's particles are held in and their first block; None if held one by one."""
    rows = scene.rows[list(scene.parts).index(name)]
    if not isinstance(rows, LaneRows):
        return None
    return plan_rows(part, by_level=differs_by_level(scene.case, scene.ground)), int(rows.group_block[0])
