"""Kernels that are compiled when they are first called, separately from their callers, and shared out among threads.

Numba copies the code of a called function into that of its caller, and optimises and translates it again at every
level, even if the case never calls it. Code that calls a kernel with `@apart` or `@in_chunks` contains a pointer, which
is null until the first call has the kernel compiled, or loaded. Each call passes all arrays, some hundred nanoseconds,
so only loops over particles, contacts or ties are worth it.
"""

import base64
import ctypes
import pickle
import traceback
from collections.abc import Callable
from functools import wraps
from importlib import import_module
from typing import Any

import numba
from llvmlite import binding, ir  # type: ignore[import-untyped]
from numba import config
from numba.core import cgutils, types
from numba.core.dispatcher import Dispatcher
from numba.core.imputils import lower_builtin
from numba.core.typing.templates import AbstractTemplate, infer_global
from numba.core.typing.templates import signature as typed

from dembound.interrupts import put_off
from dembound.kernels.common import CHUNKS

_BYTES = ir.IntType(8).as_pointer()
_INDEX = ir.IntType(64)
_RESOLVE = "dembound_compiled_kernel"


def compiled(kernel: Any, arguments: tuple[Any, ...], returned: Any) -> int:
    """Address of a kernel, compiled or loaded for arguments of given types.

    Raises TypeError for another return type.
    """
    with put_off():
        kernel.compile(arguments)
    found: Any = kernel.overloads[arguments]
    if found.signature.return_type != returned:
        raise TypeError(f"{kernel.py_func.__qualname__} returns {found.signature.return_type}, not {returned}")
    return int(found.library.get_pointer_to_function(found.fndesc.llvm_func_name))


def _compiled(needed: bytes) -> int:
    """Address of the kernel with the module, name and types of arguments that `address` wrote."""
    module, name, arguments, returned = pickle.loads(base64.b64decode(needed))
    kernel: Any = getattr(import_module(module), name)
    return compiled(kernel if isinstance(kernel, Dispatcher) else kernel.__wrapped__, arguments, returned)


@ctypes.CFUNCTYPE(ctypes.c_void_p, ctypes.c_char_p)
def _resolve(needed: bytes) -> int | None:
    """`_compiled` for compiled code, which raises RuntimeError where it gets no address."""
    try:
        return _compiled(needed)
    except BaseException:
        traceback.print_exc()
        return None


binding.add_symbol(_RESOLVE, ctypes.cast(_resolve, ctypes.c_void_p).value)
numba.get_num_threads()  # makes the functions known by which compiled code starts threads


def address(context: Any, builder: Any, kernel: Any, arguments: tuple[Any, ...], returned: Any) -> Any:
    """Write the code that looks up the address of a kernel, and requests it at the first call."""
    module, name = kernel.py_func.__module__, kernel.py_func.__name__
    kind = context.call_conv.get_function_type(returned, arguments).as_pointer()
    known = cgutils.add_global_variable(builder.module, kind, f".{module}.{name}")
    known.linkage, known.initializer = "internal", kind(None)
    with cgutils.if_unlikely(builder, cgutils.is_null(builder, builder.load(known))):
        needed = base64.b64encode(pickle.dumps((module, name, arguments, returned)))
        resolve = cgutils.get_or_insert_function(builder.module, ir.FunctionType(_BYTES, [_BYTES]), _RESOLVE)
        text = cgutils.global_constant(builder.module, ".needed", cgutils.make_bytearray(needed + b"\0"))
        found = builder.call(resolve, [builder.bitcast(text, _BYTES)])
        with cgutils.if_unlikely(builder, cgutils.is_null(builder, found)):
            context.call_conv.return_user_exc(builder, RuntimeError, (f"{module}.{name} was not compiled",))
        builder.store(builder.bitcast(found, kind), known)
    return builder.load(known)


def call_at(context: Any, builder: Any, kernel: Any, sig: Any, args: Any) -> Any:
    """Write the code that calls the kernel at an address, and passes on what it raises."""
    status, result = context.call_conv.call_function(builder, kernel, sig.return_type, sig.args, args)
    with cgutils.if_unlikely(builder, status.is_error):
        context.call_conv.return_status_propagate(builder, status)
    return result


def _callable(kernel: Any, own: tuple[Any, ...], returned: Any, call: Callable[..., Any]) -> Callable[..., Any]:
    """A function that compiled code can call for a kernel with arguments of the types of `own`, then of the call."""
    count = kernel.py_func.__code__.co_argcount - len(own)

    @wraps(kernel)
    def stub(*arguments: Any) -> Any:
        return kernel(*((0, CHUNKS) if own else ()), *arguments)

    class Typing(AbstractTemplate):
        key = stub

        def generic(self, args: Any, kws: Any) -> Any:
            return None if kws or len(args) != count else typed(returned, *(types.unliteral(each) for each in args))

    def lower(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        return call(context, builder, address(context, builder, kernel, own + sig.args, returned), sig, args)

    infer_global(stub, types.Function(Typing))
    lower_builtin(stub, types.VarArg(types.Any))(lower)
    return stub


def apart(returned: Any = types.none) -> Callable[[Any], Callable[..., Any]]:
    """A decorator of a kernel that is compiled separately from its callers; all arguments are positional.

    The kernel must be a name of its module. returned : type of its result. Called from Python it is the kernel itself.
    """
    return lambda kernel: kernel if config.DISABLE_JIT else _callable(kernel, (), returned, call_at)  # type: ignore[attr-defined]


def in_chunks(kernel: Any) -> Callable[..., Any]:
    """A kernel of chunks first to last − 1, its first two arguments, which callers leave out.

    The `CHUNKS` chunks are shared out among the threads. A chunk must not depend on others; the kernel must be a name
    of its module, and return nothing. Called from Python it computes all chunks in turn.
    """
    if config.DISABLE_JIT:  # type: ignore[attr-defined]  # from the environment
        return wraps(kernel)(lambda *arguments: kernel(0, CHUNKS, *arguments))
    return _callable(kernel, (types.int64, types.int64), types.none, _share_out)


def _share_out(context: Any, builder: Any, kernel: Any, sig: Any, args: Any) -> Any:
    """Write the code that calls a kernel of chunks in all threads, by the functions behind numba's own parallel loops.

    These call a function (places, counts, steps, data) for some of the `counts[0]` shares, the first of which is at
    places[0]; the data are the kernel and its arguments.
    """
    values = [kernel, *context.call_conv._get_arg_packer(sig.args).as_arguments(builder, args)]
    data = cgutils.alloca_once(builder, ir.LiteralStructType([value.type for value in values]))
    for k, value in enumerate(values):
        builder.store(value, cgutils.gep_inbounds(builder, data, 0, k))
    threads = builder.call(
        cgutils.get_or_insert_function(builder.module, ir.FunctionType(_INDEX, []), "get_num_threads"), []
    )
    starts = cgutils.alloca_once(builder, ir.ArrayType(_INDEX, CHUNKS + 1))
    shares = builder.select(builder.icmp_signed("<", threads, _INDEX(CHUNKS)), threads, _INDEX(CHUNKS))
    with cgutils.for_range(builder, builder.add(shares, _INDEX(1)), intp=_INDEX) as loop:
        start = builder.sdiv(builder.mul(loop.index, _INDEX(CHUNKS)), shares)
        builder.store(start, cgutils.gep_inbounds(builder, starts, 0, loop.index))
    pointers = [cgutils.alloca_once(builder, kind) for kind in (_BYTES, _INDEX, _INDEX)]
    for pointer, value in zip(
        pointers, (builder.bitcast(starts, _BYTES), shares, _INDEX(_INDEX.width // 8)), strict=True
    ):
        builder.store(value, pointer)
    share = _share(context, builder.module, data.type)
    with builder.if_else(builder.icmp_signed("==", shares, _INDEX(1))) as (alone, together):
        with alone:
            builder.call(share, [*pointers, builder.bitcast(data, _BYTES)])
        with together:
            kinds = [_BYTES, *(pointer.type for pointer in pointers), _BYTES, _INDEX, _INDEX, ir.IntType(32)]
            launch = cgutils.get_or_insert_function(
                builder.module, ir.FunctionType(ir.VoidType(), kinds), "numba_parallel_for"
            )
            more = [_INDEX(0), _INDEX(1), builder.trunc(shares, ir.IntType(32))]
            builder.call(launch, [builder.bitcast(share, _BYTES), *pointers, builder.bitcast(data, _BYTES), *more])
    return context.get_dummy_value()


def _share(context: Any, module: Any, data: Any) -> Any:
    """The function that calls a kernel of chunks for some shares, see `_share_out`; data : type of their address."""
    kinds = [_BYTES.as_pointer(), _INDEX.as_pointer(), _INDEX.as_pointer(), _BYTES]
    function = ir.Function(module, ir.FunctionType(ir.VoidType(), kinds), module.get_unique_name(".share"))
    function.linkage = "internal"
    builder = ir.IRBuilder(function.append_basic_block())
    places, counts, _, known = function.args
    begin = builder.bitcast(builder.load(places), _INDEX.as_pointer())
    chunks = [builder.load(begin), builder.load(builder.gep(begin, [builder.load(counts)]))]
    known = builder.bitcast(known, data)
    kernel, *values = [builder.load(cgutils.gep_inbounds(builder, known, 0, k)) for k in range(len(data.pointee))]
    returned, raised = (builder.alloca(kind.pointee) for kind in kernel.type.pointee.args[:2])
    builder.call(kernel, [returned, raised, *chunks, *values])
    builder.ret_void()
    return function
