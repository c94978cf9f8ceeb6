"""The ``[material]`` table."""

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Literal

from pydantic import create_model

from dembound.casefile.disks.stiffness import (
    MODULI_KEYS,
    RATIO_KEYS,
    STIFFNESS_KEYS,
    WAVE_SPEED_KEYS,
    problems_with_moduli,
    problems_with_speed,
    problems_with_target,
)
from dembound.casefile.disks.targets import FIELDS, PAIRS, PlaneModuli, Scatter, Target, keys_problems, with_history
from dembound.casefile.types import LAWS, LawName
from dembound.table import Table, quantity

TARGET_KEYS = ("plane", "along")
"""Keys that say what targets of the body mean."""

STRENGTH_KEYS = ("pb_ten", "pb_coh")
BOND_KEYS = (*STRENGTH_KEYS, "pb_fa", "pb_mcf", "pb_scatter")
"""Keys of the strengths of bonds, for history-dependent laws and load factors only."""

ROLLING_KEY = "rr_fric"
"""Key of contacts that resist rolling, for a history-dependent law that has it."""

DASHPOT_KEYS = ("dp_nratio", "dp_sratio")
HISTORY_KEYS = ("locked_in", "geometry", "elastic_start", *DASHPOT_KEYS, "dp_on")
"""Keys for history-dependent laws only."""


class MaterialTable(Table):
    """Density, and contacts and bonds by PFC's names; stiffness is given, or follows from wave speeds or targets.

    Targets are `young` and `poisson`, `bulk` and `shear`, or both wave speeds: moduli and `kratio` = `pb_kratio` are
    found for them. From a `p_wave_speed` alone they follow by Z eqs 9-11, an `s_wave_speed` alone scales them. The law
    "linearpbond" alone has `locked_in`, `geometry`, `elastic_start` and `rr_fric`; strengths are for it and for
    `output.load_factor`. Under "hertz" stiffness follows from `hz_shear`, `hz_poiss` and the stress at rest,
    `static.stress`. Both have dashpots c = 2β√(m_c k) with m_c = m₁m₂/(m₁ + m₂).
    """

    density: float = quantity(unit="kg/m³", gt=0.0)
    """bulk density: mass over scene area; absent: every [[layer]] has its own"""
    p_wave_speed: float | None = quantity(None, unit="m/s", means="wave speed", gt=0.0)
    """P-wave speed from which the moduli follow"""
    match: Literal["lattice", "assembly"] = quantity("lattice")
    """body with this speed: "lattice", the square lattice (Z eq. 11); "assembly", the packing along x"""
    contact_share: float = quantity(0.5, means="share", ge=0.0, le=1.0)
    """share α_c of the contacts in the stiffness (Z eq. 9); 0 in pattern A only"""
    s_wave_speed: float | None = quantity(None, unit="m/s", means="wave speed", gt=0.0)
    """S-wave speed; beside emod and pb_emod of the boundaries only; absent: the packing's own"""
    young: float | None = quantity(None, unit="Pa", means="modulus", gt=0.0)
    """Young's modulus of the body"""
    poisson: float | None = quantity(None, means="Poisson's ratio", gt=-1.0, lt=1.0)
    """Poisson's ratio of the body"""
    bulk: float | None = quantity(None, unit="Pa", means="modulus", gt=0.0)
    """bulk modulus of the body"""
    shear: float | None = quantity(None, unit="Pa", means="modulus", gt=0.0)
    """shear modulus of the body"""
    plane: Literal["strain", "stress"] = quantity("strain")
    """in plane "strain", young, poisson, bulk are of the solid; in "stress" of the 2D sample"""
    along: Literal["isotropic", "x", "y"] = quantity("isotropic")
    """direction with the targets: "isotropic", the mean over all; "x", "y": waves or a test along it"""
    emod: float | None = quantity(None, unit="Pa", means="modulus", ge=0.0)
    """modulus E_c of the contacts; 0 in pattern A only"""
    pb_emod: float | None = quantity(None, unit="Pa", means="modulus", ge=0.0)
    """modulus Ē_c of the parallel bonds"""
    kratio: float = quantity(1.0, means="normal over shear stiffness", gt=0.0)
    """normal over shear stiffness of the contacts"""
    pb_kratio: float = quantity(1.0, means="normal over shear stiffness", gt=0.0)
    """normal over shear stiffness of the bonds"""
    fric: float = quantity(0.0, means="friction coefficient", ge=0.0)
    """friction coefficient of the contacts; at 0 they carry no shear"""
    rr_fric: float = quantity(0.0, means="friction coefficient", ge=0.0)
    """resistance of contacts without bonds to rolling: moment of at most this times R̄ N; needs fric"""
    pb_rmul: float = quantity(1.0, means="bond radius", gt=0.0)
    """bond radius over the smaller disk's radius"""
    damp: float = quantity(0.0, means="local damping", ge=0.0, lt=1.0)
    """local damping coefficient"""
    dp_nratio: float = quantity(0.0, means="share", ge=0.0, le=1.0)
    """normal dashpot of closed contacts over the critical one (PFC's dp_mode 1)"""
    dp_sratio: float = quantity(0.0, means="share", ge=0.0, le=1.0)
    """shear dashpot of closed contacts over the critical one; needs fric"""
    dp_on: Literal["unbonded", "all"] | None = quantity(None)
    """contacts with dashpots: "all", or those without an intact bond, "unbonded"; absent: these if bonds can break"""
    quality_factor: float | None = quantity(None, means="quality factor", ge=2.0, le=1e4)
    """quality factor Q of P and S waves, see [damping]; absent: no damping"""
    law: LawName = quantity(
        "elastic", help="; ".join(f'"{name}": {law.help}' for name, law in LAWS.items() if law.help)
    )
    pb_ten: float | None = quantity(None, unit="Pa", means="strength", gt=0.0)
    """tensile strength of the bonds; absent: unbreakable"""
    pb_coh: float | None = quantity(None, unit="Pa", means="strength", gt=0.0)
    """cohesion of the bonds; absent: unbreakable in shear"""
    pb_fa: float = quantity(0.0, unit="degrees", means="friction angle", ge=0.0, lt=90.0)
    """friction angle of the bonds; needs pb_coh"""
    pb_mcf: float = quantity(1.0, means="share", ge=0.0, le=1.0)
    """share of the moment in the stress of bonds (PFC's moment contribution factor)"""
    pb_scatter: Scatter | None = quantity(None)
    """scatter of both strengths, a table; absent: none"""
    locked_in: float | None = quantity(None, unit="Pa", means="stress", gt=0.0)
    """pressure of the contacts before the static stage, up to 0.1 of their modulus; absent: none"""
    geometry: Literal["updated", "reference"] = quantity("updated")
    """ "updated": normals and arms follow the motion; "reference": intact bonds keep those of the start"""
    elastic_start: bool = quantity(True)
    """whether the faster elastic law serves until a contact opens, slips or closes or a bond yields"""

    def mistakes(self) -> Iterator[str]:
        """Keys that the law has no use for, contradict each other, or lack others."""
        law = LAWS[self.law]
        yield from keys_problems(self, self.law, (*STIFFNESS_KEYS, *RATIO_KEYS, *WAVE_SPEED_KEYS, *TARGET_KEYS))
        if law.uses is not None:
            yield from self._problems_with_dashpots()
            return
        if self.pair:
            yield from problems_with_target(self)
        else:
            yield from problems_with_moduli(self) if self.p_wave_speed is None else problems_with_speed(self)
            for key in self._given(TARGET_KEYS):
                yield f"{key}: is only allowed together with targets: young and poisson, or both wave speeds"
        yield from self._problems_with_strength()
        for key in () if law.has_history else self._given(HISTORY_KEYS):
            yield f"{key}: is only allowed with law = {with_history()}"
        if self.dp_on is not None and not self.has_dashpots:
            yield "dp_on: is of dashpots of contacts, but there are none; give dp_nratio"
        yield from self._problems_with_dashpots()
        if self.rr_fric > 0.0:
            yield from self._problems_with_rolling()
        if self.quality_factor is not None:
            yield from self._problems_with_quality()

    def _given(self, keys: Sequence[str]) -> list[str]:
        """The keys that the file gives, of those asked for, in their order."""
        return [key for key in keys if key in self.model_fields_set]

    def valued(self, keys: Sequence[str]) -> list[str]:
        """The keys that have a value, of those asked for, in their order."""
        return [key for key in keys if getattr(self, key) is not None]

    @property
    def by_s_waves(self) -> bool:
        """Whether the moduli follow from the S-wave speed alone."""
        return self.s_wave_speed is not None and not self.valued(("p_wave_speed", *MODULI_KEYS))

    @property
    def pair(self) -> tuple[str, ...]:
        """The keys that are targets, of a pair that may lack one; without targets none."""
        return next((pair for pair in PAIRS if len(self.valued(pair)) > (pair == PAIRS[2])), ())

    @property
    def target(self) -> Target | None:
        """What is asked of the body, from which moduli and kratio follow; None if they are given otherwise."""
        pair = self.pair
        if not pair:
            return None
        values = [getattr(self, key) for key in pair]
        if pair == PAIRS[2]:
            moduli = PlaneModuli.of_speeds(self.density, *values)
        else:
            of = PlaneModuli.of_young if pair == PAIRS[0] else PlaneModuli.of_bulk
            moduli = of(values[0], values[1], self.plane)
        return Target((pair[0], pair[1]), moduli, self.along, self.plane)

    @property
    def has_dashpots(self) -> bool:
        """Whether contacts have dashpots."""
        return max(self.dp_nratio, self.dp_sratio) > 0.0

    @property
    def rolls(self) -> bool:
        """Whether contacts resist rolling from the start, as there are no bonds."""
        return self.rr_fric > 0.0 and self.no_bonds is not None

    @property
    def begins_elastic(self) -> bool:
        """Whether the elastic law may serve first in place of a history-dependent one, see the case's."""
        return self.elastic_start and LAWS[self.law].starts_elastic

    @property
    def damps_bonds(self) -> bool:
        """Whether dashpots of contacts also act beside intact bonds, if no layer's bonds have a strength."""
        return self.dp_on == "all" or (self.dp_on is None and not self.valued(STRENGTH_KEYS))

    @property
    def _asks_for_elastic_start(self) -> bool:
        """Whether the file says that the elastic law is to serve first."""
        return self.elastic_start and "elastic_start" in self.model_fields_set

    @property
    def _no_contacts(self) -> str:
        """The key that leaves contacts no stiffness, with its value; empty with a stiffness."""
        return "emod = 0" if self.emod == 0.0 else "contact_share = 0" if self.contact_share == 0.0 else ""

    def _problems_with_dashpots(self) -> Iterator[str]:
        """What dashpots of contacts do not go with."""
        given = [key for key in DASHPOT_KEYS if getattr(self, key) > 0.0]
        at_once = self.damps_bonds or self.no_bonds is not None
        if given and at_once and self._asks_for_elastic_start:
            yield f"elastic_start: is true, but dashpots ({given[0]}) act from the start; leave it out"
        if self._no_contacts:
            yield from (f"{key}: is of contacts, but {self._no_contacts} leaves them no stiffness" for key in given)
        elif self.dp_sratio > 0.0 and self.fric == 0.0:
            yield "dp_sratio: is of the shear of contacts, but fric = 0 leaves them none"

    def _problems_with_rolling(self) -> Iterator[str]:
        """What resistance to rolling does not go with."""
        if self.fric == 0.0:
            yield f"{ROLLING_KEY}: is of contacts with a shear stiffness, but fric = 0 leaves them none"
        if self._no_contacts:
            yield f"{ROLLING_KEY}: is of contacts, but {self._no_contacts} leaves them no stiffness"
        if self.rolls and self._asks_for_elastic_start:
            yield f"elastic_start: is true, but contacts resist rolling ({ROLLING_KEY}) from the start"

    def _problems_with_quality(self) -> Iterator[str]:
        """What damping by a quality factor does not go with."""
        law = LAWS[self.law]
        if law.has_history and not law.relaxes:
            yield f'quality_factor: is not known for law = "{self.law}"; give law = "elastic"'
        if law.has_history and (none := self.no_bonds):
            yield f'quality_factor: is of bonds under law = "{self.law}", but {none} leaves none'
        if law.has_history and self._asks_for_elastic_start:
            yield "elastic_start: is true, but quality_factor damps bonds from the start; leave it out"
        if self.damp > 0.0:
            yield "quality_factor: is not allowed together with damp, local damping; leave damp out"

    def _problems_with_strength(self) -> Iterator[str]:
        """Mistakes in the strength of the bonds."""
        if "pb_fa" in self.model_fields_set and self.pb_coh is None:
            yield "pb_fa: is only allowed together with pb_coh, the strength it adds to"
        if self.pb_scatter is not None and self.pb_ten is None and self.pb_coh is None:
            yield "pb_scatter: is of the strengths of bonds, but there are none; give pb_ten or pb_coh"
        if "pb_mcf" in self.model_fields_set and self.pb_ten is None:
            yield "pb_mcf: is of the stress that pb_ten limits; give pb_ten"
        if none := self.no_bonds:
            yield from (
                f"{key}: is the strength of bonds, but {none} leaves none" for key in self.valued(STRENGTH_KEYS)
            )

    @property
    def no_bonds(self) -> str | None:
        """The key that leaves no bonds, with its value; None with bonds."""
        return "pb_emod = 0" if self.pb_emod == 0.0 else "contact_share = 1" if self.contact_share == 1.0 else None


if TYPE_CHECKING:
    Material = MaterialTable
else:
    Material = create_model(
        "Material", __base__=MaterialTable, __doc__=MaterialTable.__doc__, __module__=__name__, **FIELDS
    )
    """The table with the keys that laws add."""
