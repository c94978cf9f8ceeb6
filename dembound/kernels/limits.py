"""Limits of contacts and bonds, the same for all or by type of contact, see `Limits`."""

from typing import Any

import numpy as np
from numba import types
from numba.core.imputils import lower_builtin
from numba.core.typing.templates import AbstractTemplate, infer_global, signature

from dembound.kernels.tables import Limits


def in_columns(limits: np.ndarray, geometry: int) -> Limits:
    """Limits (p, 4) of rows of constants as columns: friction, tension, cohesion and tan_fa."""
    friction, tension, cohesion, tan_fa = np.ascontiguousarray(limits.T)
    return Limits(friction, tension, cohesion, tan_fa, geometry)


def limit_of(limit: Any, contact_type: Any) -> Any:
    """One of the limits for a type of contact: a number for all types, or its row of a column (p,).

    Compiled code for numbers is the number itself.
    """
    return limit if isinstance(limit, float) else limit[contact_type]


@infer_global(limit_of)
class _Typing(AbstractTemplate):
    def generic(self, args: Any, kws: Any) -> Any:
        return signature(types.float64, *args)


@lower_builtin(limit_of, types.Any, types.Any)
def _limit_of(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    limit, contact_type = args
    if not isinstance(sig.args[0], types.Array):
        return limit
    column = context.make_array(sig.args[0])(context, builder, limit)
    return builder.load(builder.gep(column.data, [contact_type]))
