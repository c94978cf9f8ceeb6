"""Bonded disks as a kind of body."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from dembound.casefile.disks import SCHEMA, DiskCase
from dembound.disks.changes import Changes, Membranes, require_inner_holes, times_of
from dembound.disks.contacts.pairs import first_break
from dembound.disks.debris import Rest
from dembound.disks.intact import require_room
from dembound.disks.material.constants import limits_of
from dembound.disks.material.packing_waves import front_of
from dembound.disks.memory import storage_of
from dembound.disks.pressure import follows, in_run
from dembound.disks.reduced import reduced
from dembound.disks.rest.settled import Settled, settling_keys
from dembound.disks.rest.stage import require_stages, settle, stage_names
from dembound.disks.scene import DiskScene, build
from dembound.disks.sources import sources_of
from dembound.disks.stability import Overlaps, choose_step, largest_overlap
from dembound.disks.step_cost import slower
from dembound.disks.stepping.load_factor import LoadFactor, least_load_factor
from dembound.disks.stepping.system import DiskSystem
from dembound.disks.trials import trials_of_disks
from dembound.disks.watches import FarDisks, Turns
from dembound.formulas.disks.entry import all_late_by
from dembound.kernels.contacts import UPDATED
from dembound.kinds.disks.debris import debris_columns, describe_debris
from dembound.kinds.disks.facts import disk_facts
from dembound.kinds.disks.incident_wave import with_incident_waves
from dembound.kinds.disks.mesh import VIEW_SCRIPT, contact_mesh, continuum_mesh, disk_mesh, joint_mesh, wall_mesh
from dembound.kinds.disks.summary import (
    asked_stress,
    describe_static,
    disk_outcome,
    stage_numbers,
    summarise_disks,
    warnings_after_disks,
)
from dembound.kinds.disks.walls import require_clear
from dembound.kinds.disks.warnings import disk_warnings
from dembound.motion.endings import rest_rule
from dembound.motion.kind import Beginning, Finding, Kind, MovingPicture, OnLook, Reduction, Slower, Stage, Stages
from dembound.motion.memory import Storage
from dembound.motion.paths import Front, Source
from dembound.motion.stability import Trial
from dembound.motion.state import Arrays
from dembound.motion.trackers import Run, Tracker
from dembound.table import Box
from dembound.words import CracksBy, Entries

if TYPE_CHECKING:
    import h5py
    import meshio
    from matplotlib.figure import Figure

    from dembound.plot.field import FieldName


class Disks(Kind[DiskCase, DiskScene]):
    """Bonded disks."""

    name = plural = "disks"
    schema = SCHEMA
    view_script = VIEW_SCRIPT
    work_unit = "particle-steps"

    def build(self, case: DiskCase) -> DiskScene:
        """The scene of a case that is to run.

        Raises the errors for loads without particles, a singular material, walls that cut disks, and too large zones
        without broken bonds;
        strips and columns that are built from parts of a case may be smaller.
        """
        scene = with_incident_waves(build(case))
        for each in filter(None, (scene.before, scene)):
            if each.has_history:  # under other laws zones matter to load factors only
                require_room(case, each.intact_zones, each.disk_count - each.column_count)
        require_clear(scene)
        require_inner_holes(scene)
        _ = scene.steady_load, [layer.material_tensor for layer in scene.ground.materials]
        return scene

    def choose_step(self, scene: DiskScene) -> tuple[float, float]:
        """Time step and stability limit (s)."""
        return choose_step(scene)

    def reduced(self, scene: DiskScene) -> Reduction[DiskScene]:
        """One row of a scene, from whose motion that of all disks follows, or the scene itself."""
        return reduced(scene)

    def begin(self, scene: DiskScene, time_step: float, on_look: OnLook, stages: Stages | None = None) -> Beginning:
        """Settle the body if the case has a static stage, else begin with the body as built."""
        if scene.case.static is None:
            return Beginning(scene.system(time_step))
        settled = settle(scene, on_look, stages)
        datum = settled.start.displacement
        return Beginning(
            system=DiskSystem(scene, time_step, settled.start, load=in_run(scene, datum, scene.steady_load)),
            datum=datum,
            stages=tuple(_stages(scene, settled)),
            summary=describe_static(settled, asked_stress(scene)),
        )

    def trackers(self, run: Run) -> list[Tracker]:
        """What a case needs: membranes of pressures on sides, far disks, rest, turns of bonds, a load factor."""
        scene, case, system = run.scene, run.scene.case, run.system
        assert isinstance(case, DiskCase)
        assert isinstance(system, DiskSystem)
        assert isinstance(scene, DiskScene)
        found: list[Tracker] = [Membranes(scene)] if follows(scene) else []
        if times_of(case):
            found.append(Changes(scene, system, run.time_step))
        if scene.has_history:
            found.append(FarDisks(scene, retires=case.run.far == "retire"))
            if case.pull > 0.0:
                rule, ends = rest_rule(scene, self.sources(scene)), case.run.until == "rest"
                found.append(Rest(scene, rule, run.time_step, ends=ends))
        if not scene.ground.law.starts_elastic:
            found.append(Overlaps(largest_overlap(scene, run.time_step)))
        if limits_of(case.material).geometry != UPDATED:
            found.append(Turns())
        return [*found, LoadFactor(case, system)] if case.output.load_factor else found

    def trials(self, case: DiskCase, *, full: bool = False) -> tuple[list[Trial], list[str]]:
        """Fewer copies of the brick under the linear law, and under the case's own law if that is history-dependent."""
        return trials_of_disks(case, full=full)

    def sources(self, scene: DiskScene) -> list[Source]:
        """Where waves start and are scattered: driven sides, loads, and holes."""
        return sources_of(scene.case, scene.ground)

    def front(self, scene: DiskScene, time_step: float) -> Front:
        """The front of the fastest waves of the packing."""
        return front_of(scene.ground, scene.case.run.safety)

    def late(self, scene: DiskScene) -> float | None:
        """Delay (s) of the motion by the places where waves enter disks; negative where motion is early."""
        return all_late_by(scene)

    def storage(self, scene: DiskScene) -> Storage:
        """Bytes on disk of the results of a scene, from the numbers of its disks and contacts."""
        return storage_of(scene.case, scene.sizes)

    def stage_keys(self, scene: DiskScene) -> dict[str, Any]:
        """All inputs that determine the result of the static stage, by key."""
        return settling_keys(scene)

    def require_ready(self, scene: DiskScene, stepped: DiskScene) -> None:
        """Find when waves enter, and build the scenes of the static stage."""
        self.late(scene)
        require_stages(stepped)

    def stage_names(self, scene: DiskScene) -> list[str]:
        """Names of the parts of the static stage, none without one."""
        return [] if scene.case.static is None else stage_names(scene)

    def stages_from(self, case: DiskCase) -> Path | None:
        """The folder given by ``static.from``."""
        return None if case.static is None or case.static.from_ is None else Path(case.static.from_)

    def facts(self, scene: DiskScene, time_step: float) -> Entries:
        """Facts on packing, law, loads and boundaries."""
        return disk_facts(scene)

    def slower(self, scene: DiskScene) -> Slower | None:
        """The pace of ground all broken, or of contacts that slide, by measured constants."""
        return slower(scene)

    def settles(self, case: DiskCase) -> bool:
        """Whether the case has a static stage of its own."""
        return case.static is not None and case.static.from_ is None

    def warnings_before(self, scene: DiskScene, time_step: float) -> list[str]:
        """Warnings that are known before the run."""
        return disk_warnings(scene, time_step)

    def warnings_after(self, scene: DiskScene, summary: Mapping[str, Any], record: Path) -> list[str]:
        """Warnings from the results of the run."""
        return warnings_after_disks(scene, summary, record)

    def summarise(self, scene: DiskScene, run: Run, beginning: Beginning, record: Path) -> dict[str, Any]:
        """Packing, sides and the static stage in numbers."""
        found = summarise_disks(scene, run) | {"static": beginning.summary}
        return found | {"debris": describe_debris(scene, run, record)}

    def derived(self, scene: DiskScene, file: h5py.File) -> dict[str, tuple[np.ndarray, str]]:
        """Run-out and fragments at every snapshot."""
        return debris_columns(scene, file)

    def work(self, run: Run) -> int:
        """Steps times the particles that are stepped."""
        return run.state.step * run.scene.count

    def findings(self, scene: DiskScene, run: Run, inside: Box | None = None) -> dict[str, Finding]:
        """Time (s) and place (m) of the first broken bonds inside a box, if any, and the load factor if requested."""
        return first_break(run, inside) | least_load_factor(run, inside)

    def outcome(self, summary: Mapping[str, Any]) -> list[str]:
        """Static stage, laws and cracks in words."""
        return disk_outcome(summary)

    def meshes(self, particles: Arrays, snapshot: Arrays, cracks: Arrays) -> dict[str, meshio.Mesh]:
        """One vertex per disk, one line per contact if the record has contacts, walls, joints, cells of a continuum."""
        meshes = {"particles": disk_mesh(particles, snapshot, cracks)}
        if "contacts/particles" in snapshot:
            meshes["contacts"] = contact_mesh(particles, snapshot)
        if any(name.startswith("walls/") for name in snapshot):
            meshes["walls"] = wall_mesh(snapshot)
        if len(snapshot.get("joints/ends", ())):
            meshes["joints"] = joint_mesh(snapshot)
        if "continuum/position" in particles:
            meshes["continuum"] = continuum_mesh(particles, snapshot)
        return meshes

    def pictures(self, record: Path) -> Iterator[tuple[str, Figure]]:
        """The picture of the scene."""
        from dembound.plot.scene import plot_scene

        yield "scene", plot_scene(record)

    def field_picture(
        self, record: Path, field: str, snapshot: int | None, exaggerate: float | None, cracks: CracksBy = "kind"
    ) -> Figure:
        """The scene with disks coloured by a field, or with lines for the forces of contacts."""
        from dembound.plot.field import FORCES
        from dembound.plot.packing import plot_chains
        from dembound.plot.scene import plot_scene

        if field == FORCES:
            return plot_chains(record, snapshot)
        return plot_scene(record, snapshot, cast("FieldName", field), exaggerate=exaggerate, cracks=cracks)

    def moving_picture(self, record: Path, field: str | None, exaggerate: float | None) -> MovingPicture:
        """The scene with disks coloured by a field, by default velocity."""
        from dembound.plot.moving import MovingScene

        return MovingScene(record, field or "velocity", exaggerate)


def _stages(scene: DiskScene, settled: Settled) -> Iterator[Stage]:
    """The static stage before an excavation, if there was one, and the last one."""
    if settled.before is not None and scene.kept is not None:
        before, kept = settled.before, scene.kept
        displacement = before.start.displacement[:, kept]
        yield Stage("static/before", stage_numbers(before), displacement, before.cracks.among(kept))
    yield Stage("static", stage_numbers(settled), settled.start.displacement, settled.cracks)
