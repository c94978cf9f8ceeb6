"""Reading and writing cases: valid ones, the message for every mistake, changed ones and their text."""

import re
import tomllib
from pathlib import Path

import pytest
from small_cases import problems_in, problems_of, rows

from dembound.casefile import to_toml
from dembound.casefile.reader import DEEPEST, parsed, value_of
from dembound.casefile.types import PACKINGS
from dembound.errors import CaseError
from dembound.kinds import load, loads, with_changes
from dembound.starting import starting_point
from dembound.table import name_of

PATTERNS = ", ".join(sorted(f'"{name_of(packing)}"' for packing in PACKINGS))

GOOD = """\
title = "short bar"
motion.held = ["y"]
output.snapshots = 3
[packing]
pattern = "A"
size = [10, 5.0]
radius = 0.25
[material]
density = 2500
p_wave_speed = 1000.0
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
output.snapshots = 3 | output.pictures = "yes" | output.pictures: is "yes", must be true or false
position = [0.0, 5.0] | position = [1] | monitor[1, P1].position: is [1], must be a list of 2 values, each a number (m)
position = [0.0, 5.0] | position = [0, inf] | monitor[1, P1].position: is [0, Infinity], must be finite
# choices
density = 2500 | density = 2500\nlaw = "glue" | material.law: is "glue", must be one of "
held = ["y"] | held = ["y", "y"] | motion.held: names a motion twice, must name each once
duration = 0.1 | duration = 0.1\ntime_step = -1 | run.time_step: is -1, must be a number greater than 0 or "auto" (s)
# keys and tables
duration = 0.1 |  | run.duration: is missing, must be a number greater than 0 (s)
duration = 0.1 | duration = 0.1\nq = 1 | run.q: unknown key; allowed: duration, time_step, safety
[boundary.right] | [boundary.rigth] | boundary.rigth: unknown side; allowed: left, right, bottom, top (did you mean righ
output.s | outputs.s | outputs: unknown table; allowed: title, ground, packing, material, damping, motion, outside
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
    text = GOOD + '[[monitor]]\nname = "P2"\n'
    for old, new in (
        ("radius = 0.25", "radius = -0.25\nradios = 1"),
        ("duration = 0.1", 'duration = "long"'),
        ('wave_p = "pulse"', 'wave_p = "pulze"'),
        ("period = 0.05", "period = 0"),
        ('name = "P1"', 'name = "P1"\nplace = 1'),
        ('title = "short bar"', "title = []"),
    ):
        text = text.replace(old, new)
    places = ["title:", "packing.radius:", "packing.radios:", "run.duration:", "wave.pulse.period:", "monitor[1,"]
    assert [line.split(" ")[0] for line in problems_of(text)] == [*places, "monitor[2,", "boundary.left.wave_p:"]


def test_a_case_of_neither_disks_nor_a_bar_is_asked_what_it_is() -> None:
    line = (
        "has neither [bar] (a bar) nor [packing] (disks); `dembound new --from rock_bar` and `dembound new` write a "
        "case to start from"
    )
    assert problems_of("") == [line]
    # what else it holds cannot be judged, but for tables that no case has
    mistyped, said = problems_of(GOOD.replace("[packing]", "[pakcing]").replace("density", "densitty"))
    assert mistyped.startswith("pakcing: ")
    assert mistyped.endswith("(did you mean packing?)")
    assert said == line
    missing = ["packing.pattern", "material.density", "run.duration"]
    assert [text.split(":")[0] for text in problems_of("[packing]")] == missing


def test_a_file_gives_name_and_folder_and_unreadable_ones_are_named(tmp_path: Path) -> None:
    path, binary = tmp_path / "long.bar.toml", tmp_path / "binary.toml"
    path.write_text(GOOD, encoding="utf-8")
    binary.write_bytes(b"\xff\xfe")
    case = load(path)
    assert (case.name, case.folder, case.text) == ("long.bar", tmp_path, GOOD)
    assert case == loads(GOOD)
    wrong = {
        tmp_path / "absent.toml": "no such file",
        tmp_path: "cannot be read",
        binary: "is not a text file in UTF-8",
    }
    for each, line in wrong.items():
        with pytest.raises(CaseError, match=f"^{re.escape(f'{each}: {line}')}"):
            load(each)


def test_wave_files_are_looked_for_beside_the_case_and_found_from_another_folder(tmp_path: Path) -> None:
    here, there = tmp_path / "cases", tmp_path / "results"
    for folder in (here, there):
        folder.mkdir()
    (here / "quake.txt").write_text("0 0\n1 3\n2 0\n")
    text = GOOD.replace('type = "cosine"\namplitude = -0.5\nperiod = 0.05', 'type = "file"\npath = "quake.txt"')
    case = loads(text, here)
    assert case.wave["pulse"].peak() == 3.0
    assert problems_of(text, there) == [f'wave.pulse.path: no file "{there / "quake.txt"}"']
    written = to_toml(case, there)
    (there / "copy.toml").write_text(written, encoding="utf-8")
    assert load(there / "copy.toml").wave["pulse"].peak() == 3.0
    assert tomllib.loads(written)["wave"]["pulse"]["path"] == "../cases/quake.txt"


def refusal(text: str) -> list[str]:
    return problems_in(lambda: parsed(text, "bar.toml"))


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
    with pytest.raises(CaseError, match="has a number of more than 4000 digits") as caught:
        parsed(f"a = {'9' * 5000}", "bar.toml")
    assert caught.value.source == "bar.toml"
    with pytest.raises(CaseError, match="has a number of more than 4000 digits") as caught:
        value_of("9" * 5000, "--set a")
    assert caught.value.source == "--set a"


def test_a_mistake_in_the_syntax_comes_with_its_line_and_a_date_with_its_place() -> None:
    assert refusal("a = 1\nb = \x00\n") == ["line 2: Invalid value, in: b = \\x00"]
    assert len(refusal(f"a = {'x' * 1000}")[0]) < 200
    assert refusal("a = '\udcff'") == ["has characters that are not text in UTF-8"]
    said = "is a date or time, must be a number, a text, true or false, a list or a table"
    assert refusal("[a]\nb = [1, 2020-01-01]\nc = 10:00:00") == [f"a.c: {said}", f"a.b[2]: {said}"]


STARTER = starting_point()


def test_nothing_changed_is_the_same_case_with_its_comments() -> None:
    case = loads(STARTER)
    assert with_changes(case, {}) == loads(to_toml(with_changes(case, {}))) == case
    assert to_toml(case) == to_toml(case, Path("elsewhere")) == STARTER


def test_none_leaves_a_key_out() -> None:
    case = with_changes(loads(STARTER), {"boundary.left.beta_p": 0.81, "static": {"stress": [-1e6, -1e6, 0.0]}})
    assert with_changes(case, {"boundary.left.beta_p": None, "static": None}) == loads(STARTER)
    assert with_changes(case, {"material.fric": None}) == case  # which it does not have
    assert with_changes(case, {"monitor.1": None}).monitor == case.monitor[1:]


def test_changes_replace_and_add_keys_and_touch_nothing_else() -> None:
    case = loads(STARTER, Path("here"), "bar")
    right, tap = {"type": "fixed"}, {"type": "ricker", "amplitude": 1.0, "frequency": 2.0}
    changes = {"boundary.left.beta_p": 0.81, "run.duration": 2, "boundary.right": right}
    changed = with_changes(case, changes | {f"wave.tap.{key}": value for key, value in tap.items()})
    assert (changed.boundary["left"].beta_p, changed.boundary["right"].type) == (0.81, "fixed")
    assert (changed.run.duration, changed.wave["tap"].peak()) == (2.0, 1.0)
    assert (changed.name, changed.folder) == ("bar", Path("here"))
    before = tomllib.loads(case.text)
    before["boundary"]["left"]["beta_p"] = 0.81
    before["boundary"]["right"], before["run"]["duration"], before["wave"]["tap"] = right, 2, tap
    assert tomllib.loads(changed.text) == before

    undone = {"boundary.left.beta_p": "matched", "run.duration": 0.3, "boundary.right": {"type": "viscous"}}
    assert with_changes(changed, undone | {"wave.tap": None}) == case
    assert changed != case
    settled = with_changes(case, {"static.stress": [-1e6, -1e6, 0.0], "static.boundary.bottom.type": "roller"})
    assert settled.static.boundary["bottom"].type == "roller"


NAMED = {
    "load": [{"name": "weight", "acceleration": [-9.81, 0.0]}, {"name": "1", "acceleration": [1.0, 0.0]}],
    "hole": [{"name": "pit", "type": "circle", "centre": [50.0, 5.0], "radius": 1.0}],
}


def test_tables_of_lists_go_by_name_or_by_number() -> None:
    case = with_changes(loads(STARTER), NAMED)
    changes = {"load.weight.acceleration": [-1.0, 0.0], "monitor.1.position": [3.0, 2.5], "hole.pit.radius": 2.0}
    changed = with_changes(case, changes | {"load.2.acceleration": [2.0, 0.0]})
    assert [load.acceleration for load in changed.load] == [(-1.0, 0.0), (2.0, 0.0)]
    assert [(monitor.name, monitor.position) for monitor in changed.monitor] == [("middle", (3.0, 2.5))]
    assert changed.hole[0].radius == 2.0
    # a name comes before a number, and a new name is known from then on
    assert with_changes(case, {"load.1.name": "push"}).load[1].name == "push"
    renamed = with_changes(case, {"load.weight.name": "heavy", "load.heavy.acceleration": [-2.0, 0.0]})
    assert (renamed.load[0].name, renamed.load[0].acceleration) == ("heavy", (-2.0, 0.0))
    whole = {"name": "gauge", "position": [1.0, 2.5]}
    assert with_changes(case, {"monitor.middle": whole}).monitor[0].name == "gauge"


def test_keys_that_lead_nowhere_are_refused() -> None:
    no_key = "is no key, must be names with one dot between two, such as run.duration"
    case = with_changes(loads(STARTER), NAMED)
    for key, line in (
        ("load.wieght.acceleration", "unknown load; allowed: weight, 1 (did you mean weight?), or a number up to 2"),
        ("load.3.acceleration", "unknown load; allowed: weight, 1, or a number up to 2"),
        ("monitor.0", "unknown monitor; allowed: middle, or a number up to 1"),
        ("packing.size.0", "size is not a table"),
        ("title.size", "title is not a table"),
        *((key, no_key) for key in ("..", "run.", "")),
    ):
        assert problems_in(lambda key=key: with_changes(case, {key: 3})) == [f"{key}: {line}"]
    with pytest.raises(CaseError, match=r"monitor\.middle\.position: monitor is not a table"):
        with_changes(loads(STARTER), {"monitor": [], "monitor.middle.position": [1.0, 1.0]})
    with pytest.raises(CaseError, match=r"boundary\.left\.beta_p: is -1"):
        with_changes(loads(STARTER), {"boundary.left.beta_p": -1})
