"""The pairs of a scene: particles in contact or nearly in contact, listed anew as particles move."""

from dataclasses import fields

import numpy as np

from dembound.casefile.disks.material import Material
from dembound.disks.contacts.dashpots import Dashpots
from dembound.disks.contacts.pair_list import NO_LIMITS, PairList
from dembound.disks.contacts.pair_rows import PairPlan
from dembound.disks.contacts.pairs import SPARE, ContactHistory, Pairs, bonds_of, push_at_rest, with_ends
from dembound.disks.contacts.row_plan import RowPlan
from dembound.disks.contacts.skins import SKIN, skins_of
from dembound.disks.material.at_rest import StressAtRest, stressed
from dembound.disks.material.constants import BondFactors, brick_constants, limits_of, shared_constants
from dembound.disks.material.packed_material import PackedMaterial
from dembound.kernels import contacts as kernel
from dembound.kernels.contacts import NONE, REFERENCE, SHEAR, TENSION
from dembound.kernels.listing import keys_of, merged
from dembound.kernels.near import near_keys, pairs_of, room
from dembound.laws.law import Limits
from dembound.motion.part import Cracks, joined
from dembound.motion.state import Arrays, Layout
from dembound.packings.tiling import Assembly
from dembound.pairwise import STRAIN, of_law

_HISTORY = ("state", "shear", "slip", "closed", "cracked", "kept")
"""The arrays of the pairs' history variables, in the order of `ContactHistory`."""

GRAIN = 1e-12
"""To which share of the mean diameter places of near pairs are rounded, so that copies of a pair share a row."""

_KEPT = ("first", "second", "contact_type", *_HISTORY)
"""The arrays of the pairs, besides their forces, that saved_arrays() returns."""


class ContactList(PairList):
    """All pairs of a part that are in contact or may soon be, with their history.

    Displacements (3, n) are those of all nodes of the scene.

    Parameters
    ----------
    ground : brick and material.
    material : gives the limits of the law.
    assembly : the part's particles at the start.
    periods : length (m) of the part along x and y where it is periodic, else None.
    begin : number of its first particle in the scene.
    held : first, second (k,) particles of the part and vectors (k, 2) m of pairs that stay listed at any distance.
    layout : the slots in which kernels hold the scene's particles; None: in their order. Nodes of continua, which
        follow the particles, are not among them, as a static stage may have fewer of them.
    plan : the rows of copies in which the part's particles are held, and their first block; None: one by one.
    layers : in layered ground the limits of each type of contact in columns, see `limits_between`, and the friction
        (m,) of each particle, for those that meet later.
    at_rest : the stress with which contacts begin; None: without forces.
    factors : of the strengths of bonds; None: without scatter. dashpots : of contacts; None: there are none.
    intact : (m,) bool, particles whose bonds never break; None: all may break.

    Attributes
    ----------
    In addition to those of `PairList`:

    limits : strengths and friction; in layered ground columns of the rows of constants.
    kind : (b,) types of the contacts as built, rows of `bonds`.
    skin : m, gap up to which the list is complete, beside fast particles more. time_step : s, of the run.
    keeps_slip : whether the elastic law is used again after contacts have slid, which keep their slip.
    retired : (m,) bool, particles that meet no others any more.
    arms : (slots,) m, the longest arm of the contacts and bonds of the particle in each slot of the part, else 0.
    """

    def __init__(
        self,
        ground: PackedMaterial,
        material: Material,
        assembly: Assembly,
        periods: tuple[float | None, float | None],
        begin: int = 0,
        held: tuple[np.ndarray, np.ndarray, np.ndarray] | None = None,
        layout: Layout | None = None,
        plan: tuple[RowPlan, int] | None = None,
        layers: tuple[Limits, np.ndarray] | None = None,
        at_rest: StressAtRest | None = None,
        factors: BondFactors | None = None,
        dashpots: Dashpots | None = None,
        intact: np.ndarray | None = None,
    ) -> None:
        super().__init__(assembly, periods, begin, layout)
        self.ground, self.factors, self.dashpots = ground, factors, dashpots
        self.limits = limits_of(material) if layers is None else layers[0]
        self._friction = None if layers is None else layers[1]
        self.locked_in = 0.0 if material.locked_in is None else material.locked_in / ground.packed_pressure
        self.searches = self.limits.geometry != REFERENCE
        self.skin = SKIN * ground.brick.mean_diameter
        self.time_step = 0.0
        self._set_origin(np.zeros((2, len(assembly.radii))), np.full(len(assembly.radii), 0.5 * self.skin))
        self._left_out = 0
        self.keeps_slip = False
        constants = brick_constants(ground, gaps_close=self.searches, locked_in=self.locked_in)
        if layers is not None:
            constants = np.column_stack([constants, *self.limits[:4]])
        self.bonds, self.kind, self._begun_slip = stressed(ground, constants, assembly, at_rest)
        first, second = assembly.pairs.T.astype(np.int64)
        pairs = Pairs(first, second, self.images(first, second, self.bonds[self.kind, :2]), self.kind)
        self._built = pairs
        bonded = bonds_of(self.ground.law, self.bonds, self.kind)
        zero, none = np.zeros(len(first)), np.zeros(len(first), dtype=np.uint8)
        closed = np.full_like(none, kernel.CLOSED)
        self.own_types = len(self.bonds)
        self._constants = self.bonds
        slip = self._begun_slip[self.kind]
        self._intact = np.zeros(len(assembly.radii), dtype=np.bool_) if intact is None else intact
        self._list(
            pairs, ContactHistory(bonded, zero, slip, closed, np.full(len(first), -1), self._kept(first, second, none))
        )
        widest = np.maximum(ground.moduli.pb_rmul, 1.0) * assembly.radii
        self.arms = np.zeros(self.layout.count)
        self.arms[self._slot] = widest + 0.5 * max(float(ground.brick.gaps.max(initial=0.0)), 0.0)
        self._cracks: list[Cracks] = []
        self._built_keys = self._keys_of(first, second, pairs.image)
        self._built_order = np.argsort(self._built_keys)
        self._held = np.zeros(0, dtype=np.int64)
        if held is not None:
            self._held = np.sort(self._keys_of(held[0], held[1], self.images(*held)))
        self.retired = np.zeros(len(assembly.radii), dtype=np.bool_)
        if self.searches:
            self.search(np.zeros((3, len(self.layout.slot))))
        if plan is not None:
            pairs, history = self._all()
            # near pairs of the start are the same in all copies, as contacts are
            self.bonds = self._constants = self._constants[: max(self.own_types, int(pairs.contact_type.max()) + 1)]
            self._plan = PairPlan.of(pairs.first, pairs.second, pairs.contact_type, len(self.bonds), *plan)
            self._list(pairs, history)

    def start_from_displacements(self, displacement: np.ndarray) -> None:
        """Set the pairs to the state of the elastic law at displacements (3, n).

        Their slip is that under the stress at rest, or the kept one.
        """
        kernel.start_from_displacements(self.spread(displacement), self.arrays, self.keeps_slip)
        if self._begun_slip.any() and not self.keeps_slip:
            kind, slip = self.arrays.contact_type, self.arrays.slip
            own = np.flatnonzero((kind < self.own_types) & (slip == 0.0))  # others are open
            slip[own] = self._begun_slip[kind[own]]

    def use_elastic_law_with(self, slip: np.ndarray) -> None:
        """Keep a slip (places of `arrays`), see `elastic_again.settled_slip`, under the elastic law."""
        self.arrays.slip[:] = slip
        self.keeps_slip = True

    def push(self, displacement: np.ndarray, *, reference: bool = False) -> None:
        """Compute the forces of the pairs at displacements (3, n) at rest, and store them in `arrays`.

        reference : with the geometry of the start, as under the elastic law.
        """
        endless = {name: getattr(self.limits, name) + np.inf for name in self.ground.law.strengths}
        elastic = self.limits._replace(geometry=REFERENCE, **endless)
        limits = elastic if reference else self.limits
        u = self.spread(displacement)
        if push_at_rest(u, self.arrays, limits) > 0:
            kernel.note_places(u, 0, self.arrays)

    def add_forces(self, total: np.ndarray) -> None:
        """Add the pairs' last forces and moments to those of all nodes, total (3, n)."""
        force = np.empty((3, self.layout.count))
        kernel.sum_forces(self.arrays, force)
        total[:, self.nodes] += force[:, self._slot]

    def is_old(self, u: np.ndarray) -> bool:
        """Whether at displacements (3, slots) a particle has moved so far that pairs may be missing."""
        return bool(room(u, self._slots.start, self.origin, self.skins, self.cells) < 0.0)

    def search(self, displacement: np.ndarray) -> None:
        """List the pairs anew for displacements (3, n) of disks at rest, see `list_anew`."""
        self.list_anew(self.spread(displacement))

    def list_anew(self, u: np.ndarray, v: np.ndarray | None = None) -> None:
        """List the pairs anew for displacements u (3, slots): add near pairs, remove distant ones without bond.

        v : (3, slots) m/s, by which fast particles get wider skins; None: all have the same, and pairs at the same
        place of different bricks share their constants.
        """
        self.note_cracks()
        moved = u[:2, self._slot].T
        if not np.isfinite(moved).all():
            return  # the `Watch` of the run raises the error
        if np.count_nonzero(self.retired) > self._left_out:
            self._leave_out_retired()
        skins = np.full(self._slots.stop - self._slots.start, 0.5 * self.skin)
        if v is not None:
            skins = skins_of(v, self._slots.start, self.cells, self.time_step, self.ground.brick.mean_diameter)
        old = self._keys[self._in_rows :]
        near = self._near(moved, skins)
        keys, source = merged(near, old, self.arrays.state[self._singles], self._held, self._row_keys)
        met = self._met(keys[source < 0], source, shares=v is None)
        begin = self._singles.start
        if len(keys) > len(self.arrays.first) - begin:
            self._list(*self._all(), room=len(keys))
        self._carry(source, met)
        self.arrays = with_ends(self.arrays, keys, begin, self._slots.stop)
        self.live = np.concatenate([self.live[: self._in_rows], begin + np.arange(len(keys))])
        self._keys = np.concatenate([self._keys[: self._in_rows], keys])
        self._note_strays()
        self._set_origin(moved.T, skins[self._slot - self._slots.start])

    @property
    def _singles(self) -> slice:
        """Places of the pairs in no row."""
        return slice(int(self.arrays.bound[0]), int(self.arrays.bound[-1]))

    def _keys_of(self, first: np.ndarray, second: np.ndarray, images: np.ndarray) -> np.ndarray:
        """Keys (b,) of pairs of particles, see near.near_keys, by their slots."""
        return keys_of(self._slot[first], self._slot[second], images, self._slots.stop)[0]

    def _near(self, moved: np.ndarray, skins: np.ndarray) -> np.ndarray:
        """Keys of pairs with gaps up to the sum of their skins (slots,) m, of particles that moved (m, 2) m."""
        ranks, radii = self._ranks, self.assembly.radii[self._ranks]
        slot = self._slot[ranks]
        own = skins[slot - self._slots.start]
        reach = np.where(self.retired[ranks], -np.inf, radii + own)
        usual = (float(radii.max()) + float(own.min())) * (1.0 + 1e-12)  # of disks that are not fast
        lengths = np.array([length or 0.0 for length in self.periods])
        return near_keys((self.assembly.positions + moved)[ranks], reach, lengths, slot, usual)

    def _met(self, keys: np.ndarray, source: np.ndarray, *, shares: bool) -> Pairs:
        """Pairs (k,) of some keys that are not listed; contacts of the brick that had parted have their constants.

        source : of all pairs, see `merged`; shares : whether constants are shared.
        """
        both, image = pairs_of(keys, self._slots.stop)
        first, second = (self.layout.node[both] - self.nodes.start).T
        kind, built = np.zeros(len(keys), dtype=np.int64), self._built
        at = np.searchsorted(self._built_keys, keys, sorter=self._built_order)
        own = self._built_order[np.minimum(at, len(self._built_order) - 1)] if len(self._built_order) > 0 else at
        parted = self._built_keys[own] == keys if len(self._built_order) > 0 else np.zeros(len(keys), dtype=np.bool_)
        own = own[parted]
        first[parted], second[parted], image[parted] = built.first[own], built.second[own], built.image[own]
        kind[parted] = built.contact_type[own]
        new = ~parted
        kind[new] = self._enter(first[new], second[new], image[new], source, shares=shares)
        return Pairs(first, second, image, kind)

    def _enter(
        self, first: np.ndarray, second: np.ndarray, image: np.ndarray, source: np.ndarray, *, shares: bool
    ) -> np.ndarray:
        """Types (k,) of new pairs: rows of constants, in layered ground with limits, that no pair uses any more."""
        if len(first) == 0:
            return first
        positions, radii = self.assembly.positions, self.assembly.radii
        vectors = positions[second] - positions[first] + image * [length or 0.0 for length in self.periods]
        unit = GRAIN * self.ground.brick.mean_diameter
        vectors = np.round(vectors / unit) * unit  # alike in copies of a brick, whatever other pairs there are
        zones = self.ground.zone_of(positions[first, 1]), self.ground.zone_of(positions[second, 1])
        both_radii, locked_in = (radii[first], radii[second]), self.locked_in
        constants = self.ground.pair_constants(both_radii, vectors, zones, bonded=False, locked_in=locked_in)
        if self._friction is not None:
            limits = np.repeat(NO_LIMITS, len(first), axis=0)
            limits[:, 0] = np.minimum(self._friction[first], self._friction[second])
            constants = np.column_stack([constants, limits])
        row_of = np.arange(len(constants))
        if shares:
            constants, row_of = shared_constants(constants, np.column_stack(zones), self.ground.law.width)
        used = np.zeros(len(self._constants), dtype=np.bool_)
        used[: len(self.bonds)] = True
        used[self.arrays.contact_type[self._singles][source[source >= 0]]] = True
        row = np.flatnonzero(~used)[: len(constants)]
        if len(row) < len(constants):
            before, more = len(self._constants), len(constants) + len(self._constants) // SPARE
            self._constants = np.vstack([self._constants, np.zeros((more, self._constants.shape[1]))])
            self._list(*self._all())
            row = np.concatenate([row, before + np.arange(len(constants) - len(row))])
        self._constants[row] = constants
        own, limits = np.split(constants, [self.ground.law.width + STRAIN], axis=1)
        self.arrays.constants[row] = of_law(own)
        for name, values in zip(self.limits._fields, limits.T, strict=False):
            getattr(self.limits, name)[row] = values
        return row[row_of]

    def _carry(self, source: np.ndarray, met: Pairs) -> None:
        """Fill the places of pairs in no row: with pairs listed before, by their number (b,), or with met ones in turn."""
        arrays, before, is_met = self.arrays, self._singles, source < 0
        index = np.where(is_met, before.stop - before.start + np.cumsum(is_met) - 1, source)
        first, second = self._slot[met.first], self._slot[met.second]
        nowhere, nothing = int(self._slot[0]), len(arrays.constants) - 1
        columns = [
            (arrays.first, first, nowhere), (arrays.second, second, nowhere),
            (arrays.contact_type, met.contact_type, nothing), (arrays.state, NONE, NONE), (arrays.shear, 0, 0),
            (arrays.slip, 0, 0), (arrays.closed, kernel.OPEN, kernel.OPEN), (arrays.cracked, -1, -1),
            (arrays.place.T, 0, 0), (arrays.kept, 0, 0), (arrays.force, 0, 0), (self._images.T, met.image.T, 0),
        ]  # fmt: skip
        if self.dashpots is not None:
            viscosity = self.dashpots.between(first, second, arrays.constants[met.contact_type])
            columns += [(arrays.viscosity, viscosity, 0), (arrays.drag, 0, 0)]
        if self.factors is not None:
            columns.append((self.limits.factor, self._factors_of(self.factors, met.first, met.contact_type), 1))
        for column, values, empty in columns:
            new = np.empty((*column.shape[:-1], len(met.first)), dtype=column.dtype)
            new[...] = values
            now = np.concatenate([column[..., before], new], axis=-1).take(index, axis=-1)
            column[..., before] = empty
            column[..., before.start : before.start + len(source)] = now

    def _all(self) -> tuple[Pairs, ContactHistory]:
        """All pairs with their history."""
        history = ContactHistory(*(self.of(name) for name in (*_HISTORY, "place")), force=self.force, drag=self._drag)
        return Pairs(*self.pairs, self.image, self.of("contact_type")), history

    @property
    def _drag(self) -> np.ndarray | None:
        """Last forces (b, 2) of the dashpots of the pairs; None without dashpots."""
        return None if self.dashpots is None else self.arrays.drag[:, self.live].T

    def _leave_out_retired(self) -> None:
        """Remove the pairs of particles that meet no others any more."""
        self._left_out = int(np.count_nonzero(self.retired))
        pairs, history = self._all()
        stays = ~(self.retired[pairs.first] | self.retired[pairs.second])
        left = Pairs(**{name: each[stays] for name, each in vars(pairs).items()})
        self._list(left, ContactHistory(*(None if each is None else each[stays] for each in history)))

    def _kept(self, first: np.ndarray, second: np.ndarray, kept: np.ndarray) -> np.ndarray:
        """Whether the bonds between particles (b,) may break, (b,) uint8, if it was kept (b,) before."""
        return np.maximum(
            kept, np.where(self._intact[first] | self._intact[second], kernel.KEPT, kernel.MAY_BREAK)
        ).astype(np.uint8)

    def take_over_subset(self, other: "ContactList", kept: np.ndarray) -> None:
        """Copy the pairs, with their history, from a list of more particles, of which this list has `kept` (m,)."""
        number = np.full(len(other.assembly.radii), -1)
        number[kept] = np.arange(len(kept))
        first, second = (number[particles] for particles in other.pairs)
        left = (first >= 0) & (second >= 0)
        self._constants = other._constants
        slots = other._slot[kept] - other._slots.start
        self._set_origin(other.origin[:, slots], other.skins[slots])
        first, second = first[left], second[left]
        pairs = Pairs(first, second, other.image[left], other.of("contact_type")[left])
        history = ContactHistory(*(other.of(name)[left] for name in (*_HISTORY, "place")))
        self._list(pairs, history._replace(kept=self._kept(first, second, other.of("kept")[left])))

    def copy_twins(self, column: "ContactList", twin: np.ndarray, displacement: np.ndarray) -> None:
        """Copy the history of each pair's twin from a settled free-field column, at displacements (3, n).

        twin : (m,) the column's particle for each of this list. Bonds that broke in the column count here as broken
        before the first step.
        """
        self.search(displacement)
        pairs = self.arrays
        first, second = (twin[particles] for particles in self.pairs)
        found, at = column.find(first, second, self._constants[self.of("contact_type"), :2])
        for name in ("state", "shear", "slip"):
            getattr(pairs, name)[self.live[found]] = column.of(name)[at[found]]
        pairs.cracked[(pairs.state == TENSION) | (pairs.state == SHEAR)] = 0
        first, second = self.pairs
        moved = displacement[:2, self.nodes].T
        pairs.place[self.live] = 0.5 * (moved[first] + moved[second])
        self.note_cracks()

    def note_cracks(self) -> None:
        """Record the bonds that broke since the last call, with their positions."""
        if not (self.arrays.cracked >= 0).any():
            return
        cracked, state = self.of("cracked"), self.of("state")
        broken = np.flatnonzero(cracked >= 0)
        first, second = (particles[broken] for particles in self.pairs)
        order = np.lexsort((second, first, cracked[broken]))
        broken, first, second = broken[order], first[order], second[order]
        half = 0.5 * self._constants[self.of("contact_type")[broken], :2]
        middle = self.assembly.positions[first] + half + self.of("place")[broken]
        both = np.column_stack([first, second]) + self.nodes.start
        self._cracks.append(Cracks(cracked[broken], both, middle, state[broken] == SHEAR))
        self.arrays.cracked[:] = -1

    def take_cracks(self) -> Cracks:
        """The bonds that broke since the last call."""
        self.note_cracks()
        noted, self._cracks = self._cracks, []
        return joined(noted)

    def saved_arrays(self) -> Arrays:
        """The pairs with their history, and cracks not yet recorded, for a checkpoint."""
        self.note_cracks()
        saved = {name: self.of(name) for name in _KEPT} | {"force": self.force}
        saved |= {"image": self.image, "constants": self._constants}
        saved |= {"origin": self.origin, "skins": self.skins}
        if self.dashpots is not None:
            saved["drag"] = self._drag
        saved["retired"] = self.retired
        saved["keeps_slip"] = np.array(self.keeps_slip)
        cracks = joined(self._cracks)
        return saved | {f"crack_{field.name}": getattr(cracks, field.name) for field in fields(Cracks)}

    def restore(self, saved: Arrays) -> None:
        """Restore the arrays returned by `saved_arrays` in another run of the same case; ValueError for others."""
        if saved["constants"].shape[1:] != self._constants.shape[1:]:
            raise ValueError("constants of contacts are of another law")
        if saved["contact_type"].max(initial=0) >= max(len(saved["constants"]), 1):
            raise ValueError("contacts have types without constants")
        self._constants = saved["constants"]
        slots = self._slot - self._slots.start
        self._set_origin(saved["origin"][:, slots], saved["skins"][slots])
        self.keeps_slip = bool(saved["keeps_slip"])
        self.retired = saved["retired"].copy()
        begin, node = self.nodes.start, self.layout.node
        first, second = (node[saved[name]] - begin for name in ("first", "second"))
        pairs = Pairs(first, second, saved["image"], saved["contact_type"])
        history = ContactHistory(**{name: saved[name] for name in _HISTORY}, drag=saved.get("drag"))
        pushed = saved["force"].any(axis=1) & (history.closed == kernel.OPEN)  # as earlier versions wrote it
        closed = np.where(pushed, kernel.CLOSED, history.closed).astype(np.uint8)
        self._list(pairs, history._replace(closed=closed, force=saved["force"]))
        self._cracks = [Cracks(*(saved[f"crack_{field.name}"] for field in fields(Cracks)))]
