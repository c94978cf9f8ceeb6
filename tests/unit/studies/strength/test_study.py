"""Factors of safety and yield accelerations: what is reduced and refused, how numbers are bracketed, what fails."""

from math import inf, radians, tan

import numpy as np
import pytest
from small_cases import PUSHED, SOIL, problems_in, small

from dembound.disks.scene import build
from dembound.errors import CaseError
from dembound.studies.strength.study import Search, measure, require_strengths, weaker
from dembound.studies.strength.trial import FALL, MOVES, NO_REST, REST, Places, Tried

CUT = {
    "packing": {"pattern": "B", "size": [12.0, 6.0], "radius": 0.35, "radius_ratio": 1.5, "brick": [6.0, 6.0]},
    "material": {"density": 2000.0, "law": "linearpbond", "emod": 2e8, "pb_emod": 2e8}
    | {"fric": 0.5, "pb_ten": 5e4, "pb_coh": 5e4},
    "hole": [{"name": "cut", "type": "polygon", "points": [[6.0, 2.0], [13.0, 2.0], [13.0, 7.0], [6.0, 7.0]]}],
    "load": [{"name": "weight", "acceleration": [0.0, -9.81]}],
    "static": {"boundary": {"bottom": {"type": "fixed"}, "left": {"type": "roller"}, "right": {"type": "roller"}}},
    "boundary": {"bottom": {"type": "fixed"}},
    "run": {"duration": 0.1},
}
"""A vertical cut of 4 m in two bricks of bonded disks."""


def test_all_strengths_are_divided_and_of_the_friction_angle_the_tangent() -> None:
    given = {"law": "linearpbond", "pb_ten": 4e5, "pb_coh": 8e5, "pb_fa": 30.0}
    layers = [{"thickness": 4.0, "fric": 0.8, "pb_fa": 45.0, "pb_ten": 2e5}, {"s_wave_speed": 300.0}]
    case = small(SOIL, changes={"layer": layers} | {f"material.{key}": value for key, value in given.items()})
    upper, lower = weaker(case, 4.0).materials

    assert (upper.fric, upper.pb_ten, upper.pb_coh) == (0.2, 5e4, 2e5)
    assert (lower.fric, lower.pb_ten, lower.pb_coh) == (0.125, 1e5, 2e5)
    assert tan(radians(upper.pb_fa)) == pytest.approx(0.25)
    assert tan(radians(lower.pb_fa)) == pytest.approx(0.25 * tan(radians(30.0)))
    assert [each.pb_emod for each in (upper, lower)] == [each.pb_emod for each in case.materials]


@pytest.mark.parametrize("true", [0.3, 1.0, 3.7, 1e-9, 1e9])
def test_a_number_is_bracketed_within_its_limits(true) -> None:
    search = Search("number", "1")
    search.bisect(lambda x: Tried(x, REST if x <= true else MOVES, 0.0, 0, False, 0, 1), (1.0, 1 / 64, 64.0), 0.02)

    assert search.stands <= true < search.fails
    if 1 / 64 < true < 64.0:
        assert search.fails - search.stands <= 0.02 * search.value
        assert len(search.tried) <= 10
    else:
        assert (search.stands, search.fails) in ((0.0, 1 / 64), (64.0, inf))


def test_what_cannot_fail_or_has_no_weight_is_refused() -> None:
    require_strengths(small(CUT))
    for changes, said in (
        ({"material": PUSHED["material"]}, 'material.law: is "elastic", under which nothing breaks or slides'),
        ({"material": PUSHED["material"] | {"law": "linearpbond"}}, "material.fric: is 0, and bonds have no strength"),
        ({"static": None}, "static: is missing"),
        ({"load": [{"name": "pull", "acceleration": [1.0, 0.0]}]}, "load: has no weight, which --strength needs"),
    ):
        case = small(CUT, changes=changes)
        (line,) = problems_in(lambda case=case: require_strengths(case))
        assert line.startswith(said)
        assert ("--set material.law=linearpbond --set material.pb_ten=" in line) == line.startswith("material.law")
    with pytest.raises(CaseError, match="--tolerance: is 0, must be from"):
        measure(small(CUT), 0.0)


def test_more_than_a_hundredth_of_the_disks_half_a_diameter_from_their_elastic_places_are_a_failure() -> None:
    scene = build(small(CUT, changes={"packing.radius": 0.25}))
    count, diameter = scene.disk_count, scene.ground.brick.mean_diameter
    few, still = count // 100, np.zeros((2, count))
    moved = np.zeros((3, count))
    moved[1, :few] = -0.51 * diameter
    assert not Places(scene, still).has_failed(moved)
    moved[0, few] = 0.51 * diameter
    assert Places(scene, still).has_failed(moved)
    assert not Places(scene, moved[:2]).has_failed(moved)
    soft = still.copy()
    soft[1, -1] = -0.3 * diameter  # twice that is more than half a diameter
    assert not Places(scene, soft).has_failed(moved)
    assert Places(scene, soft).has_failed(1.2 * moved)


@pytest.fixture(scope="module")
def cut():
    """The strength of the cut, in coarse brackets."""
    return measure(small(CUT), 0.2)


def test_twice_the_strengths_have_exactly_twice_the_factor(cut) -> None:
    """Trials are the same bodies: halves and doubles of F, and the strengths over them, are exact numbers."""
    twice = {f"material.{key}": 2.0 * CUT["material"][key] for key in ("fric", "pb_ten", "pb_coh")}
    (safety, *_), (double, *_) = cut.searches, measure(small(CUT, changes=twice), 0.2).searches

    assert (double.stands, double.fails) == (2.0 * safety.stands, 2.0 * safety.fails)
    ends = {each.value: (each.ended, each.broken, each.steps) for each in safety.tried}
    shared = [each for each in double.tried if 0.5 * each.value in ends]
    assert len(shared) >= 3
    assert all(ends[0.5 * each.value] == (each.ended, each.broken, each.steps) for each in shared)


def test_the_cut_fails_towards_its_face_and_what_ended_trials_is_told(cut) -> None:
    safety, right, left = cut.searches
    assert 0.0 < right.value < 0.5 * left.value
    assert cut.holds
    assert all(each.has_jumped == (each.ended == MOVES) for search in cut.searches for each in search.tried)
    assert {each.ended for each in safety.tried} <= {REST, MOVES, NO_REST}
    standing = [each for each in safety.tried if each.stands]
    assert all(each.moved < 0.25 for each in standing)
    assert "left and right hold the body along x in the static stage, and bear a part of the push" in cut.words
    head, *rows = cut.rows
    assert len(rows) == sum(len(search.tried) for search in cut.searches)
    assert all(len(row) == len(head) for row in rows)


def test_what_falls_is_said_to_fall_and_is_not_pushed() -> None:
    weak = {"material.pb_ten": 5e3, "material.pb_coh": 5e3}
    damped = {"material.dp_nratio": 0.2, "layer": [{"thickness": 2.0}, {}]}  # which the elastic state is without
    found = measure(small(CUT, changes=weak | damped), 0.5)
    (safety,) = found.searches
    assert not found.holds
    assert 0.0 < safety.stands < safety.fails <= 1.0
    assert found.words[-1] == "no yield acceleration: the body does not stand at full strength"
    assert np.isfinite([each.moved for each in safety.tried]).all()


def test_a_body_that_nothing_holds_sideways_has_a_factor_alone() -> None:
    smooth = {"static.boundary.bottom": {"type": "roller"}, "static.boundary.left": None}
    found = measure(small(CUT, changes=smooth | {"static.boundary.right": None, "motion.held": ["rotation"]}), 0.5)
    assert len(found.searches) == 1
    assert "static.boundary: nothing holds the body along x against load[2, push]" in found.words[-1]


@pytest.mark.slow
def test_one_disk_that_falls_out_of_the_scene_is_no_failure() -> None:
    """The last one of the upper row, below which there is nothing: its contact with the row is without force."""
    rows = {
        "packing": {"pattern": "A", "size": [15.0, 2.0], "radius": 0.25},
        "material": {"density": 2500.0, "p_wave_speed": 1000.0, "contact_share": 1.0, "fric": 0.5}
        | {"law": "linearpbond"},
        "hole": [{"name": "gap", "type": "polygon", "points": [[14.5, 0.0], [15.0, 0.0], [15.0, 1.5], [14.5, 1.5]]}],
    }
    found = measure(small(CUT | rows, changes={"static.boundary": {"bottom": {"type": "fixed"}}}), 1.0)
    first = found.searches[0].tried[0]
    assert (first.ended, first.left, first.stands) == (FALL, 1, True)
    assert found.words[-1].startswith("no yield acceleration: single disks go on falling")
