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


def test_the_starter_case_is_valid() -> None:
    case = loads(STARTER)

    assert case.boundary["left"].wave_p in case.wave
    # the pulse and its reflection from the far end pass the middle monitor within the run
    way = 1.5 * case.packing.size[0] / case.material.p_wave_speed + case.wave["pulse"].duration()
    assert way <= case.run.duration


def test_nothing_changed_is_the_same_case() -> None:
    case = loads(STARTER)
    assert with_changes(case, {}) == case
    assert loads(to_toml(with_changes(case, {}))) == case


def test_none_leaves_a_key_out() -> None:
    case = with_changes(loads(STARTER), {"boundary.left.beta_p": 0.81, "static": {"stress": [-1e6, -1e6, 0.0]}})
    assert with_changes(case, {"boundary.left.beta_p": None, "static": None}) == loads(STARTER)
    assert with_changes(case, {"material.fric": None}) == case  # which it does not have
    assert [each.name for each in with_changes(case, {"monitor.1": None}).monitor] == [
        each.name for each in case.monitor[1:]
    ]


def test_changes_replace_and_add_keys_and_touch_nothing_else() -> None:
    case = loads(STARTER, Path("here"), "bar")
    right = {"type": "fixed"}

    changed = with_changes(case, {"boundary.left.beta_p": 0.81, "run.duration": 2, "boundary.right": right})

    assert changed.boundary["left"].beta_p == 0.81
    assert changed.boundary["right"].type == "fixed"
    assert changed.run.duration == 2.0
    assert (changed.name, changed.folder) == ("bar", Path("here"))
    before, after = tomllib.loads(case.text), tomllib.loads(changed.text)
    before["boundary"]["left"]["beta_p"] = 0.81
    before["boundary"]["right"] = right
    before["run"]["duration"] = 2
    assert after == before
    undone = {"boundary.left.beta_p": "matched", "run.duration": 0.3, "boundary.right": {"type": "viscous"}}
    assert with_changes(changed, undone) == case
    assert changed != case


def test_changes_make_tables_that_are_not_there() -> None:
    changed = with_changes(
        loads(STARTER),
        {"boundary.top.type": "fixed", "wave.tap.type": "ricker"}
        | {"wave.tap.amplitude": 1.0, "wave.tap.frequency": 2.0},
    )
    assert changed.boundary["top"].type == "fixed"
    assert changed.wave["tap"].peak() == 1.0


def test_changes_reach_tables_inside_tables() -> None:
    changed = with_changes(
        loads(STARTER), {"static.stress": [-1e6, -1e6, 0.0], "static.boundary.bottom.type": "roller"}
    )
    assert changed.static.boundary["bottom"].type == "roller"
    with pytest.raises(CaseError, match=r'static\.boundary\.bottom\.type: is "viscous", must be one of'):
        with_changes(changed, {"static.boundary.bottom.type": "viscous"})


def test_a_change_within_a_table_given_as_a_whole_leaves_that_one_alone() -> None:
    push = {"type": "cosine", "amplitude": 1.0, "period": 0.1}
    changed = with_changes(loads(STARTER), {"wave.pulse": push, "wave.pulse.period": 0.2})

    assert changed.wave["pulse"].period == 0.2
    assert push["period"] == 0.1


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


@pytest.mark.parametrize(
    ("key", "line"),
    [
        (
            "load.wieght.acceleration",
            "unknown load; allowed: weight, 1 (did you mean weight?), or a number up to 2",
        ),
        ("load.3.acceleration", "unknown load; allowed: weight, 1, or a number up to 2"),
        ("monitor.0", "unknown monitor; allowed: middle, or a number up to 1"),
        ("packing.size.0", "size is not a table"),
        ("packing.size.0.x", "size is not a table"),
        ("..", "is no key, must be names with one dot between two, such as run.duration"),
        ("run.", "is no key, must be names with one dot between two, such as run.duration"),
        ("", "is no key, must be names with one dot between two, such as run.duration"),
    ],
)
def test_keys_that_lead_nowhere_are_refused(key: str, line: str) -> None:
    with pytest.raises(CaseError) as caught:
        with_changes(loads(STARTER + NAMED), {key: 3})
    assert caught.value.problems == [f"{key}: {line}"]


def test_no_table_of_an_empty_list_can_be_changed() -> None:
    with pytest.raises(CaseError, match=r"monitor\.middle\.position: monitor is not a table"):
        with_changes(loads(STARTER), {"monitor": [], "monitor.middle.position": [1.0, 1.0]})


def test_wrong_changes_are_refused_like_wrong_files() -> None:
    case = loads(STARTER)
    with pytest.raises(CaseError, match=r"boundary\.left\.beta_p: is -1"):
        with_changes(case, {"boundary.left.beta_p": -1})
    with pytest.raises(CaseError, match="title is not a table"):
        with_changes(case, {"title.size": 3})


def test_the_text_keeps_its_comments() -> None:
    case = loads(STARTER)
    assert to_toml(case) == STARTER
    assert to_toml(case, Path("elsewhere")) == STARTER


def test_wave_files_are_found_from_another_folder(tmp_path: Path) -> None:
    (tmp_path / "cases").mkdir()
    (tmp_path / "results").mkdir()
    (tmp_path / "cases" / "quake.txt").write_text("0 0\n1 3\n2 0\n")
    case = loads(STARTER + RECORD, tmp_path / "cases")

    text = to_toml(case, tmp_path / "results")
    (tmp_path / "results" / "copy.toml").write_text(text, encoding="utf-8")

    assert load(tmp_path / "results" / "copy.toml").wave["quake"].peak() == 3.0
    assert tomllib.loads(text)["wave"]["quake"]["path"] == "../cases/quake.txt"
