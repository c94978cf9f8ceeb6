"""Libraries: their records and runs, the sums of responses, and what is written of them."""

import h5py
import numpy as np
import pytest
from small_cases import GRAINS, PUSHED, SOIL, small

from dembound.errors import CaseError
from dembound.results.compare import compare
from dembound.running import run_case
from dembound.running.recorded import recorded_case
from dembound.studies.library import Library, RecordTimes, build_library, read_records, watched_contacts, write_response
from dembound.studies.library.library import on_spacing
from dembound.waves import FileWave

SPACING = 1e-3

HEAVY = GRAINS | {
    "boundary": {"bottom": {"type": "viscous_input", "wave_p": "up", "wave_s": "shake"}},
    "wave": {
        "up": GRAINS["wave"]["pulse"] | {"motion": "within"},
        "shake": GRAINS["wave"]["pulse"] | {"motion": "outcrop"},
        "push": GRAINS["wave"]["pulse"],
    },
    "load": [
        {"name": "weight", "acceleration": [0.0, -9.81]},
        {"name": "push", "force": [2e5, 1e5], "position": [5.0, 3.0], "wave": "push"},
    ],
    "static": {"boundary": {"bottom": {"type": "fixed"}}},
}
"""Random disks under their weight, with motion of two directions given below, of two kinds, and a load."""


@pytest.fixture(scope="module")
def heavy(tmp_path_factory):
    """A library of these disks."""
    return Library(build_library(small(HEAVY, "heavy"), SPACING, tmp_path_factory.mktemp("heavy"), duration=0.03))


def records(library, folder, seed=4):
    """A record of noise for each input, as an argument; too few values for a measured one, so lines join them."""
    rng, parts = np.random.default_rng(seed), []
    for name in library.inputs:
        values = rng.standard_normal(19)
        values[[0, -1]] = 0.0
        path = folder / f"{name}.txt"
        np.savetxt(path, np.column_stack([SPACING * np.arange(19), values]))
        parts.append(f"{name}={path}")
    return parts


def test_histories_are_those_of_a_direct_run(heavy, tmp_path):
    assert heavy.inputs == ["push", "shake", "up"]
    (record,) = read_records([",".join(records(heavy, tmp_path))], heavy.inputs, heavy.clock)
    path = tmp_path / record.name / "run.h5"
    motion = write_response(heavy, record, path)
    direct = run_case(recorded_case(path), tmp_path / "direct") / "run.h5"
    with h5py.File(direct) as run:
        for number, name in enumerate(heavy.monitors):
            history = run["histories"][name]
            np.testing.assert_array_equal(history["time"][:], heavy.time)
            for columns, quantity in ((slice(0, 3), "displacement"), (slice(3, 6), "velocity")):
                values = history[quantity][:]
                # rounding of sums of some hundred terms, each as large as the peak: 1e-13 of it at most
                atol = 1e-12 * np.abs(values).max(axis=0)
                assert (np.abs(motion[:, number, columns] - values) <= atol).all()
    # the step is a fraction of the spacing and of the histories' 0.4 ms, in whole steps of 0.25 ms, as in runs
    step, apart = heavy.case.run.time_step, heavy.time[1] - heavy.time[0]
    assert apart == pytest.approx(2 * step)
    for whole in (SPACING / step, SPACING / apart):
        assert whole == pytest.approx(round(whole))


@pytest.mark.slow
def test_layers_respond_as_in_a_direct_run(tmp_path):
    library = Library(build_library(small(SOIL, "soil", {"run.duration": 0.15}), 0.005, tmp_path))
    np.savetxt(tmp_path / "r.txt", [(0.0, 0.0), (0.005, 0.2), (0.01, -0.1), (0.015, 0.0)])
    (record,) = read_records([str(tmp_path / "r.txt")], library.inputs, library.clock)
    path = tmp_path / "r" / "run.h5"
    write_response(library, record, path)
    direct = run_case(recorded_case(path), tmp_path / "direct") / "run.h5"
    # sums of some hundred terms as large as the peak
    assert all(found.peak < 1e-12 for found in compare(direct, [path], "velocity"))
    # strengths are those of the layer of a contact
    monitors = [
        {"name": name, "position": [0.375, y]} for name, y in (("a", 12.375), ("b", 12.125), ("c", 5.125), ("d", 4.875))
    ]
    strong = SOIL | {"monitor": monitors, "output": {"load_factor": True}}
    changes = {"layer.clay.pb_ten": 1e5, "layer.sand.pb_ten": 2e5, "layer.rock.pb_ten": 3e5}
    library = Library(build_library(small(strong, "strong", changes), 0.005, tmp_path, duration=0.02))
    found = watched_contacts(library, ["a,b", "c,d"])
    assert [each.limits.tension for each in found] == [1e5, 2e5]


def test_inputs_without_a_record_are_silent(heavy, tmp_path):
    argument = records(heavy, tmp_path)[1]
    (record,) = read_records([argument], heavy.inputs, heavy.clock)
    each = heavy.motion(record.values)
    silent = heavy.motion({name: np.zeros(3) for name in heavy.inputs} | record.values)
    np.testing.assert_array_equal(each, silent)
    write_response(heavy, record, tmp_path / "run.h5")
    case = recorded_case(tmp_path / "run.h5")
    assert case.wave["shake"].type == "file"
    assert case.wave["up"].start > case.run.duration


def test_a_scene_without_steady_forces_needs_one_run(tmp_path):
    tables = PUSHED | {"boundary": PUSHED["boundary"] | {"left": {"type": "velocity", "wave_p": "push"}}}
    folder = build_library(small(tables, "one"), SPACING, tmp_path)
    assert sorted(each.name for each in folder.iterdir()) == ["hat_push", "library.json"]
    library = Library(folder)
    assert library.clock.duration == 0.01
    assert not library.rest.any()


@pytest.mark.parametrize(
    ("changes", "problem"),
    [
        ({"material.law": "linearpbond"}, 'material.law: is "linearpbond", .* so "elastic"'),
        ({"monitor": []}, "monitor: there is none"),
        ({"run.time_step": 3e-4}, r"run.time_step: is 0.0003 s, must be a whole fraction of the spacing, 0.00025 s"),
    ],
)
def test_what_is_not_linear_is_refused(tmp_path, changes, problem):
    case = small(PUSHED, "refused", changes)
    with pytest.raises(CaseError, match=problem):
        build_library(case, SPACING, tmp_path)
    assert not (tmp_path / "refused_library" / "library.json").exists()


CLOCK = RecordTimes(spacing=0.1, duration=1.0)


def wave(rows) -> FileWave:
    """A file wave of these times and velocities."""
    text = "\n".join(f"{time!r} {value!r}" for time, value in np.asarray(rows).tolist())
    return FileWave.model_validate({"type": "file", "path": "r.txt"}, context={"files": {"r.txt": text}})


def test_values_between_lines_are_on_straight_lines_and_begin_later_under_a_wave_at_an_angle():
    samples = np.array([[0.2, 0.0], [0.3, 2.0], [0.6, -4.0], [0.8, 0.0]])
    np.testing.assert_allclose(on_spacing(wave(samples), CLOCK), [0, 0, 0, 2, 0, -2, -4, -2, 0], atol=1e-14)
    # one as long as the library may end anyhow
    np.testing.assert_allclose(on_spacing(wave([[0.0, 0.0], [1.0, 5.0]]), CLOCK), np.arange(11) * 0.5)
    rows = [(0.0, 0.0), (0.2, 0.0), (0.3, 1.0), (0.4, 0.0)]
    assert on_spacing(wave(rows), CLOCK._replace(lead=2))[3] == 1.0
    with pytest.raises(ValueError, match=r"begins at 0\.2 s, but .* it must be 0 up to 0\.3 s"):
        on_spacing(wave(rows), CLOCK._replace(lead=3))


@pytest.fixture
def files(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ("a", "b"):
        (tmp_path / f"{name}.txt").write_text(f"0 0\n0.1 {len(name) + ord(name) - 97}\n0.2 0\n")
    (tmp_path / "bad.txt").write_text("0 1\n0.1 1\n0.2 0\n")


@pytest.mark.usefixtures("files")
def test_arguments_name_inputs_and_files():
    (record,) = read_records(["a.txt"], ["x"], CLOCK)
    assert record.name == "a"
    np.testing.assert_allclose(record.values["x"], [0.0, 1.0, 0.0])
    both, one = read_records(["x=a.txt,y=b.txt", "y=b.txt"], ["x", "y"], CLOCK)
    assert (both.name, one.name, set(one.values)) == ("a_b", "b", {"y"})
    np.testing.assert_allclose(both.values["y"], [0.0, 2.0, 0.0])
