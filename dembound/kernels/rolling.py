"""Moments of contacts without bonds that resist rolling, as laws ask for; of other laws nothing of it is compiled.

A contact's spring is turned by the relative rotation of its disks, less what has slid (`Contacts.rolled`). Names are
those of pair_lanes.py.
"""

from typing import Any

from numba import njit

from dembound.kernels.common import FAST, INLINED, U
from dembound.kernels.compiler.lane_access import load, load_of, store_some
from dembound.kernels.compiler.lanes import LANES, at_most, bits, choose, larger, magnitude, with_sign
from dembound.kernels.lane_sums import add_to
from dembound.kernels.law import answer, generic
from dembound.kernels.pair_law import most_moment, rolling
from dembound.pairwise import COMPILERS, PAIR_LAWS


@generic
def roll_pair(limits, c, k, push, turned, contacts, lost):
    """Moment of contact c, see `_roll_pair`; 0 under laws whose contacts do not resist rolling."""


@generic
def roll_eight(limits, law, at, push, step, loose, v, contacts, taken):
    """Moments of eight contacts, see `_roll_eight`; 0 under laws whose contacts do not resist rolling."""


@njit(**INLINED)
def rolled_on(limits, constants, k, kind, push, before, turned):
    """Rotation that has not slid, moment (N·m) and energy (J) taken of contacts after a step; numbers or lanes.

    push : N; before : rad, the rotation that had not slid a step earlier; turned : rad, rotation of the second disk
    relative to the first in the step. The moment of whole steps does the work ½(M⁻ + M) turned, of which the spring
    stores the change of ½k_r times the square of the rotation. Nothing is left of it in a contact that does not push.
    """
    stiff, radius = rolling(limits, constants, k)
    most, angle = most_moment(limits, kind, radius, push), before + turned
    moment = stiff * angle
    sticks = at_most(magnitude(moment), most)
    moment = choose(sticks, moment, with_sign(most, moment))
    angle = choose(sticks, angle, moment / stiff)
    return angle, moment, 0.5 * stiff * (before + angle) * (before + turned - angle)


@njit(**FAST)
def _roll_pair(limits, c, k, push, turned, contacts, lost):
    """Moment of the rolling contact c, see `rolled_on`; lost (5,) is advanced by what it takes."""
    angle, moment, taken = rolled_on(limits, contacts.constants, k, k, push, contacts.rolled[c], turned)
    contacts.rolled[c] = angle
    lost[0 if taken > 0.0 else 2] += taken
    return moment


@njit(**FAST)
def _roll_eight(limits, law, at, push, step, loose, v, contacts, taken):
    """Moments of rolling contacts, see `rolled_on`; loose : byte of those without bonds. taken is advanced."""
    (k, _, q, kind, _), (c, i, j) = law, at
    turned = step * (load_of(v, U(2), j) - load_of(v, U(2), i))
    angle, moment, loss = rolled_on(limits, k, q, kind, push, load(contacts.rolled, c), turned)
    store_some(contacts.rolled, c, angle, loose)
    loss = choose(bits(loose), loss, 0.0)
    add_to(taken, 0, larger(loss, 0.0))
    add_to(taken, LANES, choose(at_most(loss, 0.0), loss, 0.0))
    return choose(bits(loose), moment, 0.0)


@njit(**FAST)
def _no_moment(limits, c, k, push, turned, contacts, lost):
    return 0.0


@njit(**FAST)
def _no_moments(limits, law, at, push, step, loose, v, contacts, taken):
    return 0.0


def _choose(limits: type, functions: dict[str, Any]) -> None:
    """Make the functions above roll contacts for limits of a type, if the law says that they resist it."""
    acts = functions["rolls"](None)
    answer(roll_pair, limits, _roll_pair if acts else _no_moment)
    answer(roll_eight, limits, _roll_eight if acts else _no_moments)


COMPILERS.append(_choose)
for _limits, _functions in PAIR_LAWS.items():
    _choose(_limits, _functions)
