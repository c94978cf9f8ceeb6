"""Kernels of laws, ties and rotating forces, which the loop calls by their addresses.

Each kernel gets the addresses of its bundle, of the motion at the step, and of the data for all steps (bundles.py), so
that kernels and the loop are compiled separately.
"""

from typing import Any, NamedTuple, Self

import numpy as np
from numba import config, njit, types
from numba.extending import overload

from dembound.kernels import tables
from dembound.kernels.common import FAST
from dembound.kernels.compiler.bundles import At, Role, Written, caller, kind_of, kinds_of_parts, reader
from dembound.kernels.compiler.separate import compiled
from dembound.kernels.law import across, begin, check, finish, join, move, note, push, turn, turning_work

Bundles = tuple[Any, ...]


class Motion(NamedTuple):
    """Motion (3, n) at a step: displacements, space for the next ones, velocities half a step earlier."""

    u: np.ndarray
    u_next: np.ndarray
    v: np.ndarray


class Given(NamedTuple):
    """Data that is the same in all steps of a call of the loop, and its work space; see tables/.

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
        """The data of body, supports and log with new work space."""
        k, b = supports.nodes.size, log.sides.kind.size
        return cls(body, supports, log, np.zeros((k, 3)), np.zeros((k, 3)), np.zeros((3, 3, k)), np.zeros((b, 4)))


def _examples() -> tuple[Motion, Given]:
    """Bundles of the types in every call."""
    number, value, row, layer = np.zeros(0, dtype=np.int64), np.zeros(0), np.zeros((0, 3)), np.zeros((0, 3, 3))
    body = tables.Body(value, value, value, row, 0.0, 0.0)
    supports = tables.Supports(number, row, row, row, row, row, layer, number, row)
    return Motion(row, row, row), Given.by(body, supports, tables.Log(number, layer, number, layer, value, row, value))


_MOTION, _GIVEN = map(kind_of, _examples())
motion_at, given_at = reader(_MOTION), reader(_GIVEN)
"""Functions from the address of a `Motion` and of `Given` to their bundles."""


@njit(**FAST)
def _begin(law, motion, step, number, given):
    begin(law)


@njit(**FAST)
def _check(law, motion, step, number, given):
    its = motion_at(motion)
    return np.int64(check(law, its.u, its.u_next, its.v))


@njit(**FAST)
def _push(law, motion, step, number, given):
    moved, its = motion_at(motion), given_at(given)
    return np.int64(push(law, moved.u, moved.u_next, moved.v, number, its.body.step, its.log.work))


@njit(**FAST)
def _note(law, motion, step, number, given):
    note(law, step, motion_at(motion).u, given_at(given).log)


@njit(**FAST)
def _move(law, motion, step, number, given):
    moved, its = motion_at(motion), given_at(given)
    move(law, moved.u, moved.u_next, moved.v, its.body, its.supports.nodes)


@njit(**FAST)
def _finish(law, motion, step, number, given):
    its = given_at(given)
    finish(law, motion_at(motion).v, its.body, its.supports.nodes, its.log.work)


@njit(**FAST)
def _across(tie, motion, step, number, given):
    its = motion_at(motion)
    across(tie, its.u, its.v, given_at(given).pulled)


@njit(**FAST)
def _join(tie, motion, step, number, given):
    moved, its = motion_at(motion), given_at(given)
    join(tie, moved.u_next, moved.v, its.body.step, its.supports.inertia, its.moved, its.log.work)


@njit(**FAST)
def _turn(turning, motion, step, number, given):
    moved, its = motion_at(motion), given_at(given)
    return turn(turning, moved.u, moved.v, its.body.load, its.body.step)


@njit(**FAST)
def _turning_work(turning, motion, step, number, given):
    return turning_work(turning, motion_at(motion).v, given_at(given).body.step)


BEGIN, CHECK, PUSH, NOTE, MOVE, FINISH, ACROSS, JOIN, TURN, TURNING_WORK = range(1, 11)
"""Columns of the tables of bundles, see `entered`: kernels of laws, of ties, and of rotating forces."""

ROLES = {
    BEGIN: Role(begin, _begin),
    CHECK: Role(check, _check, types.int64),
    PUSH: Role(push, _push, types.int64),
    NOTE: Role(note, _note),
    MOVE: Role(move, _move),
    FINISH: Role(finish, _finish),
    ACROSS: Role(across, _across),
    JOIN: Role(join, _join),
    TURN: Role(turn, _turn, types.float64),
    TURNING_WORK: Role(turning_work, _turning_work, types.float64),
}

_call, _count, _measure = caller(types.none), caller(types.int64), caller(types.float64)


_INLINED: Any = {name: value for name, value in FAST.items() if name != "cache"} | {"forceinline": True}
"""Compiler options of functions that are copied into the loop."""


def _found(bundles: Any, column: int, *others: Any) -> list[Any]:
    """Results of the kernels of bundles, without compiling."""
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


_CALLED = (BEGIN, CHECK, PUSH, NOTE, MOVE, FINISH), (ACROSS, JOIN), (TURN, TURNING_WORK), (), ()
"""Columns of the kernels of laws, ties, rotating forces, motions and given data."""

Kept = dict[tuple[int, int], tuple[Written, list[int]]]
"""Bundles of the last call with their rows of addresses, by table and place; unchanged rows are kept."""


_KERNELS: dict[tuple[Any, ...], list[int]] = {}
"""Addresses of kernels by role, 0 for none, for all types of bundles so far, by table and `bundles.kinds_of_parts`."""


def _kernels(bundle: Any, table: int) -> list[int]:
    """The addresses of the kernels of a bundle by role, which are compiled, or loaded."""
    kinds = table, kinds_of_parts(bundle)
    if kinds not in _KERNELS:
        kind = kind_of(bundle)
        wanted = {Motion: _MOTION, Given: _GIVEN}.get(type(bundle), kind)
        if kind != wanted:
            raise TypeError(f"the loop takes {wanted}, not {kind}")
        found = [0] * len(ROLES)
        for column in _CALLED[table]:
            role = ROLES[column]
            if role.generic.kernels[type(bundle)] is not None:
                arguments = At(kind), *[types.int64] * (role.kernel.py_func.__code__.co_argcount - 1)
                found[column - 1] = compiled(role.kernel, arguments, role.returned)
        _KERNELS[kinds] = found
    return _KERNELS[kinds]


def _row(bundle: Any, table: int, place: int, kept: Kept) -> list[int]:
    """The row of a bundle in a table of addresses, see `entered`."""
    known = kept.get((table, place))
    if known is not None and known[0].takes(bundle):
        return known[1]
    kernels, data = _kernels(bundle, table), Written(bundle)
    kept[table, place] = data, [data.address, *kernels]
    return kept[table, place][1]


def entered(
    laws: Bundles, ties: Bundles, turnings: Bundles, motions: tuple[Motion, ...], given: Given, kept: Kept
) -> tuple[Any, ...]:
    """Arguments of the loop: tables of addresses, those of motions (k,), and the address of the given data.

    They are valid while `kept` is. A row of a table has the address of a bundle's numbers, then of its kernels by role,
    0 for none. Without compiling the loop takes the bundles themselves. Raises TypeError for motions or data of
    unexpected types.
    """
    if config.DISABLE_JIT:  # type: ignore[attr-defined]  # from the environment
        return laws, ties, turnings, motions, given
    rows = [
        [_row(bundle, table, place, kept) for place, bundle in enumerate(bundles)]
        for table, bundles in enumerate((laws, ties, turnings, motions, (given,)))
    ]
    *tables_of, of_motions, of_given = (np.array(each, dtype=np.int64).reshape(-1, 1 + len(ROLES)) for each in rows)
    return *tables_of, of_motions[:, 0].copy(), int(of_given[0, 0])
