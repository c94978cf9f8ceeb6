"""Enlarged scenes: their size, their contents, and cases without them."""

from pathlib import Path

import numpy as np
import pytest
from scene_tables import grains, monitors
from small_cases import around

from dembound.accuracy.judge import extended
from dembound.disks.scene import build
from dembound.errors import CaseError
from dembound.kinds import checked, load
from dembound.running import plan

GRIP = {"type": "velocity", "wave_p": "pulse"}
WAVE = {"wave_p": "pulse"}
BASE = {"type": "viscous_input", **WAVE}
FIELD = {"motion.held": [], "run.duration": 0.02, "packing.size": [10.0, 5.0]}
HOLE = {"name": "tunnel", "type": "circle", "centre": [6.0, 3.0], "radius": 0.8}
BLOW = {"name": "blow", "force": [1e5, 0.0], "position": [3.1, 2.2], "wave": "pulse"}
REGION = {"name": "wide", "force": [1e5, 0.0], "region": [1.0, 1.0, 3.0, 2.0], "wave": "pulse"}
SPRINGS = {"type": "viscoelastic", "source": [3.25, 2.25]}


@pytest.fixture
def field(bar):
    """Makes cases: a field with a hole, two loads and sides that are all artificial but the top."""

    def make(changes=None):
        boundary = {"left": {"type": "viscous"}, "right": SPRINGS, "bottom": {"type": "roller"}}
        own = {
            "hole": [HOLE],
            "load": [BLOW, REGION],
            "boundary": boundary,
            "monitor": monitors(a=(2.1, 4.0), b=(9.9, 0.1)),
        }
        return bar({**FIELD, **own, **(changes or {})}, "field")

    return make


def at(scene, nodes):
    """Place of particles, and the disk of the brick."""
    return scene.positions[nodes], scene.assembly.brick_particle[nodes]


@pytest.mark.parametrize("pattern", ["A", "B", "C"])
def test_all_stays_at_its_place_on_its_particles(field, pattern) -> None:
    random = grains(10.0, 5.0, 0.5, 5.0, 0, pattern) | {"brick": [5.0, 2.5]}
    case = field({} if pattern == "A" else {"packing": random})
    found = extended(case)
    small, large = build(case), build(checked(found.case))
    beyond = np.concatenate([small.low - large.low, large.low + large.size - small.low - small.size])

    assert (beyond[:3] > 0.0).all()
    assert beyond[3] == pytest.approx(0.0, abs=1e-9)  # the top is free
    bricks = beyond / np.tile(case.packing.brick_size, 2)
    np.testing.assert_allclose(bricks, np.rint(bricks), atol=1e-9)
    assert found.inside == case.packing.box
    for table in ("hole", "load", "boundary", "wave"):
        assert getattr(found.case, table) == getattr(case, table)
    assert found.case.monitor[0] == case.monitor[0]
    # in the lower right corner new disks of a random packing are nearer than its own
    assert (found.case.monitor[1] == case.monitor[1]) == (pattern != "B")
    for name, node in small.monitors.items():
        (here, twin), (there, its) = at(small, node), at(large, large.monitors[name])
        np.testing.assert_allclose(there, here, atol=1e-9)
        assert twin == its
    for table in ("drive", "drive_signal"):
        driven = getattr(small.supports, table), getattr(large.supports, table)
        np.testing.assert_allclose(np.sort(driven[0]), np.sort(driven[1]), rtol=1e-12)
    inside = ((large.positions > -1e-9) & (large.positions < small.size + 1e-9)).all(axis=1)
    assert np.count_nonzero(inside) >= small.count  # disks that the cut severed are connected again
    assert np.count_nonzero(inside) - small.count <= 0.02 * small.count


def test_other_sides_move_where_the_case_calls_them_artificial(bar) -> None:
    for side in ("roller", "free"):
        changes = {"boundary.left": GRIP, "run.duration": 0.05}
        own, stays, moves = (
            extended(bar(changes | {"boundary.right": {"type": side, **keys}})).case.packing.extent[0]
            for keys in ({}, {"artificial": False}, {"artificial": True})
        )
        assert stays == 10.0 < moves
        assert own == (stays if side == "free" else moves)


def test_sides_that_are_physical_stay(bar) -> None:
    found = extended(bar({"boundary.left": GRIP, "run.duration": 0.05}))
    tall = extended(bar({"motion.held": ["x"], "boundary": {"bottom": GRIP, "top": {"type": "viscous"}}}))
    wide, high = found.case.packing.extent
    assert high == 1.0
    # to the middle at 4.75 m and back within 0.05 s, over the side at X: 2X − 4.75 = 50 m and the precursor,
    # 10 (50 · 0.5²/8)^(1/3) = 11.6 m: X = 33.2 m, whole disks of 0.5 m
    middle = build(found.case).positions[build(found.case).monitors["middle"], 0]
    needed = 0.5 * (50.0 + 10.0 * np.cbrt(50.0 * 0.25 / 8.0) + middle)
    assert wide == pytest.approx(0.5 * np.ceil(2.0 * needed), rel=1e-12)
    assert middle == 4.75
    assert found.case.monitor[0].position == (5.0, 0.5)  # half-way to the next disk
    assert tall.case.packing.extent[0] == 10.0
    assert found.case.run.time_step == plan(bar({"boundary.left": GRIP})).time_step
    assert found.case.name == "bar_extended"


def test_a_scene_large_enough_is_left_alone_and_one_far_too_large_refused(bar) -> None:
    short, free = bar({"run.duration": 1e-3}), bar({"boundary": {"left": GRIP}})
    assert extended(short).case is short
    assert "nothing returns before 0.001 s" in extended(short).sentence
    assert extended(free).case is free

    changes = {"boundary.left": GRIP, "run.duration": 0.05}
    watched, unwatched = (extended(bar({**changes, **each})).case.packing.extent[0] for each in ({}, {"monitor": []}))
    # without monitors the farthest place is the right side, 10 m, in place of the middle
    assert unwatched == pytest.approx(watched + 0.5 * (10.0 - 4.75), abs=0.5)
    with pytest.raises(CaseError, match=r"run\.duration: is 10 s.* only in a scene of 50..(\.5)? m × 1 m with 20,1"):
        extended(bar({"boundary.left": GRIP, "run.duration": 10.0}), most=1000)
    instead = r".* packing\.size = \[30, 5\], packing\.origin = \[-4, 2\], no \[ground\]"
    said = r"^ground\.size: the scene cannot be extended, .* --reference finest," + instead
    ground = {"ground.size": [30.0, 5.0], "ground.origin": [-4.0, 2.0], "packing.origin": [6.0, 2.0]}
    with pytest.raises(CaseError, match=said):
        extended(bar({**FIELD, "boundary": around("outside"), "monitor": [], **ground}))


def test_where_waves_enter_a_side_stays_and_is_named(bar) -> None:
    found = extended(bar({"boundary.left": BASE, "run.duration": 0.05}))

    assert found.sentence.endswith(
        "from whose right nothing returns before 0.05 s; left stays, as waves enter there, and reflects as in the case"
    )
    with pytest.raises(CaseError, match=r"^boundary\.left: lets motion in"):
        extended(bar({"boundary": {"left": BASE}}))


def test_a_rock_bar_grows_beyond_its_absorbing_end(spalling) -> None:
    method = {"type": "finite_difference"}
    case = spalling({"boundary.right": {"type": "viscous"}, "method": method, "run.duration": 4e-3})
    found = extended(case)

    # there and back to 0.525 m from the inner end of the load, 0.05 m: 2X − 0.575 m = 4 m and the precursor
    needed = 0.5 * (4.0 + 10.0 * np.cbrt(4.0 * 0.025**2 / 8.0) + 0.575)
    assert found.case.bar.length == pytest.approx(0.025 * np.ceil(needed / 0.025), rel=1e-12)
    assert found.case.monitor[0].position == pytest.approx(0.525, rel=1e-12)
    other = spalling({"boundary.left": {"type": "viscous"}, "load.hit.side": "right", "run.duration": 4e-3})
    found = extended(other)
    longer, beyond = found.case, found.case.bar.length - 1.0
    assert longer.monitor[0].position - 0.525 == pytest.approx(beyond, rel=1e-12)
    assert found.inside == pytest.approx((beyond, 0.0, beyond + 1.0, 0.0))
    with pytest.raises(CaseError, match=r"^boundary\.left: lets motion in"):
        extended(spalling({"boundary.left": {"type": "viscous"}}))

    found = extended(load(Path(__file__).parents[3] / "cases" / "shpb.toml"))
    # of a bar of ranges the last one grows: from the striker's end at 0.2 m over the end to the gauge at 2.0126 m are
    # 3 m for an end at 2.606 m, beyond which only the precursor of the front counts
    lengths = [each.length for each in found.case.bar.range]
    assert lengths[:-1] == [0.2, 0.0017, 1.2, 0.0109]
    assert 2.606 < found.case.bar.length < 2.7
    assert found.case.bar.length == pytest.approx(sum(lengths), rel=1e-12)
    assert found.case.run.courant == 0.99  # as that of the case


def test_the_floor_of_a_slope_goes_on_beyond_a_continuum(bar) -> None:
    slope = {"name": "slope", "type": "polygon", "points": [[4.0, 11.0], [6.0, 6.0], [11.0, 6.0], [11.0, 11.0]]}
    weight = {"name": "weight", "acceleration": [0.0, -9.81]}
    blow = BLOW | {"position": [2.25, 9.75]}
    held = around("roller", "left", "right") | around("fixed", "bottom")
    changes = {"packing.size": [10.0, 10.0], "motion.held": [], "run.duration": 0.02, "monitor": []}
    changes |= {"boundary": around("outside"), "hole": [slope | {"stage": "after"}], "load": [blow, weight]}
    changes |= {"static": {"boundary": held}}
    larger = extended(bar(changes))
    made, (left, bottom, right, _) = build(larger.case), larger.case.packing.box

    assert right > 10.0
    assert max(left, bottom) < 0.0
    x, y = made.assembly.positions.T
    assert y[x > 6.0].max() < 6.0
    assert y[x < 4.0].max() > 9.5
    assert checked(larger.case).floors.keys() == {"right"}
    assert made.outside.levels["right"].surface == pytest.approx(6.0, abs=1e-9)
    assert not made.before.outside.levels
