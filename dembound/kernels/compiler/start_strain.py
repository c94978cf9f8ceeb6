"""The strain that pairs have from the start, under a stress at rest.

Without one, compiled code of listed pairs does not read it, and is compiled once for bodies with and without. Code of
pairs in rows, where each step counts, has nothing of it.
"""

from typing import Any

import numpy as np
from llvmlite import ir  # type: ignore[import-untyped]
from numba import types
from numba.core.imputils import lower_builtin
from numba.core.typing.templates import AbstractTemplate, infer_global, signature

from dembound.kernels.compiler.lane_access import gathered_rows
from dembound.kernels.compiler.lanes import indices, lanes
from dembound.pairwise import STRAIN

NONE = np.zeros((0, STRAIN))
"""`Contacts.began` without a stress at rest."""


def began_of(constants: np.ndarray) -> np.ndarray:
    """`Contacts.began` of types of contacts whose constants (p, c + 3) have their strain from the start last."""
    began = constants[:, -STRAIN:]
    return np.ascontiguousarray(began) if began.any() else NONE


def began_of_rows(constants: np.ndarray) -> float | np.ndarray:
    """`PairRows.began` of such types of contacts: 0.0 without a stress at rest."""
    began = began_of(constants)
    return began if len(began) > 0 else 0.0


def began_with(began: Any, contact_type: Any, component: Any) -> Any:
    """Stretch (0) and shear (1) in m or rotation (2) from the start of a type of contact, see `Contacts.began`.

    Where this is a number, compiled code adds nothing.
    """
    return 0.0 if isinstance(began, float) or len(began) == 0 else began[contact_type, component]


@infer_global(began_with)
class _Typing(AbstractTemplate):
    def generic(self, args: Any, kws: Any) -> Any:
        of_eight = isinstance(args[0], types.Array) and args[1] == indices
        return signature(lanes if of_eight else types.float64, *args)


@lower_builtin(began_with, types.Any, types.Any, types.Any)
def _began_with(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    began, contact_type, component = args
    if not isinstance(sig.args[0], types.Array):
        return context.get_constant(types.float64, 0.0)
    column = context.make_array(sig.args[0])(context, builder, began)
    kind, before, rows = context.get_value_type(sig.return_type), builder.block, builder.extract_value(column.shape, 0)
    with builder.if_then(builder.icmp_unsigned("!=", rows, ir.Constant(rows.type, 0)), likely=False):
        if sig.args[1] == indices:
            there = gathered_rows(builder, column.data, contact_type, component, column.shape)
        else:
            place = builder.add(builder.mul(contact_type, ir.Constant(contact_type.type, STRAIN)), component)
            there = builder.load(builder.gep(column.data, [place]))
        after = builder.block
    found = builder.phi(kind)
    found.add_incoming(ir.Constant(kind, None), before)
    found.add_incoming(there, after)
    return found
