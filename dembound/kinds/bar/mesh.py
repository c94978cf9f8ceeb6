"""Snapshots of a bar for ParaView: one line from each node to the next, and a script that shows them.

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

from typing import TYPE_CHECKING

import numpy as np

from dembound.motion.state import Arrays
from dembound.results.vtk import in_space, passed_through, shown

if TYPE_CHECKING:
    import meshio

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
