"""Lanes: eight numbers that are loaded, computed and stored at once, those of eight copies of a particle.

A kernel with `x = load(u, i)` and `f = k * (load(u, j) - x)`, see lane_access.py, computes for slots i … i + 7 the same
as with `u[i]` and `u[j]` for slot i. The compiler turns each operation into one instruction of AVX-512, two of AVX2 or
four of NEON and SSE2; results are the same bits but for fused multiply-adds, which not all machines have.

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

DOUBLES = ir.VectorType(ir.DoubleType(), LANES)
BITS, INDICES = ir.VectorType(ir.IntType(1), LANES), ir.VectorType(ir.IntType(64), LANES)
FLAGS = tuple(sorted(FASTMATH))


class _LanesType(types.Type):
    """Eight doubles."""


class _MaskType(types.Type):
    """Eight truth values."""


class _IndicesType(types.Type):
    """Eight indices."""


lanes, mask, indices = _LanesType("lanes"), _MaskType("lanes mask"), _IndicesType("lanes indices")


@register_model(_LanesType)
class _LanesModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, DOUBLES)


@register_model(_MaskType)
class _MaskModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, BITS)


@register_model(_IndicesType)
class _IndicesModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, INDICES)


def splat(number: float) -> np.ndarray:
    """One number in all lanes."""
    return np.full(LANES, float(number))


def bits(byte: int) -> np.ndarray:
    """The truth values of a byte's bits, the lowest first."""
    return np.unpackbits(np.array([byte], np.uint8), bitorder="little").astype(np.bool_)


def byte_of(chosen: np.ndarray) -> np.uint8:
    """The byte whose bits are these truth values, see `bits`."""
    return np.packbits(chosen, bitorder="little")[0]


def lane(values: np.ndarray, k: int) -> float:
    """The number in lane k."""
    return float(values[int(k)])


def widened(builder: Any, number: Any) -> Any:
    """A number in all lanes."""
    kind = ir.VectorType(number.type, LANES)
    one = builder.insert_element(ir.Constant(kind, ir.Undefined), number, ir.Constant(ir.IntType(32), 0))
    everywhere = ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES)
    return builder.shuffle_vector(one, ir.Constant(kind, ir.Undefined), everywhere)


def compiled_as(
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
            return signature(result, *args) if alike and not (lanes in arguments and _are_numbers(args)) else None

    def register(generate: Callable[..., Any]) -> Callable[..., Any]:
        def lower(context: Any, builder: Any, sig: Any, args: Any) -> Any:
            if number is not None and _is_single(sig.args, arguments):
                return number(builder, *args)
            values = []
            for given, wanted, value in zip(sig.args, arguments, args, strict=True):
                if isinstance(given, types.Array):
                    array = context.make_array(given)(context, builder, value)
                    values.append(array.data if given.ndim == 1 else (array.data, array.shape))
                else:
                    values.append(widened(builder, value) if wanted == lanes and given != lanes else value)
            found = generate(builder, *values)
            return context.get_dummy_value() if result == types.void else found

        infer_global(function)(Typing)
        variants = _VARIANTS.setdefault(function, [])
        variants.append((arguments, lower))
        lower_builtin(function, *[types.Any] * len(arguments))(_choice_of(variants))
        return generate

    return register


_VARIANTS: dict[Any, list[tuple[Any, Callable[..., Any]]]] = {}
"""Code of each function for different types of arguments."""


def _choice_of(variants: list[tuple[Any, Callable[..., Any]]]) -> Callable[..., Any]:
    """The code of a function, by the types of a call."""

    def lower(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        fitting = [each for arguments, each in variants if all(map(_fits, sig.args, arguments))]
        return (fitting or [variants[0][1]])[0](context, builder, sig, args)

    return lower


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
        return isinstance(given, types.Array) and given.dtype == wanted.dtype and given.ndim == wanted.ndim
    if isinstance(wanted, types.UniTuple):
        return isinstance(given, types.UniTuple) and given.dtype == wanted.dtype
    return bool(given == wanted)


def _are_numbers(kinds: Any) -> bool:
    """Whether all of several types are numbers, for which numba has arithmetic."""
    return len(kinds) > 1 and all(isinstance(kind, types.Number) for kind in kinds)


def _instruction(function: Any, name: str) -> None:
    """Replace an operator by an LLVM instruction for two lanes."""
    compiled_as(function, lanes, lanes, lanes)(lambda builder, a, b: getattr(builder, name)(a, b, flags=FLAGS))


def _intrinsic(function: Any, name: str, count: int) -> None:
    """Replace a function by an LLVM intrinsic, for lanes and for numbers."""

    def caller(kind: Any, of: str) -> Callable[..., Any]:
        signed = ir.FunctionType(kind, [kind] * count)

        def call(builder: Any, *values: Any) -> Any:
            return builder.call(cgutils.get_or_insert_function(builder.module, signed, f"llvm.{name}.{of}"), values)

        return call

    number = caller(ir.DoubleType(), "f64")
    compiled_as(function, lanes, *[lanes] * count, number=number)(caller(DOUBLES, f"v{LANES}f64"))


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


@compiled_as(splat, lanes, types.float64)
def _splat(builder: Any, number: Any) -> Any:
    return widened(builder, number)


@compiled_as(bits, mask, types.uint8)
def _bits(builder: Any, byte: Any) -> Any:
    return builder.bitcast(byte, BITS)


@compiled_as(byte_of, types.uint8, mask)
def _byte_of(builder: Any, chosen: Any) -> Any:
    return builder.bitcast(chosen, ir.IntType(LANES))


@compiled_as(choose, lanes, mask, lanes, lanes, number=lambda builder, *values: builder.select(*values))
def _choose(builder: Any, chosen: Any, values: Any, others: Any) -> Any:
    return builder.select(chosen, values, others)


@compiled_as(at_most, mask, lanes, lanes, number=lambda builder, a, b: builder.fcmp_ordered("<=", a, b))
def _at_most(builder: Any, values: Any, limits: Any) -> Any:
    return builder.fcmp_ordered("<=", values, limits)


def _larger_one(builder: Any, value: Any, other: Any) -> Any:
    return builder.select(builder.fcmp_ordered("<=", value, other), other, value)


@compiled_as(larger, lanes, lanes, lanes, number=_larger_one)
def _larger(builder: Any, values: Any, others: Any) -> Any:
    return _larger_one(builder, values, others)


@compiled_as(lane, types.float64, lanes, types.uint64)
def _lane(builder: Any, values: Any, k: Any) -> Any:
    return builder.extract_element(values, k)
