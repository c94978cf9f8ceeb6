"""A law of another package with functions of its own, which become part of the kernels of contacts."""

from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from dembound.laws import Law, Moduli, Springs
from dembound.laws.law import Key
from dembound.pairwise import PLACE, Column, index, is_pair_law, magnitude


class Point(NamedTuple):
    """Limits of tips: none but the geometry."""

    geometry: int
    factor: float = 1.0


@dataclass(frozen=True)
class Sharp(Moduli):
    """The constant of tips, Pa."""

    tip: float = 0.0


class Tips(Law):
    """Disks with sharp tips and no friction, N = q a²: a law with its own key, constant, limits and functions."""

    name: ClassVar[str] = "tips"
    columns = (*PLACE, Column("tip", "N/m²", "force over the square of the overlap", in_half=0.5))
    has_history: ClassVar[bool] = True
    starts_elastic: ClassVar[bool] = False
    linear = "elastic"
    strengths = ()
    keys = (Key("tip", "Pa", "modulus", "force of a contact over the square of its overlap", {"gt": 0.0}),)
    uses = ("density", "law", "fric")

    def moduli(self, given):
        """The constant beside the moduli."""
        return Sharp(given.tip, 0.0, tip=given.tip)

    def limits(self, strength):
        """The geometry alone."""
        return Point(strength.geometry)

    def without_limits(self, geometry):
        """The same."""
        return Point(geometry)

    def springs(self, moduli, radius_i, radius_j):
        """None without pressure."""
        return self.springs_at(moduli, radius_i, radius_j, np.zeros(np.shape(radius_i)))

    def springs_at(self, moduli, radius_i, radius_j, overlap):
        """2qa."""
        nothing = 0.0 * overlap
        return Springs(2.0 * moduli.tip * overlap, nothing, nothing, nothing, nothing, nothing + 1.0, nothing + 1.0)

    def own_constants(self, moduli, radius_i, radius_j, acts, *, bonded):
        """Q."""
        return np.where(acts, moduli.tip, 0.0)[:, None]


TIPS = index(Tips.columns)


def acts(limits, constants, k):
    """Pairs with a tip."""
    return constants[k, TIPS.tip] > 0.0


def normal(limits, constants, k, overlap):
    """Q a|a|."""
    return constants[k, TIPS.tip] * (overlap * magnitude(overlap))


def stored_between(limits, constants, k, before, now):
    """q(a₂³ − a₁³)/3."""
    return constants[k, TIPS.tip] * (now * now * now - before * before * before) / 3.0


def shear_of(limits, constants, k, overlap, shear, slip):
    """None."""
    return 0.0 * shear


def slip_at(limits, constants, k, overlap, shear, force):
    """All of the motion."""
    return shear


def most_shear(limits, kind, push):
    """None."""
    return 0.0 * push


def contact_energy(limits, constants, k, overlap, slid):
    """qa³/3."""
    return constants[k, TIPS.tip] * overlap * overlap * overlap / 3.0


is_pair_law(
    Point,
    acts=acts,
    normal=normal,
    stored_between=stored_between,
    shear_of=shear_of,
    slip_at=slip_at,
    most_shear=most_shear,
    contact_energy=contact_energy,
)
