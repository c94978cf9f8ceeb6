"""A bed of disks, brought to force equilibrium at a given pressure."""

import math
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from dembound.errors import PackingError
from dembound.interrupts import look
from dembound.packings.brick import contact_stress, contact_vectors, listed, near_pairs, wrap

SKIN = 0.5  # largest gap in neighbour lists over the mean radius
AT_ONCE = 50_000_000  # disks and pairs times steps between two looks for a request to end, some 0.2 s
MAX_STEPS = 400_000  # of one relaxation; 10,000 disks at rest within 1e-9 take 1,500 to 15,000
MAX_ADJUSTMENTS = 60  # of the radii; about 5 are usual
GROWTH = 1.02  # of a loose disk per round: the gaps around it close by about one usual overlap
STIFFNESS = 0.7  # first guess of d(pressure/E_c)/d(ln radius): measured 0.68 at radius ratio 1.5
PRESSURE_TOLERANCE = 5e-4
ROUNDING = 1e-9  # of a radius: disks that touch
CAGE = 1.0  # gap over the mean radius up to which disks can be the walls of a loose disk's room


@dataclass
class Bed:
    """Disks in a periodic box; the first `held` lie on fixed rows, the others are the core.

    Attributes
    ----------
    box : (2,) m.
    positions : (n, 2) m.
    radii : (n,) m.
    held : number of row disks, which neither move nor change size.
    """

    box: np.ndarray
    positions: np.ndarray
    radii: np.ndarray
    held: int

    def overlaps(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Touching pairs (b, 2), their vectors (b, 2) m and overlaps (b,) m."""
        pairs, images = near_pairs(self.positions, self.radii, self.box, 0.0)
        vectors = contact_vectors(self.positions, pairs, images, self.box)
        return pairs, vectors, self.radii[pairs].sum(axis=1) - np.hypot(*vectors.T)

    def pressure(self) -> float:
        """Mean of the two normal stresses over E_c, compression positive."""
        _, vectors, overlaps = self.overlaps()
        return -0.5 * float(contact_stress(vectors, overlaps, self.box)[:2].sum())

    def loose(self) -> np.ndarray:
        """Core disks (n,) bool with fewer than three contacts under force.

        A frictionless disk needs three contacts to be held in place. Contacts below 1e-3 of the mean overlap are not
        counted: they appear and disappear with the last digits of the balance.
        """
        pairs, _, overlaps = self.overlaps()
        bearing = pairs[overlaps > 1e-3 * overlaps.mean()] if len(overlaps) else pairs
        few = np.bincount(bearing.ravel(), minlength=len(self.radii)) < 3
        few[: self.held] = False
        return few

    def relax(self, tolerance: float, faint: float) -> None:
        """Move the core disks until mean |unbalanced force| ≤ tolerance · mean contact force.

        `faint` (m) : smaller overlaps are replaced by this one (see `kernels.pack.relax`). Raises PackingError when the
        forces do not balance.
        """
        from dembound.kernels import pack

        skin = SKIN * float(self.radii.mean())
        velocities = np.zeros((2, len(self.radii)))
        pace = np.array([pack.FIRST_STEP, pack.MIX, 0.0])
        ratio, left = math.inf, MAX_STEPS
        while left > 0:
            _, _, pairs = listed(self.positions, self.radii, self.box, skin)
            places = self.positions.T.copy()
            origin, at_once = places.copy(), max(1, AT_ONCE // (len(pairs.first) + len(self.radii)))
            is_cut = True
            while is_cut and left > 0:
                look()
                ratio, steps, is_cut = pack.relax(
                    places, velocities, self.held, pairs, origin, 0.5 * skin, tolerance, faint, min(at_once, left), pace
                )
                left -= steps
            self.positions = wrap(np.ascontiguousarray(places.T), self.box)
            if ratio <= tolerance:
                return
        raise PackingError(
            f"the packing did not come to rest: mean unbalanced force over mean contact force is {ratio:.1e} "
            f"after {MAX_STEPS} steps, {tolerance:.0e} is required"
        )

    def crowd(self, loose: np.ndarray) -> None:
        """Increase the radii of the loose disks (n,) bool a little; disks already at the largest radius are removed.

        PFC treats floaters in the same way (Potyondy & Cundall 2004). This leaves no holes and hardly changes the
        distribution of the radii. A disk that is loose at every allowed radius carries no force and can be removed.
        """
        largest = self.radii[self.held :].max()
        hopeless = loose & (self.radii >= largest)
        self.radii[loose] = np.minimum(self.radii[loose] * GROWTH, largest)
        self.positions, self.radii = self.positions[~hopeless], self.radii[~hopeless]

    def fill_cages(self, loose: np.ndarray, excess: float) -> None:
        """Put loose disks (n,) bool into the middle of the room they have, with radii that press on its three walls.

        The radius exceeds that of the largest circle between the disks around by the mean overlap times `excess`; with
        about 1 hardly any other contact opens, while near the least density of a packing 2 % more, see `crowd`, undo as
        many contacts as they close. Of loose neighbours one is treated at a time; a disk with too much room is removed.
        """
        pairs, images = near_pairs(self.positions, self.radii, self.box, CAGE * float(self.radii.mean()))
        vectors = contact_vectors(self.positions, pairs, images, self.box)
        overlaps = self.radii[pairs].sum(axis=1) - np.hypot(*vectors.T)
        usual, largest = float(overlaps[overlaps > 0.0].mean()), self.radii[self.held :].max()
        waiting, hopeless = loose.copy(), np.zeros(len(loose), bool)
        for disk in np.flatnonzero(loose):
            first, second = (pairs == disk).T
            around = np.concatenate([pairs[first, 1], pairs[second, 0]])
            waiting[disk] = False
            if waiting[around].any():
                continue
            places = np.concatenate([vectors[first], -vectors[second]])
            centre, radius = widest_circle(places, self.radii[around])
            hopeless[disk] = max(radius, self.radii[disk]) >= largest
            self.positions[disk] += centre
            self.radii[disk] = min(radius + excess * usual, largest)
        self.positions, self.radii = wrap(self.positions[~hopeless], self.box), self.radii[~hopeless]

    def compress(self, pressure: float, tolerance: float, *, hasten: bool = False) -> None:
        """Scale all core radii by one factor until the relaxed bed is under `pressure` (over E_c).

        A secant search on the logarithm of the factor. hasten : whether steps double while disks hardly touch. Raises
        PackingError when it does not converge.
        """
        faint = 0.1 * pressure * 2.0 * float(self.radii.mean())
        slope, reached, step = STIFFNESS, math.nan, 0.0
        for _ in range(MAX_ADJUSTMENTS):
            self.relax(tolerance, faint)
            before, reached = reached, self.pressure()
            if abs(reached / pressure - 1.0) <= PRESSURE_TOLERANCE:
                return
            if abs(step) > 0.0 and before > 0.0:  # limit the slope, which jumps when disks rearrange
                slope = min(max((reached - before) / step, 0.5 * STIFFNESS), 4.0 * STIFFNESS)
            last, step = step, (pressure - reached) / slope
            if hasten and reached < 0.5 * pressure and before < 0.5 * pressure:
                step = max(step, 2.0 * last)
            self.radii[self.held :] *= math.exp(step)
        raise PackingError(
            f"the packing did not converge to its confining stress: {reached / pressure:.5f} of it reached "
            f"after {MAX_ADJUSTMENTS} adjustments of the radii"
        )


def widest_circle(places: np.ndarray, radii: np.ndarray) -> tuple[np.ndarray, float]:
    """Centre (2,) and radius of the largest circle held between three of some disks and free of all of them, in m.

    places (k, 2) and radii (k,) of the disks. Without such a circle the radius is infinite.
    """
    chosen = np.array(list(combinations(range(len(radii)), 3)), dtype=np.int64).reshape(-1, 3)
    x, r = places[chosen[:, 0]], radii[chosen[:, 0]]
    # |c − x_k| = R + r_k, the first equation less the others: c − x = a + bR
    apart, longer = places[chosen[:, 1:]] - x[:, None], radii[chosen[:, 1:]] - r[:, None]
    squares = 0.5 * ((apart**2).sum(axis=2) - longer**2) - longer * r[:, None]
    with np.errstate(all="ignore"):
        a, b = (_solved(apart, sides) for sides in (squares, -longer))
        two, one, none = (b**2).sum(axis=1) - 1.0, (a * b).sum(axis=1) - r, (a**2).sum(axis=1) - r**2
        root = np.sqrt(one**2 - two * none)
        found = np.stack([(-one - root) / two, (-one + root) / two], axis=1)
        radius = np.where(found > 0.0, found, np.inf).min(axis=1)
        centre = x + a + b * radius[:, None]
        ways = places[chosen] - centre[:, None]
        turns = _cross(ways, np.roll(ways, -1, axis=1))
        gaps = np.hypot(*np.moveaxis(centre[:, None] - places, 2, 0)) - radii - radius[:, None]
        fits = (np.abs(np.sign(turns).sum(axis=1)) == 3.0) & (gaps >= -ROUNDING * radius[:, None]).all(axis=1)
    if not fits.any():
        return np.zeros(2), math.inf
    best = np.flatnonzero(fits)[np.argmax(radius[fits])]
    return centre[best], float(radius[best])


def _cross(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Cross products of vectors (…, 2)."""
    return one[..., 0] * other[..., 1] - one[..., 1] * other[..., 0]


def _solved(rows: np.ndarray, sides: np.ndarray) -> np.ndarray:
    """Solutions (k, 2) of pairs of equations with rows (k, 2, 2) and right sides (k, 2); not finite without one."""
    (first, second), (s, t) = np.moveaxis(rows, 1, 0), sides.T
    return (s * np.array([second[:, 1], -second[:, 0]]) + t * np.array([-first[:, 1], first[:, 0]])).T / (
        _cross(first, second)[:, None]
    )
