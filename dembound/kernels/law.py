"""The functions that the loop calls for laws, ties and rotating forces.

Each of these is a named tuple of arrays (tables/), a bundle, whose type determines which kernels are called. A new law
is a bundle with its kernels, registered with `is_law`; the loop is not changed.
"""

from functools import wraps
from typing import Any

from numba import config
from numba.extending import overload

from dembound.kernels.common import FAST

Kernel = Any
"""A compiled function."""


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
def join(tie, u_next, v, step, inertia, moved, work):
    """Change the motion of supported nodes (k,) after a step (s) to what a tie prescribes, and the ledger with it.

    u_next, v : (3, n) displacements and velocities after the step. inertia : (k, 3) masses over the step. moved :
    (3, 3, k), see step.move_supported. work : (2, 7), see tables.Log.
    """


@generic
def turn(turning, u, v, load, step):
    """Rotate the forces that rotate with their sides, in load (3, n); returns its work (J) up to the whole step."""


@generic
def turning_work(turning, v, step):
    """Work (J) of the rotation of forces in the half step (s) after that, at velocities v (3, n) of its end."""


_INLINED: Any = {"forceinline": True}
"""Compiler options of kernels of bundles, which are copied into the function that is called for theirs."""


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
    """Register bundles of a type as a law with these kernels.

    Each is explained at the function of its name in this module. The type must be importable by its name, as the code
    compiled for it is kept on disk.
    """
    for name, kernel in locals().copy().items():
        if name != "bundle":
            answer(globals()[name], bundle, kernel)


def is_tie(bundle: type, *, across: Kernel, join: Kernel | None = None) -> None:
    """Register bundles of this type as a tie."""
    answer(globals()["across"], bundle, across)
    answer(globals()["join"], bundle, join)


def is_turning(bundle: type, *, turn: Kernel, turning_work: Kernel) -> None:
    """Register bundles of this type as forces that rotate."""
    answer(globals()["turn"], bundle, turn)
    answer(globals()["turning_work"], bundle, turning_work)


def answer(function: Kernel, bundle: type, kernel: Kernel | None) -> None:
    """Make a generic function call a kernel if its first argument is a bundle of this type.

    kernel : None if there is nothing to do, in functions that are called for all laws.
    """
    function.kernels[bundle] = kernel
    if kernel is None or config.DISABLE_JIT:  # type: ignore[attr-defined]  # from the environment
        return

    def choose(first: Any, *others: Any) -> Kernel | None:
        return kernel.py_func if getattr(first, "instance_class", None) is bundle else None

    options = {name: value for name, value in kernel.targetoptions.items() if name in FAST} | _INLINED
    overload(function, jit_options=options, strict=False)(choose)  # type: ignore[arg-type]  # its stubs lack _nrt
