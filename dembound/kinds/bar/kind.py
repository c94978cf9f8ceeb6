"""Bars as a kind of body."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from dembound.bar.body import storage_of
from dembound.bar.linear_steps import front_of_bar, sources_of_bar
from dembound.bar.scene import BarScene, build_bar
from dembound.bar.stability import choose_step, trials_of_bar
from dembound.casefile.bar import SCHEMA, BarCase
from dembound.kinds.bar.facts import bar_facts
from dembound.kinds.bar.mesh import VIEW_SCRIPT, bar_mesh
from dembound.kinds.bar.summary import bar_outcome, part_of, spalls_of, summarise_bar
from dembound.kinds.bar.warnings import bar_warnings
from dembound.kinds.bar.warnings_after import warnings_after_bar
from dembound.motion.kind import Beginning, Finding, Kind, MovingPicture, OnLook, Stages
from dembound.motion.memory import Storage
from dembound.motion.paths import Front, Source
from dembound.motion.stability import Trial
from dembound.motion.state import Arrays
from dembound.motion.trackers import Run
from dembound.results.reader import has_monitors
from dembound.table import Box
from dembound.words import Entries

if TYPE_CHECKING:
    import meshio
    from matplotlib.figure import Figure


SPALL_PLACE, SPALL_TIME = "spall place", "spall time"
"""Names of the findings about the first spall."""


class Bars(Kind[BarCase, BarScene]):
    """Bars of nodes."""

    name, plural = "bar", "bars"
    schema = SCHEMA
    view_script = VIEW_SCRIPT
    work_unit = "bond updates"

    def build(self, case: BarCase) -> BarScene:
        """The scene of a bar: its nodes and what supports them."""
        return build_bar(case)

    def choose_step(self, scene: BarScene) -> tuple[float, float]:
        """Time step and stability limit (s)."""
        return choose_step(scene)

    def is_planned_quickly(self, case: BarCase) -> bool:
        """Always true, as the step limit of a bar is computed within milliseconds."""
        return True

    def begin(self, scene: BarScene, time_step: float, on_look: OnLook, stages: Stages | None = None) -> Beginning:
        """The bar at rest."""
        return Beginning(scene.system(time_step))

    def trials(self, case: BarCase, *, full: bool = False) -> tuple[list[Trial], list[str]]:
        """The bar at every stage of its method."""
        return trials_of_bar(case)

    def sources(self, scene: BarScene) -> list[Source]:
        """Driven and loaded ends."""
        return sources_of_bar(scene.case)

    def front(self, scene: BarScene, time_step: float) -> Front:
        """The fastest waves at any stage of its method."""
        return front_of_bar(scene, time_step)

    def storage(self, scene: BarScene) -> Storage:
        """Bytes on disk of the results of a bar, from its nodes and the lengths of its bonds."""
        return storage_of(scene.case)

    def facts(self, scene: BarScene, time_step: float) -> Entries:
        """The bar, its method, boundaries and loads in words."""
        return bar_facts(scene, time_step)

    def warnings_before(self, scene: BarScene, time_step: float) -> list[str]:
        """Warnings that are known before the run."""
        return bar_warnings(scene, time_step)

    def warnings_after(self, scene: BarScene, summary: Mapping[str, Any], record: Path) -> list[str]:
        """Warnings from the results of the run."""
        return warnings_after_bar(scene, summary, record)

    def summarise(self, scene: BarScene, run: Run, beginning: Beginning, record: Path) -> dict[str, Any]:
        """The bar and its spalls in numbers."""
        return summarise_bar(scene, run, record)

    def work(self, run: Run) -> int:
        """Number of computed forces of springs and bonds; without horizons n − 1 in every step."""
        return part_of(run).bond_updates

    def findings(self, scene: BarScene, run: Run, inside: Box | None = None) -> dict[str, Finding]:
        """Middle (m) and time (s) of the first spall, if there is one.

        With a fracture energy the time is that of its beginning.
        """
        for spall in sorted(spalls_of(scene, run)[0], key=lambda spall: spall.reached):
            place = 0.5 * sum(spall.start)
            if inside is None or inside[0] <= place <= inside[2]:
                return {SPALL_PLACE: Finding(place, "m"), SPALL_TIME: Finding(spall.reached, "s")}
        return {}

    def outcome(self, summary: Mapping[str, Any]) -> list[str]:
        """Methods and spalls in words."""
        return bar_outcome(summary)

    def meshes(self, particles: Arrays, snapshot: Arrays, cracks: Arrays) -> dict[str, meshio.Mesh]:
        """One line from each node to the next."""
        return {"bar": bar_mesh(particles, snapshot, cracks)}

    def pictures(self, record: Path) -> Iterator[tuple[str, Figure]]:
        """The bar over place and time, and the stress at its monitors."""
        from dembound.plot.bar import plot_bar
        from dembound.plot.histories import plot_histories

        yield "scene", plot_bar(record)
        if has_monitors(record):
            yield "histories_stress", plot_histories([record], quantity="stress")

    def field_picture(self, record: Path, field: str, snapshot: int | None) -> Figure:
        """One field over place and time."""
        from dembound.plot.bar import plot_bar_field

        return plot_bar_field(record, field, snapshot)

    def moving_picture(self, record: Path, field: str | None, exaggerate: float) -> MovingPicture:
        """Fields along the bar, by default stress and damage."""
        from dembound.plot.moving import MovingBar

        return MovingBar(record, ("stress", "damage") if field is None else (field,), exaggerate)
