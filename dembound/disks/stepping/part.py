"""A part of bonded disks, the body or its free-field column, and the seam that couples them."""

from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from dembound.disks.contacts.contact_list import ContactList
from dembound.disks.contacts.layout import Rows, elastic_constants, with_special
from dembound.disks.contacts.pairs import plain_contacts
from dembound.disks.contacts.placing import NO_DASHPOTS
from dembound.disks.material.at_rest import AtRest
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.stepping.arms import of_all_types
from dembound.disks.stepping.damped_ground import DiskMemories
from dembound.kernels import bonded, bonded_lanes, damped, elastic, elastic_lanes  # noqa: F401  # they register their laws
from dembound.kernels.common import CHUNKS, LIST_ENDS
from dembound.kernels.contact_measures import strain_energy
from dembound.kernels.contacts import LOST, REFERENCE, SLID
from dembound.kernels.relaxing import arms_energy
from dembound.kernels.tables import Contacts, DampedLinks, LaneRows, Seam, SeamEnds
from dembound.kernels.tables.laws import Arms, Bonded, LaneBonded, Links, Relaxing, WatchedLinks
from dembound.motion.part import NO_CRACKS, Cracks, Part, Tie
from dembound.motion.state import Arrays, Layout, State
from dembound.packings.column import Seam as ColumnSeam
from dembound.packings.tiling import Assembly


class DiskPart(Part):
    """Disks under a linear law (kernels/elastic.py) or a history-dependent one (kernels/bonded.py).

    Parameters
    ----------
    name : its name in the state.
    ground : brick and material.
    assembly : its disks and their contacts.
    nodes : their range among the scene's particles.
    rows : the same contacts in the form for a linear law.
    layout : the slots in which kernels hold the scene's particles.
    contacts : its pairs with their history; None where the material's law has none.
    at_rest : stress with which its contacts begin; None: without forces.
    memories : of its forces; None without damping, or where bonds have arms.
    arms : relaxation arms of its bonds; None: there are none.

    Attributes
    ----------
    uses_history : whether the history-dependent law is in use; before, a linear law replaces it. watches : whether the
    loop returns before a contact leaves the linear law. stops_at_breaks : whether it returns after a step in which a
    bond of this part broke. dashes : whether dashpots of contacts act, where the material has some. fastest : (chunks,)
    m/s, speeds of its disks after a step under the history-dependent law; supports move others.
    """

    def __init__(
        self,
        name: str,
        ground: PackedMaterial,
        assembly: Assembly,
        nodes: slice,
        rows: Rows,
        layout: Layout,
        contacts: ContactList | None,
        at_rest: AtRest | None = None,
        memories: DiskMemories | None = None,
        arms: Arms | None = None,
    ) -> None:
        self.name, self.nodes = name, nodes
        self.ground, self.assembly, self.rows, self.layout = ground, assembly, rows, layout
        self.contacts, self.at_rest, self.memories, self.arms = contacts, at_rest, memories, arms
        self.uses_history = self.stops_at_breaks = False
        self.watches = self.dashes = True
        self.fastest, self._way = np.zeros(CHUNKS), np.zeros(2)
        self._law: tuple[tuple[Any, ...], NamedTuple] | None = None
        self._damped, (self._lost, self._also_lost) = np.zeros((CHUNKS, 2)), np.zeros((2, CHUNKS, LOST))
        self._links = Links(rows, self.fastest, self._damped)

    @property
    def law_name(self) -> str:  # type: ignore[override]  # an attribute of other parts
        """Name of the law in use, for reports."""
        return self.ground.law.name if self.uses_history else self.ground.law.linear

    def law(self) -> NamedTuple:
        """The arrays of the law in use; before a history-dependent one begins, a linear law that may check contacts.

        It is the same bundle as long as neither pairs nor flags have changed.
        """
        contacts = self.contacts
        if self.memories is not None:
            return DampedLinks(self._links, self.memories.arrays)
        if contacts is None or not (self.uses_history or self.watches):
            return self._links
        flags = self.uses_history, self.dashes, self.stops_at_breaks, contacts.keeps_slip
        known = contacts.arrays, contacts.cells, *flags
        if self._law is None or any(one is not other for one, other in zip(known, self._law[0], strict=True)):
            self._law = known, self._law_of(contacts)
        return self._law[1]

    def _law_of(self, contacts: ContactList) -> NamedTuple:
        """The law with pairs; those with a history are in rows of copies if their disks are."""
        pairs = contacts.arrays if self.dashes else contacts.arrays._replace(**NO_DASHPOTS)
        listed = (pairs, contacts.limits, contacts.origin, contacts.skins, contacts.cells)
        if not self.uses_history:
            return WatchedLinks(self._links, *listed, contacts.arms, self._way, contacts.keeps_slip)
        if self.arms is not None:
            return self._relaxing(contacts, pairs, self.arms)
        return self._in_rows(contacts, Bonded(*listed, self.stops_at_breaks, *self._space))

    def _relaxing(self, contacts: ContactList, pairs: Contacts, arms: Arms) -> Relaxing:
        """The law with relaxation arms: bonds break by them, and not by the law of their springs alone."""
        endless = {name: getattr(contacts.limits, name) + np.inf for name in self.ground.law.strengths}
        limits = contacts.limits._replace(**endless)
        law = Bonded(pairs, limits, contacts.origin, contacts.skins, contacts.cells, False, *self._space)
        arms = of_all_types(arms, len(pairs.constants))
        return Relaxing(self._in_rows(contacts, law), law, contacts.limits, arms, self.stops_at_breaks)

    @property
    def _space(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Work space of the law."""
        return self._way, self.fastest, self._damped, self._lost

    def _in_rows(self, contacts: ContactList, law: Bonded) -> Bonded | LaneBonded:
        """The law in rows of copies, if its disks are."""
        if contacts.rows is None:
            return law
        assert isinstance(self.rows, LaneRows)
        slots, starts, ends = contacts.strays
        rows = with_special(self.rows, slots)
        return LaneBonded(law, rows, contacts.rows, slots, starts, ends, contacts.extra, self._also_lost)

    def react(self, why: int, steps: int, state: State) -> None:
        """List the pairs anew if some may be missing."""
        if self.contacts is not None and why == LIST_ENDS and self.contacts.is_old(state.u):
            self.contacts.list_anew(state.u, state.v)

    def elastic_forces(self, displacement: np.ndarray) -> np.ndarray:
        """Forces and moments (3, slots) of the elastic law on its disks at displacements (3, n)."""
        u = self.layout.spread(displacement)
        force = np.zeros_like(u)
        elastic.contact_forces(u, self.rows, force)
        return force

    def stored(self, u: np.ndarray) -> tuple[float, float]:
        """Energy (J) in contacts and in bonds at displacements (3, slots)."""
        rolls = self.contacts is not None and self.contacts.rolls and self.uses_history
        law = self.ground.law  # of another package it need not know of rolling
        limits = law.without_limits(self.geometry, rolls=True) if rolls else law.without_limits(self.geometry)
        in_contacts, in_bonds = strain_energy(u, self.pairs, limits)
        if self.arms is not None:
            in_bonds += arms_energy(self.pairs, limits, self.arms)
        return in_contacts, in_bonds

    def take_cracks(self, steps: int) -> Cracks:
        """The bonds that broke since the last call; none under a law without a history."""
        return NO_CRACKS if self.contacts is None else self.contacts.take_cracks()

    def snapshot(self, displacement: np.ndarray) -> dict[str, tuple[np.ndarray, str]]:
        """Number of intact bonds and closed contacts of every disk, if the material's law has a history."""
        return {} if self.contacts is None else {"coordination": (self.contacts.coordination(self.geometry), "1")}

    def saved_arrays(self) -> Arrays:
        """Whether the law in use has a history, and the pairs, for a checkpoint."""
        pairs = {} if self.contacts is None else self.contacts.saved_arrays()
        memories = {} if self.memories is None else self.memories.saved_arrays()
        return {"uses_history": np.array(self.uses_history), **pairs, **memories}

    def restore(self, saved: Arrays) -> None:
        """Restore the arrays returned by `saved_arrays` in another run of the same case."""
        self.uses_history = bool(saved["uses_history"])
        if self.contacts is not None:
            self.contacts.restore(saved)
        if self.memories is not None:
            self.memories.restore(saved)

    @property
    def geometry(self) -> int:
        """Geometry of the pairs under the law in use, see kernels/contacts.py."""
        if self.contacts is None:
            return REFERENCE
        if self.uses_history:
            return self.contacts.limits.geometry
        return SLID if self.contacts.keeps_slip else REFERENCE

    @property
    def pairs(self) -> Contacts:
        """The pairs of its disks for the kernels, by slots, without history if the material's law has none."""
        return self._plain_contacts if self.contacts is None else self.contacts.arrays

    @property
    def stressed_pairs(self) -> Contacts:
        """The pairs with the stress at rest, which `pairs` without history do not include."""
        if self.contacts is not None or self.at_rest is None:
            return self.pairs
        return plain_contacts(self.ground, self.assembly, self.layout.slot[self.nodes], self.at_rest)

    @cached_property
    def _plain_contacts(self) -> Contacts:
        return plain_contacts(self.ground, self.assembly, self.layout.slot[self.nodes])


class FreeFieldSeam(Tie):
    """The forces of the free-field column on the body across its sides; the body does not act on the column.

    Parameters
    ----------
    seam : contacts across it.
    column : the part that represents the ground beyond.
    """

    def __init__(self, seam: ColumnSeam, column: DiskPart) -> None:
        self.seam, self.column, self.nodes = seam, column, seam.node
        self._let_go = np.zeros(len(seam.twin), dtype=np.bool_)
        self._constants, row_of = elastic_constants(column.ground)
        slot = column.layout.slot
        self._row = row_of[2 * seam.contact_type + seam.twin_is_second].astype(np.uint32)
        self._neighbour = slot[seam.neighbour].astype(np.uint32)
        self._ends: tuple[Contacts, np.ndarray] | None = None
        self._bundle: tuple[tuple[Any, ...], NamedTuple] | None = None

    def let_go(self, disks: np.ndarray) -> None:
        """Exert no forces from now on on the disks (n,) bool that have broken off or lost all their bonds."""
        if (disks[: len(self._let_go)] != self._let_go).any():
            self._let_go, self._ends = disks[: len(self._let_go)].copy(), None

    def bundle(self, supported: np.ndarray) -> NamedTuple:
        """The rows of contacts across the seam, under the law in use in the column."""
        contacts = self.column.contacts
        known = supported, self._let_go, contacts.arrays if contacts and self.column.uses_history else None
        if self._bundle is None or any(one is not other for one, other in zip(known, self._bundle[0], strict=True)):
            self._bundle = known, self._bundle_of(supported)
        return self._bundle[1]

    def _bundle_of(self, supported: np.ndarray) -> NamedTuple:
        """See `bundle`."""
        seam = self.seam
        counts = np.zeros(len(supported), dtype=np.uint32)
        counts[np.searchsorted(supported, seam.node)] = np.where(self._let_go[seam.node], 0, seam.contact_counts)
        start = np.zeros(len(supported) + 1, dtype=np.uint32)
        np.cumsum(counts, out=start[1:])
        if not self.column.uses_history:
            twin = np.zeros(len(supported), dtype=np.int64)  # of no use where there are no contacts
            twin[counts > 0] = self.column.layout.slot[seam.twin[supported[counts > 0]]]
            return Seam(twin, start, self._neighbour, self._row, self._constants)
        assert self.column.contacts is not None
        ends = self.ends(self.column.contacts).astype(np.uint32)
        return SeamEnds(start, ends, self.column.contacts.arrays.force)

    def elastic_forces(self, displacement: np.ndarray) -> np.ndarray:
        """Forces and moments (3, k) on its nodes at displacements (3, n) under the elastic law."""
        force = np.zeros((len(self.nodes), 3))
        layout = self.column.layout
        twin = layout.slot[self.seam.twin[self.nodes]]
        seam = Seam(twin, self.seam.start, self._neighbour, self._row, self._constants)
        elastic.seam_forces(seam, layout.spread(displacement), np.zeros((3, 0)), force)
        return force.T

    def last_forces(self, contacts: ContactList) -> np.ndarray:
        """Forces and moments (3, k) on its nodes from the last forces of the column's pairs."""
        force = np.zeros((len(self.nodes), 3))
        assert not self._let_go.any()
        ends = SeamEnds(self.seam.start, self.ends(contacts).astype(np.uint32), contacts.arrays.force)
        bonded.seam_ends_forces(ends, np.zeros((3, 0)), np.zeros((3, 0)), force)
        return force.T

    def ends(self, contacts: ContactList) -> np.ndarray:
        """Contact ends (e,) of the column's pairs of its particles' contacts across the seam, in the seam's order."""
        if self._ends is None or self._ends[0] is not contacts.arrays:
            owner, near, vectors = self.seam.pairs(contacts.ground.brick)
            owner, near = owner - self.seam.disks.start, near - self.seam.disks.start
            _, pair = contacts.find(owner, near, vectors)
            image = contacts.images(owner, near, vectors)
            turned = (contacts.pairs[0][pair] != owner) | (contacts.image[pair] != image).any(axis=1)
            acting = ~np.repeat(self._let_go[self.seam.node], self.seam.contact_counts)
            self._ends = contacts.arrays, (2 * contacts.live[pair] + turned)[acting]
        return self._ends[1]
