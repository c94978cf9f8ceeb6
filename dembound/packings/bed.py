"""A bed of disks, brought to force equilibrium at a given pressure."""

import math
from dataclasses import dataclass

import numpy as np

from dembound.errors import PackingError
from dembound.interrupts import look
from dembound.packings.brick import contact_stress, contact_vectors
from dembound.packings.contacts import listed, near_pairs, wrap

SKIN = 0.5  # largest gap in neighbour lists over the mean radius
AT_ONCE = 50_000_000  # disks and pairs times steps between two looks for a request to end, some 0.2 s
MAX_STEPS = 400_000  # of one relaxation; 10,000 disks at rest within 1e-9 take 1,500 to 15,000
MAX_ADJUSTMENTS = 60  # of the radii; about 5 are usual
GROWTH = 1.02  # of a loose disk per round: the gaps around it close by about one usual overlap
STIFFNESS = 0.7  # first guess of d(pressure/E_c)/d(ln radius): measured 0.68 at radius ratio 1.5
PRESSURE_TOLERANCE = 5e-4


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

    def compress(self, pressure: float, tolerance: float) -> None:
        """Scale all core radii by one factor until the relaxed bed is under `pressure` (over E_c).

        A secant search on the logarithm of the factor. Raises PackingError when it does not converge.
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
            step = (pressure - reached) / slope
            self.radii[self.held :] *= math.exp(step)
        raise PackingError(
            f"the packing did not converge to its confining stress: {reached / pressure:.5f} of it reached "
            f"after {MAX_ADJUSTMENTS} adjustments of the radii"
        )
