"""The picture of a chart, from its record."""

import h5py
import numpy as np
import pytest

from dembound.plot.chart import plot_chart


@pytest.fixture
def chart(tmp_path):
    """Writes records of charts: choices of (name, error, cost), numbers of those on the front, of the reference."""

    def write(choices, front=(), own=(), failed=(), apart=0.0):
        path = tmp_path / "chart.h5"
        with h5py.File(path, "w") as file:
            file.attrs.update({"name": "rod", "title": "A rod", "quantity": "velocity", "sentence": "cheapest: none"})
            said = {"sentence": "exact", "of": "of the rock", "covered": "measured: all causes"}
            file.create_group("reference").attrs.update({**said, "choices": np.array(own, dtype=int)})
            for number, (name, error, cost) in enumerate(choices):
                file.create_group(f"runs/{number}").attrs["threads"] = 1
                group = file.create_group(f"choices/{number:04d}")
                failure = "too long a step" if number in failed else ""
                group.attrs.update({"name": name, "on_front": number in front, "failure": failure, "found": ""})
                group.attrs.update({"error": max(error, 1e-6), "cost": cost})
                group["monitor"], group["component"], group["total"] = ["gauge"], ["x"], np.array([error])
                group["apart"] = np.array([apart * number])
        return path

    return write


def texts(panel) -> list[str]:
    """All texts of a panel, in the order in which they were written."""
    return [text.get_text() for text in panel.texts]


def test_points_are_errors_in_per_cent_at_their_cost(chart) -> None:
    panel, side = plot_chart(chart([("fine", 0.01, 4.0), ("coarse", 0.2, 0.5)], front=[0, 1])).axes
    points = {line.get_gid(): (line.get_xdata()[0], line.get_ydata()[0]) for line in panel.lines if line.get_gid()}
    assert points == {"fine": (4.0, pytest.approx(1.0)), "coarse": (0.5, pytest.approx(20.0))}
    (front,) = (line for line in panel.lines if line.get_label() == "Pareto front")
    np.testing.assert_allclose(front.get_xydata(), [(4.0, 1.0), (0.5, 20.0)])
    assert texts(side) == ["Pareto front, the cheapest first", "coarse: 20 %, 0.5 s", "fine: 1 %, 4 s"]
