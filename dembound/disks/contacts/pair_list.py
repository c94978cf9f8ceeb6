"""Pairs of disks with small gaps, in the places where kernels hold them."""

import numpy as np

from dembound.disks.contacts.dashpots import Dashpots
from dembound.disks.contacts.pair_rows import PairPlan
from dembound.disks.contacts.pairs import acting
from dembound.disks.contacts.placing import ContactHistory, Pairs, in_places, numbers_of
from dembound.disks.material.constants import BondFactors
from dembound.disks.material.packed_material import PackedMaterial
from dembound.kernels.contacts import REACHED
from dembound.kernels.listing import keys_of, sorted_into
from dembound.kernels.tables.contacts import Cells, PairRows
from dembound.laws.law import AnyLimits, RollingLimits, in_columns
from dembound.motion.state import Layout, aligned_zeros
from dembound.packings.tiling import Assembly
from dembound.pairwise import STRAIN

CELL = 4.0
"""Least side of a cell over the largest diameter.

In wider cells disks move apart more, in narrower ones disks of cells that do not touch may meet sooner.
"""


@np.errstate(over="ignore", invalid="ignore")  # of motion without bound, which ends the run
def cells_of(
    positions: np.ndarray, radii: np.ndarray, numbers: np.ndarray, periods: tuple[float | None, float | None]
) -> Cells:
    """Cells of disks at positions (n, 2) m with radii (n,) m, by their numbers (n,) in kernels."""
    low, diameter = np.array([x.min() for x in positions.T]), 2.0 * float(radii.max())  # faster than along an axis
    wraps = np.array([length is not None for length in periods])
    extent = np.array([np.ptp(x) if length is None else length for x, length in zip(positions.T, periods, strict=True)])
    side = max(CELL * diameter, float(np.sqrt(extent.prod() / len(radii))))  # not many more cells than disks
    count = np.clip(np.floor(extent / side), 1, len(radii)).astype(np.int64)
    width = np.where(extent > 0.0, extent / count, 1.0)
    start, member = sorted_into(positions, low, width, count, wraps, numbers)
    # between cells that do not touch there is at least one cell
    split = count > np.where(wraps, 3, 2)
    reach = 0.5 * (float(width[split].min()) - diameter) if split.any() else np.inf
    return Cells(start, member, count, wraps, reach)


NO_LIMITS = np.array([[0.0, np.inf, np.inf, 0.0, 0.0]])
"""Limits of a place without a pair; the last one only where contacts resist rolling."""


class PairList:
    """Pairs of a part's particles, with their history, in the arrays of the kernels.

    Parameters
    ----------
    assembly, periods, begin, layout : as of `ContactList`.

    Attributes
    ----------
    arrays : the pairs for the kernels, by slots. In rows of copies some places hold no pair; these have no stiffness.
    live : (b,) the places of the pairs in `arrays`, ascending; `pairs`, `image` and `of` contain only these. Other
    places have no stiffness.
    rows : the pairs in rows of copies, which come first in `arrays`; None: there are none. With rows, strays : slots of
        the disks (k,) with ends of other pairs, offsets (k + 1,) of each one's ends, and these ends (e,); extra :
        (3, slots) work space of the kernels.
    origin : (2, m) m, displacements of the part's m slots at which the list was made; skins : (m,) m, up to whose sum
    gaps of pairs are listed.
    cells : of the particles there.
    ground : whose law says how many constants of it a pair has.
    bonds : constants of the contacts of the brick, with the limits of each in layers, see `ContactList.limits`.
    own_types : number of the types of the brick's contacts, which come before those of near pairs. factors : of the
    strengths of bonds; None: without scatter. dashpots : of contacts; None: there are none. lags : numbers by which the
    relaxation arms of a bond lag behind; 0 without arms.
    """

    ground: PackedMaterial
    limits: AnyLimits
    own_types: int
    factors: BondFactors | None
    dashpots: Dashpots | None
    lags: int
    bonds: np.ndarray
    _constants: np.ndarray

    def __init__(
        self, assembly: Assembly, periods: tuple[float | None, float | None], begin: int, layout: Layout | None
    ) -> None:
        self.assembly = assembly
        self.periods = periods
        self.nodes = slice(begin, begin + len(assembly.radii))
        self.layout = Layout.plain(self.nodes.stop) if layout is None else layout
        self._slot = self.layout.slot[self.nodes]
        self._slots = slice(int(self._slot.min()), int(self._slot.max()) + 1)
        self._ranks = np.argsort(self._slot)  # particles by their slots
        self._plan: PairPlan | None = None
        self.rows: PairRows | None = None

    def spread(self, displacement: np.ndarray) -> np.ndarray:
        """Displacements (3, n) of all nodes, reordered by slots of the particles (3, slots)."""
        return self.layout.spread(displacement[:, : len(self.layout.slot)])

    @property
    def pairs(self) -> tuple[np.ndarray, np.ndarray]:
        """First and second particle (b,) int64 of every pair, numbered from the part's first one."""
        begin, node = self.nodes.start, self.layout.node
        return node[self.of("first")] - begin, node[self.of("second")] - begin

    def of(self, name: str) -> np.ndarray:
        """A column of `arrays` for the live pairs, (b,) or (b, …)."""
        return getattr(self.arrays, name)[self.live]

    @property
    def rolls(self) -> bool:
        """Whether contacts without bonds resist rolling."""
        return isinstance(self.limits, RollingLimits)

    @property
    def image(self) -> np.ndarray:
        """Whole periods (b, 2) int8 between the particles of every pair."""
        return self._images[self.live]

    @property
    def force(self) -> np.ndarray:
        """Last forces (b, 4) of the pairs, see kernels/contacts.py."""
        return self.arrays.force[:, self.live].T

    def images(self, first: np.ndarray, second: np.ndarray, vectors: np.ndarray) -> np.ndarray:
        """Whole periods (b, 2) int8 that a pair's vector goes beyond the difference of its positions."""
        inside = self.assembly.positions[second] - self.assembly.positions[first]
        periods = np.broadcast_to([length or 0.0 for length in self.periods], inside.shape)
        wraps = np.divide(vectors - inside, periods, out=np.zeros_like(inside), where=periods > 0.0)
        return np.rint(wraps).astype(np.int8)

    def find(self, first: np.ndarray, second: np.ndarray, vectors: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Find pairs (b,) of particles with vectors (b, 2) m between them in this list.

        Returns whether they are listed (b,), and their indices (b,), for either order of the two particles.
        """
        keys = self._keys_of(first, second, self.images(first, second, vectors))
        at = numbers_of(keys, self._keys, np.argsort(self._keys))
        return at >= 0, at

    def _keys_of(self, first: np.ndarray, second: np.ndarray, images: np.ndarray) -> np.ndarray:
        """Keys (b,) of pairs of particles, see near.near_keys, by their slots."""
        return keys_of(self._slot[first], self._slot[second], images, self._slots.stop)

    def reached(self) -> tuple[np.ndarray, np.ndarray]:
        """First and second particle (b,) of the bonds that have reached their strength, but never break."""
        at = self.arrays.kept == REACHED
        if not at.any():
            return self.pairs[0][:0], self.pairs[1][:0]
        own = self.of("kept") == REACHED
        first, second = self.pairs
        return first[own], second[own]

    def coordination(self, geometry: int) -> np.ndarray:
        """Number (m,) of intact bonds and closed contacts of every particle, see `contact_forces.acting`."""
        chosen = acting(self.arrays, geometry)[self.live]
        ends = np.concatenate([particles[chosen] for particles in self.pairs])
        return np.bincount(ends, minlength=len(self.assembly.radii))

    def _set_origin(self, displacement: np.ndarray, skins: np.ndarray) -> None:
        """Store the displacements (2, m) m from which later motion is counted, and the skins (m,) m of particles."""
        self.origin = np.zeros((2, self._slots.stop - self._slots.start))
        slot = self._slot - self._slots.start
        self.origin[:, slot] = displacement
        self.skins = np.full(self.origin.shape[1], float(skins.min()))
        self.skins[slot] = skins
        self.cells = cells_of(self.assembly.positions + displacement.T, self.assembly.radii, slot, self.periods)

    def _list(self, pairs: Pairs, history: ContactHistory, room: int = 0) -> None:
        """Give the pairs their places, with room for so many in no row, and list their contact ends."""
        constants, columns = np.split(self._constants, [self.ground.law.width + STRAIN], axis=1)
        if columns.size > 0:
            columns = np.vstack([columns, NO_LIMITS[:, : columns.shape[1]]])  # of places without a pair
            self.limits = in_columns(columns, self.limits.geometry)
        placed = in_places(pairs, history, self._slot, constants, self._plan, room)
        self.arrays, self.live, self._in_rows = placed.arrays, placed.live, placed.in_rows
        self._images = placed.images
        self._keys = placed.keys
        self._row_keys = np.sort(self._keys[: self._in_rows])
        if self.factors is not None:
            self.limits = self.limits._replace(factor=self._factors(self.factors))
        if self.dashpots is not None:
            viscosity = self.dashpots.at(self.arrays)
            drag = self.arrays.drag if history.drag is not None else np.zeros_like(viscosity)
            damps_bonds = self.dashpots.damps_bonds
            self.arrays = self.arrays._replace(viscosity=viscosity, drag=drag, damps_bonds=damps_bonds)
        if self.lags > 0 and history.lag is None:
            self.arrays = self.arrays._replace(lag=aligned_zeros(self.lags, len(self.arrays.first)))
        if self.rolls and history.rolled is None:
            self.arrays = self.arrays._replace(rolled=aligned_zeros(len(self.arrays.first)))
        if self._plan is not None:
            self.rows = self._plan.rows(self.live[: self._in_rows], constants)
            self.extra = aligned_zeros(3, self.layout.count)
        self._note_strays()

    def _note_strays(self) -> None:
        """Find the disks with ends of pairs in no row, beside rows of copies."""
        if self._plan is not None:
            start, end = self.arrays.start, self.arrays.end
            slots = np.flatnonzero(np.diff(start))
            self.strays = slots, np.append(start[slots], len(end)).astype(np.int64), end

    def _factors(self, factors: BondFactors) -> np.ndarray:
        """Factors of the strengths of the bonds in all places of `arrays`, 1 where there is none."""
        found = aligned_zeros(len(self.arrays.contact_type))
        first = self.layout.node[self.arrays.first] - self.nodes.start
        found[:] = self._factors_of(factors, first, self.arrays.contact_type)
        return found

    def _factors_of(self, factors: BondFactors, first: np.ndarray, contact_type: np.ndarray) -> np.ndarray:
        """Factors (b,) of the strengths of pairs of first particles (b,); 1 for those that were not built."""
        found, bonded = np.ones(len(first)), np.flatnonzero(contact_type < self.own_types)
        found[bonded] = factors.at(first[bonded], contact_type[bonded])
        return found
