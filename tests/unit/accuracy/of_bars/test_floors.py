"""Lower bounds of the errors of choices for a bar, from errors of others."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from estimated_bars import scene

from dembound.accuracy.of_bars.options import BarOption
from dembound.accuracy.of_bars.search import MARGIN, Floors, first_echo, is_regular
from dembound.bar.scene import BarScene, build_bar
from dembound.casefile.bar import BarCase
from dembound.kinds import with_changes

PLACES = {"near": 0.2, "far": 0.8}
FROM_THE_RIGHT: dict[str, Any] = {
    "load": [{"name": "hit", "side": "right", "pressure": 1e6, "wave": "pulse", "nodes": 2}],
    "boundary": {"left": {"type": "viscous"}},
}


def built(name: str, **changes: Any) -> BarScene:
    case = with_changes(scene(name), {key.replace("__", "."): value for key, value in changes.items()})
    assert isinstance(case, BarCase)
    return build_bar(case)


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
    ("name", "courant", "regular"),
    [
        ("finite differences, ν = 0.5", 0.97, True),  # √0.95 = 0.975
        ("finite differences, ν = 0.5", 0.98, False),
        ("m = 1, soft ends", 1.0, False),
        ("m = 3, soft ends", 1.0, True),  # waves do not disperse at √5, above the limit 1.96
        ("switch", 1.0, False),  # begins with finite differences
        ("m = 3, soft ends", 2.19, False),
    ],
)
def test_near_the_courant_number_without_dispersion_errors_vary(name: str, courant: float, regular: bool) -> None:
    assert is_regular(choice(name, courant), PLACES) == regular


def test_monitors_elsewhere_make_errors_irregular() -> None:
    assert is_regular(choice("viscous end", 0.5, 0.05), PLACES)
    assert not is_regular(choice("viscous end", 0.5, 0.05), PLACES | {"far": 0.79})
    assert not is_regular(choice("viscous end", 0.5, 1.0 / 16), PLACES)


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
    assert isinstance(case, BarCase)
    assert first_echo(build_bar(case)) == pytest.approx({key: way / 2740.0 for key, way in ways.items()})
