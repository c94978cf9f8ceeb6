"""Rock bars: nodes in a row, their time stepping, and reports about them.

body: the arrays; layers: what absorbs beyond the ends; scene: the scene and its part, which is stepped; stability: the
time step; fracture: place and time of spalls. Methods are in `dembound.methods`.
"""
