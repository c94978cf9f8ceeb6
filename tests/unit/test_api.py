"""dembound from Python: the same cases, checks and results as from files."""

import re
import signal
import warnings
from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pytest
import tomli_w
from scene_tables import ROCK, lattice, monitors

import dembound
from dembound.results.reader import text_of
from dembound.waves import Cosine

ROOT = Path(__file__).parents[2]
pytestmark = pytest.mark.filterwarnings("ignore:(wave|monitor)")  # of a case this small
TABLES = {
    "packing": {"pattern": "A", "size": (5.0, 1.0), "radius": 0.25},
    "material": {"density": 2500.0, "p_wave_speed": np.float64(1000.0)},
    "boundary": {"left": {"type": "velocity", "wave_p": "push"}, "right": {"type": "viscous", "beta_p": None}},
    "wave": {"push": Cosine(type="cosine", amplitude=0.5, period=0.002)},
    "monitor": [{"name": "middle", "position": np.array([2.6, 0.3])}],
    "run": {"duration": 0.004},
    "output": {"pictures": False, "snapshots": 2},
}
PLAIN = TABLES | {
    "packing": lattice(5.0, 1.0, 0.5),
    "material": ROCK,
    "boundary": TABLES["boundary"] | {"right": {"type": "viscous"}},
    "wave": {"push": {"type": "cosine", "amplitude": 0.5, "period": 0.002}},
    "monitor": monitors(middle=(2.6, 0.3)),
}


@pytest.fixture(scope="module")
def results(tmp_path_factory) -> dembound.Results:
    return dembound.run(dembound.case("small", **TABLES), tmp_path_factory.mktemp("results"))


def test_a_case_of_python_s_words_is_that_of_a_file(tmp_path) -> None:
    path = tmp_path / "small.toml"
    path.write_text(tomli_w.dumps(PLAIN))

    made, read = dembound.case("small", **TABLES), dembound.load(path)
    assert made == read == dembound.loads(made.text)
    assert (made.name, read.name) == ("small", "small")


def test_mistakes_are_those_of_a_file() -> None:
    wrong = {**TABLES, "material": {"density": -1.0}, "runs": {}}
    with pytest.raises(dembound.CaseError) as python:
        dembound.case(**wrong)
    with pytest.raises(dembound.CaseError) as file:
        dembound.loads(tomli_w.dumps({**PLAIN, "material": {"density": -1.0}, "runs": {}}))
    assert python.value.problems == file.value.problems
    assert len(file.value.problems) == 2

    with pytest.raises(dembound.CaseError, match=r"material\.density: is of the Python type complex, must be numbers"):
        dembound.case(**{**TABLES, "material": {"density": 1j}})


def test_a_case_is_changed_into_another(results) -> None:
    case = dembound.case("small", **TABLES)
    other = dembound.change(case, {"wave.push.amplitude": np.float32(0.25), "monitor.middle.position": (1, 1)}, "other")

    assert (other.name, other.wave["push"].amplitude, other.monitor[0].position) == ("other", 0.25, (1.0, 1.0))
    assert case.wave["push"].amplitude == 0.5
    with pytest.raises(dembound.CaseError, match=r"run\.duration"):
        dembound.change(case, {"run.duration": 0.0})


def test_a_case_made_without_checks_is_checked_before_it_runs(tmp_path) -> None:
    case = dembound.case(**TABLES)
    lost = replace(case, wave={})
    with pytest.raises(dembound.CaseError, match=r'boundary\.left\.wave_p: "push" is not a wave of this case'):
        dembound.run(lost, tmp_path)
    # those of the class alone: only what has no default has to be given
    bare = type(case)(packing=case.packing, material=case.material, run=case.run)
    assert dembound.loads(bare.text) == bare
    assert not bare.is_checked


def test_results_are_those_of_the_record(results) -> None:
    with h5py.File(results.folder / "run.h5") as file:
        for name in ("time", "velocity", "displacement"):
            assert np.array_equal(results.histories["middle"][name], file["histories/middle"][name][:])
        times = [group.attrs["time"] for group in file["snapshots"].values()]
        assert [shot.attributes["time"] for shot in results.snapshots] == times
        assert np.array_equal(results.snapshots[-1]["velocity"], file["snapshots/0001/velocity"][:])
        assert np.array_equal(results.boundaries["right"]["peak_velocity"], file["boundaries/right/peak_velocity"][:])
        assert results.case == text_of(file.attrs["case"])
    steps = round(results.energy["time"][-1] / results.attributes["time_step"]) + 1
    assert results.attributes["steps"] == results.summary["steps"] == steps
    assert results.laws == [("elastic", 0.0)]
    assert dembound.loads(results.case) == dembound.case(**TABLES)


def test_results_that_a_later_run_replaced_say_so(tmp_path) -> None:
    case = dembound.case("again", **TABLES)
    first = dembound.run(case, tmp_path)
    velocities = first.histories["middle"]
    dembound.run(dembound.change(case, {"wave.push.amplitude": 0.1}), tmp_path)
    for read in (
        lambda: velocities["velocity"],
        lambda: first.snapshots[0],
        lambda: first.energy,
        lambda: first.summary,
    ):
        with pytest.raises(dembound.RecordError, match=r"again: was replaced by a later run; give runs names of their"):
            read()
    assert dembound.Results(first.folder).histories["middle"]["velocity"].size > 0


def test_an_interrupted_run_names_what_continues_it(tmp_path) -> None:
    class Stops(dembound.Progress):
        def running(self, run, steps) -> None:
            signal.raise_signal(signal.SIGINT)

    with pytest.raises(KeyboardInterrupt) as stop:
        dembound.run(dembound.case("cut", **TABLES), tmp_path, progress=Stops())
    partial = tmp_path / "cut.partial"
    again = f'to continue: dembound.resume("{partial}")'
    assert str(stop.value) == f"cut: stopped; histories so far are in {partial}; {again}"
    begun = dembound.Results(partial)
    assert begun.histories["middle"]["velocity"].shape[1] == 3
    assert dembound.resume(partial).attributes["complete"]


def test_runs_are_estimated_if_their_case_asks_for_it_and_warn_as_python_does(tmp_path) -> None:
    case = dembound.case("asked", **(TABLES | {"output": TABLES["output"] | {"estimate": True}}))
    with pytest.warns(dembound.CaseWarning, match=r"^boundary\.right: sends back") as warned:
        found = dembound.run(case, tmp_path)
    assert {each.filename for each in warned} == {__file__}
    assert "middle" in found.summary["error_estimate"]["monitors"]
    longer = dembound.resume(found.folder, until=0.006)
    assert "middle" in longer.summary["error_estimate"]["monitors"]
    budget = dembound.estimate(found.folder)
    assert budget.total("middle", "velocity").value > 0.0
    said = r"<Budget, errors of the rock: .+ of the velocity at middle .*; monitors: middle>"
    assert re.fullmatch(said, repr(budget))


def test_one_side_or_all_are_calibrated() -> None:
    case = dembound.change(dembound.case(**TABLES), {"boundary.right.beta_p": 2.0, "wave.push.period": 0.1})
    calibrated, found = dembound.calibrate(case, "right")
    assert calibrated.boundary["right"].beta_p == found.result == pytest.approx(1.0, abs=0.02)

    calibrated, found = dembound.calibrate_all(case, method="homogenised")
    assert {(each.side, each.motion): each.result for each in found} == {
        (side, motion): table.factors[motion] for side, table in calibrated.boundary.items() for motion in table.factors
    }


def test_the_documented_examples_run(tmp_path, monkeypatch, capsys) -> None:
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "docs/start/python.md").read_text(), flags=re.DOTALL)
    monkeypatch.chdir(tmp_path)
    names: dict = {}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for block in blocks:
            exec(block, names)
    said = capsys.readouterr().out.splitlines()

    # half the peak of 1 m/s is there a quarter of the period of 0.08 s after 80 m at 1000 m/s
    assert float(re.search(r"after ([\d.]+) s", said[0])[1]) == pytest.approx(0.1, abs=0.001)
    assert said[1] == "spall at 439 µs, 0.905 to 0.909 m"
    assert said[2:4] == ["0.1 m/s in, 0.100 m/s at 80 m", "1 m/s in, 1.000 m/s at 80 m"]
    assert said[4].startswith("β_P = ")
    # the lattice delays a wave of 160 disks by (2π/160)²/24 of its way, a wavelength: the crest keeps its 1 m/s to 1 %
    assert said[5] == "E 2.00 GPa, strength 0.50 MPa"
    assert said[6].endswith(" m/s at 80 m under one period of a sine")
    assert float(said[6].split()[0]) == pytest.approx(1.0, abs=0.01)
    assert [line.split(":")[0] for line in said[7:]] == ["run.duration", "boundary.right.beta_p"]


def test_names_that_results_do_not_have_are_answered_with_those_they_have(results) -> None:
    known = "displacement, time, velocity (did you mean velocity?)"
    for group, name, said in (
        (results.histories, "midle", 'monitor: is "midle", must be one of middle (did you mean middle?)'),
        (results.boundaries, "up", 'side: is "up", must be one of bottom, left, right, top'),
        (results.histories["middle"], "velocty", f'array: is "velocty", must be one of {known}'),
        (results.summary, "step", 'entry: is "step", must be one of '),
    ):
        with pytest.raises(dembound.NameMissingError) as caught:
            group[name]
        assert str(caught.value).startswith(said)
        assert isinstance(caught.value, KeyError)

    for arrays in (*results.histories.values(), *results.snapshots, results.particles, results.cracks):
        for name in arrays:
            columns = arrays[name].shape[1] if arrays[name].ndim > 1 else 1
            assert len(arrays.units(name)) == columns, name
            assert all(arrays.units(name))
    assert results.histories["middle"].units("velocity") == ("m/s", "m/s", "rad/s")
    assert [results.energy_units[name] for name in ("time", "kinetic", "relative_error")] == ["s", "J/m", "1"]


def test_the_text_of_a_case_is_no_path() -> None:
    for ask in (dembound.load, dembound.run):
        with pytest.raises(dembound.CaseError, match=r"is the text of a case, .*give dembound\.loads\(text\)"):
            ask('[packing]\npattern = "A"\n')
