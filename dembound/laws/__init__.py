"""Bond laws: how contacts push. A new law is one file and its name in the list below."""

from dembound.laws.elastic import Moduli, Stiffness, elastic_stiffness
from dembound.laws.linearpbond import pair_lines
from dembound.laws.moduli import lattice_moduli

LAWS = {"elastic": elastic_stiffness, "linearpbond": elastic_stiffness}
"""Law name in a case file -> stiffness of its contacts at rest."""

__all__ = ["LAWS", "Moduli", "Stiffness", "elastic_stiffness", "lattice_moduli", "pair_lines"]
