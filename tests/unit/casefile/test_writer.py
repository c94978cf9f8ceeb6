"""Changed cases and the text they are written as."""

import tomllib
from pathlib import Path

import pytest

from dembound.casefile import to_toml
from dembound.errors import CaseError
from dembound.kinds import load, loads, with_changes
from dembound.starting import starting_point

STARTER = starting_point()

RECORD = '[wave.quake]\ntype = "file"\npath = "quake.txt"\n'


def test_nothing_changed_is_the_same_case_with_its_comments() -> None:
    case = loads(STARTER)
    assert with_changes(case, {}) == loads(to_toml(with_changes(case, {}))) == case
    assert to_toml(case) == to_toml(case, Path("elsewhere")) == STARTER


def test_none_leaves_a_key_out() -> None:
    case = with_changes(loads(STARTER), {"boundary.left.beta_p": 0.81, "static": {"stress": [-1e6, -1e6, 0.0]}})
    assert with_changes(case, {"boundary.left.beta_p": None, "static": None}) == loads(STARTER)
    assert with_changes(case, {"material.fric": None}) == case  # which it does not have
    assert [each.name for each in with_changes(case, {"monitor.1": None}).monitor] == [
        each.name for each in case.monitor[1:]
    ]


def test_changes_replace_and_add_keys_and_touch_nothing_else() -> None:
    case = loads(STARTER, Path("here"), "bar")
    right, tap = {"type": "fixed"}, {"type": "ricker", "amplitude": 1.0, "frequency": 2.0}
    changes = {"boundary.left.beta_p": 0.81, "run.duration": 2, "boundary.right": right}
    changed = with_changes(case, changes | {f"wave.tap.{key}": value for key, value in tap.items()})
    assert changed.boundary["left"].beta_p == 0.81
    assert changed.boundary["right"].type == "fixed"
    assert changed.run.duration == 2.0
    assert changed.wave["tap"].peak() == 1.0
    assert (changed.name, changed.folder) == ("bar", Path("here"))
    before, after = tomllib.loads(case.text), tomllib.loads(changed.text)
    before["boundary"]["left"]["beta_p"] = 0.81
    before["boundary"]["right"] = right
    before["run"]["duration"] = 2
    before["wave"]["tap"] = tap
    assert after == before

    undone = {"boundary.left.beta_p": "matched", "run.duration": 0.3, "boundary.right": {"type": "viscous"}}
    assert with_changes(changed, undone | {"wave.tap": None}) == case
    assert changed != case
    settled = with_changes(case, {"static.stress": [-1e6, -1e6, 0.0], "static.boundary.bottom.type": "roller"})
    assert settled.static.boundary["bottom"].type == "roller"


NAMED = """
[[load]]
name = "weight"
acceleration = [-9.81, 0.0]
[[load]]
name = "1"
acceleration = [1.0, 0.0]
[[hole]]
name = "pit"
type = "circle"
centre = [50.0, 5.0]
radius = 1.0
"""


def test_tables_of_lists_go_by_name_or_by_number() -> None:
    case = loads(STARTER + NAMED)
    changed = with_changes(
        case,
        {"load.weight.acceleration": [-1.0, 0.0], "monitor.1.position": [3.0, 2.5], "hole.pit.radius": 2.0}
        | {"load.2.acceleration": [2.0, 0.0]},
    )
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
    for key, line in (
        ("load.wieght.acceleration", "unknown load; allowed: weight, 1 (did you mean weight?), or a number up to 2"),
        ("load.3.acceleration", "unknown load; allowed: weight, 1, or a number up to 2"),
        ("monitor.0", "unknown monitor; allowed: middle, or a number up to 1"),
        ("packing.size.0", "size is not a table"),
        ("title.size", "title is not a table"),
        *((key, no_key) for key in ("..", "run.", "")),
    ):
        with pytest.raises(CaseError) as caught:
            with_changes(loads(STARTER + NAMED), {key: 3})
        assert caught.value.problems == [f"{key}: {line}"]
    with pytest.raises(CaseError, match=r"monitor\.middle\.position: monitor is not a table"):
        with_changes(loads(STARTER), {"monitor": [], "monitor.middle.position": [1.0, 1.0]})
    with pytest.raises(CaseError, match=r"boundary\.left\.beta_p: is -1"):
        with_changes(loads(STARTER), {"boundary.left.beta_p": -1})


def test_wave_files_are_found_from_another_folder(tmp_path: Path) -> None:
    (tmp_path / "cases").mkdir()
    (tmp_path / "results").mkdir()
    (tmp_path / "cases" / "quake.txt").write_text("0 0\n1 3\n2 0\n")
    case = loads(STARTER + RECORD, tmp_path / "cases")

    text = to_toml(case, tmp_path / "results")
    (tmp_path / "results" / "copy.toml").write_text(text, encoding="utf-8")

    assert load(tmp_path / "results" / "copy.toml").wave["quake"].peak() == 3.0
    assert tomllib.loads(text)["wave"]["quake"]["path"] == "../cases/quake.txt"
