"""What the loop calls: the kernels of laws, of ties, and of forces that rotate, by their addresses.

Each kernel is called with the addresses of its bundle, of the motion at the step, and of what is given for all steps
(bundles.py), so that it and the loop are compiled by themselves.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple, Self

import numpy as np
from numba import config, njit, typeof, types
from numba.extending import overload

from dembound.kernels import tables
from dembound.kernels.bundles import SPACE, Role, caller, contents, reader, writer
from dembound.kernels.common import FAST
from dembound.kernels.law import Kernel, across, begin, check, finish, move, note, push, turn, turning_work

Bundles = tuple[Any, ...]


class Motion(NamedTuple):
    """Motion (3, n) at a step: displacements, space for the next ones, velocities half a step earlier."""

    u: np.ndarray
    u_next: np.ndarray
    v: np.ndarray


class Given(NamedTuple):
    """What is the same in all steps of a call of the loop, and its work space; see tables/.

    pulled (k, 3) N forces of ties on the k supported nodes, followed (k, 3) m/s velocities of their twins, moved
    (3, 3, k) see step.move_supported, sums (b, 4) see sides.note_sides.
    """

    body: tables.Body
    supports: tables.Supports
    log: tables.Log
    pulled: np.ndarray
    followed: np.ndarray
    moved: np.ndarray
    sums: np.ndarray

    @classmethod
    def by(cls, body: tables.Body, supports: tables.Supports, log: tables.Log) -> Self:
        """With new work space."""
        k, b = supports.nodes.size, log.sides.kind.size
        return cls(body, supports, log, np.zeros((k, 3)), np.zeros((k, 3)), np.zeros((3, 3, k)), np.zeros((b, 4)))


def _examples() -> tuple[Motion, Given]:
    """Bundles of the types that all have."""
    number, value, row, layer = np.zeros(0, dtype=np.int64), np.zeros(0), np.zeros((0, 3)), np.zeros((0, 3, 3))
    body = tables.Body(value, value, value, row, 0.0, 0.0)
    supports = tables.Supports(number, row, row, row, row, row, layer, number, row)
    return Motion(row, row, row), Given.by(body, supports, tables.Log(number, layer, number, layer, value, row, value))


_MOTION, _GIVEN = map(typeof, _examples())
motion_at, given_at = reader(_MOTION), reader(_GIVEN)
"""Functions of an address that the loop has of a `Motion`, and of what is `Given`."""


@njit(**FAST)
def _begin(law, motion, step, number, given):
    begin(contents(law))


@njit(**FAST)
def _check(law, motion, step, number, given):
    u, u_next, v = motion_at(motion)
    return np.int64(check(contents(law), u, u_next, v))


@njit(**FAST)
def _push(law, motion, step, number, given):
    u, u_next, v = motion_at(motion)
    its = given_at(given)
    return np.int64(push(contents(law), u, u_next, v, number, its.body.step, its.log.work))


@njit(**FAST)
def _note(law, motion, step, number, given):
    note(contents(law), step, motion_at(motion).u, given_at(given).log)


@njit(**FAST)
def _move(law, motion, step, number, given):
    u, u_next, v = motion_at(motion)
    its = given_at(given)
    move(contents(law), u, u_next, v, its.body, its.supports.nodes)


@njit(**FAST)
def _finish(law, motion, step, number, given):
    its = given_at(given)
    finish(contents(law), motion_at(motion).v, its.body, its.supports.nodes, its.log.work)


@njit(**FAST)
def _across(tie, motion, step, number, given):
    u, _, v = motion_at(motion)
    across(contents(tie), u, v, given_at(given).pulled)


@njit(**FAST)
def _turn(turning, motion, step, number, given):
    u, _, v = motion_at(motion)
    its = given_at(given)
    return turn(contents(turning), u, v, its.body.load, its.body.step)


@njit(**FAST)
def _turning_work(turning, motion, step, number, given):
    return turning_work(contents(turning), motion_at(motion).v, given_at(given).body.step)


LAW = (
    Role(begin, _begin),
    Role(check, _check, types.int64),
    Role(push, _push, types.int64),
    Role(note, _note),
    Role(move, _move),
    Role(finish, _finish),
)
TIE = (Role(across, _across),)
TURNING = Role(turn, _turn, types.float64), Role(turning_work, _turning_work, types.float64)
"""What is called for laws, for ties, and for forces that rotate, by columns of tables of them after the first."""

_call, _count, _measure = caller(types.none), caller(types.int64), caller(types.float64)


_INLINED: Any = {name: value for name, value in FAST.items() if name != "cache"} | {"forceinline": True}
"""Compiler options of functions that are copied into the loop."""


def _of_all(role: Role, column: int) -> Kernel:
    """The function (bundles, motion, step, number, given) that calls a kernel of all bundles in turn.

    It returns the largest whole number, or the sum, of what they return. A bundle without such a kernel costs nothing,
    neither time nor compiling. Compiled code takes a table of addresses, see `entered`, others the bundles.
    """

    def call(bundles: Any, *others: Any) -> Any:
        """Replaced by one of the functions below in compiled code; this one runs without compiling."""
        kernels = role.generic.kernels
        found = [role.kernel(bundle, *others) for bundle in bundles if kernels[type(bundle)] is not None]
        if role.returned == types.none:
            return None
        return max(found, default=0) if role.returned == types.int64 else sum(found)

    def none(bundles, motion, step, number, given):  # type: ignore[no-untyped-def]
        for k in range(bundles.shape[0]):
            if bundles[k, column] != 0:
                _call(bundles[k, column], bundles[k, 0], motion, step, number, given)

    def largest(bundles, motion, step, number, given):  # type: ignore[no-untyped-def]
        found = 0
        for k in range(bundles.shape[0]):
            if bundles[k, column] != 0:
                found = max(found, _count(bundles[k, column], bundles[k, 0], motion, step, number, given))
        return found

    def total(bundles, motion, step, number, given):  # type: ignore[no-untyped-def]
        found = 0.0
        for k in range(bundles.shape[0]):
            if bundles[k, column] != 0:
                found += _measure(bundles[k, column], bundles[k, 0], motion, step, number, given)
        return found

    choice = {types.none: none, types.int64: largest, types.float64: total}[role.returned]
    overload(call, jit_options=_INLINED, strict=False)(lambda bundles, motion, step, number, given: choice)
    return call


begin_all, check_all, push_all, note_all, move_all, finish_all = (_of_all(each, 1 + k) for k, each in enumerate(LAW))
across_all = _of_all(*TIE, 1)
turn_all, turning_work_all = (_of_all(each, 1 + k) for k, each in enumerate(TURNING))

_write_law, _write_tie, _write_turning = writer(LAW), writer(TIE), writer(TURNING)
_write_motion, _write_given = writer(only=_MOTION), writer(only=_GIVEN)


@njit(**FAST)
def _enter_law(law, row, space):
    _write_law(law, row, space)


@njit(**FAST)
def _enter_tie(tie, row, space):
    _write_tie(tie, row, space)


@njit(**FAST)
def _enter_turning(turning, row, space):
    _write_turning(turning, row, space)


@njit(**FAST)
def _enter_motion(motion, row, space):
    _write_motion(motion, row, space)


@njit(**FAST)
def _enter_given(given, row, space):
    _write_given(given, row, space)


_ENTER = _enter_law, _enter_tie, _enter_turning, _enter_motion, _enter_given


@contextmanager
def entered(
    laws: Bundles, ties: Bundles, turnings: Bundles, motions: tuple[Motion, ...], given: Given
) -> Iterator[tuple[Any, ...]]:
    """What the loop takes, valid inside: tables of addresses, those of motions (k,), the one of what is given.

    A row of a table has the address of a bundle's data, then of its kernels by role, 0 for none. Without compiling the
    loop takes the bundles themselves.
    """
    if config.DISABLE_JIT:  # type: ignore[attr-defined]  # from the environment
        yield laws, ties, turnings, motions, given
        return
    kinds: list[Bundles] = [laws, ties, turnings, motions, (given,)]
    tables_of = [np.zeros((len(bundles), 1 + max(len(LAW), len(TURNING))), dtype=np.int64) for bundles in kinds]
    spaces = [np.empty((len(bundles), SPACE), dtype=np.int64) for bundles in kinds]
    for enter, bundles, table, space in zip(_ENTER, kinds, tables_of, spaces, strict=True):
        for k, bundle in enumerate(bundles):
            enter(bundle, table[k], space[k])
    *of_bundles, of_motions, of_given = tables_of
    yield *of_bundles, of_motions[:, 0].copy(), int(of_given[0, 0])
