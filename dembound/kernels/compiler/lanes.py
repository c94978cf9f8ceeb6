"""Lanes: eight numbers that are loaded, computed and stored at once, those of eight copies of a particle.

A kernel with `x = load(u, i)` and `f = k * (load(u, j) - x)` computes for slots i … i + 7 the same as with `u[i]` and
`u[j]` for slot i. The compiler turns each operation into one instruction of AVX-512, two of AVX2 or four of NEON and
SSE2; results are the same bits but for fused multiply-adds, which not all machines have.

Without compiling (NUMBA_DISABLE_JIT=1) the functions below run as Python, on arrays of eight.
"""

import operator
from collections.abc import Callable
from typing import Any

import numpy as np
from llvmlite import ir  # type: ignore[import-untyped]
from numba import types
from numba.core import cgutils
from numba.core.imputils import lower_builtin
from numba.core.typing.templates import AbstractTemplate, infer_global, signature
from numba.extending import models, register_model

from dembound.kernels.common import FASTMATH
from dembound.pairwise import at_most, choose, larger, magnitude, root, with_sign

LANES = 8
"""Slots computed at once."""

_DOUBLES = ir.VectorType(ir.DoubleType(), LANES)
_BITS = ir.VectorType(ir.IntType(1), LANES)
_FLAGS = tuple(sorted(FASTMATH))


class _LanesType(types.Type):
    """Eight doubles."""


class _MaskType(types.Type):
    """Eight truth values."""


lanes, mask = _LanesType("lanes"), _MaskType("lanes mask")


@register_model(_LanesType)
class _LanesModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, _DOUBLES)


@register_model(_MaskType)
class _MaskModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, _BITS)


def load(array: np.ndarray, i: int) -> np.ndarray:
    """The eight doubles of a contiguous array (n,) from index i on."""
    return array[int(i) : int(i) + LANES].copy()


def store(array: np.ndarray, i: int, values: np.ndarray) -> None:
    """Write eight doubles to a contiguous array (n,) from index i on."""
    array[int(i) : int(i) + LANES] = values


def splat(number: float) -> np.ndarray:
    """One number in all lanes."""
    return np.full(LANES, float(number))


def bits(byte: int) -> np.ndarray:
    """The truth values of a byte's bits, the lowest first."""
    return np.unpackbits(np.array([byte], np.uint8), bitorder="little").astype(np.bool_)


def byte_of(chosen: np.ndarray) -> np.uint8:
    """The byte whose bits are these truth values, see `bits`."""
    return np.packbits(chosen, bitorder="little")[0]


def where_equal(array: np.ndarray, i: int, value: int) -> np.ndarray:
    """Mask of the eight bytes of a contiguous array (n,) from index i on that equal a value."""
    return array[int(i) : int(i) + LANES] == value


def note_bits(array: np.ndarray, i: int, chosen: np.ndarray) -> None:
    """Write eight bytes to a contiguous array (n,) from index i on, 1 where chosen, else 0."""
    array[int(i) : int(i) + LANES] = chosen


def lane(values: np.ndarray, k: int) -> float:
    """The number in lane k."""
    return float(values[int(k)])


def combine(
    points: tuple, matrix: np.ndarray, given: np.ndarray, i: int, found: np.ndarray, j: int, stride: int
) -> None:
    """Multiply N groups of eight doubles by a matrix (N·N,), row by row.

    points : N numbers, only used for their count N, which is known when a kernel is compiled. given, found
    : contiguous arrays (n,), in which the groups begin at i, i + stride, … and j, j + stride, …; both may be the same.
    """
    groups = int(stride) * np.arange(len(points))[:, None] + np.arange(LANES)
    found[int(j) + groups] = matrix.reshape(len(points), -1) @ given[int(i) + groups]


def combine_more(
    points: tuple, matrix: np.ndarray, given: np.ndarray, i: int, found: np.ndarray, j: int, stride: int
) -> None:
    """Combine lanes and add the result to `found`."""
    groups = int(stride) * np.arange(len(points))[:, None] + np.arange(LANES)
    found[int(j) + groups] += matrix.reshape(len(points), -1) @ given[int(i) + groups]


def _widened(builder: Any, number: Any) -> Any:
    """A double in all lanes."""
    one = builder.insert_element(ir.Constant(_DOUBLES, ir.Undefined), number, ir.Constant(ir.IntType(32), 0))
    everywhere = ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES)
    return builder.shuffle_vector(one, ir.Constant(_DOUBLES, ir.Undefined), everywhere)


def _compiled(
    function: Any, result: Any, *arguments: Any, number: Callable[..., Any] | None = None
) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Replace a function in compiled kernels by code that a function of (builder, values…) generates.

    arguments : the numba types it takes; for `lanes` a number will do; of arrays the code gets the address of the first
    double. number : the code for single numbers and truth values in place of lanes and masks; None: there is none.
    """

    class Typing(AbstractTemplate):
        def generic(self, args: Any, kws: Any) -> Any:
            if len(args) != len(arguments):
                return None
            if number is not None and _is_single(args, arguments):
                return signature(_SINGLE.get(result, result), *(_SINGLE.get(each, each) for each in arguments))
            alike = all(map(_fits, args, arguments))
            return signature(result, *args) if alike and not _are_numbers(args) else None

    def register(generate: Callable[..., Any]) -> Callable[..., Any]:
        def lower(context: Any, builder: Any, sig: Any, args: Any) -> Any:
            if number is not None and _is_single(sig.args, arguments):
                return number(builder, *args)
            values = []
            for given, wanted, value in zip(sig.args, arguments, args, strict=True):
                if isinstance(given, types.Array):
                    values.append(context.make_array(given)(context, builder, value).data)
                else:
                    values.append(_widened(builder, value) if wanted == lanes and given != lanes else value)
            found = generate(builder, *values)
            return context.get_dummy_value() if result == types.void else found

        infer_global(function)(Typing)
        lower_builtin(function, *[types.Any] * len(arguments))(lower)
        return generate

    return register


_SINGLE = {lanes: types.float64, mask: types.boolean}
"""The types of one pair that take the place of lanes and masks."""


def _is_single(given: Any, wanted: Any) -> bool:
    """Whether types are single numbers and truth values where lanes and masks are wanted; no function has others."""
    kinds = {lanes: types.Number, mask: types.Boolean}
    return all(isinstance(one, kinds[other]) for one, other in zip(given, wanted, strict=True))


def _fits(given: Any, wanted: Any) -> bool:
    """Whether a type can be passed for another one."""
    if wanted == lanes:
        return given == lanes or isinstance(given, types.Float)
    if isinstance(wanted, types.Array):
        return isinstance(given, types.Array) and given.dtype == wanted.dtype and given.ndim == 1
    if isinstance(wanted, types.UniTuple):
        return isinstance(given, types.UniTuple) and given.dtype == wanted.dtype
    return bool(given == wanted)


def _are_numbers(kinds: Any) -> bool:
    """Whether all of several types are numbers, for which numba has arithmetic."""
    return len(kinds) > 1 and all(isinstance(kind, types.Number) for kind in kinds)


def _instruction(function: Any, name: str) -> None:
    """Replace an operator by an LLVM instruction for two lanes."""
    _compiled(function, lanes, lanes, lanes)(lambda builder, a, b: getattr(builder, name)(a, b, flags=_FLAGS))


def _intrinsic(function: Any, name: str, count: int) -> None:
    """Replace a function by an LLVM intrinsic, for lanes and for numbers."""

    def caller(kind: Any, of: str) -> Callable[..., Any]:
        signed = ir.FunctionType(kind, [kind] * count)

        def call(builder: Any, *values: Any) -> Any:
            return builder.call(cgutils.get_or_insert_function(builder.module, signed, f"llvm.{name}.{of}"), values)

        return call

    number = caller(ir.DoubleType(), "f64")
    _compiled(function, lanes, *[lanes] * count, number=number)(caller(_DOUBLES, f"v{LANES}f64"))


_numbers = types.UniTuple(types.float64, 1)  # of any length
_array, _bytes = types.Array(types.float64, 1, "C"), types.Array(types.uint8, 1, "C")

for _operator, _in_place, _name in (
    (operator.add, operator.iadd, "fadd"),
    (operator.sub, operator.isub, "fsub"),
    (operator.mul, operator.imul, "fmul"),
    (operator.truediv, operator.itruediv, "fdiv"),
):
    _instruction(_operator, _name)
    _instruction(_in_place, _name)

_intrinsic(magnitude, "fabs", 1)
_intrinsic(root, "sqrt", 1)
_intrinsic(with_sign, "copysign", 2)


@_compiled(load, lanes, _array, types.uint64)
def _load(builder: Any, first: Any, i: Any) -> Any:
    return builder.load(builder.bitcast(builder.gep(first, [i]), _DOUBLES.as_pointer()), align=8)


@_compiled(store, types.void, _array, types.uint64, lanes)
def _store(builder: Any, first: Any, i: Any, values: Any) -> None:
    builder.store(values, builder.bitcast(builder.gep(first, [i]), _DOUBLES.as_pointer()), align=8)


@_compiled(splat, lanes, types.float64)
def _splat(builder: Any, number: Any) -> Any:
    return _widened(builder, number)


@_compiled(bits, mask, types.uint8)
def _bits(builder: Any, byte: Any) -> Any:
    return builder.bitcast(byte, _BITS)


@_compiled(byte_of, types.uint8, mask)
def _byte_of(builder: Any, chosen: Any) -> Any:
    return builder.bitcast(chosen, ir.IntType(LANES))


@_compiled(where_equal, mask, _bytes, types.uint64, types.uint8)
def _where_equal(builder: Any, first: Any, i: Any, value: Any) -> Any:
    kind = ir.VectorType(ir.IntType(8), LANES)
    values = builder.load(builder.bitcast(builder.gep(first, [i]), kind.as_pointer()), align=1)
    one = builder.insert_element(ir.Constant(kind, ir.Undefined), value, ir.Constant(ir.IntType(32), 0))
    everywhere = ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES)
    return builder.icmp_unsigned("==", values, builder.shuffle_vector(one, ir.Constant(kind, ir.Undefined), everywhere))


@_compiled(note_bits, types.void, _bytes, types.uint64, mask)
def _note_bits(builder: Any, first: Any, i: Any, chosen: Any) -> None:
    kind = ir.VectorType(ir.IntType(8), LANES)
    builder.store(builder.zext(chosen, kind), builder.bitcast(builder.gep(first, [i]), kind.as_pointer()), align=1)


@_compiled(choose, lanes, mask, lanes, lanes, number=lambda builder, *values: builder.select(*values))
def _choose(builder: Any, chosen: Any, values: Any, others: Any) -> Any:
    return builder.select(chosen, values, others)


@_compiled(at_most, mask, lanes, lanes, number=lambda builder, a, b: builder.fcmp_ordered("<=", a, b))
def _at_most(builder: Any, values: Any, limits: Any) -> Any:
    return builder.fcmp_ordered("<=", values, limits)


def _larger_one(builder: Any, value: Any, other: Any) -> Any:
    return builder.select(builder.fcmp_ordered("<=", value, other), other, value)


@_compiled(larger, lanes, lanes, lanes, number=_larger_one)
def _larger(builder: Any, values: Any, others: Any) -> Any:
    return _larger_one(builder, values, others)


@_compiled(lane, types.float64, lanes, types.uint64)
def _lane(builder: Any, values: Any, k: Any) -> Any:
    return builder.extract_element(values, k)


def _strided(builder: Any, first: Any, stride: Any, count: int) -> list[Any]:
    """`count` indices from the first one on, a stride apart."""
    places = [first]
    for _ in range(count - 1):
        places.append(builder.add(places[-1], stride))
    return places


def _combination(adds: bool) -> Callable[..., None]:
    """The code of `combine`, or of `combine_more`: all groups are loaded before any is stored."""

    def generate(builder: Any, points: Any, matrix: Any, given: Any, i: Any, found: Any, j: Any, stride: Any) -> None:
        count = points.type.count
        terms = [_load(builder, given, place) for place in _strided(builder, i, stride, count)]
        places, results = _strided(builder, j, stride, count), []
        for row, place in enumerate(places):
            total = _load(builder, found, place) if adds else None
            for column, term in enumerate(terms):
                entry = builder.load(builder.gep(matrix, [ir.Constant(ir.IntType(64), row * count + column)]))
                product = builder.fmul(_widened(builder, entry), term, flags=_FLAGS)
                total = product if total is None else builder.fadd(total, product, flags=_FLAGS)
            results.append(total)
        for place, total in zip(places, results, strict=True):
            _store(builder, found, place, total)

    return generate


for _function, _adds in ((combine, False), (combine_more, True)):
    _compiled(_function, types.void, _numbers, _array, _array, types.uint64, _array, types.uint64, types.uint64)(
        _combination(_adds)
    )
