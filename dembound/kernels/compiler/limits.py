"""Limits of contacts and bonds, the same for all, by type of contact or by bond, see laws/."""

from typing import Any

from llvmlite import ir  # type: ignore[import-untyped]
from numba import types
from numba.core.imputils import lower_builtin
from numba.core.typing.templates import AbstractTemplate, infer_global, signature

from dembound.kernels.compiler.lanes import LANES, gathered, indices, lanes, load
from dembound.pairwise import limit_of


@infer_global(limit_of)
class _Typing(AbstractTemplate):
    def generic(self, args: Any, kws: Any) -> Any:
        of_eight = isinstance(args[0], types.Array) and args[1] == indices
        return signature(lanes if of_eight else types.float64, *args)


@lower_builtin(limit_of, types.Any, types.Any)
def _limit_of(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    limit, contact_type = args
    if not isinstance(sig.args[0], types.Array):
        return limit
    column = context.make_array(sig.args[0])(context, builder, limit)
    if sig.args[1] == indices:
        return gathered(builder, column.data, contact_type)
    return builder.load(builder.gep(column.data, [contact_type]))


def factor_of(factor: Any, c: Any) -> Any:
    """The factor of the strengths of the bond of pair c, see laws/; compiled code for a number is 1.0."""
    return factor if isinstance(factor, float) else factor[c]


def factors_of(factor: Any, c: Any) -> Any:
    """The factors of eight pairs in lanes; compiled code for a number is 1.0, see `factor_of`."""
    return factor if isinstance(factor, float) else load(factor, c)


def _is_factor(function: Any, of_column: Any, loaded: Any) -> None:
    """Replace a function in compiled code: 1.0 for numbers, and for columns what `loaded` reads from a place."""

    class Typing(AbstractTemplate):
        def generic(self, args: Any, kws: Any) -> Any:
            return signature(of_column if isinstance(args[0], types.Array) else types.float64, *args)

    def lower(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        if not isinstance(sig.args[0], types.Array):
            return context.get_constant(types.float64, 1.0)
        column = context.make_array(sig.args[0])(context, builder, args[0])
        if sig.args[1] == indices:
            return gathered(builder, column.data, args[1])
        return loaded(builder, builder.gep(column.data, [args[1]]))

    infer_global(function)(Typing)
    lower_builtin(function, types.Any, types.Any)(lower)


_is_factor(factor_of, types.float64, lambda builder, place: builder.load(place))
_is_factor(
    factors_of,
    lanes,
    lambda builder, place: builder.load(
        builder.bitcast(place, ir.VectorType(ir.DoubleType(), LANES).as_pointer()), align=8
    ),
)
