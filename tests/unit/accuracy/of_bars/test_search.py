"""The cheapest choice within an error, of bars, beside d'Alembert's solution."""

import re
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from advised import Advised, advised
from estimated_bars import RICKER, recorded_of, scene, true_errors

from dembound.accuracy.choice import Choice
from dembound.accuracy.of_bars.options import BarOption
from dembound.accuracy.of_bars.search import MARGIN, Floors, first_echo
from dembound.bar.scene import BarScene, build_bar
from dembound.kinds import with_changes


def true_error(choice: Advised) -> float:
    """The largest RMS error over RMS of the run of a choice, beside the exact motion at the given case's nodes."""
    given, case = choice.given, choice.case
    places = {name: own.place for name, own in recorded_of(given)[0].items()}
    recorded = {name: replace(own, place=places[name]) for name, own in recorded_of(case)[0].items()}
    return max(error for own in recorded.values() for error in true_errors(case, own).values())


@pytest.mark.parametrize(
    ("name", "changes", "bound", "kept"),
    [
        ("finite differences, ν = 0.5", {}, 0.003, []),
        pytest.param("input, β = 0.8, m = 3", {"bar.spacing": 0.0025}, 0.03, ["bar", "run"], marks=pytest.mark.slow),
    ],
)
def test_the_choice_is_as_accurate_as_asked_for(
    name: str, changes: Mapping[str, Any], bound: float, kept: list[str]
) -> None:
    # expected errors are true ones within 3 % (test_causes.py), which the reserve of 5 % covers
    case = with_changes(scene(name), changes)

    choice = advised(case, bound, kept)

    assert choice.holds
    error = true_error(choice)
    assert error <= bound
    assert choice.error == pytest.approx(error, rel=0.03, abs=1e-4)
    for name in ("wave", "load", "monitor", "output"):
        assert getattr(choice.case, name) == getattr(case, name)


def test_the_cheapest_of_all_choices_is_taken() -> None:
    """At Courant number 1 coarse nodes are exact, but steps must resolve the corners of the wave."""
    case = scene("finite differences, ν = 0.9")

    choice = advised(case, 0.01)

    assert choice.case.run.courant == 1.0
    assert choice.case.bar.spacing == 2 * case.bar.spacing
    assert choice.cost < 0.5 * choice.own_cost
    assert choice.tried <= 10  # of some hundred


SPREAD = {"method": {"type": "peridynamics", "horizon": 3, "corrected_ends": True}, "load.hit.nodes": 3}


@pytest.mark.slow
def test_a_bar_of_peridynamics_that_cannot_break_is_taken_by_finite_differences() -> None:
    """Loads of finite differences act on the last node, where the surface is, and monitors remain at their places."""
    case = with_changes(scene("finite differences, ν = 0.9"), {"run": {"duration": 1.1e-3}, **SPREAD})

    choice = advised(case, 0.01)

    assert choice.holds
    assert choice.case.method.type == "finite_difference"
    assert choice.case.load[0].nodes == 1
    assert true_error(choice) <= 0.01
    other = advised(case, 0.01, ["load.hit.nodes", "boundary", "run"]).case
    assert other.method.type == "peridynamics"


@pytest.mark.slow
def test_two_rocks_get_nodes_of_equal_travel_times() -> None:
    """Finite differences near Courant number 1 are then exact in both rocks, except for whole numbers of nodes.

    Whole numbers make Δx/c differ a little, so that the bar may not run at the limit itself.
    """
    ranges = [{"name": "a", "length": 0.6}, {"name": "b", "length": 0.4, "wave_speed": 1400.0}]
    case = with_changes(scene("finite differences, ν = 0.9"), {"bar.range": ranges} | RICKER)

    choice = advised(case, 0.005)

    assert choice.holds
    ways = [part.length / part.cells / part.speed for part in choice.case.bar.parts]
    assert ways[1] == pytest.approx(ways[0], rel=0.1)
    assert choice.case.run.safety == 0.99
    assert true_error(choice) <= 0.005


def test_the_small_stress_beside_a_free_end_does_not_count() -> None:
    case = with_changes(scene("finite differences, ν = 0.9"), {"monitor.far.position": 1.0})
    choice = advised(case, 0.05, ["bar", "run"])
    shares = true_errors(case, recorded_of(case)[0]["far"])
    assert shares["stress"] > 0.05 > shares["velocity"]
    assert choice.holds
    assert choice.choice.toml == []


@pytest.mark.slow
def test_of_a_bar_that_may_break_finite_differences_are_named_where_its_method_does_not_do() -> None:
    changes = {**SPREAD, "bar.strength": 1e9, "boundary.right": {"type": "viscous"}}
    case = with_changes(scene("finite differences, ν = 0.9"), changes)

    choice = advised(case, 0.01)

    assert not choice.holds
    assert (choice.case.bar, choice.case.method) == (case.bar, case.method)
    said = r"; finite differences, loads on the last node, nodes every ([\d.]+) mm, .* have ([\d.]+) %"
    named = re.search(said, choice.words)
    assert named
    assert choice.words.endswith("break otherwise")
    other = {"bar.spacing": 1e-3 * float(named[1]), "method": {"type": "finite_difference"}, "load.hit.nodes": 1}
    finite = with_changes(case, {**other, "run": {"duration": 1.1e-3, "courant": 1.0}})
    error = true_error(choice._replace(choice=Choice.of(case, finite, "")))
    assert 0.01 * float(named[2]) == pytest.approx(error, rel=0.1)


def test_a_run_ends_once_nothing_returns_from_absorbing_ends() -> None:
    """Nothing remains of a pulse once it has left."""
    case = with_changes(scene("viscous end, β = 0.7"), {"run.duration": 0.004})
    choice = advised(case, 0.01, ["bar"])
    assert choice.holds
    assert choice.case.run.until == "silent"
    assert choice.cost < 0.5 * advised(case, 0.01, ["bar", "run.until"]).cost
    recorded = recorded_of(choice.case)[0]
    expected = float(choice.words.rpartition("about ")[2].removesuffix(" s"))
    # the run looks at its monitors some times only, and ends at the next of them
    assert next(iter(recorded.values())).time[-1] == pytest.approx(expected, rel=0.15)


FROM_THE_RIGHT: dict[str, Any] = {
    "load": [{"name": "hit", "side": "right", "pressure": 1e6, "wave": "pulse", "nodes": 2}],
    "boundary": {"left": {"type": "viscous"}},
}


def built(name: str, **changes: Any) -> BarScene:
    return build_bar(with_changes(scene(name), {key.replace("__", "."): value for key, value in changes.items()}))


def choice(name: str, courant: float, spacing: float = 0.01, ends: str = "dashpots", method: str = "") -> BarOption:
    return BarOption(built(name, bar__spacing=spacing), courant * spacing / 2740.0, {}, ends, method)


@pytest.fixture(scope="module")
def known() -> BarOption:
    return choice("viscous end", 0.5)


def floor(known: BarOption, other: BarOption, error: float = 0.3, without_echo: float = 0.0) -> float:
    floors = Floors()
    floors.add(known, error, without_echo)
    return floors.of(other)


def test_of_finer_nodes_they_fall_with_the_square_of_the_spacing(known: BarOption) -> None:
    assert floor(known, choice("viscous end", 0.5, 0.0025)) == pytest.approx(0.3 / 16 / MARGIN)
    assert floor(known, known) == pytest.approx(0.3 / MARGIN)
    # of coarser ones they are as large; other methods and Courant numbers say nothing; the largest of all counts
    assert floor(known, choice("viscous end", 0.5, 0.04)) == pytest.approx(0.3)
    assert floor(known, choice("viscous end", 0.6), without_echo=0.3) == 0.0
    assert floor(known, replace(known, method=", corrected ends"), without_echo=0.3) == 0.0
    floors = Floors()
    for error in (0.1, 0.4, 0.2):
        floors.add(known, error, 0.0)
    assert floors.of(known) == pytest.approx(0.4 / MARGIN)


def test_of_other_ends_only_what_is_wrong_before_an_echo_counts(known: BarOption) -> None:
    layers = replace(known, ends="layers")
    assert floor(known, layers) == 0.0
    assert floor(known, layers, without_echo=0.12) == pytest.approx(0.12 / MARGIN)
    finer, coarser = (choice("viscous end", 0.5, spacing, "layers") for spacing in (0.005, 0.04))
    assert floor(known, finer, without_echo=0.12) == pytest.approx(0.12 / 4 / MARGIN)
    assert floor(known, coarser, without_echo=0.12) == pytest.approx(0.12 / MARGIN)


@pytest.mark.parametrize(
    ("name", "changes", "ways"),
    [
        ("viscous end", {}, {"near": 1.8, "far": 1.2}),
        ("viscous ends, loaded", {}, {"near": 0.2, "far": 0.8}),  # the left end is loaded, and absorbs
        ("wall", {}, {"near": np.inf, "far": np.inf}),
        ("viscous end", FROM_THE_RIGHT, {"near": 1.19, "far": 1.79}),
        # beyond 0.6 m at half the speed
        ("ranges", {"boundary.right": {"type": "viscous"}}, {"near": 1.4 + 1.2, "far": 1.4 + 0.4}),
    ],
)
def test_the_first_echo_takes_the_way_to_the_end_and_back(
    name: str, changes: dict[str, Any], ways: dict[str, float]
) -> None:
    case = with_changes(scene(name), changes)
    assert first_echo(build_bar(case)) == pytest.approx({key: way / 2740.0 for key, way in ways.items()})
