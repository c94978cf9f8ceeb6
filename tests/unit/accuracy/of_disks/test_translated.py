"""Quantities derived from places of a case, without a run, do not change if the case is moved as a whole."""

from dataclasses import replace

import numpy as np
import pytest
from small_cases import Tables, small
from translated import translated

from dembound.accuracy.judge import extended
from dembound.accuracy.of_disks.arrangements import _with_monitors, box_tables, boxes
from dembound.accuracy.of_disks.coarser import coarser
from dembound.accuracy.of_disks.exact import problem_of
from dembound.accuracy.of_disks.exact.lamb import LambProblem
from dembound.casefile import Case
from dembound.disks.scene import build
from dembound.kinds import checked, with_changes

BY = np.array([-37.5, -11.25])
"""m, not of whole diameters."""

LAMB: Tables = {
    "packing": {"pattern": "A", "size": [40.0, 30.0], "radius": 0.5},
    "material": {"density": 2500.0, "p_wave_speed": 300.0, "fric": 0.5},
    "boundary": {"left": {"type": "symmetry"}, "right": {"type": "viscous"}, "bottom": {"type": "viscous"}},
    "wave": {"pulse": {"type": "cubic_spline", "amplitude": 1.0, "period": 0.1}},
    "load": [{"name": "hammer", "force": [0.0, -2e5], "position": [0.0, 30.0], "wave": "pulse"}],
    "monitor": [{"name": "receiver", "position": [10.5, 30.0]}, {"name": "other", "position": [25.5, 30.0]}],
    "run": {"duration": 0.15},
}
SOURCE = {"type": "viscoelastic", "source": [20.0, 2.0]}
FORCE = LAMB | {
    "boundary": {"left": SOURCE, "right": {"type": "viscous"}, "bottom": {"type": "viscous"}},
    "load": [{"name": "hammer", "force": [0.0, -2e5], "position": [20.0, 30.0], "wave": "pulse"}],
}
BLAST = FORCE | {
    "hole": [{"name": "shaft", "type": "circle", "centre": [16.0, 14.0], "radius": 2.5}],
    "load": [{"name": "blast", "pressure": 1e6, "hole": "shaft", "wave": "pulse"}],
}


@pytest.fixture(params=[LAMB, FORCE, BLAST], ids=["symmetry", "force", "blast"])
def both(request) -> tuple[Case, Case]:
    case = small(request.param)
    return case, translated(case, tuple(BY))


def places_of(case) -> np.ndarray:
    """All places of a case (k, 2) m."""
    values = [each.position for each in (*case.monitor, *case.load) if each.position is not None]
    values += [load.region for load in case.load if load.region is not None]
    values += [hole.box for hole in case.hole] + [case.packing.box, case.box]
    return np.concatenate([np.reshape(value, (-1, 2)) for value in values])


def test_the_same_scene_is_extended_by_as_much(both) -> None:
    own, other = (extended(case) for case in both)

    assert own.case.packing.copies == other.case.packing.copies
    np.testing.assert_array_equal(places_of(other.case), places_of(own.case) + BY)
    assert other.sentence == own.sentence
    everywhere, there = (extended(replace(case, monitor=())).case.packing for case in both)
    assert everywhere.copies == there.copies


def test_larger_disks_are_at_the_same_places(both) -> None:
    """In ground that is not a whole number of cells, so that places move with its sides."""
    wide = {"name": "wide", "force": [1e5, 0.0], "region": [3.0, 3.0, 9.0, 7.0], "wave": "pulse"}
    case = with_changes(both[0], {"packing.size": [41.0, 31.0], "load": [wide]})
    own, other = (coarser(each, build(each), 1e-4, 1.3).case for each in (case, translated(case, tuple(BY))))

    assert own.size[1] != pytest.approx(31.0, rel=1e-3)

    np.testing.assert_allclose(places_of(other), places_of(own) + BY, rtol=0.0, atol=1e-12)


def test_exact_solutions_are_as_far_from_loads_and_hold_as_long(both) -> None:
    own, other = (problem_of(build(case)) for case in both)

    assert type(own) is type(other)
    assert own.until == pytest.approx(other.until, rel=1e-12)
    if isinstance(own, LambProblem):
        assert isinstance(other, LambProblem)
        assert other.away == own.away
        assert own.load.force == (4e5 if both[0].side("left").is_mirror else 2e5)
    else:
        assert other.blast.surface == own.blast.surface + BY[1]


@pytest.mark.parametrize("height", [20.0, 50.0])
def test_boxes_and_their_tables_are_in_the_ground_at_its_place(height) -> None:
    """Boxes deep in the ground, and boxes so near its surface that the disks reach up to it."""
    shaft = BLAST["hole"][0] | {"centre": [16.0, height]}
    case = small(BLAST | {"packing": BLAST["packing"] | {"size": [80.0, 60.0]}, "hole": [shaft], "monitor": []})
    watched = with_changes(case, {"monitor": [{"name": "corner", "position": [79.7, 59.7]}]})
    moved = translated(case, tuple(BY))
    own, other = (list(boxes(build(each))) for each in (case, moved))

    assert own
    assert [each[1:] for each in own] == [each[1:] for each in other]
    for one, another in zip(own, other, strict=True):
        np.testing.assert_array_equal(another.box, np.add(one.box, np.tile(BY, 2)))
        both = ((watched, one.box), (translated(watched, tuple(BY)), another.box))
        wide, there = (_with_monitors(*each) for each in both)
        np.testing.assert_array_equal(there, np.add(wide, np.tile(BY, 2)))
    tables, given = box_tables(moved, other[-1].box), box_tables(case, own[-1].box)
    assert tables.keys() == given.keys()
    assert ("boundary.top" in tables) == (height == 20.0)
    assert tables["ground"] == {"size": [80.0, 60.0], "origin": BY.tolist()}
    assert given["ground"] == {"size": [80.0, 60.0]}
    packing = {f"packing.{key}": value for key, value in tables.pop("packing").items()}
    made = checked(with_changes(moved, tables | packing))
    assert made.box == moved.box
    assert build(made).outside is not None
