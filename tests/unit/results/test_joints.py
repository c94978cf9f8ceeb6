"""Joints in the files of a run: histories, segments, files for ParaView and pictures."""

import meshio
import numpy as np
import pytest
from small_cases import PUSHED, small

import dembound
from dembound.plot.moving import MovingScene
from dembound.plot.scene import plot_scene
from dembound.running import run_case

FAULTS = PUSHED | {
    "joint": [
        {"name": "main", "points": [[-1.0, 1.25], [8.0, 1.25]], "kn": 1e9, "ks": 1e9, "fric": 0.3},
        {"name": "across", "points": [[4.0, -1.0], [4.5, 3.0]], "kn": 1e9, "ks": 1e9},
    ],
    "boundary": {"bottom": PUSHED["boundary"]["left"] | {"wave_p": "shake", "wave_s": "push"}},
    "output": {"snapshots": 2, "pictures": False},
}
"""A lattice, shaken from below, with a joint that slides and opens, and another that is cut by it and stays closed."""


@pytest.fixture(scope="module")
def found(tmp_path_factory) -> dembound.Results:
    return dembound.Results(run_case(small(FAULTS, "faults"), tmp_path_factory.mktemp("joints")))


def test_histories_are_means_over_the_segments(found) -> None:
    assert set(found.joints) == {"main", "across_1", "across_2"}
    main = found.joints["main"]
    np.testing.assert_allclose(main["points"], [[-1.0, 1.25], [8.0, 1.25]])
    last = found.snapshots[-1]
    assert len(main["time"]) == len(found.histories["front"]["time"])
    lengths = np.hypot(*np.diff(last["joints/ends"].reshape(-1, 2, 2), axis=1)[:, 0].T)
    own = last["joints/joint"] == 0
    weights = lengths[own] / lengths[own].sum()
    for name in ("slip", "opening", "pressure", "shear"):
        np.testing.assert_allclose(main[name][-1], np.sum(weights * last[f"joints/{name}"][own]), rtol=1e-3, atol=1e-7)
    states = last["joints/state"]
    np.testing.assert_allclose(main["sliding"][-1], np.sum(weights * (states[own] == 2)), atol=1e-3)
    np.testing.assert_allclose(main["closed"][-1], np.sum(weights * (states[own] != 3)), atol=1e-3)
    assert (states[~own] == 0).all()
    assert np.abs(found.joints["across_1"]["slip"]).max() < 1e-6
    across = found.joints["across_2"]
    # springs: a joint that neither opens nor slides gives by its pressure
    closed = found.joints["across_2"]["pressure"] != 0.0
    assert (
        np.ptp(across["opening"][closed] / across["pressure"][closed])
        < 1e-3 * np.abs(across["opening"][closed] / across["pressure"][closed]).max()
    )


def test_first_slip_and_opening_are_told(found) -> None:
    main, across = found.summary["joints"]["main"], found.summary["joints"]["across_1"]
    assert across["slides_from"] is across["opens_from"] is None
    history = found.joints["main"]
    slid = history["time"][(np.abs(history["slip"]) > 5e-6) & (history["sliding"] > 0.0)][0]
    assert main["slides_from"] == pytest.approx(slid)
    assert main["slip"] == pytest.approx(history["slip"][-1], rel=0.1)  # some steps later


def test_paraview_and_pictures_have_them(found) -> None:
    last, shown = found.snapshots[-1], meshio.read(found.folder / "paraview" / "joints_0001.vtu")
    assert shown.cell_data.keys() == {"joint", "slip", "opening", "pressure", "shear", "state"}
    np.testing.assert_allclose(shown.cell_data["slip"][0], last["joints/slip"], atol=1e-9)
    assert len(shown.cells[0].data) == len(last["joints/slip"])
    labels = [text.get_text() for text in plot_scene(found.folder / "run.h5", -1).legends[0].get_texts()]
    assert any(label.startswith("joint that has slid") for label in labels)
    MovingScene(found.folder / "run.h5", exaggerate=1.0).frame(1, 300)
