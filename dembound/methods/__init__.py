"""Methods for bars: each file holds one method's TOML table, how its bonds begin, and how they answer stretch.

A new method is one file and its class's name in the list below.
"""

from typing import Annotated

from pydantic import Field

from dembound.methods.finite_difference import FiniteDifference
from dembound.methods.method import Method
from dembound.methods.patch import Patch
from dembound.methods.peridynamics import Peridynamics
from dembound.methods.switch import Switch

MethodTable = Annotated[FiniteDifference | Peridynamics | Switch | Patch, Field(discriminator="type")]
"""Any ``[method]`` table of a case file, told apart by its ``type``."""

__all__ = ["FiniteDifference", "Method", "MethodTable", "Patch", "Peridynamics", "Switch"]
