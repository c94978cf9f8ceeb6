"""Types as another package would add them: laws, a method, boundaries, packings, a wave, a hole."""

from dataclasses import replace
from typing import ClassVar, Literal

import numpy as np

from dembound.boundaries.boundary import Driven
from dembound.boundaries.viscous import Dashpots
from dembound.holes import Hole
from dembound.laws import Elastic
from dembound.methods import Peridynamics
from dembound.methods.bonds import Bonds
from dembound.packings import Packing
from dembound.packings.brick import Brick
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
