"""Rock bars: nodes in a row, how they are stepped, and what is reported of them.

body and scene: the arrays; part: the steps; banded and stability: their step limit; facts, warnings, summary, outcome,
mesh: reports; fracture: where and when a bar came apart. Methods stand in `dembound.methods`.
"""
