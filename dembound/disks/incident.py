"""Plane waves that enter a body from the continuum below it, and the forces by which its ties pass them on.

Disks have the total motion, the grid has the scattered one alone: what remains without the incident wave

    u(y, t) = Σ_m p_m g_m(t − (y − y_0)/c_m),   Σ_m p_m ġ_m(t) = (v_s(t), v_p(t)),

the sum of both plane waves along y (Christoffel's equation, outside/medium.py), whose velocity on the line y_0 is that
of the waves of the case. In the undisturbed packing a disk i at height y_i then moves by x_i = u + χ_i ∂_y u, with the
correctors χ of homogenise.py. Let A_i x_i be the share of a disk in the elongations of a tie, B w that of the grid's
motion w, K the stiffness of the tie, and f_i the force of the bond on the disk per unit gradient of the packing. What
acts on a tied disk is the force of the bond in the undisturbed packing, and that of the tie, which is strained by what
differs from there; on the grid acts the transpose of the latter alone:

    on the disk  f_i ∂_y u(y_c) + A_iᵀK(1 + η d/dt)(B w − A_i(ξ_i − x_i)),
    on the grid  −BᵀK(1 + η d/dt)(B w − A_i(ξ_i − x_i)),

with ξ_i the disk's own motion and y_c the edge of the grid. So in a packing that moves as undisturbed the grid remains
at rest. The terms of w and ξ are those of the kernel (kernels/wall.py). The others are the drives here: the bond's
force, and what the kernel computes for the motions −x_i of the disks and a grid at rest.

The bonds of one cut are at several heights, but the sum of their forces accelerates the mass above, which is that of a
uniform body above y_c (`Brick.mass_offset`), so that it is the stress at y_c. Then errors are of second order in D/λ.
With the stress at the bonds, or the grid's motion at the contact in place of f_i, they would be of first order.

Heights of tied disks differ by a few diameters. There u is the polynomial in y through its values at `HEIGHTS`
Gauss–Lobatto points, so that all drives follow from g at so many delays.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from dembound.boundaries.support import Incident, SupportBuilder
from dembound.disks.cut_bonds import GRADIENT
from dembound.disks.tie_forces import TieForces, forces_at_rest
from dembound.disks.wall import Wall
from dembound.kernels.sums import weighted_sums
from dembound.outside.gll import Rule
from dembound.outside.medium import Medium

HEIGHTS = 5
"""Delays at which waves are computed. Over four diameters and 20 diameters to a wavelength the error is 1e-5."""

NO_PART = 1e-12
"""Part of a wave below which it is rounding: S waves have none of P waves in an isotropic medium."""

UPWARDS = (0.0, 1.0)


@dataclass(frozen=True, eq=False)
class PlaneWaves:
    """Plane waves that run upwards through a medium, near some heights.

    Attributes
    ----------
    medium : density and moduli. datum : y_0, m, where they have the given velocities.
    waves : whose velocities are those along x and y; None for none.
    span : lowest and highest place, m.
    """

    medium: Medium
    datum: float
    waves: tuple[Incident | None, Incident | None]
    span: tuple[float, float]

    @cached_property
    def _plane(self) -> tuple[np.ndarray, np.ndarray]:
        """Speeds (2,) and polarisations (2, 2) in columns."""
        return self.medium.plane_waves(UPWARDS)

    @cached_property
    def _rule(self) -> Rule:
        """The points of the heights."""
        return Rule(HEIGHTS - 1)

    def _places(self, y: np.ndarray) -> np.ndarray:
        """Heights y as −1 … 1 within the span."""
        low, high = self.span
        return (2.0 * y - low - high) / (high - low)

    @property
    def count(self) -> int:
        """Number of amplitudes: of both plane waves at each of the heights."""
        return 2 * HEIGHTS

    def amplitudes(self, times: np.ndarray, of: str) -> np.ndarray:
        """g_m (k, 2·HEIGHTS) at times (k,) s and the heights; of : "displacement" (m) or "velocity" (m/s)."""
        speeds, polarisations = self._plane
        low, high = self.span
        heights = 0.5 * (low + high + (high - low) * self._rule.points)
        values = np.zeros((len(times), 2, HEIGHTS))
        for wave, parts in zip(self.waves, polarisations, strict=True):
            for mode, part in enumerate(parts):
                if wave is not None and abs(part) > NO_PART:
                    delay = (heights - self.datum) / speeds[mode]
                    values[:, mode] += part * getattr(wave, of)(times[:, None] - delay)
        return values.reshape(len(times), -1)

    def strained(self, y: float | np.ndarray, values: np.ndarray) -> np.ndarray:
        """What values (3, 4, d) per unit gradient become at heights y m, one or (d,): (3, d, 2·HEIGHTS)."""
        at = self._places(np.atleast_1d(y))
        slope = self._rule.slope(at) * (2.0 / (self.span[1] - self.span[0]))
        each = np.einsum("cgd,gm->cdm", values[:, [GRADIENT[0][1], GRADIENT[1][1]]], self._plane[1])
        return (each[:, :, :, None] * slope[:, None, :]).reshape(3, values.shape[2], -1)

    def motion(self, y: np.ndarray, corrector: np.ndarray) -> np.ndarray:
        """Motion (3, d, 2·HEIGHTS) of disks at heights y (d,) m with correctors (3, 4, d), per unit of amplitudes."""
        moved = self.strained(y, corrector)
        value = self._rule.shape(self._places(y))
        moved[:2] += (self._plane[1][:, None, :, None] * value[:, None, :]).reshape(2, len(y), -1)
        return moved

    def power(self, times: np.ndarray) -> np.ndarray:
        """Power (k,) W that they bring through a metre of the line y_0: Σ ρ c_m ġ_m²."""
        speeds, polarisations = self._plane
        given = np.stack([np.zeros_like(times) if wave is None else wave.velocity(times) for wave in self.waves])
        return self.medium.density * np.sum(speeds[:, None] * (polarisations.T @ given) ** 2, axis=0)


@dataclass(frozen=True, eq=False)
class Drives:
    """Forces on some degrees of freedom, each a sum of amplitudes of plane waves.

    Attributes
    ----------
    waves : the plane waves. factors : (2·count, r) N or N·m per unit of the displacements, and of the velocities that
    ties see, of all their amplitudes.
    """

    waves: PlaneWaves
    factors: np.ndarray

    @property
    def count(self) -> int:
        """Number of the degrees of freedom."""
        return self.factors.shape[1]

    def __call__(self, times: np.ndarray, half_step: float) -> np.ndarray:
        """Forces (k, r) at times (k,) s; velocities are half a step (s) behind."""
        waves, forces = self.waves, np.empty((len(times), self.count))
        moved, moving = waves.amplitudes(times, "displacement"), waves.amplitudes(times - half_step, "velocity")
        weighted_sums(np.hstack([moved, moving]), self.factors, forces)
        return forces


@dataclass(frozen=True, eq=False, kw_only=True)
class IncidentForces(TieForces):
    """Forces by which plane waves enter from below.

    Attributes
    ----------
    waves : the plane waves.
    """

    waves: PlaneWaves

    @classmethod
    def of(
        cls, wall: Wall, medium: Medium, datum: float, waves: tuple[Incident | None, Incident | None]
    ) -> "IncidentForces":
        """Those of waves along x and y (None for none) that pass the line y = datum (m) at their own time."""
        bonds, edge = wall.bonds, wall.mesh.sides[2]
        disk, first, place = np.unique(bonds.particle, return_index=True, return_inverse=True)
        heights = bonds.height[first]
        plane = PlaneWaves(medium, datum, waves, (min(edge, *heights), max(edge, *heights)))
        summed = np.zeros((3, 4, len(disk)))
        for sums, forces in zip(summed.reshape(12, -1), bonds.on_disks.reshape(12, -1), strict=True):
            np.add.at(sums, place, forces)
        of_ties, reactions = forces_at_rest(wall, disk, -plane.motion(heights, bonds.own[:, :, first]))
        return cls(
            waves=plane,
            disk=disk,
            bonds=plane.strained(edge, summed),
            ties=of_ties,
            node=wall.nodes,
            reactions=reactions,
            lag=wall.lag,
        )

    def add_to_disks(self, builder: SupportBuilder, disks: np.ndarray) -> None:
        """Add rows to the disks (d,) of a scene that are, or have the place of, those that are tied."""
        self._add(builder, disks, *self.on_disks)

    def at(self, place: np.ndarray) -> "IncidentForces":
        """The same with some of the disks, by their places (k,) among them, maybe more than once; without nodes."""
        nothing = self.reactions[:, :0]
        return replace(
            self,
            disk=self.disk[place],
            bonds=self.bonds[:, place],
            ties=self.ties[:, place],
            node=self.node[:0],
            reactions=nothing,
        )

    def add_to_nodes(self, builder: SupportBuilder, nodes: np.ndarray) -> None:
        """Add rows to the nodes (m,) of a scene."""
        self._add(builder, nodes, *self.on_nodes)

    def _add(self, builder: SupportBuilder, nodes: np.ndarray, where: np.ndarray, factors: np.ndarray) -> None:
        """Add forces on nodes (k,), see `on_disks`."""
        if factors.any():
            builder.add_forces(nodes[where[1]], where[0], Drives(self.waves, factors))
