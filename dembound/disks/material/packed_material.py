"""A brick with its material: masses, contact constants, and the equivalent continuum.

Everything here is computed from one brick, before any scene is built. The homogenised stiffness comes from one periodic
linear solve and gives wave speeds without a dynamic run.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import Any, Self, TypeVar

import numpy as np

from dembound.boundaries.edge import SIDES
from dembound.damping import Attenuation
from dembound.disks.material.free_surface import cut_at, skin_depths
from dembound.disks.material.homogenise import HomogenisedMaterial, Network, homogenise
from dembound.disks.material.sliding import sliding_forces
from dembound.laws import Law, Moduli, Stiffness
from dembound.packings.brick import Brick
from dembound.packings.tiling import Assembly

T = TypeVar("T")

NO_STIFFNESS = 1e-9
"""Stiffness over the largest one below which no wave runs: rounding in homogenisation leaves some 1e-13."""

DIGITS = 12
"""Digits of a stress over its largest component by which the forces under it are kept."""


@dataclass(frozen=True)
class PackedMaterial:
    """A brick with its material.

    Attributes
    ----------
    brick : the packed periodic body.
    density : bulk density, kg/m³.
    moduli : micro-parameters in use, after any scaling to a wave speed.
    law : the contact law.
    held : components (0 x, 1 y, 2 rotation) that are held for all particles.
    given_speeds : speeds (m/s) of P and S waves that the case gives; None for those it does not give.
    mechanisms : of its damping; None without damping. Moduli, stiffness and wave speeds are then those at the frequency
    at which they are given, and springs are stiffer.
    overlaps : (b,) m, of the brick's contacts under the stress at rest; None under a law whose springs do not depend on
    it. is_secant : whether the stiffness is that from no force to the forces at rest, instead of that of small motion.
    is_relaxed : whether its springs are those at rest, instead of the unrelaxed ones.
    """

    brick: Brick
    density: float
    moduli: Moduli
    law: Law
    held: tuple[int, ...] = ()
    given_speeds: tuple[float | None, float | None] = (None, None)
    mechanisms: Attenuation | None = None
    overlaps: np.ndarray | None = None
    is_secant: bool = False
    is_relaxed: bool = False
    _kept: dict[tuple[str, Any], Any] = field(default_factory=dict, init=False, repr=False, compare=False)
    """What is known of its continuum, solved once, also where only its damping changes."""

    @cached_property
    def stiffness(self) -> Stiffness:
        """Constants of the brick's contacts."""
        first, second = self.brick.radii[self.brick.pairs].T
        found = self.law.stiffness(self.moduli, first, second, np.hypot(*self.brick.vectors.T), self.overlaps)
        if not self.is_secant:
            return found
        normal, shear = self.law.secant
        return replace(found, normal=normal * found.normal, shear=shear * found.shear)

    @property
    def has_stiffness(self) -> bool:
        """Whether its contacts have a stiffness at rest: not without pressure, where it depends on that."""
        return self.overlaps is None or bool(self.overlaps.any())

    @cached_property
    def at_rest(self) -> PackedMaterial:
        """The linear material that has its forces at rest under the stress at rest."""
        return self if self.overlaps is None else replace(self, is_secant=True)

    def stiffnesses(self, constants: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Stiffnesses (3, b) of the brick's contacts and bonds at rest, apart; constants : their rows, with zones."""
        if self.overlaps is None:
            return self.law.stiffnesses(constants)
        found = self.at_rest.stiffness
        return np.array([found.normal, found.shear, found.bending]), np.zeros((3, len(found.normal)))

    def content(self, *more: object) -> bytes:
        """A digest of brick and moduli, and of more values with a text, by which what follows from them is kept."""
        brick = self.brick
        digest = hashlib.sha256(repr((self.moduli, self.law.name, self.held, *more)).encode())
        for array in (brick.size, brick.positions, brick.radii, brick.pairs, brick.images):
            digest.update(np.ascontiguousarray(array).tobytes())
        return digest.digest()

    @cached_property
    def contact_constants(self) -> np.ndarray:
        """Constants (b, c + 3) of the brick's contacts as built, see `pair_constants`."""
        first, second = self.brick.radii[self.brick.pairs].T
        return self.pair_constants((first, second), self.brick.vectors, gaps_close=False)

    @property
    def mechanisms_by_layer(self) -> tuple[Attenuation | None, ...]:
        """The mechanisms of every layer, from the surface down."""
        return tuple(each.mechanisms for each in self.materials)

    @property
    def is_damped(self) -> bool:
        """Whether any layer is damped."""
        return any(self.mechanisms_by_layer)

    @property
    def unrelaxed(self) -> float:
        """Stiffness of the springs with which it is stepped over `stiffness`; 1 without damping."""
        return 1.0 if self.mechanisms is None else self.mechanisms.unrelaxed

    @property
    def relaxes(self) -> bool:
        """Whether intact bonds have relaxation arms, by which ground that can break is damped."""
        return self.law.has_history and self.is_damped

    @cached_property
    def stepped(self) -> PackedMaterial:
        """The ground with the springs of its disks as they are stepped: those at rest where bonds have arms."""
        return self._with(is_relaxed=True) if self.relaxes else self

    @property
    def undamped(self) -> PackedMaterial:
        """The ground without damping, with the springs of its moduli: itself if it is not damped."""
        return self._with(mechanisms=None) if self.is_damped else self

    def _with(self, **damping: Any) -> Self:
        """The ground with other damping, which changes nothing of what is known of its continuum."""
        found = replace(self, **damping)
        object.__setattr__(found, "_kept", self._kept)
        return found

    def _once(self, what: str, key: Any, solve: Callable[[], T]) -> T:
        """A solution for a key, kept."""
        if (what, key) not in self._kept:
            self._kept[what, key] = solve()
        found: T = self._kept[what, key]
        return found

    @property
    def _spring_factor(self) -> float:
        """Stiffness of `springs` over `stiffness`."""
        if self.mechanisms is None or not self.is_relaxed:
            return self.unrelaxed
        return self.mechanisms.relaxed * self.unrelaxed

    @property
    def contact_modulus(self) -> float:
        """Modulus E_c of its contacts, Pa; that at rest if it is relaxed."""
        return self.moduli.emod * self._spring_factor if self.is_relaxed else self.moduli.emod

    @property
    def springs(self) -> Stiffness:
        """Constants of the contacts of the brick as it is stepped: unrelaxed, or those at rest if it is relaxed."""
        if self.mechanisms is None:
            return self.stiffness
        return self.stiffness.times(np.full(len(self.brick.pairs), self._spring_factor))

    @cached_property
    def mass(self) -> np.ndarray:
        """Disk masses (n,) kg; all disks have the same density, which gives the brick the bulk density of the case."""
        area = self.brick.radii**2
        return self.density * float(np.prod(self.brick.size)) * area / area.sum()

    @cached_property
    def inertia(self) -> np.ndarray:
        """Moments of inertia of the disks (n,) kg·m², mR²/2."""
        return 0.5 * self.mass * self.brick.radii**2

    def at(self, height: float, x: float | None = None) -> PackedMaterial:
        """The material at a height and a place x (m): the same everywhere, except in a layered ground."""
        return self

    def beside(self, side: str) -> PackedMaterial:
        """The ground of the left or right side, as if it were everywhere: the same, except in unlike ground."""
        return self

    def zone_of(self, places: np.ndarray) -> np.ndarray:
        """Number of the zone, from the bottom, of disks at places (n, 2) m: one, except in a layered ground."""
        return np.zeros(len(places), dtype=np.int64)

    @property
    def materials(self) -> tuple[PackedMaterial, ...]:
        """The materials of its layers, from the surface down, without corrections; of uniform ground itself."""
        return (self,)

    @property
    def zone_materials(self) -> tuple[PackedMaterial, ...]:
        """The material of each zone, see `zone_of`."""
        return (self,)

    def layer_of(self, places: np.ndarray) -> np.ndarray:
        """Number of the layer, from the top, of disks at places (n, 2) m."""
        return np.zeros(len(places), dtype=np.int64)

    def disk_masses(self, assembly: Assembly) -> tuple[np.ndarray, np.ndarray]:
        """Masses (n,) kg and moments of inertia (n,) kg·m² of an assembly's disks."""
        return self.mass[assembly.brick_particle], self.inertia[assembly.brick_particle]

    @property
    def is_layered(self) -> bool:
        """Whether masses and springs change with height."""
        return len(self.pairings) > 1

    @property
    def pairings(self) -> tuple[tuple[int, int], ...]:
        """The zones of the first and second disk of contacts, in the order of the variants of the brick's contacts."""
        return ((0, 0),)

    def pairing_of(self, first: np.ndarray, second: np.ndarray) -> np.ndarray:
        """Number (b,) in `pairings` of contacts between disks at places first and second (b, 2) m."""
        return np.zeros(len(first), dtype=np.int64)

    def stiffness_of(self, pairing: tuple[int, int]) -> Stiffness:
        """Constants of the brick's contacts between two zones, see `springs`."""
        return self.springs

    def pair_constants(
        self,
        radii: tuple[np.ndarray, np.ndarray],
        vectors: np.ndarray,
        zones: tuple[np.ndarray | int, np.ndarray | int] = (0, 0),
        *,
        bonded: bool | None = None,
        gaps_close: bool = True,
        locked_in: float = 0.0,
    ) -> np.ndarray:
        """Constants (b, c + 3) of pairs, see `Law.pair_constants`.

        radii : (b,) m of first and second disks. zones : (b,) of both disks, see `zone_of`. bonded : whether the pairs
        have bonds; None: if the material has them.
        """
        bonded = self.moduli.pb_emod > 0.0 if bonded is None else bonded
        factor = self._spring_factor
        moduli = replace(self.moduli, emod=factor * self.moduli.emod, pb_emod=factor * self.moduli.pb_emod)
        return self.law.pair_constants(
            moduli, *radii, vectors, bonded=bonded, gaps_close=gaps_close, locked_in=locked_in
        )

    @property
    def packed_pressure(self) -> float:
        """Pressure (Pa) at which the brick was packed, for the present stiffness of its contacts, if they have one."""
        if self.overlaps is not None:
            return 0.0
        return 0.0 - 0.5 * self.contact_modulus * float(self.brick.stress[0] + self.brick.stress[1])

    @cached_property
    def bond_share(self) -> float:
        """Share of the stiffness, the smaller of x and y, that remains in tension, where contacts are open."""
        if self.moduli.pb_emod == 0.0:
            return 0.0
        first, second = self.brick.radii[self.brick.pairs].T
        bonds = self.law.stiffness(replace(self.moduli, emod=0.0), first, second, np.hypot(*self.brick.vectors.T))
        alone = homogenise(self.brick, bonds, self._held_turns).tensor
        return min(float(alone[axis, axis] / self.material_tensor[axis, axis]) for axis in (0, 1))

    @property
    def tensor(self) -> np.ndarray:
        """Homogenised stiffness (4, 4) Pa with the scene's held motions; see `homogenise`."""
        return self._continuum(self.held).tensor

    @property
    def material_tensor(self) -> np.ndarray:
        """Homogenised stiffness (4, 4) Pa with both translations free, a property of the material."""
        return self.continuum.tensor

    @property
    def continuum(self) -> HomogenisedMaterial:
        """The continuum equivalent to the brick, with both translations free."""
        return self._continuum(self._held_turns)

    @property
    def _held_turns(self) -> tuple[int, ...]:
        """The components that are held where both translations are free."""
        return tuple(component for component in self.held if component == 2)

    def skin(self, side: str) -> float:
        """Depth (m) of the continuum's free surface at a side that cuts no brick, see `skin_depths`."""
        axis, last = divmod(SIDES.index(side), 2)
        solve = partial(skin_depths, self.brick, self.stiffness, self.material_tensor, axis)
        return self._once("skin", axis, solve)[last]

    def cut(self, height: float) -> tuple[float, float]:
        """Heights at which the packing's mass and its continuum end below a cut at a height, m above the brick's edge.

        Both in m above the cut, the second usually negative: see `Brick.mass_offset` and `skin_depths`.
        """
        height %= float(self.brick.size[1])

        def solve() -> tuple[float, float]:
            brick = cut_at(self.brick, height)
            return float(brick.mass_offset[1]), -skin_depths(brick, self.stiffness, self.material_tensor)[1]

        return self._once("cut", height, solve)

    def remember(self, found: HomogenisedMaterial) -> None:
        """Take the continuum with both translations free from a solve for a multiple of its moduli."""
        self._kept["continuum", self._held_turns] = found

    def _continuum(self, held: tuple[int, ...]) -> HomogenisedMaterial:
        """The continuum with some components held, computed once."""
        if not self.has_stiffness:
            return HomogenisedMaterial(np.zeros((4, 4)), np.zeros((3, len(self.brick.radii), 4)))
        return self._once("continuum", held, lambda: homogenise(self.brick, self.stiffness, held))

    def sliding_forces(self, stress: np.ndarray) -> np.ndarray | None:
        """Forces (4, b) of the brick's contacts under a stress (3,) Pa at which some slide, see `sliding_forces`."""
        largest = float(np.abs(stress).max())
        way = tuple((stress / largest).round(DIGITS).tolist()) if largest > 0.0 else (0.0, 0.0, 0.0)

        def solve() -> np.ndarray | None:
            network, area = Network.of_brick(self.brick, self.at_rest.stiffness), float(np.prod(self.brick.size))
            springs, friction = self.stiffnesses(self.contact_constants), self.moduli.fric
            return sliding_forces(network, *springs, friction, np.array(way), self._held_turns, area)

        found = self._once("sliding", way, solve)
        return None if found is None else largest * found

    def wave_speeds(self, axis: int) -> tuple[float, float]:
        """c_p and c_s (m/s) of plane waves along x (axis 0) or y (1) in the scene, held motions included.

        The roots of the Christoffel equation det(Γ − ρc²) = 0; P is the one that moves mostly along the axis. A wave
        that does not run has speed nan: its motion is held, or no stiffness resists it.
        """
        pair = [0, 3] if axis == 0 else [1, 2]
        christoffel = self.tensor[np.ix_(pair, pair)] / self.density
        held = np.array([axis in self.held, 1 - axis in self.held])
        if held.any():
            squares = np.where(held, np.nan, np.diag(christoffel))
        else:
            roots, shapes = np.linalg.eigh(christoffel)
            p = int(np.argmax(np.abs(shapes[0])))
            squares = roots[[p, 1 - p]]
        least = NO_STIFFNESS * np.abs(self.tensor).max() / self.density
        p_square, s_square = np.where(squares > least, squares, np.nan)  # nan > least is false
        return float(np.sqrt(p_square)), float(np.sqrt(s_square))
