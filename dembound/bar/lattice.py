"""The endless row of nodes that a bar is inside, as its bonds stand."""

from dembound.bar.scene import BarScene
from dembound.exact.dispersion import Lattice, usual_shares
from dembound.methods.bonds import Bonds

DIGITS = 12
"""Of the shares of stress that bonds of a length carry: beyond is rounding."""


def lattice_of(bonds: Bonds, time_step: float, wave_speed: float) -> Lattice:
    """The row of nodes in the middle of a bar whose bonds stand like these; time_step s, wave_speed m/s."""
    shares = tuple(round(share, DIGITS) for share in bonds.shares)
    horizon = len(shares)
    usual = shares == tuple(round(share, DIGITS) for share in usual_shares(horizon))
    return Lattice(horizon, bonds.rod.spacing, time_step, wave_speed, None if usual else shares)


def carrying_lattice(scene: BarScene, time_step: float) -> Lattice:
    """The row of nodes that carries waves where nothing is about to break; time_step s."""
    return lattice_of(scene.case.method.begin(scene.rod), time_step, scene.case.bar.speed)
