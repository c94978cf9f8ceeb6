"""The strengths of single bonds: a factor for each, which follows from the bond's place in the packing."""

from dataclasses import dataclass

import numpy as np

from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.scatter import Scatter
from dembound.disks.material.packed_material import PackedMaterial
from dembound.packings.tiling import Assembly

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
