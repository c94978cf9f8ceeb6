"""The pairs of a scene: particles in contact or nearly in contact, listed anew as particles move."""

from dataclasses import fields
from typing import Any

import numpy as np

from dembound.casefile.disks.material import Material
from dembound.disks.contacts.dashpots import Dashpots
from dembound.disks.contacts.pair_rows import PairPlan
from dembound.disks.contacts.pairs import bonds_of, push_at_rest
from dembound.disks.contacts.placing import ContactHistory, Pairs
from dembound.disks.contacts.relisting import HISTORY, RenewedList
from dembound.disks.contacts.row_plan import RowPlan
from dembound.disks.contacts.skins import SKIN
from dembound.disks.material.at_rest import AtRest, stressed
from dembound.disks.material.constants import BondFactors, brick_constants, limits_of
from dembound.disks.material.packed_material import PackedMaterial
from dembound.kernels import contacts as kernel
from dembound.kernels.contacts import INTACT, REFERENCE, SHEAR, TENSION
from dembound.kernels.near import pairs_of
from dembound.laws.law import AnyLimits, columns_of
from dembound.motion.part import Cracks, joined
from dembound.motion.state import Arrays, Layout
from dembound.packings.tiling import Assembly
from dembound.pairwise import STRAIN

_KEPT = ("first", "second", "contact_type", *HISTORY)
"""The arrays of the pairs, besides their forces, that saved_arrays() returns."""


class ContactList(RenewedList):
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
        and the resistance to rolling (m,) of each particle, for those that meet later.
    at_rest : the stress with which contacts begin; None: without forces.
    factors : of the strengths of bonds; None: without scatter. dashpots : of contacts; None: there are none.
    intact : (m,) bool, particles whose bonds never break; None: all may break. lags : of each bond, 3K with K
        relaxation arms, see `Contacts`. beside : (m, k) numbers of the joints each particle is beside, opposite on
        their two sides, else 0: particles of opposite numbers never touch. None: there are no joints.

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
        layers: tuple[AnyLimits, np.ndarray, np.ndarray] | None = None,
        at_rest: AtRest | None = None,
        factors: BondFactors | None = None,
        dashpots: Dashpots | None = None,
        intact: np.ndarray | None = None,
        lags: int = 0,
        beside: np.ndarray | None = None,
    ) -> None:
        super().__init__(assembly, periods, begin, layout)
        self.ground, self.factors, self.dashpots, self.lags = ground, factors, dashpots, lags
        self.limits = limits_of(material) if layers is None else layers[0]
        self._friction, self._rolling = (None, np.zeros(0)) if layers is None else layers[1:]
        self.locked_in = 0.0 if material.locked_in is None else material.locked_in / ground.packed_pressure
        self.searches = self.limits.geometry != REFERENCE
        self._beside = None
        if beside is not None:
            self._beside = np.zeros((self._slots.stop, beside.shape[1]), dtype=np.int64)
            self._beside[self._slot] = beside
        self._apart = np.zeros(0, dtype=np.int64)
        self.skin = SKIN * ground.brick.mean_diameter
        self.time_step = 0.0
        self._set_origin(np.zeros((2, len(assembly.radii))), np.full(len(assembly.radii), 0.5 * self.skin))
        self._left_out = 0
        self.keeps_slip = False
        constants = brick_constants(ground, gaps_close=self.searches, locked_in=self.locked_in)
        if layers is not None:
            constants = np.column_stack([constants, *columns_of(self.limits)])
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
            self._list(pairs, history._replace(lag=None))

    def take_limits(self, limits: AnyLimits, friction: np.ndarray, rolling: np.ndarray) -> None:
        """Have other friction and strengths from now on: of types of contacts, and of particles, see `layers`."""
        width, built = self.ground.law.width + STRAIN, self._built
        columns = np.column_stack(columns_of(limits))
        self.meet_with(friction, rolling)
        pairs, history = self._all()
        self._constants[built.contact_type, width:] = columns[self.assembly.contact_type]
        met = pairs.contact_type >= self.own_types
        self._constants[pairs.contact_type[met], width:] = self._limits_of_met(pairs.first[met], pairs.second[met])
        self._list(pairs, history)

    def meet_with(self, friction: np.ndarray, rolling: np.ndarray) -> None:
        """Have other friction and resistance to rolling of particles (m,) that meet from now on."""
        self._friction, self._rolling = friction, rolling

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
        self._constants = other._constants.copy()
        slots = other._slot[kept] - other._slots.start
        self._set_origin(other.origin[:, slots], other.skins[slots])
        first, second = first[left], second[left]
        if self._beside is not None and other._beside is not None:
            self._beside[self._slot[~other._beside[other._slot[kept]].any(axis=1)]] = 0
            both, image = pairs_of(other._apart, other._slots.stop)
            one, two = (number[other.layout.node[each] - other.nodes.start] for each in both.T)
            stays = (one >= 0) & (two >= 0)
            self._apart = np.sort(self._keys_of(one[stays], two[stays], image[stays]))
        pairs = Pairs(first, second, other.image[left], other.of("contact_type")[left])
        history = ContactHistory(*(other.of(name)[left] for name in (*HISTORY, "place")))
        history = history._replace(rolled=other.of("rolled")[left] if self.rolls else None)
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
        for name in ("state", "shear", "slip", *(("rolled",) if self.rolls else ())):
            getattr(pairs, name)[self.live[found]] = column.of(name)[at[found]]
        pairs.cracked[(pairs.state == TENSION) | (pairs.state == SHEAR)] = 0
        first, second = self.pairs
        moved = displacement[:2, self.nodes].T
        pairs.place[self.live] = 0.5 * (moved[first] + moved[second])
        self.note_cracks()

    @property
    def torn(self) -> np.ndarray:
        """Whether each particle (m,) has lost all its bonds; not of those that had none, nor long ago."""
        torn = np.zeros(len(self.assembly.radii), dtype=np.bool_)
        state, pairs = self.of("state"), np.stack(self.pairs)
        torn[pairs[:, (state == TENSION) | (state == SHEAR)]] = True
        torn[pairs[:, state == INTACT]] = False
        return torn

    def take_cracks(self) -> Cracks:
        """The bonds that broke since the last call."""
        self.note_cracks()
        noted, self._cracks = self._cracks, []
        return joined(noted)

    def saved_arrays(self) -> Arrays:
        """The pairs with their history, and cracks not yet recorded, for a checkpoint."""
        self.note_cracks()
        saved = {name: self.of(name) for name in _KEPT} | {"force": self.force}
        saved |= {"image": self.image, "constants": self._constants.copy()}
        saved |= {"origin": self.origin, "skins": self.skins}
        if self.dashpots is not None:
            saved["drag"] = self.drag
        if self.lags > 0:
            saved["lag"] = self.lag
        if self.rolls:
            saved["rolled"] = self.of("rolled")
        saved["retired"] = self.retired
        if self._beside is not None:
            saved["beside"], saved["apart"] = self._beside.copy(), self._apart.copy()
        saved["keeps_slip"] = np.array(self.keeps_slip)
        cracks = joined(self._cracks)
        return saved | {f"crack_{field.name}": getattr(cracks, field.name) for field in fields(Cracks)}

    def restore(self, saved: Arrays) -> None:
        """Restore the arrays returned by `saved_arrays` in another run of the same case; ValueError for others."""
        if saved["constants"].shape[1:] != self._constants.shape[1:]:
            raise ValueError("constants of contacts are of another law")
        if saved["contact_type"].max(initial=0) >= max(len(saved["constants"]), 1):
            raise ValueError("contacts have types without constants")
        self._constants = saved["constants"].copy()
        slots = self._slot - self._slots.start
        self._set_origin(saved["origin"][:, slots], saved["skins"][slots])
        self.keeps_slip = bool(saved["keeps_slip"])
        self.retired = saved["retired"].copy()
        if self._beside is not None:
            self._beside, self._apart = saved["beside"].copy(), saved["apart"].copy()
        begin, node = self.nodes.start, self.layout.node
        first, second = (node[saved[name]] - begin for name in ("first", "second"))
        pairs = Pairs(first, second, saved["image"], saved["contact_type"])
        history = ContactHistory(**{name: saved[name] for name in HISTORY})
        more: dict[str, Any] = {name: saved.get(name) for name in ("drag", "lag", "rolled")}
        history = history._replace(**more)
        pushed = saved["force"].any(axis=1) & (history.closed == kernel.OPEN)  # as earlier versions wrote it
        closed = np.where(pushed, kernel.CLOSED, history.closed).astype(np.uint8)
        self._list(pairs, history._replace(closed=closed, force=saved["force"]))
        self._cracks = [Cracks(*(saved[f"crack_{field.name}"] for field in fields(Cracks)))]
