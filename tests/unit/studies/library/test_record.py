"""Records for a library."""

import numpy as np
import pytest

from dembound.errors import CaseError
from dembound.studies.library import RecordTimes, read_records
from dembound.studies.library.library import on_spacing
from dembound.waves import FileWave

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


@pytest.mark.parametrize(
    ("rows", "problem"),
    [
        ([(-0.1, 0.0), (0.1, 1.0), (0.2, 0.0)], "begins at -0.1 s, must not begin before 0"),
        ([(0.0, 0.0), (0.1, 1.0), (1.1, 0.0)], "lasts 1.1 s, the library only 1 s"),
        ([(0.0, 0.0), (0.15, 1.0), (0.3, 0.0)], "has a value at 0.15 s, no whole multiple of the library's spacing"),
        ([(0.0, 0.0), (0.1, 1.0), (0.10000001, 2.0), (0.2, 0.0)], "has values closer than the library's spacing"),
        ([(0.0, 0.5), (0.1, 1.0), (0.2, 0.0)], "begins with 0.5, must begin with 0"),
        ([(0.0, 0.0), (0.1, 1.0), (0.2, 0.25)], "ends with 0.25 before the library does, must end with 0"),
    ],
)
def test_what_no_library_responds_to_is_said(rows, problem):
    with pytest.raises(ValueError, match=problem):
        on_spacing(wave(rows), CLOCK)


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


@pytest.mark.usefixtures("files")
@pytest.mark.parametrize(
    ("arguments", "inputs", "problems"),
    [
        (["a.txt"], ["x", "y"], ["RECORD: is a.txt, must be INPUT=FILE, or several with commas between; inputs: x, y"]),
        (["x=a.txt,x=b.txt"], ["x", "y"], ["RECORD: x=a.txt,x=b.txt: names the input x twice"]),
        (["bad.txt", "none.txt"], ["x"], [
            "bad.txt: begins with 1, must begin with 0; put a line with 0 before it",
            'no file "none.txt"',
        ]),
        (["a.txt", "x=a.txt"], ["x"], ["RECORD: two records are called a, so one would replace the other"]),
    ],
)  # fmt: skip
def test_each_mistake_has_its_line(arguments, inputs, problems):
    with pytest.raises(CaseError) as raised:
        read_records(arguments, inputs, CLOCK)
    assert raised.value.problems == problems
