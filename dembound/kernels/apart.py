"""Kernels that are compiled once, apart from those that call them.

Numba copies the code of a called function into that of its caller, where it is optimised and translated anew: once for
every combination of laws and ties of the loop, and at every level between. A kernel with `@apart` stays where it is.
The caller contains its name alone, which is linked to its address when the caller is compiled, or loaded. Each call
passes all arrays, some hundred nanoseconds, so only loops over particles, contacts or ties are worth it.
"""

import hashlib
from collections.abc import Callable
from functools import wraps
from importlib import import_module
from inspect import signature
from typing import Any, NamedTuple

import numba
from llvmlite import binding  # type: ignore[import-untyped]
from numba import config
from numba.core import cgutils, types
from numba.core.compiler import CompileResult
from numba.core.imputils import lower_builtin
from numba.core.typing.templates import AbstractTemplate, infer_global


class _Needed(NamedTuple):
    """A kernel for certain types of arguments that compiled code calls; it is called itself before this is loaded."""

    module: str
    name: str
    arguments: tuple[Any, ...]

    def __call__(self) -> None:
        """Link its name to its address; compiled or loaded before, if necessary."""
        kernel = getattr(import_module(self.module), self.name).__wrapped__
        kernel.compile(self.arguments)
        found = kernel.overloads[self.arguments]
        binding.add_symbol(self.symbol, found.library.get_pointer_to_function(found.fndesc.llvm_func_name))

    @property
    def symbol(self) -> str:
        """Name of the function in the machine code of callers."""
        types_of = hashlib.sha256(repr(self.arguments).encode()).hexdigest()
        return f"{self.module}.{self.name}.{types_of}"


KEPT = ["target_context", "libdata", "fndesc", "env", "signature", "objectmode", "lifted", "typeann"]
KEPT += ["reload_init", "referenced_envs"]
"""What numba keeps of compiled code on disk, in the versions with which `_rebuilt` works."""


def require_known(rebuild: Callable[..., Any]) -> None:
    """Raise ImportError if numba's own function for loading compiled code takes something else than `KEPT`.

    Loaded code would then call kernels that are not linked.
    """
    if (found := list(signature(rebuild).parameters)) != KEPT:
        raise ImportError(
            f"numba {numba.__version__} loads compiled code in a way that this dembound does not know "
            f"({', '.join(found)}); install a version of numba that dembound's requirements name"
        )


_rebuild = CompileResult._rebuild
require_known(_rebuild)


def _rebuilt(*kept: Any) -> Any:
    """Compiled code from what was kept on disk, for numba.

    Numba itself forgets what loaded code needs, so that a caller that is compiled from it would not know.
    """
    code = _rebuild(*kept)
    code.library._reload_init.update(code.reload_init)
    return code


CompileResult._rebuild = _rebuilt  # type: ignore[method-assign]


def apart(kernel: Any) -> Callable[..., Any]:
    """A compiled kernel for others to call without becoming part of them; they have to pass all arguments by place.

    It must be a name of its module. Called from Python it is the kernel itself.
    """
    if config.DISABLE_JIT:  # type: ignore[attr-defined]  # from the environment
        return kernel  # type: ignore[no-any-return]

    @wraps(kernel)
    def stub(*arguments: Any, **more: Any) -> Any:
        return kernel(*arguments, **more)

    class Typing(AbstractTemplate):
        key = stub

        def generic(self, args: Any, kws: Any) -> Any:
            if kws or len(args) != kernel.py_func.__code__.co_argcount:
                return None
            kernel.compile(args)
            return kernel.overloads[args].signature

    def lower(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        needed = _Needed(kernel.py_func.__module__, kernel.py_func.__name__, sig.args)
        needed()
        context.active_code_library._reload_init.add(needed)
        kind = context.call_conv.get_function_type(sig.return_type, sig.args)
        callee = cgutils.get_or_insert_function(builder.module, kind, needed.symbol)
        status, result = context.call_conv.call_function(builder, callee, sig.return_type, sig.args, args)
        with cgutils.if_unlikely(builder, status.is_error):
            context.call_conv.return_status_propagate(builder, status)
        return result

    infer_global(stub, types.Function(Typing))
    lower_builtin(stub, types.VarArg(types.Any))(lower)
    return stub
