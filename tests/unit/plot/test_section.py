"""Record sections and hodographs."""

import h5py
import numpy as np
import pytest

from dembound.errors import CaseError
from dembound.plot.histories import plot_hodograph, plot_section
from dembound.plot.table import columns_of
from dembound.results.reader import record_names


def test_a_section_has_each_history_at_its_distance(small_run):
    (panel,) = plot_section([small_run], monitors=["back", "front"]).axes
    with h5py.File(small_run) as file:
        groups = [file["histories/back"], file["histories/front"]]
        distance = np.hypot(*(groups[1].attrs["position"] - groups[0].attrs["position"]))
        largest = max(np.abs(group["velocity"][:, 0]).max() for group in groups)
        for line, group, begin in zip(panel.lines, groups, (0.0, distance), strict=True):
            # the largest value is as high as 0.9 of the mean distance between neighbours
            expected = begin + 0.9 * distance / largest * group["velocity"][:, 0]
            np.testing.assert_allclose(line.get_ydata(), expected)
            np.testing.assert_allclose(line.get_xdata(), group["time"][:] / 1e-3)
    names = [(text.get_text(), text.xy) for text in panel.texts]
    assert names == [("back", (1.0, 0.0)), ("front", (1.0, distance))]
    assert panel.figure.get_suptitle() == "Section of the velocity at the monitors"
    assert panel.get_ylabel() == "distance from back (m), velocity along x upwards"
    assert panel.get_title("left") == f"{distance:.3g} m upwards is {largest / 0.9:.3g} m/s"


def test_a_hodograph_has_the_motion_along_y_against_that_along_x(small_run, other_run):
    runs = [small_run, other_run]
    panels = plot_hodograph(runs, "displacement", ["front"]).axes
    panel, rest = panels[0], panels[1:]
    assert not any(each.get_visible() for each in rest)
    with h5py.File(small_run) as file:
        moved = file["histories/front/displacement"][:]
    np.testing.assert_array_equal(panel.lines[0].get_xdata(), moved[:, 0])
    np.testing.assert_array_equal(panel.lines[0].get_ydata(), moved[:, 1])
    np.testing.assert_array_equal(panel.lines[1].get_xydata(), moved[-1:, :2])
    assert (panel.get_xlabel(), panel.get_ylabel()) == ("displacement along x (m)", "displacement along y (m)")
    assert panel.get_aspect() == 1.0
    assert panel.figure.get_suptitle() == "Paths of the displacement at the monitors, dots at their ends"
    heads = [head for head, _ in columns_of(plot_hodograph(runs, "displacement"))]
    paths = [f"{name}, {run}" for name in ("front", "back") for run in record_names(runs)]
    assert heads[::2] == [f"displacement along x (m) of {path}" for path in paths]
    assert heads[1::2] == [f"{path}: displacement along y (m)" for path in paths]


def test_what_cannot_be_shown_is_said(small_run, spalled_run):
    with pytest.raises(CaseError, match="needs two monitors that all runs have, here are 1"):
        plot_section([small_run], monitors=["back"])
    with pytest.raises(CaseError, match="a section shows one"):
        plot_section([small_run], component="both")
    with pytest.raises(CaseError, match="a hodograph is of a motion"):
        plot_hodograph([spalled_run], "stress")
