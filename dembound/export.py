"""Snapshots for ParaView: one VTU file each, a PVD file listing their times, and a script that shows them.

Every disk is a vertex at its reference position moved by its displacement (z = 0), with these point data; what a bar
has instead is told in `bar.export`:

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
| ``coordNumber`` | 1 | (n,) | its intact bonds and pushing contacts, under a law with a memory (YADE's name) |
| ``nbCracks`` | 1 | (n,) | its bonds that have broken so far (YADE's name) |
| ``damage`` | 1 | (n,) | that number over the bonds it had at the start, 0 where it had none |
| ``stress`` | Pa | (n, 6) | XX, YY, ZZ, XY, YZ, XZ, tension positive, those with Z being 0; if the case asks for it |
| ``peakVelocity`` | m/s | (n,) | largest speed in the whole run, in every file; if the case asks for it |

Where bonds broke in the run, ``cracks.vtu`` has one vertex per broken bond, between its two disks as they stood then:

| name | unit | shape | what |
|---|---|---|---|
| ``time`` | s | (k,) | when it broke, 0 in the static stage |
| ``mode`` | 1 | (k,) | how: 0 in tension, 1 in shear |
| ``particles`` | 1 | (k, 2) | ids of the two disks |

To see disks in ParaView, run ``paraview --script=view.py`` in the folder, or open ``particles.pvd``, press
Apply and run ``view.py`` from the Python shell (Run Script). By hand: representation *Point Gaussian*, shader
preset *Plain circle*, scale by array ``radii``, no scale function, Gaussian radius 1. As solid geometry: filter
*Glyph*, type *2D Glyph* (circle, filled), no orientation, scale array ``radii``, scale factor 2, all points.
*Warp By Vector* with ``displacement`` and factor k − 1 shows displacements k times as large.
"""

from pathlib import Path
from xml.etree import ElementTree

import h5py
import meshio
import numpy as np

from dembound.bar.export import VIEW_SCRIPT as BAR_VIEW_SCRIPT
from dembound.bar.export import bar_mesh
from dembound.results import cracks_until, is_bar, open_record, replacing

VIEW_SCRIPT = '''\
"""Shows the disks of particles.pvd in ParaView: paraview --script=view.py, or Run Script once it is open."""

from pathlib import Path

from paraview.simple import *

folder = Path(globals().get("__file__", "view.py")).resolve().parent  # Run Script has no __file__
disks = GetActiveSource() or PVDReader(FileName=str(folder / "particles.pvd"))
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

ColorBy(shown, ("POINTS", "linVelVec", "Magnitude"))
shown.RescaleTransferFunctionToDataRangeOverTime()
shown.SetScalarBarVisibility(view, True)
view.ResetCamera()
Render()
'''


def write_vtu(run: Path, folder: Path) -> Path | None:
    """Write every snapshot of a run for ParaView; returns the PVD file, None for a run without snapshots.

    Parameters
    ----------
    run
        the ``run.h5`` of a run.
    folder
        made when it is not there; gets ``particles_0000.vtu`` …, ``particles.pvd``, ``view.py`` and, where bonds
        broke, ``cracks.vtu``; of a bar ``bar_0000.vtu`` … and ``bar.pvd``.

    The PVD file is written last, so it never names a file that is not there.

    Raises CaseError when the record cannot be read.
    """
    with open_record(run) as file:
        snapshots = file.get("snapshots", {})
        if not snapshots:
            return None
        folder.mkdir(parents=True, exist_ok=True)
        bar = ("bar", bar_mesh, BAR_VIEW_SCRIPT)
        stem, mesh, script = bar if is_bar(file) else ("particles", _disks, VIEW_SCRIPT)
        times = {}
        for number, snapshot in snapshots.items():
            name = f"{stem}_{number}.vtu"
            times[name] = float(snapshot.attrs["time"])
            _write(folder / name, mesh(file["particles"], snapshot, cracks_until(file, times[name])))
        cracks = cracks_until(file, np.inf)
        if len(cracks["time"]) > 0:
            _write(folder / "cracks.vtu", _cracks(cracks))
    (folder / "view.py").write_text(script, encoding="utf-8")
    return _write_index(folder / f"{stem}.pvd", times)


def _disks(particles: h5py.Group, snapshot: h5py.Group, cracks: dict[str, np.ndarray]) -> meshio.Mesh:
    """One snapshot, and the cracks until then, as vertices with the point data of this module's first table."""
    displacement, velocity = snapshot["displacement"][:], snapshot["velocity"][:]
    count = len(displacement)
    moved = _in_space(displacement[:, :2])
    bonds = particles["bonds"][:]
    broken = np.bincount(cracks["particles"].ravel(), minlength=count)
    data = {
        "radii": particles["radius"][:],
        "id": np.arange(count),
        "linVelVec": _in_space(velocity[:, :2]),
        "angVelVec": np.column_stack([np.zeros((count, 2)), velocity[:, 2]]),
        "speed": np.hypot(velocity[:, 0], velocity[:, 1]),
        "displacement": moved,
        "rotation": displacement[:, 2],
        "brick_particle": particles["brick_particle"][:],
        "nbCracks": broken,
        "damage": broken / np.maximum(bonds, 1),  # without bonds none can break
    }
    if "coordination" in snapshot:
        data["coordNumber"] = snapshot["coordination"][:]
    if "stress" in snapshot:
        data["stress"] = _tensors(snapshot["stress"][:])
    if "peak_velocity" in particles:
        data["peakVelocity"] = particles["peak_velocity"][:]
    return _vertices(_in_space(particles["position"][:]) + moved, data)


def _cracks(cracks: dict[str, np.ndarray]) -> meshio.Mesh:
    """Cracks as vertices with the point data of this module's second table."""
    data = {"time": cracks["time"], "mode": cracks["shear"].astype(int), "particles": cracks["particles"]}
    return _vertices(_in_space(cracks["position"]), data)


def _vertices(points: np.ndarray, data: dict[str, np.ndarray]) -> meshio.Mesh:
    """One vertex per point (n, 3) m, with arrays (n, …) on them."""
    return meshio.Mesh(points, [("vertex", np.arange(len(points))[:, None])], point_data=data)


def _write(path: Path, mesh: meshio.Mesh) -> None:
    """A VTU file, whole or not at all."""
    with replacing(path) as part:
        meshio.write(part, mesh, file_format="vtu")


def _in_space(vectors: np.ndarray) -> np.ndarray:
    """Vectors (n, 2) as (n, 3) with z = 0."""
    return np.column_stack([vectors, np.zeros(len(vectors))])


def _tensors(stress: np.ndarray) -> np.ndarray:
    """Stresses (n, 3) xx, yy, xy as (n, 6), in the order VTK knows symmetric tensors by: xx, yy, zz, xy, yz, xz."""
    tensors = np.zeros((len(stress), 6))
    tensors[:, [0, 1, 3]] = stress
    return tensors


def _write_index(path: Path, times: dict[str, float]) -> Path:
    """The PVD file: file name -> time in s."""
    root = ElementTree.Element("VTKFile", type="Collection", version="0.1")
    collection = ElementTree.SubElement(root, "Collection")
    for name, time in times.items():
        ElementTree.SubElement(collection, "DataSet", timestep=repr(time), part="0", file=name)
    ElementTree.indent(root)
    with replacing(path) as part:
        ElementTree.ElementTree(root).write(part, encoding="utf-8", xml_declaration=True)
    return path
