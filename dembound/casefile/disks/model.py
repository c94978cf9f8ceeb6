"""A case of bonded disks: all tables of one file."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Literal

import numpy as np

from dembound.boundaries.viscous import Bearing
from dembound.casefile.disks.ground import Ground, floors, lowered
from dembound.casefile.disks.group import Group
from dembound.casefile.disks.incident import Damping, IncidentWave, Motion
from dembound.casefile.disks.joint import Joint
from dembound.casefile.disks.layer import Layer, OutsideTable, bottoms, stack
from dembound.casefile.disks.load import Load, Monitor, pull
from dembound.casefile.disks.material import Material
from dembound.casefile.disks.static import Static, bearing_of, begins_stressed, can_break, changes, intact_depths
from dembound.casefile.disks.wall import Wall
from dembound.casefile.messages import numbered
from dembound.casefile.model import Case
from dembound.casefile.tables import Run
from dembound.casefile.types import LAWS
from dembound.holes.hole import Floor, Hole, level_beside, surface_below
from dembound.packings.base import Packing
from dembound.table import Box, Table, quantity


class Reduce(Table):
    """Parts of a scene that are not stepped, as their motion follows from that of other parts."""

    rows: bool = quantity(True)
    """whether rows of disks that move identically are stepped as one"""
    settled: bool = quantity(False)
    """whether the elastic law serves after a static stage if nothing is open or slides"""


class DiskRun(Run):
    """The simulated time and the time step of disks, and what becomes of disks that have fallen far below the scene."""

    far: Literal["keep", "retire"] = quantity("keep")
    """disks below the base by more than the height of the scene: "keep", they fall on; "retire", they stop"""


@dataclass(frozen=True, kw_only=True, repr=False)
class DiskCase(Case):
    """A case of bonded disks.

    Attributes
    ----------
    run, ground, packing, material, damping, motion, outside, reduce : the tables of these names.
    static, incident : the tables of these names; None: no static stage, no wave at an angle.
    layer : from the surface down; none: the ground is uniform. group, hole, wall, joint : in the order of the file.
    """

    run: DiskRun
    packing: Packing
    material: Material
    damping: Damping = field(default_factory=Damping)
    motion: Motion = field(default_factory=Motion)
    ground: Ground = field(default_factory=Ground)
    outside: OutsideTable = field(default_factory=OutsideTable)
    reduce: Reduce = field(default_factory=Reduce)
    incident: IncidentWave | None = None
    static: Static | None = None
    layer: tuple[Layer, ...] = ()
    group: tuple[Group, ...] = ()
    hole: tuple[Hole, ...] = ()
    wall: tuple[Wall, ...] = ()
    joint: tuple[Joint, ...] = ()
    load: tuple[Load, ...] = ()
    monitor: tuple[Monitor, ...] = ()

    @property
    def size(self) -> tuple[float, float]:
        """Width and height (m) of the ground, or of the disks if they fill all of it."""
        return self.packing.extent if self.ground.size is None else self.ground.size

    @property
    def box(self) -> Box:
        """Left, bottom, right and top (m) of the ground, or of the disks if they fill all of it."""
        return self.ground.box(self.packing)

    @cached_property
    def materials(self) -> tuple[Material, ...]:
        """The material of each layer, from the surface down: [material] with the layer's keys; without layers one."""
        return tuple(layer.merged(self.material) for layer in self.layer) or (self.material,)

    @cached_property
    def all_materials(self) -> tuple[Material, ...]:
        """The materials of the layers, and those that each group alone makes of them."""
        return (*self.materials, *(group.merged(each) for group in self.group for each in self.materials))

    @property
    def is_damped(self) -> bool:
        """Whether the ground, or a layer of it, has a quality factor."""
        return any(material.quality_factor is not None for material in self.materials)

    @property
    def relaxes(self) -> bool:
        """Whether intact bonds have relaxation arms, by which ground that can break is damped."""
        return LAWS[self.material.law].has_history and self.is_damped

    @property
    def begins_elastic(self) -> bool:
        """Whether the elastic law serves first in place of a history-dependent one."""
        at_once = bool(self.relaxes or self.rolls or self.dashes_at_once or self.wall)
        return self.material.begins_elastic and not at_once

    @property
    def damps_bonds(self) -> bool:
        """Whether dashpots of contacts also act beside intact bonds."""
        return self.material.damps_bonds and not (self.material.dp_on is None and can_break(self.all_materials))

    @property
    def dashes_at_once(self) -> bool:
        """Whether dashpots of contacts act from the start."""
        loose = any(material.no_bonds is not None for material in self.all_materials)
        return self.material.has_dashpots and (self.damps_bonds or loose)

    @property
    def rolls(self) -> bool:
        """Whether contacts without bonds resist rolling from the start."""
        return any(material.rolls for material in self.all_materials)

    @property
    def layer_planes(self) -> tuple[float, ...]:
        """Heights y (m) of the planes between layers, from the uppermost down; of unlike sides those of both."""
        if self.is_unlike:
            return tuple(sorted({*self.beside("left").layer_planes, *self.beside("right").layer_planes}, reverse=True))
        return tuple(bottoms(self.layer, self.box[3])[:-1])

    @property
    def is_unlike(self) -> bool:
        """Whether the layers at the left and right differ, see `Ground.meet`."""
        return self.ground.meet is not None

    @property
    def sides_of_ground(self) -> tuple[str, ...]:
        """The sides whose layers are those of all the ground, or of their part of it where these differ."""
        return ("left", "right") if self.is_unlike else ("left",)

    def numbers_beside(self, side: str) -> list[int]:
        """Numbers, from 0, of the layers of the left or right side, from the surface down."""
        return [number for number, _ in stack(self.layer, side)]

    def beside(self, side: str) -> "DiskCase":
        """The case with the layers of the left or right side everywhere; itself where these are one."""
        if not self.is_unlike:
            return self
        layers = tuple(layer.model_copy(update={"side": None}) for _, layer in stack(self.layer, side))
        return replace(self, layer=layers, ground=self.ground.alike())

    def layer_at(self, height: float) -> int:
        """Number of the layer, from the top, at a height (m); above a plane between two on it.

        Raises ValueError where it differs at the left and right, see `beside`.
        """
        if self.is_unlike:
            one, other = (
                self.numbers_beside(side)[self.beside(side).layer_at(height)] for side in self.sides_of_ground
            )
            if one != other:
                raise ValueError(f"the layers at y = {height:g} m differ at both sides")
            return one
        near = 1e-9 * max(abs(self.box[1]), abs(self.box[3]))
        return sum(height + near < plane for plane in self.layer_planes)

    def uniform_at(self, height: float) -> "DiskCase":
        """The case with the layer at a height (m) everywhere; itself without layers."""
        if not self.layer:
            return self
        only = self.layer[self.layer_at(height)].model_copy(update={"thickness": None, "bottom": None})
        return replace(self, layer=(only,), ground=self.ground.alike())

    def layers_meeting(self, joints: Sequence[float]) -> tuple[Layer, ...]:
        """The layers if they meet at these heights (m), from the uppermost down, wherever the surface is."""
        if self.is_unlike:
            raise ValueError("the layers of one side are needed")
        ends = [*joints, None] if self.layer else []
        return tuple(
            layer.model_copy(update={"thickness": None, "bottom": end})
            for layer, end in zip(self.layer, ends, strict=True)
        )

    @property
    def layer_names(self) -> tuple[str, ...]:
        """The name of each layer, from the surface down: as given, or its number from 1."""
        return tuple(layer.name or str(number) for number, layer in enumerate(self.layer, start=1))

    @property
    def reaches_surface(self) -> bool:
        """Whether the disks reach the top of the ground."""
        return "top" not in self.packing.gaps(self.box)

    @cached_property
    def holes(self) -> tuple[Hole, ...]:
        """The holes before the run, and the air above the surface of the ground as the last one if that is given."""
        above, made = self.ground.above(self.packing.box), tuple(hole for hole in self.hole if hole.stage != "run")
        return made if above is None else (*made, above)

    @property
    def named_holes(self) -> Iterator[tuple[str, Hole]]:
        """The holes with their places in messages."""
        yield from ((place, hole) for place, hole in numbered("hole", self.hole) if hole.stage != "run")
        yield from (("ground.surface", hole) for hole in self.holes if hole not in self.hole)

    @property
    def files(self) -> dict[str, str]:
        """Texts of the files that the case refers to, by their paths in it."""
        own = super().files | self.ground.files
        return own | {path: text for wall in self.wall for path, text in wall.files.items()}

    def hole_of(self, load: Load) -> Hole:
        """The hole on whose wall a pressure acts."""
        return next(hole for hole in self.hole if hole.name == load.hole)

    @property
    def pressed(self) -> set[str]:
        """The names of the holes on whose walls a pressure acts."""
        return {load.hole for load in self.load if load.pressure is not None and load.hole is not None}

    @cached_property
    def floors(self) -> dict[str, Floor]:
        """The floors that all holes together leave at the left and right side, by side."""
        return self.floors_of(self.holes)

    def floors_of(self, holes: Sequence[Hole]) -> dict[str, Floor]:
        """The floors that some of the holes leave."""
        return floors(holes, self.packing, self.ground, self.boundary)

    @property
    def periodic(self) -> tuple[bool, bool]:
        """Whether the scene is periodic along x and along y."""
        return self.side("left").is_periodic, self.side("bottom").is_periodic

    @property
    def begins_stressed(self) -> bool:
        """Whether contacts begin with the forces of a stress at rest, see `static.begins_stressed`."""
        return self.static is not None and begins_stressed(self.static, self.boundary, self.material)

    @property
    def entering(self) -> set[str]:
        """Names of the waves that enter through driven sides, or at an angle."""
        return super().entering | (set() if self.incident is None else {self.incident.wave})

    @property
    def moving(self) -> set[str]:
        """Names of the waves by which walls move."""
        return {name for wall in self.wall for name in wall.waves.values()}

    @property
    def pull(self) -> float:
        """The largest acceleration (m/s²) of steady loads; 0 without one."""
        return pull(self.load)

    @property
    def last_change(self) -> float:
        """Time (s) from which walls stand groups, holes, ends of reactions have come; infinite if walls never stop."""
        walls = [wall.stops(self.wave) for wall in self.wall if wall.is_driven]
        return max([*walls, *(time for _, time in changes(self.group, self.hole, self.static))], default=0.0)

    @cached_property
    def intact(self) -> dict[str, int]:
        """Number of disks from each side, counted by bonds, whose bonds do not break; see `intact_depths`."""
        return intact_depths(self.all_materials, self.boundary, self.static)

    @property
    def bearing(self) -> dict[str, Bearing]:
        """The springs of sides on their motion relative to the ground beyond, by side; sides without are left out."""
        found = {side: bearing_of(side, table, self.material, self.intact) for side, table in self.boundary.items()}
        return {side: each for side, each in found.items() if each is not None}

    @property
    def free_field_sides(self) -> tuple[str, ...]:
        """The free-field sides."""
        return tuple(side for side, table in self.boundary.items() if table.needs_column)

    @property
    def outside_sides(self) -> tuple[str, ...]:
        """The sides beyond which the ground goes on as a continuum."""
        return tuple(side for side, table in self.boundary.items() if table.is_outside)

    @property
    def column_sides(self) -> tuple[str, ...]:
        """The sides at which a free-field column represents the ground beyond.

        Beyond sides with a continuum there is a column if the ground has waves from below, a static stage, or a load on
        all of it. The continuum then computes only the difference from the column. Where the ground is lower beyond one
        of the sides, or its layers differ there, there is one only under waves.
        """
        if self.free_field_sides:
            return self.free_field_sides
        driven = any(self.boundary[side].waves for side in self.outside_sides)
        if any(self.periodic) or ((self.is_unlike or lowered(self.floors, self.boundary)) and not driven):
            return ()
        everywhere = any(load.is_everywhere for load in self.load)
        return self.outside_sides if everywhere or driven or self.static is not None else ()

    @property
    def middle(self) -> float:
        """Place x (m) of the middle of the slope between its left and right side, from which monitors are beside one.

        That of the disks where the surface has one height, and the plane between layers where these differ.
        """
        if self.ground.meet is not None:
            return self.ground.meet
        left, _, right, _ = self.packing.box
        return 0.5 * (left + self.level["left"] + right - self.level["right"])

    @cached_property
    def level(self) -> dict[str, float]:
        """Length (m) from the left and the right side inwards over which the surface is level, by side."""
        box, diameter = self.packing.box, 2.0 * self.packing.radius
        return {
            side: self.floors[side].width if side in self.floors else level_beside(self.holes, box, side, diameter)
            for side in ("left", "right")
        }

    def is_above_surface(self, hole: Hole) -> bool:
        """Whether a hole is what lies above the ground at a side where that is lower than the box of disks."""
        left, _, right, top = self.packing.box
        beside = hole.box[0] <= left or hole.box[2] >= right
        return beside and hole.box[3] >= top and bool(self.floors)

    @cached_property
    def surface(self) -> np.ndarray | None:
        """Points (2, k) m on the free surface of the disks from left to right, before an excavation.

        None where the ground is level beside the disks, up to the height of their box.
        """
        before = [hole for hole in self.holes if hole.stage == "before"]
        if not self.floors_of(before):
            return None
        if self.ground.points:
            return np.array(self.ground.points).T
        (left, bottom, right, _), radius = self.packing.box, self.packing.radius
        x = np.linspace(left + radius, right - radius, max(2, round((right - left) / radius) - 1))
        heights = surface_below(before, self.packing.box, x, 2.0 * radius)
        return np.stack([x, np.where(np.isnan(heights), bottom, heights)])

    @property
    def column_rows(self) -> tuple[int, int]:
        """The first row of bricks of the disks in the ground, and the number of rows of the ground."""
        if self.ground.size is None:
            return 0, self.packing.copies[1]
        brick = self.packing.brick_size[1]
        return round((self.packing.origin[1] - self.box[1]) / brick), round(self.ground.size[1] / brick)
