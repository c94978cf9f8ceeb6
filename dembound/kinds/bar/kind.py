"""Bars as a kind of body, with their snapshots for ParaView: one line from each node to the next, and a script.

Every node is drawn at its reference position plus its displacement (y = z = 0), with these point data:

| name | unit | shape | what |
|---|---|---|---|
| ``id`` | 1 | (n,) | number of the node, from the left end |
| ``volume`` | m³ | (n,) | volume of the node; half at the ends |
| ``displacement`` | m | (n, 3) | since the start of the run, along x |
| ``velocity`` | m/s | (n, 3) | half a time step earlier, along x |
| ``stress`` | Pa | (n,) | along the bar, tension positive |
| ``damage`` | 1 | (n,) | local damage φ, 0 whole to 1 cut off (L eq. 7) |
| ``peakVelocity`` | m/s | (n,) | largest speed in the whole run, in every file; if the case asks for it |

Every line has the cell data ``brokenBonds`` (n − 1,): how many bonds across it have broken so far.

To see a bar in ParaView, run ``paraview --script=view.py`` in the folder, or open ``bar.pvd``, press Apply and choose
an array to colour by. A bar is thin: *Warp By Scalar* with ``stress`` and the normal (0, 1, 0) draws it as a curve.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from dembound.bar.body import storage_of
from dembound.bar.scene import BarScene, build_bar
from dembound.bar.stability import choose_step, front_of_bar, sources_of_bar, trials_of_bar
from dembound.casefile.bar import SCHEMA, BarCase
from dembound.kinds.bar.summary import bar_facts, bar_outcome, part_of, spalls_of, summarise_bar
from dembound.kinds.bar.warnings import bar_warnings
from dembound.kinds.bar.warnings_after import warnings_after_bar
from dembound.motion.kind import Beginning, Finding, Kind, MovingPicture, OnLook, Stages
from dembound.motion.memory import Storage
from dembound.motion.paths import Front, Source
from dembound.motion.stability import Trial
from dembound.motion.state import Arrays
from dembound.motion.trackers import Run
from dembound.results.reader import has_monitors
from dembound.results.vtk import in_space, passed_through, shown
from dembound.table import Box
from dembound.words import CracksBy, Entries

if TYPE_CHECKING:
    import meshio
    from matplotlib.figure import Figure

VIEW_SCRIPT = '''\
"""Shows the line of a bar in ParaView: paraview --script=view.py, or Run Script once it is open."""

from pathlib import Path

from paraview.simple import *

folder = Path(globals().get("__file__", "view.py")).resolve().parent  # Run Script has no __file__
files = {path.stem: path for ending in ("vtkhdf", "pvd") for path in folder.glob(f"*.{ending}")}
bar = GetActiveSource() or OpenDataFile(str(files["bar"]))
view = GetActiveViewOrCreate("RenderView")
view.InteractionMode = "2D"
GetAnimationScene().UpdateAnimationUsingDataTimeSteps()

shown = Show(bar, view)
shown.SetRepresentationType("Surface")
shown.LineWidth = 12.0

ColorBy(shown, ("POINTS", "stress"))
shown.RescaleTransferFunctionToDataRangeOverTime()
shown.SetScalarBarVisibility(view, True)
view.ResetCamera()
Render()
'''


def bar_mesh(particles: Arrays, snapshot: Arrays, cracks: Arrays) -> meshio.Mesh:
    """One snapshot of a bar, and the cracks until then, as lines with the data of this module's table."""
    displacement = snapshot["displacement"]  # a bar moves along x alone, its other columns are zero
    places = in_space(particles["position"])
    count = len(places)
    data = {
        "id": np.arange(count),
        "volume": particles["volume"],
        "displacement": displacement,
        "velocity": snapshot["velocity"],
        **passed_through(snapshot),
    }
    if "peak_velocity" in particles:
        data["peakVelocity"] = particles["peak_velocity"]
    nodes = np.arange(count, dtype=np.int32)
    lines = np.stack([nodes[:-1], nodes[1:]], axis=1)
    broken = broken_across(cracks["particles"], count).astype(np.int32)
    import meshio  # imported here, as commands that write no files need not wait for it

    cells = [("line", lines)]
    return meshio.Mesh(places + displacement, cells, point_data=shown(data), cell_data={"brokenBonds": [broken]})


def broken_across(pairs: np.ndarray, count: int) -> np.ndarray:
    """How many broken bonds, pairs (b, 2) of nodes, cross each plane (n − 1,) between neighbours of n = `count`."""
    first, last = np.sort(pairs, axis=1).T
    begun, ended = (np.bincount(nodes, minlength=count) for nodes in (first, last))
    return np.cumsum(begun - ended)[:-1]


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

    def field_picture(
        self, record: Path, field: str, snapshot: int | None, exaggerate: float | None, cracks: CracksBy = "kind"
    ) -> Figure:
        """One field over place and time."""
        from dembound.plot.bar import plot_bar_field

        return plot_bar_field(record, field, snapshot)

    def moving_picture(self, record: Path, field: str | None, exaggerate: float | None) -> MovingPicture:
        """Fields along the bar, by default stress and damage."""
        from dembound.plot.moving import MovingBar

        return MovingBar(record, ("stress", "damage") if field is None else (field,), exaggerate or 0.0)
