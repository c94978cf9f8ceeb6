"""Rock bars: nodes in a row, their time stepping, and reports about them.

body and scene: the arrays; part: the steps; banded and stability: the limit of the time step; facts, warnings, summary,
outcome, mesh: reports; fracture: place and time of spalls. Methods are in `dembound.methods`.
"""
