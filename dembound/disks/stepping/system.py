"""Bonded disks in motion: the law they begin with, the change to the history-dependent one, and their state."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from dembound.disks.bearing import BearingTie
from dembound.disks.body import DiskBody
from dembound.disks.contacts.contact_list import ContactList
from dembound.disks.stepping.balance import Balance
from dembound.disks.stepping.carriers import RestForces
from dembound.disks.stepping.damped_ground import drag_rates
from dembound.disks.stepping.fields import RecordedDisks, turned_as_a_whole, turns_freely
from dembound.disks.stepping.first_law import balanced, first_law, not_balanced
from dembound.disks.stepping.near_ties import NearTies
from dembound.disks.stepping.scene_parts import DiskParts, Start, grids, joint_ties, walls
from dembound.disks.stepping.side_watch import SideWatch
from dembound.disks.stepping.walls import WallPart
from dembound.disks.surroundings.jump import JumpTie
from dembound.kernels.common import BROKE, LAW_ENDS
from dembound.kernels.follower import turn_forces
from dembound.motion.state import Arrays, State, arrays_of_owner

LOOK = 32
"""Steps between two looks at what has broken off, or opened near ties."""


class DiskSystem(RecordedDisks):
    """The parts of a scene of disks, which begin under one law and may change to the history-dependent one.

    Parameters
    ----------
    scene : the scene to be moved. time_step : Δt in s. start : a settled body; the forces on its particles are balanced
    from then on, unless it is `settling` again. None: as built, with nothing balanced. settling : whether this is a
    static stage, in which forces are not balanced. load : (3, n) steady forces and moments (N, N·m); None: the scene's.

    Attributes
    ----------
    forces : computes forces inside the scene at rest. balance : the forces that balance those in a settled body; None
    for a body as built or settling. near_ties : contacts outside the elastic range near ties to a continuum; None
    without one, or without a history. is_elastic_again : whether the elastic law is used again after a static stage
    that left it; refused : why it is not, if requested.
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
        if len(scene.seams) > 1 and scene.outside is not None and start is not None and not settling:
            # a body settled by itself is not where the columns are
            scene = replace(scene, outside=replace(scene.outside, rest=start.displacement))
        disks = DiskParts(scene, start, None if settling else time_step, watches=not settling)
        for pairs in disks.contacts.values():
            pairs.time_step = time_step
        joints = joint_ties(scene, start, time_step)
        ties = [*walls(scene), *disks.seams]
        if disks.damped_ties is not None:  # last of those that it remembers
            ties.insert(len(ties) if disks.remembers_seams else len(ties) - len(disks.seams), disks.damped_ties)
        self._bearing = None if settling or scene.bearing is None else BearingTie(scene.bearing, scene.layout)
        ties += joints
        if self._bearing is not None:
            ties.append(self._bearing)
        if scene.outside is not None and scene.outside.body.mesh.slit and not settling:
            ties.append(JumpTie(scene.outside, scene.feet, scene.layout, time_step))
        touched: WallPart | None = None
        if scene.case.wall:
            displacement = np.zeros((3, scene.count)) if start is None else start.displacement
            touching = None if start is None else start.touching
            touched = WallPart(scene, time_step, disks.parts[-1].fastest, displacement, touching, stand=settling)
        beyond = grids(scene, time_step, damped=not settling)
        super().__init__(scene, disks, joints, beyond, ties, scene.steady_load if load is None else load, touched)
        if not settling:
            self.drag = drag_rates(scene)
        self.forces = RestForces(scene, disks, joints, self.walls)
        self.balance: Balance | None = None
        self.is_elastic_again = False
        self._time_step, self._start, self._settling = time_step, start, settling
        watches = scene.outside is not None and scene.has_history and not settling
        self.side_watch = SideWatch(scene, time_step)
        self.near_ties = NearTies(scene, self.contacts["body"]) if watches else None

    @property
    def supply_is_plain(self) -> bool:  # type: ignore[override]  # a constant of other systems
        """Whether no seams of unlike columns act, whose forces at rest do not cancel."""
        return len(self.scene.seams) < 2

    @property
    def contacts(self) -> dict[str, ContactList]:
        """The pairs of each part by name, empty if the material's law has no history."""
        return self.disks.contacts

    @property
    def uses_history(self) -> bool:
        """Whether the history-dependent law is in use."""
        return self.disks.uses_history

    @property
    def law_name(self) -> str:
        """Name of the law of the disks in use, for reports."""
        return self.disks.parts[-1].law_name

    def begin(self, state: State) -> None:
        """Choose the first law, and the steady forces that belong to it."""
        law = first_law(self.scene, self.disks, self._start, state.datum, settling=self._settling)
        self.is_elastic_again, self.refused = law.is_elastic_again, law.refused
        if self._start is None or self._settling:
            steady = not_balanced(law, self.scene, self.forces, self.load)
        else:
            self.balance, steady = balanced(law, self.scene, self.disks, self.forces, self.load, state.datum)
        self._begin_at_rest()
        if self._bearing is not None:
            self._bearing.rest_at(state.datum)
        self.steady = self._kept(steady)
        if law.has_history:
            self.switch(state, fresh=not law.goes_on)
        else:
            super().begin(state)

    def apply(self, load: np.ndarray) -> None:
        """Replace the steady forces and moments (3, n) of loads."""
        if self.steady.shape[1] == 0:
            self.steady = np.zeros_like(load)
        self.steady += load - self.load
        self.load = load

    def follow(self, load: np.ndarray, state: State, step: float) -> None:
        """Replace the steady loads (3, n) N and N·m of a run from the present step (s) on."""
        change = load - self.load
        # the loads of the last step acted until half a step before the present displacements
        self.work_before -= float(np.sum(change * (state.displacement - 0.5 * step * state.velocity - state.datum)))
        self.apply(load)
        if self.balance is not None:
            self.balance.followers.steady[...] += change[:2, self.balance.followers.node]

    def react(self, why: int, steps: int, state: State) -> None:
        """Change the law if contacts are about to leave the elastic range; end the forces on broken-off pieces.

        Pieces are looked for after breaks, and as contacts open without one, every `LOOK` steps: when pairs are listed
        must not matter.
        """
        looks = self.uses_history and (why == BROKE or state.step % LOOK == 0)
        if why == LAW_ENDS:
            self.switch(state)
        elif self.balance is not None and looks:
            self.balance.end_on_debris(
                self.disks.parts, state.displacement, state.velocity, self._time_step, self.steady, self._held
            )
            self._let_go()
        super().react(why, steps, state)
        if looks:
            self.look_near_ties(state)
            self._end_loose_faces(state)

    def _end_loose_faces(self, state: State) -> None:
        """Let disks that have left the blocks beside joints be as all others."""
        if not self.joints:
            return
        displacement, body = state.displacement, self.contacts["body"]
        torn = np.concatenate([np.zeros(body.nodes.start, dtype=np.bool_), body.torn])
        ended = np.unique(np.concatenate([joint.loose(displacement, torn) for joint in self.joints]))
        for joint in self.joints:
            joint.end_faces(ended)
        body.end_faces(displacement, ended - body.nodes.start)

    @property
    def _held(self) -> np.ndarray | None:
        """Disks (m,) by which pieces are not debris: those whose bonds never break, and those pressed on a joint."""
        held = self.scene.intact
        for joint in self.joints:
            held = np.zeros(self.scene.disk_count, dtype=np.bool_) if held is None else held.copy()
            held[joint.pressed] = True
        return held

    def look_near_ties(self, state: State) -> None:
        """Note contacts near ties to a continuum that have opened or slid, which the elastic law does not describe."""
        if self.near_ties is not None and self.uses_history:
            self.near_ties.look(state, self.contacts["body"])

    def steps_to_look(self, step: int) -> int | None:
        """See `react`."""
        looks = self.uses_history and (self.balance is not None or self.near_ties is not None or bool(self.joints))
        return LOOK - step % LOOK if looks else None

    def switch(self, state: State, fresh: bool = True) -> None:
        """Use the history-dependent law from now on; fresh: with contacts as the elastic law leaves them."""
        before = self._potential(state) if state.laws else None
        if fresh and self.disks.geometry_follows and turns_freely(self.scene):
            state.displacement, state.velocity = turned_as_a_whole(
                self.scene, state.displacement, state.velocity, state.datum
            )
        for part in self.disks.parts:
            part.uses_history = True
        if fresh:
            self.disks.adopt(state.displacement)
        if self.balance is not None:  # debris is looked for by the bonds that break from now on
            for pairs in self.contacts.values():
                pairs.note_cracks()
        if before is not None:
            state.work[:, 4] += self._potential(state) - before
        if fresh:
            self.disks.adopt(state.displacement - self._time_step * state.velocity)  # its first push adds this step
        if self.near_ties is not None:
            self.near_ties.begin(self.contacts["body"])
        self.steady = self._kept(self.load) if self.balance is None else self.load + self.balance.force
        self._set_balance_in_use()
        if before is not None and self.turning is not None:
            # the next step counts the work of rotation from half a step earlier, when forces did not rotate yet
            layout, steady = state.layout, state.layout.spread(self.steady)
            turning = self.turning.in_slots(layout.slot)
            state.work[:, 4] -= turn_forces(turning, state.u, state.v, steady, self._time_step)
        state.switch_velocity = state.velocity.copy()
        state.laws.append((self.law_name, state.step))

    def saved(self, state: State) -> tuple[str, ...]:
        """In words, the number of steps under the elastic law after a static stage that left it; empty without any."""
        if not self.is_elastic_again:
            return ()
        steps = state.laws[1][1] if len(state.laws) > 1 else state.step
        return (f"law: elastic after settling, as nothing is open or slides, for {steps:,} of {state.step:,} steps",)

    def balancing_work(self, u: np.ndarray) -> float:
        """Work (J) up to displacements (3, slots) of forces that balance a settled stress, without their rotation."""
        return 0.0 if self.balance is None else self.balance.work(self.scene.layout.gather(u))

    def spring_shift(self, u: np.ndarray) -> float:
        """Work (J) up to displacements (3, slots) of the balancing forces that shift springs and ties to rest.

        Beside two columns also of those that balance the forces of their seams at rest, unlike at both sides, so that
        these forces count as balanced, too.
        """
        if self.balance is None:
            return 0.0
        moved = self.scene.layout.gather(u) - self.balance.datum
        shift = float(np.sum(self.forces.shift(self.balance.datum) * moved))
        return shift - self.balance.work_across(moved) if len(self.scene.seams) > 1 else shift

    @property
    def balancing_force(self) -> np.ndarray | None:
        """Forces (3, n) N and N·m that balance a settled stress, without their rotation; None if there are none."""
        return None if self.balance is None else self.balance.force

    def saved_arrays(self) -> Arrays:
        """All arrays that change during a run except the motion, by name."""
        saved = dict(super().saved_arrays())
        watches = ("near_ties", self.near_ties), ("side_watch", self.side_watch)
        for owner, kept in (("balance", self.balance), *watches):
            saved |= {} if kept is None else {f"{owner}/{name}": values for name, values in kept.saved_arrays().items()}
        return saved

    def restore(self, saved: Arrays) -> None:
        """Restore the arrays returned by `saved_arrays` in another run of the same case."""
        super().restore(saved)
        kept = arrays_of_owner(saved, "balance")
        self.balance = Balance.restored(self.scene, kept) if kept else None
        if self.near_ties is not None:
            self.near_ties.restore(arrays_of_owner(saved, "near_ties"))
        self.side_watch.restore(arrays_of_owner(saved, "side_watch"))
        self.side_watch.sides = [] if self.balance is None else self.balance.sides
        self._set_balance_in_use()
        self._let_go()
        self._begin_at_rest()
        if self._bearing is not None and self.balance is not None:
            self._bearing.rest_at(self.balance.datum)

    def retire(self, disks: np.ndarray, state: State, step: float) -> None:
        """Put disks (m,) bool that touch nothing to rest for good, where others pass them without touching.

        Their energy counts as taken by damping. step : Δt in s; velocities are half a step behind.
        """
        chosen = np.flatnonzero(disks)
        if len(chosen) == 0:
            return
        self.stop(chosen, state, step)
        self.leave_out(disks, state.displacement)

    def stop(self, chosen: np.ndarray, state: State, step: float) -> None:
        """Stop disks (k,) that only steady forces act on, for good; see `retire`."""
        slots, inertia = state.layout.slot[chosen], np.stack([self.scene.mass, self.scene.mass, self.scene.inertia])
        v = state.v[:, slots]
        force = self.steady[:, chosen] if self.steady.size else np.zeros_like(v)
        force = force - self.scene.damp * np.abs(force) * np.sign(v)
        state.work[:, 1] += float(np.sum(0.5 * v * (inertia[:, chosen] * v + step * force)))
        state.v[:, slots] = 0.0
        if self.steady.size:
            self.steady[:, chosen] = 0.0
        if self.balance is not None:
            self.balance.leave_alone(chosen)

    def leave_out(self, disks: np.ndarray, displacement: np.ndarray) -> None:
        """Drop all pairs of disks (m,) bool, which meet no others any more; displacements (3, n)."""
        for pairs in self.contacts.values():
            pairs.retired |= disks[pairs.nodes]
            pairs.search(displacement)

    def look(self, u: np.ndarray, step: int, borne: float, energy: float) -> None:
        """Look at the forces at rest at displacements (3, slots) of a step, see `SideWatch.look`."""
        if self.balance is not None and self.scene.has_history:
            displacement = self.scene.layout.gather(u)
            self.side_watch.look(self.balance, self.contacts, displacement, step, borne, energy)

    def _let_go(self) -> None:
        """Let the free field exert no forces on disks that have broken off or lost all their bonds."""
        for seam in self.disks.seams if self.balance is not None else ():
            assert self.balance is not None
            seam.let_go(self.balance.let_go)

    def borne(self, supported: np.ndarray) -> np.ndarray:
        """Forces (s, 3) N of the springs on relative motion on the nodes (s,) of the support table."""
        return super().borne(supported) if self._bearing is None else self._bearing.force_on(supported)

    def _begin_at_rest(self) -> None:
        """Let nothing be remembered of the forces at rest, if these are balanced."""
        if self.balance is not None and (self.disks.are_damped or self.disks.damped_ties is not None):
            datum = self.balance.datum
            self.disks.rest_at(datum, self.forces.of_ties(datum))
            if self.disks.are_damped and self.scene.case.output.stress:
                self._stress_at_rest = self._unrelaxed_stress(datum)

    def _set_balance_in_use(self) -> None:
        """Let the loop return after a break if balancing forces may have to end, and rotate them if their law does."""
        balance = self.balance
        for part in self.disks.parts:
            part.stops_at_breaks = balance is not None
        follows = self.uses_history and self.disks.geometry_follows
        self.turning = balance.followers if balance is not None and follows else None

    def _kept(self, steady: np.ndarray) -> np.ndarray:
        """Steady forces (3, n); none where all are zero and there are no walls: kernels then read no array of them."""
        return steady.copy() if steady.any() or self.walls is not None else np.zeros((3, 0))

    def _potential(self, state: State) -> float:
        """Energy (J) stored in contacts and bonds less the work of steady and balancing forces since the start."""
        steady = float(np.sum(self.load * (state.displacement - state.datum)))
        return sum(self.stored(state.u)) - steady - self.balancing_work(state.u)
