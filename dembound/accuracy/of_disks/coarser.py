"""A case of disks with larger particles: the same ground, sides, loads, holes and monitors on a coarser lattice.

Effects of artificial sides (echoes, drift, surface waves) hardly depend on the particles as long as they resolve the
waves. Their error is therefore found from two runs with larger ones, which cost a small share of the run itself: k
times larger disks are k² times fewer, with steps k times longer.

The coarser packing is always a square lattice. In place of a random packing it has the same wave speeds along x, the
same density, dashpots that reflect as much of plane waves along their normal, and springs as stiff.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np

from dembound.accuracy.of_disks.equal_sides import equal_sides, with_whole_cells
from dembound.boundaries import Boundary
from dembound.boundaries.platen import Keeping
from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.ground import Ground
from dembound.casefile.disks.layer import Layer
from dembound.casefile.disks.load import Load
from dembound.casefile.disks.material import TARGET_KEYS, Material
from dembound.casefile.disks.static import Static, can_break
from dembound.casefile.disks.stiffness import STIFFNESS_KEYS
from dembound.casefile.tables import ENDING
from dembound.continuum import sizing
from dembound.disks.material.case_material import nominal_moduli
from dembound.disks.material.layered import materials_in
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.scene import DiskScene
from dembound.disks.supports import forces_of
from dembound.formulas.disks.reflections import Reflections
from dembound.formulas.disks.waves import is_square_lattice
from dembound.laws import Moduli
from dembound.packings.square import Square
from dembound.table import Box

CELLS = 4
"""Smallest number of particles across a hole."""

LAYER = 2.5
"""Smallest number of particles across a layer: at least `THINNEST`, after sides have moved."""

SPARE = 1.1
"""Distance of two heights of the surface over the smallest useful element, as whole disks move the heights."""

TRIED = 60
"""Numbers of columns that are tried for the one whose rows fit the height best."""


def largest_diameter(case: DiskCase, shortest: float) -> float:
    """Largest diameter (m) of disks: at most `shortest`, `CELLS` across holes and between sides, `LAYER` a layer.

    Beside lower ground beyond a continuum its elements fit between the heights.
    """
    holes = [min(hole.box[2] - hole.box[0], hole.box[3] - hole.box[1]) / CELLS for hole in case.holes]
    across = [length / CELLS for length, periodic in zip(case.size, case.periodic, strict=True) if not periodic]
    layers = [(high - low) / LAYER for high, low in pairwise([case.box[3], *case.layer_planes])]
    heights = sorted({case.packing.box[1], case.packing.box[3], *(floor.height for floor in case.floors.values())})
    element = SPARE * sizing.least_size(case.outside.order, 1.0, is_random=False)
    steps = [(high - low) / element for low, high in pairwise(heights)] if case.outside_sides and case.floors else []
    return min([shortest, *holes, *across, *layers, *steps])


MOST_SETTLING = 10_000
"""Steps after which larger disks whose bonds can break have not settled: they need fewer than the given ones."""


@dataclass(frozen=True)
class Coarser:
    """A case with larger particles.

    weight : ratio of the error of its sides in the case to the error added by whole cells at the sides. The latter is
    the reflection by excess mass, out of phase, which k times larger cells have k times; 0 where it need not be known.
    """

    case: DiskCase
    weight: float

    @property
    def with_whole_cells(self) -> DiskCase:
        """The case with whole cells at its sides."""
        return with_whole_cells(self.case)


def coarser(
    case: DiskCase, scene: DiskScene, time_step: float, diameter: float, reflections: Reflections | None = None
) -> Coarser:
    """The case with a square lattice of about this diameter (m); scene, time_step (s) : of the case.

    Places move with the sides, by less than half a diameter, as the scene then is whole cells wide and high. Nothing
    but histories is recorded. reflections : of sides, measured before.

    Raises the errors of building a scene.
    """
    columns, rows, cell = _cells(case.size, diameter)
    packing = Square(pattern="A", radius=0.5 * cell, bricks=(columns, rows), origin=case.box[:2])
    sides = _Sides(np.divide(packing.extent, case.size), packing.box)
    places = {monitor.name: {"position": sides.at(scene.monitored[monitor.name])} for monitor in case.monitor}
    lasting = case.run.model_dump(exclude=set(ENDING), exclude_unset=True)
    larger = replace(
        case,
        packing=packing,
        ground=Ground(),
        material=case.material if case.layer else _material(case.material, scene.ground),
        layer=_layers(case, scene.ground, sides),
        hole=tuple(hole.shifted(sides.moved(_middle(hole.box))) for hole in case.holes),
        load=tuple(_load(load, scene, cell, sides) for load in case.load),
        monitor=tuple(monitor.model_copy(update=places[monitor.name]) for monitor in case.monitor),
        static=_static(case, scene.ground.moduli),
        run=type(case.run).model_validate(lasting | {"time_step": "auto", "checkpoint": 0.0}),
        output=case.output.model_copy(update={"snapshots": 0, "history_interval": 0.0, "load_factor": False}),
        name=f"{case.name}_coarser",
    )
    is_below = "top" in case.packing.gaps(case.box)  # larger disks fill the ground, up to its free surface
    remaining = [side for side in case.boundary if not (is_below and side == "top")]
    larger = replace(larger, boundary={side: _as_deep(case, side, scene, cell) for side in remaining})
    boundary, weight = equal_sides(larger, scene, time_step, reflections or Reflections())
    return Coarser(replace(larger, boundary=boundary), weight)


def _as_deep(case: DiskCase, side: str, scene: DiskScene, cell: float) -> Boundary:
    """A side whose bonds do not break no deeper than in the case, in larger cells (m)."""
    table = case.boundary[side]
    if not isinstance(table, Keeping) or side not in case.intact:
        return table
    depth = case.intact[side] * scene.ground.brick.mean_diameter / cell
    return table.model_copy(update={"intact": int(depth)})


def _cells(size: tuple[float, float], diameter: float) -> tuple[int, int, float]:
    """Columns, rows and width (m) of cells of at most this diameter whose rows fit the height best."""
    fewest = math.ceil(size[0] / diameter - 1e-9)
    most = max(fewest + 1, min(fewest + TRIED, int(1.15 * fewest)))
    tried = [(columns, size[1] * columns / size[0]) for columns in range(fewest, most + 1)]
    columns, rows = min(tried, key=lambda each: (round(abs(each[1] - round(each[1])) / each[1], 4), each[0]))
    return columns, max(1, round(rows)), size[0] / columns


def _middle(box: tuple[float, float, float, float]) -> np.ndarray:
    return np.array([0.5 * (box[0] + box[2]), 0.5 * (box[1] + box[3])])


@dataclass(frozen=True)
class _Sides:
    """The mapping of places when sides move.

    stretch : of lengths along x and y, from the lower left corner. box : left, bottom, right and top (m) afterwards,
    which rounding must not exceed.
    """

    stretch: np.ndarray
    box: Box

    def moved(self, place: np.ndarray) -> tuple[float, float]:
        """Displacement (m) of a place."""
        x, y = ((place - self.box[:2]) * (self.stretch - 1.0)).tolist()
        return x, y

    def at(self, place: np.ndarray) -> tuple[float, float]:
        """New position (m) of a place."""
        x, y = self.within((place - self.box[:2]) * self.stretch + self.box[:2]).tolist()
        return x, y

    def within(self, place: np.ndarray) -> np.ndarray:
        """A place (2,) m, or the nearest one in the box."""
        return np.clip(place, self.box[:2], self.box[2:])


def _layers(case: DiskCase, ground: PackedMaterial, sides: _Sides) -> tuple[Layer, ...]:
    """The layers, where sides have moved them, whose lattices have their wave speeds along y."""
    layers = case.layers_meeting([joint + sides.moved(np.array([0.0, joint]))[1] for joint in case.layer_planes])
    if is_square_lattice(ground):
        return layers
    return tuple(
        layer.model_copy(update=_of_lattice(_material(material, own, along=1)))
        for layer, material, own in zip(layers, case.materials, reversed(materials_in(ground)), strict=False)
    )


def _of_lattice(material: Material) -> dict[str, float | None]:
    """The keys of a layer for a material of a square lattice."""
    moduli = nominal_moduli(material)
    keys = "emod", "pb_emod", "kratio", "pb_kratio"
    return dict.fromkeys((*STIFFNESS_KEYS, *TARGET_KEYS)) | {key: getattr(moduli, key) for key in keys}


def _material(material: Material, ground: PackedMaterial, along: int = 0) -> Material:
    """The material with which the lattice has the ground's wave speeds along x, or y."""
    if is_square_lattice(ground):
        return material
    tensor, density = ground.material_tensor, ground.density
    p, s = (math.sqrt(tensor[k, k] / density) for k in ((0, 3), (1, 2))[along])
    moduli = ground.moduli
    ratio = 0.5 * (p / s) ** 2  # a square lattice whose disks turn freely has G = k_s/2
    contacts = moduli.emod / (moduli.emod + moduli.pb_emod)
    replaced = {*STIFFNESS_KEYS, *TARGET_KEYS, "match", "kratio", "pb_kratio", "locked_in"}
    given = material.model_dump(exclude_unset=True, exclude=replaced)
    of_bonds = ratio if material.fric > 0.0 else ratio * (1.0 - contacts)  # else bonds carry all shear
    given |= {"p_wave_speed": p, "contact_share": contacts, "kratio": ratio, "pb_kratio": of_bonds}
    return Material.model_validate({key: value for key, value in given.items() if value is not None})


def _static(case: DiskCase, moduli: Moduli) -> Static | None:
    """The static stage; a locked-in stress becomes a given stress with the same contact pressure."""
    if case.static is None:
        return None
    update: dict[str, Any] = {"from_": None}
    if can_break(case.materials):  # coarse ground may fail under its weight, where the given one stands
        update["max_steps"] = min(case.static.max_steps, MOST_SETTLING)
    if (pressure := case.material.locked_in) is not None:
        both = pressure * (moduli.emod + moduli.pb_emod) / moduli.emod
        sxx, syy, sxy = case.static.stress or (0.0, 0.0, 0.0)
        update["stress"] = (sxx - both, syy - both, sxy)
    return case.static.model_copy(update=update)


def _load(load: Load, scene: DiskScene, cell: float, sides: _Sides) -> Load:
    """A load with the same total force, on the disks of a region at least one cell wide and high."""
    if load.pressure is not None or load.is_everywhere:
        return load
    update: dict[str, Any] = {}
    if load.acceleration is not None:
        total = forces_of(load, scene)[1].sum(axis=0)
        update |= {"acceleration": None, "force": (float(total[0]), float(total[1]))}
    if load.position is not None:
        (node,), _ = forces_of(load, scene)
        return load.model_copy(update=update | {"position": sides.at(scene.positions[node])})
    assert load.region is not None
    corner = np.tile(sides.box[:2], 2)
    box = (np.array(load.region) - corner) * np.tile(sides.stretch, 2) + corner
    middle, half = 0.5 * (box[:2] + box[2:]), np.maximum(0.5 * (box[2:] - box[:2]), 0.5 * cell * (1.0 + 1e-9))
    low, high = sides.within(middle - half), sides.within(middle + half)
    return load.model_copy(update=update | {"region": (*low.tolist(), *high.tolist())})
