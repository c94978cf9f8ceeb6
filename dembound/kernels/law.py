"""What the loop calls of a law, of a tie, and of forces that turn.

Each is a named tuple of arrays (tables.py), and its type decides, when the loop is compiled, which kernels are called.
A new law is a bundle with its kernels, named with `is_law`; the loop stays as it is.
"""

from functools import wraps
from typing import Any

import numpy as np
from numba import config, literal_unroll, njit, types
from numba.extending import overload

from dembound.kernels.common import DONE, FAST

Kernel = Any
"""A compiled function."""


def generic(stub: Kernel) -> Kernel:
    """A function whose kernel is chosen by the type of its first argument; `answer` names the kernels.

    Compiled code chooses when it is compiled, Python code, where nothing is compiled, when it is called.
    """
    kernels: dict[type, Kernel] = {}

    @wraps(stub)
    def choose(first: Any, *others: Any) -> Any:
        return kernels[type(first)](first, *others)

    choose.kernels = kernels  # type: ignore[attr-defined]
    return choose


@generic
def begin(law):
    """Reset what the law counts within one call of the loop."""


@generic
def check(law, u, u_next, v):
    """Why the loop has to return before this step, DONE if nothing keeps it; changes nothing but work space.

    u, v : (3, n) displacements now, velocities half a step ago; u_next : (3, n) work space.
    """


@generic
def push(law, u, u_next, v, number, step, work):
    """Compute the forces of displacements u in step `number` of length `step` (s).

    Forces that `move` needs stay in the law's own arrays or in u_next. work : (2, 6), see tables.Log. Returns whether
    bonds broke that the loop is to stop for, as a number.
    """


@generic
def note(law, index, u, log):
    """Write down what the law records at the probes beside their motion, in row `index` of log.record."""


@generic
def move(law, u, u_next, v, body, nodes):
    """Move the law's nodes by a step; u_next takes their displacements, of supported ones (k,) their forces."""


@generic
def finish(law, v, body, nodes, work):
    """Enter in work what the law took in this step, supported nodes (k,) moved too; v : (3, n) velocities after it."""


@generic
def across(tie, u, force):
    """Add to force (k, 3) what a tie does to the k supported nodes at displacements u (3, n)."""


def pull(ties, u, force):
    """Fill force (k, 3) with what all ties do to the k supported nodes at displacements u (3, n)."""
    force[:] = 0.0
    for tie in ties:
        across(tie, u, force)


@overload(pull)
def _pull(ties, u, force):
    if len(ties) == 0:
        return lambda ties, u, force: None

    def pull_all(ties, u, force):
        force[:] = 0.0
        for tie in literal_unroll(ties):
            across(tie, u, force)

    return pull_all


@generic
def turn(turning, u, v, load, step):
    """Turn the forces that turn with their sides, in load (3, n); returns the work (J) of that up to the whole step."""


@generic
def turning_work(turning, v, step):
    """Work (J) of what turning adds in the half step (s) after that, at velocities v (3, n) of its end."""


def _of_all(kernel: Kernel, *, returns: bool) -> Kernel:
    """The function called for all laws of a tuple in turn; returns the largest number where it returns numbers.

    A single law is called directly: unrolling a loop costs a short bar a tenth of its step.
    """

    def call(laws: Any, *others: Any) -> Any:
        """Stands for one of those below; what it does itself is done where nothing is compiled."""
        done = [kernel(law, *others) for law in laws]
        return max(done) if returns else None

    def choose(laws: Any, *others: Any) -> Kernel:
        def one(laws, *others):  # type: ignore[no-untyped-def]
            return kernel(laws[0], *others)

        def several(laws, *others):  # type: ignore[no-untyped-def]
            for law in literal_unroll(laws):
                kernel(law, *others)

        def largest(laws, *others):  # type: ignore[no-untyped-def]
            most = 0
            for law in literal_unroll(laws):
                most = max(most, np.int64(kernel(law, *others)))
            return most

        return one if len(laws) == 1 else largest if returns else several

    overload(call, jit_options=_UNCACHED, strict=False)(choose)
    return call


_INLINED: Any = {"forceinline": True}
"""How kernels of laws are compiled: into the loop. Passing all arrays of a bundle costs as much as fifty nodes."""

_UNCACHED: Any = {name: value for name, value in FAST.items() if name != "cache"} | _INLINED

begin_all, move_all = _of_all(begin, returns=False), _of_all(move, returns=False)
check_all, push_all = _of_all(check, returns=True), _of_all(push, returns=True)
note_all, finish_all = _of_all(note, returns=False), _of_all(finish, returns=False)


@njit(**FAST)
def _no_begin(law):
    pass


@njit(**FAST)
def _no_check(law, u, u_next, v):
    return DONE


@njit(**FAST)
def _no_push(law, u, u_next, v, number, step, work):
    return 0


@njit(**FAST)
def _no_note(law, index, u, log):
    pass


@njit(**FAST)
def _no_turn(turning, u, v, load, step):
    return 0.0


@njit(**FAST)
def _no_turning_work(turning, v, step):
    return 0.0


def is_law(
    bundle: type,
    *,
    move: Kernel,
    finish: Kernel,
    begin: Kernel = _no_begin,
    check: Kernel = _no_check,
    push: Kernel = _no_push,
    note: Kernel = _no_note,
) -> None:
    """Make bundles of this type a law with these kernels; each as described at this module's function of its name.

    The type has to be importable by its name, as what is compiled for it is kept on disk.
    """
    for name, kernel in locals().copy().items():
        if name != "bundle":
            answer(globals()[name], bundle, kernel)


def is_tie(bundle: type, *, across: Kernel) -> None:
    """Make bundles of this type a tie."""
    answer(globals()["across"], bundle, across)


def is_turning(bundle: type, *, turn: Kernel, turning_work: Kernel) -> None:
    """Make bundles of this type forces that turn."""
    answer(globals()["turn"], bundle, turn)
    answer(globals()["turning_work"], bundle, turning_work)


def answer(function: Kernel, bundle: type | None, kernel: Kernel) -> None:
    """Let a kernel stand for a generic function where its first argument is a bundle of this type, or None."""
    function.kernels[bundle or type(None)] = kernel
    if config.DISABLE_JIT:  # type: ignore[attr-defined]  # from the environment
        return

    def choose(first: Any, *others: Any) -> Kernel | None:
        is_it = isinstance(first, types.NoneType) if bundle is None else getattr(first, "instance_class", 0) is bundle
        return kernel.py_func if is_it else None

    options = {name: value for name, value in kernel.targetoptions.items() if name in FAST} | _INLINED
    overload(function, jit_options=options, strict=False)(choose)  # type: ignore[arg-type]  # its stubs miss _nrt


answer(turn, None, _no_turn)
answer(turning_work, None, _no_turning_work)
