"""What joints note for the record: places that lose their strength, means over each line, and when it first slides."""

from numba import njit

from dembound.kernels.common import FAST, U
from dembound.kernels.tables.joints import F

PAIRS, STEPS, EVENTS, NEEDED, LAID_OUT = range(5)
"""Places in `JointFaces.counts`."""

SLIGHT = 1e-5
"""Mean slip and opening from which on a joint slides and opens, over the diameter of the disks."""


@njit(**FAST)
def note_event(joint, k, torn, u):
    """Note that pair k has lost its strength in the middle of its overlap, at displacements u (3, n)."""
    number, f = joint.counts[EVENTS], joint.pairs.first[k]
    i, arm, height = U(joint.disk[f]), joint.pairs.arm[k], joint.height[f]
    tx, ty = joint.frame[F.along_x, k], joint.frame[F.along_y, k]
    x = joint.centre[f, 0] + u[U(0), i] + tx * arm + ty * height
    y = joint.centre[f, 1] + u[U(1), i] + ty * arm - tx * height
    if number < joint.events.shape[0]:
        joint.events[number, 0] = joint.counts[STEPS]
        joint.events[number, 1] = f
        joint.events[number, 2] = joint.pairs.second[k]
        joint.events[number, 3] = x
        joint.events[number, 4] = y
        joint.events[number, 5] = 0.0 if torn != 0 else 1.0
    joint.counts[EVENTS] = number + 1


@njit(**FAST)
def note_means(joint):
    """Note overlaps of each line in this step with sums for its history, and when it first slides and opens."""
    pairs, slight = joint.pairs, SLIGHT * joint.law.reach
    record = joint.record[joint.counts[STEPS] % joint.record.shape[0]]
    for part in range(record.shape[0]):
        for c in range(record.shape[1]):
            record[part, c] = 0.0
    for k in range(joint.counts[PAIRS]):
        f, g, length = U(pairs.first[k]), U(pairs.second[k]), pairs.length[k]
        if length > 0.0:
            part = joint.part[f]
            closed = not joint.law.fails or pairs.intact[k] != 0 or pairs.pressure[k] > 0.0
            record[part, U(0)] += length
            record[part, U(1)] += length * (pairs.slip[k] - 0.5 * (joint.rest[f] + joint.rest[g]))
            record[part, U(2)] += length * pairs.opening[k]
            record[part, U(3)] += length * pairs.pressure[k]
            record[part, U(4)] += length * pairs.shear[k]
            record[part, U(5)] += length * closed
            record[part, U(6)] += length * pairs.slides[k]
    for part in range(record.shape[0]):
        length = record[part, 0]
        if joint.first[part, 0] < 0 and record[part, 6] > 0.0 and abs(record[part, 1]) > slight * length:
            joint.first[part, 0] = joint.counts[STEPS]
        if joint.first[part, 1] < 0 and record[part, 5] < length and record[part, 2] > slight * length:
            joint.first[part, 1] = joint.counts[STEPS]
