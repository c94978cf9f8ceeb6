"""The static stage: a damped run that brings a body to rest under steady forces, and its end."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from dembound.disks.columns import COLUMNS
from dembound.disks.faces.states import cracks_of, most_slipped, states_among, states_of
from dembound.disks.rest.loading import LOOK, Loading
from dembound.disks.rest.settled import Settled, Uniformity, among, block_stress
from dembound.disks.rest.static_scene import StaticScene
from dembound.disks.scene import DiskScene, column_alone
from dembound.disks.stability import Overlaps, largest_overlap, step_limit
from dembound.disks.stepping.scene_parts import Start, contact_lists
from dembound.disks.stepping.system import DiskSystem
from dembound.motion.kind import OnLook, Stages, StalledError
from dembound.motion.part import Cracks, joined
from dembound.motion.simulation import Simulation
from dembound.motion.state import Arrays, State
from dembound.motion.trackers import Run, Tracker
from dembound.results.reader import understood

PATIENCE = 20_000
"""Steps after which a stage has stalled if the force ratio has not decreased by a tenth."""

ELASTIC_PATIENCE = 5_000
"""Steps without such a decrease after which a body leaves the elastic law."""

WORST = 3
"""Number of particles in the message about a stalled stage."""


class UntilAtRest(Tracker):
    """Ends a static stage that is at rest or has stalled; until then it applies the loads.

    Parameters
    ----------
    body : the scene that settles.
    system : its parts.
    loading : applies its loads.
    on_look : receives the number of steps done, the force ratio and the name from time to time.
    stage : its name in messages.

    Attributes
    ----------
    ratio : mean unbalanced over mean contact force at the last evaluation. forces : (3, n) N and N·m of contacts at
    that time.
    """

    name = "until at rest"
    evolving = ("due", "_best", "_best_at")

    def __init__(
        self, body: StaticScene, system: DiskSystem, loading: Loading, on_look: OnLook | None, stage: str
    ) -> None:
        self.ratio, self.forces = np.inf, np.zeros((3, 0))
        self._body, self._system, self._loading = body, system, loading
        self._on_look, self._stage = on_look, stage
        self._best, self._best_at = np.inf, 0
        # a law without history has no list of pairs, but their forces are needed too
        self._contacts = system.contacts or contact_lists(body.scene)
        self._look_after(0)

    def _look_after(self, step: int) -> None:
        self.due = min(step + LOOK, max(self._body.static.max_steps, step + 1))

    def handle(self, run: Run) -> None:
        """Evaluate the force ratio; raise StalledError if it no longer decreases or the steps exceed the maximum."""
        state, static, loading = run.state, self._body.static, self._loading
        self._body.keep_from_turning(state)
        self.forces = self._contact_forces(state.displacement)
        self.ratio = self._body.force_ratio(self._system, self.forces, self._contacts)
        if self._on_look is not None:
            self._on_look(state.step, self.ratio, self._stage)
        if loading.is_rising(state.step):
            self._begin_anew(state)
        elif self.ratio <= self._enough:
            if loading.is_the_answer(state):
                run.stopped = True
                return
            self._begin_anew(state)
        elif self.ratio < 0.9 * self._best:
            self._best, self._best_at = self.ratio, state.step
        elif state.step - self._best_at >= ELASTIC_PATIENCE and loading.give_up_elastic_law(state):
            self._begin_anew(state)
        if state.step - self._best_at >= PATIENCE or state.step >= static.max_steps:
            self._fail(run)
        loading.put_on(state)
        self._look_after(state.step)

    @property
    def _enough(self) -> float:
        """The force ratio at which the stage is over under the present law."""
        return self._body.static.enough(slides=self._system.uses_history)

    def _begin_anew(self, state: State) -> None:
        """Reset the record of progress, as the loads or the law have changed."""
        self._best, self._best_at = np.inf, state.step

    def _fail(self, run: Run) -> None:
        """Raise StalledError, with the state of the stage and advice."""
        lacking, cracks = self._body.unbalanced(self._system, self.forces), self.take_cracks()
        steps = run.state.step
        broken = f"broken bonds: {len(cracks):,}{most_slipped(self._system.joints)}\n{_lacking(run, lacking)}"
        came, advice = "came to", "allow more with static.max_steps"
        within = f"in {steps:,} steps"
        if steps < self._body.static.max_steps:
            came, advice = "stalls at", "is the body held, and can its contacts carry the load?"
            within = f"after {steps:,} steps"
        message = f"{self._stage} {came} an unbalanced force ratio of {self.ratio:.3g} {within}"
        message += f", static.ratio requests {self._enough:g}; {broken}\n{advice}"
        raise StalledError(message, run, lacking.T, cracks)

    def saved_arrays(self) -> Arrays:
        """The next step of evaluation, the force ratio and step of the last progress, and the loads."""
        return {**super().saved_arrays(), **self._loading.saved_arrays()}

    def restore(self, saved: Arrays) -> None:
        """Restore the arrays returned by `saved_arrays` in another run of the same case."""
        super().restore(saved)

        self._loading.restore(saved)

    def take_cracks(self) -> Cracks:
        """The bonds that broke since the last call."""
        return joined([*(pairs.take_cracks() for pairs in self._contacts.values()), cracks_of(self._system.joints)])

    def _contact_forces(self, displacement: np.ndarray) -> np.ndarray:
        """Forces and moments (3, n) of contacts and ties now, under the elastic law with the locked-in forces."""
        if not self._system.uses_history:
            for pairs in self._contacts.values():
                pairs.push(displacement, reference=True)
        forces = self._system.forces
        return forces.last(self._contacts) + forces.of_ties(displacement) + forces.of_joints(displacement)


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


SAFETY = 0.9
"""Time step over the stability limit."""


def settle(scene: DiskScene, on_look: OnLook | None = None, stages: Stages | None = None) -> Settled:
    """Run a scene's static stage, or take its result from `stages`.

    A scene with an excavation settles before it, and then again from this state, under the same loads and supports.
    With a free field the column settles first, by itself; the body starts from its state, and both settle together.
    Otherwise the body could reach another state, as with friction there is more than one state of rest.

    Raises StalledError, with the force ratio reached, when the ratio no longer decreases or the steps exceed the
    maximum, and RunError when the motion grows without bound.
    """
    kept = stages or Stages()
    if scene.before is not None:
        before = _settle_built(scene.before, _Stage("before", "before the excavation the static stage", on_look, kept))
        stage = _Stage("body", "after the excavation the static stage", on_look, kept)
        excavated = _settle(scene, lambda: _excavate(scene, before.start), stage)
        return replace(excavated, before=before)
    return _settle_built(scene, _Stage("body", "the static stage", on_look, kept))


def settle_on(scene: DiskScene, start: Start, on_look: OnLook | None = None, stages: Stages | None = None) -> Settled:
    """Bring a settled body to rest again, under loads other than before, whose difference is applied slowly.

    start : of a body settled in an equal scene, which can be used only once. Raises the errors of `settle`.
    """
    return _settle(scene, lambda: start, _Stage("body", "the static stage", on_look, stages or Stages()))


def require_stages(scene: DiskScene) -> None:
    """Raise the errors of building the scenes of a static stage, if the case has one."""
    if (static := scene.case.static) is None:
        return
    for each in filter(None, (scene.before, scene)):
        for built in (each, *(column_alone(each, number) for number in range(len(each.seams)))):
            StaticScene(built, static)


def stage_names(scene: DiskScene) -> list[str]:
    """The names of a scene's stages in the `Stages` that `settle` receives, in their order."""
    if scene.before is None:
        return [*_columns(scene, "body"), "body"]
    return [*_columns(scene.before, "before"), "before", "body"]


def _columns(scene: DiskScene, name: str) -> list[str]:
    """The names of the stages of a scene's free-field columns, which precede the body's."""
    return [f"{name}.{part}" for part in scene.parts if part != "body"]


@dataclass(frozen=True)
class _Stage:
    """One stage: its key in `stages`, its name in messages, the receiver of its progress, and the store of results."""

    key: str
    name: str
    on_look: OnLook | None
    stages: Stages


def _settle_built(scene: DiskScene, stage: _Stage) -> Settled:
    """Settle a body as built, after its free-field columns."""
    columns = []
    for number, key in enumerate(_columns(scene, stage.key)):
        alone = replace(stage, key=key, name=f"{stage.name} of the free-field column alone")
        columns.append(_settle(column_alone(scene, number), lambda: None, alone))
    if not columns:
        return _settle(scene, lambda: None, stage)
    starts = [each.start for each in columns]
    return replace(_settle(scene, lambda: _beside(scene, starts), stage), columns=tuple(columns))


def _excavate(scene: DiskScene, before: Start) -> Start:
    """The start of an excavated scene: the settled state before, with the history of the remaining contacts."""
    assert scene.kept is not None
    contacts = contact_lists(scene) if before.contacts else {}
    for name, pairs in contacts.items():
        there = before.contacts[name] if name in before.contacts else before.contacts[COLUMNS[0]]
        pairs.take_over_subset(there, scene.kept[scene.parts[name]] - there.nodes.start)
    assert scene.before is not None
    joints = states_among(before.joints, scene.before.faces, scene.faces, scene.kept)
    return Start(before.displacement[:, scene.kept], contacts, before.has_history, joints=joints)


def _beside(scene: DiskScene, columns: Sequence[Start]) -> Start:
    """The start of a body with settled columns: every particle and pair in the state of its twin.

    Beside two columns those of the body begin as built, as not all of them have a twin.
    """
    displacement, has_history = np.zeros((3, scene.disk_count)), any(each.has_history for each in columns)
    contacts = contact_lists(scene) if columns[0].contacts else {}
    twins = [seam.twin for seam in scene.seams]
    for twin, seam, name, column in zip(twins, scene.seams, scene.parts, columns, strict=False):
        own = np.arange(seam.disks.start, scene.disk_count if len(columns) == 1 else seam.disks.stop)
        displacement[:, own] = column.displacement[:, twin[own] - seam.disks.start]
        if has_history:
            for pairs in [contacts[name], *([contacts["body"]] if len(columns) == 1 else [])]:
                pairs.copy_twins(column.contacts["body"], twin[pairs.nodes] - seam.disks.start, displacement)
    return Start(displacement, contacts, has_history)


def _settle(scene: DiskScene, starting: Callable[[], Start | None], stage: _Stage) -> Settled:
    """Run one stage to rest, unless its result is kept.

    starting : returns its start, None for the scene as built.
    """
    if (kept := stage.stages.finished(stage.key)) is not None:
        with understood(Path(f"{stage.key}.npz")):
            return Settled.restored(scene, kept)
    static, start = scene.case.static, starting()
    assert static is not None
    body = StaticScene(scene, static)
    step = SAFETY * step_limit(body.scene, damp=static.damp, viscous=False)
    datum = none = np.zeros((3, body.scene.count))
    if start is not None:
        start = replace(start, displacement=among(start.displacement, body.scene))
        datum = start.displacement
    load = body.load(datum if start is not None and start.has_history else none)
    system = DiskSystem(body.scene, step, start, settling=True, load=load)
    simulation = Simulation(body.scene, step, system=system, datum=datum, damp=static.damp)
    loading = Loading(body, system, datum, step)
    rest = UntilAtRest(body, system, loading, stage.on_look, stage.name)
    simulation.track(rest)
    if not scene.ground.law.starts_elastic:
        simulation.track(Overlaps(largest_overlap(body.scene, step, static.damp)))
    stage.stages.begin(stage.key, simulation)
    simulation.run(static.max_steps)
    displacement, forces = simulation.state.displacement, rest.forces
    uniform = scene.at_rest is None or scene.at_rest.is_uniform
    asked = None if static.stress is None or not uniform else np.array(static.stress)
    unbalanced = np.hypot(*(forces + body.scene.steady_load)[:2, : scene.disk_count])
    held = body.held
    touching, joints = None if system.walls is None else system.walls.touching, states_of(system.joints)
    settled = Settled(
        start=Start(among(displacement, scene), system.contacts, system.uses_history, touching, joints),
        steps=simulation.state.step,
        ratio=rest.ratio,
        mean_reaction=float(unbalanced[held].mean()) if held.any() else 0.0,
        mean_residual=float(np.hypot(*body.unbalanced(system, forces))[~held].mean()) if not held.all() else 0.0,
        stress=block_stress(body.scene, system, displacement).mean(axis=(0, 1)),
        uniformity=None if asked is None else Uniformity.of(body.scene, system, displacement, asked),
        cracks=rest.take_cracks(),
    )
    stage.stages.finish(stage.key, settled.saved_arrays())
    return settled
