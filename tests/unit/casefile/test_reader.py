"""Reading cases: valid ones, and the message for every mistake."""

import re
from pathlib import Path

import pytest
from small_cases import problems_of, rows

from dembound.casefile.reader import DEEPEST, parsed, value_of
from dembound.casefile.types import PACKINGS
from dembound.errors import CaseError
from dembound.kinds import load, loads
from dembound.table import name_of

PATTERNS = ", ".join(sorted(f'"{name_of(packing)}"' for packing in PACKINGS))

GOOD = """\
title = "short bar"
[packing]
pattern = "A"
size = [10, 5.0]
radius = 0.25
[material]
density = 2500
p_wave_speed = 1000.0
[motion]
held = ["y"]
[boundary.right]
type = "viscous"
[boundary.left]
type = "viscous_input"
wave_p = "pulse"
[wave.pulse]
type = "cosine"
amplitude = -0.5
period = 0.05
[[monitor]]
name = "P1"
position = [0.0, 5.0]
[run]
duration = 0.1
[output]
snapshots = 3
"""


def problem(old: str, new: str) -> str:
    """The one line that a change of the good case is refused with."""
    assert GOOD.count(old) == 1
    (line,) = problems_of(GOOD.replace(old, new))
    return line


MISTAKES = r"""
# values out of limits
radius = 0.25 | radius = -0.25 | packing.radius: is -0.25, must be greater than 0
duration = 0.1 | duration = inf | run.duration: is inf, must be finite
duration = 0.1 | duration = 0.1\nsafety = 1.5 | run.safety: is 1.5, must be at most 1
amplitude = -0.5 | amplitude = 0.0 | wave.pulse.amplitude: is 0, must not be 0
# values of the wrong kind
type = "viscous"\n | type = "viscous"\nbeta_p = -1\n | boundary.right.beta_p: is -1, must be a number no less than 0 or
density = 2500 | density = "2500" | material.density: is "2500", must be a number greater than 0 (kg/m³)
snapshots = 3 | snapshots = 3.0 | output.snapshots: is 3.0, must be a whole number no less than 0
snapshots = 3 | pictures = "yes" | output.pictures: is "yes", must be true or false
position = [0.0, 5.0] | position = [1] | monitor[1, P1].position: is [1], must be a list of 2 values, each a number (m)
position = [0.0, 5.0] | position = [0, inf] | monitor[1, P1].position: is [0, Infinity], must be finite
# choices
[motion] | law = "glue"\n[motion] | material.law: is "glue", must be one of "
held = ["y"] | held = ["y", "y"] | motion.held: names a motion twice, must name each once
duration = 0.1 | duration = 0.1\ntime_step = -1 | run.time_step: is -1, must be a number greater than 0 or "auto" (s)
# keys and tables
duration = 0.1 |  | run.duration: is missing, must be a number greater than 0 (s)
duration = 0.1 | duration = 0.1\nq = 1 | run.q: unknown key; allowed: duration, time_step, safety
[boundary.right] | [boundary.rigth] | boundary.rigth: unknown side; allowed: left, right, bottom, top (did you mean righ
[output] | [outputs] | outputs: unknown table; allowed: title, ground, packing, material, damping, motion, outside
[[monitor]] | [monitor] | monitor: is a table, must be a list of tables, each [[monitor]] in TOML
# messages of the tables themselves
size = [10, 5.0] | size = [10.1, 5.0] | packing.size:
wave_p = "pulse"\n |  | boundary.left: names no wave;
name = "P1" | name = "P/1" | monitor[1, P/1].name: is "P/1", must be made of the letters A-Z and a-z, digits, "_", "-" a
"""


@pytest.mark.parametrize(("old", "new", "line"), rows(MISTAKES))
def test_each_mistake_gets_one_plain_line(old: str, new: str, line: str) -> None:
    assert problem(old, new).startswith(line)


def test_choices_and_near_keys_are_named() -> None:
    assert problem('pattern = "A"', 'pattern = "D"') == f'packing.pattern: is "D", must be one of {PATTERNS}'
    mistyped, missing = problems_of(GOOD.replace('pattern = "A"', 'patern = "A"'))
    assert mistyped.startswith("packing.patern: unknown key; ")
    assert mistyped.endswith("(did you mean pattern?)")
    assert missing == f"packing.pattern: is missing, must be one of {PATTERNS}"
    assert problem("duration = 0.1", "duration = 0.1\ntimstep = 1").endswith("(did you mean time_step?)")


def test_all_mistakes_of_all_tables_are_listed_at_once() -> None:
    text = (
        GOOD.replace("radius = 0.25", "radius = -0.25\nradios = 1")
        .replace("duration = 0.1", 'duration = "long"')
        .replace('wave_p = "pulse"', 'wave_p = "pulze"')
        .replace("period = 0.05", "period = 0")
        .replace('name = "P1"', 'name = "P1"\nplace = 1')
        + '[[monitor]]\nname = "P2"\n'
    )

    found = [line.split(" ")[0] for line in problems_of(text.replace('title = "short bar"', "title = []"))]

    assert found == [
        "title:",
        "packing.radius:",
        "packing.radios:",
        "run.duration:",
        "wave.pulse.period:",
        "monitor[1,",
        "monitor[2,",
        "boundary.left.wave_p:",
    ]


def test_a_case_of_neither_disks_nor_a_bar_is_asked_what_it_is() -> None:
    (line,) = problems_of("")
    assert line == (
        "has neither [bar] (a bar) nor [packing] (disks); `dembound new --from rock_bar` and `dembound new` write a "
        "case to start from"
    )
    # what else it holds cannot be judged, but for tables that no case has
    found = problems_of(GOOD.replace("[packing]", "[pakcing]").replace("density", "densitty"))
    assert [text.split(":")[0] for text in found] == ["pakcing", line]
    assert found[0].endswith("(did you mean packing?)")
    missing = ["packing.pattern", "material.density", "run.duration"]
    assert [text.split(":")[0] for text in problems_of("[packing]")] == missing


def test_a_file_gives_name_and_folder_and_unreadable_ones_are_named(tmp_path: Path) -> None:
    path = tmp_path / "long.bar.toml"
    path.write_text(GOOD, encoding="utf-8")
    case = load(path)
    assert (case.name, case.folder, case.text) == ("long.bar", tmp_path, GOOD)
    assert case == loads(GOOD)

    binary = tmp_path / "binary.toml"
    binary.write_bytes(b"\xff\xfe")
    for path, line in (
        (tmp_path / "absent.toml", "no such file"),
        (tmp_path, "cannot be read"),
        (binary, "is not a text file in UTF-8"),
    ):
        with pytest.raises(CaseError, match=f"^{re.escape(f'{path}: {line}')}"):
            load(path)


def test_wave_files_are_looked_for_beside_the_case(tmp_path: Path) -> None:
    (tmp_path / "quake.txt").write_text("0 0\n1 3\n2 0\n")
    text = GOOD.replace('type = "cosine"\namplitude = -0.5\nperiod = 0.05', 'type = "file"\npath = "quake.txt"')

    assert loads(text, tmp_path).wave["pulse"].peak() == 3.0
    (line,) = problems_of(text, tmp_path / "elsewhere")
    assert line == f'wave.pulse.path: no file "{tmp_path / "elsewhere" / "quake.txt"}"'


def refusal(text: str) -> list[str]:
    with pytest.raises(CaseError) as caught:
        parsed(text, "bar.toml")
    assert caught.value.source == "bar.toml"
    return caught.value.problems


def test_tables_and_values_are_read() -> None:
    assert parsed("a = 1\n[b]\nc = [1.5, 'x']") == {"a": 1, "b": {"c": [1.5, "x"]}}
    assert [value_of(text, "--set a") for text in ("1", "1e3", "true", "[1, 2]", '"x"', " plain text ", "a b")] == [
        *(1, 1e3, True, [1, 2], "x", "plain text", "a b")
    ]


def test_nesting_has_an_end() -> None:
    for depth in (DEEPEST + 1, 2000):
        for text in (f"a = {'[' * depth}{']' * depth}", f"a{'.a' * depth} = 1"):
            (line,) = refusal(text)
            assert f"is nested more than {DEEPEST} deep" in line
        with pytest.raises(CaseError, match="is nested more than"):
            value_of(f"{'[' * depth}{']' * depth}", "--set a")
    assert parsed(f"a = {'[' * (DEEPEST - 1)}{']' * (DEEPEST - 1)}")


def test_numbers_have_a_length() -> None:
    assert refusal(f"a = {'9' * 5000}") == ["has a number of more than 4000 digits"]
    with pytest.raises(CaseError, match="has a number of more than 4000 digits") as caught:
        value_of("9" * 5000, "--set a")
    assert caught.value.source == "--set a"


def test_a_mistake_in_the_syntax_comes_with_its_line_and_a_date_with_its_place() -> None:
    assert refusal("a = 1\nb = \x00\n") == ["line 2: Invalid value, in: b = \\x00"]
    assert len(refusal(f"a = {'x' * 1000}")[0]) < 200
    assert refusal("a = '\udcff'") == ["has characters that are not text in UTF-8"]
    said = "is a date or time, must be a number, a text, true or false, a list or a table"
    assert refusal("[a]\nb = [1, 2020-01-01]\nc = 10:00:00") == [f"a.c: {said}", f"a.b[2]: {said}"]
