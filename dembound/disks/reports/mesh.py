"""Snapshots of disks for ParaView: one vertex per disk, and a script that shows them.

Every disk is a vertex at its reference position moved by its displacement (z = 0), with these point data:


| name | unit | shape | what |
|---|---|---|---|
| ``radii`` | m | (n,) | disk radius (YADE's name) |
| ``id`` | 1 | (n,) | number of the disk in the scene (YADE's name) |
| ``linVelVec`` | m/s | (n, 3) | velocity, z = 0 (YADE's name) |
| ``angVelVec`` | rad/s | (n, 3) | angular velocity, along z (YADE's name) |
| ``speed`` | m/s | (n,) | length of ``linVelVec`` |
| ``displacement`` | m | (n, 3) | since the start of the run, z = 0 |
| ``rotation`` | rad | (n,) | since the start of the run |
| ``brick_particle`` | 1 | (n,) | the disk of the brick that this one is a copy of |
| ``column`` | 1 | (n,) | 1 for a disk of a free-field column, else 0 |
| ``layer`` | 1 | (n,) | number of its layer, from 1 at the surface; of a layered ground |
| ``coordNumber`` | 1 | (n,) | its intact bonds and closed contacts, of a history-dependent law (YADE's name) |
| ``nbCracks`` | 1 | (n,) | its bonds that have broken so far (YADE's name) |
| ``damage`` | 1 | (n,) | that number over the bonds it had at the start, 0 where it had none |
| ``stress`` | Pa | (n, 6) | XX, YY, ZZ, XY, YZ, XZ, tension positive, with Z 0; if the case asks for it |
| ``peakVelocity`` | m/s | (n,) | largest speed in the whole run, in every file; if the case asks for it |

To see disks in ParaView, run ``paraview --script=view.py`` in the folder, or open ``particles.pvd``, press
Apply and run ``view.py`` from the Python shell (Run Script). By hand: representation *Point Gaussian*, shader
preset *Plain circle*, scale by array ``radii``, no scale function, Gaussian radius 1. As solid geometry: filter
*Glyph*, type *2D Glyph* (circle, filled), no orientation, scale array ``radii``, scale factor 2, all points.
*Warp By Vector* with ``displacement`` and factor k − 1 shows displacements k times as large. The script also shows the
continuum of ``continuum.pvd``, see `disks.continuum_mesh`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from dembound.motion.state import Arrays
from dembound.results.vtk import in_space, shown, vertices

if TYPE_CHECKING:
    import meshio

VIEW_SCRIPT = '''\
"""Shows the disks in ParaView, and in the same colours the continuum beyond them if there is one.

paraview --script=view.py, or Run Script once it is open.
"""

from pathlib import Path

from paraview.simple import *

folder = Path(globals().get("__file__", "view.py")).resolve().parent  # Run Script has no __file__
files = {path.stem: path for ending in ("vtkhdf", "pvd") for path in folder.glob(f"*.{ending}")}
disks = GetActiveSource() or OpenDataFile(str(files["particles"]))
view = GetActiveViewOrCreate("RenderView")
view.InteractionMode = "2D"
GetAnimationScene().UpdateAnimationUsingDataTimeSteps()

shown = Show(disks, view)
shown.SetRepresentationType("Point Gaussian")
shown.ShaderPreset = "Plain circle"
shown.SetScaleArray = ["POINTS", "radii"]
shown.ScaleByArray = 1
shown.UseScaleFunction = 0
shown.GaussianRadius = 1.0
all_shown = [shown]

if "continuum" in files:
    cells = Show(OpenDataFile(str(files["continuum"])), view)
    cells.SetRepresentationType("Surface")
    all_shown.append(cells)

largest = []
for each in all_shown:
    ColorBy(each, ("POINTS", "linVelVec", "Magnitude"))
    each.RescaleTransferFunctionToDataRangeOverTime()
    largest.append(GetColorTransferFunction("linVelVec").RGBPoints[-4])
GetColorTransferFunction("linVelVec").RescaleTransferFunction(0.0, max(largest))
shown.SetScalarBarVisibility(view, True)
view.ResetCamera()
Render()
'''


def disk_mesh(particles: Arrays, snapshot: Arrays, cracks: Arrays) -> meshio.Mesh:
    """One snapshot, and the cracks until then, as vertices with the point data of this module's table."""
    displacement, velocity = snapshot["displacement"], snapshot["velocity"]
    count = len(displacement)
    broken = np.bincount(cracks["particles"].ravel(), minlength=count).astype(np.int32)
    spin = np.zeros((count, 3), np.float32)
    spin[:, 2] = velocity[:, 2]
    data = {
        "radii": particles["radius"],
        "id": np.arange(count, dtype=np.int32),
        "linVelVec": in_space(velocity[:, :2], np.float32),
        "angVelVec": spin,
        "speed": np.hypot(velocity[:, 0], velocity[:, 1]),
        "displacement": in_space(displacement[:, :2], np.float32),
        "rotation": displacement[:, 2],
        "brick_particle": particles["brick_particle"],
        "column": particles["column"],
        "nbCracks": broken,
        "damage": broken / np.maximum(particles["bonds"], 1),  # without bonds none can break
    }
    if "layer" in particles:
        data["layer"] = particles["layer"]
    if "coordination" in snapshot:
        data["coordNumber"] = snapshot["coordination"]
    if "stress" in snapshot:
        data["stress"] = tensors(snapshot["stress"])
    if "peak_velocity" in particles:
        data["peakVelocity"] = particles["peak_velocity"]
    return vertices(places_of(particles, snapshot), shown(data))


def places_of(particles: Arrays, snapshot: Arrays) -> np.ndarray:
    """Places (n, 3) m at which disks are drawn: their positions at the start plus their displacements."""
    return in_space(particles["position"] + snapshot["displacement"][:, :2])


def tensors(stress: np.ndarray) -> np.ndarray:
    """Stresses (n, 3) xx, yy, xy as (n, 6), in VTK's order of symmetric tensors: xx, yy, zz, xy, yz, xz."""
    tensors = np.zeros((len(stress), 6))
    tensors[:, [0, 1, 3]] = stress
    return tensors
