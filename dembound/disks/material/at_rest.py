"""The stress of undisturbed ground at rest, and the strain that it gives the pairs of a packing.

In an endless packing under a uniform stress every copy of a contact has the same force, known from the homogenisation.
Contacts that begin with these forces, scaled by the stress at their height, are at rest in a body, in its free-field
column and across the sides of both, without any displacement: a stress that no displacement could reach, as a column
that is periodic sideways cannot be strained along x. Under a history-dependent law contacts that would exceed their
friction or be pulled begin with what they bear, and with the slip that belongs to it (sliding.py).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.load import gravity
from dembound.disks.material.homogenise import Network
from dembound.disks.material.layered import LayeredGround
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.material.sliding import strains_of, strains_with_slip, within_friction
from dembound.disks.material.unlike import UnlikeGround
from dembound.packings.tiling import Assembly
from dembound.pairwise import STRAIN
from dembound.places import ROUNDING


@dataclass(frozen=True, eq=False)
class StressAtRest:
    """The stress of undisturbed ground by height.

    Attributes
    ----------
    uniform : (3,) xx, yy, xy in Pa, tension positive, at all heights.
    tops : (l,) m, the upper ends of layers from the surface down. growth : (l,) Pa/m, by which σ_yy grows per metre of
    depth in each, negative under weight; k0 : (l,) the stress along x over that along y due to weight. low : m, height
    down to which there are contacts. surface : points (2, k) m on the free surface from left to right, below the top of
    the first layer; None: at its top.
    slides : whether contacts slide or open under it. is_borne : whether the packing can bear it so.
    """

    uniform: np.ndarray
    tops: np.ndarray
    growth: np.ndarray
    k0: np.ndarray
    low: float
    surface: np.ndarray | None = None
    slides: bool = False
    is_borne: bool = True

    @property
    def is_uniform(self) -> bool:
        """Whether the stress is the same at all heights."""
        return not self.growth.any()

    @property
    def height(self) -> float:
        """Height (m) of all contacts."""
        return float(self.tops[0] - self.low)

    def at(self, heights: np.ndarray, x: np.ndarray | None = None) -> np.ndarray:
        """Stress (3, k) xx, yy, xy in Pa at heights (k,) m; above the surface that of no weight.

        x : (k,) m, places along the surface; None: where it is at the top of the first layer. Weight is that straight
        above a place.
        """
        thick = np.append(-np.diff(self.tops), np.inf)[:, None]
        tops = self.tops[:, None]
        if x is not None and self.surface is not None:
            lower = np.minimum(tops, np.interp(x, *self.surface))
            thick, tops = np.clip(thick - tops + lower, 0.0, None), lower
        within = np.clip(tops - heights, 0.0, thick)
        vertical = self.growth @ within
        ratio = self.k0[self.layer_of(heights)]
        return np.asarray(self.uniform[:, None] + np.stack([ratio * vertical, vertical, np.zeros_like(vertical)]))

    def layer_of(self, heights: np.ndarray) -> np.ndarray:
        """Number of the layer, from the surface, at heights (k,) m; the upper one between two, the first above all."""
        near = ROUNDING * (self.tops[0] - self.low)
        return np.maximum(np.searchsorted(-self.tops, -heights - near, side="right") - 1, 0)

    def ends(self, layer: int) -> tuple[np.ndarray, np.ndarray]:
        """The upper and the lower end (2,) m of a layer, and the stresses (2, 3) Pa in it there."""
        bottom = self.tops[layer + 1] if layer + 1 < len(self.tops) else min(self.low, self.tops[layer] - 1.0)
        heights = np.array([self.tops[layer], bottom])
        vertical = self.at(heights)[1] - self.uniform[1]
        return heights, self.uniform + np.outer(vertical, [self.k0[layer], 1.0, 0.0])


@dataclass(frozen=True, eq=False)
class UnlikeStress:
    """The stress of undisturbed ground whose layers differ at the left and right: each side has its own.

    Attributes
    ----------
    sides : of the left and of the right side. ground : by which places belong to a side.
    """

    sides: tuple[StressAtRest, StressAtRest]
    ground: UnlikeGround

    @property
    def is_uniform(self) -> bool:
        """Whether the stress is the same at all heights."""
        return all(side.is_uniform for side in self.sides)

    @property
    def surface(self) -> np.ndarray | None:
        """Points (2, k) m on the free surface, see `StressAtRest`."""
        return self.sides[0].surface

    @property
    def low(self) -> float:
        """Height (m) down to which there are contacts."""
        return self.sides[0].low

    @property
    def height(self) -> float:
        """Height (m) of all contacts."""
        return max(side.height for side in self.sides)

    @property
    def slides(self) -> bool:
        """Whether contacts slide or open under it."""
        return any(side.slides for side in self.sides)

    @property
    def is_borne(self) -> bool:
        """Whether the packing can bear it so."""
        return all(side.is_borne for side in self.sides)

    def at(self, heights: np.ndarray, x: np.ndarray | None = None) -> np.ndarray:
        """Stress (3, k) xx, yy, xy in Pa at heights and places x (k,) m, which are needed."""
        assert x is not None
        left, right = (side.at(heights, x) for side in self.sides)
        return np.where(self.ground.is_right(x), right, left)


AtRest = StressAtRest | UnlikeStress
"""The stress of undisturbed ground, by height or also by side."""


def stress_at_rest(case: DiskCase, ground: PackedMaterial, surface: np.ndarray | None = None) -> AtRest | None:
    """The stress with which the contacts of a case begin, of either side where its layers differ; None without forces.

    Parameters as of `_level_stress`.
    """
    if not isinstance(ground, UnlikeGround):
        return _level_stress(case, ground, surface)
    left, right = (_level_stress(case.beside(side), ground.beside(side), surface) for side in ("left", "right"))
    if left is None or right is None:
        return None
    slides = left.slides or right.slides
    return UnlikeStress((replace(left, slides=slides), replace(right, slides=slides)), ground)


def _level_stress(case: DiskCase, ground: PackedMaterial, surface: np.ndarray | None) -> StressAtRest | None:
    """The stress with which the contacts of a case begin; None if they begin without forces.

    Weight counts from the height at which the packing's mass ends. surface : points (2, k) m; None: that of the box.
    """
    static = case.static
    if static is None or not case.begins_stressed:
        return None
    down = 0.0 if static.k0 is None else sum(gravity(case.load))
    offset = float(ground.brick.mass_offset[1])
    top = case.box[3] + offset
    layers = [(top, ground.density, static.k0)]
    if isinstance(ground, LayeredGround):
        own = [case.layer[zone.layer].k0 for zone in ground.layers]
        each = zip(ground.layers, own, strict=True)
        layers = [(zone.high, zone.material.density, static.k0 if k0 is None else k0) for zone, k0 in each][::-1]
    tops, densities, ratios = zip(*layers, strict=True)
    at_rest = StressAtRest(
        uniform=np.array(static.stress or (0.0, 0.0, 0.0)),
        tops=np.minimum(tops, top),
        growth=down * np.array(densities),
        k0=np.array([ratio or 0.0 for ratio in ratios]),
        low=case.box[3] - case.column_rows[1] * float(ground.brick.size[1]),
        surface=None if surface is None or static.k0 is None else np.stack([surface[0], surface[1] + offset]),
    )
    return _with_sliding(ground, at_rest) if ground.law.has_history else at_rest


def _with_sliding(ground: PackedMaterial, at_rest: StressAtRest) -> StressAtRest:
    """A stress at rest, with whether contacts slide under it, and whether the packing bears it."""
    zones = [(ground, 0)]
    if isinstance(ground, LayeredGround):
        zones = [(each.material, each.layer) for each in ground.zones]
    under = [(material, stress) for material, layer in zones for stress in at_rest.ends(layer)[1]]
    if all(
        within_friction(*each.stiffnesses(each.contact_constants), each.moduli.fric, pair_forces(each) @ stress)
        for each, stress in under
    ):
        return at_rest
    is_borne = all(each.sliding_forces(stress) is not None for each, stress in under)
    return replace(at_rest, slides=is_borne, is_borne=is_borne)


def gradients_of_stresses(tensor: np.ndarray) -> np.ndarray:
    """Displacement gradients (4, 3), in the order of `GRADIENTS`, of unit stresses xx, yy, xy; tensor (4, 4) Pa.

    The smallest of those that differ by a rotation, which the packing does not resist.
    """
    stresses = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]])
    return np.asarray(np.linalg.lstsq(tensor, stresses, rcond=1e-9)[0])


def pair_forces(ground: PackedMaterial) -> np.ndarray:
    """Normal, shear and bending springs' forces (3, b, 3) N and N·m of contacts per Pa of the stresses xx, yy, xy."""
    ground = ground.at_rest
    network, continuum = Network.of_brick(ground.brick, ground.stiffness), ground.continuum
    strains = network.gradient_matrix() + network.motion_matrix() @ continuum.corrector.reshape(-1, 4)
    forces: np.ndarray = network.springs[:, None] * (strains @ gradients_of_stresses(continuum.tensor))
    return forces.reshape(3, -1, 3)


def rest_forces(
    ground: PackedMaterial, at_rest: AtRest, kind: np.ndarray, heights: np.ndarray, x: np.ndarray | None = None
) -> np.ndarray:
    """Normal, shear and bending forces of the brick's contacts with their bonds, and shear forces of contacts, (4, k).

    Where some slide: of types (k,) at heights (k,) m, and places x (k,) m, in ground of one material. Within a layer
    forces change with height as the stress does, so they stay in balance and within friction.
    """
    if isinstance(at_rest, UnlikeStress):
        assert x is not None
        left, right = (rest_forces(ground, side, kind, heights, x) for side in at_rest.sides)
        return np.where(at_rest.ground.is_right(x), right, left)
    found, layer = np.empty((4, len(kind))), at_rest.layer_of(heights)
    for number in np.unique(layer).tolist():
        own = layer == number
        (top, bottom), stresses = at_rest.ends(number)
        one, other = (_sliding(ground, stress)[:, kind[own]] for stress in stresses)
        part = np.clip((top - heights[own]) / (top - bottom), 0.0, None)
        if x is not None and at_rest.surface is not None:
            vertical, (least, most) = at_rest.at(heights[own], x[own])[1], stresses[:, 1]
            part = (vertical - least) / (most - least) if most != least else np.zeros(len(vertical))
        found[:, own] = one + part * (other - one)
    return found


def _sliding(ground: PackedMaterial, stress: np.ndarray) -> np.ndarray:
    """Forces (4, b) under a stress, see `rest_forces`: beside a joint the elastic ones if friction cannot bear it."""
    found = ground.sliding_forces(stress)
    if found is not None:
        return found
    contacts, bonds = ground.stiffnesses(ground.contact_constants)
    forces = pair_forces(ground) @ stress
    return np.vstack([forces, contacts[1] * strains_of(forces, contacts + bonds)[1]])


def levels_of(assembly: Assembly, ground: PackedMaterial, at_rest: AtRest | None) -> np.ndarray:
    """A number (n,) of each disk, the same for copies of a brick under the same stress at rest: of one row of bricks.

    Below a surface that is not level only bricks below equal level parts of it have the same, and where the layers of
    both sides differ only bricks of one side.
    """
    row, brick = assembly.tile[:, 1].astype(np.int64), ground.brick
    unlike = isinstance(ground, UnlikeGround)
    if not unlike and (at_rest is None or at_rest.surface is None):
        return row
    _, first, tile = np.unique(assembly.tile[:, 0], return_index=True, return_inverse=True)
    left = assembly.positions[first, 0] - brick.positions[assembly.brick_particle[first], 0]
    if isinstance(ground, UnlikeGround):
        row = row * (len(left) + 2) + ground.side_of_bricks(left)[tile]
    if at_rest is None or at_rest.surface is None:
        return row
    reach, points = float(np.abs(brick.vectors[:, 0]).max()), at_rest.surface
    low, high = left - reach, left + float(brick.size[0]) + reach
    ends = np.interp(np.stack([low, high]), *points)
    inside = (points[0] > low[:, None]) & (points[0] < high[:, None])
    least = np.minimum(ends.min(axis=0), np.where(inside, points[1], np.inf).min(axis=1))
    most = np.maximum(ends.max(axis=0), np.where(inside, points[1], -np.inf).max(axis=1))
    is_level = most - least <= ROUNDING * at_rest.height
    heights, kind = np.unique(np.round(least[is_level] - at_rest.low, 6), return_inverse=True)
    number = len(heights) + np.arange(len(left))
    number[is_level] = kind
    return np.asarray(row * (len(heights) + len(left)) + number[tile])


def stressed(
    ground: PackedMaterial, constants: np.ndarray, assembly: Assembly, at_rest: AtRest | None
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Constants of contacts that begin under a stress at rest, the row of each contact (b,), and the slip of each row.

    constants : (2b, c + 3 or more) of the brick's contacts, of each pairing of zones in a layered ground. Where the
    stress depends on height, each row of bricks has its own, see `levels_of`. Slip in m.
    """
    if at_rest is None:
        return constants, assembly.contact_type, np.zeros(len(constants))
    brick = ground.brick
    across, middle = (brick.positions[brick.pairs[:, 0]] + 0.5 * brick.vectors).T
    began = slice(ground.law.width, ground.law.width + STRAIN)
    kind, types = assembly.contact_type.astype(np.int64), 2 * len(middle)
    _, first, row = np.unique(levels_of(assembly, ground, at_rest), return_index=True, return_inverse=True)
    begin = assembly.positions[first] - brick.positions[assembly.brick_particle[first]]
    row = np.zeros(len(kind), np.int64) if at_rest.is_uniform else row.reshape(-1)[assembly.pairs[:, 0]]
    used, variant = np.unique(row * len(ground.pairings) + kind // types, return_inverse=True)
    zones = ground.zone_materials
    linear = [] if at_rest.slides else [pair_forces(each) for each in zones]
    found, slips = np.empty((len(used), types, constants.shape[1])), np.zeros((len(used), 2, len(middle)))
    each_used = zip(*np.divmod(used, len(ground.pairings)), strict=True)
    for own, slip, (number, pairing) in zip(found, slips, each_used, strict=True):
        own[:] = constants[pairing * types : (pairing + 1) * types]
        x, heights = begin[number, 0] + across, begin[number, 1] + middle
        between = ground.pairings[pairing]
        contacts, bonds = ground.stiffnesses(own[: len(middle)])
        if at_rest.slides:
            every = np.arange(len(middle))
            forces = np.mean([rest_forces(zones[zone], at_rest, every, heights, x) for zone in between], axis=0)
            strains, slip[:] = strains_with_slip(forces, contacts, bonds)
        else:
            stress = at_rest.at(heights, x)
            forces = np.einsum("kbs,sb->bk", np.mean([linear[zone] for zone in between], axis=0), stress)
            strains = strains_of(forces.T, contacts + bonds)
        own[:, began] = np.concatenate([strains.T, strains.T])
    return found.reshape(-1, constants.shape[1]), kind % types + types * variant.reshape(-1), slips.reshape(-1)
