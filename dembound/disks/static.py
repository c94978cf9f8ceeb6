"""The static stage: a damped run that brings a body to rest under steady loads and a given stress.

The forces of its supports and from outside then act as a constant force F_0 on every particle (Z eqs 5, 6: the
unbalanced force F_eq with opposite sign). The motion starts from rest, and the boundaries of the run replace the
supports.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from dembound.boundaries.support import SupportBuilder, Supports
from dembound.casefile.disks.static import Static
from dembound.disks.contacts import ContactList
from dembound.disks.scene import DiskScene, boundary_medium, column_alone
from dembound.disks.settled import Settled, among
from dembound.disks.stability import step_limit
from dembound.disks.system import DiskSystem, Start
from dembound.disks.tractions import Tractions, mean_stress
from dembound.motion.cracks import Cracks, joined
from dembound.motion.kind import StalledError
from dembound.motion.simulation import Simulation
from dembound.motion.stages import Stages
from dembound.motion.state import Arrays, State
from dembound.motion.trackers import Run, Tracker

LOOK = 100
"""Steps between two evaluations of the force ratio."""

PATIENCE = 20_000
"""Steps after which a stage has stalled if the force ratio has not decreased by a tenth."""

SAFETY = 0.9
"""Time step over the stability limit."""

WORST = 3
"""Number of particles in the message about a stalled stage."""


OnLook = Callable[[int, float], None] | None
"""Called with the steps done and the force ratio from time to time."""


def settle(scene: DiskScene, on_look: OnLook = None, stages: Stages | None = None) -> Settled:
    """Run a scene's static stage, or take what `stages` has kept of it.

    A scene with an excavation settles before it, and then again from this state, under the same loads and supports.
    With a free field the column settles first, alone; the body starts from its state, and both settle together.
    Otherwise the body could reach another state, as with friction there is more than one state of rest.

    Raises StalledError, with the force ratio reached, when the ratio no longer decreases or the steps exceed the
    maximum, and RunError when the motion grows without bound.
    """
    kept = stages or Stages()
    if scene.before is not None:
        before = _settle_built(scene.before, _Stage("before", "before the excavation the static stage", on_look, kept))
        stage = _Stage("body", "the static stage", on_look, kept)
        excavated = _settle(scene, lambda: _excavate(scene, before.start), stage, tractions=before.tractions)
        return replace(excavated, before=before)
    return _settle_built(scene, _Stage("body", "the static stage", on_look, kept))


def stage_names(scene: DiskScene) -> list[str]:
    """The names of a scene's stages in the `Stages` that `settle` receives, in their order."""
    if scene.before is None:
        return [*([_column("body")] if scene.seam is not None else []), "body"]
    return [*([_column("before")] if scene.before.seam is not None else []), "before", "body"]


def _column(name: str) -> str:
    """The name of the stage of the free-field column alone, before that of a body."""
    return f"{name}.column"


@dataclass(frozen=True)
class _Stage:
    """One stage: its key in `stages`, its name in messages, who gets its progress, and what keeps it."""

    key: str
    name: str
    on_look: OnLook
    stages: Stages


def _settle_built(scene: DiskScene, stage: _Stage) -> Settled:
    """The stage of a body as built, after that of its free-field column."""
    if scene.seam is None:
        return _settle(scene, lambda: None, stage)
    alone = replace(stage, key=_column(stage.key), name=f"{stage.name} of the free-field column alone")
    column = _settle(column_alone(scene), lambda: None, alone)
    return replace(_settle(scene, lambda: _beside(scene, column.start), stage), column=column)


def _excavate(scene: DiskScene, before: Start) -> Start:
    """The state in which an excavated scene begins to settle: that before, with the history of its contacts."""
    assert scene.kept is not None
    contacts = scene.contact_lists() if before.contacts else {}
    for name, pairs in contacts.items():
        there = before.contacts[name]
        kept = scene.kept[(scene.kept >= there.nodes.start) & (scene.kept < there.nodes.stop)] - there.nodes.start
        pairs.take_over_subset(there, kept)
    return Start(before.displacement[:, scene.kept], contacts, before.has_history)


def _beside(scene: DiskScene, column: Start) -> Start:
    """The state in which a body with a settled column begins to settle: every particle and pair as its twin."""
    assert scene.seam is not None
    displacement = column.displacement[:, scene.seam.twin]  # of the disks
    contacts = scene.contact_lists() if column.contacts else {}
    if column.has_history:
        for pairs in contacts.values():
            pairs.copy_twins(column.contacts["body"], scene.seam.twin[pairs.nodes], displacement)
    return Start(displacement, contacts, column.has_history)


def _settle(
    scene: DiskScene, starting: Callable[[], Start | None], stage: _Stage, tractions: np.ndarray | None = None
) -> Settled:
    """One stage to rest, unless it is kept.

    starting : returns its start, None for the scene as built. tractions : (3,) Pa, if they have been corrected.
    """
    if (kept := stage.stages.finished(stage.key)) is not None:
        return Settled.recalled(scene, kept)
    static, start = scene.case.static, starting()
    assert static is not None
    body = _StaticScene(scene, static, tractions)
    step = SAFETY * step_limit(body.scene, damp=static.damp)
    datum = np.zeros((3, body.scene.count))
    if start is not None:
        start = replace(start, displacement=among(start.displacement, body.scene))
        datum = start.displacement
    system = DiskSystem(body.scene, step, start, settling=True, load=body.load(datum))
    simulation = Simulation(body.scene, step, system=system, datum=datum, damp=static.damp)
    rest = _UntilAtRest(body, system, stage.on_look, stage.name)
    simulation.track(rest)
    stage.stages.begin(stage.key, simulation)
    simulation.run(static.max_steps)
    displacement, forces = simulation.state.displacement, rest.forces
    unbalanced = np.hypot(*(forces + body.scene.steady_load)[:2, : scene.disk_count])
    held = body.held
    settled = Settled(
        start=Start(among(displacement, scene), system.contacts, system.uses_history),
        steps=simulation.state.step,
        ratio=rest.ratio,
        mean_reaction=float(unbalanced[held].mean()) if held.any() else 0.0,
        mean_residual=float(unbalanced[~held].mean()) if not held.all() else 0.0,
        stress=mean_stress(scene, system.stress(displacement)),
        cracks=rest.take_cracks(),
        tractions=body.applied,
    )
    stage.stages.finish(stage.key, settled.memory())
    return settled


class _UntilAtRest(Tracker):
    """Ends a static stage that is at rest or has stalled; until then it rotates the loads with the body.

    Parameters
    ----------
    body : the scene that settles.
    system : its parts.
    on_look : gets the steps done and the force ratio from time to time.
    stage : its name in messages.

    Attributes
    ----------
    ratio : mean unbalanced over mean contact force at the last evaluation. forces : (3, n) N and N·m of contacts at
    that time.
    """

    name = "until at rest"

    def __init__(self, body: "_StaticScene", system: DiskSystem, on_look: OnLook, stage: str) -> None:
        self.ratio, self.forces = np.inf, np.zeros((3, 0))
        self._body, self._system, self._on_look, self._stage = body, system, on_look, stage
        self._best, self._best_at = np.inf, 0
        # a law without history has no list of pairs, but their forces are needed too
        self._contacts = system.contacts or body.scene.contact_lists()
        self._look_after(0)

    def _look_after(self, step: int) -> None:
        self.due = min(step + LOOK, max(self._body.static.max_steps, step + 1))

    def handle(self, run: Run) -> None:
        """Evaluate the force ratio; raise StalledError if it no longer decreases or the steps exceed the maximum."""
        body, static, system, state = self._body, self._body.static, self._system, run.state
        body.keep_from_turning(state)
        self.forces = self._contact_forces(state.displacement)
        self.ratio = body.force_ratio(system, self.forces, self._contacts)
        if self._on_look is not None:
            self._on_look(state.step, self.ratio)
        if self.ratio <= static.ratio:
            if not body.correct(system, state):
                run.stopped = True
                return
            self._best, self._best_at = np.inf, state.step
        elif self.ratio < 0.9 * self._best:
            self._best, self._best_at = self.ratio, state.step
        if state.step - self._best_at >= PATIENCE or state.step >= static.max_steps:
            lacking, cracks = body.unbalanced(system, self.forces), self.take_cracks()
            message = f"{self._stage} {_where_it_ended(static, run, self.ratio, lacking, cracks)}"
            raise StalledError(message, run, lacking.T, cracks)
        body.turn_tractions(system, state)
        self._look_after(state.step)

    def memory(self) -> Arrays:
        """The next step of evaluation, the force ratio and step of the last progress, and the tractions."""
        applied = np.zeros(0) if self._body.applied is None else self._body.applied
        best = {"best": np.array(self._best), "best_at": np.array(self._best_at)}
        return {**super().memory(), **best, "tractions": applied, "corrections": np.array(self._body.corrections_left)}

    def recall(self, memory: Arrays) -> None:
        """Take over what `memory` has returned in another run of the same case."""
        super().recall(memory)
        self._best, self._best_at = float(memory["best"]), int(memory["best_at"])
        if memory["tractions"].size:
            self._body.go_on_with(memory["tractions"], int(memory["corrections"]))

    def take_cracks(self) -> Cracks:
        """The bonds that broke since this was last called."""
        return joined([pairs.take_cracks() for pairs in self._contacts.values()])

    def _contact_forces(self, displacement: np.ndarray) -> np.ndarray:
        """Forces and moments (3, n) of contacts and ties now, under the elastic law with the locked-in forces."""
        if not self._system.uses_history:
            for pairs in self._contacts.values():
                pairs.push(displacement, reference=True)
        return self._system.last_forces(self._contacts) + self._system.tie_forces(displacement)


def _where_it_ended(static: Static, run: Run, ratio: float, unbalanced: np.ndarray, cracks: Cracks) -> str:
    """Lines about a stage that takes too long, with its state and advice; unbalanced (2, n) N as for `_lacking`."""
    steps = run.state.step
    facts = f"static.ratio asks for {static.ratio:g}; broken bonds: {len(cracks):,}\n{_lacking(run, unbalanced)}"
    if steps >= static.max_steps:
        return f"came to a force ratio of {ratio:.3g} in {steps:,} steps, {facts}\nallow more with static.max_steps"
    return (
        f"stalls at a force ratio of {ratio:.3g} after {steps:,} steps, {facts}\n"
        "is the body held, and can its contacts carry the load?"
    )


def _lacking(run: Run, unbalanced: np.ndarray) -> str:
    """The particles with the largest unbalanced forces, a line each, and how many have half of the sum.

    unbalanced (2, n) N is the sum of the forces on each particle.
    """
    scene, size = run.scene, np.hypot(*unbalanced)
    order = np.argsort(-size, kind="stable")
    half = 1 + int(np.searchsorted(np.cumsum(size[order]), 0.5 * size.sum()))
    places = scene.positions + run.state.displacement[:2].T
    worst = [
        f"unbalanced force on particle {i} at ({places[i, 0]:.2f}, {places[i, 1]:.2f}) m: "
        f"({unbalanced[0, i] + 0.0:.3g}, {unbalanced[1, i] + 0.0:.3g}) N"  # + 0.0: no −0
        for i in order[: min(WORST, len(order))]
    ]
    low, high = places[order[:half]].min(axis=0), places[order[:half]].max(axis=0)
    share = (
        f"{half:,} of {scene.count:,} particles have half of all unbalanced force, between "
        f"({low[0]:.2f}, {low[1]:.2f}) and ({high[0]:.2f}, {high[1]:.2f}) m"
    )
    return "\n".join([*worst, share])


def _without_own_continua(scene: DiskScene) -> DiskScene:
    """A scene without continua that are tied by the motion of its disks itself, in place of which supports hold it.

    Those tied by the motion relative to the free-field column stay, as a hole moves the ground round it.
    """
    beyond = scene.outside if scene.outside is not None and scene.outside.twin is not None else None
    return replace(scene, outside=beyond, foot=None)


def _of_disks(supports: Supports, disks: int) -> np.ndarray:
    """The disks (k,) with prescribed components."""
    node = supports.node[supports.prescribed]
    return node[node < disks]


class _StaticScene:
    """A scene under its static supports and tractions."""

    def __init__(self, scene: DiskScene, static: Static, tractions: np.ndarray | None) -> None:
        case = scene.case
        builder = SupportBuilder(held=scene.ground.held)
        free_field = {side: table for side, table in case.boundary.items() if table.needs_column}
        for side, table in (free_field | dict(static.boundary)).items():
            if side in scene.edges:
                edge = scene.edges[side]
                table.support(edge, boundary_medium(case, scene.ground, edge.axis), case.wave, builder)
        self.static = static
        self._tractions = None if static.stress is None else Tractions(scene, static.stress, tractions)
        self.scene = _without_own_continua(scene)
        for each in self.scene.continua:
            each.support(builder)
        self.scene = replace(self.scene, supports=builder.table())
        self.held = np.zeros(scene.disk_count, dtype=bool)
        for edge in scene.edges.values():
            self.held[edge.nodes] = static.stress is not None
        supports: Supports = self.scene.supports
        self.held[_of_disks(supports, scene.disk_count)] = True  # dashpots have no force at rest
        self._floats = len(supports) == 0
        held = bool((scene.free[:2] == 0.0).any())
        self._by_tractions_alone = self._floats and not held and not scene.steady_load.any()
        self._moves = np.repeat(scene.free[:2, None] > 0.0, scene.disk_count, axis=1)
        across = (supports.component < 2) & supports.prescribed
        self._moves[supports.component[across], supports.node[across]] = False

    def load(self, displacement: np.ndarray) -> np.ndarray:
        """All steady forces (3, n) N and N·m at displacements (3, n)."""
        return self.scene.steady_load + (0.0 if self._tractions is None else self._tractions.forces(displacement))

    @property
    def applied(self) -> np.ndarray | None:
        """The stress (3,) Pa of the tractions, if the stage has a target stress."""
        return None if self._tractions is None else self._tractions.applied

    @property
    def corrections_left(self) -> int:
        """How often the tractions may still be corrected."""
        return 0 if self._tractions is None else self._tractions.corrections_left

    def go_on_with(self, applied: np.ndarray, corrections_left: int) -> None:
        """Take tractions (3,) Pa that have been corrected in another run of the same case."""
        assert self._tractions is not None
        self._tractions.applied, self._tractions.corrections_left = applied.copy(), corrections_left

    def correct(self, system: DiskSystem, state: State) -> bool:
        """Correct the tractions of a body at rest by the error of the stress inside; returns whether there was one.

        Nothing is corrected if there are steady loads, whose stress adds to the target stress, or supports, which carry
        a part of it.
        """
        if self._tractions is None or not self._by_tractions_alone:
            return False
        return self._tractions.correct(mean_stress(self.scene, system.stress(state.displacement)))

    def turn_tractions(self, system: DiskSystem, state: State) -> None:
        """Rotate the tractions with the sides, and apply corrections."""
        if self._tractions is not None:
            system.apply(self.load(state.displacement))

    def keep_from_turning(self, state: State) -> None:
        """Stop the rigid motion of a body that is not held, as no force would bring it to rest."""
        if not self._floats:
            return
        mass, velocity = self.scene.mass, state.velocity.copy()
        arm = self.scene.assembly.positions + state.displacement[:2].T
        arm = (arm - np.average(arm, axis=0, weights=mass)).T
        velocity[:2] -= np.average(velocity[:2], axis=1, weights=mass)[:, None] * self.scene.free[:2, None]
        state.velocity = velocity
        if not self.scene.free.all():
            return
        spin = np.sum(mass * (arm[0] * velocity[1] - arm[1] * velocity[0])) + np.sum(self.scene.inertia * velocity[2])
        rate = spin / (np.sum(mass * (arm**2).sum(axis=0)) + self.scene.inertia.sum())
        state.velocity = velocity - rate * np.stack([-arm[1], arm[0], np.ones(self.scene.count)])

    def unbalanced(self, system: DiskSystem, forces: np.ndarray) -> np.ndarray:
        """Unbalanced forces (2, m) N on disks along the directions in which they can move, for forces (3, n)."""
        return np.where(self._moves, (forces + system.load)[:2, : self._moves.shape[1]], 0.0)

    def force_ratio(self, system: DiskSystem, forces: np.ndarray, contacts: Mapping[str, ContactList]) -> float:
        """Mean unbalanced force over the mean contact force, for contact forces (3, n) and the pairs of each part."""
        unbalanced = np.hypot(*self.unbalanced(system, forces)).mean()
        pair = np.concatenate([np.hypot(*pairs.arrays.force[:2]) for pairs in contacts.values()])
        acting = pair > 0.0
        return float(unbalanced / pair[acting].mean()) if acting.any() else (np.inf if unbalanced > 0.0 else 0.0)
