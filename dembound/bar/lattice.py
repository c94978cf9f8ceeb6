"""The infinite row of nodes with the same bonds as the inside of a bar."""

from dembound.bar.scene import BarScene
from dembound.exact.dispersion import Lattice, usual_shares
from dembound.methods.bonds import Bonds

DIGITS = 12
"""Digits of the share of stress that bonds of one length carry; further digits are rounding errors."""


def lattice_of(bonds: Bonds, time_step: float, wave_speed: float) -> Lattice:
    """The infinite row of nodes with the bonds of the middle of a bar; time_step s, wave_speed m/s."""
    shares = tuple(round(share, DIGITS) for share in bonds.shares)
    horizon = len(shares)
    usual = shares == tuple(round(share, DIGITS) for share in usual_shares(horizon))
    return Lattice(horizon, bonds.rod.spacing, time_step, wave_speed, None if usual else shares)


def carrying_lattice(scene: BarScene, time_step: float) -> Lattice:
    """The infinite row of nodes in which waves run before the method reacts to large stretches; time_step s."""
    return lattice_of(scene.case.method.begin(scene.rod), time_step, scene.case.bar.speed)
