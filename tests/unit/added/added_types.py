"""Types as another package would add them: laws, a method, boundaries, packings, a wave, a hole."""

from dataclasses import dataclass, replace
from typing import ClassVar, Literal, NamedTuple

import numpy as np

from dembound.boundaries.boundary import Driven
from dembound.boundaries.viscous import Dashpots
from dembound.holes import Hole
from dembound.laws import Elastic, Law, Moduli, Springs
from dembound.laws.law import Key
from dembound.methods import Peridynamics
from dembound.methods.bonds import Bonds
from dembound.packings import Packing
from dembound.packings.brick import Brick
from dembound.pairwise import PLACE, Column, index, is_pair_law, magnitude
from dembound.table import quantity
from dembound.waves.wave import Shape


class Linear(Elastic):
    """The elastic law without moments: bonds resist no bending."""

    name: ClassVar[str] = "linear"

    def springs(self, moduli, radius_i, radius_j):
        """The stiffnesses of the elastic law."""
        springs = super().springs(moduli, radius_i, radius_j)
        return replace(springs, bending=np.zeros_like(springs.bending))


class Brittle(Linear):
    """Bonds break; before that the law without moments holds."""

    name: ClassVar[str] = "brittle"
    has_history: ClassVar[bool] = True
    linear = "linear"


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


class Forgetful(Linear):
    """Bonds break; no linear law is named for the time before."""

    name: ClassVar[str] = "forgetful"
    has_history: ClassVar[bool] = True


class Rubber(Linear):
    """A law that is not linear and names no linear law; its kernel is not used."""

    name: ClassVar[str] = "rubber"
    is_linear: ClassVar[bool] = False


class Cone(Peridynamics):
    """Peridynamics whose micromodulus falls linearly to the horizon and a spacing."""

    type: Literal["cone"]

    def begin(self, rod):
        """Bonds of the whole bar."""
        influence = 1.0 - np.arange(1, self.horizon + 1) / (self.horizon + 1.0)
        bonds = Bonds(rod, self.horizon, complement=self.corrected_ends, influence=influence)
        bonds.add_zone(0, rod.count)
        return bonds


class OtherInput(Dashpots, Driven):
    """Absorbs and lets waves in, as viscous input does."""

    type: Literal["other_input"]

    def support(self, edge, medium, waves, supports):
        """Dashpots, and the force that makes the waves pass."""
        names = self.waves_by_axis(edge.axis)
        for component, damping in enumerate(self.dampings(edge, medium)):
            supports.add(edge.nodes, component, damping=damping)
            if name := names[component]:
                supports.add(edge.nodes, component, drive=2.0 * damping, signal=waves[name].velocity)


class Hexagonal(Packing):
    """Equal disks that touch six neighbours without force; two in a brick."""

    is_lattice: ClassVar[bool] = True
    regular_sides: ClassVar[tuple[str, ...]] = ("bottom", "top")

    pattern: Literal["hexagonal"]

    @property
    def brick_size(self):
        """Size of a brick: one diameter wide, two rows high."""
        return 2.0 * self.radius, 2.0 * np.sqrt(3.0) * self.radius

    def pack(self, contact_modulus):
        """The brick; the contact modulus plays no part."""
        size = np.array(self.brick_size)
        return Brick(
            size=size,
            positions=np.array([0.25 * size, 0.75 * size]),
            radii=np.full(2, self.radius),
            pairs=np.array([[0, 0], [1, 1], [0, 1], [0, 1], [0, 1], [0, 1]]),
            images=np.array([[1, 0], [1, 0], [0, 0], [-1, 0], [0, -1], [-1, -1]]),
            edge_rows=np.zeros((2, 2), bool),
            stress=np.zeros(3),
            residual_ratio=0.0,
        )


class Gauss(Shape):
    """A bell."""

    type: Literal["gauss"]
    width: float = quantity(..., unit="s", help="time in which it falls to 1/e", gt=0.0)

    def _velocity_shape(self, since):
        return np.exp(-((since / self.width - 4.0) ** 2))

    def _displacement_shape(self, since):
        from scipy.special import erf

        return 0.5 * np.sqrt(np.pi) * self.width * (1.0 + erf(since / self.width - 4.0))

    def peak_time(self):
        """The middle."""
        return self.start + 4.0 * self.width

    def duration(self):
        """Twice that."""
        return self.start + 8.0 * self.width

    def dominant_frequency(self):
        """Frequency of a period of four widths."""
        return 0.25 / self.width

    def highest_frequency(self):
        """Frequency at which the bell exp(−π²w²f²) of the spectrum has fallen to 1 %."""
        return float(np.sqrt(np.log(100.0)) / (np.pi * self.width))


class Diamond(Hole):
    """A square on its tip."""

    type: Literal["diamond"]
    centre: tuple[float, float] = quantity(..., unit="m", help="its middle")
    half: float = quantity(..., unit="m", help="half its diagonal", gt=0.0)

    def depth(self, positions):
        """Distances of positions from the lines of its edges, negative outside."""
        return (self.half - np.abs(positions - self.centre).sum(axis=1)) / np.sqrt(2.0)

    def shifted(self, by):
        """The diamond with its middle somewhere else."""
        return self.model_copy(update={"centre": (self.centre[0] + by[0], self.centre[1] + by[1])})

    @property
    def box(self):
        """The square around it."""
        (x, y), h = self.centre, self.half
        return x - h, y - h, x + h, y + h


class LateInput(OtherInput):
    """Lets waves in so late that a calibration's pass is over before."""

    type: Literal["late_input"]

    def support(self, edge, medium, waves, supports):
        """Add the rows of the base, with waves that come 10 s later."""
        super().support(edge, medium, {name: _Later(wave) for name, wave in waves.items()}, supports)


class _Later:
    """A wave 10 s later."""

    def __init__(self, wave):
        self.wave = wave

    def velocity(self, t):
        """Velocity of the wave 10 s earlier."""
        return self.wave.velocity(t - 10.0)


class Namesake(Elastic):
    """Stiffer than the elastic law, with the same name by mistake."""


class Nameless(Shape):
    """A wave without a literal type, and without formulas."""


class Stranger:
    """An object of no type that dembound knows."""
