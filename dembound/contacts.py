"""The pairs of a scene: who touches or may soon touch whom, kept up to date as particles move."""

from dataclasses import dataclass, fields

import numpy as np

from dembound.case.material import Material
from dembound.ground import Ground
from dembound.kernels import contacts as kernel
from dembound.kernels.common import CHUNKS
from dembound.kernels.contacts import BONDED, INTACT, NONE, REFERENCE, SHEAR, TENSION, UPDATED
from dembound.kernels.tables import Contacts, Limits
from dembound.laws import pair_lines
from dembound.neighbours import near_pairs, pair_keys
from dembound.packings.column import Seam
from dembound.packings.tiling import Assembly

SKIN = 0.05
"""Pairs are listed while their gap is below this share of the mean diameter: they are looked for anew once a particle
has moved by half of it."""


@dataclass(frozen=True)
class Cracks:
    """Bonds that broke, k of them in the order they did.

    step (k,) int64; pair (k, 2) int64 particles; position (k, 2) m, between the two at the end of the block of steps
    in which it broke; shear (k,) bool, broken in shear, not in tension.
    """

    step: np.ndarray
    pair: np.ndarray
    position: np.ndarray
    shear: np.ndarray

    def __len__(self) -> int:
        return len(self.step)

    def among(self, kept: np.ndarray) -> "Cracks":
        """Those between two of the particles kept (m,), ascending, and numbered as these are."""
        inside = np.isin(self.pair, kept).all(axis=1)
        pair = np.searchsorted(kept, self.pair[inside])
        return Cracks(self.step[inside], pair, self.position[inside], self.shear[inside])


NO_CRACKS = Cracks(np.zeros(0, np.int64), np.zeros((0, 2), np.int64), np.zeros((0, 2)), np.zeros(0, np.bool_))
"""Nothing broke."""


def limits_of(material: Material) -> Limits:
    """Where contacts and bonds of a material give way; the elastic law never does."""
    unbreakable = material.law == "elastic"
    return Limits(
        friction=float(material.fric),
        tension=np.inf if unbreakable or material.pb_ten is None else material.pb_ten,
        cohesion=np.inf if unbreakable or material.pb_coh is None else material.pb_coh,
        tan_fa=float(np.tan(np.radians(material.pb_fa))) if material.pb_coh is not None else 0.0,
        geometry=REFERENCE if unbreakable else {"updated": UPDATED, "reference": BONDED}[material.geometry],
    )


@dataclass(frozen=True)
class Pairs:
    """A list of pairs: first, second (b,) particles, image (b, 2) whole periods between, line (b,) of the palette."""

    first: np.ndarray
    second: np.ndarray
    image: np.ndarray
    line: np.ndarray


class ContactList:
    """All pairs of a scene that push or may soon push, with their memory.

    Parameters
    ----------
    ground : brick and material.
    assembly : where the particles are at the start.
    periods : length (m) of the scene along x and y where it is periodic, else None.
    seam : the free-field column in the assembly and its seam with the body, if there is one.

    Attributes
    ----------
    arrays : the pairs as the kernels read them.
    limits : where they give way.
    origin : (2, n) m, displacements at which the list was made.
    skin : m, gap up to which it is complete.
    arms : (n,) m, the longest arm of each particle's contacts and bonds.
    """

    def __init__(
        self,
        ground: Ground,
        material: Material,
        assembly: Assembly,
        periods: tuple[float | None, float | None],
        seam: Seam | None = None,
    ) -> None:
        self.ground = ground
        self.assembly = assembly
        self.periods = periods
        self.seam = seam
        count = len(assembly.radii)
        self._bodies = [(slice(0, count), periods)]
        if seam is not None:
            self._bodies = [(slice(0, seam.count), (seam.width, periods[1])), (slice(seam.count, count), periods)]
        self._periods = np.zeros((count, 2))
        for body, lengths in self._bodies:
            self._periods[body] = [length or 0.0 for length in lengths]
        self.limits = limits_of(material)
        self.locked_in = 0.0 if material.locked_in is None else material.locked_in / ground.packed_pressure
        self.searches = self.limits.geometry != REFERENCE
        self.skin = SKIN * ground.brick.mean_diameter
        self.origin = np.zeros((2, len(assembly.radii)))
        self._bonds = _brick_lines(ground, gaps_close=self.searches, locked_in=self.locked_in)
        first, second = assembly.pairs.T.astype(np.int64)
        pairs = Pairs(first, second, self._images(first, second, self._bonds[assembly.kind, :2]), assembly.kind)
        bonded = np.full(len(first), INTACT if ground.moduli.pb_emod > 0.0 else NONE, dtype=np.uint8)
        zero = np.zeros(len(first))
        self._palette = self._bonds
        self._list(pairs, bonded, zero, zero, np.full(len(first), -1))
        widest = np.maximum(ground.moduli.pb_rmul, 1.0) * assembly.radii
        self.arms = widest + 0.5 * max(float(ground.brick.gaps.max(initial=0.0)), 0.0)
        self._cracks: list[Cracks] = []
        if self.searches:
            self.search(np.zeros((3, len(assembly.radii))))

    def adopt(self, displacement: np.ndarray) -> None:
        """Take over from the elastic law at displacements (3, n): nothing has slid so far."""
        kernel.adopt(displacement, self.arrays)

    def forces(self, displacement: np.ndarray, *, reference: bool = False) -> np.ndarray:
        """Forces and moments (3, n) on the particles at displacements (3, n) reached at rest.

        The pairs' own forces are left in `arrays`. reference: with the geometry of the start, as under the elastic law.
        """
        elastic = self.limits._replace(geometry=REFERENCE, tension=np.inf, cohesion=np.inf)
        limits = elastic if reference else self.limits
        still = np.zeros_like(displacement)
        kernel.push(displacement, still, 0.0, 0, self.arrays, limits, np.empty((CHUNKS, 2)))
        return self.last_forces()

    def last_forces(self) -> np.ndarray:
        """Forces and moments (3, n) on the particles from the pairs' last forces, those across a seam included."""
        force = np.empty((3, len(self.assembly.radii)))
        kernel.sum_forces(self.arrays, force)
        if self.seam is not None:
            force[:, self.seam.node] += self.across_the_seam()
        return force

    @property
    def bodies(self) -> list[slice]:
        """The particles of each body: the free-field column, if there is one, and the body itself."""
        return [particles for particles, _ in self._bodies]

    def across_the_seam(self) -> np.ndarray:
        """Forces and moments (3, k) that the seam's nodes get through their twins, from the pairs' last forces."""
        seam = self.seam
        assert seam is not None
        ends = self.seam_ends()
        pair, side = ends >> 1, ends & 1
        sign = 1.0 - 2.0 * side
        pushes = np.stack([*(sign * self.arrays.force[pair, :2].T), self.arrays.force[pair, 2 + side]])
        across = np.zeros((3, len(seam.node)))
        row = np.repeat(np.arange(len(seam.node)), seam.many)
        for component in range(3):
            np.add.at(across[component], row, pushes[component])
        return across

    def search(self, displacement: np.ndarray) -> None:
        """List the pairs anew for displacements (3, n): near ones come in, those far apart and unbonded go."""
        self.note_cracks(displacement)
        here = self.assembly.positions + displacement[:2].T
        if not np.isfinite(here).all():
            return  # the loop's watch will say so
        old, count = self.arrays, len(self.assembly.radii)
        near, image = self._near(here)
        vectors = displacement[:2, old.second].T - displacement[:2, old.first].T + old.palette[old.kind, :2]
        gap = np.hypot(*vectors.T) - self.assembly.radii[old.first] - self.assembly.radii[old.second]
        kept = (old.state == INTACT) | (gap <= self.skin)
        kept[self.seam_ends() >> 1] = True
        keys = pair_keys(old.first[kept], old.second[kept], self._image[kept], count)
        fresh = ~np.isin(pair_keys(near[:, 0], near[:, 1], image, count), keys)
        first, second = near[fresh].T
        vectors = self.assembly.positions[second] - self.assembly.positions[first] + image[fresh] * self._periods[first]
        radii = self.assembly.radii
        lines = pair_lines(
            self.ground.moduli, radii[first], radii[second], vectors, bonded=False, locked_in=self.locked_in
        )
        lines, line_of_new = _shared(lines, self.skin)
        # lines of earlier searches that are still in use move up behind the brick's own
        own = len(self._bonds)
        used, line = np.unique(old.kind[kept], return_inverse=True)
        extra = used >= own
        place = used.astype(np.int64)
        place[extra] = own + np.arange(np.count_nonzero(extra))
        self._palette = np.vstack([self._bonds, self._palette[used[extra]], lines])
        pairs = Pairs(
            np.concatenate([old.first[kept], first]),
            np.concatenate([old.second[kept], second]),
            np.concatenate([self._image[kept], image[fresh]]),
            np.concatenate([place[line], own + np.count_nonzero(extra) + line_of_new]),
        )
        self._list(
            pairs,
            np.concatenate([old.state[kept], np.full(len(first), NONE, dtype=np.uint8)]),
            np.concatenate([old.shear[kept], np.zeros(len(first))]),
            np.concatenate([old.slip[kept], np.zeros(len(first))]),
            np.concatenate([old.cracked[kept], np.full(len(first), -1)]),
        )
        self.origin = displacement[:2].copy()

    def inherit(self, other: "ContactList", kept: np.ndarray) -> None:
        """Take the pairs, with their memory, of a list of more particles, of which this one's are `kept` (n,)."""
        number = np.full(len(other.assembly.radii), -1)
        number[kept] = np.arange(len(kept))
        old = other.arrays
        first, second = number[old.first], number[old.second]
        left = (first >= 0) & (second >= 0)
        self._palette, self.origin = other._palette, other.origin[:, kept]
        pairs = Pairs(first[left], second[left], other._image[left], old.kind[left])
        self._list(pairs, old.state[left], old.shear[left], old.slip[left], old.cracked[left])

    def copy_column(self, column: "ContactList", displacement: np.ndarray) -> None:
        """Take the history of each pair's twin in a free-field column that has settled alone, at displacements (3, n).

        Bonds that broke there have broken here before the first step.
        """
        assert self.seam is not None
        self.search(displacement)
        pairs, twin, count = self.arrays, self.seam.twin, len(self.assembly.radii)
        first, second = twin[pairs.first], twin[pairs.second]
        image = self._images(first, second, pairs.palette[pairs.kind, :2])
        there = column.arrays
        known = pair_keys(there.first, there.second, column._image, count)
        order = np.argsort(known)
        keys = pair_keys(first, second, image, count)
        at = order[np.minimum(np.searchsorted(known, keys, sorter=order), len(order) - 1)]
        found = known[at] == keys
        for ours, theirs in ((pairs.state, there.state), (pairs.shear, there.shear), (pairs.slip, there.slip)):
            ours[found] = theirs[at[found]]
        pairs.cracked[(pairs.state == TENSION) | (pairs.state == SHEAR)] = 0
        self.note_cracks(displacement)

    def note_cracks(self, displacement: np.ndarray) -> None:
        """Write down the bonds that broke since the last time; displacement (3, n) is that of now."""
        pairs = self.arrays
        broken = np.flatnonzero(pairs.cracked >= 0)
        broken = broken[np.argsort(pairs.cracked[broken], kind="stable")]
        if len(broken) == 0:
            return
        first, second = pairs.first[broken].astype(np.int64), pairs.second[broken].astype(np.int64)
        half = 0.5 * pairs.palette[pairs.kind[broken], :2]
        middle = self.assembly.positions[first] + half + 0.5 * (displacement[:2, first] + displacement[:2, second]).T
        shear = pairs.state[broken] == SHEAR
        self._cracks.append(Cracks(pairs.cracked[broken], np.column_stack([first, second]), middle, shear))
        pairs.cracked[broken] = -1

    def take_cracks(self) -> Cracks:
        """The bonds that broke since this was last called."""
        noted, self._cracks = [NO_CRACKS, *self._cracks], []
        columns = (np.concatenate([getattr(part, field.name) for part in noted]) for field in fields(Cracks))
        return Cracks(*columns)

    def seam_ends(self) -> np.ndarray:
        """Contact ends (e,) at which the seam's twins feel what is beyond it, in the order of the seam's contacts."""
        seam, count = self.seam, len(self.assembly.radii)
        if seam is None:
            return np.zeros(0, dtype=np.int64)
        owner = np.repeat(seam.twin[seam.node], seam.many)
        vectors = self._bonds[seam.kind, :2] * np.where(seam.second, -1.0, 1.0)[:, None]
        image = self._images(owner, seam.near, vectors)
        listed = pair_keys(self.arrays.first, self.arrays.second, self._image, count)
        order = np.argsort(listed)
        pair = order[np.searchsorted(listed, pair_keys(owner, seam.near, image, count), sorter=order)]
        turned = (self.arrays.first[pair] != owner) | (self._image[pair] != image).any(axis=1)
        return 2 * pair + turned

    def broken_bonds(self) -> np.ndarray:
        """Number (n,) of broken bonds of every particle among the listed pairs."""
        pairs = self.arrays
        broken = (pairs.state == TENSION) | (pairs.state == SHEAR)
        ends = np.concatenate([pairs.first[broken], pairs.second[broken]])
        return np.bincount(ends, minlength=len(self.assembly.radii))

    def coordination(self) -> np.ndarray:
        """Number (n,) of intact bonds and pushing contacts of every particle, from the pairs' last forces."""
        pairs = self.arrays
        acts = (pairs.state == INTACT) | pairs.force[:, :2].any(axis=1)
        ends = np.concatenate([pairs.first[acts], pairs.second[acts]])
        return np.bincount(ends, minlength=len(self.assembly.radii))

    def _list(self, pairs: Pairs, state: np.ndarray, shear: np.ndarray, slip: np.ndarray, cracked: np.ndarray) -> None:
        """Sort the pairs, and list the ends of each particle."""
        order = np.lexsort((pairs.image[:, 1], pairs.image[:, 0], pairs.second, pairs.first))
        self._image = pairs.image[order]
        first, second = pairs.first[order], pairs.second[order]
        count, b = len(self.assembly.radii), len(order)
        owner = np.concatenate([first, second])
        end = np.concatenate([2 * np.arange(b), 2 * np.arange(b) + 1])
        start = np.zeros(count + 1, dtype=np.uint32)
        np.cumsum(np.bincount(owner, minlength=count), out=start[1:])
        self.arrays = Contacts(
            first=first.astype(np.uint32),
            second=second.astype(np.uint32),
            kind=pairs.line[order].astype(np.uint32),
            palette=self._palette,
            state=state[order],
            shear=shear[order],
            slip=slip[order],
            cracked=cracked[order],
            force=np.zeros((b, 4)),
            start=start,
            end=end[np.lexsort((end, owner))].astype(np.uint32),
        )

    def _images(self, first: np.ndarray, second: np.ndarray, vectors: np.ndarray) -> np.ndarray:
        """Whole periods (b, 2) that a pair's vector goes beyond the difference of its positions."""
        inside = self.assembly.positions[second] - self.assembly.positions[first]
        periods = self._periods[first]
        wraps = np.divide(vectors - inside, periods, out=np.zeros_like(inside), where=periods > 0.0)
        return np.rint(wraps).astype(np.int64)

    def _near(self, positions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Pairs (b, 2) within the skin at positions (n, 2) and the periods between them, body by body."""
        found = []
        for body, periods in self._bodies:
            near, image = near_pairs(positions[body], self.assembly.radii[body], self.skin, periods)
            found.append((near + body.start, image))
        pairs, images = zip(*found, strict=True)
        return np.concatenate(pairs), np.concatenate(images)


def plain_contacts(ground: Ground, assembly: Assembly) -> Contacts:
    """The contacts of the elastic law, without memory, forces and rows: what its strain energy takes."""
    first, second = assembly.pairs.T.astype(np.uint32, order="C")
    bonded = INTACT if ground.moduli.pb_emod > 0.0 else NONE
    nothing = np.zeros(0)
    return Contacts(
        first=first,
        second=second,
        kind=assembly.kind.astype(np.uint32),
        palette=_brick_lines(ground, gaps_close=False, locked_in=0.0),
        state=np.full(len(first), bonded, dtype=np.uint8),
        shear=nothing,
        slip=nothing,
        cracked=np.zeros(0, dtype=np.int64),
        force=np.zeros((0, 4)),
        start=first[:0],
        end=first[:0],
    )


def _brick_lines(ground: Ground, *, gaps_close: bool, locked_in: float) -> np.ndarray:
    """Palette lines (2b, 12) of the brick's contacts, then the same with half their stiffness, for half cells.

    The words are those of `pair_lines`.
    """
    brick = ground.brick
    first, second = brick.radii[brick.pairs].T
    lines = pair_lines(
        ground.moduli,
        first,
        second,
        brick.vectors,
        bonded=ground.moduli.pb_emod > 0.0,
        gaps_close=gaps_close,
        locked_in=locked_in,
    )
    half = lines.copy()
    half[:, 5:10] *= 0.5  # stiffnesses
    half[:, 10:] *= 2.0  # and areas and sections with them, so that stresses stay
    return np.vstack([lines, half])


def _shared(lines: np.ndarray, length: float) -> tuple[np.ndarray, np.ndarray]:
    """Palette lines (p, 12) of pairs without those that are equal but for rounding, and each pair's line (b,).

    Pairs at the same place of different bricks then share a line; length (m) is what rounding is small against.
    """
    places = np.round(lines[:, :5] / (1e-6 * length))
    _, first, line_of = np.unique(places, axis=0, return_index=True, return_inverse=True)
    return lines[first], line_of.reshape(-1)
