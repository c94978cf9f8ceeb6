"""The functions that the loop calls for a law, for a tie, and for forces that rotate.

Each of these is a named tuple of arrays (tables/), a bundle. Its type determines, when the loop is compiled, which
kernels are called. A new law is a bundle with its kernels, registered with `is_law`; the loop is not changed.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from functools import wraps
from typing import Any, NamedTuple, Self

import numpy as np
from numba import config, njit, typeof, types
from numba.extending import overload

from dembound.kernels import tables
from dembound.kernels.bundles import SPACE, Role, caller, contents, reader, writer
from dembound.kernels.common import FAST

Kernel = Any
"""A compiled function."""

Bundles = tuple[Any, ...]


def generic(stub: Kernel) -> Kernel:
    """A function whose kernel is chosen by the type of its first argument; `answer` registers the kernels.

    In compiled code the choice is made when it is compiled, otherwise (NUMBA_DISABLE_JIT=1) at each call.
    """
    kernels: dict[type, Kernel] = {}

    @wraps(stub)
    def choose(first: Any, *others: Any) -> Any:
        return kernels[type(first)](first, *others)

    choose.kernels = kernels  # type: ignore[attr-defined]
    return choose


@generic
def begin(law):
    """Reset the counters of the law at the beginning of a call of the loop."""


@generic
def check(law, u, u_next, v):
    """The reason why the loop has to return before this step, or DONE; changes only work space.

    u, v : (3, n) displacements now, velocities half a step earlier; u_next : (3, n) work space.
    """


@generic
def push(law, u, u_next, v, number, step, work):
    """Compute the forces of displacements u in step `number` of length `step` (s).

    Forces that `move` needs are stored in the law's own arrays or in u_next. work : (2, 7), see tables.Log. Returns, as
    a number, whether bonds broke at which the loop is to stop.
    """


@generic
def note(law, index, u, log):
    """Record quantities of the law at the probes, in addition to their motion, in row `index` of log.record."""


@generic
def move(law, u, u_next, v, body, nodes):
    """Move the law's nodes by a step; u_next receives their displacements, for supported ones (k,) their forces."""


@generic
def finish(law, v, body, nodes, work):
    """Add to work the energy the law took in this step, with supported nodes (k,); v : (3, n) velocities after it."""


@generic
def across(tie, u, v, force):
    """Add to force (k, 3) the forces of a tie on the k supported nodes at displacements u (3, n).

    v : (3, n) velocities half a step earlier.
    """


@generic
def turn(turning, u, v, load, step):
    """Rotate the forces that rotate with their sides, in load (3, n); returns its work (J) up to the whole step."""


@generic
def turning_work(turning, v, step):
    """Work (J) of the rotation of forces in the half step (s) after that, at velocities v (3, n) of its end."""


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


def _of_all(role: Role, column: int) -> Kernel:
    """The function (bundles, motion, step, number, given) that calls a kernel of all bundles in turn.

    It returns the largest whole number, or the sum, of what they return. A bundle without such a kernel costs nothing,
    neither time nor compiling. Compiled code takes a table of addresses, see `entered`, others the bundles.
    """

    def call(bundles: Any, *others: Any) -> Any:
        """Replaced by one of the functions below in compiled code; this one runs without compiling."""
        kernels = role.generic.kernels
        found = [role.kernel(bundle, *others) for bundle in bundles if kernels[type(bundle)] is not None]
        return (
            max(found, default=0) if role.returned == types.int64 else sum(each for each in found if each is not None)
        )

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
    overload(call, jit_options=_UNCACHED, strict=False)(lambda bundles, motion, step, number, given: choice)
    return call


_INLINED: Any = {"forceinline": True}
"""Compiler options of kernels of bundles, which are copied into the function that is called for theirs."""

_UNCACHED: Any = {name: value for name, value in FAST.items() if name != "cache"} | _INLINED

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


def is_law(
    bundle: type,
    *,
    move: Kernel,
    finish: Kernel,
    begin: Kernel | None = None,
    check: Kernel | None = None,
    push: Kernel | None = None,
    note: Kernel | None = None,
) -> None:
    """Register bundles of this type as a law with these kernels; see the function of the same name in this module.

    The type must be importable by its name, as the code compiled for it is kept on disk.
    """
    for name, kernel in locals().copy().items():
        if name != "bundle":
            answer(globals()[name], bundle, kernel)


def is_tie(bundle: type, *, across: Kernel) -> None:
    """Register bundles of this type as a tie."""
    answer(globals()["across"], bundle, across)


def is_turning(bundle: type, *, turn: Kernel, turning_work: Kernel) -> None:
    """Register bundles of this type as forces that rotate."""
    answer(globals()["turn"], bundle, turn)
    answer(globals()["turning_work"], bundle, turning_work)


def answer(function: Kernel, bundle: type | None, kernel: Kernel | None) -> None:
    """Make a generic function call a kernel where its first argument is a bundle of this type, or None.

    kernel : None if there is nothing to do, in functions that are called for all laws.
    """
    function.kernels[bundle or type(None)] = kernel
    if kernel is None or config.DISABLE_JIT:  # type: ignore[attr-defined]  # from the environment
        return

    def choose(first: Any, *others: Any) -> Kernel | None:
        is_it = isinstance(first, types.NoneType) if bundle is None else getattr(first, "instance_class", 0) is bundle
        return kernel.py_func if is_it else None

    options = {name: value for name, value in kernel.targetoptions.items() if name in FAST} | _INLINED
    overload(function, jit_options=options, strict=False)(choose)  # type: ignore[arg-type]  # its stubs lack _nrt
