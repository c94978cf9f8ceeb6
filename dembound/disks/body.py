"""The arrays of a body of disks. Only this file defines their names, shapes and units."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from dembound.boundaries.half_mass import mass_factor
from dembound.boundaries.support import Edge, Supports
from dembound.casefile.disks import DiskCase
from dembound.disks.beyond.ground_motion import GroundMotion
from dembound.disks.beyond.ground_waves import GroundWaves
from dembound.disks.beyond.surroundings import Surroundings
from dembound.disks.contacts.contact_list import ContactList
from dembound.disks.contacts.layout import Rows
from dembound.disks.contacts.row_plan import RowPlan, plan_rows
from dembound.disks.material.packed_material import PackedMaterial
from dembound.kernels.tables import LaneRows
from dembound.motion.between import Between
from dembound.motion.layout import Layout
from dembound.motion.scene import Scene
from dembound.motion.threads import thread_count_for
from dembound.packings.column import Seam, nearest_in_column
from dembound.packings.tiling import Assembly


@dataclass(frozen=True)
class DiskBody(Scene):
    """A body of disks, with its free-field column if it has one, under its supports; n particles, all SI.

    Attributes
    ----------
    case : the case it was built from.
    ground : brick and material.
    assembly : the tiled brick: positions (n, 2) m, radii (n,) m, brick_particle (n,), contacts.
    rows : contacts of the elastic law for the kernels, of each part.
    edges : side -> its exposed particles, for every side that is not periodic.
    supports : the table of forces from outside, loads that follow a wave included.
    monitors : name -> particle, or the nearest node of the continuum.
    seam : the connection between the free-field column, whose particles come first in the arrays, and the body; None
    without a column.
    slots : the slots in which kernels hold its particles; None: in their order.
    outside : the continuum on some sides, whose nodes follow the particles; None for none.
    foot : the continuum below the free-field column, whose nodes come last; None for none.
    between : name -> place, of the monitors in the continuum, and of twins of monitors without a column.
    ground_waves : the motion of the ground without the body, which the continuum does not have; None without any.
    """

    case: DiskCase
    ground: PackedMaterial
    assembly: Assembly
    rows: tuple[Rows, ...]
    edges: Mapping[str, Edge]
    supports: Supports
    monitors: Mapping[str, int]
    seam: Seam | None = None
    slots: Layout | None = None
    outside: Surroundings | None = None
    foot: Surroundings | None = None
    between: Mapping[str, Between] = field(default_factory=dict)
    ground_waves: GroundWaves | None = None

    kind = "disks"
    energy_unit = "J/m"
    record_width = 6
    block = 256

    @property
    def attributes(self) -> dict[str, Any]:
        """The attributes of a record's header in addition to those of every run."""
        return {"seed": getattr(self.case.packing, "seed", 0), "column": 0 if self.seam is None else self.seam.count}

    @property
    def columns(self) -> dict[str, tuple[np.ndarray, str]]:
        """Data of every particle for the record, by name: values (n, …) and unit."""
        assembly, bonded = self.assembly, self.ground.moduli.pb_emod > 0.0
        return {
            "position": (assembly.positions, "m"),
            "radius": (assembly.radii, "m"),
            "brick_particle": (assembly.brick_particle, "1"),
            "column": (self._in_column, "1"),
            "bonds": (np.bincount(assembly.pairs.ravel(), minlength=self.disk_count) * int(bonded), "1"),
        }

    @property
    def _in_column(self) -> np.ndarray:
        """(m,) bool, whether each particle belongs to the free-field column."""
        return np.arange(self.disk_count) < (0 if self.seam is None else self.seam.count)

    @property
    def places(self) -> dict[str, tuple[float, float]]:
        """The positions given for the monitors, m."""
        return {monitor.name: monitor.position for monitor in self.case.monitor}

    @property
    def disk_count(self) -> int:
        """Number of its particles, which come first."""
        return len(self.assembly.radii)

    @property
    def count(self) -> int:
        """Number of particles and of nodes of continua, n."""
        return self.disk_count + sum(each.count for each in self.continua)

    @property
    def continua(self) -> tuple[Surroundings, ...]:
        """The continua, in the order of their nodes."""
        return tuple(each for each in (self.outside, self.foot) if each is not None)

    @cached_property
    def on_foot(self) -> np.ndarray:
        """Disks (k,) of the body that have the forces of the foot on their twins in the column, ascending."""
        if self.foot is None or self.seam is None:
            return np.zeros(0, dtype=np.int64)
        disks = np.arange(self.seam.count, self.disk_count)
        return disks[np.isin(self.seam.twin[disks], self.foot.wall.bonds.particle)]

    @property
    def recorded(self) -> int:
        """The particles; nodes of the continuum are recorded apart."""
        return self.disk_count

    @cached_property
    def in_snapshots(self) -> tuple[str, ...]:  # type: ignore[override]
        """What the case asks for, and the motion of a continuum."""
        beside = () if self.outside is None else ("displacement", "velocity", "stress")
        asked = ("stress", self.case.output.stress), ("contacts", self.case.output.contacts)
        return (*(name for name, there in asked if there), *(f"continuum/{name}" for name in beside))

    @property
    def nodes_beside(self) -> slice:
        """The nodes of the continuum round the body."""
        return slice(self.count, self.count) if self.outside is None else self.outside.nodes

    @cached_property
    def twin_beside(self) -> np.ndarray | None:
        """(m,) disk of the free-field column nearest to each node of the continuum round the body, modulo its width.

        −1 below the ground that the column stands for; None without one.
        """
        if self.outside is None or self.seam is None:
            return None
        return nearest_in_column(self.assembly, self.outside.body.mesh.positions)

    def motion_beside(self, values: np.ndarray, of: str, time: float) -> dict[str, np.ndarray]:
        """Motion (m, 3) of the nodes of the continuum, from that of all nodes (n, 3).

        Where the ground moves or rests without the body it is "scattered_", and "" the sum of it and the ground's.
        """
        own = values[self.nodes_beside]
        if self.outside is None:
            return {}
        total = own.copy()
        if self.seam is not None and self.twin_beside is not None:
            total += self._ground_motion.at_heights(values[: self.seam.count]) * (self.twin_beside >= 0)[:, None]
        if self.ground_waves is not None:
            total += self.ground_waves.motion(of, np.array([time]), self.outside.body.mesh.positions)[0]
        return {"": total, "scattered_": own} if self._is_scattered else {"": own}

    @property
    def _is_scattered(self) -> bool:
        """Whether the continuum has only what differs from the motion of the ground without the body."""
        return self.seam is not None or self.ground_waves is not None

    @property
    def beside(self) -> dict[str, tuple[np.ndarray, str]]:
        """Data of the nodes of the continuum for the record."""
        if self.outside is None:
            return {}
        more: dict[str, tuple[np.ndarray, str]] = {}
        if self.twin_beside is not None:
            more["twin"] = (self.twin_beside, "1")
        if self._is_scattered:
            below = np.zeros(self.outside.count, dtype=np.bool_) if self.twin_beside is None else self.twin_beside < 0
            more["total"] = (~below, "1")
        return self.outside.columns | more

    @cached_property
    def _ground_motion(self) -> GroundMotion:
        """At the nodes of the continuum."""
        assert self.seam is not None
        column, up = slice(0, self.seam.count), self.positions[:, 1]
        return GroundMotion(up[column], self.mass[column], self.ground.brick.mean_diameter, up[self.nodes_beside])

    @cached_property
    def positions(self) -> np.ndarray:  # type: ignore[override]  # computed once
        """(n, 2) m."""
        return np.vstack([self.assembly.positions, *(each.body.mesh.positions for each in self.continua)])

    @property
    def size(self) -> np.ndarray:
        """(2,) width and height, m."""
        return self.assembly.size

    @cached_property
    def layout(self) -> Layout:  # type: ignore[override]  # computed once
        """Where kernels hold its particles."""
        layout = self._disk_layout
        for each in self.continua:
            layout = each.laid_out(layout)
        return layout

    @property
    def _disk_layout(self) -> Layout:
        """Where kernels hold its particles, without the nodes of continua."""
        return Layout.plain(self.disk_count) if self.slots is None else self.slots

    @property
    def threads(self) -> int:
        """Threads its steps use."""
        return thread_count_for(self.count)

    @property
    def parts(self) -> dict[str, slice]:
        """The particles of each part: of the free-field column, if there is one, and of the body."""
        return parts_of(self.disk_count, self.seam)

    @property
    def twin(self) -> np.ndarray | None:
        """(n,) twin of each particle in the free-field column, of other nodes themselves; None without a column."""
        if self.seam is None:
            return None
        return np.concatenate([self.seam.twin, np.arange(self.disk_count, self.count)])

    @property
    def damp(self) -> float:
        """Local damping coefficient."""
        return self.case.material.damp

    @cached_property
    def mass(self) -> np.ndarray:
        """(n,) kg; half of it for particles on sides with half mass."""
        return self._with_nodes(self.ground.mass[self.assembly.brick_particle] * self.cell_fraction)

    @cached_property
    def inertia(self) -> np.ndarray:
        """(n,) kg·m², halved with the mass; of nodes of the continuum, which do not rotate, that of the mass at 1 m."""
        return self._with_nodes(self.ground.inertia[self.assembly.brick_particle] * self.cell_fraction)

    def _with_nodes(self, of_disks: np.ndarray) -> np.ndarray:
        """Masses of the particles (m,), followed by those of the nodes of continua."""
        return np.concatenate([of_disks, *(each.body.mass for each in self.continua)])

    @cached_property
    def cell_fraction(self) -> np.ndarray:
        """(n,) part of a particle's cell inside the scene: 1, on a side of half cells ½, where two such meet ¼."""
        return mass_factor(self.disk_count, self.edges, self.case.boundary)

    @cached_property
    def free(self) -> np.ndarray:
        """(3,) 1 for a component that moves, 0 for one held everywhere."""
        free = np.ones(3)
        free[list(self.ground.held)] = 0.0
        return free

    @property
    def moves(self) -> np.ndarray:
        """(3, n) bool, False for components that are held or prescribed; nodes of a continuum do not rotate."""
        moves = super().moves
        moves[2, self.disk_count :] = False
        for each in self.continua:
            moves[:2, each.nodes] &= ~each.body.mesh.held
        return moves

    @property
    def has_history(self) -> bool:  # type: ignore[override]  # a constant of other kinds
        """Whether the scene's law is history-dependent: contacts that open and slide, bonds that break."""
        return self.ground.law.has_history

    def contact_lists(self) -> dict[str, ContactList]:
        """The pairs of each part, without history."""
        return {name: self._contact_list(name, nodes) for name, nodes in self.parts.items()}

    def _contact_list(self, name: str, nodes: slice) -> ContactList:
        """The pairs of one part."""
        wide, high = self.assembly.size.tolist()
        sides = zip((wide, high), self.case.periodic, strict=True)
        along_x, along_y = (length if wraps else None for length, wraps in sides)
        held = None
        if self.seam is not None and name == "column":
            along_x, held = self.seam.width, self.seam.pairs(self.ground.brick)
        part = self.assembly.part(nodes)
        return ContactList(
            self.ground,
            self.case.material,
            part,
            (along_x, along_y),
            nodes.start,
            held,
            self._disk_layout,
            self._row_plan(name, part),
        )

    def _row_plan(self, name: str, part: Assembly) -> tuple[RowPlan, int] | None:
        """The rows of copies that a part's particles are held in, if they are, and their first block."""
        rows = self.rows[list(self.parts).index(name)]
        return (plan_rows(part), int(rows.group_block[0])) if isinstance(rows, LaneRows) else None


def parts_of(count: int, seam: Seam | None) -> dict[str, slice]:
    """The particles of each part of `count` in all: of the free-field column, if there is one, and of the body."""
    if seam is None:
        return {"body": slice(0, count)}
    return {"column": slice(0, seam.count), "body": slice(seam.count, count)}
