"""The loop: advances a scene in time, up to the steps at which trackers are due."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress

import numpy as np

from dembound.errors import RunError
from dembound.interrupts import Stopped, look, put_off
from dembound.kernels import loop, tables
from dembound.kernels.calls import Kept
from dembound.motion.memory import DRIVEN_BYTES, threads_for
from dembound.motion.part import System
from dembound.motion.scene import Scene
from dembound.motion.sides import NodeSides, Samples
from dembound.motion.state import State, aligned_zeros
from dembound.motion.supports import NodeSupports
from dembound.motion.trackers import Clock, Records, Tracker, Watch

AT_ONCE = 20_000_000
"""Nodes times steps between two checks for a request to end: 0.2 s to 2 s on one core."""

LEAST_AT_ONCE = 128
"""Least number of steps between two checks: a return of the loop takes as long as one or two steps."""


class Simulation:
    """The motion of a scene, from rest at time zero.

    Velocities are those of half steps. The first one, Δt/2 after rest, follows from half a kick, v = a₀Δt/2: forces
    that are there at once, as weight, then give v = a₀t and u = ½a₀t² at whole steps; with a whole kick, motion would
    be half a step early. Where something moves at the start, the velocities given are those half a step before it.

    Parameters
    ----------
    scene : the scene to be moved.
    time_step : Δt in s; the caller has compared it with the stability limit.
    probes : (p,) nodes whose motion `advance` returns at every step; by default none.
    system : its parts and ties; by default those of the scene as built, at rest.
    datum : (3, n) displacements at which they are at rest; by default zero.
    damp : local damping coefficient of a stage on the way to rest, whose first kick is a whole one as its time means
    nothing; by default the scene's.
    clock : counts the seconds of stepping and of trackers, under "step" and "record".
    side_stride : steps between two samples of the sides' forces and displacements; 0: sides are not measured.

    Attributes
    ----------
    state : all arrays that change during the run.
    trackers : called during the run; at first a `Watch`, which all runs should have. stopped : whether a
    tracker has ended the run. sides : the measured sides; None for none. side_samples : of the last steps.
    """

    def __init__(
        self,
        scene: Scene,
        time_step: float,
        probes: Sequence[int] | np.ndarray = (),
        *,
        system: System | None = None,
        datum: np.ndarray | None = None,
        damp: float | None = None,
        clock: Clock | None = None,
        side_stride: int = 0,
    ) -> None:
        self.scene = scene
        self.time_step = time_step
        self.clock = clock or Clock()
        self.probes = np.array(probes, dtype=np.int64)
        self.system = scene.system(time_step) if system is None else system
        datum = np.zeros((3, scene.count)) if datum is None else datum
        layout = scene.layout
        peaks, top = np.zeros((len(scene.tracked), 3, 2)), np.zeros(layout.count if scene.case.output.peaks else 0)
        self.state = State(layout, layout.spread(datum), aligned_zeros(3, layout.count), datum, peaks, top)
        if (velocity := scene.first_velocity) is not None:
            self.state.velocity = velocity
        self.state.owners["system"] = self.system
        self.trackers: list[Tracker] = []
        self.track(Watch(scene.block))
        self.stopped = False
        self._u_next = aligned_zeros(3, layout.count)
        self._entered: Kept = {}
        self._damp = scene.damp if damp is None else damp
        self._takes_time = damp is None
        self._supports = NodeSupports(scene, self.system.ties, time_step, self.system.drag)
        self.sides = NodeSides(scene, self._supports) if side_stride > 0 else None
        self._side_stride = side_stride
        self.side_samples = Samples.between(0, 0, side_stride, 0)
        if self.sides is not None:
            self.state.side_work = np.zeros((2, len(self.sides.names), 2))
        inverses = 1.0 / scene.mass, 1.0 / scene.inertia  # rounded as in rows of copies
        self._mobility, self._inverse_inertia = (layout.spread(time_step * of) for of in inverses)
        for mobility in (self._mobility, self._inverse_inertia):
            mobility[self._supports.slots] = 0.0  # these are moved by the support table
        self._probe_slots, self._tracked_slots = layout.slot[self.probes], layout.slot[scene.tracked]
        self.system.begin(self.state)

    def track(self, *trackers: Tracker) -> None:
        """Add trackers to the run; they are part of its state."""
        self.trackers += trackers
        self.state.owners |= {tracker.name: tracker for tracker in trackers}

    def forget_trackers(self) -> None:
        """Remove all trackers after the run, some of which refer to it, so that its arrays can be freed."""
        self.trackers.clear()
        self.state.owners.clear()

    @property
    def time(self) -> float:
        """Time of the current displacements (s)."""
        return self.state.step * self.time_step

    def run(self, steps: int) -> None:
        """Advance to `steps` steps in all, or until a tracker ends the run; trackers are called when they are due.

        Raises the errors of trackers: RunError, with time and place, when the motion grows without bound, and Stopped
        after a request to end, when the trackers have received all steps that were done.
        """
        self._hand_round(None)
        while self.state.step < steps and not self.stopped:
            with self.clock.of("step"):
                record = self._advance_to(min(steps, *(tracker.due for tracker in self.trackers)))
            self._hand_round(record)
            look()

    def advance(self, steps: int) -> np.ndarray:
        """Advance by `steps` steps; returns (steps, p, 6): displacement and velocity of the probes before each.

        Displacements are measured from the start. For a bar, stress (Pa) is a seventh column. Trackers are called as in
        `run`.
        """
        kept = Records()
        self.trackers.append(kept)
        try:
            self.run(self.state.step + steps)
        finally:
            self.trackers.remove(kept)
        empty = np.empty((0, len(self.probes), self.scene.record_width))
        return np.concatenate([empty, *kept.records])

    @contextmanager
    def a_step_ahead(self) -> Iterator[np.ndarray]:
        """Inside, the run is a step ahead, which velocities of now need; gives the motion (p, 6) of the probes now.

        For a bar, stress (Pa) is a seventh column. Trackers are not called. Afterwards the motion is as before, but
        contacts of disks are a step ahead, as copies of them would take a third of the memory of a run.
        """
        state, owners, samples = self.state, self.state.owners, self.side_samples
        state.owners = {"system": self.system} if any(part.is_summarised for part in self.system.parts) else {}
        saved = state.arrays()
        try:
            with put_off():
                yield self._advance_to(state.step + 1)[0]
        finally:
            state.take(saved)
            state.owners, self.side_samples = owners, samples

    def edge_peaks(self, side: str) -> np.ndarray:
        """Smallest and largest velocity so far of the nodes of one side of the whole scene, (k, 3, 2)."""
        return self.scene.side_peaks(side, self.state.peaks)

    def _hand_round(self, record: np.ndarray | None) -> None:
        """Pass the last record of the probes, if any, to all trackers, and call trackers that are due."""
        with self.clock.of("record"), put_off():
            for tracker in self.trackers:
                if record is not None:
                    tracker.observe(self, record)
            for tracker in self.trackers:
                if tracker.due <= self.state.step:
                    tracker.handle(self)

    def _advance_to(self, step: int) -> np.ndarray:
        """Advance to a step, or less far after a request to end; returns the record of the probes, see `advance`."""
        begun = self.state.step
        record = np.empty((step - begun, len(self.probes), self.scene.record_width))
        names = [] if self.sides is None else self.sides.names
        self.side_samples = Samples.between(begun, step, self._side_stride, len(names))
        most_driven = int(DRIVEN_BYTES / (24 * max(1, len(self._supports.nodes))))
        at_once = max(1, min(most_driven, max(LEAST_AT_ONCE, AT_ONCE // self.scene.count)))
        with threads_for(self.scene.count), suppress(Stopped):  # also while kernels are compiled
            if begun == 0 and self._takes_time and not self.state.v.any():
                self._advance_from_rest(record[:1])
            for first in range(self.state.step - begun, len(record), at_once):
                look()
                self._advance(record[first : first + at_once])
        record = record[: self.state.step - begun]
        self.side_samples = self.side_samples.before(self.state.step)
        if self.sides is not None:
            self.side_samples.record[..., :3] -= self.sides.origin(self.state.datum)
        record[..., :3] -= self.state.datum[:, self.probes].T
        return record

    def _advance_from_rest(self, record: np.ndarray) -> None:
        """Do the first step of a body at rest, with half a kick, but a whole one by waves: they give means at jumps.

        What is recorded for time zero is rest, but half the prescribed velocities. The work F·(v⁻ + v⁺)/2·Δt that leads
        from one step to the next in the ledger (`energy`) has, from rest, only its later half, F·v⁺Δt/2 of half of v⁺;
        that of prescribed velocities, which jump to v⁺, is a whole one.
        """
        state, before = self.state, self.state.u.copy()
        self._advance(record, from_rest=True)
        driven = np.zeros_like(state.v)
        driven[:, self._supports.slots] = self._supports.driven(state.v)
        half = 0.5 * state.v
        half[:, self._supports.slots] = self._supports.after_half_a_kick(state.v)
        if self.system.drag.size:
            half *= state.layout.spread(1.0 + 0.5 * self.time_step * self.system.drag)
        half += driven
        if np.array_equal(half, state.v):
            return  # nothing moves but what is prescribed
        state.v[...] = half
        state.u[...] = before + self.time_step * state.v
        record[0, :, 3:6] = 0.5 * driven[:, self._probe_slots].T
        speed = state.v[:, self._tracked_slots].T
        state.peaks[...] = np.stack([np.minimum(speed, 0.0), np.maximum(speed, 0.0)], axis=-1)
        if state.top.size:
            state.top[...] = np.hypot(*state.v[:2])
        if not driven.any():
            state.work[0] *= 0.5
            state.side_work[0] *= 0.5

    def _advance(self, record: np.ndarray, from_rest: bool = False) -> None:
        """Do as many steps as the record (k, p, 6 or 7) has rows, with changes of law if necessary.

        from_rest : with forces by waves of which `NodeSupports.after_half_a_kick` leaves the whole ones.
        """
        times = (self.state.step + np.arange(len(record))) * self.time_step
        signals = self._supports.sampled(times)
        supports = self._supports.table(signals)
        if from_rest:
            supports.drive[...] *= np.where(self._supports.prescribed > 0.0, 1.0, 1.0 + self._supports.keep)
        done = 0
        while done < len(record):
            most = self.system.steps_to_look(self.state.step)
            stop = len(record) if most is None else min(len(record), done + most)
            remaining = supports._replace(drive=supports.drive[done:stop])
            measured = tables.NO_SIDES
            if self.sides is not None:
                measured = self.sides.table(signals[done:stop], self.system, self.side_samples, self.state.side_work)
            advanced = self._advance_under_one_law(record[done:stop], remaining, measured)
            if advanced == 0 and not np.isfinite(self.state.u).all():  # pairs cannot be listed, so no step follows
                raise RunError(f"the motion grew without bound by t = {self.state.step * self.time_step:g} s")
            done += advanced

    def _advance_under_one_law(self, record: np.ndarray, supports: tables.Supports, sides: tables.Sides) -> int:
        """Do as many of these steps as the laws in use, with their pairs or bonds, are valid; returns their number."""
        state, system = self.state, self.system
        load, turning = system.steady, system.turning
        if not state.layout.is_plain:
            load = state.layout.spread(load) if load.size else load
            turning = None if turning is None else turning.in_slots(state.layout.slot)
        body = tables.Body(self._mobility, self._inverse_inertia, self.scene.free, load, self._damp, self.time_step)
        probes, tracked = self._probe_slots, self._tracked_slots
        log = tables.Log(probes, record, tracked, state.peaks, state.top, state.work, state.supplied, sides)
        u, u_next, v, laws, ties = state.u, self._u_next, state.v, system.laws(), system.bundles(self._supports.nodes)
        done, why = loop.advance(u, u_next, v, state.step, laws, ties, turning, body, supports, log, self._entered)
        if turning is not None and system.turning is not None and not state.layout.is_plain:
            system.steady[:2, system.turning.node] = load[:2, turning.node]
        with put_off():
            state.step += int(done)
            system.react(int(why), int(done), state)
        return int(done)
