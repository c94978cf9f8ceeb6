"""Keys and values in which a changed case differs from a given one."""

from typing import Any

import pytest
from small_cases import PUSHED, small

from dembound.accuracy.choice import differences, in_toml, keeps, value_at
from dembound.casefile.reader import parsed
from dembound.errors import CaseError
from dembound.kinds import with_changes

DRIVEN = {"boundary": {"left": {"type": "velocity", "wave_p": "push"}, "right": {"type": "viscous"}}}

CHANGES: list[dict[str, Any]] = [
    {"packing.radius": 0.125},
    {"boundary.right": {"type": "outside"}, "outside.accuracy": 0.01, "boundary.left": {"type": "outside"}},
    {"boundary.right": {"type": "viscous", "half_mass": True}},
    {"monitor.back.position": [9.1, 1.2], "packing.size": [12.0, 2.5]},
    {"packing": {"pattern": "A", "bricks": [40, 10], "radius": 0.125}},
]


@pytest.mark.parametrize("changes", CHANGES)
def test_differences_make_the_changed_case_of_the_given_one(changes: dict[str, Any]) -> None:
    given = small(PUSHED)
    changed = with_changes(given, changes)
    found = differences(given, changed)
    assert found
    assert with_changes(given, found) == changed


def test_tables_and_lists_are_replaced_as_a_whole_or_left_out() -> None:
    assert differences(small(PUSHED), small(PUSHED)) == {}
    given = small(PUSHED | {"motion": {"held": ["y"]}, "wave": {"push": PUSHED["wave"]["push"]}} | DRIVEN)
    changed = with_changes(given, {"motion": None})
    found = differences(given, changed)
    assert found == {"motion": None}
    assert with_changes(given, found) == changed
    assert in_toml(found) == ["motion: left out"]
    changed = with_changes(small(PUSHED), {"boundary.left": {"type": "outside"}})
    assert differences(small(PUSHED), changed) == {"boundary.left": {"type": "outside"}}
    load = {"name": "hit", "force": [1.0, 0.0], "position": [5.0, 1.2], "wave": "push"}
    given, changed = small(PUSHED | {"load": [load]}), small(PUSHED | {"load": [load | {"name": "blow"}]})
    assert differences(given, changed) == {"load": [load | {"name": "blow"}]}
    values = {"a": {"type": "outside", "x": 0.1}, "b": [1.5, 2.0], "c": True, "d": "é"}
    assert parsed("\n".join(in_toml(values))) == values


def test_values_are_found_by_name_by_number_and_by_default() -> None:
    case = small(PUSHED)
    assert value_at(case, "monitor.back.position") == value_at(case, "monitor.2.position") == [9.6, 1.2]
    assert value_at(case, "run.safety") == 0.9
    for key in ("packing.radios", "monitor.3", "packing.radius.x", "nothing"):
        with pytest.raises(CaseError, match=f"--keep: {key} is no key"):
            value_at(case, key)


def test_kept_keys_keep_their_values() -> None:
    given = small(PUSHED)
    changed = with_changes(given, {"packing.radius": 0.125})
    assert keeps(given, changed, ["boundary", "packing.size"])
    assert not keeps(given, changed, ["packing"])
    assert not keeps(given, changed, ["boundary", "packing.radius"])
