"""A body that a static stage has brought to rest, and the mean stress in blocks of it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, fields
from itertools import chain
from typing import Any, Self

import numpy as np

from dembound.disks.contacts.pairs import Piece, pieces
from dembound.disks.scene import DiskScene
from dembound.disks.side_forces import packing_pieces
from dembound.disks.stepping.fields import joint_pieces
from dembound.disks.stepping.scene_parts import Start, contact_lists
from dembound.disks.stepping.system import DiskSystem
from dembound.disks.stepping.walls import Touching
from dembound.kernels.contacts import UPDATED
from dembound.motion.part import Cracks
from dembound.motion.state import Arrays, arrays_of_owner
from dembound.packings.cut import BEYOND
from dembound.table import every_key

RIM = 4.0
"""Width, in mean diameters, of the rim along the sides that no block includes; a quarter of narrower bodies."""

BLOCK = 10.0
"""Least width of a block in mean diameters, where the body is as wide."""


@dataclass(frozen=True, eq=False)
class Blocks:
    """Rectangles of equal size that fill a body inside its rim.

    Attributes
    ----------
    low, size : (2,) m, lower left corner of the first one, and the size of each. count : (2,) along x and y. wraps :
    (2,) bool, whether the body is periodic along the axis; it then has no rim. diameter : m, mean of the disks.
    """

    low: np.ndarray
    size: np.ndarray
    count: np.ndarray
    wraps: np.ndarray
    diameter: float

    @classmethod
    def of(cls, scene: DiskScene, moved: np.ndarray | None = None) -> Blocks:
        """The blocks of a body as built, or with its sides moved by displacements (3, n)."""
        diameter, wide = scene.ground.brick.mean_diameter, scene.assembly.size.copy()
        if scene.surface is not None:  # a column may end far below the top of its box
            wide[1] = min(wide[1], scene.surface[1].max() - scene.assembly.origin[1])
        wraps = np.array(scene.case.periodic)
        rim = np.where(wraps, 0.0, np.minimum(RIM * diameter, 0.25 * wide))
        inside = wide - 2.0 * rim
        count = np.maximum(1, np.floor(inside / (BLOCK * diameter) * (1.0 + 1e-9))).astype(np.int64)
        low, high = rim.copy(), wide - rim
        for axis, sides in enumerate(BEYOND):
            if moved is not None and set(sides) <= scene.edges.keys():  # none at the top of ground below a surface
                shift, further = (float(moved[axis, scene.edges[side].nodes].mean()) for side in sides)
                ends = low[axis], high[axis]
                low[axis], high[axis] = (x + shift + x / wide[axis] * (further - shift) for x in ends)
        return cls(scene.assembly.origin + low, (high - low) / count, count, wraps, diameter)

    def stress(self, found: Iterable[Piece], positions: np.ndarray) -> np.ndarray:
        """Mean stress (nx, ny, 3) xx, yy, xy in Pa of each block, tension positive; xy averages both shear stresses.

        It is Σ w f_a l_b over the block's area: with the force f on the first disk of a contact, the vector l from its
        centre to that of the second, and the part w, inside the block, of a square of a mean diameter round the middle
        of l. With this square, rows of a lattice count the same wherever a block ends between them. Holes and pores
        add nothing. positions : (n, 2) m of the disks.
        """
        nx, ny = self.count.tolist()
        total = np.zeros((3, nx * ny))
        for piece in found:
            (x, y), (pull_x, pull_y) = piece.vector, piece.force
            dyads = np.stack([pull_x * x, pull_y * y, 0.5 * (pull_x * y + pull_y * x)])
            middle = positions[piece.first].T + 0.5 * piece.vector
            for column, part_x in self._shares(middle[0], 0):
                for row, part_y in self._shares(middle[1], 1):
                    inside = (column >= 0) & (column < nx) & (row >= 0) & (row < ny)
                    block = (column * ny + row)[inside]
                    for component, dyad in enumerate(dyads * part_x * part_y):
                        total[component] += np.bincount(block, dyad[inside], nx * ny)
        return (total / np.prod(self.size)).T.reshape(nx, ny, 3)

    def _shares(self, middle: np.ndarray, axis: int) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """The two columns or rows of blocks (k,) that a square round each place (k,) m may touch, and its parts."""
        size, begin = float(self.size[axis]), middle - self.low[axis] - 0.5 * self.diameter
        first = np.floor(begin / size).astype(np.int64)
        beyond = np.clip(1.0 + (begin - (first + 1) * size) / self.diameter, 0.0, 1.0)
        for number, part in ((first, 1.0 - beyond), (first + 1, beyond)):
            yield (number % self.count[axis] if self.wraps[axis] else number), part

    @property
    def middles(self) -> np.ndarray:
        """Middle (nx, ny, 2) m of each block."""
        at = np.stack(np.meshgrid(*(np.arange(count) for count in self.count), indexing="ij"), axis=-1)
        return np.asarray(self.low + (at + 0.5) * self.size)

    def near(self, box: tuple[float, float, float, float]) -> np.ndarray:
        """Mask (nx, ny) of blocks within the width of the rim of a box left, bottom, right, top, m."""
        low, high = np.array(box[:2]) - RIM * self.diameter, np.array(box[2:]) + RIM * self.diameter
        half = 0.5 * self.size
        return np.asarray(np.asarray(((self.middles + half > low) & (self.middles - half < high)).all(axis=-1)))


def block_stress(scene: DiskScene, system: DiskSystem, displacement: np.ndarray) -> np.ndarray:
    """Stress (nx, ny, 3) in the blocks of a body at displacements (3, n), see `Blocks.stress`; without its column."""
    part = system.disks.parts[-1]
    of_contacts = pieces(scene.layout, part.stressed_pairs, displacement, part.geometry)
    found = chain(of_contacts, joint_pieces(system.joints, scene, displacement))
    if part.geometry != UPDATED:
        return Blocks.of(scene).stress(found, scene.positions)
    return Blocks.of(scene, displacement).stress(found, scene.positions + displacement[:2].T)


@dataclass(frozen=True, eq=False)
class Uniformity:
    """Deviation of the stress in blocks from the requested one, over its largest principal stress.

    Attributes
    ----------
    block : (2,) m, width and height of a block. deviation : the largest of a component in a block not near a hole;
    place : (2,) m, the middle of this block. packing : the largest in the elastic packing without sides, an inherent
    property of a random one. near_holes : the largest near holes; nan without any.
    """

    block: np.ndarray
    deviation: float
    place: np.ndarray
    packing: float
    beyond: float
    near_holes: float

    @classmethod
    def of(cls, scene: DiskScene, system: DiskSystem, displacement: np.ndarray, asked: np.ndarray) -> Uniformity:
        """The uniformity of a body at displacements (3, n), for a requested stress (3,) Pa."""
        blocks, stress = Blocks.of(scene), block_stress(scene, system, displacement)
        xx, yy, xy = asked
        largest = abs(0.5 * (xx + yy)) + np.hypot(0.5 * (xx - yy), xy)
        scale = 1.0 / largest if largest > 0.0 else 0.0
        off = np.abs(stress - asked).max(axis=-1) * scale
        packing = blocks.stress(packing_pieces(scene, asked), scene.positions)
        own, beyond = (np.abs(each - packing).max(axis=-1) * scale for each in (asked, stress))
        near = np.zeros(off.shape, dtype=np.bool_)
        for hole in scene.case.holes:
            if hole.stage == "before" or scene.before is not None:
                near |= blocks.near(hole.box)
        away = np.where(near, -1.0, off)
        worst = np.unravel_index(np.argmax(away), away.shape)
        return cls(
            block=blocks.size,
            deviation=max(0.0, float(away[worst])),
            place=blocks.middles[worst],
            packing=float(own[~near].max(initial=0.0)),
            beyond=float(beyond[~near].max(initial=0.0)),
            near_holes=float(off[near].max()) if near.any() else float("nan"),
        )

    def saved_arrays(self) -> Arrays:
        """All numbers as arrays, from which `restored` restores the object."""
        return {field.name: np.array(getattr(self, field.name)) for field in fields(self)}

    @classmethod
    def restored(cls, saved: Arrays) -> Self:
        """The uniformity restored from the arrays returned by `saved_arrays`."""
        numbers: dict[str, Any] = {name: each.copy() if each.ndim else float(each) for name, each in saved.items()}
        return cls(**numbers)


NUMBERS = ("steps", "ratio", "mean_reaction", "mean_residual", "stress")
"""Names of the numbers of a stage kept besides its body, cracks and blocks."""


@dataclass(frozen=True)
class Settled:
    """A body at rest, and the results of its static stage.

    Attributes
    ----------
    start : the state in which the run begins.
    steps : number of steps of the stage.
    ratio : mean unbalanced over mean contact force at the end.
    mean_reaction : N, mean force of supports and tractions on the particles they act on.
    mean_residual : N, mean unbalanced force on all other particles, which F_0 balances too.
    stress : (3,) mean xx, yy, xy in Pa inside the body's rim, tension positive, see `block_stress`. uniformity :
    deviation of blocks from a target stress; None without one.
    cracks : the bonds that broke during the stage.
    before : results before an excavation, if there was one, with the numbering of particles before it.
    columns : results of the free-field columns, each settled by itself, the left one first.
    """

    start: Start
    steps: int
    ratio: float
    mean_reaction: float
    mean_residual: float
    stress: np.ndarray
    cracks: Cracks
    uniformity: Uniformity | None = None
    before: Settled | None = None
    columns: tuple[Settled, ...] = ()

    def saved_arrays(self) -> Arrays:
        """All arrays from which `restored` restores the settled body in another run; without the stages before."""
        start = self.start
        kept = {name: np.array(getattr(self, name)) for name in NUMBERS}
        kept |= {"displacement": start.displacement, "has_history": np.array(start.has_history)}
        if self.uniformity is not None:
            kept |= {f"uniformity/{name}": values for name, values in self.uniformity.saved_arrays().items()}
        kept |= {f"cracks/{field.name}": getattr(self.cracks, field.name) for field in fields(Cracks)}
        if start.touching is not None:
            kept |= {f"walls/{name}": values for name, values in start.touching._asdict().items()}
        for part, pairs in start.contacts.items():
            kept |= {f"contacts/{part}/{name}": values for name, values in pairs.saved_arrays().items()}
        return kept | {f"joints/{name}": values for name, values in start.joints.items()}

    @classmethod
    def restored(cls, scene: DiskScene, saved: Arrays) -> Self:
        """The settled body of an equal scene restored from the arrays returned by `saved_arrays`."""
        contacts = contact_lists(scene) if any(name.startswith("contacts/") for name in saved) else {}
        for part, pairs in contacts.items():
            pairs.restore(arrays_of_owner(saved, f"contacts/{part}"))
        walls, joints = arrays_of_owner(saved, "walls"), arrays_of_owner(saved, "joints")
        cracks, uniformity = arrays_of_owner(saved, "cracks"), arrays_of_owner(saved, "uniformity")
        touching = Touching(**{name: values.copy() for name, values in walls.items()}) if walls else None
        displacement = among(saved["displacement"], scene)
        return cls(
            start=Start(displacement, contacts, bool(saved["has_history"]), touching, joints),
            steps=int(saved["steps"]),
            ratio=float(saved["ratio"]),
            mean_reaction=float(saved["mean_reaction"]),
            mean_residual=float(saved["mean_residual"]),
            stress=saved["stress"].copy(),
            cracks=Cracks(**{field.name: cracks[field.name] for field in fields(Cracks)}),
            uniformity=Uniformity.restored(uniformity) if uniformity else None,
        )


def among(displacement: np.ndarray, scene: DiskScene) -> np.ndarray:
    """Displacements (3, …) of a scene's disks extended to all its nodes, zero for nodes of continua.

    The displacement of a continuum is counted from rest: forces of its ties at rest are part of the balanced forces.
    """
    of_all = np.zeros((3, scene.count))
    of_all[:, : scene.disk_count] = displacement[:, : scene.disk_count]
    return of_all


def settling_keys(scene: DiskScene) -> dict[str, Any]:
    """All inputs that determine the result of a scene's static stage, as plain JSON values by key.

    Boundaries: free fields, which settle too, half cells, whose mass is halved, sides that belong to the packing, and
    continua that settle beside a free-field column, with all settings, also chosen ones. Loads: the steady ones.
    """
    case = scene.case
    if case.static is None:
        return {}
    tables = {name: getattr(case, name) for name in ("packing", "material", "motion", "static")}
    holes = [every_key(hole) for hole in case.hole if hole.stage != "run"]
    tables["hole"] = [{key: each for key, each in hole.items() if key != "time"} for hole in holes]
    loads = [load for load in case.load if load.wave is None]
    sides = {side: every_key(table) for side, table in case.boundary.items() if table.needs_column}
    joined = {side: {"type": t.type} for side, t in case.boundary.items() if t.is_periodic or t.is_mirror}
    halved = {side: True for side, table in case.boundary.items() if table.half_cells}
    keys = {**tables, "load": loads, "boundary": sides | joined, "half_mass": halved}
    if scene.outside is not None and scene.outside.twins:
        keys["outside"] = case.outside.model_copy(update=scene.outside.settings.given)
        keys["outside_sides"] = scene.outside.sides
        if scene.ground.is_layered:
            keys["outside_rows"] = [float(height) for height in scene.outside.body.mesh.heights]
    if case.joint:
        keys["joint"] = case.joint
    if case.intact:
        keys["intact"] = case.intact
    if case.group:
        places, groups = ("region", "points", "rr_fric"), ((group.time, every_key(group)) for group in case.group)
        keys["group"] = [
            {key: each for key, each in group.items() if key in places or (time is None and key != "name")}
            for time, group in groups
        ]
    if case.layer:
        keys["layer"] = [{key: each for key, each in every_key(layer).items() if key != "side"} for layer in case.layer]
    if case.is_unlike:
        keys["sides_of_layers"] = [case.ground.meet, *(layer.side for layer in case.layer)]
    if case.ground.surface is not None:
        keys["surface"] = case.ground.points
    if case.wall:
        keys["wall"] = [{**every_key(wall), "points": wall.line} for wall in case.wall]
    if scene.ground.is_damped:
        each = scene.ground.mechanisms_by_layer
        keys["unrelaxed"] = [one and one.unrelaxed * (one.relaxed if scene.ground.relaxes else 1.0) for one in each]
    settling = every_key(keys) | {"particles": scene.disk_count, "reduced": list(scene.reduced)}
    del settling["static"]["from"]
    for side in settling["static"]["boundary"].values():
        side.pop("until", None)  # of the run, as are holes that are made in it
    return settling
