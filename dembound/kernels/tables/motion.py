"""Arrays by which nodes are moved, and the record of every step. n nodes, of which k are supported."""

from typing import NamedTuple

import numpy as np

from dembound.kernels.tables.sides import NO_SIDES, Sides


class Body(NamedTuple):
    """Data to compute motion from forces.

    mobility, inverse_inertia : (n,) Δt/m and Δt/I; free : (3,) 1, or 0 for a component held everywhere; load : (3, n)
    steady forces N and moments N·m, or (3, 0) for none; damp : local damping; step : Δt in s.
    """

    mobility: np.ndarray
    inverse_inertia: np.ndarray
    free: np.ndarray
    load: np.ndarray
    damp: float
    step: float


class Followers(NamedTuple):
    """Forces that rotate with their sides, for s sides with m members in all and q particles; see kernels/follower.py.

    opposite : (s,) the opposite side of each, itself if there is none. start : (s + 1,) members of side k are
    start[k]:start[k + 1] of the next three; member, twin : (m,) particles, and those relative to which their motion is
    measured, −1 for none, GONE for a member that has broken off; arm : (2, m) m, from the side's mean position at the
    datum. node : (q,) particles; side : (2, q) the one or two sides each belongs to, −1 for none; force : (2, 2, q) N
    by side and component; steady : (2, q) N, all steady load before any rotation; extra : (2, q) N, its present change
    by rotation. rest : (2, m) m, displacement of a member in the reference state, less that of its twin.
    """

    opposite: np.ndarray
    start: np.ndarray
    member: np.ndarray
    twin: np.ndarray
    arm: np.ndarray
    node: np.ndarray
    side: np.ndarray
    force: np.ndarray
    steady: np.ndarray
    extra: np.ndarray
    rest: np.ndarray

    def in_slots(self, slot: np.ndarray) -> "Followers":
        """The table by the slots (n,) of particles."""
        twin = np.where(self.twin < 0, self.twin, slot[self.twin])
        return self._replace(member=slot[self.member], twin=twin, node=slot[self.node])


class Supports(NamedTuple):
    """The support table on k nodes, all components: v⁺ = keep·v + mobility·(F − K u + drive) + prescribed·drive.

    nodes (k,), ascending; inertia (k, 3) m/Δt; keep, mobility, stiffness, prescribed (k, 3); drive (steps, k, 3) in N,
    or m/s where prescribed. twin (k,) : a node before it in the order, whose velocity dashpots follow (k, 3) N·s/m
    follow, −1 for none. A centred dashpot C has keep = (m/Δt − C/2)/(m/Δt + C/2) and
    mobility 1/(m/Δt + C/2); a prescribed component has keep = mobility = 0 and prescribed = 1.
    """

    nodes: np.ndarray
    inertia: np.ndarray
    keep: np.ndarray
    mobility: np.ndarray
    stiffness: np.ndarray
    prescribed: np.ndarray
    drive: np.ndarray
    twin: np.ndarray
    follow: np.ndarray


class Log(NamedTuple):
    """The record of every step.

    probes : (p,) particles; record : (steps, p, 6) their displacement and velocity at the start of each step, the
    velocity as the mean of its two half-step values, and of a bar (steps, p, 7), stress last, Pa. tracked : (q,)
    particles; peaks : (q, 3, 2) smallest and largest velocity so far. top_speed : (n,) largest speed so far, m/s, or
    (0,) if not asked for. work : (2, 7) J done on the body by supports, taken by damping, friction and cracks, added by
    a change of method, done by the change of follower forces as they rotate, taken by contacts that open and close,
    column by column; row 0 up to the half step reached, row 1 up to the last whole step. supplied : (1,) J, the largest
    work of supports so far, at any step.
    sides : what is recorded of the sides.
    """

    probes: np.ndarray
    record: np.ndarray
    tracked: np.ndarray
    peaks: np.ndarray
    top_speed: np.ndarray
    work: np.ndarray
    supplied: np.ndarray
    sides: Sides = NO_SIDES
