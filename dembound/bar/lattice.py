"""The infinite row of nodes with the bonds of the inside of a bar."""

import math
from collections.abc import Iterable, Iterator
from itertools import product

from dembound.bar.scene import BarScene
from dembound.exact.dispersion import Lattice, usual_shares
from dembound.methods.bonds import Bonds
from dembound.methods.rod import Range

DIGITS = 12
"""Digits of the share of stress that bonds of one length carry; further digits are rounding errors."""


def lattice_of(bonds: Bonds, part: Range, time_step: float) -> Lattice:
    """The infinite row of nodes with the bonds of the middle of a range; time_step s."""
    shares = tuple(round(share, DIGITS) for share in bonds.shares(part))
    horizon = len(shares)
    usual = shares == tuple(round(share, DIGITS) for share in usual_shares(horizon))
    return Lattice(horizon, part.spacing, time_step, part.speed, None if usual else shares)


def even_lattices(stages: Iterable[Bonds], ranges: Iterable[Range], time_step: float) -> Iterator[Lattice]:
    """The infinite rows of all stages of a method in all ranges; time_step s.

    Stages in which a zone of other bonds ends in the middle of a range are left out, as the row is not uniform there.
    """
    for bonds, part in product(stages, ranges):
        if math.isclose(sum(bonds.shares(part)), 1.0, rel_tol=10.0**-DIGITS):
            yield lattice_of(bonds, part, time_step)


def carrying_lattices(scene: BarScene, time_step: float) -> list[Lattice]:
    """For every range the infinite row of nodes in which waves run before the method reacts; time_step s."""
    bonds = scene.case.method.begin(scene.rod)
    return [lattice_of(bonds, part, time_step) for part in scene.rod.ranges]
