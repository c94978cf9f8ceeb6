"""Arrays of joints: faces of disks on both sides of lines, and the pairs of faces that lie opposite each other."""

from collections import namedtuple
from typing import Any, NamedTuple

import numpy as np


class JointLaw(NamedTuple):
    """Constants of a joint: friction, tension and cohesion Pa, dashpot Pa·s/m of sliding faces, step s.

    dilation : tangent of its angle, up to a slip dilation_end, m. follows : share of a change of pressure that friction
    follows in a step. fails : whether its faces part and slide. margin : m, by which faces on the list of pairs may lie
    apart. reach : m, gap of a pair above which it is not listed.
    """

    friction: float
    tension: float
    cohesion: float
    dilation: float
    dilation_end: float
    dashpot: float
    step: float
    follows: float
    fails: bool
    margin: float
    reach: float


class FacePairs(NamedTuple):
    """Pairs of faces that overlap or may soon, p places of which the first are in use; sorted by first, then second.

    first, second : (p,) faces; kn, ks : (p,) Pa/m, their springs. intact : (p,) uint8, whether the joint has its
    strength there; slides : (p,) uint8, in the last step. slip : (p,) m, shear displacement without stress. length :
    (p,) m, overlap in the last step; pressure, shear, drag : (p,) Pa, its normal stress, positive if it pushes, its
    shear stress on the first face along its line, and the normal stress of the dashpot; bearing : (p,) Pa, the pressure
    that friction counts. arm, arm_2 : (p,) m, from the foot of both disks' centres to the middle of the overlap along
    the line; begin : (p,) m, from the first end of the first face to the overlap. energy : (p,) J. opening : (p,) m, by
    which its faces have moved apart since the start.
    """

    first: np.ndarray
    second: np.ndarray
    kn: np.ndarray
    ks: np.ndarray
    intact: np.ndarray
    slides: np.ndarray
    slip: np.ndarray
    length: np.ndarray
    pressure: np.ndarray
    shear: np.ndarray
    drag: np.ndarray
    arm: np.ndarray
    arm_2: np.ndarray
    begin: np.ndarray
    energy: np.ndarray
    bearing: np.ndarray
    opening: np.ndarray


_ROWS: list[Any] = [np.uint64(row) for row in (0, 1, 2, 3, 4, 12, 14, 15)]

F: Any = namedtuple("F", ["along_x", "along_y", "apart", "apart_up", "end", "height", "closure", "rest"])(*_ROWS)
"""Rows of `JointFaces.frame`: pairs at the start, in a frame along the line and its normal.

along_x, along_y : the line of the pair, between those of its faces. apart, apart_up : m, from the centre of the first
disk to that of the second. end : m, of four ends, both of the first face, then of the second, from the centre of its
disk; two rows each. height : m, of both centres from their faces, two rows. closure, rest : m, by which the pair is
pressed in and sheared at the start.
"""


class JointFaces(NamedTuple):
    """Joints of the same constants: m faces, of which `split` are on the left of their lines; see kernels/joints.py.

    law : their constants. part : (m,) int64, number of the line of each face. disk : (m,) int64 slots of their disks;
    line : (m,) theirs in the support table. centre : (m, 2), ends (m, 4) m, of the disk and x, y of both ends of the
    face at the start; along (m, 2) unit vector; height (m,) m, of the centre from the face; stiffness (2, m) Pa/m,
    along n and t, of two such faces; closure, rest (m,) m, by which the face is pressed in and sheared at the start.
    pairs, spare : the pairs, and space to list them anew, for a multiple of eight; frame (16, p) : see `F`. motion,
    pushes (8, 8), (4, 8) : work space of eight pairs. counts (5,) int64 : pairs listed, steps done, events noted, the
    most pairs needed so far, and whether frames are those of the pairs listed. listed : (m, 2) m, displacement of the
    disks at which they were listed. gives : (m, 3) 1/kg and 1/(kg·m²), of the disk of each face, 0 for what is held or
    prescribed. force, kick : (m, 3) N and N·m, N·s and N·m·s on it by springs and dashpots in the last step; lost (3,)
    J: friction, crack and closing. events : (k, 6) step, first and second face, x, y m, whether by shear, of places
    that lost their strength. record : (r, l, 7) of each line in the last r steps the overlap, m, and times it slip and
    opening, m, pressure and shear stress, Pa, on the left side along the line, and shares that are closed and that
    slide. first : (l, 2) int64, step in which each first slid and opened, −1 if it has not.
    """

    law: JointLaw
    split: int
    part: np.ndarray
    disk: np.ndarray
    line: np.ndarray
    centre: np.ndarray
    ends: np.ndarray
    along: np.ndarray
    height: np.ndarray
    stiffness: np.ndarray
    closure: np.ndarray
    rest: np.ndarray
    pairs: FacePairs
    spare: FacePairs
    frame: np.ndarray
    motion: np.ndarray
    pushes: np.ndarray
    counts: np.ndarray
    listed: np.ndarray
    gives: np.ndarray
    force: np.ndarray
    kick: np.ndarray
    lost: np.ndarray
    events: np.ndarray
    record: np.ndarray
    first: np.ndarray
