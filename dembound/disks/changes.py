"""What changes during a run: groups that weaken, holes that are made, supports that let go, pressures that follow."""

from __future__ import annotations

import numpy as np

from dembound.casefile.disks.model import DiskCase
from dembound.casefile.disks.static import changes
from dembound.disks.contacts.contact_list import ContactList
from dembound.disks.pressure import in_run
from dembound.disks.scene import DiskScene
from dembound.disks.stepping.first_law import let_go
from dembound.disks.stepping.scene_parts import layers_of
from dembound.disks.stepping.system import DiskSystem
from dembound.errors import CaseError, RunError
from dembound.holes import Hole
from dembound.laws.law import AnyLimits
from dembound.motion.state import Arrays
from dembound.motion.trackers import NEVER, Every, Run, Tracker

STEPS = 64
"""Steps from one position of the membranes to the next: a wave crosses some thirty disks meanwhile."""


class Membranes(Every):
    """Moves the membranes of pressures on sides to where the disks of their sides are."""

    name = "membranes"

    def __init__(self, scene: DiskScene) -> None:
        super().__init__(STEPS)
        self._scene = scene

    def see(self, run: Run) -> None:
        """Replace the forces of membranes by those on the disks in their present places."""
        assert isinstance(run.system, DiskSystem)
        load = in_run(self._scene, run.state.displacement, self._scene.steady_load)
        run.system.follow(load, run.state, run.time_step)


def times_of(case: DiskCase) -> list[float]:
    """The times (s) of a run at which something changes, ascending."""
    return sorted({time for _, time in changes(case.group, case.hole, case.static)})


def taken_by(hole: Hole, scene: DiskScene) -> np.ndarray:
    """Mask (m,) of the disks of the body that a hole takes, by their places as built."""
    taken = hole.takes(scene.assembly.positions, scene.case.packing.span)
    taken[: scene.column_count] = False
    return taken


def require_inner_holes(scene: DiskScene) -> None:
    """Raise CaseError for holes made during the run that take no disks, or disks by which sides act."""
    case, problems = scene.case, []
    if all(hole.stage != "run" for hole in case.hole):
        return
    acting = [scene.supports.node, *scene.tied.values(), *scene.intact_zones.values()]
    held = {} if case.static is None else case.static.boundary
    acting += [edge.nodes for side, edge in scene.edges.items() if side in held or not case.side(side).is_free]
    at_sides = np.zeros(scene.count, dtype=np.bool_)
    at_sides[np.concatenate([nodes.astype(np.int64) for nodes in acting])] = True
    for hole in case.hole:
        if hole.stage != "run":
            continue
        taken = taken_by(hole, scene)
        if not taken.any():
            problems.append(f"hole.{hole.name}: takes no disks")
        if beside := int(np.count_nonzero(taken & at_sides[: len(taken)])):
            problems.append(
                f'hole.{hole.name}: takes {beside} disks by which sides act; with stage = "run" it must end before them'
            )
    if problems:
        raise CaseError(problems)


class Changes(Tracker):
    """Makes all changes of a run at the first steps at or after their times.

    Parameters
    ----------
    scene : the scene. system : its parts. time_step : s.
    """

    name = "changes"
    evolving = ("due", "_made")

    def __init__(self, scene: DiskScene, system: DiskSystem, time_step: float) -> None:
        self._scene, self._system, self._time_step = scene, system, time_step
        self._times, self._made = times_of(scene.case), 0
        self.due = self._step_of_next()

    def _step_of_next(self) -> int:
        if self._made == len(self._times):
            return NEVER
        return int(np.ceil(self._times[self._made] / self._time_step - 1e-9))

    def handle(self, run: Run) -> None:
        """Make the changes that are due; a law with a history begins one step before them."""
        while self.due <= run.state.step:
            time, case = self._times[self._made], self._scene.case
            holes = [hole for hole in case.hole if hole.time == time]
            weaker = any(group.time == time for group in case.group)
            if (holes or weaker) and not self._system.uses_history:
                self._system.switch(run.state)
                self.due = run.state.step + 1
                return
            if weaker:
                self._pairs.take_limits(*self._limits_at(time))
            self._let_go(run, time)
            if holes:
                self._excavate(run, holes)
            self._made += 1
            self.due = self._step_of_next()

    @property
    def _pairs(self) -> ContactList:
        """The pairs of the body."""
        return self._system.contacts["body"]

    def _limits_at(self, time: float) -> tuple[AnyLimits, np.ndarray, np.ndarray]:
        limits = layers_of(self._scene, self._pairs.assembly, time)
        assert limits is not None
        return limits

    def _let_go(self, run: Run, time: float) -> None:
        """End the reactions of static sides."""
        what, state, system = let_go(self._scene, time), run.state, self._system
        if what.any() and system.balance is not None:
            system.balance.end(what, state.displacement, state.velocity, run.time_step, system.steady)

    def _excavate(self, run: Run, holes: list[Hole]) -> None:
        """Let the disks in holes vanish with their contacts; their energy counts as taken by damping.

        With r the vanishing disks and f the forces (N) of their contacts on all disks, one step ago at energy U, the
        balance of central differences loses Σ_r ½v·(m v + Δt F) + U − ½Δt Σ f·v, see `dembound.motion.energy`.
        """
        state, step, system = run.state, run.time_step, self._system
        gone = np.logical_or.reduce([taken_by(hole, self._scene) for hole in holes])
        if system.walls is not None and gone[system.walls.touching.disk].any():
            raise RunError(
                f"hole.{holes[0].name}: at t = {run.time:.4g} s some of its disks touch walls, and cannot vanish"
            )
        earlier = state.u - step * state.v
        before = sum(system.stored(earlier)), self._power(run)
        system.leave_out(gone, state.displacement)
        after = sum(system.stored(earlier)), self._power(run)
        state.work[:, 1] += before[0] - after[0] - 0.5 * step * (before[1] - after[1])
        system.stop(np.flatnonzero(gone), state, step)

    def _power(self, run: Run) -> float:
        """Power (W) of the last forces of all contacts of the body."""
        force = np.zeros((3, self._scene.count))
        for pairs in self._system.contacts.values():
            pairs.add_forces(force)
        return float(np.sum(force * run.state.velocity))

    def restore(self, saved: Arrays) -> None:
        """Restore the arrays returned by `saved_arrays` in another run."""
        super().restore(saved)
        if self._made and self._scene.case.group:
            self._pairs.meet_with(*self._limits_at(self._times[self._made - 1])[1:])
