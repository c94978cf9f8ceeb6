"""Pairs of faces of joints: copied as they are listed anew, and begun."""

from numba import njit

from dembound.kernels.common import FAST


@njit(**FAST)
def copy_pair(one, k, other, q):
    """Copy pair k of one list to place q of another."""
    other.first[q], other.second[q] = one.first[k], one.second[k]
    other.kn[q], other.ks[q] = one.kn[k], one.ks[k]
    other.intact[q], other.slides[q] = one.intact[k], one.slides[k]
    other.slip[q], other.length[q] = one.slip[k], one.length[k]
    other.pressure[q], other.shear[q], other.drag[q] = one.pressure[k], one.shear[k], one.drag[k]
    other.arm[q, 0], other.arm[q, 1] = one.arm[k, 0], one.arm[k, 1]
    other.energy[q], other.bearing[q], other.opening[q] = one.energy[k], one.bearing[k], one.opening[k]


@njit(**FAST)
def _in_series(one, other):
    """Stiffness between the faces of two disks, each of which gives by half of what its stiffness (Pa/m) says."""
    return one if one == other else 2.0 * one * other / (one + other)


@njit(**FAST)
def begin_pair(joint, q, f, g):
    """Make pair q of the spare list one of faces f and g without overlap."""
    pairs, each = joint.spare, joint.stiffness
    pairs.first[q], pairs.second[q] = f, g
    pairs.kn[q], pairs.ks[q] = _in_series(each[0, f], each[0, g]), _in_series(each[1, f], each[1, g])
    pairs.intact[q], pairs.slides[q] = False, False
    pairs.slip[q], pairs.length[q] = 0.0, 0.0
    pairs.pressure[q], pairs.shear[q], pairs.drag[q] = 0.0, 0.0, 0.0
    pairs.arm[q, 0], pairs.arm[q, 1] = 0.0, 0.0
    pairs.energy[q], pairs.bearing[q], pairs.opening[q] = 0.0, 0.0, 0.0
