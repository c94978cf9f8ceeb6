"""Rock bars: a scene of nodes in a row, how it is stepped, and what is told of it.

scene: the arrays; engine: the steps; banded: their stability limit; check: what a case would come to; fracture: where
and when a bar came apart; summary and export: a run in numbers and for ParaView. Methods stand in `dembound.methods`.
"""
