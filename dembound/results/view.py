"""Shows the disks of a run in a window, or draws them into a file."""

import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import h5py
import numpy as np
from matplotlib.image import imsave

from dembound.casefile.messages import counted
from dembound.errors import CaseError, DemboundError
from dembound.files import replacing
from dembound.results.reader import (
    cracks_until,
    is_line,
    open_record,
    require_run,
    snapshot_of,
    snapshot_of_largest_motion,
    snapshots_of,
    text_of,
)

if TYPE_CHECKING:
    import pyvista

Field = Literal["velocity", "displacement"]
LABELS = {"velocity": "speed (m/s)", "displacement": "displacement (m)"}

CRACKS = "red"  # a colour that no disk has; black is hard to see on disks at rest

CRACK_SIZE = 10.0  # pixels

WINDOW = 1600, 900  # pixels

CONTINUUM = "continuum"  # group of a record, and of its snapshots

OUTLINE = "#8A8A8A"  # of the elements of a continuum

PALE = 0.6  # opacity of the layers that absorb

BELOW = 1e-3  # depth of a continuum below the disks over the size of the scene, so that they cover it

ROUND = 300  # pixels above and below the disks together in a picture: title, axis, and room for the colour bar

MARGIN = 0.7  # half the width of a view over that of the disks; 0.5 would leave none

CORNERS = 24  # of a disk's polygon; a multiple of four, so that it is as wide and as high as the disk

# Without OpenGL, VTK crashes instead of raising an error, so drawing is tried in another process first, which prints
# the class of its window. It does not import pyvista, which would take longer than the trial.
TRIAL = """
import vtkmodules.vtkRenderingOpenGL2
from vtkmodules.vtkRenderingCore import vtkRenderer, vtkRenderWindow
window = vtkRenderWindow()
window.SetOffScreenRendering(True)
window.SetSize(9, 9)
window.AddRenderer(vtkRenderer())
window.Render()
print(window.GetClassName())
"""

NO_DISPLAY = (
    "view: there is no display to open a window on; set DISPLAY to one (over ssh: ssh -X), draw a picture with "
    "--output picture.png, or open the files in paraview/ of the results in ParaView"
)

WINDOWLESS = ("vtkEGLRenderWindow", "vtkOSOpenGLRenderWindow")  # VTK's windows without a display


def view(
    run: Path,
    snapshot: int | None = None,
    field: Field = "velocity",
    picture: Path | None = None,
    exaggerate: float = 0.0,
) -> None:
    """Show a run's disks from above, coloured by the length of a field, its cracks, and the continuum around them.

    run is a ``run.h5``; snapshot the number to begin with, negative ones counting from the last, by default the one
    with the largest motion; field velocity in m/s or displacement in m; picture a PNG file to draw into instead of
    opening a window; exaggerate the factor of the displacements of disks, nodes and cracks: 0 shows their first places,
    1 their true ones. Layers that absorb are pale. The axes, and the outlines of elements, are those of the scene at
    the start. The window has a slider over several snapshots; dragging moves the scene, the wheel zooms. Returns once
    it is closed.

    Raises CaseError when the file cannot be read, is that of a bar or has no such snapshot, DemboundError without
    OpenGL or a display.
    """
    with open_record(run) as file:
        if is_line(file.attrs["size"]):
            raise CaseError([f"{run}: is a bar, view shows disks; `dembound plot RESULTS --field stress` draws bars"])
        first = snapshot_of_largest_motion(file, field) if snapshot is None else snapshot_of(file, snapshot)
        require_rendering(in_window=picture is None)
        plotter = make_plotter(file, first, field, exaggerate, off_screen=picture is not None)
        if picture is None:
            plotter.show(title=f"dembound: {text_of(file.attrs['name'])}")
        else:
            with replacing(picture) as file:
                imsave(file, plotter.screenshot(), format="png")


def require_rendering(in_window: bool) -> None:
    """Raise DemboundError if VTK cannot draw here, or `in_window` and there is no display to show a window on."""
    tried = subprocess.run([sys.executable, "-c", TRIAL], capture_output=True, text=True, check=False)
    if tried.returncode != 0:
        raise DemboundError(
            "view: cannot draw here, VTK finds no working OpenGL; `dembound plot RESULTS --field velocity` needs none"
        )
    if in_window and tried.stdout.split()[-1] in WINDOWLESS:
        raise DemboundError(NO_DISPLAY)


def disk_mesh(positions: np.ndarray, radii: np.ndarray) -> "pyvista.PolyData":
    """One filled polygon per disk, in the disks' order; positions (n, 2) and radii (n,) in m."""
    import pyvista

    places = pyvista.PolyData(np.column_stack([positions, np.zeros(len(positions))]))
    places["diameter"] = 2.0 * radii
    circle = pyvista.Circle(radius=0.5, resolution=CORNERS)
    return places.glyph(geom=circle, scale="diameter", factor=1.0, orient=False)


def continuum_mesh(positions: np.ndarray, cells: np.ndarray) -> "pyvista.PolyData":
    """One polygon per cell between the nodes of a continuum, below the disks; positions (m, 2) m, cells (c, 4)."""
    import pyvista

    depth = np.full(len(positions), -BELOW * float(np.ptp(positions)))
    faces = np.column_stack([np.full(len(cells), 4), cells])
    return pyvista.PolyData(np.column_stack([positions, depth]), faces=faces.ravel())


class Coloured:
    """A mesh whose points move with disks or nodes, and whose colours are the length of a field.

    Parameters
    ----------
    mesh : with `corners` points in turn for each disk, which is a cell, or 1 for nodes. group : of snapshots.
    opacity : of all, or of each node, 0 … 1.
    """

    def __init__(self, mesh: "pyvista.PolyData", corners: int, group: str, opacity: float | np.ndarray = 1.0) -> None:
        self.mesh, self.group, self.opacity = mesh, group, opacity
        self._corners, self._still = corners, mesh.points.copy()

    def show(self, snapshot: h5py.Group, field: Field, exaggerate: float) -> None:
        """Show the places and the field of a snapshot."""
        fields = snapshot[self.group]
        data = self.mesh.point_data if self._corners == 1 else self.mesh.cell_data
        data[LABELS[field]] = lengths(fields, field)
        moved = exaggerate * fields["displacement"][:, :2]
        self.mesh.points[:, :2] = self._still[:, :2] + np.repeat(moved, self._corners, axis=0)


def meshes_of(file: h5py.File) -> "list[Coloured]":
    """The disks of an open record, and the continuum around them if there is one; errors as of `require_run`."""
    require_run(file)
    disks = disk_mesh(file["particles/position"][:], file["particles/radius"][:])
    meshes = [Coloured(disks, CORNERS, ".")]
    if CONTINUUM in file:
        positions, cells, absorbs = (file[f"{CONTINUUM}/{name}"][:] for name in ("position", "cell", "absorbs"))
        meshes.append(Coloured(continuum_mesh(positions, cells), 1, CONTINUUM, np.where(absorbs, PALE, 1.0)))
    return meshes


def extent_of(file: h5py.File) -> np.ndarray:
    """Lowest and highest corner (2, 2) m of the scene of an open record, with its continuum."""
    low = file.attrs.get("corner", np.zeros(2))  # earlier versions began at zero
    corners = [low, low + file.attrs["size"]]
    if CONTINUUM in file:
        corners += [*file[f"{CONTINUUM}/element"][:].reshape(-1, 2)]
    return np.array([np.min(corners, axis=0), np.max(corners, axis=0)])


def make_plotter(
    file: h5py.File, first: h5py.Group, field: Field, exaggerate: float, off_screen: bool
) -> "pyvista.Plotter":
    """The scene of an open record, ready to show, at its snapshot `first`; one colour scale for the whole run."""
    import pyvista  # imported here, as it takes seconds and other commands do not need it
    from vtkmodules.vtkCommonCore import vtkLogger

    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_ERROR)  # no warnings about drawing without a display
    snapshots, extent, meshes = snapshots_of(file), extent_of(file), meshes_of(file)
    limit = max(lengths(snapshot[each.group], field).max() for snapshot in snapshots for each in meshes)
    size = picture_size(np.diff(extent, axis=0)[0]) if off_screen else WINDOW
    plotter = pyvista.Plotter(off_screen=off_screen, window_size=size)
    bar = {"vertical": True, "position_x": 0.91, "position_y": 0.1, "height": 0.7}
    for each in reversed(meshes):
        each.show(first, field, exaggerate)
        looks = {"scalars": LABELS[field], "clim": (0.0, limit or 1.0), "lighting": False, "opacity": each.opacity}
        plotter.add_mesh(each.mesh, show_scalar_bar=each is meshes[0], scalar_bar_args=bar, **looks)
    plotter.scalar_bar.SetVerticalTitleSeparation(20)  # pixels, for the uppermost number
    if CONTINUUM in file:
        show_elements(plotter, file[f"{CONTINUUM}/element"][:])
    plotter.enable_anti_aliasing("ssaa")

    def show(number: float) -> None:
        shown = snapshots[round(number)]
        for each in meshes:
            each.show(shown, field, exaggerate)
        cracks = cracks_until(file, shown.attrs["time"])
        moved = exaggerate * shown["displacement"][:, :2]
        show_cracks(plotter, cracks["position"] + moved[cracks["particles"]].mean(axis=1))
        scale = f", displacements × {exaggerate:g}" if exaggerate else ""
        broken = len(cracks["position"])
        marked = f", {counted(broken, 'broken bond')} ({CRACKS})" if broken else ""
        title = f"{text_of(file.attrs['name'])}: t = {shown.attrs['time']:.3g} s{scale}{marked}"
        plotter.add_text(title, name="time", font_size=12)

    show(snapshots.index(first))
    if len(snapshots) > 1 and not off_screen:
        span, place = (0, len(snapshots) - 1), {"pointa": (0.03, 0.1), "pointb": (0.28, 0.1)}  # lower left
        slider = plotter.add_slider_widget(show, span, value=snapshots.index(first), title="snapshot", **place)
        slider.GetRepresentation().ShowSliderLabelOff()  # its label has decimals, and the time is shown instead
    look_from_above(plotter, extent)
    return plotter


def show_elements(plotter: "pyvista.Plotter", elements: np.ndarray) -> None:
    """Outline the elements (e, 4) of a continuum, left, bottom, right and top in m."""
    import pyvista

    corners = elements[:, [0, 1, 2, 1, 2, 3, 0, 3]].reshape(-1, 2)
    begin = 4 * np.arange(len(elements))[:, None]
    lines = np.column_stack([np.full(len(elements), 5), begin + np.array([0, 1, 2, 3, 0])])
    outlines = pyvista.PolyData(np.column_stack([corners, np.zeros(len(corners))]), lines=lines.ravel())
    plotter.add_mesh(outlines, color=OUTLINE, line_width=1, reset_camera=False)


def show_cracks(plotter: "pyvista.Plotter", positions: np.ndarray) -> None:
    """Mark broken bonds at positions (k, 2) m by points, in place of those marked before."""
    plotter.remove_actor("cracks", render=False)
    if len(positions) > 0:
        raised = np.column_stack([positions, np.ones(len(positions))])  # the height is not visible from above
        plotter.add_points(raised, color=CRACKS, point_size=CRACK_SIZE, name="cracks", reset_camera=False)
        plotter.renderer.ResetCameraClippingRange()


def picture_size(size: np.ndarray) -> tuple[int, int]:
    """Width and height of a picture in pixels for a scene of a size (2,) m: low for a long horizontal scene."""
    across, up = WINDOW
    return across, min(up, round(across / (2.0 * MARGIN) * size[1] / size[0]) + ROUND)


def look_from_above(plotter: "pyvista.Plotter", extent: np.ndarray) -> None:
    """Put labelled axes around a scene, its lowest and highest corner (2, 2) m, and a camera above all.

    The camera only moves and zooms.
    """
    size = extent[1] - extent[0]
    share = size / size.max()
    x_labels, y_labels = map(label_count, size, share)
    x_shown, y_shown = share > 0.03  # labels across a narrower scene collide
    x_axis = {"xtitle": "x (m)", "n_xlabels": x_labels, "show_xlabels": x_shown}
    y_axis = {"ytitle": "y (m)", "n_ylabels": y_labels, "show_ylabels": y_shown}
    plotter.show_bounds(
        bounds=(*extent.T.ravel(), 0.0, 0.0), use_2d=True, show_zaxis=False, fmt="%.4g", **x_axis, **y_axis
    )
    plotter.view_xy()
    plotter.enable_parallel_projection()
    plotter.enable_custom_trackball_style(left="pan")
    across, up = plotter.window_size
    left, right, bottom, top, *_ = plotter.bounds
    plotter.camera.parallel_scale = MARGIN * max(top - bottom, (right - left) * up / across)


def label_count(length: float, share: float) -> int:
    """Number of evenly spaced labels on an axis from 0 to its length (m), given its share of the longest axis.

    It fits the room, or is two more or less for round labels, and even, as the axis title is in the middle.
    """
    room = 2 * int(np.ceil(3.0 * share))
    steps = {count: length / (count - 1) for count in (room, room + 2, room - 2) if count > 0}
    return next((count for count, step in steps.items() if np.isclose(float(f"{step:.2g}"), step, atol=0.0)), room)


def lengths(snapshot: h5py.Group, field: Field) -> np.ndarray:
    """Length (n,) of a field of a snapshot in the plane, in m/s or m."""
    return np.hypot(*snapshot[field][:, :2].T)
