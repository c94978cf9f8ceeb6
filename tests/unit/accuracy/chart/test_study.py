"""A whole chart: choices run, compared, recorded and resumed."""

import csv
from contextlib import contextmanager

import h5py
import numpy as np
import pytest

from dembound.accuracy.chart import study
from dembound.accuracy.chart.study import Options, chart
from dembound.accuracy.chart.tables import COLUMNS, write_results, write_table
from dembound.accuracy.choice import choices_of, combinations
from dembound.accuracy.of_disks.judge import REALISATIONS, DiskJudge
from dembound.accuracy.reference import Requested
from dembound.errors import CaseError, RunError
from dembound.running import Progress

SPACINGS = {"bar.spacing": [0.05, 0.025]}


class Log:
    """Names of the runs of a chart; those that are not timed have their size, particles × steps."""

    def __init__(self) -> None:
        self.names: list[str] = []

    @contextmanager
    def __call__(self, name: str):
        self.names.append(name.rpartition(", ")[0] if name.endswith(" steps") else name)
        yield Progress()


@pytest.fixture(autouse=True)
def at_once(monkeypatch) -> None:
    """Short runs are timed once."""
    monkeypatch.setattr(study, "AT_ONCE", 1)


@pytest.fixture
def charted(tmp_path):
    """Charts a case in a folder, and logs the runs."""

    def make(case, vary=SPACINGS, resume=False, repeats=2, **options):
        log = Log()
        options = Options(named=combinations(case, vary) if vary else None, repeats=repeats, **options)
        return chart(case, options, tmp_path / "chart", resume, log), log.names

    return make


def test_runs_compile_first_and_are_timed_in_turn(charted, spalling) -> None:
    found, runs = charted(spalling())
    assert runs == [
        "1 of 2 choices, spacing 0.05 m",
        "2 of 2 choices, spacing 0.025 m",
        *(f"{k} of 2 choices, timed run {n} of 2" for n in (1, 2) for k in (1, 2)),
    ]
    assert [len(line.outcome.cpu) for line in found.lines] == [2, 2]
    assert all(0.0 < line.point.cost < line.wall for line in found.lines)
    assert found.lines[1].outcome.work > 3.9 * found.lines[0].outcome.work  # twice the bonds in twice the steps
    assert found.lines[1].errors[0].rms < found.lines[0].errors[0].rms
    assert found.reference.name == "exact"


def test_a_chart_is_resumed_where_it_ended(charted, spalling, tmp_path) -> None:
    first, _ = charted(spalling(), {"bar.spacing": [0.05]}, repeats=1)
    second, runs = charted(spalling(), resume=True)
    assert runs == [
        "2 of 2 choices, spacing 0.025 m",
        "2 of 2 choices, timed run 1 of 2",
        "1 of 2 choices, timed run 2 of 2",
        "2 of 2 choices, timed run 2 of 2",
    ]
    assert second.lines[0].errors == first.lines[0].errors
    assert second.lines[0].outcome.cpu[0] == first.lines[0].outcome.cpu[0]
    assert charted(spalling(), resume=True)[1] == []
    assert len(charted(spalling({"run.duration": 1.4e-3}), resume=True)[1]) == 6  # other results
    assert len(charted(spalling())[1]) == 6  # anew


def test_a_choice_that_fails_is_kept_with_its_reason(charted, spalling) -> None:
    found, _ = charted(spalling(), {"run.courant": [0.5, 3.0]}, repeats=1)
    good, bad = found.lines
    assert (good.outcome.failure, bad.errors) == ("", ())
    assert bad.outcome.failure.startswith("run.courant: is 3, must not be above")
    assert found.front == [0]
    with pytest.raises(RunError, match=r"courant 3: run\.courant"):
        charted(spalling(), {"run.courant": [3.0]})


def test_the_finest_choice_is_the_reference_of_disks_without_a_solution(charted, bar) -> None:
    case = bar({"run.duration": 0.02, "motion.held": []})
    found, _ = charted(case, {"packing.radius": [0.25, 0.5]}, repeats=1)
    assert (found.reference.name, found.reference.own) == ("finest", (0,))
    assert found.reference.sentence == "the finest run, radius 0.25 m"
    assert found.judged == found.front == [1]
    assert found.lines[0].errors[0].rms == 0.0
    assert found.sentence.endswith(f"the reference itself: radius 0.25 m ({found.lines[0].point.cost:.2g} s)")
    # a choice that is the reference run again is not its cheapest: the number of snapshots changes no run
    found, _ = charted(case, {"run.safety": [0.45, 0.9], "output.snapshots": [0, 2]}, repeats=1)
    assert (found.reference.own, found.judged) == ((0, 1), [2, 3])
    assert found.cheapest(1.0) in (2, 3)


FADING = {"bar.attenuation": 0.1, "bar.strength": 1e9, "method": {"type": "finite_difference"}, "load.1.nodes": 1}
"""A bar for which no exact solution is known."""


def test_a_finer_run_is_the_reference_of_bars_without_a_solution(charted, spalling) -> None:
    found, runs = charted(spalling(FADING), {"bar.spacing": [0.05, 0.025], "run.courant": [0.9, 1.0]}, repeats=1)
    assert (found.reference.name, found.reference.own) == ("finer", ())
    # 20 and 40 cells: 160 are a multiple of both, and four times as many as the finest
    said = "finite differences at Courant number 1 and a spacing of 0.00625 m, finer than all choices"
    assert found.reference.sentence == said
    assert runs.count("finer reference") == 1
    assert found.judged == [0, 1, 2, 3]
    assert all(error.apart == 0.0 for line in found.lines for error in line.errors)
    errors = {line.choice.name: line.errors[0].rms for line in found.lines}
    # without attenuation no error would be left at ν = 1; with it 0.04 %, and 16 % at ν = 0.9
    assert errors["spacing 0.025 m, courant 1"] < 0.05 * errors["spacing 0.025 m, courant 0.9"]


def test_spalls_are_compared_with_the_closed_form(charted, spalling) -> None:
    found, _ = charted(spalling(), repeats=1)
    place, time = (found.lines[1].outcome.findings[name].value for name in ("spall place", "spall time"))
    farther, later = 1e3 * (place - (1.0 - 0.2 / 3.0)), 1e6 * (time - found.reference.until)
    assert found.found(found.lines[1]) == f"spall place {farther:+.2g} mm, spall time {later:+.2g} µs"


SPALLING_DISKS = {
    "material.law": "linearpbond",
    "material.contact_share": 0.0,
    "material.pb_ten": 0.4e6,
    "motion.held": ["y", "rotation"],
    "boundary.right": {"type": "free"},
    "run.duration": 0.05,
}
"""A bar whose bonds break when the pulse comes back from its free end."""


@pytest.mark.slow
def test_histories_are_compared_up_to_the_first_broken_bond(charted, bar) -> None:
    laws = {"material.elastic_start": [True, False], "run.safety": [0.9, 0.3]}
    found, _ = charted(bar(SPALLING_DISKS), laws, repeats=1)
    time = found.lines[found.reference.own[0]].outcome.findings["break time"].value
    assert found.reference.until == time < 0.05
    assert found.reference.sentence.endswith(f", up to its first break at {1e3 * time:.4g} ms")
    assert "break time +" in found.found(found.lines[0]) or "break time -" in found.found(found.lines[0])
    assert found.found(found.lines[found.reference.own[0]]).startswith(f"break time {1e3 * time:.3g} ms, break x ")

    whole, _ = charted(bar(SPALLING_DISKS | {"chart.until": "end"}), laws, repeats=1)
    assert (whole.reference.until, "break" in whole.reference.sentence) == (np.inf, False)
    # the pieces fly on at speeds of their own
    assert whole.lines[0].errors[0].rms > 3.0 * found.lines[0].errors[0].rms


def test_random_packings_are_realisations_but_boxes_elsewhere_have_the_same_bricks(charted, bar) -> None:
    packing = {"pattern": "B", "size": [9.0, 3.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [3.0, 3.0], "seed": 1}
    case = bar({"packing": packing, "run.duration": 0.004})
    found, _ = charted(case, {"packing.seed": [1, 2]}, repeats=1, reference="finest")
    assert found.left_out == [REALISATIONS]
    packing = {"pattern": "B", "radius": 0.25, "radius_ratio": 1.5, "brick": [5.0, 5.0]}
    case = bar({"packing": packing | {"size": [10.0, 10.0]}, "motion.held": []})
    box = {"ground.size": [10.0, 10.0], "packing": packing | {"size": [5.0, 5.0], "origin": [0.0, 5.0]}}
    sides = {f"boundary.{side}": {"type": "outside"} for side in ("left", "right", "bottom")}
    choices, _ = choices_of(case, {"all": {}, "box": box | sides, "other": {"packing.seed": 7}})
    cases = [choice.case for choice in choices]
    assert DiskJudge().cautions(cases[:2]) == ()
    assert len(DiskJudge().cautions(cases)) == 1


def test_an_extended_scene_is_the_reference_of_sides(charted, bar) -> None:
    # the pulse of 10 m meets the end while it is still driven: nothing returns from an end far away
    sides = {"boundary.right": [{"type": "viscous"}, {"type": "free"}], "packing.radius": [0.25, 0.5]}
    case = bar({"run.duration": 0.02, "motion.held": []})  # so that there is no exact solution
    found, runs = charted(case, sides, repeats=1)
    assert found.reference.name == "extended"
    assert "extended scene" in runs
    errors = {line.choice.name: line.errors[0] for line in found.lines}
    assert errors["boundary.right viscous, radius 0.25 m"].rms < 0.5 * errors["boundary.right free, radius 0.25 m"].rms
    assert errors["boundary.right free, radius 0.25 m"].apart == 0.0
    # the reference has the dispersion of the finest disks: ways of 5 m at most, pulse of 10 m and D/2 = 0.25 m. A delay
    # s/24 (qD)² of some 2 mm at q = 2π/10 m, four times more at three times that, is some 0.1 to 0.5 % of the motion
    (rest,) = {error.rest for error in errors.values()}
    assert 5e-4 < rest < 0.01
    assert all(error.total == pytest.approx(np.hypot(error.rms, rest)) for error in errors.values())


@pytest.mark.parametrize(
    ("body", "changes", "options", "said"),
    [
        ("spalling", {"monitor": []}, {}, "monitor: is missing"),
        ("spalling", {}, {"requested": Requested(monitor="no")}, "--monitor: is no, must be one of gauge"),
        ("spalling", {"bar.attenuation": 0.1}, {"reference": "exact"}, "no exact solution"),
        (
            "spalling",
            {},
            {"vary": {"bar.spacing": [0.05]}, "reference": "finest"},
            "is the only valid choice, which wou",
        ),
        ("bar", {}, {"vary": {"run.safety": [0.45, 0.9]}, "reference": "finer"}, "finer is for bars"),
        ("bar", {}, {"vary": {"run.safety": [0.5]}, "requested": Requested("stress")}, "stress is that along a bar"),
    ],
)
def test_what_cannot_be_compared_is_bad_input(charted, request, body, changes, options, said, tmp_path) -> None:
    with pytest.raises(CaseError, match=said):
        charted(request.getfixturevalue(body)(changes), repeats=1, **options)
    assert "only valid" not in said or not (tmp_path / "chart").exists()


def test_the_record_and_the_table_have_all(charted, spalling, tmp_path) -> None:
    found, _ = charted(spalling(), {"bar.spacing": [0.05, 0.025], "run.courant": [0.9, 3.0]}, repeats=1)
    path = tmp_path / "chart" / "chart.h5"
    write_results(found, path)
    write_results(found, path)  # again, as of a chart that is resumed
    write_table(found, tmp_path / "chart.csv")

    with (tmp_path / "chart.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [row["choice"] for row in rows] == [line.choice.name for line in found.lines]
    assert float(rows[0]["rms"]) == found.lines[0].errors[0].rms
    assert rows[1]["failure"].startswith("run.courant: is 3")
    assert [row["bar.spacing"] for row in rows] == ["0.05", "0.05", "0.025", "0.025"]
    assert float(rows[0]["spall place error"]) == pytest.approx(float(rows[0]["spall place"]) - 1.0 + 0.2 / 3.0)
    assert set(COLUMNS) < set(rows[0])
    with h5py.File(path) as file:
        assert [group.attrs["name"] for group in file["choices"].values()] == [row["choice"] for row in rows]
        run = file["runs"][file["choices/0000"].attrs["digest"]]
        gauge, motion = run["gauges/gauge"], found.lines[0].outcome.motions["gauge"]
        np.testing.assert_array_equal(gauge["velocity"][:], motion.velocity)
        assert file["reference"].attrs["spall place"] == pytest.approx(1.0 - 0.2 / 3.0)
        assert file.attrs["sentence"] == found.sentence
