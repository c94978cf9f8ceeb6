"""Bundles of arrays, the arguments of kernels. n particles, b contacts, e = 2b contact ends, k nodes."""

from typing import NamedTuple

import numpy as np


class NeighbourTable(NamedTuple):
    """Contacts of the elastic law, one row per particle, of the particles from number `begin` on.

    Row i, that of particle i, is start[i]:start[i + 1] of neighbour (e,) and contact_type (e,), its row of
    constants (p, 6); see elastic.py. start ends with the last particle's row; those before `begin` are empty.
    """

    begin: int

    start: np.ndarray
    neighbour: np.ndarray
    contact_type: np.ndarray
    constants: np.ndarray


class LaneRows(NamedTuple):
    """Contacts of the elastic law between r rows of copies in g groups, see elastic_lanes.py.

    group_row, group_block : (g + 1,) rows and blocks of eight slots of each group; column by column, every row of a
    group has a block there. inverse_mass 1/kg, inverse_inertia 1/(kg·m²) : (r,) of a row's disks. start : (r + 1, 2)
    where the entries of each row begin, and those of them that not all copies have. shift : (e,) slots from a disk to
    its neighbour; mask : (e,) where the bits of the copies that have the contact begin in masks (m,) uint8, one byte a
    column; constants (e, 8), turn (e, 3), own (r, 3) see there. special : (blocks,) bool, blocks with supported disks,
    strays, or masses of their own. Contacts that are in no entry are strays, of k disks in stray (k,), ascending slots;
    those of each begin in stray_neighbour (s,) and stray_type (s,), a row of stray_constants (p, 6), at stray_start
    (k + 1,). extra : (3, slots) work space.
    """

    group_row: np.ndarray
    group_block: np.ndarray
    inverse_mass: np.ndarray
    inverse_inertia: np.ndarray
    start: np.ndarray
    shift: np.ndarray
    mask: np.ndarray
    masks: np.ndarray
    constants: np.ndarray
    turn: np.ndarray
    own: np.ndarray
    special: np.ndarray
    stray: np.ndarray
    stray_start: np.ndarray
    stray_neighbour: np.ndarray
    stray_type: np.ndarray
    stray_constants: np.ndarray
    extra: np.ndarray


class Contacts(NamedTuple):
    """Contacts with a history, each listed once; see contacts.py for the columns of constants and force.

    first, second, contact_type : (b,) uint32 particles, and the row of the pair in constants (p, 12).
    state : (b,) uint8, see contacts.py; shear, slip : (b,) m, the tangential displacement since the start, not kept up
    to date for pairs in the geometry of the start, and the part of it that slid; cracked : (b,) int64, step in which
    the bond broke, else −1; place : (b, 2) m, mean displacement of the two disks in that step; force : (4, b).
    start, end : rows of contact ends, one per particle, those before number `begin` empty, end (e,) uint32 = 2·contact
    + (0 first, 1 second).
    """

    begin: int

    first: np.ndarray
    second: np.ndarray
    contact_type: np.ndarray
    constants: np.ndarray
    state: np.ndarray
    shear: np.ndarray
    slip: np.ndarray
    cracked: np.ndarray
    place: np.ndarray
    force: np.ndarray
    start: np.ndarray
    end: np.ndarray


class Limits(NamedTuple):
    """Friction of contacts and strength of bonds.

    friction, tan_fa : pure numbers; tension, cohesion : Pa; geometry : one of those in contacts.py.
    """

    friction: float
    tension: float
    cohesion: float
    tan_fa: float
    geometry: int


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
    """Forces that rotate with their sides, for s sides with m members in all and q particles; see follower.py.

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
        """The same by the slots (n,) of particles."""
        twin = np.where(self.twin < 0, self.twin, slot[self.twin])
        return self._replace(member=slot[self.member], twin=twin, node=slot[self.node])


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
    """The same for a column under the history-dependent law: start (k + 1,) rows of its contact ends, end (e,).

    force : (4, b) of its contacts, see Contacts.
    """

    start: np.ndarray
    end: np.ndarray
    force: np.ndarray


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


class WallTies(NamedTuple):
    """Half bonds between particles and the wall of a grid, by its e elements of N × N nodes; see wall.py.

    Ties are in B blocks of eight (lanes.py), T = 8B of them with those of no stiffness that fill the last block of
    each element. points : tuple of N numbers, so that N is part of the type. start : (e + 1,) blocks of each
    element. node : (e, N²) its nodes, row by row, and line, theirs in the support table; reach : (e, 4) first and end
    column, first and end row of those that ties act on. particle, particle_line : (T,) of the particle; twin (T,) in the free-field column, −1 for none. along, up : (B·N·8,) values of the
    element's shape functions along x and y at the tie's point; along_slope, up_slope their derivatives, 1/m.
    corrector : (B·12·8,) m and rad, motion x, y, rotation of the bond's middle beyond that of the point, each per
    unit gradient xx, yy, xy, yx. normal : (2T,) components x, then y, from the particle to the point; arm (T,) m.
    stiffness : (3T,) N/m, N/m and N·m of the half bonds. lag : η, s. moved (2N²,), reaction (2N²·8,), field (48,),
    own (24,) : work space.
    """

    points: tuple[float, ...]
    start: np.ndarray
    node: np.ndarray
    line: np.ndarray
    reach: np.ndarray
    particle: np.ndarray
    particle_line: np.ndarray
    twin: np.ndarray
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


class Sides(NamedTuple):
    """Forces on s sides of a body in b batches of e elements, and their m members; see sides.py.

    A batch has elements of one kind on one component, of one side. kind, side, component, sign, signal : (b,), sign −1
    where the forces are those on an image; signal the column of signals (steps, q) of its incident wave or power, −1
    for none. leaves : (b,) bool, whether energy that does not come in by its forces counts as absorbed.
    start : (b + 1,) elements of each batch in line (e,), the line of each in the support table; constant (e,), by kind:
    N of forces needed over those of the nodes stepped; N·s/m of dashpots, twice; N/m of springs, from rest 0; N per
    unit of signal; N of ties over those on the nodes stepped; follow (e,) N·s/m; column (e,) of the signals of drives.
    member_start : (s + 1,) members of each side in member (m,), nodes; weight (3, m) of their displacements in the
    mean, sign of images included. offset : (s, 2) N, added to the force on each side. bearer_start : (s + 1,) nodes of
    each side in bearer (q,) whose steady forces are added too, times share (2, q); none if these do not change.
    record : (rows, s, 5) mean displacement, m and rad, and force, N, at the start of each `every`-th step, of which
    `first` came before; every is 0 where nothing is recorded. work : (2, s, 2) J that came in and were absorbed,
    without springs; row 0 up to the half step reached, row 1 up to the last whole step, after the last step of a call.
    """

    kind: np.ndarray
    side: np.ndarray
    component: np.ndarray
    sign: np.ndarray
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
    every: int
    first: int
    record: np.ndarray
    work: np.ndarray

    @classmethod
    def none(cls) -> "Sides":
        """Of no side."""
        number, value = np.zeros(0, dtype=np.int64), np.zeros(0)
        return cls(
            kind=number,
            side=number,
            component=number,
            sign=value,
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
            weight=np.zeros((3, 0)),
            offset=np.zeros((0, 2)),
            bearer_start=np.zeros(1, dtype=np.int64),
            bearer=number,
            share=np.zeros((2, 0)),
            every=0,
            first=0,
            record=np.zeros((0, 0, 5)),
            work=np.zeros((2, 0, 2)),
        )


NO_SIDES = Sides.none()
"""Where sides are not recorded."""


class Log(NamedTuple):
    """The record of every step.

    probes : (p,) particles; record : (steps, p, 6) their displacement and velocity at the start of each step, the
    velocity as the mean of its two half-step values, and of a bar (steps, p, 7), stress last, Pa. tracked : (q,)
    particles; peaks : (q, 3, 2) smallest and largest velocity so far. top_speed : (n,) largest speed so far, m/s, or
    (0,) if not asked for. work : (2, 6) J done on the body by supports, taken by damping, friction and cracks, added by
    a change of method, done by the change of follower forces as they rotate, column by column; row 0 up to the half
    step reached, row 1 up to the last whole step. supplied : (1,) J, the largest work of supports so far, at any step.
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


class Links(NamedTuple):
    """The elastic law on the particles of the rows; fastest (chunks,), damped (chunks, 2) : work space."""

    rows: NeighbourTable | LaneRows
    fastest: np.ndarray
    damped: np.ndarray


class Cells(NamedTuple):
    """Cells of the n disks at the displacements at which pairs were listed, see approach.py.

    Cell c contains the disks member[start[c]:start[c + 1]], of those from `begin` on; divisions : (2,) columns and rows
    of cells, which are numbered row by row; wraps : (2,) whether the first touches the last along x and y. reach : m,
    no two disks of cells that do not touch can meet before one has moved so far.
    """

    start: np.ndarray
    member: np.ndarray
    divisions: np.ndarray
    wraps: np.ndarray
    reach: float


class WatchedLinks(NamedTuple):
    """The elastic law with a check for contacts that would leave it.

    contacts, limits : the pairs and their limits; origin : (2, n) displacements at which the list of pairs was made, of
    the n particles of the rows; skin : m, largest gap of listed pairs; cells : of the particles then; arms : (begin +
    n,) m, longest arm of a particle's contacts; way : (2,) m, distance surfaces have moved since the contacts were
    checked, and the distance they may move; keeps_slip : whether contacts have slid earlier.
    """

    links: Links
    contacts: Contacts
    limits: Limits
    origin: np.ndarray
    skin: float
    cells: Cells
    arms: np.ndarray
    way: np.ndarray
    keeps_slip: bool = False


class Bonded(NamedTuple):
    """The history-dependent law on the n particles of the contacts.

    limits : friction and strengths; origin : (2, n) displacements at which all pairs with gaps up to skin (m) were
    listed; cells : of the particles then; stops : return after a step in which a bond broke; way : (2,) m, distance
    particles have moved since this was checked, and the distance they may move; fastest (chunks,), damped, lost
    (chunks, 2) : work space.
    """

    contacts: Contacts
    limits: Limits
    origin: np.ndarray
    skin: float
    cells: Cells
    stops: bool
    way: np.ndarray
    fastest: np.ndarray
    damped: np.ndarray
    lost: np.ndarray


class PairRows(NamedTuple):
    """Pairs in rows of copies, q rows in g groups, which come before all others among the contacts.

    group_row, group_block : (g + 1,) rows and blocks of pairs of each group; column by column, every row of a group has
    a block there, as disks have (LaneRows). disk_block, disk_rows : (g,) first block and number of rows of the group's
    disks. step : (q, 2) row of the first disk within its group, and slots from the first disk to the second; constants
    : (q, 14) those of Contacts, and the direction from the first disk to the second at the start; exists : (blocks,)
    uint8, the bits of the lanes that hold a pair.
    start : (3r + 1,) entries of each row of disks, by pairs of which the disk is the first, of which it is the second,
    and of which it is the second in a part of the copies: offset (e,) places from the first one of the column. mask :
    (e,) where the bits of these copies begin in masks (m,) uint8, one byte a column, else −1.
    """

    group_row: np.ndarray
    group_block: np.ndarray
    disk_block: np.ndarray
    disk_rows: np.ndarray
    step: np.ndarray
    constants: np.ndarray
    exists: np.ndarray
    start: np.ndarray
    offset: np.ndarray
    mask: np.ndarray
    masks: np.ndarray


class LaneBonded(NamedTuple):
    """The history-dependent law in rows of copies; the other pairs come after those in rows.

    bonded : the law, for all pairs; rows : the disks, whose contacts are not used; pairs : the rows of pairs. stray :
    (k,) ascending slots of disks with ends of other pairs; stray_start (k + 1,), stray_end (e,) those ends, as in
    Contacts. extra : (3, slots), also_lost (chunks, 2) : work space.
    """

    bonded: Bonded
    rows: LaneRows
    pairs: PairRows
    stray: np.ndarray
    stray_start: np.ndarray
    stray_end: np.ndarray
    extra: np.ndarray
    also_lost: np.ndarray


class BarBonds(NamedTuple):
    """Springs and bonds of a bar of n nodes; horizon m, 0 if there is no peridynamic bond.

    spring : (n − 1,) N/m of the local springs between neighbours, 0 where there is none; spring_limit : (n − 1,) m, the
    elongation at which each breaks, or where it triggers (n − 1,) the method; bond : (m, n) N/m, row p − 1
    those between nodes i and i + p; bond_limit : (m,) m, the elongation at which they break. spring_broken (n − 1,),
    bond_broken (m, n) : step in which each broke, −1 for not. plain : (r, 2) ranges of nodes between equal springs that
    all trigger at plain_limit m; plain_push 1/s : Δt k/m of them, less what attenuation takes; mixed : (q, 4) the
    ranges of all others, with the number of bond lengths there, 0 or m, and whether they have springs. section : m².
    mobility : (n,) Δt/m, less what attenuation takes, 0 for supported nodes; keep : part of the velocity of a node that
    remains after attenuation in a step; drag : (n,) N·s/m of its dashpots, or (0,) for none. space (n + m + 1,), mean
    (n,), before (k,), reached (1,) : work space.
    """

    spring: np.ndarray
    spring_limit: np.ndarray
    triggers: np.ndarray
    bond: np.ndarray
    bond_limit: np.ndarray
    spring_broken: np.ndarray
    bond_broken: np.ndarray
    plain: np.ndarray
    plain_push: float
    plain_limit: float
    mixed: np.ndarray
    section: float
    mobility: np.ndarray
    keep: float
    drag: np.ndarray
    space: np.ndarray
    mean: np.ndarray
    before: np.ndarray
    reached: np.ndarray
