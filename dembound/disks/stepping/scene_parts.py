"""The parts of a scene that are stepped: disks, free-field column, continua; their pairs and ties."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from dembound.continuum.part import GridPart
from dembound.disks.body import DiskBody
from dembound.disks.columns import COLUMNS, levels_in
from dembound.disks.contacts.contact_list import ContactList
from dembound.disks.contacts.dashpots import Dashpots
from dembound.disks.contacts.layout import with_supports
from dembound.disks.contacts.row_plan import RowPlan, plan_rows
from dembound.disks.faces.found import merged, numbers_beside
from dembound.disks.faces.tie import JointTie
from dembound.disks.material.constants import bond_factors, ground_limits
from dembound.disks.material.grouped import BEFORE, GroupedGround
from dembound.disks.material.layered import LayeredGround
from dembound.disks.stepping.arms import arms_of, arms_per_bond
from dembound.disks.stepping.damped_ground import disk_memories, ties_remembering
from dembound.disks.stepping.part import DiskPart, FreeFieldSeam
from dembound.disks.stepping.walls import Touching
from dembound.disks.surroundings.continuum import Surroundings
from dembound.disks.surroundings.jump import nodes_on_slit
from dembound.errors import RecordError
from dembound.kernels.contacts import UPDATED
from dembound.kernels.tables.contacts import LaneRows
from dembound.kernels.tables.motion import Repeats, WallTies
from dembound.laws.law import AnyLimits
from dembound.motion.part import Tie
from dembound.motion.state import Layout, arrays_of_owner
from dembound.packings.tiling import Assembly


@dataclass(frozen=True)
class Start:
    """A body at rest to start from: displacement (3, n) m and rad since it was built, and its contacts.

    contacts : of each part by name, empty if the scene's law has no history. The system that starts from them changes
    them, so a start can be used only once. has_history : whether they have any history. touching : the contacts with
    walls; None without any. joints : what joints remember, see `faces.tie.states_of`.
    """

    displacement: np.ndarray
    contacts: Mapping[str, ContactList] = field(default_factory=dict)
    has_history: bool = False
    touching: Touching | None = None
    joints: Mapping[str, np.ndarray] = field(default_factory=dict)

    @property
    def left_elastic_law(self) -> bool:
        """Whether contacts opened or slid or bonds broke under a law that starts elastic."""
        return self.has_history and all(pairs.ground.law.starts_elastic for pairs in self.contacts.values())

    def __post_init__(self) -> None:
        """Store displacements row after row, as in a record, so that sums over them have the same bits from there."""
        object.__setattr__(self, "displacement", np.ascontiguousarray(self.displacement))


def contact_lists(scene: DiskBody) -> dict[str, ContactList]:
    """The pairs of each part of a scene by its name, as built and without history."""
    return {name: _contact_list(scene, name, nodes) for name, nodes in scene.parts.items()}


def _contact_list(scene: DiskBody, name: str, nodes: slice) -> ContactList:
    """The pairs of one part's particles `nodes`; across its sides a column also has the pairs of the seam."""
    wide, high = scene.assembly.size.tolist()
    sides = zip((wide, high), scene.case.periodic, strict=True)
    along_x, along_y = (length if wraps else None for length, wraps in sides)
    held = None
    if name in COLUMNS:
        seam = scene.seams[COLUMNS.index(name)]
        along_x, (first, second, vectors) = seam.width, seam.pairs(scene.ground.brick)
        held = first - nodes.start, second - nodes.start, vectors
    part = scene.assembly.part(nodes)
    beside = numbers_beside(scene.faces)
    return ContactList(
        (scene.ground if name in COLUMNS else scene.inside).stepped,
        scene.case.material,
        part,
        (along_x, along_y),
        nodes.start,
        held,
        scene.disk_layout,
        _row_plan(scene, name, part),
        None if name in COLUMNS and scene.groups else layers_of(scene, part),
        scene.at_rest_of(name),
        bond_factors(scene.case, scene.ground, part, alike=name in COLUMNS),
        Dashpots.of(scene.case, scene.disk_layout.spread(scene.mass[: scene.disk_count])),
        None if scene.intact is None else scene.intact[nodes],
        3 * arms_per_bond(scene),
        None if beside is None or name in COLUMNS else beside[nodes],
    )


def layers_of(scene: DiskBody, part: Assembly, time: float = BEFORE) -> tuple[AnyLimits, np.ndarray, np.ndarray] | None:
    """Limits of contacts in columns, friction and resistance to rolling of each particle, at a time (s) of the run.

    In layered ground and beside groups only.
    """
    ground, materials, case = scene.inside, scene.case.materials, scene.case
    if not isinstance(ground, LayeredGround):
        return None
    if isinstance(ground, GroupedGround):
        materials = ground.materials_at(case, time)
    layer = ground.layer_of(part.positions)
    friction, rolling = (np.array([getattr(each, key) for each in materials])[layer] for key in ("fric", "rr_fric"))
    rolls = any(each.rr_fric > 0.0 for each in case.all_materials)
    return ground_limits(ground, materials, rolls=rolls), friction, rolling


def _row_plan(scene: DiskBody, name: str, part: Assembly) -> tuple[RowPlan, int] | None:
    """The rows of copies that a part's particles are held in and their first block; None if held one by one."""
    rows = scene.rows[list(scene.parts).index(name)]
    if not isinstance(rows, LaneRows):
        return None
    levels = levels_in(scene.case, scene.ground, part, scene.at_rest_of(name))
    return plan_rows(part, levels), int(rows.group_block[0])


class WallTie(Tie):
    """The half bonds between the disks and the continuum.

    Parameters
    ----------
    surroundings : the continuum and its half bonds. layout : the slots of all nodes of the scene.
    """

    def __init__(self, surroundings: Surroundings, layout: Layout) -> None:
        self._surroundings, self._layout, self.nodes = surroundings, layout, surroundings.tied
        self._last: tuple[np.ndarray, WallTies] | None = None

    def bundle(self, supported: np.ndarray) -> NamedTuple:
        """The arrays of the tie for the kernels; supported (s,) are all nodes of the support table, ascending."""
        if self._last is None or self._last[0] is not supported:  # it is asked for at every return of the loop
            self._last = supported, self._surroundings.ties(self._layout, supported)
        return self._last[1]


class TwinTie(Tie):
    """Repeats the forces that earlier ties exert on the twins of some disks on these disks.

    Parameters
    ----------
    disks : (k,) ascending. twin : (n,) twin of each of the scene's nodes.
    """

    def __init__(self, disks: np.ndarray, twin: np.ndarray) -> None:
        self.nodes, self._twin = disks, twin

    def bundle(self, supported: np.ndarray) -> NamedTuple:
        """The arrays of the tie for the kernels; supported (s,) are all nodes of the support table, ascending."""
        return Repeats(*(np.searchsorted(supported, nodes) for nodes in (self._twin[self.nodes], self.nodes)))


def disks_on_foot(scene: DiskBody) -> np.ndarray:
    """Disks (k,) of the body that have the forces of the foot on their twins in the column, ascending."""
    if not scene.feet:
        return np.zeros(0, dtype=np.int64)
    disks = np.arange(scene.column_count, scene.disk_count)
    return disks[np.isin(scene.seams[0].twin[disks], scene.feet[0].wall.bonds.particle)]


def tied_nodes(scene: DiskBody, *, seams: bool = True) -> np.ndarray:
    """Nodes (k,) of a scene that ties act on; seams : also those of a free field."""
    tied = [np.zeros(0, dtype=np.int64), *(each.tied for each in scene.continua), disks_on_foot(scene)]
    across = [seam.node for seam in scene.seams] if seams else []
    return np.concatenate([*tied, *across, nodes_on_slit(scene.outside)])


def grids(scene: DiskBody, time_step: float, *, damped: bool) -> list[GridPart]:
    """The continua of a scene, as parts to be stepped by time_step (s); damped : whether their damping acts."""
    named = [] if scene.outside is None else [(scene.outside, "continuum")]
    named += zip(scene.feet, ("foot", "right_foot"), strict=False)
    return [
        GridPart(each.body, time_step, name=name, first_node=each.first, supported=each.wall.nodes, damped=damped)
        for each, name in named
    ]


def walls(scene: DiskBody) -> list[Tie]:
    """The ties of a scene to its continua, and the tie that repeats the forces of the column's foot on the body."""
    walls: list[Tie] = [] if scene.outside is None else [WallTie(scene.outside, scene.layout)]
    if scene.feet:
        feet = [WallTie(foot, scene.layout) for foot in scene.feet]
        repeats = TwinTie(disks_on_foot(scene), scene.seams[0].twin)
        walls = [*feet, repeats, *walls]  # these forces are there before they are repeated
    return walls


def joint_ties(scene: DiskBody, start: Start | None, time_step: float) -> list[JointTie]:
    """The joints of a scene, with the history of the body from which it starts, or as built.

    Raises RecordError for a body that another version of dembound has settled.
    """
    gives = scene.moves / np.stack([scene.mass, scene.mass, scene.inertia])
    ties = []
    for faces in merged(scene.faces):
        tie = JointTie(faces, scene.assembly.positions, scene.ground, gives, scene.layout, time_step, scene.at_rest)
        if start is not None and start.joints:
            try:
                tie.go_on_from(arrays_of_owner(start.joints, tie.name))
            except (KeyError, ValueError) as error:
                reason = f"the settled body is not of this version of dembound ({error}); run the case anew"
                raise RecordError([reason]) from None
        ties.append(tie)
    return ties


class DiskParts:
    """The parts of disks of a scene, which change their law together.

    Parameters
    ----------
    scene : the scene. start : gives the contacts if the scene's law has a history; None: contacts as built.
    watches : whether the loop returns before a contact leaves the elastic law. time_step : s, for which damped ground
    remembers forces; None: damping and dashpots are left out, as in a static stage.

    Attributes
    ----------
    parts : the free-field columns, if there are any, and the body. seams : one for each column. contacts : the pairs
    of each part by name, empty if the scene's law has no history. damped_ties : the memories of ties; None without ties
    or damping. remembers_seams : whether the forces across seams are among them: not where bonds have arms.
    """

    def __init__(self, scene: DiskBody, start: Start | None, time_step: float | None, *, watches: bool) -> None:
        lists: Mapping[str, ContactList] = {}
        if scene.has_history:
            lists = contact_lists(scene) if start is None else start.contacts
        beside = [each.disk for each in scene.faces]
        supported = scene.layout.slot[np.union1d(scene.supports.node, np.concatenate([tied_nodes(scene), *beside]))]
        ground, layout = scene.inside.stepped, scene.layout
        self.parts = tuple(
            DiskPart(
                name, ground, scene.assembly.part(nodes), nodes, with_supports(rows, supported), layout,
                lists.get(name), scene.at_rest_of(name),
                None if time_step is None else disk_memories(scene, nodes, rows, supported, time_step),
                None if time_step is None or not scene.ground.relaxes else arms_of(scene, lists[name], time_step),
            )
            for (name, nodes), rows in zip(scene.parts.items(), scene.rows, strict=True)
        )  # fmt: skip
        for part in self.parts:
            part.watches = watches
            part.dashes = time_step is not None
        self.contacts = {part.name: part.contacts for part in self.parts if part.contacts is not None}
        self.seams = tuple(map(FreeFieldSeam, scene.seams, self.parts))
        self.remembers_seams = not scene.ground.relaxes
        tied = tied_nodes(scene, seams=self.remembers_seams)
        self.damped_ties = None if time_step is None else ties_remembering(scene, tied, time_step)

    @property
    def uses_history(self) -> bool:
        """Whether the history-dependent law is in use."""
        return all(part.uses_history for part in self.parts)

    @property
    def geometry_follows(self) -> bool:
        """Whether the normals and arms of the history-dependent law follow the motion."""
        return any(pairs.limits.geometry == UPDATED for pairs in self.contacts.values())

    def adopt(self, displacement: np.ndarray) -> None:
        """Set all contacts to the state of the elastic law at displacements (3, n)."""
        for pairs in self.contacts.values():
            pairs.start_from_displacements(displacement)

    @property
    def are_damped(self) -> bool:
        """Whether the forces of disks are remembered."""
        return any(part.memories is not None for part in self.parts)

    def rest_at(self, displacement: np.ndarray, of_ties: np.ndarray) -> None:
        """Let memories begin at rest at displacements (3, n), with forces of ties (3, n) other than of seams."""
        for part in self.parts:
            if part.memories is not None:
                part.memories.rest_at(part.layout.spread(displacement), part.elastic_forces(displacement))
        if self.damped_ties is not None:
            force = of_ties.copy()
            for tie in self.seams if self.remembers_seams else ():
                force[:, tie.nodes] += tie.elastic_forces(displacement)
            self.damped_ties.rest_at(force)
