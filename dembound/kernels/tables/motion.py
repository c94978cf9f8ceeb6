"""Arrays by which nodes are moved, of the sides whose forces are recorded, and of ties between two parts."""

from typing import NamedTuple

import numpy as np


class Sides(NamedTuple):
    """Forces on s sides of a body in b batches of e elements, and their m members; see kernels/sides.py.

    A batch has elements of one kind on one component, of one side. kind, side, component, signal : (b,), signal the
    column of signals (steps, q) of its incident wave or power, −1 for none. leaves : (b,) bool, whether energy that
    does not come in by its forces counts as absorbed.
    start : (b + 1,) elements of each batch in line (e,), the line of each in the support table; constant (e,), by kind:
    N of forces needed over those of the nodes stepped; N·s/m of dashpots, twice; N/m of springs, from rest 0; N per
    unit of signal; N of ties over those on the nodes stepped; follow (e,) N·s/m; column (e,) of the signals of drives.
    member_start : (s + 1,) members of each side in member (m,), nodes; weight (m,) of their displacements in the mean.
    offset : (s, 2) N, added to the force on each side. bearer_start : (s + 1,) nodes of each side in bearer (q,) whose
    steady forces are added too, times share (2, q); none if these do not change.
    borne : (k, 3) N on the lines of the support table by springs on relative motion, see `Bearings`.
    record : (rows, s, 5) mean displacement, m and rad, and force, N, at the start of each `every`-th step, of which
    `first` came before; every is 0 where nothing is recorded. work : (2, s, 2) J that came in and were absorbed,
    without springs; row 0 up to the half step reached, row 1 up to the last whole step, after the last step of a call.
    """

    kind: np.ndarray
    side: np.ndarray
    component: np.ndarray
    signal: np.ndarray
    leaves: np.ndarray
    signals: np.ndarray
    start: np.ndarray
    line: np.ndarray
    constant: np.ndarray
    follow: np.ndarray
    column: np.ndarray
    member_start: np.ndarray
    member: np.ndarray
    weight: np.ndarray
    offset: np.ndarray
    bearer_start: np.ndarray
    bearer: np.ndarray
    share: np.ndarray
    borne: np.ndarray
    every: int
    first: int
    record: np.ndarray
    work: np.ndarray

    @classmethod
    def none(cls) -> "Sides":
        """A table without sides."""
        number, value = np.zeros(0, dtype=np.int64), np.zeros(0)
        return cls(
            kind=number,
            side=number,
            component=number,
            signal=number,
            leaves=np.zeros(0, dtype=np.bool_),
            signals=np.zeros((0, 0)),
            start=np.zeros(1, dtype=np.int64),
            line=number,
            constant=value,
            follow=value,
            column=number,
            member_start=np.zeros(1, dtype=np.int64),
            member=number,
            weight=value,
            offset=np.zeros((0, 2)),
            bearer_start=np.zeros(1, dtype=np.int64),
            bearer=number,
            share=np.zeros((2, 0)),
            borne=np.zeros((0, 3)),
            every=0,
            first=0,
            record=np.zeros((0, 0, 5)),
            work=np.zeros((2, 0, 2)),
        )


NO_SIDES = Sides.none()
"""Table for runs in which sides are not recorded."""


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


class Seam(NamedTuple):
    """The forces of a free-field column under the elastic law on k supported nodes across its seam.

    twin : (k,) the column's particle at the same place of the brick, −1 for none; start : (k + 1,) rows of its contacts
    across the seam: neighbour (e,) there, and contact_type (e,), rows of constants (p, 6).
    """

    twin: np.ndarray
    start: np.ndarray
    neighbour: np.ndarray
    contact_type: np.ndarray
    constants: np.ndarray


class SeamEnds(NamedTuple):
    """Ends of a seam for a column under the history-dependent law: start (k + 1,) rows of its contact ends, end (e,).

    force : (4, b) of its contacts, see Contacts.
    """

    start: np.ndarray
    end: np.ndarray
    force: np.ndarray


class WallTies(NamedTuple):
    """Half bonds between particles and the wall of a grid, by its e elements of N × N nodes; see kernels/wall.py.

    Ties are in B blocks of eight (kernels/compiler/lanes.py), T = 8B of them with those of no stiffness that fill the
    last block of each element. points : tuple of N numbers, so that N is part of the type. start : (e + 1,) blocks of
    each element. node : (e, N²) its nodes, row by row, and line, theirs in the support table. reach : (e, 4) first and
    end column, first and end row of the nodes that the ties act on. particle, particle_line : (T,) of the particle;
    twin (T,) in the free-field column, −1 for none; rest (3T,) m, m and rad, its motion less the twin's at which the
    tie has no force. along, up : (B·N·8,) values of the element's shape functions along
    x and y at the tie's point; along_slope, up_slope their derivatives, 1/m. corrector : (B·12·8,) m and rad, motion x,
    y, rotation of the bond's middle beyond that of the point, each per unit gradient xx, yy, xy, yx. normal : (2T,)
    components x, then y, from the particle to the point; arm (T,) m. stiffness : (3T,) N/m, N/m and N·m of the half
    bonds. lag : η, s. moved (2N²,), reaction (2N²·8,), field (48,), own (24,) : work space.
    """

    points: tuple[float, ...]
    start: np.ndarray
    node: np.ndarray
    line: np.ndarray
    reach: np.ndarray
    particle: np.ndarray
    particle_line: np.ndarray
    twin: np.ndarray
    rest: np.ndarray
    along: np.ndarray
    along_slope: np.ndarray
    up: np.ndarray
    up_slope: np.ndarray
    corrector: np.ndarray
    normal: np.ndarray
    arm: np.ndarray
    stiffness: np.ndarray
    lag: float
    moved: np.ndarray
    reaction: np.ndarray
    field: np.ndarray
    own: np.ndarray


class Repeats(NamedTuple):
    """Forces on lines of the support table that are repeated on others: source and target, (r,) each."""

    source: np.ndarray
    target: np.ndarray


class Bearings(NamedTuple):
    """Springs of k nodes on their motion relative to the ground beyond; see kernels/follower.py.

    node, twin, line : (k,) each node, its twin, −1 for none, and its line in the support table. weight : (k,) in the
    mean motion of all. stiffness : (k, 2) N/m along x and y; rest : (k, 2) m, displacement relative to the ground
    without force. force : (s, 3) N of each line of the support table, work space.
    """

    node: np.ndarray
    twin: np.ndarray
    line: np.ndarray
    weight: np.ndarray
    stiffness: np.ndarray
    rest: np.ndarray
    force: np.ndarray
