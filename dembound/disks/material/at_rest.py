"""The stress of undisturbed ground at rest, and the strain that it gives the pairs of a packing.

In an endless packing under a uniform stress every copy of a contact has the same force, known from the homogenisation.
Contacts that begin with these forces, scaled by the stress at their height, are at rest in a body, in its free-field
column and across the sides of both, without any displacement: a stress that no displacement could reach, as a column
that is periodic sideways cannot be strained along x.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.load import gravity
from dembound.disks.material.homogenise import Network
from dembound.disks.material.layered import LayeredGround
from dembound.disks.material.packed_material import PackedMaterial
from dembound.packings.tiling import Assembly


@dataclass(frozen=True, eq=False)
class StressAtRest:
    """The stress of undisturbed ground by height.

    Attributes
    ----------
    uniform : (3,) xx, yy, xy in Pa, tension positive, at all heights.
    tops : (l,) m, the upper ends of layers from the surface down. growth : (l,) Pa/m, by which σ_yy grows per metre of
    depth in each, negative under weight; k0 : (l,) the stress along x over that along y due to weight.
    """

    uniform: np.ndarray
    tops: np.ndarray
    growth: np.ndarray
    k0: np.ndarray

    @property
    def is_uniform(self) -> bool:
        """Whether the stress is the same at all heights."""
        return not self.growth.any()

    def at(self, heights: np.ndarray) -> np.ndarray:
        """Stress (3, k) xx, yy, xy in Pa at heights (k,) m; above the surface that of no weight."""
        thick = np.append(-np.diff(self.tops), np.inf)
        within = np.clip(self.tops[:, None] - heights, 0.0, thick[:, None])
        vertical = self.growth @ within
        ratio = self.k0[np.maximum(np.searchsorted(-self.tops, -heights, side="right") - 1, 0)]
        stress: np.ndarray = self.uniform[:, None] + np.stack([ratio * vertical, vertical, np.zeros_like(vertical)])
        return stress


def stress_at_rest(case: DiskCase, ground: PackedMaterial) -> StressAtRest | None:
    """The stress with which the contacts of a case begin; None if they begin without forces.

    Weight counts from the height at which the packing's mass ends.
    """
    static = case.static
    if static is None or not case.begins_stressed:
        return None
    down = 0.0 if static.k0 is None else sum(gravity(case.load))
    surface = case.box[3] + float(ground.brick.mass_offset[1])
    layers = [(surface, ground.density, static.k0)]
    if isinstance(ground, LayeredGround):
        own = [case.layer[zone.layer].k0 for zone in ground.layers]
        each = zip(ground.layers, own, strict=True)
        layers = [(zone.high, zone.material.density, static.k0 if k0 is None else k0) for zone, k0 in each][::-1]
    tops, densities, ratios = zip(*layers, strict=True)
    return StressAtRest(
        uniform=np.array(static.stress or (0.0, 0.0, 0.0)),
        tops=np.minimum(tops, surface),
        growth=down * np.array(densities),
        k0=np.array([ratio or 0.0 for ratio in ratios]),
    )


def gradients_of_stresses(tensor: np.ndarray) -> np.ndarray:
    """Displacement gradients (4, 3), in the order of `GRADIENTS`, of unit stresses xx, yy, xy; tensor (4, 4) Pa.

    The smallest of those that differ by a rotation, which the packing does not resist.
    """
    stresses = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]])
    found: np.ndarray = np.linalg.lstsq(tensor, stresses, rcond=1e-9)[0]
    return found


def pair_forces(ground: PackedMaterial) -> np.ndarray:
    """Normal, shear and bending springs' forces (3, b, 3) N and N·m of contacts per Pa of the stresses xx, yy, xy."""
    network, continuum = Network.of_brick(ground.brick, ground.stiffness), ground.continuum
    strains = network.gradient_matrix() + network.motion_matrix() @ continuum.corrector.reshape(-1, 4)
    forces: np.ndarray = network.springs[:, None] * (strains @ gradients_of_stresses(continuum.tensor))
    return forces.reshape(3, -1, 3)


def stressed(
    ground: PackedMaterial, constants: np.ndarray, assembly: Assembly, at_rest: StressAtRest | None
) -> tuple[np.ndarray, np.ndarray]:
    """Constants of contacts that begin under a stress at rest, and the row of each contact (b,) of an assembly.

    constants : (2b, 15) of the brick's contacts, of each pairing of zones in a layered ground. Where the stress depends
    on height, each row of bricks has its own.
    """
    if at_rest is None:
        return constants, assembly.contact_type
    brick = ground.brick
    middle = brick.positions[brick.pairs[:, 0], 1] + 0.5 * brick.vectors[:, 1]
    kind, types = assembly.contact_type.astype(np.int64), 2 * len(middle)
    _, first, row = np.unique(assembly.tile[:, 1], return_index=True, return_inverse=True)
    base = assembly.positions[first, 1] - brick.positions[assembly.brick_particle[first], 1]
    row = np.zeros(len(kind), np.int64) if at_rest.is_uniform else row.reshape(-1)[assembly.pairs[:, 0]]
    used, variant = np.unique(row * len(ground.pairings) + kind // types, return_inverse=True)
    by_zone = [pair_forces(each.material) for each in ground.zones] if isinstance(ground, LayeredGround) else []
    found = np.empty((len(used), types, constants.shape[1]))
    for own, (number, pairing) in zip(found, zip(*np.divmod(used, len(ground.pairings)), strict=True), strict=True):
        own[:] = constants[pairing * types : (pairing + 1) * types]
        between = [by_zone[zone] for zone in ground.pairings[pairing]] if by_zone else [pair_forces(ground)]
        forces = np.einsum("kbs,sb->bk", np.mean(between, axis=0), at_rest.at(base[number] + middle))
        springs = _springs(own[: len(middle)])
        strains = np.divide(forces, springs, out=np.zeros_like(forces), where=springs > 0.0)
        own[:, 12:15] = np.concatenate([strains, strains])
    return found.reshape(-1, constants.shape[1]), kind % types + types * variant.reshape(-1)


def _springs(constants: np.ndarray) -> np.ndarray:
    """Stiffnesses (b, 3) of contact and bond together against stretch, shear and rotation."""
    closed = constants[:, 3] >= constants[:, 2]
    normal, shear = (np.where(closed, constants[:, k], 0.0) + constants[:, k + 2] for k in (5, 6))
    return np.column_stack([normal, shear, constants[:, 9]])
