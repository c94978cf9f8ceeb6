"""Sides of records: stress and displacement of the whole, diameters and peaks of their disks."""

import h5py
import numpy as np
import pytest
import tomli_w

from dembound.errors import CaseError
from dembound.kinds import loads
from dembound.plot.side import plot_boundary, plot_side
from dembound.results.histories import read_side_history
from dembound.results.reader import text_of
from dembound.results.results import Results
from dembound.running import run_case

CASE = {
    "packing": {"pattern": "A", "size": [4.0, 2.0], "radius": 0.25},
    "material": {"density": 2500.0, "p_wave_speed": 1000.0},
    "boundary": {"bottom": {"type": "fixed"}, "top": {"type": "velocity", "wave_p": "push", "wave_s": "push"}},
    "wave": {"push": {"type": "constant", "amplitude": 0.01, "rise": 0.01}},
    "run": {"duration": 0.03},
    "output": {"pictures": False, "snapshots": 0, "history_interval": 1e-3},
}


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    return run_case(loads(tomli_w.dumps(CASE), name="pulled"), tmp_path_factory.mktemp("side")) / "run.h5"


def test_stress_is_the_force_over_the_length_tension_positive(run) -> None:
    top, bottom = (read_side_history(run, side) for side in ("top", "bottom"))
    with h5py.File(run) as file:
        force = {side: file[f"boundaries/{side}/force"][:] for side in ("top", "bottom")}
        assert text_of(file["boundaries/top/force"].attrs["unit"]) == "N/m"
        assert len(file["boundaries/top/time"]) == len(force["top"])

    np.testing.assert_array_equal(top.stress, force["top"][:, ::-1] / 4.0)  # yy, then xy
    np.testing.assert_array_equal(bottom.stress, -force["bottom"][:, ::-1] / 4.0)
    assert (top.stress[-1] > 0.0).all()  # pulled up and along x
    # of rows whose centres are 1.5 m apart; extension positive, the same seen from both
    np.testing.assert_allclose(top.strain, top.displacement[:, 1] / 1.5, rtol=1e-12)
    np.testing.assert_allclose(bottom.strain, top.strain, rtol=1e-12)
    np.testing.assert_array_equal(bottom.displacement, 0.0)


def test_both_quantities_are_drawn_with_their_units(run, small_run) -> None:
    by_time, by_strain = plot_side([run], "top", "stress").axes
    history = read_side_history(run, "top")
    np.testing.assert_allclose(by_time.lines[0].get_ydata(), history.stress[:, 0] / 1e6)
    np.testing.assert_allclose(by_time.lines[1].get_ydata(), history.stress[:, 1] / 1e6)
    np.testing.assert_allclose(by_strain.lines[0].get_xdata(), 100.0 * history.strain)
    assert by_time.get_ylabel() == by_strain.get_ylabel() == "mean stress (MPa)"
    (panel,) = plot_side([run], "bottom", "displacement").axes
    assert panel.get_ylabel() == "mean displacement (m)"
    with pytest.raises(CaseError, match="must be one of stress, displacement, is velocity"):
        plot_side([run], "top", "velocity")
    with pytest.raises(CaseError, match="has no history of side left, sides there: none"):
        read_side_history(small_run, "left")


def test_results_have_the_sides(run) -> None:
    results = Results(run)
    assert results.boundaries["top"]["force"].shape == (len(results.boundaries["top"]["time"]), 2)
    energies = results.side_energies["top"]
    assert set(energies) == {"came_in", "absorbed", "stored"}
    assert energies["came_in"][-1] == pytest.approx(results.energy["outside"][-1], rel=1e-9)
    found = results.summary["sides"]["top"]
    assert (found["came_in"], found["absorbed_share"]) == (energies["came_in"][-1], 0.0)


@pytest.mark.parametrize(("side", "axis"), [("left", 1), ("top", 0)])
def test_diameters_and_peaks_stand_along_the_side(small_run, side, axis):
    upper, lower = plot_boundary([small_run], side).axes
    (diameters,), (peaks,) = upper.lines, lower.lines
    with h5py.File(small_run) as file:
        group = file[f"boundaries/{side}"]
        np.testing.assert_array_equal(diameters.get_xdata(), group["position"][:, axis])
        np.testing.assert_array_equal(diameters.get_ydata(), group["diameter"][:])
        largest = np.maximum(-group["peak_velocity"][:, 0, 0], group["peak_velocity"][:, 0, 1])
        np.testing.assert_array_equal(peaks.get_xdata(), group["position"][:, axis])
        np.testing.assert_array_equal(peaks.get_ydata(), largest)


def test_what_is_no_side_is_refused(small_run, spalled_run):
    with pytest.raises(CaseError, match="no particles of side outer, sides there: bottom, left, right, top"):
        plot_boundary([small_run], "outer")
    with pytest.raises(CaseError, match="is a bar, each end of which is one node"):
        plot_boundary([spalled_run], "left")
