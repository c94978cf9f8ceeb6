"""Bundles, named tuples of arrays (tables/), by their addresses, so that the loop is the same for all types.

`Written` holds the numbers of a bundle in RAM. Compiled code takes the address, of type `At`, in place of the
bundle: every attribute that it reads is loaded where it is used. As named tuples all arrays would be taken apart and
put together again in each function that passes them on, which takes a third to a half of the time of compiling.
"""

import ctypes
from collections.abc import Callable
from itertools import accumulate
from typing import Any, NamedTuple

import numpy as np
from llvmlite import ir  # type: ignore[import-untyped]
from numba import _helperlib, typeof, types
from numba.core import cgutils
from numba.core.imputils import lower_builtin
from numba.core.typing.templates import AbstractTemplate, AttributeTemplate, infer_getattr, infer_global, signature
from numba.extending import NativeValue, lower_getattr_generic, models, register_model, typeof_impl, unbox
from numba.np.arrayobj import populate_array

from dembound.kernels import tables
from dembound.kernels.compiler.separate import call_at

_NUMBER = ir.IntType(64)

_HEAD = 4
"""Numbers of an array, as numba writes it, before its address: owners, count and size of its numbers."""


class Role(NamedTuple):
    """A function that the loop calls for a bundle: generic, through a kernel that takes the bundle's address first."""

    generic: Any
    kernel: Any
    returned: Any = types.none


class At(types.Type):
    """The address of a bundle of numba type `bundle`; compiled code reads its fields as attributes."""

    def __init__(self, bundle: Any) -> None:
        self.bundle = bundle
        super().__init__(f"at({bundle})")

    @property
    def mangling_args(self) -> tuple[str, tuple[Any, ...]]:
        """A short name within the names of compiled functions, which also have a number."""
        return f"at{self.instance_class.__name__}", ()

    @property
    def instance_class(self) -> type:
        """The class of the bundle, by which kernels are chosen (law.py)."""
        found: type = self.bundle.instance_class
        return found


@register_model(At)
class _AddressModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, cgutils.voidptr_t)


@infer_getattr
class _Fields(AttributeTemplate):
    key = At

    def generic_resolve(self, at: Any, name: str) -> Any:  # type: ignore[override]  # declared as not implemented
        bundle = at.bundle
        kind = bundle.types[bundle.fields.index(name)] if name in bundle.fields else None
        return At(kind) if isinstance(kind, types.BaseNamedTuple) else kind


def kind_of(value: Any) -> Any:
    """The numba type of a bundle with all it contains, or of another value."""
    if not hasattr(value, "_fields"):
        return typeof(value)
    return types.BaseTuple.from_types(tuple(map(kind_of, value)), type(value))


def kinds_of_parts(bundle: Any) -> tuple[Any, ...]:
    """A key that determines the numba type of a bundle, and is faster to compute and compare."""
    return tuple(map(_kind_of_part, _parts(bundle)))


def _kind_of_part(part: Any) -> Any:
    """A key that determines the numba type of a part of a bundle, see `_parts`."""
    if not isinstance(part, np.ndarray):
        return part if isinstance(part, type) else type(part)
    return part.dtype, part.ndim, part.flags.c_contiguous, part.flags.f_contiguous, part.flags.writeable


def _parts_of(kind: Any) -> list[Any] | None:
    """The types in a tuple; None for other types."""
    is_tuple = isinstance(kind, types.BaseTuple)
    return list(kind.types) if is_tuple else None


def _count(kind: Any) -> int:
    """Number of 8-byte words of a value of this type; of an array `_HEAD` words, address, shape and strides."""
    if isinstance(kind, types.Array):
        return _HEAD + 1 + 2 * int(kind.ndim)
    parts = _parts_of(kind)
    return 1 if parts is None else sum(map(_count, parts))


_adapt = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.py_object, ctypes.c_void_p)(_helperlib.c_helpers["adapt_ndarray"])  # type: ignore[attr-defined]


def _put(part: Any, numbers: np.ndarray, first: int, address: int) -> None:
    """Write a part of a bundle to numbers (k,) at an address, from number `first` on; of floats their bits."""
    if isinstance(part, np.ndarray):
        _adapt(part, address + 8 * first)
    elif isinstance(part, float | np.floating):
        numbers[first : first + 1].view(np.float64)[0] = part
    elif not isinstance(part, type):
        numbers[first] = part


def _parts(bundle: Any) -> list[Any]:
    """The arrays and numbers of a bundle in order, each named tuple's class before them."""
    parts = [type(bundle)]
    for each in bundle:
        if isinstance(each, tuple):
            parts += _parts(each)
        else:
            parts.append(each)
    return parts


def _size(part: Any) -> int:
    """Number of words of a part of a bundle, see `_count`."""
    if isinstance(part, np.ndarray):
        return _HEAD + 1 + 2 * part.ndim
    return 0 if isinstance(part, type) else 1


class Written:
    """The words of a bundle in RAM, to whose address `At` refers, and its arrays, which have to be kept.

    Attributes
    ----------
    numbers : (k,) int64. address : of these.
    """

    def __init__(self, bundle: NamedTuple) -> None:
        self._bundle, self._parts = bundle, _parts(bundle)
        self._first = list(accumulate(map(_size, self._parts), initial=0))
        self.numbers = np.zeros(self._first.pop(), dtype=np.int64)
        self.address = int(self.numbers.ctypes.data)
        for part, first in zip(self._parts, self._first, strict=True):
            _put(part, self.numbers, first, self.address)

    def takes(self, bundle: NamedTuple) -> bool:
        """Write the changes of another bundle over this one; False, without writing, if its type differs."""
        if bundle is self._bundle:
            return True
        parts = _parts(bundle)
        if len(parts) != len(self._parts):
            return False
        changed = [k for k, (part, other) in enumerate(zip(parts, self._parts, strict=True)) if part is not other]
        if any(isinstance(parts[k], type) or _kind_of_part(parts[k]) != _kind_of_part(self._parts[k]) for k in changed):
            return False
        for k in changed:
            _put(parts[k], self.numbers, self._first[k], self.address)
        self._bundle, self._parts = bundle, parts
        return True


@unbox(At)
def _unboxed(kind: Any, bundle: Any, c: Any) -> Any:
    """Write a bundle with which a kernel is called from Python, for as long as the call lasts."""
    space = cgutils.alloca_once(c.builder, ir.ArrayType(_NUMBER, _count(kind.bundle)))
    _write(c, kind.bundle, bundle, c.builder.bitcast(space, _NUMBER.as_pointer()))
    address = c.builder.bitcast(space, cgutils.voidptr_t)
    # what is written must not be moved behind what is read, which is marked as never written (`_load`)
    passed = ir.FunctionType(address.type, [address.type])
    return NativeValue(c.builder.asm(passed, "", "=r,0,~{memory}", [address], True))


def _write(c: Any, kind: Any, value: Any, place: Any) -> None:
    """Write the code that writes an object of Python, known to be of this type, as `_put` does."""
    parts = _parts_of(kind)
    if parts is not None:
        first = 0
        for k, each in enumerate(parts):
            _write(c, each, c.pyapi.tuple_getitem(value, k), c.builder.gep(place, [_NUMBER(first)]))
            first += _count(each)
    elif isinstance(kind, types.Array):
        kinds = ir.FunctionType(ir.IntType(32), [value.type, cgutils.voidptr_t])
        adapt = cgutils.get_or_insert_function(c.builder.module, kinds, "numba_adapt_ndarray")
        c.builder.call(adapt, [value, c.builder.bitcast(place, cgutils.voidptr_t)])
    elif isinstance(kind, types.Float):
        c.builder.store(c.builder.bitcast(c.pyapi.float_as_double(value), _NUMBER), place)
    elif isinstance(kind, types.Boolean):
        c.builder.store(c.builder.zext(c.pyapi.object_istrue(value), _NUMBER), place)
    else:
        c.builder.store(c.pyapi.long_as_longlong(value), place)


def passed_by_address(kind: type) -> None:
    """Have kernels that are called from Python take bundles of a type by their address, as those that the loop calls.

    So each kernel is compiled once for both.
    """
    typeof_impl.register(kind)(lambda bundle, _: At(kind_of(bundle)))


for _class in vars(tables).values():
    if isinstance(_class, type) and issubclass(_class, tuple):
        passed_by_address(_class)


def _loaded(context: Any, builder: Any, kind: Any, place: Any) -> Any:
    """The value of a type whose numbers begin at a place; it does not change while compiled code runs."""
    if isinstance(kind, types.Array):
        data, *others = (_load(builder, builder.gep(place, [_NUMBER(k)])) for k in range(_HEAD, _count(kind)))
        shape, strides = others[: kind.ndim], others[kind.ndim :]
        array = context.make_array(kind)(context, builder)
        pointer = builder.inttoptr(data, array.data.type)
        item = context.get_constant(types.intp, context.get_abi_sizeof(context.get_data_type(kind.dtype)))
        populate_array(array, data=pointer, shape=shape, strides=strides, itemsize=item, meminfo=None)
        return array._getvalue()
    parts = _parts_of(kind)
    if parts is not None:
        values, first = [], 0
        for each in parts:
            values.append(_loaded(context, builder, each, builder.gep(place, [_NUMBER(first)])))
            first += _count(each)
        return context.make_tuple(builder, kind, values)
    wanted, number = context.get_value_type(kind), _load(builder, place)
    if isinstance(wanted, ir.DoubleType):
        return builder.bitcast(number, wanted)
    return number if wanted.width == _NUMBER.width else builder.trunc(number, wanted)


def _load(builder: Any, place: Any) -> Any:
    number = builder.load(place)
    number.set_metadata("invariant.load", builder.module.add_metadata([]))
    return number


@lower_getattr_generic(At)
def _field(context: Any, builder: Any, at: Any, address: Any, name: str) -> Any:
    bundle = at.bundle
    index = bundle.fields.index(name)
    first = sum(_count(each) for each in bundle.types[:index])
    place = builder.gep(builder.bitcast(address, _NUMBER.as_pointer()), [_NUMBER(first)])
    kind = bundle.types[index]
    if isinstance(kind, types.BaseNamedTuple):
        return builder.bitcast(place, cgutils.voidptr_t)
    return _loaded(context, builder, kind, place)


def _known(typed: Callable[..., Any], lower: Callable[..., Any]) -> Callable[..., Any]:
    """A function for compiled code: typed by its arguments' types, written by `lower`.

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


def reader(bundle: Any) -> Callable[..., Any]:
    """A function that turns an address, a whole number, into one of a bundle of this type, see `At`."""

    def lower(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        return builder.inttoptr(args[0], cgutils.voidptr_t)

    return _known(lambda _: signature(At(bundle), types.int64), lower)
