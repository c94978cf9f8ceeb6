"""Ground in which some disks are in groups, with friction, strengths or springs of their own.

A contact across the border of a group has the springs of both sides in series, and the smaller friction and strengths,
as one across a joint of layers. Waves, continua and free-field columns are of the ground without groups.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Self

import numpy as np
from pydantic import ValidationError

from dembound.casefile.disks.group import Group
from dembound.casefile.disks.material import Material
from dembound.casefile.disks.model import DiskCase
from dembound.disks.material.case_material import make_packed_material
from dembound.disks.material.layered import LayeredGround, Zone
from dembound.disks.material.packed_material import PackedMaterial
from dembound.errors import CaseError
from dembound.packings.tiling import Assembly

BEFORE = -1.0
"""A time (s) before a run."""


@dataclass(frozen=True)
class GroupedGround(LayeredGround):
    """The ground of a body whose disks are in groups.

    Its zones are those of the ground without groups, then one for the disks of each of these in the same groups. Its
    layers are numbered on in the same way.

    Attributes
    ----------
    base : the ground without groups. groups : of the case. span : m, size of the scene.
    codes : of further zones, ascending: the number of the zone without groups in front of a bit for each group.
    members : of further layers: the layer without groups, and the numbers of the groups. more : further pairings.
    """

    base: PackedMaterial | None = None
    groups: tuple[Group, ...] = ()
    span: float = 0.0
    codes: tuple[int, ...] = ()
    members: tuple[tuple[int, tuple[int, ...]], ...] = ()
    more: tuple[tuple[int, int], ...] = ()

    @classmethod
    def of(cls, base: PackedMaterial, case: DiskCase, body: Assembly) -> Self:
        """The ground of a body. Raises CaseError for groups without disks, and keys that do not go together."""
        own = {each.name: getattr(base, each.name) for each in fields(PackedMaterial) if each.init}
        zones = [*base.zones] if isinstance(base, LayeredGround) else [Zone(-np.inf, np.inf, 0, base)]
        found = cls(**own, zones=tuple(zones), base=base, groups=case.group, span=case.packing.span)
        code = found._code_of(body.positions)
        bits = np.bitwise_or.reduce(code) & ((1 << len(case.group)) - 1)
        if empty := [group.name for number, group in enumerate(case.group) if not bits >> number & 1]:
            raise CaseError([f"group.{name}: has no disks" for name in empty])
        codes = [each for each in np.unique(code).tolist() if each & ((1 << len(case.group)) - 1)]
        members: list[tuple[int, tuple[int, ...]]] = []
        for each in codes:
            zone = zones[each >> len(case.group)]
            member = zone.layer, tuple(k for k in range(len(case.group)) if each >> k & 1)
            if member not in members:
                members.append(member)
            material = _material(case, zone.material, *member)
            zones.append(zone._replace(layer=len(case.materials) + members.index(member), material=material))
        found = replace(found, zones=tuple(zones), codes=tuple(codes), members=tuple(members))
        between = np.unique(found.zone_of(body.positions)[body.pairs], axis=0)
        first = len(zones) - len(codes)
        return replace(found, more=tuple((a, b) for a, b in between.tolist() if max(a, b) >= first))

    def _code_of(self, places: np.ndarray) -> np.ndarray:
        """Number of the zone without groups, and a bit for each group, of disks at places (n, 2) m."""
        assert self.base is not None
        code = self.base.zone_of(places).astype(np.int64) << len(self.groups)
        for number, group in enumerate(self.groups):
            code |= group.has(places, self.span).astype(np.int64) << number
        return code

    def zone_of(self, places: np.ndarray) -> np.ndarray:
        """Number of the zone of disks at places (n, 2) m."""
        code, codes = self._code_of(places), np.array(self.codes, dtype=np.int64)
        inside = code & ((1 << len(self.groups)) - 1) > 0
        first = len(self.zones) - len(codes)
        return np.where(inside, first + np.searchsorted(codes, code), code >> len(self.groups))

    @property
    def materials(self) -> tuple[PackedMaterial, ...]:
        """The materials of its layers, further ones last."""
        assert self.base is not None
        known = {zone.layer: zone.material for zone in self.zones[len(self.zones) - len(self.codes) :]}
        return (*self.base.materials, *(known[layer] for layer in sorted(known)))

    @property
    def pairings(self) -> tuple[tuple[int, int], ...]:
        """The zones of the first and second disk of contacts: those without groups first."""
        assert self.base is not None
        return (*self.base.pairings, *self.more)

    def typed(self, assembly: Assembly, first: int) -> Assembly:
        """An assembly whose contacts, typed without groups, have types of their groups; first : disk of the body."""
        a, b = self.zone_of(assembly.positions)[assembly.pairs].T
        inside = np.maximum(a, b) >= len(self.zones) - len(self.codes)
        inside &= assembly.pairs.min(axis=1) >= first
        number = np.zeros((len(self.zones),) * 2, dtype=np.int64)
        number[tuple(np.array(self.more, dtype=np.int64).reshape(-1, 2).T)] = np.arange(len(self.more))
        types = 2 * len(self.brick.pairs)
        own = types * (len(self.pairings) - len(self.more) + number[a, b]) + assembly.contact_type % types
        return replace(assembly, contact_type=np.where(inside, own, assembly.contact_type).astype(np.int32))

    def materials_at(self, case: DiskCase, time: float) -> tuple[Material, ...]:
        """The tables of its layers at a time (s) of the run."""
        further = (_merged(case, case.materials[layer], groups, time) for layer, groups in self.members)
        return (*case.materials, *further)


def _merged(case: DiskCase, beside: Material, groups: Sequence[int], time: float) -> Material:
    """The table of the ground in some groups, by their numbers, at a time (s)."""
    for number in groups:
        group = case.group[number]
        if group.time is not None and group.time > time:
            continue
        try:
            beside = group.merged(beside)
        except ValidationError as error:
            lines = str(error.errors()[0]["ctx"]["error"]).splitlines()
            raise CaseError([f"group.{group.name}.{line}" for line in lines]) from None
    return beside


def _material(case: DiskCase, beside: PackedMaterial, layer: int, groups: tuple[int, ...]) -> PackedMaterial:
    """The material of disks in some groups, by their numbers, with the masses of the ground beside them."""
    own = _merged(case, case.materials[layer], groups, BEFORE)
    moduli, stiff = beside.moduli, [case.group[number] for number in groups if case.group[number].is_stiff]
    if stiff:
        along, place = 1 if case.layer else 0, f"group.{stiff[-1].name}"
        moduli = make_packed_material(beside.brick, own, case.motion.held, along, place=place).moduli
    return replace(beside, moduli=replace(moduli, fric=own.fric, pb_mcf=own.pb_mcf))
