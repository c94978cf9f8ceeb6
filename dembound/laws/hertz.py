"""Hertz and Mindlin's contact without bonds: stiffness grows with the overlap, as in PFC's and YADE's models.

With the overlap a, N = h a^1.5 and h = 2G√(2R̄)/(3(1 − ν)), 1/R̄ = ½(1/R₁ + 1/R₂), so that k_n = 1.5 h √a; in shear k_s
= k_n 2(1 − ν)/(2 − ν) (K. L. Johnson, Contact Mechanics, 1985, eqs 4.23 and 7.43, in PFC's form). The shear force
grows by k_s times the motion of the surfaces, up to μN. While the overlap grows the force is kept; while it shrinks the
force shrinks with k_s, since a kept force on a softer spring would have more energy than was put in (D. Elata and J. G.
Berryman, Mechanics of Materials 24, 1996). Energy lost so is counted as friction.
"""

from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np

from dembound.laws.law import AnyLimits, Key, Law, Moduli, Springs
from dembound.pairwise import PLACE, Column, at_most, choose, index, is_pair_law, larger, limit_of, root

COLUMNS = (
    *PLACE,
    Column("normal", "N/m^1.5", "normal force over the overlap to the power 1.5", in_half=0.5),
    Column("shear", "N/m^1.5", "stiffness in shear over the root of the overlap", in_half=0.5),
)
"""Constants of a pair."""

K = index(COLUMNS)
"""Numbers of the constants by name."""

TANGENT = 1.5
"""Slope of the normal force over its quotient by the overlap."""

LEAST = 1e-300
"""Overlap (m) that replaces zero in quotients."""


class Friction(NamedTuple):
    """Friction of contacts, a number or a column (p,), and a geometry of kernels/contacts.py; see `Limits`."""

    friction: float | np.ndarray
    geometry: int
    factor: float | np.ndarray = 1.0


@dataclass(frozen=True)
class Elasticity(Moduli):
    """Shear modulus (Pa) and Poisson's ratio of the grains, beside the stiffness of contacts at rest, by PFC's names.

    emod : mean normal stiffness at rest, 0 without pressure.
    """

    hz_shear: float = 0.0
    hz_poiss: float = 0.0


class Hertz(Law):
    """Contacts of elastic grains without bonds."""

    name: ClassVar[str] = "hertz"
    columns = COLUMNS
    has_history: ClassVar[bool] = True
    starts_elastic: ClassVar[bool] = False
    elsewhere = ("hertz_mindlin", "hertzian", "mindlin", "hertz_model")
    keys = (
        Key("hz_shear", "Pa", "modulus", "shear modulus G of the grains", {"gt": 0.0}),
        Key("hz_poiss", "1", "Poisson's ratio", "Poisson's ratio ν of the grains", {"ge": 0.0, "lt": 0.5}),
    )
    strengths = ()
    secant = (1.0 / TANGENT, 1.0)
    uses = ("density", "law", "fric", "damp", "dp_nratio", "dp_sratio")
    help = "contacts of grains, stiffer under pressure, without bonds"

    @property
    def linear(self) -> str:
        """Name of the elastic law, which holds for small motion at rest."""
        return "elastic"

    def moduli(self, given: Any) -> Elasticity:
        """Moduli of a material; bricks are packed for contacts of the grains' shear modulus."""
        shear, poisson = given.hz_shear, given.hz_poiss
        ratio = (2.0 - poisson) / (2.0 * (1.0 - poisson))
        return Elasticity(shear, 0.0, kratio=ratio, fric=given.fric, hz_shear=shear, hz_poiss=poisson)

    def limits(self, strength: AnyLimits) -> Friction:
        """Friction alone."""
        return Friction(strength.friction, strength.geometry)

    def springs(self, moduli: Moduli, radius_i: np.ndarray, radius_j: np.ndarray) -> Springs:
        """Springs of contacts of the mean stiffness at rest."""
        return self.springs_under(moduli, np.full(np.shape(radius_i), moduli.emod))

    def springs_at(self, moduli: Moduli, radius_i: np.ndarray, radius_j: np.ndarray, overlap: np.ndarray) -> Springs:
        """Springs of small motion about overlaps (b,) m."""
        normal, _ = _stiff(moduli, radius_i, radius_j)
        return self.springs_under(moduli, TANGENT * normal * np.sqrt(overlap))

    def springs_under(self, moduli: Moduli, normal: np.ndarray) -> Springs:
        """Springs of contacts of normal stiffnesses (b,) N/m."""
        nothing = np.zeros_like(normal)
        shear = normal / moduli.kratio if moduli.fric > 0.0 else nothing
        return Springs(normal, shear, nothing, nothing, nothing, nothing + 1.0, nothing + 1.0)

    def overlap_of(self, moduli: Moduli, radius_i: np.ndarray, radius_j: np.ndarray, push: np.ndarray) -> np.ndarray:
        """Overlaps (b,) m at which contacts push with forces (b,) N, 0 for pulling ones."""
        normal, _ = _stiff(moduli, radius_i, radius_j)
        found: np.ndarray = (np.maximum(push, 0.0) / normal) ** (2.0 / 3.0)
        return found

    def dashpot_springs(self, constants: np.ndarray) -> np.ndarray:
        """Stiffnesses (p, 2) N/m at an overlap of 1 m, see `viscosity`."""
        return constants[:, [int(K.normal), int(K.shear)]] * [TANGENT, 1.0]

    def own_constants(
        self, moduli: Moduli, radius_i: np.ndarray, radius_j: np.ndarray, acts: np.ndarray, *, bonded: bool
    ) -> np.ndarray:
        """Constants (b, 2) of pairs, in the columns after their place."""
        return np.column_stack([np.where(acts, each, 0.0) for each in _stiff(moduli, radius_i, radius_j)])

    def without_limits(self, geometry: int, *, rolls: bool = False) -> Friction:
        """Limits that no contact reaches."""
        return Friction(0.0, geometry)


def _stiff(moduli: Moduli, radius_i: np.ndarray, radius_j: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """H and k_s/√a (b,) N/m^1.5 of contacts between disks of radii (b,) m."""
    assert isinstance(moduli, Elasticity)
    radius = 2.0 * radius_i * radius_j / (radius_i + radius_j)
    normal = 2.0 * moduli.hz_shear * np.sqrt(2.0 * radius) / (3.0 * (1.0 - moduli.hz_poiss))
    return normal, TANGENT * normal / moduli.kratio * float(moduli.fric > 0.0)


def acts(limits, constants, k):
    """See pair_law.acts."""
    return constants[k, K.normal] > 0.0


def normal(limits, constants, k, overlap):
    """N = h a^1.5, see pair_law.normal."""
    return constants[k, K.normal] * (overlap * root(larger(overlap, 0.0)))


def stored_between(limits, constants, k, before, now):
    """⅖h (a₂^2.5 − a₁^2.5), see pair_law.stored_between."""
    return 0.4 * (constants[k, K.normal] * (now * now * root(now) - before * before * root(before)))


def shear_of(limits, constants, k, overlap, shear, slip):
    """S = k_s (s − slip), see pair_law.shear_of."""
    return constants[k, K.shear] * root(larger(overlap, 0.0)) * (shear - slip)


def slip_at(limits, constants, k, overlap, shear, force):
    """The slip s − S/k_s, see pair_law.slip_at."""
    stiff = constants[k, K.shear] * root(larger(overlap, 0.0))
    return shear - force / larger(stiff, LEAST)


def slips_by_overlap(limits):
    """See pair_law.slips_by_overlap."""
    return True


def slip_after(limits, constants, k, before, now, shear, slip):
    """The slip with which the force stays while the overlap grows; it stays the same otherwise."""
    kept = root(larger(before, 0.0)) / larger(root(larger(now, 0.0)), LEAST)
    return choose(at_most(now, larger(before, 0.0)), slip, shear - (shear - slip) * kept)


def rubbed(limits, constants, k, before, now, was, shear, slip, slid, force, pushed):
    """The work of the force less what the spring has stored, see pair_law.rubbed."""
    stored, left = shear - slid, was - slip
    spring = constants[k, K.shear]
    gained = spring * (root(larger(now, 0.0)) * (stored * stored) - root(larger(before, 0.0)) * (left * left))
    return 0.5 * ((force + pushed) * (shear - was) - gained)


def viscosity(limits, constants, k, overlap):
    """a^¼, as critical damping grows with the root of the stiffness; a in m."""
    return root(root(larger(overlap, 0.0)))


def most_shear(limits, kind, push):
    """Friction, μN, see pair_law.most_shear."""
    return limit_of(limits.friction, kind) * push


def contact_energy(limits, constants, k, overlap, slid):
    """⅖h a^2.5 + ½k_s s², see pair_law.contact_energy."""
    width = root(larger(overlap, 0.0))
    return width * (0.4 * constants[k, K.normal] * overlap * overlap + 0.5 * constants[k, K.shear] * slid * slid)


is_pair_law(
    Friction,
    acts=acts,
    normal=normal,
    stored_between=stored_between,
    shear_of=shear_of,
    slip_at=slip_at,
    slips_by_overlap=slips_by_overlap,
    slip_after=slip_after,
    rubbed=rubbed,
    viscosity=viscosity,
    most_shear=most_shear,
    contact_energy=contact_energy,
)
