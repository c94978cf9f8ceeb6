"""The picture of a chart, from its record."""

import h5py
import numpy as np
import pytest

from dembound.errors import CaseError
from dembound.plot.chart import LEAST, plot_chart
from dembound.plot.style import save


@pytest.fixture
def chart(tmp_path):
    """Writes records of charts: choices of (name, error, costs), numbers of those on the front, of the reference."""

    def write(choices, front=(), own=(), failed=(), apart=0.0):
        path = tmp_path / "chart.h5"
        with h5py.File(path, "w") as file:
            file.attrs.update({"name": "rod", "title": "A rod", "quantity": "velocity", "sentence": "cheapest: none"})
            file.create_group("reference").attrs.update({"sentence": "exact", "choices": np.array(own, dtype=int)})
            for number, (name, error, costs) in enumerate(choices):
                run = file.create_group(f"runs/{number}")
                run.attrs["threads"], run["cpu"] = 1, np.array(costs)
                group = file.create_group(f"choices/{number:04d}")
                failure = "too long a step" if number in failed else ""
                group.attrs.update({"name": name, "on_front": number in front, "failure": failure, "found": ""})
                group["run"] = h5py.SoftLink(f"/runs/{number}")
                group["monitor"], group["component"], group["rms"] = ["gauge"], ["x"], np.array([error])
                group["apart"] = np.array([apart * number])
        return path

    return write


def texts(panel) -> list[str]:
    """All texts of a panel, in the order in which they were written."""
    return [text.get_text() for text in panel.texts]


def test_points_are_errors_in_per_cent_at_the_median_cost(chart) -> None:
    figure = plot_chart(chart([("fine", 0.01, [3.0, 4.0, 9.0]), ("coarse", 0.2, [0.5])], front=[0, 1]))
    panel, side = figure.axes
    points = {line.get_gid(): (line.get_xdata()[0], line.get_ydata()[0]) for line in panel.lines if line.get_gid()}
    assert points == {"fine": (4.0, pytest.approx(1.0)), "coarse": (0.5, pytest.approx(20.0))}
    (front,) = (line for line in panel.lines if line.get_label() == "Pareto front")
    np.testing.assert_allclose(front.get_xydata(), [(4.0, 1.0), (0.5, 20.0)])
    assert panel.get_xlabel() == "CPU time of stepping (s), 1 thread"
    assert panel.get_ylabel() == "RMS error of the velocity, worst monitor (%)"
    assert texts(side) == ["Pareto front, the cheapest first", "2  coarse: 20 %, 0.5 s", "1  fine: 1 %, 4 s"]


def test_reference_others_and_failures_are_listed_and_exact_results_drawn_at_the_least(chart) -> None:
    choices = [("own", 0.0, [8.0]), ("good", 1e-14, [1.0]), ("bad", 0.2, [2.0]), ("none", 0.0, [])]
    panel, side = plot_chart(chart(choices, front=[1], own=(0,), failed=[3])).axes
    assert texts(side) == [
        *("Pareto front, the cheapest first", "2  good: 0 %, 1 s", "reference", "1  own: 8 s"),
        *("others", "3  bad: 20 %, 2 s", "failed", "4  none: too long a step"),
    ]
    (line,) = (line for line in panel.lines if line.get_linestyle() == ":")
    assert list(line.get_xdata()) == [8.0, 8.0]
    (point,) = (line for line in panel.lines if line.get_gid() == "good")
    assert point.get_ydata()[0] == LEAST


def test_numbers_cover_neither_each_other_nor_points_and_are_inside_the_panel(chart) -> None:
    rng = np.random.default_rng(3)
    crowd = [(f"choice {k}", error, [cost]) for k, (error, cost) in enumerate(np.exp(0.15 * rng.normal(size=(12, 2))))]
    column = [(f"choice {k}", 0.1 * 1.5**k, [1.0]) for k in range(9)]
    for choices in (crowd, column):
        figure = plot_chart(chart(choices, front=[0, 1]))
        figure.draw_without_rendering()
        panel = figure.axes[0]
        boxes = [text.get_window_extent() for text in panel.texts]
        assert len(boxes) > 6
        assert not any(a.overlaps(b) for k, a in enumerate(boxes) for b in boxes[:k])
        assert all(panel.get_window_extent().contains(*corner) for box in boxes for corner in box.corners())
        points = panel.transData.transform(
            [(line.get_xdata()[0], line.get_ydata()[0]) for line in panel.lines if line.get_gid()]
        )
        assert not any(box.contains(*point) for box in boxes for point in points)
        for text, box in zip(panel.texts, boxes, strict=True):
            middle = np.mean(box.corners(), axis=0)
            assert np.argmin(np.hypot(*(points - middle).T)) == int(text.get_text()) - 1


def test_monitors_elsewhere_are_marked_with_the_largest_distance(chart) -> None:
    choices = [("fine", 0.01, [3.0]), ("coarse", 0.2, [0.5]), ("coarser", 0.3, [0.4])]
    side = plot_chart(chart(choices, apart=0.25)).axes[1]  # 0, 0.25 and 0.5 m
    names = [text.split(":")[0] for text in texts(side)[1:4]]
    assert names == ["3  coarser†", "2  coarse†", "1  fine"]
    assert texts(side)[-1] == "† monitors record elsewhere than in the reference, up to 0.5 m away"
    assert "†" not in "".join(texts(plot_chart(chart(choices)).axes[1]))


def test_the_sentence_stays_below_any_title(chart, tmp_path) -> None:
    path = chart([("fine", 0.01, [3.0])])
    assert plot_chart(path).get_suptitle() == "A rod\ncheapest: none"
    figure = plot_chart(path, "Mine $x^{$")
    assert figure.get_suptitle() == "Mine $x^{$\ncheapest: none"
    save(figure, path.with_suffix(".png"))  # as text, not as a formula
    with pytest.raises(CaseError, match="cannot be read"):
        plot_chart(tmp_path / "nothing.h5")
