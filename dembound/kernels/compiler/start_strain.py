"""The strain that pairs have from the start, under a stress at rest; compiled code without one has nothing of it."""

from typing import Any

import numpy as np
from llvmlite import ir  # type: ignore[import-untyped]
from numba import types
from numba.core.imputils import lower_builtin
from numba.core.typing.templates import AbstractTemplate, infer_global, signature

from dembound.kernels.compiler.lanes import gathered_rows, indices, lanes
from dembound.pairwise import STRAIN


def began_of(constants: np.ndarray) -> float | np.ndarray:
    """`Contacts.began` of types of contacts whose constants (p, c + 3) have their strain from the start last."""
    began = constants[:, -STRAIN:]
    return np.ascontiguousarray(began) if began.any() else 0.0


def began_with(began: Any, contact_type: Any, component: Any) -> Any:
    """Stretch (0) and shear (1) in m or rotation (2) from the start of a type of contact, see `Contacts.began`.

    Where this is a number, compiled code adds nothing.
    """
    return began if isinstance(began, float) else began[contact_type, component]


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
    if sig.args[1] == indices:
        return gathered_rows(builder, column.data, contact_type, component, column.shape)
    place = builder.add(builder.mul(contact_type, ir.Constant(contact_type.type, 3)), component)
    return builder.load(builder.gep(column.data, [place]))
