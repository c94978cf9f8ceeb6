"""The static stage: a damped run that brings a body to rest under steady loads and a given stress.

The forces of its supports and from outside then act as a constant force F_0 on every particle (Z eqs 5, 6: the
unbalanced force F_eq with opposite sign). The motion starts from rest, and the boundaries of the run replace the
supports.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from dembound.disks.rest.block_stress import Uniformity, block_stress
from dembound.disks.rest.loading import Loading
from dembound.disks.rest.settled import Settled, among
from dembound.disks.rest.static_scene import StaticScene
from dembound.disks.rest.until_at_rest import UntilAtRest
from dembound.disks.scene import DiskScene, column_alone
from dembound.disks.stability import step_limit
from dembound.disks.stepping.contact_lists import contact_lists
from dembound.disks.stepping.start import Start
from dembound.disks.stepping.system import DiskSystem
from dembound.motion.kind import OnLook
from dembound.motion.simulation import Simulation
from dembound.motion.stages import Stages
from dembound.results.reader import understood

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


def require_stages(scene: DiskScene) -> None:
    """Raise the errors of building the scenes of a static stage, if the case has one."""
    if (static := scene.case.static) is None:
        return
    for each in filter(None, (scene.before, scene)):
        for built in (each, *([column_alone(each)] if each.seam is not None else [])):
            StaticScene(built, static)


def stage_names(scene: DiskScene) -> list[str]:
    """The names of a scene's stages in the `Stages` that `settle` receives, in their order."""
    if scene.before is None:
        return [*([_column("body")] if scene.seam is not None else []), "body"]
    return [*([_column("before")] if scene.before.seam is not None else []), "before", "body"]


def _column(name: str) -> str:
    """The name of the stage of the free-field column, which precedes the body's."""
    return f"{name}.column"


@dataclass(frozen=True)
class _Stage:
    """One stage: its key in `stages`, its name in messages, the receiver of its progress, and the store of results."""

    key: str
    name: str
    on_look: OnLook | None
    stages: Stages


def _settle_built(scene: DiskScene, stage: _Stage) -> Settled:
    """Settle a body as built, after its free-field column."""
    if scene.seam is None:
        return _settle(scene, lambda: None, stage)
    alone = replace(stage, key=_column(stage.key), name=f"{stage.name} of the free-field column alone")
    column = _settle(column_alone(scene), lambda: None, alone)
    return replace(_settle(scene, lambda: _beside(scene, column.start), stage), column=column)


def _excavate(scene: DiskScene, before: Start) -> Start:
    """The start of an excavated scene: the settled state before, with the history of the remaining contacts."""
    assert scene.kept is not None
    contacts = contact_lists(scene) if before.contacts else {}
    for name, pairs in contacts.items():
        there = before.contacts[name]
        kept = scene.kept[(scene.kept >= there.nodes.start) & (scene.kept < there.nodes.stop)] - there.nodes.start
        pairs.take_over_subset(there, kept)
    return Start(before.displacement[:, scene.kept], contacts, before.has_history)


def _beside(scene: DiskScene, column: Start) -> Start:
    """The start of a body with a settled column: every particle and pair in the state of its twin."""
    assert scene.seam is not None
    displacement = column.displacement[:, scene.seam.twin]  # of the disks
    contacts = contact_lists(scene) if column.contacts else {}
    if column.has_history:
        for pairs in contacts.values():
            pairs.copy_twins(column.contacts["body"], scene.seam.twin[pairs.nodes], displacement)
    return Start(displacement, contacts, column.has_history)


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
    none = np.zeros((3, body.scene.count))
    datum = none
    if start is not None:
        start = replace(start, displacement=among(start.displacement, body.scene))
        datum = start.displacement
    load = body.load(datum if start is not None and start.has_history else none)
    system = DiskSystem(body.scene, step, start, settling=True, load=load)
    simulation = Simulation(body.scene, step, system=system, datum=datum, damp=static.damp)
    loading = Loading(body, system, datum, step)
    rest = UntilAtRest(body, system, loading, stage.on_look, stage.name)
    simulation.track(rest)
    stage.stages.begin(stage.key, simulation)
    simulation.run(static.max_steps)
    displacement, forces = simulation.state.displacement, rest.forces
    uniform = scene.at_rest is None or scene.at_rest.is_uniform
    asked = None if static.stress is None or not uniform else np.array(static.stress)
    unbalanced = np.hypot(*(forces + body.scene.steady_load)[:2, : scene.disk_count])
    held = body.held
    settled = Settled(
        start=Start(among(displacement, scene), system.contacts, system.uses_history),
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
