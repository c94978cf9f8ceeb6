"""Moving bonded disks: the body, its free-field column, and the change from the elastic to the full law."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import chain

import numpy as np

from dembound.disks.body import DiskBody
from dembound.disks.contacts.arrays import plain_contacts
from dembound.disks.contacts.contact_list import ContactList
from dembound.disks.contacts.elastic_again import elastic_again, never_elastic_again, settled_refused
from dembound.disks.contacts.forces import contact_columns, pieces
from dembound.disks.contacts.layout import with_supports
from dembound.disks.stepping.balance import Balance
from dembound.disks.stepping.continuum_ties import grids, tied_nodes, walls
from dembound.disks.stepping.near_ties import NearTies
from dembound.disks.stepping.part import DiskPart, FreeFieldSeam
from dembound.disks.stepping.rotation import turned_as_a_whole, turns_freely
from dembound.disks.stepping.stress import part_stress
from dembound.kernels.common import BROKE, LAW_ENDS, LIST_ENDS
from dembound.kernels.contacts import REFERENCE, UPDATED
from dembound.kernels.follower import turn_forces
from dembound.motion.part import System
from dembound.motion.state import Arrays, State, within
from dembound.outside.part import GridPart


@dataclass(frozen=True)
class Start:
    """A body at rest to start from: displacement (3, n) since it was built, and its contacts.

    contacts : those of each part by name, empty if the scene's law has no history. The system that starts from them
    changes them, so a start can be used only once. has_history : whether they have any history.
    """

    displacement: np.ndarray
    contacts: Mapping[str, ContactList] = field(default_factory=dict)
    has_history: bool = False

    def __post_init__(self) -> None:
        """Store displacements row after row, as in a record, so that sums over them have the same bits from there."""
        object.__setattr__(self, "displacement", np.ascontiguousarray(self.displacement))


class DiskSystem(System):
    """The parts of a scene of disks.

    Parameters
    ----------
    scene : the scene to be moved.
    time_step : Δt in s.
    start : a body that has settled; the forces on its particles are balanced from then on, unless it is `settling`
    again. None: as built, with nothing balanced. settling : whether this is a static stage, in which forces are not
    balanced. load : (3, n) steady forces and moments (N, N·m); None: the scene's own.

    Attributes
    ----------
    balance : the forces that balance those in a settled body; None for a body as built or settling. is_elastic_again :
    whether the elastic law is used again after a static stage that left it; refused : why not where it is asked for.
    near_ties : what leaves the elastic range near ties to a continuum; None without one, or without a history.
    """

    def __init__(
        self,
        scene: DiskBody,
        time_step: float,
        start: Start | None = None,
        *,
        settling: bool = False,
        load: np.ndarray | None = None,
    ) -> None:
        lists: Mapping[str, ContactList] = {}
        if scene.has_history:
            lists = scene.contact_lists() if start is None else start.contacts
        supported = scene.layout.slot[np.union1d(scene.supports.node, tied_nodes(scene))]
        parts = [
            DiskPart(
                name, scene.ground, scene.assembly.part(nodes), nodes, with_supports(rows, supported), scene.layout,
                lists.get(name),
            )
            for (name, nodes), rows in zip(scene.parts.items(), scene.rows, strict=True)
        ]  # fmt: skip
        ties = [] if scene.seam is None else [FreeFieldSeam(scene.seam, parts[0])]
        for part in parts:
            part.watches = not settling
        self.disk_parts, self._seams = tuple(parts), tuple(ties)
        super().__init__(
            [*parts, *grids(scene, time_step)], [*walls(scene), *ties], scene.steady_load if load is None else load
        )
        self.balance: Balance | None = None
        self.is_elastic_again = False
        self.scene, self._time_step = scene, time_step
        self._start, self._settling = start, settling
        watches = scene.outside is not None and scene.has_history and not settling
        self.near_ties = NearTies(scene, self.contacts["body"]) if watches else None

    def apply(self, load: np.ndarray) -> None:
        """Replace the steady forces and moments (3, n) of a settling body."""
        if self.steady.shape[1] == 0:
            self.steady = np.zeros_like(load)
        self.steady += load - self.load
        self.load = load

    def begin(self, state: State) -> None:
        """Choose the first law, and the steady forces that belong to it."""
        scene, start = self.scene, self._start
        # a locked-in stress also acts through the seam of a free field, but not under the elastic law
        through = bool(self._seams) and scene.case.material.locked_in is not None and not self._settling
        has_history = start is not None and start.has_history
        if has_history and not self._settling and scene.case.reduce.settled and not never_elastic_again(scene.case):
            reason = elastic_again(self.contacts.values(), state.datum)
            self.is_elastic_again, has_history = reason == "", reason != ""
            self.refused = settled_refused(reason)
        if start is not None and not self._settling:
            springs = self._offset(state.datum)
            resting = self._resting_force(state.datum, has_history=has_history)
            self._balance(springs - resting - self.load, state.datum)
            steady = springs - self.elastic_forces(state.datum)
        elif scene.has_history and not has_history:
            # the elastic law does not include the forces of the body as built, such as a locked-in stress
            rest = np.zeros_like(self.load)
            steady = self.load + self._forces_of_history(rest, fresh=True)
        else:
            steady = self.load
        if steady.any():
            self.steady = steady.copy()
        at_once = through or not (self._settling or scene.case.material.elastic_start)
        if has_history or (scene.has_history and at_once):
            self.switch(state, fresh=not has_history)
        else:
            super().begin(state)

    def react(self, why: int, steps: int, state: State) -> None:
        """Change the law if contacts are about to leave the elastic range; end the forces on broken-off pieces."""
        if why == LAW_ENDS:
            self.switch(state)
        elif self.balance is not None and self.uses_history and why in (BROKE, LIST_ENDS):
            self.balance.end_on_debris(
                self.disk_parts, state.displacement, state.velocity, self._time_step, self.steady
            )
        super().react(why, steps, state)
        if self.near_ties is not None and self.uses_history:
            self.near_ties.look(state, self.contacts["body"])

    def elastic_forces(self, displacement: np.ndarray) -> np.ndarray:
        """Contact and seam forces and moments (3, n) of the elastic law at displacements (3, n)."""
        force = np.zeros_like(displacement)
        for part in self.disk_parts:
            part.add_elastic_forces(displacement, force)
        for tie in self._seams:
            force[:, tie.nodes] += tie.elastic_forces(displacement)
        return force

    def saved(self, state: State) -> tuple[str, ...]:
        """The steps under the elastic law after a static stage that left it."""
        if not self.is_elastic_again:
            return ()
        steps = state.laws[1][1] if len(state.laws) > 1 else state.step
        return (f"law: elastic after settling, as nothing is open or slides, for {steps:,} of {state.step:,} steps",)

    @property
    def recorded_parts(self) -> tuple[DiskPart, ...]:
        """The parts of disks."""
        return self.disk_parts

    @property
    def law_name(self) -> str:
        """Name of the law of the disks in use, for reports."""
        return self.disk_parts[-1].law_name

    @property
    def uses_history(self) -> bool:
        """Whether the history-dependent law is in use."""
        return all(part.uses_history for part in self.disk_parts)

    @property
    def contacts(self) -> dict[str, ContactList]:
        """The pairs of each part by name, empty if the material's law has no history."""
        return {part.name: part.contacts for part in self.disk_parts if part.contacts is not None}

    def last_forces(self, contacts: Mapping[str, ContactList]) -> np.ndarray:
        """Forces and moments (3, n) from the last forces of each part's pairs, those across a seam included."""
        force = np.zeros((3, self.scene.count))
        for pairs in contacts.values():
            pairs.add_forces(force)
        return force + self._across(contacts)

    def stress(self, displacement: np.ndarray) -> np.ndarray:
        """Stress (m, 3) xx, yy, xy in Pa of all particles at displacements (3, n), tension positive."""
        return np.concatenate([part_stress(self.scene, part, displacement) for part in self.disk_parts])

    def contact_forces(self, displacement: np.ndarray) -> dict[str, tuple[np.ndarray, str]]:
        """The contacts and bonds of the whole scene at displacements (3, n) of this one, see `contact_columns`.

        Only with output.contacts. Of a smaller scene, which is under the elastic law, all disks are moved.
        """
        scene, whole = self.scene, self.scene.whole
        if not scene.case.output.contacts:
            return {}
        lists = [(part.pairs, part.geometry) for part in self.disk_parts]
        if whole is not scene:
            assert isinstance(whole, DiskBody)
            displacement = scene.widened("displacement", displacement.T).T
            lists = [(plain_contacts(whole.ground, whole.assembly, whole.layout.slot), REFERENCE)]
        each = (pieces(whole.layout, pairs, displacement, geometry) for pairs, geometry in lists)
        return contact_columns(chain.from_iterable(each))

    def snapshot(self, displacement: np.ndarray) -> dict[str, tuple[np.ndarray, str]]:
        """Fields of every disk at displacements (3, n) other than its motion; stress only with output.stress."""
        known = super().snapshot(displacement)
        if self.scene.case.output.stress:
            known["stress"] = self.stress(displacement), "Pa"
        return known

    def snapshot_beside(self, displacement: np.ndarray) -> dict[str, tuple[np.ndarray, str]]:
        """Stress of the nodes of the continuum, if there is one, at displacements (3, n)."""
        return next((part.snapshot(displacement) for part in self.parts if isinstance(part, GridPart)), {})

    def balancing_work(self, u: np.ndarray) -> float:
        """Work (J) up to displacements (3, slots) of forces that balance a settled stress, without their rotation."""
        return 0.0 if self.balance is None else self.balance.work(self.scene.layout.gather(u))

    def spring_shift(self, u: np.ndarray) -> float:
        """Work (J) up to displacements (3, slots) of the balancing forces that shift springs and ties to rest."""
        if self.balance is None:
            return 0.0
        moved = self.scene.layout.gather(u) - self.balance.datum
        return float(np.sum(self._offset(self.balance.datum) * moved))

    @property
    def balancing_force(self) -> np.ndarray | None:
        """Forces (3, n) N and N·m that balance a settled stress, without their rotation; None if there are none."""
        return None if self.balance is None else self.balance.force

    def memory(self) -> Arrays:
        """All arrays that change during a run except the motion, by name."""
        memory = dict(super().memory())
        for owner, kept in (("balance", self.balance), ("near_ties", self.near_ties)):
            memory |= {} if kept is None else {f"{owner}/{name}": values for name, values in kept.memory().items()}
        return memory

    def recall(self, memory: Arrays) -> None:
        """Restore what `memory` has returned in another run of the same case."""
        super().recall(memory)
        kept = within(memory, "balance")
        self.balance = Balance.recalled(self.scene, kept) if kept else None
        if self.near_ties is not None:
            self.near_ties.recall(within(memory, "near_ties"))
        self._watch_breaks()
        self._follow()

    def tie_forces(self, displacement: np.ndarray) -> np.ndarray:
        """Forces and moments (3, n) of the ties to continua at displacements (3, n), at rest."""
        force, u = np.zeros_like(displacement), self.scene.layout.spread(displacement)
        for each in self.scene.continua:
            each.add_tie_forces(self.scene.layout, u, force)
        if self.scene.foot is not None:
            assert self.scene.twin is not None
            force[:, self.scene.on_foot] += force[:, self.scene.twin[self.scene.on_foot]]
        return force

    def _offset(self, datum: np.ndarray) -> np.ndarray:
        """Forces (3, n) that shift the zero of springs and ties to the datum."""
        return self.scene.supports.springs_at(datum) - self.tie_forces(datum)

    def _resting_force(self, datum: np.ndarray, *, has_history: bool) -> np.ndarray:
        """Contact forces (3, n) of the body at rest at the datum."""
        if not self.scene.has_history:
            return self.elastic_forces(datum)
        return self._forces_of_history(datum, fresh=not has_history)

    def _forces_of_history(self, displacement: np.ndarray, *, fresh: bool) -> np.ndarray:
        """Contact forces (3, n) of the history-dependent law at rest at displacements (3, n); fresh: no history."""
        self._adopt(displacement, fresh)
        for pairs in self.contacts.values():
            pairs.push(displacement)
        return self.last_forces(self.contacts)

    def _across(self, contacts: Mapping[str, ContactList]) -> np.ndarray:
        """Forces and moments (3, n) that act through the seam of a free field, from the pairs' last forces."""
        force = np.zeros((3, self.scene.count))
        for tie in self._seams:
            if contacts:
                force[:, tie.nodes] += tie.last_forces(contacts[tie.column.name])
        return force

    def _balance(self, force: np.ndarray, datum: np.ndarray) -> None:
        """Balance forces (3, n) from now on."""
        self.balance = Balance(self.scene, force, self.load, datum, self._across(self.contacts))

    def switch(self, state: State, fresh: bool = True) -> None:
        """Use the history-dependent law from now on; fresh: without any history yet."""
        before = self._potential(state) if state.laws else None
        if fresh and self._is_updated and turns_freely(self.scene):
            state.displacement, state.velocity = turned_as_a_whole(
                self.scene, state.displacement, state.velocity, state.datum
            )
        self._adopt(state.displacement, fresh)
        for part in self.disk_parts:
            part.uses_history = True
        self._watch_breaks()
        if self.balance is not None:
            self.balance.count_breaks_from(self.disk_parts)
        if before is not None:
            state.work[:, 4] += self._potential(state) - before
        self._adopt(state.displacement - self._time_step * state.velocity, fresh)  # its first push adds this step
        if self.near_ties is not None:
            self.near_ties.begin(self.contacts["body"])
        self.steady = self.load + (0.0 if self.balance is None else self.balance.force)
        self._follow()
        if before is not None and self.turning is not None:
            # the next step counts the work of rotation from half a step earlier, when forces did not rotate yet
            layout, steady = state.layout, state.layout.spread(self.steady)
            turning = self.turning.in_slots(layout.slot)
            state.work[:, 4] -= turn_forces(turning, state.u, state.v, steady, self._time_step)
        state.switch_velocity = state.velocity.copy()
        state.laws.append((self.law_name, state.step))

    def _adopt(self, displacement: np.ndarray, fresh: bool) -> None:
        """Set contacts without history to the state of the elastic law at displacements (3, n)."""
        for pairs in self.contacts.values():
            if fresh:
                pairs.start_from_displacements(displacement)

    def _watch_breaks(self) -> None:
        """Make the loop return after a break if balancing forces may have to end."""
        for part in self.disk_parts:
            part.stops_at_breaks = self.balance is not None

    def _follow(self) -> None:
        """Rotate balancing forces with their sides if the law in use has the updated geometry."""
        follows = self.uses_history and self._is_updated
        self.turning = self.balance.followers if self.balance is not None and follows else None

    @property
    def _is_updated(self) -> bool:
        """Whether the history-dependent law's normals and arms follow the motion."""
        return any(pairs.limits.geometry == UPDATED for pairs in self.contacts.values())

    def _potential(self, state: State) -> float:
        """Energy (J) stored in contacts and bonds less the work of steady and balancing forces since the start."""
        steady = float(np.sum(self.load * (state.displacement - state.datum)))
        return sum(self.stored(state.u)) - steady - self.balancing_work(state.u)
