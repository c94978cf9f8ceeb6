"""Methods for bars: each file contains the TOML table of one method, and creates and changes its bonds.

A new method is one file and its class's name in `TYPES`; another package registers its own, see casefile/types.py.
"""

from dembound.methods.finite_difference import FiniteDifference
from dembound.methods.method import Method
from dembound.methods.patch import Patch
from dembound.methods.peridynamics import Peridynamics
from dembound.methods.switch import Switch

TYPES = (FiniteDifference, Peridynamics, Switch, Patch)
"""All methods."""

__all__ = ["TYPES", "FiniteDifference", "Method", "Patch", "Peridynamics", "Switch"]
