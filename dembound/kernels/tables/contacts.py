"""Arrays of contacts. n particles, b contacts, e = 2b contact ends."""

from typing import NamedTuple

import numpy as np


class NeighbourTable(NamedTuple):
    """Contacts of the elastic law, one row per particle, of the particles from number `begin` on.

    Row i, that of particle i, is start[i]:start[i + 1] of neighbour (e,) and contact_type (e,), its row of
    constants (p, 6); see kernels/elastic.py. start ends with the last particle's row; those before `begin` are empty.
    """

    begin: int

    start: np.ndarray
    neighbour: np.ndarray
    contact_type: np.ndarray
    constants: np.ndarray


class LaneRows(NamedTuple):
    """Contacts of the elastic law between r rows of copies in g groups, see kernels/elastic_lanes.py.

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
    """Contacts with a history, each listed once; see kernels/contacts.py for forces, pairwise.py for constants.

    first, second, contact_type : (b,) uint32 particles, and the row of the pair in constants (p, c).
    began : (p, 3) stretch and shear (m) and rotation that pairs have from the start; (0, 3) without a stress at rest.
    state : (b,) uint8, see kernels/contacts.py; shear, slip : (b,) m, the tangential displacement since the start, not
    kept up to date for pairs in the geometry of the start, and the part of it that slid; closed : (b,) uint8, whether
    the contact pushed in the last step, see kernels/contacts.py; cracked : (b,) int64, step in which the bond broke,
    else −1; place : (b, 2) m, mean displacement of the two disks in that step; kept : (b,) uint8, whether the bond may
    break, see kernels/contacts.py; force : (4, b). viscosity : (2, b) N·s/m of normal and shear dashpots of contacts,
    and drag : (2, b) N their last forces, pushing and along the shear; (2, 0) where there are none; damps_bonds :
    whether they also act beside intact bonds. lag : (3K, b) m, m
    and rad, by which each of the K relaxation arms of a bond lags behind its stretch, its shear and its rotation in
    turn, see kernels/arms.py; (0, 0) without arms. rolled : (b,) rad, rotation of closed contacts without bonds that
    has not slid, which they resist; (0,) where none resists rolling.
    bound : (chunks + 1,) pairs in rows come before the first of these, the others are sorted by their particles, and
    shared out so that it depends on these alone in which chunk a pair is; after the last one places are spare.
    start, end : rows of contact ends of the pairs in no row, one per particle, those before number `begin` empty, end
    (e,) uint32 = 2·contact + (0 first, 1 second).
    """

    begin: int
    damps_bonds: bool
    first: np.ndarray
    second: np.ndarray
    contact_type: np.ndarray
    constants: np.ndarray
    began: np.ndarray
    state: np.ndarray
    shear: np.ndarray
    slip: np.ndarray
    closed: np.ndarray
    cracked: np.ndarray
    place: np.ndarray
    kept: np.ndarray
    force: np.ndarray
    viscosity: np.ndarray
    drag: np.ndarray
    lag: np.ndarray
    rolled: np.ndarray
    start: np.ndarray
    end: np.ndarray
    bound: np.ndarray


class PairRows(NamedTuple):
    """Pairs in rows of copies, q rows in g groups, which come before all others among the contacts.

    group_row, group_block : (g + 1,) rows and blocks of pairs of each group; column by column, every row of a group has
    a block there, as disks have (LaneRows). disk_block, disk_rows : (g,) first block and number of rows of the group's
    disks. step : (q, 2) row of the first disk within its group, and slots from the first disk to the second; constants
    : (q, c) those of Contacts; way : (q, 2) direction from the first disk to the second at the start; exists :
    (blocks,) uint8, the bits of the lanes that hold a pair.
    start : (3r + 1,) entries of each row of disks, by pairs of which the disk is the first, of which it is the second,
    and of which it is the second in a part of the copies: offset (e,) places from the first one of the column. mask :
    (e,) where the bits of these copies begin in masks (m,) uint8, one byte a column, else −1. contact_type : (q,)
    uint32 that of the pairs, and began (q, 3) or 0.0, see `Contacts`.
    """

    group_row: np.ndarray
    group_block: np.ndarray
    disk_block: np.ndarray
    disk_rows: np.ndarray
    step: np.ndarray
    constants: np.ndarray
    way: np.ndarray
    began: float | np.ndarray
    exists: np.ndarray
    start: np.ndarray
    offset: np.ndarray
    mask: np.ndarray
    masks: np.ndarray
    contact_type: np.ndarray


class Cells(NamedTuple):
    """Cells of the n disks at the displacements at which pairs were listed, see kernels/near.py.

    Cell c contains the disks member[start[c]:start[c + 1]], of those from `begin` on; divisions : (2,) columns and rows
    of cells, which are numbered row by row; wraps : (2,) whether the first touches the last along x and y. reach : m,
    no two disks of cells that do not touch can meet before one has moved so far.
    """

    start: np.ndarray
    member: np.ndarray
    divisions: np.ndarray
    wraps: np.ndarray
    reach: float


class Walls(NamedTuple):
    """Rigid walls and the m disks listed near them, in ascending slots; see kernels/walls.py.

    slot, radius, mass, kratio : (m,) slot, m, kg, and normal over shear stiffness of a contact of each disk; place
    (2, m) m, its centre before displacements; spring (m,) N/m, normal stiffness where walls give none. bound :
    (chunks + 1,) first disk of each chunk, which slots alone decide. start : (m + 1,) rows of the segments near each
    disk in segment (e,). ends (s, 4) m, x and y of both ends of each segment; wall (s,) of the W walls.
    given (W, 2) N/m, normal and shear stiffness, 0 where absent; friction and rolling (W,); dashpot (W,), 2β. path :
    (rows, W, 2) m, displacement of each wall before each step, of which the last two rows are equal. follow : (W + 1,)
    wall w moves by the mean velocity of the disks in slots leader[follow[w]:follow[w + 1]] with their share. fastest :
    (chunks,) m/s of disks after a step.
    kept : (m, MOST, KEPT) contacts of the last step. force (3, m), load (3, m), lost (chunks, 3), total (chunks, W, 2)
    : work space. record : (R, W, 4) displacement (m) of each wall and force (N) on it in the last R steps. moved :
    (2,) J that walls have supplied as they move, as `Log.work`. way : (2,) m that disks and walls may have come since
    the list was made, and the limit; step (1,), that of the forces.
    """

    slot: np.ndarray
    radius: np.ndarray
    mass: np.ndarray
    kratio: np.ndarray
    place: np.ndarray
    spring: np.ndarray
    bound: np.ndarray
    start: np.ndarray
    segment: np.ndarray
    ends: np.ndarray
    wall: np.ndarray
    given: np.ndarray
    friction: np.ndarray
    rolling: np.ndarray
    dashpot: np.ndarray
    path: np.ndarray
    follow: np.ndarray
    leader: np.ndarray
    share: np.ndarray
    fastest: np.ndarray
    kept: np.ndarray
    force: np.ndarray
    load: np.ndarray
    lost: np.ndarray
    total: np.ndarray
    record: np.ndarray
    moved: np.ndarray
    way: np.ndarray
    step: np.ndarray


class Unloading(NamedTuple):
    """Steady loads (3, m) of the disks in these slots (m,), which are restored once walls have pushed them."""

    slot: np.ndarray
    load: np.ndarray
