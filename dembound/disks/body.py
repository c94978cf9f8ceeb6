"""The arrays of a body of disks. Only this file defines their names, shapes and units."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np

from dembound.boundaries.edge import Edge
from dembound.boundaries.half_mass import half_contacts, mass_factor
from dembound.boundaries.support import Supports
from dembound.casefile.disks.load import FREE_FIELD
from dembound.casefile.disks.model import DiskCase
from dembound.disks.bearing import Springs
from dembound.disks.columns import COLUMNS, free_field_attributes, parts_of, rest_beside
from dembound.disks.contacts.layout import Rows
from dembound.disks.faces.found import Faces
from dembound.disks.intact import intact_disks, intact_zones
from dembound.disks.material.at_rest import AtRest, stress_at_rest
from dembound.disks.material.constants import brick_constants
from dembound.disks.material.grouped import GroupedGround
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.surroundings.continuum import Surroundings
from dembound.disks.surroundings.layered_waves import Undisturbed
from dembound.disks.surroundings.recorded import RecordedContinuum
from dembound.motion.memory import thread_count_for
from dembound.motion.scene import Between, Scene
from dembound.motion.state import Layout
from dembound.packings.brick import Brick
from dembound.packings.column import Seam, columns_end
from dembound.packings.tiling import Assembly


def with_half_contacts(
    case: DiskCase, brick: Brick, assembly: Assembly, seams: Sequence[Seam], edges: Mapping[str, Edge]
) -> tuple[Assembly, tuple[Seam, ...]]:
    """Replace contacts along sides of half cells, also across seams, by types with half the stiffness."""
    vectors, whole = brick.vectors, len(brick.pairs)

    def halved(contact_type: np.ndarray, first: np.ndarray, second: np.ndarray) -> np.ndarray:
        plain = contact_type % whole
        half = half_contacts(first, second, vectors[plain], edges, case.boundary)
        return plain + whole * half.astype(contact_type.dtype)

    assembly = replace(assembly, contact_type=halved(assembly.contact_type, *assembly.pairs.T))
    halves = []
    for seam in seams:
        owner = np.repeat(seam.twin[seam.node], seam.contact_counts)
        halves.append(replace(seam, contact_type=halved(seam.contact_type, owner, seam.neighbour)))
    return assembly, tuple(halves)


def with_layers(ground: PackedMaterial, assembly: Assembly, seams: Sequence[Seam]) -> tuple[Assembly, tuple[Seam, ...]]:
    """Replace the contacts of a layered ground, also across seams, by types with the springs of their zones."""
    if not ground.is_layered:
        return assembly, tuple(seams)
    places, types = assembly.positions, 2 * len(ground.brick.pairs)
    pairing = ground.pairing_of(*places[assembly.pairs.T])
    assembly = replace(assembly, contact_type=(assembly.contact_type + types * pairing).astype(np.int32))
    own = []
    for seam in seams:
        owner, other = places[np.repeat(seam.twin[seam.node], seam.contact_counts)], places[seam.neighbour]
        swapped = seam.twin_is_second[:, None]
        pairing = ground.pairing_of(np.where(swapped, other, owner), np.where(swapped, owner, other))
        own.append(replace(seam, contact_type=seam.contact_type + types * pairing))
    return assembly, tuple(own)


@dataclass(frozen=True)
class DiskBody(Scene):
    """A body of disks, with its free-field column if it has one, under its supports; n particles, all SI.

    Attributes
    ----------
    case : the case it was built from. ground : brick and material.
    assembly : the tiled brick: positions (n, 2) m, radii (n,) m, brick_particle (n,), contacts.
    rows : contacts of the elastic law for the kernels, of each part. edges : side -> its exposed particles, for every
    side that is not periodic. supports : the table of forces from outside, loads that follow a wave included.
    monitors : name -> particle, or the nearest node of the continuum.
    seams : the connections between free-field columns, whose particles come first in the arrays, and the body; one
    column stands for the ground at all sides, or of two the first for that at the left and below.
    slots : the slots in which kernels hold its particles; None: in their order. outside : the continuum on some sides,
    whose nodes follow the particles; None for none. feet : those below the free-field columns, whose nodes come last.
    between : name -> place, of the monitors in the continuum, and of twins of monitors without a column.
    ground_waves : the motion of the ground without the body, which the continuum does not include; None without any.
    surface : points (2, k) m on its free surface at rest; None where it is level at the top of the ground.
    all_intact : whether no bond breaks, as in the free-field column of a body with intact zones, settled by itself.
    faces : of its joints. groups : the ground of its disks, of which some are in groups; None without groups.
    """

    case: DiskCase
    ground: PackedMaterial
    assembly: Assembly
    rows: tuple[Rows, ...]
    edges: Mapping[str, Edge]
    supports: Supports
    monitors: Mapping[str, int]
    seams: tuple[Seam, ...] = ()
    slots: Layout | None = None
    outside: Surroundings | None = None
    feet: tuple[Surroundings, ...] = ()
    between: Mapping[str, Between] = field(default_factory=dict)
    ground_waves: Undisturbed | None = None
    surface: np.ndarray | None = None
    all_intact: bool = False
    faces: tuple[Faces, ...] = ()
    groups: GroupedGround | None = None

    kind = "disks"
    energy_unit = "J/m"
    record_width = 6
    block = 256

    @property
    def attributes(self) -> dict[str, Any]:
        """The attributes of a record's header in addition to those of every run.

        Of layers their names, and heights (m) of joints from the surface down; where these differ at both sides those
        of each, and the numbers of its layers, from 1.
        """
        case, found = self.case, {"seed": getattr(self.case.packing, "seed", 0), "column": self.column_count}
        if case.layer_planes:
            found["layer_names"] = [*case.layer_names]
            if not case.is_unlike:
                return found | {"joints": [*case.layer_planes]}
            found["meet"] = case.ground.meet
            for side in case.sides_of_ground:
                found[f"{side}_layers"] = [1 + number for number in case.numbers_beside(side)]
                found[f"{side}_joints"] = np.array(case.beside(side).layer_planes)
        return found

    @property
    def columns(self) -> dict[str, tuple[np.ndarray, str]]:
        """Data of every particle for the record, by name: values (n, …) and unit."""
        assembly, bonded = self.assembly, self.ground.moduli.pb_emod > 0.0
        layer = self.ground.layer_of(assembly.positions) + 1
        return {
            "position": (assembly.positions, "m"),
            "radius": (assembly.radii, "m"),
            "brick_particle": (assembly.brick_particle, "1"),
            "column": (np.arange(self.disk_count) < self.column_count, "1"),
            "bonds": (np.bincount(assembly.pairs.ravel(), minlength=self.disk_count) * int(bonded), "1"),
        } | ({"layer": (layer.astype(np.int32), "1")} if self.ground.is_layered else {})

    @property
    def places(self) -> dict[str, tuple[float, float]]:
        """Requested positions of the monitors, m, by name."""
        return {monitor.name: monitor.position for monitor in self.case.monitor}

    def attributes_of_monitor(self, name: str) -> dict[str, Any]:
        """Of a free field the side and the surface of its ground."""
        ground = self.case, self.seams, self.outside, self.monitored[name]
        return free_field_attributes(*ground) if name.endswith(FREE_FIELD) else {}

    @property
    def inside(self) -> PackedMaterial:
        """The ground of the disks of the body, with its groups, by which their contacts are."""
        return self.groups or self.ground

    @property
    def disk_count(self) -> int:
        """Number of particles, which come before the nodes of continua."""
        return len(self.assembly.radii)

    @property
    def column_count(self) -> int:
        """Number of the particles of its free-field columns, which come first; 0 without a column."""
        return columns_end(self.seams)

    @property
    def count(self) -> int:
        """Number of particles and of nodes of continua, n."""
        return self.disk_count + sum(each.count for each in self.continua)

    @property
    def continua(self) -> tuple[Surroundings, ...]:
        """The continua, in the order of their nodes."""
        return self.feet if self.outside is None else (self.outside, *self.feet)

    @property
    def recorded(self) -> int:
        """Number of nodes recorded as particles: the disks; nodes of the continuum are recorded separately."""
        return self.disk_count

    @cached_property
    def in_snapshots(self) -> tuple[str, ...]:  # type: ignore[override]
        """Names of the recorded fields: those requested in the case, and the motion of a continuum."""
        beside = () if self.outside is None else ("displacement", "velocity", "stress")
        asked = ("stress", self.case.output.stress), ("contacts", self.case.output.contacts)
        return (*(name for name, there in asked if there), *(f"continuum/{name}" for name in beside))

    @cached_property
    def beside(self) -> RecordedContinuum | None:  # type: ignore[override]  # computed once
        """The nodes of the continuum round the body, which are recorded separately; None without it."""
        if self.outside is None:
            return None
        brick = self.ground.brick
        return RecordedContinuum(self.outside, self.ground_waves, self.assembly, self.mass, brick.mean_diameter)

    @cached_property
    def positions(self) -> np.ndarray:  # type: ignore[override]  # computed once
        """Positions (n, 2) m of particles and nodes of continua as built."""
        return np.vstack([self.assembly.positions, *(each.body.mesh.positions for each in self.continua)])

    @property
    def low(self) -> np.ndarray:
        """Lower left corner (2,) m of the body."""
        return self.assembly.origin

    @property
    def size(self) -> np.ndarray:
        """Width and height (2,) m of the body."""
        return self.assembly.size

    @property
    def lines(self) -> dict[str, dict[str, np.ndarray]]:
        """Points (p, 2) m by name of the "walls" that disks touch, and of "joints"."""
        walls = {wall.name: np.array(wall.line) for wall in self.case.wall}
        return {"walls": walls, "joints": {each.joint.name: np.array(each.joint.points) for each in self.faces}}

    @cached_property
    def layout(self) -> Layout:  # type: ignore[override]  # computed once
        """The slots in which kernels hold particles and nodes of continua."""
        layout = self.disk_layout
        for each in self.continua:
            layout = each.laid_out(layout)
        return layout

    @property
    def disk_layout(self) -> Layout:
        """The slots in which kernels hold the particles, without the nodes of continua."""
        return Layout.plain(self.disk_count) if self.slots is None else self.slots

    @property
    def threads(self) -> int:
        """Number of threads that compute a step."""
        return thread_count_for(self.count)

    @property
    def parts(self) -> dict[str, slice]:
        """The particles of each part: of the free-field columns, if there are any, and of the body."""
        return parts_of(self.disk_count, self.seams)

    @cached_property
    def twin(self) -> np.ndarray | None:  # type: ignore[override]  # computed once
        """Twin (n,) of each particle in a free-field column, of other nodes themselves; None without a column.

        Of two columns that of the side the particle is nearer to, by the middle of the slope, or where that has no twin
        the other one.
        """
        if not self.seams:
            return None
        count = self.disk_count
        twin, other = self.seams[0].twin, self.seams[-1].twin
        if len(self.seams) > 1:
            beyond = self.assembly.positions[:, 0] > self.case.middle
            twin = np.where(((beyond & (other != np.arange(count))) | (twin == np.arange(count))), other, twin)
        return np.concatenate([twin, np.arange(count, self.count)])

    @property
    def against_growth(self) -> str:
        """Other sides than a continuum, whose layers may amplify motion; a smaller step without one, or of bonds."""
        if not self.continua:
            return super().against_growth
        sides = 'sides of another type than "outside", whose layers may amplify motion, or fewer outside.layers'
        return f"{sides}, or {super().against_growth}" if self.has_history else sides

    @property
    def damp(self) -> float:
        """Local damping coefficient."""
        return self.case.material.damp

    @cached_property
    def mass(self) -> np.ndarray:
        """Mass (n,) kg of each particle and node; half for particles on sides of half cells."""
        return self._with_nodes(self.ground.disk_masses(self.assembly)[0] * self.cell_fraction)

    @cached_property
    def inertia(self) -> np.ndarray:
        """Moment of inertia (n,) kg·m², halved with the mass; of nodes of continua, which do not rotate, m × (1 m)²."""
        return self._with_nodes(self.ground.disk_masses(self.assembly)[1] * self.cell_fraction)

    def _with_nodes(self, of_disks: np.ndarray) -> np.ndarray:
        """Masses of the particles (m,), followed by those of the nodes of continua."""
        return np.concatenate([of_disks, *(each.body.mass for each in self.continua)])

    @cached_property
    def cell_fraction(self) -> np.ndarray:
        """Part (n,) of a particle's cell inside the scene: 1, on a side of half cells ½, where two of them meet ¼."""
        return mass_factor(self.disk_count, self.edges, self.case.boundary)

    @cached_property
    def free(self) -> np.ndarray:
        """Array (3,): 1 for a component that moves, 0 for one held everywhere."""
        free = np.ones(3)
        free[list(self.ground.held)] = 0.0
        return free

    @property
    def moves(self) -> np.ndarray:
        """Array (3, n) bool, False for held or prescribed components and for the rotation of nodes of a continuum."""
        moves = super().moves
        moves[2, self.disk_count :] = False
        for each in self.continua:
            moves[:2, each.nodes] &= ~each.body.mesh.held
        return moves

    @cached_property
    def bonds(self) -> np.ndarray:
        """The pairs (b, 2) of disks that are bonded as built."""
        constants = brick_constants(self.inside, gaps_close=False, locked_in=0.0)
        stiff = self.ground.law.column(constants, "bond_kn")[self.assembly.contact_type] > 0.0
        return self.assembly.pairs[stiff]

    @property
    def bearing(self) -> Springs | None:
        """The springs of sides on relative motion; None without any."""
        return None

    @cached_property
    def intact_zones(self) -> dict[str, np.ndarray]:
        """The disks (k,) of each zone beside a side in which bonds do not break, by side."""
        return intact_zones(self.case, self.ground.brick, self.assembly, self.edges, self.column_count)

    @cached_property
    def intact(self) -> np.ndarray | None:
        """Whether the bonds of each disk (m,) never break; None if all may."""
        if self.all_intact:
            return np.ones(self.disk_count, dtype=np.bool_)
        return intact_disks(self.case, self.intact_zones, self.disk_count, self.column_count)

    @cached_property
    def at_rest(self) -> AtRest | None:
        """The stress of undisturbed ground with which contacts begin; None if they begin without forces."""
        return stress_at_rest(self.case, self.ground, self.surface)

    def at_rest_of(self, part: str) -> AtRest | None:
        """The stress with which the contacts of a part begin: of a column that of the ground of its side."""
        seam = self.seams[COLUMNS.index(part)] if part in COLUMNS else None
        if seam is None or (self.surface is None and not self.case.is_unlike):
            return self.at_rest
        return rest_beside(self.case, self.ground, seam, self.surface)

    @property
    def has_history(self) -> bool:  # type: ignore[override]  # a constant of other kinds
        """Whether the scene's law is history-dependent: contacts that open and slide, bonds that break."""
        return self.ground.law.has_history
