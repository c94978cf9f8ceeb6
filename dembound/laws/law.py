"""The base of all contact laws of disks: stiffnesses and constants of pairs."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any, ClassVar, NamedTuple

import numpy as np

from dembound.pairwise import PLACE, STRAIN, Column, P, index


def lattice_moduli(
    density: float, p_wave_speed: float, contact_share: float, bond_radius_factor: float
) -> tuple[float, float]:
    """Contact modulus E_c and bond modulus Ē_c (Pa) for a P-wave speed along the rows of a square lattice.

    Z eq. 11: E_c = α_c ρ c_p² and Ē_c = (1 − α_c) ρ c_p² / η, with η the bond's radius factor (pb_rmul).
    """
    modulus = density * p_wave_speed**2
    return contact_share * modulus, (1.0 - contact_share) * modulus / bond_radius_factor


@dataclass(frozen=True)
class Moduli:
    """Micro-parameters under their PFC names: emod, pb_emod in Pa; the others are pure numbers."""

    emod: float
    pb_emod: float
    kratio: float = 1.0
    pb_kratio: float = 1.0
    pb_rmul: float = 1.0
    fric: float = 0.0
    pb_mcf: float = 1.0


class Key(NamedTuple):
    """A key of [material] that a law adds: its name, unit, kind of number (`meanings`), meaning and limits.

    limits : constraints of pydantic, as gt.
    """

    name: str
    unit: str
    means: str
    help: str
    limits: Mapping[str, float]


@dataclass(frozen=True)
class Springs:
    """Contact and bond of pairs separately, (b,) each: stiffnesses in N/m and N·m/rad, bond area (m) and radius (m)."""

    contact_normal: np.ndarray
    contact_shear: np.ndarray
    bond_normal: np.ndarray
    bond_shear: np.ndarray
    bending: np.ndarray
    area: np.ndarray
    bond_radius: np.ndarray


@dataclass(frozen=True)
class Stiffness:
    """Constants of contacts, (b,) each: normal and shear in N/m, bending in N·m/rad, arms in m."""

    normal: np.ndarray
    shear: np.ndarray
    bending: np.ndarray
    arm_i: np.ndarray
    arm_j: np.ndarray

    def of(self, contacts: np.ndarray) -> "Stiffness":
        """The constants of some of the contacts, by number or as a mask."""
        return Stiffness(*(getattr(self, each.name)[contacts] for each in fields(self)))

    def times(self, factor: np.ndarray) -> "Stiffness":
        """The constants with stiffnesses multiplied by factors (b,) of contacts."""
        return Stiffness(factor * self.normal, factor * self.shear, factor * self.bending, self.arm_i, self.arm_j)


COLUMNS = (
    *PLACE,
    Column("kn", "N/m", "normal stiffness of the contact", in_half=0.5),
    Column("ks", "N/m", "shear stiffness of the contact", in_half=0.5),
    Column("bond_kn", "N/m", "normal stiffness of the bond, k̄_n A", in_half=0.5),
    Column("bond_ks", "N/m", "shear stiffness of the bond, k̄_s A", in_half=0.5),
    Column("bending", "N·m/rad", "stiffness of the bond against rotation, k̄_n J", in_half=0.5),
    Column("per_area", "1/m", "stress of the bond over its force, 1/A", in_half=2.0),
    Column("per_section", "1/m²", "stress of the bond over its moment, pb_mcf R̄/J", in_half=2.0),
)
"""Constants of a pair."""

K = index(COLUMNS)
"""Numbers of the constants by name."""


class Limits(NamedTuple):
    """Friction of contacts and strength of bonds: numbers, or columns (p,) by row of constants (pairwise.limit_of).

    friction, tan_fa : pure numbers; tension, cohesion : Pa; geometry : one of those in kernels/contacts.py. Kernels for
    columns are compiled separately, so all four are numbers or all are columns. factor : 1.0, or (b,) by which the
    strengths of each pair's bond, tension and cohesion, are multiplied (kernels/compiler/limits.py), which is compiled
    separately too.
    """

    friction: float | np.ndarray
    tension: float | np.ndarray
    cohesion: float | np.ndarray
    tan_fa: float | np.ndarray
    geometry: int
    factor: float | np.ndarray = 1.0


class RollingLimits(NamedTuple):
    """`Limits` of contacts that also resist rolling, with the coefficient `rolling` of their largest moment.

    Their kernels are compiled separately.
    """

    friction: float | np.ndarray
    tension: float | np.ndarray
    cohesion: float | np.ndarray
    tan_fa: float | np.ndarray
    rolling: float | np.ndarray
    geometry: int
    factor: float | np.ndarray = 1.0


AnyLimits = Limits | RollingLimits
"""Limits of contacts and bonds; laws may have others."""


def columns_of(limits: Any) -> tuple[Any, ...]:
    """Friction, strengths and, where contacts resist rolling, their coefficient: all limits before the geometry."""
    return tuple(limits[: limits._fields.index("geometry")])


def in_columns(limits: np.ndarray, geometry: int) -> AnyLimits:
    """Limits (p, 4) or, of contacts that resist rolling, (p, 5) of rows of constants as columns, see `columns_of`."""
    columns = np.ascontiguousarray(limits.T)
    friction, tension, cohesion, tan_fa = columns[:4]
    if len(columns) == 4:
        return Limits(friction, tension, cohesion, tan_fa, geometry)
    return RollingLimits(friction, tension, cohesion, tan_fa, columns[4], geometry)


class Law(ABC):
    """Forces of contacts and bonds: the springs from which forces, energies, wave speeds and step limit are computed.

    Attributes
    ----------
    name : value of `material.law`.
    columns : constants of pairs, those of pairwise.PLACE first; by default of springs of contact and bond.
    has_history : whether contacts open, slide and break (kernels/contacts.py).
    starts_elastic : whether a linear law with the same springs holds until a contact opens or slides, whatever the
    stress. If not, springs are those of small motion about the stress at rest, and there are none without.
    secant : force over displacement from no force over the stiffness of small motion, normal and in shear.
    strengths : names of the limits at which bonds break. relaxes : whether intact bonds may have relaxation arms
    (kernels/arms.py), for which the forces of closed contacts and of bonds must be linear, and a quality factor.
    rolls : whether contacts without bonds may resist rolling, by the key rr_fric.
    keys : of [material] that it adds, all required under it; uses : names of others that it has a use for, None for
    all. elsewhere : its names in other codes. help : what contacts and bonds do under it, in a few words.
    """

    name: ClassVar[str]
    columns: ClassVar[tuple[Column, ...]] = COLUMNS
    has_history: ClassVar[bool] = False
    starts_elastic: ClassVar[bool] = True
    strengths: ClassVar[tuple[str, ...]] = ("tension", "cohesion")
    relaxes: ClassVar[bool] = False
    rolls: ClassVar[bool] = False
    secant: ClassVar[tuple[float, float]] = (1.0, 1.0)
    keys: ClassVar[tuple[Key, ...]] = ()
    uses: ClassVar[tuple[str, ...] | None] = None
    elsewhere: ClassVar[tuple[str, ...]] = ()
    help: ClassVar[str] = ""

    @property
    def width(self) -> int:
        """Number of constants of a pair, its place included."""
        return len(self.columns)

    @property
    def stiff(self) -> list[int]:
        """Numbers of the columns of stiffnesses, which half pairs have half of, and contacts in series less of."""
        return [number for number, each in enumerate(self.columns) if each.in_half == 0.5]

    def column(self, constants: np.ndarray, name: str) -> np.ndarray:
        """One of the constants of pairs (p, c or more) by name; 0 under a law that does not have it."""
        names = [each.name for each in self.columns]
        return constants[:, names.index(name)] if name in names else np.zeros(len(constants))

    def stiffnesses(self, constants: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Stiffnesses (3, p) of contacts and of bonds against stretch, shear and rotation; of closed contacts alone."""
        closed = constants[:, P.touch] >= constants[:, P.rest]
        contacts = [self.column(constants, name) for name in ("kn", "ks")]
        bonds = [self.column(constants, name) for name in ("bond_kn", "bond_ks", "bending")]
        return np.where(closed, [*contacts, np.zeros(len(constants))], 0.0), np.array(bonds)

    @property
    def is_linear(self) -> bool:
        """Whether forces are linear in displacements; by default True for laws without history (elastic.py)."""
        return not self.has_history

    @property
    def linear(self) -> str:
        """Name of the linear law that has the same stiffness at rest; required for a history-dependent law."""
        return self.name

    def moduli(self, given: Any) -> Moduli:
        """Micro-parameters of a material with given moduli, a table [material]."""
        keys = (field.name for field in fields(Moduli))
        return Moduli(**{key: getattr(given, key) for key in keys})

    def limits(self, strength: AnyLimits) -> Any:
        """What the functions of the law get of the limits of a material; they are found by its type."""
        return strength

    def springs_at(self, moduli: Moduli, radius_i: np.ndarray, radius_j: np.ndarray, overlap: np.ndarray) -> Springs:
        """Springs of small motion about overlaps (b,) m; the same for all under a law that starts elastic."""
        return self.springs(moduli, radius_i, radius_j)

    def overlap_of(self, moduli: Moduli, radius_i: np.ndarray, radius_j: np.ndarray, push: np.ndarray) -> np.ndarray:
        """Overlaps (b,) m at which contacts push with forces (b,) N, 0 for pulling ones.

        Only asked of laws that do not start elastic; raises NotImplementedError for others.
        """
        raise NotImplementedError(f'law "{self.name}" does not start elastic and lacks overlap_of()')

    def dashpot_springs(self, constants: np.ndarray) -> np.ndarray:
        """Normal and shear stiffnesses (p, 2) N/m of pairs from which the viscosity of their dashpots follows."""
        return constants[:, [int(K.kn), int(K.ks)]]

    def without_limits(self, geometry: int, *, rolls: bool = False) -> Any:
        """Limits that no contact or bond reaches, in a geometry of kernels/contacts.py; rolls : of rolling contacts."""
        strong = 0.0, np.inf, np.inf, 0.0
        return RollingLimits(*strong, np.inf, geometry) if rolls else Limits(*strong, geometry)

    @abstractmethod
    def springs(self, moduli: Moduli, radius_i: np.ndarray, radius_j: np.ndarray) -> Springs:
        """Springs of closed, bonded contacts between disks of radii (b,) m."""

    def stiffness(
        self,
        moduli: Moduli,
        radius_i: np.ndarray,
        radius_j: np.ndarray,
        distance: np.ndarray,
        overlap: np.ndarray | None = None,
    ) -> Stiffness:
        """Stiffnesses of contacts between disks of radii (b,) m whose centres are `distance` (b,) m apart.

        Contact and bond together; across a gap only the bond. The arms end in the middle of the overlap or gap and
        their sum is the distance, so moments balance. overlap : (b,) m at rest, for a law that does not start elastic.
        """
        given = (moduli, radius_i, radius_j)
        pair = self.springs(*given) if overlap is None else self.springs_at(*given, overlap)
        closed = touching(radius_i, radius_j, distance)
        return Stiffness(
            normal=np.where(closed, pair.contact_normal, 0.0) + pair.bond_normal,
            shear=np.where(closed, pair.contact_shear, 0.0) + pair.bond_shear,
            bending=pair.bending,
            arm_i=(distance + radius_i - radius_j) / 2.0,
            arm_j=(distance + radius_j - radius_i) / 2.0,
        )

    def pair_constants(
        self,
        moduli: Moduli,
        radius_i: np.ndarray,
        radius_j: np.ndarray,
        vectors: np.ndarray,
        *,
        bonded: bool,
        gaps_close: bool = True,
        locked_in: float = 0.0,
    ) -> np.ndarray:
        """Constants of pairs: their place, those of the law, and the strain from the start, which is none.

        Parameters
        ----------
        moduli : micro-parameters.
        radius_i, radius_j : (b,) m.
        vectors : (b, 2) m, from i to j at the start.
        bonded : whether the pairs have bonds.
        gaps_close : whether pairs with a gap have a contact that acts once it closes; not in laws without history.
        locked_in : part of the overlaps that causes a force from the start; with 0, overlapping disks just touch.

        Returns (b, c + 3), with the c columns of `columns`.
        """
        distance = np.hypot(*vectors.T)
        closed = touching(radius_i, radius_j, distance)
        overlap = np.maximum(radius_i + radius_j - distance, 0.0)
        return np.column_stack(
            [
                vectors,
                distance,
                np.where(closed, distance + locked_in * overlap, radius_i + radius_j),
                (radius_i - radius_j) / 2.0,
                self.own_constants(moduli, radius_i, radius_j, closed | gaps_close, bonded=bonded),
                np.zeros((len(vectors), STRAIN)),
            ]
        )

    def own_constants(
        self, moduli: Moduli, radius_i: np.ndarray, radius_j: np.ndarray, acts: np.ndarray, *, bonded: bool
    ) -> np.ndarray:
        """Constants (b, 7) of pairs, in the columns after their place."""
        pair, has_bond = self.springs(moduli, radius_i, radius_j), float(bonded)
        return np.column_stack(
            [
                np.where(acts, pair.contact_normal, 0.0),
                np.where(acts, pair.contact_shear, 0.0),
                has_bond * pair.bond_normal,
                has_bond * pair.bond_shear,
                has_bond * pair.bending,
                1.0 / pair.area,
                moduli.pb_mcf * 1.5 / pair.bond_radius**2,  # pb_mcf R̄/J
            ]
        )


def touching(radius_i: np.ndarray, radius_j: np.ndarray, distance: np.ndarray) -> np.ndarray:
    """Mask (b,) of disks that touch or overlap, to rounding; all in m."""
    return distance <= (radius_i + radius_j) * (1.0 + 1e-9)
