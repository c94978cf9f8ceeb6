"""A scene that is moved as a whole moves alike, and `check` says the same of it but for places.

Every key that is a place is moved, by the meaning of keys, so that a new one is, too. Scenes then have zero inside of
their width and above all of their height, so that an axis, a sign or a plane taken at zero is seen; all lengths are
binary fractions.

Constants of contacts are those of the brick, wherever it is, and have the same bits. What is computed from coordinates
X, as the shape functions of a continuum at its ties, delays of waves and distances from sources, is rounded by ε X,
over at least a radius R that it varies in. n steps add up to n ε X/R.
"""

import re
from dataclasses import astuple

import numpy as np
import pytest
import tomli_w
from translated import translated

from dembound.accuracy.runner import measure
from dembound.boundaries import SIDES, normal_axis
from dembound.check import check
from dembound.disks.memory import SceneSizes
from dembound.disks.rest.settled import Blocks
from dembound.disks.scene import build
from dembound.disks.sources import sources_of
from dembound.kinds import loads
from dembound.motion.endings import silent_rule
from dembound.running import Progress

BY = (-18.5, -35.5)
RADIUS = 0.25
OF_THE_MACHINE = ("memory", "disk", "estimated time")
"""Facts that another moment does not repeat."""

LATTICE = {"pattern": "A", "radius": RADIUS}
DENSE = {"pattern": "B", "radius": RADIUS, "radius_ratio": 1.5, "brick": [5.0, 5.0], "seed": 1}
FRAMED = DENSE | {"pattern": "C", "edge_radius": 0.26}
OUTSIDE = {side: {"type": "outside"} for side in SIDES}
HALF_SPACE = {side: OUTSIDE[side] for side in SIDES[:3]}
AT_REST = {"boundary": {"left": {"type": "roller"}, "right": {"type": "roller"}, "bottom": {"type": "fixed"}}}
WEIGHT = {"name": "weight", "acceleration": [0.0, -9.81]}
BLOW = {"name": "blow", "force": [0.0, -1e6], "position": [3.1, 7.9], "wave": "pulse"}
WIDE = {"name": "wide", "force": [1e5, 0.0], "region": [1.0, 1.0, 3.0, 2.1], "wave": "pulse"}
BLAST = {"name": "blast", "pressure": 1e6, "hole": "tunnel", "wave": "pulse"}


SCENES = {
    "dashpots": {
        "packing": LATTICE | {"size": [12.0, 8.0]},
        "boundary": {
            **{"left": {"type": "viscous"}, "bottom": {"type": "roller"}},
            "right": {"type": "viscoelastic", "source": [4.3, 5.2]},
        },
        "hole": [{"name": "tunnel", "type": "circle", "centre": [8.1, 3.0], "radius": 1.2}],
        "load": [BLOW, WIDE, BLAST],
        "monitor": [[2.2, 4.1], [11.9, 0.3]],
        "run": {"duration": 0.2, "until": "silent"},
    },
    "free field": {
        "packing": DENSE | {"size": [10.0, 10.0]},
        "boundary": {
            **{"left": {"type": "free_field"}, "right": {"type": "free_field"}},
            "bottom": {"type": "viscous_input", "wave_s": "pulse"},
        },
        "hole": [{"name": "cut", "type": "polygon", "points": [[4.2, 9.0], [5.8, 9.0], [5.0, 7.1]]}],
        "static": AT_REST,
        "load": [WEIGHT],
        "monitor": [[2.2, 6.1], [9.0, 0.3]],
    },
    "box in the ground": {
        "packing": FRAMED | {"size": [10.0, 10.0], "origin": [10.0, 10.0]},
        "ground": {"size": [30.0, 30.0]},
        "boundary": OUTSIDE | {"bottom": {"type": "outside", "wave_s": "pulse"}},
        "outside": {"element": 2.5, "margin": 1},
        "hole": [{"name": "tunnel", "type": "ellipse", "centre": [15.0, 15.0], "semi_axes": [1.5, 1.2]}],
        "load": [BLOW | {"position": [12.1, 17.9]}],
        "monitor": [[17.2, 14.1], [14.0, 24.0], [8.1, 15.0]],
        "run": {"duration": 0.03},
    },
    "wave at an angle": {
        "packing": LATTICE | {"size": [8.0, 6.0]},
        "boundary": HALF_SPACE,
        "outside": {"element": 2.0},
        "incident": {"type": "sv", "angle": -20.0, "wave": "pulse"},
        "hole": [{"name": "step", "type": "rectangle", "corners": [3.0, 4.0, 5.0, 7.0]}],
        "monitor": [[2.2, 4.1], [-1.4, 3.0], [0.0, 2.2]],
        "run": {"duration": 0.03},
    },
    "periodic": {
        "packing": DENSE | {"size": [5.0, 10.0]},
        "boundary": {
            **{"left": {"type": "periodic"}, "right": {"type": "periodic"}, "top": {"type": "viscous"}},
            "bottom": {"type": "velocity", "wave_p": "pulse"},
        },
        "monitor": [[2.2, 4.1], [4.9, 9.3]],
    },
    "slope under its weight": {
        "packing": LATTICE | {"size": [12.0, 8.0]},
        "boundary": HALF_SPACE,
        "outside": {"element": 2.0},
        "hole": [{"name": "slope", "type": "polygon", "points": [[4.0, 9.0], [6.0, 4.0], [13.0, 4.0], [13.0, 9.0]]}],
        "static": AT_REST,
        "load": [WEIGHT, BLOW],
        "monitor": [[2.2, 4.1], [13.2, 2.0]],
        "run": {"duration": 0.03},
    },
}
IN_CI = ("dashpots", "box in the ground", "wave at an angle")
"""Scenes that together have all keys that are places, and sides of most kinds."""
NAMES = [name if name in IN_CI else pytest.param(name, marks=pytest.mark.slow) for name in SCENES]


def case_of(name: str):
    tables = {
        **{"material": {"density": 2500.0, "p_wave_speed": 1000.0, "fric": 0.5}, "motion": {"held": []}},
        **{"wave": {"pulse": {"type": "cosine", "amplitude": 0.5, "period": 0.01}}, "run": {"duration": 0.02}},
        **SCENES[name],
        "output": {"pictures": False},
    }
    tables["monitor"] = [{"name": f"m{k}", "position": place} for k, place in enumerate(SCENES[name]["monitor"])]
    return loads(tomli_w.dumps(tables), name=name.replace(" ", "_"))


def in_place(text: str) -> str:
    """A text of `check` without coordinates."""
    return re.sub(r"\(-?[\d.]+, -?[\d.]+\)|y = -?[\d.]+", "place", text)


@pytest.mark.parametrize("name", NAMES)
def test_a_scene_moves_alike_wherever_it_is(name) -> None:
    case = case_of(name)
    moved = translated(case, BY)
    own, other = (measure(each, Progress())[0] for each in (case, moved))
    farthest = max(np.hypot(*np.abs(box).reshape(2, 2).max(axis=0)) for box in map(np.array, (case.box, moved.box)))

    assert (own.time_step, own.steps) == (other.time_step, other.steps)
    for monitor, history in own.motions.items():
        there = other.motions[monitor]
        np.testing.assert_allclose(there.place, np.add(history.place, BY), rtol=0.0, atol=1e-13 * farthest)
        for quantity, values in history.values.items():
            near = own.steps * np.finfo(float).eps * farthest / RADIUS * np.abs(values).max()
            assert 0.0 < near < 1e-9 * np.abs(values).max()
            np.testing.assert_allclose(there.values[quantity], values, rtol=0.0, atol=near)


@pytest.mark.parametrize("name", NAMES)
def test_check_says_the_same_but_for_places(name) -> None:
    case = case_of(name)
    (facts, warnings), (there, warned) = check(case), check(translated(case, BY))

    assert [in_place(line) for line in warned] == [in_place(line) for line in warnings]
    assert facts.keys() == there.keys()
    for key in facts.keys() - set(OF_THE_MACHINE):
        assert in_place(there[key]) == in_place(facts[key])


@pytest.mark.parametrize("name", SCENES)
def test_what_is_built_has_the_same_sides_sources_and_blocks(name) -> None:
    own, other = (build(each) for each in (case_of(name), translated(case_of(name), BY)))
    (sources, moved), near = (sources_of(each.case, each.ground) for each in (own, other)), {"rtol": 0.0, "atol": 1e-12}

    assert SceneSizes.expected(other.case) == SceneSizes.expected(own.case)
    for side in SIDES:
        assert other.plane(side) == pytest.approx(own.plane(side) + BY[normal_axis(side)], abs=1e-12)
        if side in own.edges:
            np.testing.assert_array_equal(other.edges[side].nodes, own.edges[side].nodes)
    assert other.sides.keys() == own.sides.keys()
    for side, nodes in own.tied.items():
        np.testing.assert_array_equal(other.tied[side], nodes)
    np.testing.assert_allclose(other.positions, own.positions + BY, **near)
    for monitor, place in own.monitored.items():
        np.testing.assert_allclose(other.monitored[monitor], place + BY, **near)
    for one, another in zip(sources, moved, strict=True):
        np.testing.assert_allclose(another.box, np.add(one.box, np.tile(BY, 2)), **near)
        np.testing.assert_allclose((another.start, another.over), (one.start, one.over), **near)
    rules = silent_rule(own, sources), silent_rule(other, moved)
    assert astuple(rules[1]) == pytest.approx(astuple(rules[0]), rel=1e-12)
    np.testing.assert_allclose(Blocks.of(other).low, Blocks.of(own).low + BY, **near)
