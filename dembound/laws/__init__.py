"""Bond laws of disks: the forces of contacts.

A new law is one file and its class's name in `TYPES`; another package registers its own, see casefile/types.py.
"""

from dembound.laws.elastic import Elastic
from dembound.laws.hertz import Hertz
from dembound.laws.law import Law, Moduli, Springs, Stiffness, lattice_moduli
from dembound.laws.linearpbond import LinearPBond

TYPES: tuple[type[Law], ...] = (Elastic, LinearPBond, Hertz)
"""All laws."""

__all__ = ["TYPES", "Elastic", "Hertz", "Law", "LinearPBond", "Moduli", "Springs", "Stiffness", "lattice_moduli"]
