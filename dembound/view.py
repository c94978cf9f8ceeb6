"""The disks of a run in a window to zoom into, or drawn without one into a picture."""

import os
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import h5py
import numpy as np

from dembound.errors import DemboundError
from dembound.results import open_record, snapshot_of

if TYPE_CHECKING:
    import pyvista

Field = Literal["velocity", "displacement"]

LABELS = {"velocity": "speed (m/s)", "displacement": "displacement (m)"}
"""What colours the disks: the length of the field in the plane."""

CORNERS = 24
"""Corners of a disk's polygon; a multiple of four, so that it is as wide and as high as the disk."""

# Without OpenGL, VTK does not raise but crashes, so another process tries first; it says what it would draw in.
TRIAL = """
import pyvista
plotter = pyvista.Plotter(off_screen=True, window_size=(9, 9))
plotter.screenshot()
print(plotter.render_window.GetClassName())
"""

WINDOWLESS = ("vtkEGLRenderWindow", "vtkOSOpenGLRenderWindow")
"""What VTK draws in where it finds no display."""


def view(run: Path, snapshot: int = -1, field: Field = "velocity", picture: Path | None = None) -> None:
    """Show a run's disks from above, at their undeformed places, coloured by the length of a field.

    The window has a slider over the snapshots; drag to move, the wheel zooms. It returns when closed.

    Parameters
    ----------
    run
        the ``run.h5`` of a run.
    snapshot
        the one to begin with; negative ones count from the last.
    field
        velocity in m/s or displacement in m.
    picture
        PNG file to draw into instead of opening a window.

    Raises CaseError when the file cannot be read or has no such snapshot, DemboundError without display or OpenGL.
    """
    with open_record(run) as file:
        first = snapshot_of(file, snapshot)
        require_rendering(in_window=picture is None)
        plotter = make_plotter(file, first, field, off_screen=picture is not None)
        if picture is None:
            plotter.show(title=f"dembound: {file.attrs['name']}")
        else:
            plotter.screenshot(picture)
            plotter.close()


def require_rendering(in_window: bool) -> None:
    """Raise DemboundError if VTK cannot draw here, or `in_window` and there is no display to show a window on."""
    tried = subprocess.run([sys.executable, "-c", TRIAL], capture_output=True, text=True, check=False)
    if tried.returncode != 0:
        raise DemboundError("view: cannot draw here, VTK finds no working OpenGL; `dembound plot` needs none")
    if in_window and tried.stdout.split()[-1] in WINDOWLESS:
        shown = os.environ.get("DISPLAY", "")
        raise DemboundError(f"view: no display to open a window on (DISPLAY={shown}), try --picture FILE.png")


def disk_mesh(positions: np.ndarray, radii: np.ndarray) -> "pyvista.PolyData":
    """One filled polygon per disk, in the disks' order; positions (n, 2) and radii (n,) in m."""
    import pyvista

    places = pyvista.PolyData(np.column_stack([positions, np.zeros(len(positions))]))
    places["diameter"] = 2.0 * radii
    circle = pyvista.Circle(radius=0.5, resolution=CORNERS)
    return places.glyph(geom=circle, scale="diameter", factor=1.0, orient=False)


def make_plotter(file: h5py.File, first: h5py.Group, field: Field, off_screen: bool) -> "pyvista.Plotter":
    """The scene of an open record, ready to show, at its snapshot `first`; one colour scale for the whole run."""
    import pyvista  # here, for it takes seconds and other commands can do without

    snapshots = list(file["snapshots"].values())
    label = LABELS[field]
    disks = disk_mesh(file["particles/position"][:], file["particles/radius"][:])
    disks.cell_data[label] = lengths(first, field)
    limit = max(float(lengths(each, field).max()) for each in snapshots) or 1.0
    plotter = pyvista.Plotter(off_screen=off_screen, window_size=(1600, 900))
    plotter.add_mesh(disks, scalars=label, clim=(0.0, limit), lighting=False, scalar_bar_args={"vertical": True})

    def show(number: float) -> None:
        shown = snapshots[round(number)]
        disks.cell_data[label] = lengths(shown, field)
        plotter.add_text(f"{file.attrs['name']}: t = {shown.attrs['time']:.3g} s", name="time", font_size=12)

    show(snapshots.index(first))
    if len(snapshots) > 1 and not off_screen:
        last = len(snapshots) - 1
        plotter.add_slider_widget(show, (0, last), snapshots.index(first), title="snapshot", fmt="%.0f")
    plotter.show_bounds(xtitle="x (m)", ytitle="y (m)", show_zaxis=False, use_2d=True)
    plotter.view_xy()
    plotter.enable_parallel_projection()
    return plotter


def lengths(snapshot: h5py.Group, field: Field) -> np.ndarray:
    """Length (n,) of a field of a snapshot in the plane, in m/s or m."""
    return np.hypot(*snapshot[field][:, :2].T)
