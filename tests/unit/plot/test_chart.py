"""The picture of a chart, from its record."""

import h5py
import numpy as np
import pytest

from dembound.accuracy.chart.front import front, points_of
from dembound.errors import CaseError
from dembound.plot.chart import LEAST, plot_chart
from dembound.plot.style import save


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
    figure = plot_chart(chart([("fine", 0.01, 4.0), ("coarse", 0.2, 0.5)], front=[0, 1]))
    panel, side = figure.axes
    points = {line.get_gid(): (line.get_xdata()[0], line.get_ydata()[0]) for line in panel.lines if line.get_gid()}
    assert points == {"fine": (4.0, pytest.approx(1.0)), "coarse": (0.5, pytest.approx(20.0))}
    (front,) = (line for line in panel.lines if line.get_label() == "Pareto front")
    np.testing.assert_allclose(front.get_xydata(), [(4.0, 1.0), (0.5, 20.0)])
    assert panel.get_xlabel() == "cost: CPU time of stepping (s), 1 thread"
    assert panel.get_ylabel() == "RMS error of the velocity, worst monitor (%)"
    assert panel.get_title(loc="left") == "errors of the rock, beside exact; gauge (x)\nmeasured: all causes"
    assert sorted(texts(panel)) == ["coarse", "fine"]
    assert texts(side) == ["Pareto front, the cheapest first", "coarse: 20 %, 0.5 s", "fine: 1 %, 4 s"]


@pytest.mark.parametrize("seed", [0, *(pytest.param(k, marks=pytest.mark.slow) for k in (1, 2))])
def test_no_point_off_the_drawn_front_is_left_of_and_below_all_on_it_and_none_on_it_is_dominated(chart, seed) -> None:
    """Of the points of the figure itself; errors at both ends of those that can be drawn, and costs in ties."""
    rng = np.random.default_rng(seed)
    errors, costs = 10.0 ** rng.uniform(-8, 0, 25), 0.1 * 1.1 ** rng.integers(0, 30, 25)
    points = points_of(errors, costs)
    choices = [(f"choice {k}", error, cost) for k, (error, cost) in enumerate(points)]
    panel = plot_chart(chart(choices, front=front(points))).axes[0]
    drawn = {line.get_gid(): line.get_xydata()[0] for line in panel.lines if line.get_gid()}
    (line,) = (line for line in panel.lines if line.get_label() == "Pareto front")
    on = line.get_xydata()
    assert len(drawn) == 25
    for place in drawn.values():
        dominated = any((other <= place).all() and (other < place).any() for other in drawn.values())
        assert dominated != (on == place).all(axis=1).any()


def test_reference_others_and_failures_are_listed_and_exact_results_drawn_at_the_least(chart) -> None:
    choices = [("own", 0.0, 8.0), ("good", 1e-14, 1.0), ("bad " * 40, 0.2, 2.0), ("none", 0.0, np.nan)]
    panel, side = plot_chart(chart(choices, front=[1], own=(0,), failed=[3])).axes
    assert texts(side) == [
        *("Pareto front, the cheapest first", "good: 0 %, 1 s", "reference", "1  own: 8 s"),
        *("others", side.texts[5].get_text(), "failed", "4  none: too long a step"),
    ]
    assert side.texts[5].get_text().startswith("3  bad bad")  # the one whose name is too long for the picture
    (line,) = (line for line in panel.lines if line.get_linestyle() == ":")
    assert list(line.get_xdata()) == [8.0, 8.0]
    (point,) = (line for line in panel.lines if line.get_gid() == "good")
    assert point.get_ydata()[0] == LEAST


@pytest.mark.slow
def test_labels_cover_neither_each_other_nor_points_and_are_inside_the_panel(chart) -> None:
    rng = np.random.default_rng(3)
    crowd = [(f"choice {k}", error, cost) for k, (error, cost) in enumerate(np.exp(0.15 * rng.normal(size=(12, 2))))]
    column = [(f"choice {k}", 0.1 * 1.5**k, 1.0) for k in range(9)]
    for choices in (crowd, column):
        figure = plot_chart(chart(choices, front=[0, 1]))
        figure.draw_without_rendering()
        panel = figure.axes[0]
        boxes = [text.get_window_extent() for text in panel.texts]
        assert len(boxes) > 6
        assert any(text.get_text().startswith("choice") for text in panel.texts)
        assert not any(a.overlaps(b) for k, a in enumerate(boxes) for b in boxes[:k])
        assert all(panel.get_window_extent().contains(*corner) for box in boxes for corner in box.corners())
        points = panel.transData.transform(
            [(line.get_xdata()[0], line.get_ydata()[0]) for line in panel.lines if line.get_gid()]
        )
        assert not any(box.contains(*point) for box in boxes for point in points)
        for text, box in zip(panel.texts, boxes, strict=True):
            apart = np.hypot(*np.maximum(np.maximum(box.min - points, points - box.max), 0.0).T)
            said = text.get_text()
            assert np.argmin(apart) == (int(said[7:]) if said.startswith("choice") else int(said) - 1)


def test_monitors_elsewhere_are_marked_with_the_largest_distance(chart) -> None:
    choices = [("fine", 0.01, 3.0), ("coarse", 0.2, 0.5), ("coarser", 0.3, 0.4)]
    panel, side = plot_chart(chart(choices, front=[0, 1], apart=0.25)).axes  # 0, 0.25 and 0.5 m
    assert [text.split(":")[0] for text in texts(side)[1:3]] == ["coarse†", "fine"]
    assert sorted(texts(panel)) == ["coarser†", "coarse†", "fine"]
    last = " ".join(texts(side)[-1].split())
    assert last == "† monitors record elsewhere than in the reference, up to 0.5 m away"
    assert "†" not in "".join(texts(plot_chart(chart(choices)).axes[1]))


def test_the_sentence_stays_below_any_title(chart, tmp_path) -> None:
    path = chart([("fine", 0.01, 3.0)])
    assert plot_chart(path).get_suptitle() == "A rod\ncheapest: none"
    figure = plot_chart(path, "Mine $x^{$")
    assert figure.get_suptitle() == "Mine $x^{$\ncheapest: none"
    save(figure, path.with_suffix(".png"))  # as text, not as a formula
    with pytest.raises(CaseError, match="cannot be read"):
        plot_chart(tmp_path / "nothing.h5")
