"""The figures of two papers, each drawn as printed from its own runs, with its numbers beside the printed ones.

A paper is a table of figures, `Figure`, which the command ``paper`` lists and draws.
"""

from dembound.papers import lu2016, zhou2018
from dembound.papers.figure import Figure, Paper, Row, Work

__all__ = ["PAPERS", "Figure", "Paper", "Row", "Work"]

PAPERS: dict[str, Paper] = {"zhou2018": zhou2018.PAPER, "lu2016": lu2016.PAPER}
"""The papers by the names of their groups of shipped cases."""
