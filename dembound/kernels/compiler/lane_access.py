"""Lanes in arrays: read, written, and multiplied by a matrix, one after the other or at eight indices.

Slots that are not one after the other are given by eight indices, `i = load(first, c)` of an array of uint32, in place
of the first slot: functions with `at`, and a row of constants (`constants[k, column]`), take either.
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

from dembound.kernels.compiler.lanes import (
    BITS,
    DOUBLES,
    FLAGS,
    INDICES,
    LANES,
    bits,
    compiled_as,
    indices,
    lanes,
    mask,
    widened,
)

_INDEX, _BYTES = ir.IntType(64), ir.VectorType(ir.IntType(8), LANES)

At = Any
"""The first of eight indices one after the other, or eight indices (8,)."""


def _all_of(at: At) -> np.ndarray:
    """The eight indices."""
    return at if isinstance(at, np.ndarray) else int(at) + np.arange(LANES)


def load(array: np.ndarray, at: At) -> np.ndarray:
    """Eight doubles of a contiguous array (n,), or indices from one of uint32."""
    return array[_all_of(at)]


def load_of(table: np.ndarray, row: int, at: At) -> np.ndarray:
    """Eight doubles of a row of a contiguous array (m, n)."""
    return load(table[int(row)], at)


def fetch(array: np.ndarray, at: int) -> None:
    """Ask for eight doubles of a contiguous array (n,), or beyond its end, that are soon loaded; changes nothing."""


def store(array: np.ndarray, i: int, values: np.ndarray) -> None:
    """Write eight doubles to a contiguous array (n,) from index i on."""
    array[_all_of(i)] = values


def store_of(table: np.ndarray, row: int, i: int, values: np.ndarray) -> None:
    """Write eight doubles to a row of a contiguous array (m, n) from index i on."""
    store(table[int(row)], i, values)


def store_some(array: np.ndarray, at: At, values: np.ndarray, chosen: int) -> None:
    """Write those of eight doubles whose bit is set in the byte `chosen` to a contiguous array (n,)."""
    array[_all_of(at)[bits(chosen)]] = np.broadcast_to(values, LANES)[bits(chosen)]


def store_some_of(table: np.ndarray, row: int, at: At, values: np.ndarray, chosen: int) -> None:
    """Write those of eight doubles whose bit is set in the byte `chosen` to a row of a contiguous array (m, n)."""
    store_some(table[int(row)], at, values, chosen)


def nth(at: At, k: int) -> int:
    """The index in lane k."""
    return int(_all_of(at)[int(k)])


def where_equal(array: np.ndarray, at: At, value: int) -> np.ndarray:
    """Mask of eight bytes of a contiguous array (n,) that equal a value."""
    return array[_all_of(at)] == value


def note_some(array: np.ndarray, at: At, ones: int, twos: int, chosen: int) -> None:
    """Write those of eight bytes whose bit is set in `chosen` to an array (n,): 1 or 2 as in these bytes, else 0."""
    array[_all_of(at)[bits(chosen)]] = (bits(ones) + 2 * bits(twos).astype(np.uint8))[bits(chosen)]


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


_numbers = types.UniTuple(types.float64, 1)  # of any length
_table = types.Array(types.float64, 2, "C")
_array, _bytes = types.Array(types.float64, 1, "C"), types.Array(types.uint8, 1, "C")
_numbers_of_slots = types.Array(types.uint32, 1, "C")


def _place(builder: Any, first: Any, i: Any, kind: Any) -> Any:
    """Address of the eight values of a kind from index i on."""
    return builder.bitcast(builder.gep(first, [i]), kind.as_pointer())


def _places(builder: Any, first: Any, at: Any) -> Any:
    """Addresses of values at eight indices."""
    size = ir.Constant(INDICES, [_SIZES[str(first.type.pointee)]] * LANES)
    begin = widened(builder, builder.ptrtoint(first, _INDEX))
    return builder.inttoptr(builder.add(begin, builder.mul(at, size)), ir.VectorType(first.type, LANES))


_SIZES = {"double": 8, "i32": 4, "i8": 1}


def _call(builder: Any, name: str, returned: Any, *values: Any) -> Any:
    """Call of an LLVM intrinsic for vectors."""
    signed = ir.FunctionType(returned, [value.type for value in values])
    return builder.call(cgutils.get_or_insert_function(builder.module, signed, f"llvm.masked.{name}"), values)


_ALIGN, _EVERYWHERE = ir.Constant(ir.IntType(32), 1), ir.Constant(BITS, [1] * LANES)


def gathered(builder: Any, first: Any, at: Any) -> Any:
    """Values at eight indices of an array, for code of compiled functions."""
    value = first.type.pointee
    name = {"double": "f64", "i32": "i32", "i8": "i8"}[str(value)]
    kind = ir.VectorType(value, LANES)
    places, others = _places(builder, first, at), ir.Constant(kind, ir.Undefined)
    return _call(builder, f"gather.v{LANES}{name}.v{LANES}p0", kind, places, _ALIGN, _EVERYWHERE, others)


@compiled_as(load, lanes, _array, types.uint64)
def _load(builder: Any, first: Any, i: Any) -> Any:
    return builder.load(_place(builder, first, i, DOUBLES), align=8)


compiled_as(load, lanes, _array, indices)(gathered)


@compiled_as(load, indices, _numbers_of_slots, types.uint64)
def _load_indices(builder: Any, first: Any, i: Any) -> Any:
    kind = ir.VectorType(ir.IntType(32), LANES)
    return builder.zext(builder.load(_place(builder, first, i, kind), align=4), INDICES)


@compiled_as(load, indices, _numbers_of_slots, indices)
def _load_indices_at(builder: Any, first: Any, at: Any) -> Any:
    return builder.zext(gathered(builder, first, at), INDICES)


@compiled_as(fetch, types.void, _array, types.uint64)
def _fetch(builder: Any, first: Any, i: Any) -> None:
    place, word = builder.bitcast(builder.gep(first, [i]), ir.IntType(8).as_pointer()), ir.IntType(32)
    signed = ir.FunctionType(ir.VoidType(), [place.type, word, word, word])
    prefetch = cgutils.get_or_insert_function(builder.module, signed, "llvm.prefetch.p0")
    builder.call(prefetch, [place, word(1), word(3), word(1)])  # to be written, into all caches, data


@compiled_as(store, types.void, _array, types.uint64, lanes)
def _store(builder: Any, first: Any, i: Any, values: Any) -> None:
    builder.store(values, _place(builder, first, i, DOUBLES), align=8)


@compiled_as(store_some, types.void, _array, types.uint64, lanes, types.uint8)
def _store_some(builder: Any, first: Any, i: Any, values: Any, chosen: Any) -> None:
    place, bits = _place(builder, first, i, DOUBLES), builder.bitcast(chosen, BITS)
    _call(builder, f"store.v{LANES}f64.p0", ir.VoidType(), values, place, _ALIGN, bits)


def _scatter(builder: Any, values: Any, first: Any, at: Any, chosen: Any) -> None:
    """Write those of eight values that are chosen."""
    name = {"double": "f64", "i8": "i8"}[str(first.type.pointee)]
    places = _places(builder, first, at)
    _call(builder, f"scatter.v{LANES}{name}.v{LANES}p0", ir.VoidType(), values, places, _ALIGN, chosen)


@compiled_as(store_some, types.void, _array, indices, lanes, types.uint8)
def _store_some_at(builder: Any, first: Any, at: Any, values: Any, chosen: Any) -> None:
    _scatter(builder, values, first, at, builder.bitcast(chosen, BITS))


def _row_of(builder: Any, table: Any, row: Any) -> Any:
    """Address of a row of an array (m, n)."""
    first, shape = table
    return builder.gep(first, [builder.mul(row, builder.extract_value(shape, 1))])


for _kind, _loaded, _some_stored in ((types.uint64, _load, _store_some), (indices, gathered, _store_some_at)):
    compiled_as(load_of, lanes, _table, types.uint64, _kind)(
        lambda builder, table, row, at, of=_loaded: of(builder, _row_of(builder, table, row), at)
    )
    compiled_as(store_some_of, types.void, _table, types.uint64, _kind, lanes, types.uint8)(
        lambda builder, table, row, *more, of=_some_stored: of(builder, _row_of(builder, table, row), *more)
    )


@compiled_as(store_of, types.void, _table, types.uint64, types.uint64, lanes)
def _store_of(builder: Any, table: Any, row: Any, i: Any, values: Any) -> None:
    _store(builder, _row_of(builder, table, row), i, values)


@compiled_as(nth, types.uint64, types.uint64, types.uint64)
def _nth(builder: Any, at: Any, k: Any) -> Any:
    return builder.add(at, k)


@compiled_as(nth, types.uint64, indices, types.uint64)
def _nth_at(builder: Any, at: Any, k: Any) -> Any:
    return builder.extract_element(at, k)


@infer_global(operator.getitem)
class _RowsTyping(AbstractTemplate):
    """Constants of eight pairs: a column of an array (p, c) in eight rows."""

    def generic(self, args: Any, kws: Any) -> Any:
        table, at = args
        if isinstance(table, types.Array) and table.ndim == 2 and at == _ROWS:
            return signature(lanes, table, at)
        return None


_ROWS = types.Tuple((indices, types.uint64))


@lower_builtin(operator.getitem, types.Array, _ROWS)
def _rows(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    table = context.make_array(sig.args[0])(context, builder, args[0])
    rows, column = cgutils.unpack_tuple(builder, args[1])
    return gathered_rows(builder, table.data, rows, column, table.shape)


def gathered_rows(builder: Any, first: Any, rows: Any, column: Any, shape: Any) -> Any:
    """Values of a column in eight rows of a contiguous array of a shape, for code of compiled functions."""
    width = builder.extract_value(shape, 1)
    at = builder.add(builder.mul(rows, widened(builder, width)), widened(builder, column))
    return gathered(builder, first, at)


def _equal(builder: Any, values: Any, value: Any) -> Any:
    return builder.icmp_unsigned("==", values, widened(builder, value))


@compiled_as(where_equal, mask, _bytes, types.uint64, types.uint8)
def _where_equal(builder: Any, first: Any, i: Any, value: Any) -> Any:
    return _equal(builder, builder.load(_place(builder, first, i, _BYTES), align=1), value)


@compiled_as(where_equal, mask, _bytes, indices, types.uint8)
def _where_equal_at(builder: Any, first: Any, at: Any, value: Any) -> Any:
    return _equal(builder, gathered(builder, first, at), value)


def _ones_and_twos(builder: Any, ones: Any, twos: Any) -> Any:
    """Bytes that are 1, 2 or 0."""
    one, two = (builder.zext(builder.bitcast(each, BITS), _BYTES) for each in (ones, twos))
    return builder.add(one, builder.add(two, two))


@compiled_as(note_some, types.void, _bytes, types.uint64, types.uint8, types.uint8, types.uint8)
def _note_some(builder: Any, first: Any, i: Any, ones: Any, twos: Any, chosen: Any) -> None:
    place = _place(builder, first, i, _BYTES)
    values, old = _ones_and_twos(builder, ones, twos), builder.load(place, align=1)
    builder.store(builder.select(builder.bitcast(chosen, BITS), values, old), place, align=1)


@compiled_as(note_some, types.void, _bytes, indices, types.uint8, types.uint8, types.uint8)
def _note_some_at(builder: Any, first: Any, at: Any, ones: Any, twos: Any, chosen: Any) -> None:
    _scatter(builder, _ones_and_twos(builder, ones, twos), first, at, builder.bitcast(chosen, BITS))


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
                product = builder.fmul(widened(builder, entry), term, flags=FLAGS)
                total = product if total is None else builder.fadd(total, product, flags=FLAGS)
            results.append(total)
        for place, total in zip(places, results, strict=True):
            _store(builder, found, place, total)

    return generate


for _function, _adds in ((combine, False), (combine_more, True)):
    compiled_as(_function, types.void, _numbers, _array, _array, types.uint64, _array, types.uint64, types.uint64)(
        _combination(_adds)
    )
