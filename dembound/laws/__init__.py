"""Bond laws of disks: how contacts push.

A new law is one file and its class's name in the list below; another package registers its own under the entry point
group ``dembound.laws``.
"""

from dembound.laws.elastic import Elastic
from dembound.laws.law import Law, Moduli, Springs, Stiffness
from dembound.laws.linearpbond import LinearPBond
from dembound.laws.moduli import lattice_moduli
from dembound.table import with_registered

LAWS: dict[str, Law] = {law.name: law() for law in with_registered("dembound.laws", Law, (Elastic, LinearPBond))}
"""Name in a case file -> law."""

__all__ = ["LAWS", "Elastic", "Law", "LinearPBond", "Moduli", "Springs", "Stiffness", "lattice_moduli"]
