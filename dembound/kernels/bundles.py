"""Bundles, named tuples of arrays (tables/), behind addresses: the loop is the same for all types of them.

`writer` makes what writes the data of a bundle to memory and the addresses of its kernels to a row of a table. The loop
calls these by `caller`, with the address of the data; a kernel reads them by `contents`.
"""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from llvmlite import ir  # type: ignore[import-untyped]
from numba import types
from numba.core import cgutils
from numba.core.imputils import lower_builtin
from numba.core.typing.templates import AbstractTemplate, infer_global, signature

from dembound.kernels.apart import address, call_at

SPACE = 1024
"""Most numbers in the data of a bundle: of an array seven and two more for each direction after the first."""


class Role(NamedTuple):
    """What the loop calls for a bundle: a generic function, through a kernel that takes the bundle's address first."""

    generic: Any
    kernel: Any
    returned: Any = types.none


def _known(typed: Callable[..., Any], lower: Callable[..., Any]) -> Callable[..., Any]:
    """A function that compiled code can call: typed by its arguments' types, written by `lower`.

    Called from Python, without compiling, it returns its first argument.
    """

    def function(first: Any, *_: Any) -> Any:
        return first

    class Typing(AbstractTemplate):
        key = function

        def generic(self, args: Any, kws: Any) -> Any:
            return typed(*args)

    infer_global(function, types.Function(Typing))
    lower_builtin(function, types.VarArg(types.Any))(lower)
    return function


def caller(returned: Any) -> Callable[..., Any]:
    """A function (address of a kernel, address of a bundle, whole numbers) that calls the kernel."""

    def typed(*args: Any) -> Any:
        return signature(returned, *[types.int64 for _ in args])

    def lower(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        kinds = types.voidptr, *sig.args[2:]
        kernel = builder.inttoptr(args[0], context.call_conv.get_function_type(returned, kinds).as_pointer())
        bundle = builder.inttoptr(args[1], cgutils.voidptr_t)
        return call_at(context, builder, kernel, signature(returned, *kinds), [bundle, *args[2:]])

    return _known(typed, lower)


def _data(context: Any, bundle: Any) -> tuple[Any, Any]:
    """What takes a bundle apart into numbers, and the type of these in memory."""
    packer = context.call_conv._get_arg_packer((bundle,))
    return packer, ir.LiteralStructType(list(packer.argument_types))


def _read(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    packer, data = _data(context, sig.return_type)
    change = builder.inttoptr if isinstance(args[0].type, ir.IntType) else builder.bitcast
    place = change(args[0], data.as_pointer())
    numbers = [builder.load(cgutils.gep_inbounds(builder, place, 0, k)) for k in range(len(data))]
    return packer.from_arguments(builder, tuple(numbers))[0]


contents = _known(lambda pointer: signature(pointer.dtype, pointer), _read)
"""The bundle at an address of this type; without compiling the bundle itself."""


def reader(bundle: Any) -> Callable[..., Any]:
    """A function that returns the bundle, of this type, at an address, a whole number; see `contents`."""
    return _known(lambda _: signature(bundle, types.int64), _read)


def writer(roles: Mapping[int, Role] | None = None, only: Any = None) -> Callable[..., Any]:
    """A function (bundle, row, space): writes the bundle's data to space (`SPACE`,), and addresses to a row.

    They are that of the data, in column 0, and those of the kernels of the roles in which the bundle has one, by
    column. only : the type that a bundle must have.
    """

    def lower(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        bundle = sig.args[0]
        packer, data = _data(context, bundle)
        if len(data) > SPACE:
            raise ValueError(f"{bundle.instance_class.__name__} has {len(data)} numbers, must have at most {SPACE}")
        row, space = (
            context.make_array(kind)(context, builder, each) for kind, each in zip(sig.args[1:], args[1:], strict=True)
        )
        place = builder.bitcast(space.data, data.as_pointer())
        for k, number in enumerate(packer.as_arguments(builder, [args[0]])):
            builder.store(number, cgutils.gep_inbounds(builder, place, 0, k))
        found = {0: place}
        for k, role in (roles or {}).items():
            if role.generic.kernels[bundle.instance_class] is not None:
                arguments = types.CPointer(bundle), *[types.int64] * (role.kernel.py_func.__code__.co_argcount - 1)
                found[k] = address(context, builder, role.kernel, arguments, role.returned)
        for k, pointer in found.items():
            slot = cgutils.gep(builder, row.data, k)
            builder.store(builder.ptrtoint(pointer, slot.type.pointee), slot)
        return context.get_dummy_value()

    return _known(lambda *args: signature(types.none, *args) if only in (None, args[0]) else None, lower)
