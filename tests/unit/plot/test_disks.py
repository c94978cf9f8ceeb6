"""Outlines of holes are those of the case, means those of cells, and a continuum is drawn in their colours."""

import h5py
import numpy as np
import pytest
from matplotlib.collections import EllipseCollection, TriMesh
from matplotlib.patches import PathPatch
from small_cases import SURROUNDED, small

from dembound.kinds.disks.kind import Disks
from dembound.motion.simulation import Simulation
from dembound.plot import style
from dembound.plot.field import SHOWN_LAYER
from dembound.plot.moving import MovingScene
from dembound.plot.outlines import ABOVE_FIELD, ABOVE_FILLING, read_holes
from dembound.plot.scene import plot_scene
from dembound.results.recorder import Recorder

RADIUS = 0.5

HOLES = {
    "oval": {"type": "ellipse", "centre": [12.0, 8.0], "semi_axes": [6.0, 2.5], "angle": 25.0},
    "floor": {"type": "polygon", "points": [[12.0, 10.0], [30.0, 10.0], [30.0, 19.0], [9.0, 19.0]]},
}

ALONE = {"boundary": {side: {"type": "viscous"} for side in ("left", "right", "bottom")}}


def hollow_run(path, name, in_a_box):
    """Write the record of 24 × 16 disks with a hole, in a continuum or alone, with random motion in a snapshot."""
    size = {"pattern": "A", "size": [24.0, 16.0], "radius": RADIUS}
    changes = {"packing": size, "hole": [{"name": name, **HOLES[name]}], **({} if in_a_box else ALONE)}
    if name == "floor" and not in_a_box:
        changes["boundary"] = ALONE["boundary"] | {"right": {"type": "free"}}
    scene = Disks().build(small(SURROUNDED, "hollow", changes))
    simulation, rng = Simulation(scene, 1e-4), np.random.default_rng(3)
    with Recorder(path, simulation, 2e-4) as recorder:
        simulation.state.velocity = rng.normal(size=(3, scene.count)) * scene.moves
        recorder.snapshot()


def away(points, line):
    """Largest distance (m) of points from a line of many short pieces."""
    begin, piece = line[:-1], np.diff(line, axis=0)
    part = ((points[:, None] - begin) * piece).sum(axis=2) / np.maximum((piece**2).sum(axis=1), 1e-30)
    nearest = begin + np.clip(part, 0.0, 1.0)[..., None] * piece
    return np.hypot(*np.moveaxis(points[:, None] - nearest, 2, 0)).min(axis=1).max()


@pytest.mark.parametrize(("name", "in_a_box", "dots"), [("oval", True, 150), ("floor", False, 12)])
def test_outlines_are_those_of_the_case(name, in_a_box, dots, run, monkeypatch):
    """In a picture and in a movie of so many dots per inch."""
    monkeypatch.setattr(style, "DOTS_PER_INCH", dots)
    hollow_run(run, name, in_a_box)
    with h5py.File(run) as file:
        (hole,) = read_holes(file)
        positions = file["particles/position"][:]
    low, high = positions.min(axis=0) - RADIUS, positions.max(axis=0) + RADIUS
    true = hole.outline.at(np.linspace(0.0, hole.outline.period, 1501))
    inside = true[((true > low + 1e-6) & (true < high - 1e-6)).all(axis=1)]
    moving = MovingScene(run)
    moving.frame(0, 8 * dots)
    for panel in (plot_scene(run).axes[0], moving.figure.axes[0]):
        patches = [each for each in panel.patches if isinstance(each, PathPatch)]
        lines = [each.get_path().vertices for each in patches if each.get_zorder() == ABOVE_FILLING]
        filled = [each for each in patches if each.get_zorder() == ABOVE_FIELD]
        assert lines
        for line in lines:
            assert away(line, true) < 1e-2 * RADIUS  # the true one cuts corners by a part of its step, some 1 cm
            middle = 0.5 * (line[1:] + line[:-1])
            assert away(middle, true) < 0.1 * 2.0 * RADIUS
        found = [np.min([away(point[None], line) for line in lines]) for point in inside[::12]]
        assert max(found) < 0.1 * 2.0 * RADIUS
        # what is drawn as an image of means is cut off at the outline, disks are whole
        assert bool(filled) is not any(isinstance(each, EllipseCollection) for each in panel.collections)
        assert len(positions) < 24 * 16


LEFT, RIGHT, BOTTOM, TOP = -9.0, 21.0, -9.0, 6.0
"""Sides of the scene, with a margin of one and layers of two elements of 3 m beyond 12 m × 6 m."""


def only(kind: type, panel):
    """The collection of this kind in a panel."""
    (found,) = [each for each in panel.collections if type(each) is kind]
    return found


def labelled(panel) -> dict:
    return {each.get_label(): each for each in [*panel.collections, *panel.patches]}


@pytest.mark.parametrize(
    ("field", "name", "column"),
    [("velocity", "velocity", 0), ("stress_yy", "stress", 1), ("peak", "peak_velocity", None)],
)
def test_nodes_have_the_colours_of_disks_with_the_same_value(surrounded_run, field, name, column) -> None:
    """In one scale up to the largest of both outside the layers that absorb, in which motion is that of no ground."""
    more = {} if field in ("peak", "stress_yy") else {"component": "x"}
    panel = plot_scene(surrounded_run, field=field, snapshot=None if field == "peak" else 1, **more).axes[0]
    disks, nodes = only(EllipseCollection, panel), only(TriMesh, panel)
    with h5py.File(surrounded_run) as file:
        cell, position, absorbs = (file[f"continuum/{name}"][:] for name in ("cell", "position", "absorbs"))
        group = file if field == "peak" else file["snapshots/0001"]
        own = group["particles" if field == "peak" else "."][name][:]
        values = group[f"continuum/{name}"][:]
        if column is not None:
            own, values = own[:, column], values[:, column]
            everywhere = [each[name][:, column] for each in file["snapshots"].values()]
            everywhere += [each[f"continuum/{name}"][~absorbs, column] for each in file["snapshots"].values()]
        else:
            everywhere = [own, values[~absorbs]]
    unit = 1e6 if field == "stress_yy" else 1.0
    np.testing.assert_array_equal(disks.get_array(), own / unit)
    np.testing.assert_array_equal(nodes.get_array(), (values / unit)[cell.ravel()])
    triangles = nodes._triangulation
    np.testing.assert_array_equal(np.column_stack([triangles.x, triangles.y]), position[cell.ravel()])
    limit = max(np.abs(each).max() for each in everywhere) / unit
    assert disks.get_clim() == nodes.get_clim() == (0.0 if field == "peak" else -limit, limit)
    assert disks.get_cmap() == nodes.get_cmap()


def test_elements_layers_surface_and_ties_are_in_the_legend(surrounded_run) -> None:
    panel = plot_scene(surrounded_run).axes[0]
    seen = SHOWN_LAYER * 18.0  # of the layers, beyond 18 m of disks and elements
    ends = [-3.0 - seen, 15.0 + seen, -3.0 - seen, TOP]
    np.testing.assert_allclose([*panel.get_xlim(), *panel.get_ylim()], ends)
    triangles = only(TriMesh, panel)._triangulation  # which cover the cells once
    x, y = (of[triangles.triangles] for of in (triangles.x, triangles.y))
    twice = (x[:, 1] - x[:, 0]) * (y[:, 2] - y[:, 0]) - (x[:, 2] - x[:, 0]) * (y[:, 1] - y[:, 0])
    assert twice.min() > 0.0
    assert 0.5 * twice.sum() == pytest.approx(30.0 * 15.0 - 12.0 * 6.0)
    shown = labelled(panel)
    layers, surface = shown["layers that absorb, in place of the ground beyond"], shown["free surface of the continuum"]
    ties = shown["ties of cut bonds (24)"]
    inside = layers.get_path().contains_points
    assert inside([[-4.0, 4.0], [-8.0, -8.0], [16.0, 4.0], [6.0, -4.0]]).all()
    assert not inside([[-2.0, 4.0], [6.0, 3.0], [6.0, -2.0], [14.0, 4.0]]).any()
    assert sorted(line[0, 0] for line in surface.get_segments()) == [-9.0, -6.0, -3.0, 12.0, 15.0, 18.0]
    assert {y for line in surface.get_segments() for y in line[:, 1]} == {TOP}
    x, y = np.array(ties.get_offsets()).T
    assert ((x == 0.0) | (x == 12.0) | (y == 0.0)).all()
