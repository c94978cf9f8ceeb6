"""A continuum is drawn where it is, in the colours of the disks."""

import h5py
import numpy as np
import pytest
from matplotlib.collections import EllipseCollection, TriMesh

from dembound.plot.continuum import read_continuum
from dembound.plot.scene import plot_scene

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
    np.testing.assert_allclose([*panel.get_xlim(), *panel.get_ylim()], [LEFT, RIGHT, BOTTOM, TOP])
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


def test_cells_of_a_periodic_continuum_end_beside_its_last_column(surrounded_run, copied) -> None:
    """There the last nodes are those of the first column."""
    with copied(surrounded_run) as file:
        group = file["continuum"]
        position, node = group["position"][:], group["node"][:]
        last = {tuple(place): node for node, place in enumerate(position.tolist()) if place[0] == LEFT}
        moved = np.array([last.get((LEFT, y), n) if x == RIGHT else n for n, (x, y) in enumerate(position)])
        before = read_continuum(file).corners
        group["node"][:] = moved[node]
        assert (moved[node] != node).any()
        np.testing.assert_allclose(read_continuum(file).corners, before, atol=1e-12)
