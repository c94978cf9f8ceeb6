"""Snapshots for ParaView: a vertex per disk, a line per contact, cells of the continuum, and a script."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from dembound.motion.state import Arrays
from dembound.results.vtk import in_space, passed_through, shown, vertices

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

if "walls" in files:
    walls = Show(OpenDataFile(str(files["walls"])), view)
    ColorBy(walls, None)
    walls.DiffuseColor = [0.0, 0.0, 0.0]
    walls.LineWidth = 2.0

if "joints" in files:
    joints = Show(OpenDataFile(str(files["joints"])), view)
    ColorBy(joints, ("CELLS", "slip"))
    joints.LineWidth = 3.0

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
    data |= passed_through(snapshot)
    if "peak_velocity" in particles:
        data["peakVelocity"] = particles["peak_velocity"]
    return vertices(places_of(particles, snapshot), shown(data))


def places_of(particles: Arrays, snapshot: Arrays) -> np.ndarray:
    """Places (n, 3) m at which disks are drawn: their positions at the start plus their displacements."""
    return in_space(particles["position"] + snapshot["displacement"][:, :2])


def contact_mesh(particles: Arrays, snapshot: Arrays) -> meshio.Mesh:
    """The contacts of one snapshot as lines with the cell data of this module's table."""
    pairs = snapshot["contacts/particles"]
    begin = places_of(particles, snapshot)[pairs[:, 0]]
    ends = np.stack([begin, begin + in_space(snapshot["contacts/vector"])], axis=1)
    data = {
        "normalForce": snapshot["contacts/normal_force"],
        "shearForce": snapshot["contacts/shear_force"],
        "bonded": snapshot["contacts/bonded"],
        "particles": pairs,
    }
    return _segments(ends, data)


def _segments(ends: np.ndarray, data: Arrays) -> meshio.Mesh:
    """Lines between ends (k, 2, 3) or (2k, 3) m, two each, with their cell data."""
    import meshio  # imported here, as commands that write no files need not wait for it

    points = ends.reshape(-1, 3)
    lines = np.arange(len(points), dtype=np.int32).reshape(-1, 2)
    cells = {name: [values] for name, values in shown(data).items()}
    return meshio.Mesh(points, [("line", lines)], cell_data=cells)


def wall_mesh(snapshot: Arrays) -> meshio.Mesh:
    """The walls of one snapshot as lines, with the number of the wall of each."""
    import meshio

    walls = [points for name, points in snapshot.items() if name.startswith("walls/")]
    counts = np.array([len(points) for points in walls])
    first = np.delete(np.arange(counts.sum()), np.cumsum(counts) - 1)
    number = np.repeat(np.arange(len(walls), dtype=np.int32), counts - 1)
    lines = np.stack([first, first + 1], axis=1).astype(np.int32)
    return meshio.Mesh(in_space(np.concatenate(walls)), [("line", lines)], cell_data={"wall": [number]})


def joint_mesh(snapshot: Arrays) -> meshio.Mesh:
    """The segments of joints of one snapshot as lines, moved with the disks on their left."""
    places = snapshot["joints/ends"].reshape(-1, 2, 2)
    moved = snapshot["displacement"][snapshot["joints/particles"][:, 0], None, :2]
    names = ("joint", "slip", "opening", "pressure", "shear", "state")
    return _segments(in_space((places + moved).reshape(-1, 2)), {name: snapshot[f"joints/{name}"] for name in names})


def continuum_mesh(columns: Arrays, snapshot: Arrays) -> meshio.Mesh:
    """One snapshot as quadrilaterals with the point data of this module's table."""
    import meshio

    displacement, velocity = (snapshot[f"continuum/{name}"][:, :2] for name in ("displacement", "velocity"))
    data = {
        "linVelVec": in_space(velocity),
        "speed": np.hypot(*velocity.T),
        "displacement": in_space(displacement),
        **passed_through(snapshot, "continuum/"),
        "absorbs": columns["continuum/absorbs"],
    }
    if "continuum/total" in columns:
        data["scattered"], data["scatteredVelocity"] = (
            in_space(snapshot[f"continuum/scattered_{name}"][:, :2]) for name in ("displacement", "velocity")
        )
        data["total"] = columns["continuum/total"]
    if "continuum/peak_velocity" in columns:
        data["peakVelocity"] = columns["continuum/peak_velocity"]
    across = Across.of(columns)
    points = np.concatenate([columns["continuum/position"], across.place])
    node = np.concatenate([np.arange(len(displacement)), across.node])
    cells = np.concatenate([columns["continuum/cell"], across.cell]).astype(np.int32)
    shift = in_space(points + displacement[node])
    return meshio.Mesh(shift, [("quad", cells)], point_data=shown({name: each[node] for name, each in data.items()}))


class Across(NamedTuple):
    """Nodes and cells of a periodic continuum across its period.

    node : (k,) nodes that are repeated. place : (k, 2) m, their places one period on. cell : (c, 4) corners of the
    cells between the last nodes and the repeated ones, which are numbered after all nodes.
    """

    node: np.ndarray
    place: np.ndarray
    cell: np.ndarray

    @classmethod
    def of(cls, columns: Arrays) -> Across:
        """Points of a record's continuum that meet across a period; empty for one that is not periodic."""
        position, node = columns["continuum/position"], columns["continuum/node"].astype(np.int64)
        low, high = (columns["continuum/element"][:, None, None, end] for end in (slice(0, 2), slice(2, 4)))
        is_last = np.zeros((1, *node.shape[1:], 2), dtype=np.bool_)
        is_last[:, :, -1, 0] = is_last[:, -1, :, 1] = True
        place = position[node]
        wraps = is_last & (place < 0.5 * (low + high))  # the last line of points is the first one of the mesh
        place = np.where(wraps, high, place)
        of_node = wraps.any(axis=3)
        kept = np.column_stack([node[of_node], wraps[of_node]])
        chosen, first, number = np.unique(kept, axis=0, return_index=True, return_inverse=True)
        corner = node.copy()
        corner[of_node] = len(position) + number.ravel()
        cells = np.stack([corner[:, :-1, :-1], corner[:, :-1, 1:], corner[:, 1:, 1:], corner[:, 1:, :-1]], axis=3)
        cells = cells.reshape(-1, 4)
        return cls(chosen[:, 0], place[of_node][first], cells[(cells >= len(position)).any(axis=1)])
