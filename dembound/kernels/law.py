"""What the loop asks of a law, of a tie, and of forces that turn.

Each is a named tuple of arrays (tables.py), and its type decides, when the loop is compiled, which kernels answer. A
new law is a bundle with its kernels, named with `is_law`; the loop stays as it is.
"""

from typing import Any

import numpy as np
from numba import literal_unroll, njit, types
from numba.extending import overload

from dembound.kernels.common import DONE, FAST

Kernel = Any
"""A compiled function."""


def begin(law):
    """Reset what the law counts within one call of the loop."""


def check(law, u, spare, v):
    """Why the loop has to return before this step, DONE if nothing keeps it; changes nothing but work space.

    u, v : (3, n) displacements now, velocities half a step ago; spare : (3, n) work space.
    """


def push(law, u, spare, v, number, step, work):
    """Compute the forces of displacements u in step `number` of length `step` (s).

    Forces that `move` needs stay in the law's own arrays or in spare. work : (2, 6), see tables.Log. Returns whether
    bonds broke that the loop is to stop for, as a number.
    """


def note(law, index, u, log):
    """Write down what the law knows of the probes beside their motion, in row `index` of log.record."""


def move(law, u, spare, v, body, nodes):
    """Move the law's nodes by a step; spare takes their displacements, of supported ones (k,) their forces."""


def finish(law, v, body, nodes, work):
    """Enter in work what the law took in this step, supported nodes (k,) moved too; v : (3, n) velocities after it."""


def across(tie, u, force):
    """Add to force (k, 3) what a tie does to the k supported nodes at displacements u (3, n)."""


def pull(ties, u, force):
    """Fill force (k, 3) with what all ties do to the k supported nodes at displacements u (3, n)."""


@overload(pull)
def _pull(ties, u, force):
    if len(ties) == 0:
        return lambda ties, u, force: None

    def pull_all(ties, u, force):
        force[:] = 0.0
        for tie in literal_unroll(ties):
            across(tie, u, force)

    return pull_all


def turn(turning, u, v, load, step):
    """Turn the forces that turn with their sides, in load (3, n); returns the work (J) of that up to the whole step."""


def turning_work(turning, v, step):
    """Work (J) of what turning adds in the half step (s) after that, at velocities v (3, n) of its end."""


def _of_all(question: Kernel, *, answered: bool) -> Kernel:
    """The question put to all laws of a tuple in turn; returns the largest answer if they answer with numbers.

    A single law is asked at once: unrolling a loop costs a short bar a tenth of its step.
    """

    def ask(laws: Any, *others: Any) -> Any:
        """Stands for one of those below."""

    def choose(laws: Any, *others: Any) -> Kernel:
        def one(laws, *others):  # type: ignore[no-untyped-def]
            return question(laws[0], *others)

        def several(laws, *others):  # type: ignore[no-untyped-def]
            for law in literal_unroll(laws):
                question(law, *others)

        def largest(laws, *others):  # type: ignore[no-untyped-def]
            answer = 0
            for law in literal_unroll(laws):
                answer = max(answer, np.int64(question(law, *others)))
            return answer

        return one if len(laws) == 1 else largest if answered else several

    overload(ask, jit_options=_UNCACHED, strict=False)(choose)
    return ask


_INLINED: Any = {"forceinline": True}
"""How answers are compiled: into the loop. Handing on all arrays of a bundle costs as much as fifty nodes of a bar."""

_UNCACHED: Any = {name: value for name, value in FAST.items() if name != "cache"} | _INLINED

begin_all, move_all = _of_all(begin, answered=False), _of_all(move, answered=False)
check_all, push_all = _of_all(check, answered=True), _of_all(push, answered=True)
note_all, finish_all = _of_all(note, answered=False), _of_all(finish, answered=False)


@njit(**FAST)
def _no_begin(law):
    pass


@njit(**FAST)
def _no_check(law, u, spare, v):
    return DONE


@njit(**FAST)
def _no_push(law, u, spare, v, number, step, work):
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
    """Make bundles of this type a law with these kernels; each does what this module's function of its name says.

    The type has to be importable by its name, as what is compiled for it is kept on disk.
    """
    for name, kernel in locals().copy().items():
        if name != "bundle":
            _answer(globals()[name], bundle, kernel)


def is_tie(bundle: type, *, across: Kernel) -> None:
    """Make bundles of this type a tie."""
    _answer(globals()["across"], bundle, across)


def is_turning(bundle: type, *, turn: Kernel, turning_work: Kernel) -> None:
    """Make bundles of this type forces that turn."""
    _answer(globals()["turn"], bundle, turn)
    _answer(globals()["turning_work"], bundle, turning_work)


def _answer(generic: Kernel, bundle: type | None, kernel: Kernel) -> None:
    """Let a kernel stand for `generic` where its first argument is a bundle of this type, or None."""

    def choose(first: Any, *others: Any) -> Kernel | None:
        is_it = isinstance(first, types.NoneType) if bundle is None else getattr(first, "instance_class", 0) is bundle
        return kernel.py_func if is_it else None

    options = {name: value for name, value in kernel.targetoptions.items() if name in FAST} | _INLINED
    overload(generic, jit_options=options, strict=False)(choose)  # type: ignore[arg-type]  # its stubs miss _nrt


_answer(turn, None, _no_turn)
_answer(turning_work, None, _no_turning_work)
