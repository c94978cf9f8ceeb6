"""Fragments in pictures, sieve curves and ParaView, and cracks by time."""

from pathlib import Path

import h5py
import meshio
import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from readable import drawn_quickly
from typer.testing import CliRunner

from dembound.cli import app
from dembound.errors import CaseError
from dembound.kinds import kind_of_record
from dembound.plot.crack_lines import TIME_MAP
from dembound.plot.moving import MovingScene
from dembound.plot.pieces import HUES, NO_PIECE, SINGLE, plot_sieve
from dembound.plot.scene import plot_scene
from dembound.report import page
from dembound.results.new_record import write_derived
from dembound.results.vtk import write_paraview


@pytest.fixture(scope="module")
def apart(cracked_run, tmp_path_factory) -> Path:
    """The record of `cracked_run` in whose last snapshot the first five disks are three fragments."""
    path = tmp_path_factory.mktemp("apart") / "run.h5"
    path.write_bytes(cracked_run.read_bytes())
    with h5py.File(path, "a") as file:
        count, times = len(file["particles/radius"]), [each.attrs["time"] for each in file["snapshots"].values()]
        pieces = np.zeros((2, count), np.int32)
        pieces[0, :2] = 1
        pieces[1, :5] = 1, 1, 3, 4, 4
        sizes = {"snapshot": ([0, 1, 1, 1], "1"), "piece": ([1, 1, 3, 4], "1"), "disks": ([2, 2, 1, 2], "1")}
        sizes |= {"mass": ([3.0, 3.0, 2.0, 1.0], "kg/m"), "diameter": ([0.4, 0.4, 0.1, 0.2], "m")}
        found = {f"sizes/{name}": (np.array(values), unit) for name, (values, unit) in sizes.items()}
        write_derived(file, {"time": (np.array(times), "s"), "piece": (pieces, "1")} | found)
    return path


def colours_of(panel) -> list[str]:
    """Colours of the first six disks."""
    (disks,) = (each for each in panel.collections if type(each).__name__ == "EllipseCollection")
    disks.update_scalarmappable()
    return [to_hex(each).upper() for each in disks.get_facecolors()[:6]]


def test_disks_have_the_colour_of_their_piece_which_it_keeps(apart):
    figure = plot_scene(apart, field="fragments")  # the last snapshot
    (panel,) = figure.axes  # without a bar
    assert colours_of(panel) == [HUES[0], HUES[0], SINGLE, HUES[1], HUES[1], NO_PIECE]
    first = plot_scene(apart, 0, field="fragments").axes[0]
    assert colours_of(first) == [HUES[0], HUES[0], *[NO_PIECE] * 4]
    texts = [each.get_text() for each in figure.legends[0].get_texts()]
    assert {"single disk", "fragments of two disks or more: a hue each, in turn"} <= set(texts)
    assert MovingScene(apart, "fragments").frame(1, 300).shape[1] == 300


def test_a_sieve_curve_has_the_shares_of_the_mass_in_pieces_not_larger(apart, cracked_run, tmp_path):
    line = plot_sieve([apart, cracked_run]).axes[0].lines[0]
    np.testing.assert_array_equal(line.get_xdata()[:3], [0.1, 0.2, 0.4])
    np.testing.assert_allclose(line.get_ydata(), [2.0 / 6.0, 3.0 / 6.0, 1.0, 1.0])
    table, picture = tmp_path / "sieve.csv", tmp_path / "sieve.png"
    asked = ["plot", str(apart), "--sieve", "--table", str(table), "--output", str(picture)]
    assert CliRunner().invoke(app, asked).exit_code == 0
    assert [row.split(",")[0] for row in table.read_text().splitlines()[1:4]] == ["0.1", "0.2", "0.4"]
    for draw in (lambda: plot_sieve([cracked_run]), lambda: plot_scene(cracked_run, field="fragments")):
        with pytest.raises(CaseError, match=r"(holds|has) no fragments"):
            draw()


def test_a_page_has_the_fragments_and_their_sieve_curve(apart, tmp_path, monkeypatch):
    drawn_quickly(monkeypatch)
    for part, empty in (("_frames", None), ("_charts", ()), ("plot_energy", Figure())):
        monkeypatch.setattr(page, part, lambda *_, empty=empty: empty)
    page.write_report([apart], tmp_path / "page.html")
    text = (tmp_path / "page.html").read_text()
    assert 'alt="cracked: fragments of ' in text
    assert 'alt="Sieve curves of the fragments; ' in text


def test_paraview_has_the_number_of_each_disks_piece(apart, tmp_path):
    write_paraview(apart, tmp_path, kind_of_record(apart))
    data = meshio.read(tmp_path / "particles_0001.vtu").point_data["piece"]
    assert data[:6].tolist() == [1, 1, 3, 4, 4, 0]


def test_cracks_have_the_colours_of_the_times_at_which_they_broke_on_request(cracked_run):
    figure = plot_scene(cracked_run, 1, cracks="time")
    with h5py.File(cracked_run) as file:
        time, shear = file["cracks/time"][:], file["cracks/shear"][:]
    shown = [each for each in figure.axes[0].collections if "bond" in each.get_label()]
    for each, kind in zip(shown, (False, True), strict=True):
        np.testing.assert_array_equal(each.get_array(), time[shear == kind])
        assert each.get_cmap() == TIME_MAP
    assert "time at which the bond broke (s)" in {each.get_ylabel() for each in figure.axes}
    said = CliRunner().invoke(app, ["plot", str(cracked_run), "--cracks", "time"])
    assert "--cracks: goes with --field" in str(said.exception)
