"""Choices: parsed from options, combined, named, checked, and compared with the given case."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from small_cases import PUSHED, small

from dembound.accuracy.choice import (
    Choice,
    choices_of,
    combinations,
    differences,
    digest,
    in_toml,
    keeps,
    parsed_options,
    value_at,
)
from dembound.accuracy.reference import Reference, Requested, errors
from dembound.accuracy.runner import Run
from dembound.casefile.reader import parsed
from dembound.errors import CaseError
from dembound.formulas.history import History
from dembound.kinds import with_changes


def test_values_are_toml_or_plain_text() -> None:
    found = parsed_options(
        ['boundary.right={type="viscous", beta_p=0.5},{type="free"}', "run.safety=0.9,0.5", "material.law=a,b"]
    )
    assert found == {
        "boundary.right": [{"type": "viscous", "beta_p": 0.5}, {"type": "free"}],
        "run.safety": [0.9, 0.5],
        "material.law": ["a", "b"],
    }
    assert parsed_options(["packing.size=[1.0, 2.0],[3.0, 4.0]", 'title="a, b",c']) == {
        "packing.size": [[1.0, 2.0], [3.0, 4.0]],
        "title": ["a, b", "c"],
    }
    for options in (["run.safety"], ["=1"], ["run.safety="], ["a=1,,2"], ["a=1", "a=2"]):
        with pytest.raises(CaseError, match="--vary"):
            parsed_options(options)


def test_all_combinations_are_named_with_units(bar, spalling) -> None:
    named = combinations(
        bar(), {"packing.radius": [0.25, 0.5], "boundary.right": [{"type": "viscous", "beta_p": 0.5}, {"type": "free"}]}
    )
    assert list(named) == [
        "radius 0.25 m, boundary.right viscous (beta_p 0.5)",
        "radius 0.25 m, boundary.right free",
        "radius 0.5 m, boundary.right viscous (beta_p 0.5)",
        "radius 0.5 m, boundary.right free",
    ]
    assert named["radius 0.5 m, boundary.right free"] == {"packing.radius": 0.5, "boundary.right": {"type": "free"}}
    # keys with the same last name in full, whole tables by their type
    (name,) = combinations(bar(), {"boundary.left.beta_p": [0.5], "boundary.right.beta_p": [0.6]})
    assert name == "boundary.left.beta_p 0.5, boundary.right.beta_p 0.6"
    (name,) = combinations(spalling(), {"method": [{"type": "peridynamics", "horizon": 2}], "bar.spacing": [0.05]})
    assert name == "peridynamics (horizon 2), spacing 0.05 m"


def test_invalid_choices_are_left_out_with_a_line_each(bar) -> None:
    case = bar()
    choices, left_out = choices_of(case, combinations(case, {"packing.radius": [0.25, 0.3]}))
    assert [choice.name for choice in choices] == ["radius 0.25 m"]
    assert choices[0].case.packing.radius == 0.25
    (line,) = left_out
    assert line.startswith("radius 0.3 m: left out, packing.size: ")
    with pytest.raises(CaseError) as raised:
        choices_of(case, combinations(case, {"packing.radios": [1.0], "run.safety": [0.5, 0.9]}))
    names = [line.partition(": left out, packing.radios: ")[0] for line in raised.value.problems]
    assert names == ["radios 1, safety 0.5", "radios 1, safety 0.9"]
    # equal choices count once
    choices, _ = choices_of(case, {"as it is": {}, "twice the same": {}, "shorter": {"run.duration": 0.005}})
    assert [choice.name for choice in choices] == ["as it is", "shorter"]


def test_digests_differ_with_results_and_with_the_contents_of_files(bar, tmp_path) -> None:
    assert digest(bar()) == digest(bar({"chart": {"repeats": 7}, "title": "another"}))
    assert digest(bar()) != digest(bar({"run.duration": 0.011}))
    still = bar({"static.stress": [-1e5, -1e5, 0.0], "boundary": {}, "wave": {}, "material.fric": 0.5})
    assert digest(bar()) != digest(still)
    assert digest(still) == digest(replace(still, text=still.text + "\n[static.boundary]\n"))  # which says nothing more
    path, found = tmp_path / "wave.txt", []
    for crest in (1.0, 2.0):
        path.write_text(f"0.0 0.0\n0.005 {crest}\n0.01 0.0\n", encoding="utf-8")
        found.append(digest(bar({"wave.pulse": {"type": "file", "path": str(path)}})))
    assert found[0] != found[1]


DRIVEN = {"boundary": {"left": {"type": "velocity", "wave_p": "push"}, "right": {"type": "viscous"}}}

CHANGES: list[dict[str, Any]] = [
    {"boundary.right": {"type": "outside"}, "outside.accuracy": 0.01, "boundary.left": {"type": "outside"}},
    {"boundary.right": {"type": "viscous", "half_mass": True}},
    {"monitor.back.position": [9.1, 1.2], "packing.size": [12.0, 2.5]},
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
    assert not keeps(given, changed, ["boundary", "packing.radius"])


def gauge(samples: int, x: float = 1.0, y: float = 0.0, place: float = 0.0, after: float = 0.0) -> History:
    """A motion of a second along both axes with these factors; y is added to by `after` from 0.5 s on."""
    time = np.linspace(0.0, 1.0, samples)
    shape = np.sin(np.pi * time)
    motion = np.column_stack([x * shape, y * shape + after * (time > 0.5), 0.0 * time])
    return History.of(np.array([place, 0.0]), time, 2.0 * motion, motion, 3.0 * motion[:, 0])


@pytest.fixture
def compared(bar):
    """Compares gauges with those of a reference."""

    def compare(found, expected, until: float = np.inf, **requested):
        choice = Choice("it", {}, bar())
        reference = Reference("finest", "the finest", lambda choice, outcome: expected, until=until)
        return errors(choice, Run(motions=found), reference, Requested(**requested))

    return compare


def test_the_worst_monitor_comes_first(compared) -> None:
    found = compared(
        {"a": gauge(101, 1.1, place=3.0), "b": gauge(101, 1.2)}, {"a": gauge(101, place=2.5), "b": gauge(101)}
    )
    assert [(each.monitor, each.component) for each in found] == [("b", "x"), ("a", "x")]
    assert [each.rms for each in found] == pytest.approx([0.2, 0.1])
    assert [each.peak for each in found] == pytest.approx([0.2, 0.1])
    assert [each.apart for each in found] == [0.0, 0.5]
    assert compared({"a": gauge(101, place=0.1 + 0.2)}, {"a": gauge(101, place=0.3)})[0].apart == 0.0  # rounding


def test_the_finer_history_is_interpolated(compared) -> None:
    # between 11 samples a sine that is interpolated is up to (π/10)²/8 = 1.2 % too small; at the samples it is exact
    assert compared({"a": gauge(11)}, {"a": gauge(1001)})[0].rms < 1e-12
    assert compared({"a": gauge(1001)}, {"a": gauge(11)})[0].rms < 1e-12


def test_the_component_is_that_of_the_reference_or_the_one_asked_for(compared) -> None:
    mine, theirs = {"a": gauge(101, 9.0, 1.5)}, {"a": gauge(101, 0.9, 1.0)}
    assert compared(mine, theirs)[0].rms == pytest.approx(0.5)
    assert compared(mine, theirs, component="x")[0].rms == pytest.approx(9.0)
    for quantity, component in (("displacement", "x"), ("stress", "stress")):
        (found,) = compared({"a": gauge(101, 1.1)}, {"a": gauge(101)}, quantity=quantity)
        assert (found.component, found.rms) == (component, pytest.approx(0.1))


def test_quiet_monitors_are_left_out_but_not_if_asked_for(compared) -> None:
    mine, theirs = {"a": gauge(101, 1.1), "far": gauge(101, 0.005)}, {"a": gauge(101), "far": gauge(101, 0.001)}
    assert [each.monitor for each in compared(mine, theirs)] == ["a"]
    assert compared(mine, theirs, monitor="far")[0].rms == pytest.approx(4.0)


def test_histories_are_compared_up_to_the_first_spall(compared) -> None:
    mine, theirs = {"a": gauge(101, 0.0, 1.1, after=5.0)}, {"a": gauge(101, 0.0, 1.0)}
    assert compared(mine, theirs)[0].rms > 1.0
    assert compared(mine, theirs, until=0.5)[0].rms == pytest.approx(0.1)
    # what moves later does not choose monitors and components either
    late = gauge(101, 1.0, after=50.0)  # along y from 0.5 s on
    found = compared({"a": gauge(101, 1.1), "b": gauge(101, 1.2)}, {"a": late, "b": gauge(101)}, until=0.5)
    assert [(each.monitor, each.component) for each in found] == [("b", "x"), ("a", "x")]
    for still, until in ((gauge(101), 0.0), (gauge(101, 0.0), np.inf)):
        with pytest.raises(CaseError, match="zero in the reference"):
            compared({"a": gauge(101)}, {"a": still}, until=until)
