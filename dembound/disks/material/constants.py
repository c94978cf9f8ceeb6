"""Constants and limits of contacts under the history-dependent law, and strengths of single bonds."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from dembound.casefile.disks.material import Material
from dembound.casefile.disks.model import DiskCase
from dembound.casefile.disks.targets import Scatter
from dembound.casefile.types import LAWS
from dembound.disks.material.layered import LayeredGround
from dembound.disks.material.packed_material import PackedMaterial
from dembound.kernels.contacts import BONDED, REFERENCE, UPDATED
from dembound.laws.law import AnyLimits, RollingLimits, Stiffness, columns_of, in_columns
from dembound.packings.brick import Brick
from dembound.packings.tiling import Assembly
from dembound.pairwise import PLACE

LEVEL = 1e-6
"""Largest deviation from straight, and difference of radii, over the radius: rounding."""


def with_images(ground: PackedMaterial, axis: int, diameters: np.ndarray) -> Stiffness:
    """Constants of the contacts of disks (k,) with their images beyond a side, of diameters (k,) m.

    axis : of the side's normal. The distance of a disk from its image is that of equal disks straight across the side
    between bricks side by side, so that a lattice continues with its own contacts, touching or across a gap. Where a
    brick has no such disks, disks touch their images.
    """
    sizes, which = np.unique(diameters, return_inverse=True)
    distances = np.array([_distance(ground.brick, axis, size) for size in sizes.tolist()])[which]
    distances = np.where(np.isnan(distances), diameters, distances)
    return ground.law.stiffness(ground.moduli, 0.5 * diameters, 0.5 * diameters, distances)


def continues(brick: Brick, axis: int, diameters: np.ndarray) -> bool:
    """Whether bricks side by side have disks of all of these diameters (k,) m straight across a side."""
    return not any(np.isnan(_distance(brick, axis, each)) for each in np.unique(diameters).tolist())


def _distance(brick: Brick, axis: int, diameter: float) -> float:
    """Distance (m) of the nearest equal disks straight across a side; nan for none."""
    vectors, level = brick.vectors, 0.5 * diameter * LEVEL
    straight = (brick.images[:, axis] != 0) & (np.abs(vectors[:, 1 - axis]) <= level)
    equal = (np.abs(brick.radii[brick.pairs] - 0.5 * diameter) <= level).all(axis=1)
    distances = np.abs(vectors[straight & equal, axis])
    return float(distances.min()) if len(distances) else float("nan")


def strength_of(material: Material) -> RollingLimits:
    """Strengths, friction and rolling resistance of a material in the geometry of the start, whatever its law."""
    return RollingLimits(
        friction=float(material.fric),
        tension=np.inf if material.pb_ten is None else material.pb_ten,
        cohesion=np.inf if material.pb_coh is None else material.pb_coh,
        tan_fa=float(np.tan(np.radians(material.pb_fa))) if material.pb_coh is not None else 0.0,
        rolling=float(material.rr_fric),
        geometry=REFERENCE,
    )


def limits_of(material: Material) -> AnyLimits:
    """Limits of contacts under their law; infinite for bonds under a law that is not history-dependent."""
    strength = strength_of(material)
    if not LAWS[material.law].has_history:
        return strength._replace(tension=np.inf, cohesion=np.inf)
    geometry = {"updated": UPDATED, "reference": BONDED}[material.geometry]
    found: AnyLimits = LAWS[material.law].limits(strength._replace(geometry=geometry))
    return found


def limits_between(
    pairings: Iterable[tuple[Material, Material]],
    types: int,
    of: Callable[[Material], AnyLimits] = limits_of,
    *,
    rolls: bool = False,
) -> AnyLimits:
    """Columns (p,) of the limits of contacts between two materials: `types` rows for each pairing, in their order.

    The smaller friction, resistance to rolling and tensile strength hold, and the line of shear strength with the
    smaller cohesion. of : `limits_of` or `strength_of`. rolls : whether contacts may resist rolling at other times.
    """
    rows = [_weaker(_in_full(of(one)), _in_full(of(other))) for one, other in pairings]
    columns = np.repeat([columns_of(row) for row in rows], types, axis=0)
    rolls = rolls or bool(columns[:, RollingLimits._fields.index("rolling")].any())
    return in_columns(columns if rolls else columns[:, :-1], rows[0].geometry)


def _in_full(limits: AnyLimits) -> RollingLimits:
    """Limits with a resistance to rolling, which may be 0."""
    if isinstance(limits, RollingLimits):
        return limits
    return RollingLimits(**{**limits._asdict(), "rolling": 0.0})


def ground_limits(
    ground: PackedMaterial,
    materials: Sequence[Material],
    of: Callable[[Material], AnyLimits] = limits_of,
    *,
    rolls: bool = False,
) -> AnyLimits:
    """Limits of the contacts of a ground: numbers, in layered ground columns by their types, see `limits_between`.

    materials : of its layers from the surface down. rolls : see `limits_between`.
    """
    if not isinstance(ground, LayeredGround):
        return of(materials[0])
    own = [materials[zone.layer] for zone in ground.zones]
    pairings = [(own[one], own[other]) for one, other in ground.pairings]
    return limits_between(pairings, 2 * len(ground.brick.pairs), of, rolls=rolls)


def _weaker(one: RollingLimits, other: RollingLimits) -> RollingLimits:
    """Limits of contacts between materials of two limits."""
    sheared = min(one, other, key=lambda each: (each.cohesion, each.tan_fa))
    least = {name: min(getattr(one, name), getattr(other, name)) for name in ("friction", "tension", "rolling")}
    return sheared._replace(**least)


def brick_constants(ground: PackedMaterial, *, gaps_close: bool, locked_in: float) -> np.ndarray:
    """Constants (2b, c + 3) of the brick's contacts, followed by the same with half their stiffness, for half cells.

    For each pairing of zones in a layered ground. Arguments as for `pair_constants`.
    """
    brick = ground.brick
    first, second = brick.radii[brick.pairs].T
    found = []
    for pairing in ground.pairings:
        own = (first, second), brick.vectors, pairing
        constants = ground.pair_constants(*own, gaps_close=gaps_close, locked_in=locked_in)
        half = constants.copy()
        half[:, : ground.law.width] *= [each.in_half for each in ground.law.columns]
        found += [constants, half]
    return np.vstack(found)


def shared_constants(constants: np.ndarray, zones: np.ndarray, width: int) -> tuple[np.ndarray, np.ndarray]:
    """Distinct rows (p, …) of the constants of pairs, and the row of each pair (b,).

    Pairs at the same place of different bricks then share a row, if they are in the same zones (b, 2) and have the same
    limits; width : number of constants of the law.
    """
    places = np.column_stack([constants[:, : len(PLACE)], zones, constants[:, width:]])
    _, first, row_of = np.unique(places, axis=0, return_index=True, return_inverse=True)
    return constants[first], row_of.reshape(-1)


LEAST = 0.05
"""Smallest factor of a strength."""

DEVIATIONS = 3.0
"""Deviations from 1 at which normal factors are cut off, on either side."""

APART = 0.2718
"""Part of a brick by which tiles are counted further, so that no body begins at the edge of one."""


@dataclass(frozen=True, eq=False)
class BondFactors:
    """Factors of the strengths of the bonds of a part.

    A bond is a copy of a contact of the brick. Its factor follows from a seed, that contact, and the tile, counted from
    the origin of coordinates, that its first disk is in: not from the order of disks and contacts, nor from which
    others there are.

    scatter : the distribution; None: all factors are 1. tile : (m, 2) of each disk; contacts : number of those of the
    brick.
    """

    scatter: Scatter | None
    seed: int
    tile: np.ndarray
    contacts: int

    def at(self, first: np.ndarray, contact: np.ndarray) -> np.ndarray:
        """Factors (b,) of bonds by their first disk (b,) and the brick's contact (b,) of which each is a copy."""
        if self.scatter is None:
            return np.ones(len(first))
        x, y = self.tile[first].T
        return drawn(self.scatter, uniform(self.seed, self.scatter.seed, x, y, contact % self.contacts))


def bond_factors(
    case: DiskCase, ground: PackedMaterial, assembly: Assembly, *, alike: bool = False
) -> BondFactors | None:
    """The factors of the bonds of an assembly of a case; None without scatter.

    alike : whether all factors are 1, as in a free-field column, whose bonds stand for those of all the ground beyond.
    """
    scatter, size = case.material.pb_scatter, ground.brick.size
    if scatter is None:
        return None
    tile = assembly.tile + np.floor(assembly.origin / size + APART).astype(np.int64)
    seed = int(getattr(case.packing, "seed", 0))  # a lattice has none
    return BondFactors(None if alike else scatter, seed, tile, len(ground.brick.pairs))


def uniform(*numbers: int | np.ndarray) -> np.ndarray:
    """Random numbers (b,) between 0 and 1, ends excluded, that follow from whole numbers (b,): hashed by SplitMix64."""
    mixed = np.zeros(1, dtype=np.uint64)
    for each in numbers:
        mixed = mixed + np.asarray(each, dtype=np.int64).astype(np.uint64) + np.uint64(0x9E3779B97F4A7C15)
        mixed = (mixed ^ (mixed >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
        mixed = (mixed ^ (mixed >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
        mixed = mixed ^ (mixed >> np.uint64(31))
    return ((mixed >> np.uint64(12)).astype(np.float64) + 0.5) * 2.0**-52


def drawn(scatter: Scatter, share: np.ndarray) -> np.ndarray:
    """Factors (b,) of mean 1 below which a share (b,), 0 to 1, of all factors is."""
    from scipy.special import gamma, gammaincc, ndtr, ndtri

    if scatter.type == "normal":
        assert scatter.deviation is not None
        most = min(DEVIATIONS, (1.0 - LEAST) / scatter.deviation)
        low = ndtr(-most)
        found = 1.0 + scatter.deviation * ndtri(low + share * (1.0 - 2.0 * low))
    else:
        assert scatter.shape is not None
        scale = 1.0 / gamma(1.0 + 1.0 / scatter.shape)
        cut = (LEAST / scale) ** scatter.shape
        found = scale * (cut - np.log1p(-share)) ** (1.0 / scatter.shape)
        # the mean of those above the cut
        found /= scale * gamma(1.0 + 1.0 / scatter.shape) * gammaincc(1.0 + 1.0 / scatter.shape, cut) * np.exp(cut)
    return np.asarray(found)
