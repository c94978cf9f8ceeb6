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
from dembound.kernels.law import across, begin, check, finish, move, note, push, turn, turning_work

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


BEGIN, CHECK, PUSH, NOTE, MOVE, FINISH, ACROSS, TURN, TURNING_WORK = range(1, 10)
"""Columns of the tables of bundles, see `entered`: what is called for laws, for ties, and for forces that rotate."""

ROLES = {
    BEGIN: Role(begin, _begin),
    CHECK: Role(check, _check, types.int64),
    PUSH: Role(push, _push, types.int64),
    NOTE: Role(note, _note),
    MOVE: Role(move, _move),
    FINISH: Role(finish, _finish),
    ACROSS: Role(across, _across),
    TURN: Role(turn, _turn, types.float64),
    TURNING_WORK: Role(turning_work, _turning_work, types.float64),
}

_call, _count, _measure = caller(types.none), caller(types.int64), caller(types.float64)


_INLINED: Any = {name: value for name, value in FAST.items() if name != "cache"} | {"forceinline": True}
"""Compiler options of functions that are copied into the loop."""


def _found(bundles: Any, column: int, *others: Any) -> list[Any]:
    """What the kernels of bundles return, without compiling."""
    role = ROLES[column]
    return [role.kernel(each, *others) for each in bundles if role.generic.kernels[type(each)] is not None]


def call_all(bundles: Any, column: int, *others: Any) -> None:
    """Call a kernel, by its column, of all bundles in turn, with (motion, step, number, given).

    A bundle without such a kernel costs nothing, neither time nor compiling. Compiled code takes a table of addresses,
    see `entered`, others the bundles.
    """
    _found(bundles, column, *others)


def count_all(bundles: Any, column: int, *others: Any) -> Any:
    """The largest of the whole numbers that the kernels return, at least 0; see `call_all`."""
    return max(_found(bundles, column, *others), default=0)


def measure_all(bundles: Any, column: int, *others: Any) -> Any:
    """The sum of the numbers that the kernels return; see `call_all`."""
    return sum(_found(bundles, column, *others))


@overload(call_all, jit_options=_INLINED, strict=False)
def _call_all(bundles, column, motion, step, number, given):  # type: ignore[no-untyped-def]
    def none(bundles, column, motion, step, number, given):  # type: ignore[no-untyped-def]
        for k in range(bundles.shape[0]):
            if bundles[k, column] != 0:
                _call(bundles[k, column], bundles[k, 0], motion, step, number, given)

    return none


@overload(count_all, jit_options=_INLINED, strict=False)
def _count_all(bundles, column, motion, step, number, given):  # type: ignore[no-untyped-def]
    def largest(bundles, column, motion, step, number, given):  # type: ignore[no-untyped-def]
        found = 0
        for k in range(bundles.shape[0]):
            if bundles[k, column] != 0:
                found = max(found, _count(bundles[k, column], bundles[k, 0], motion, step, number, given))
        return found

    return largest


@overload(measure_all, jit_options=_INLINED, strict=False)
def _measure_all(bundles, column, motion, step, number, given):  # type: ignore[no-untyped-def]
    def total(bundles, column, motion, step, number, given):  # type: ignore[no-untyped-def]
        found = 0.0
        for k in range(bundles.shape[0]):
            if bundles[k, column] != 0:
                found += _measure(bundles[k, column], bundles[k, 0], motion, step, number, given)
        return found

    return total


def _of(*columns: int) -> dict[int, Role]:
    """The roles of these columns."""
    return {column: ROLES[column] for column in columns}


_write_law = writer(_of(BEGIN, CHECK, PUSH, NOTE, MOVE, FINISH))
_write_tie, _write_turning = writer(_of(ACROSS)), writer(_of(TURN, TURNING_WORK))
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
    tables_of = [np.zeros((len(bundles), 1 + len(ROLES)), dtype=np.int64) for bundles in kinds]
    spaces = [np.empty((len(bundles), SPACE), dtype=np.int64) for bundles in kinds]
    for enter, bundles, table, space in zip(_ENTER, kinds, tables_of, spaces, strict=True):
        for k, bundle in enumerate(bundles):
            enter(bundle, table[k], space[k])
    *of_bundles, of_motions, of_given = tables_of
    yield *of_bundles, of_motions[:, 0].copy(), int(of_given[0, 0])
