"""Methods for bars: each file holds one method's TOML table, how its bonds begin, and how they answer stretch.

A new method is one file and its class's name in the list below; another package registers its own under the entry point
group ``dembound.methods``.
"""

from typing import TYPE_CHECKING

from dembound.methods.finite_difference import FiniteDifference
from dembound.methods.method import Method
from dembound.methods.patch import Patch
from dembound.methods.peridynamics import Peridynamics
from dembound.methods.switch import Switch
from dembound.table import one_of, with_registered

TYPES = with_registered("dembound.methods", Method, (FiniteDifference, Peridynamics, Switch, Patch))
"""All methods."""

if TYPE_CHECKING:
    MethodTable = Method
else:
    MethodTable = one_of("type", TYPES)

__all__ = ["TYPES", "FiniteDifference", "Method", "MethodTable", "Patch", "Peridynamics", "Switch"]
