"""What a run's monitors need, by hand."""

import pytest
from translated import translated

from dembound.kinds import loads
from dembound.motion.proposals import proposals
from dembound.running import plan

GRIP = {"type": "velocity", "wave_p": "pulse"}
LONG = {"packing.size": [100.0, 1.0], "boundary.left": GRIP, "run.duration": 0.4}
BLOW = {"name": "blow", "force": [1e5, 0.0], "position": [30.25, 30.25], "wave": "pulse"}
STEADY = {"name": "weight", "acceleration": [0.0, -9.81]}
SQUARE = {
    "packing.size": [60.0, 60.0],
    "motion.held": [],
    "boundary": {side: {"type": "viscous"} for side in ("left", "right", "bottom", "top")},
    "monitor": [{"name": "P", "position": [40.25, 30.25]}],
    "load": [BLOW],
    "run.duration": 0.2,
}


def lines(case):
    return dict(proposals(plan(case)))


def test_a_bar_needs_no_more_than_the_wave_at_its_last_monitor(bar) -> None:
    found = lines(bar({**LONG, "monitor": [{"name": "P", "position": [20.25, 0.75]}]}))

    # a pulse of 0.01 s; 20.25 m at 1000 m/s, 2 % more: 0.03066 s, the left grip being its own mirror: rounded up
    assert found["shorter run"].startswith(
        "the slowest waves, and what sides reflect of them, have passed all monitors"
    )
    assert found["shorter run"].endswith("by 0.031 s; run.duration is 0.4 s")
    # the first echo comes after 0.18 s
    assert "echoes" not in found
    # 31 m and the precursor of 9.9 m to and fro: half of 31 + 9.9 + 20.25, whole disks
    assert found["smaller scene"] == ("31 m instead of 100 m along x (right 69 m nearer): no echo before 0.031 s")


def test_what_a_free_end_reflects_is_waited_for(bar) -> None:
    place = {"monitor": [{"name": "P", "position": [20.25, 0.75]}]}
    left = {"boundary": {"left": {"type": "viscous_input", "wave_p": "pulse"}}}
    found = lines(bar({**LONG, **left, **place}))

    # to the free end and back: 100 + 79.75 m at 1000 m/s, 2 % more, and the pulse
    assert "have passed all monitors by 0.2 s" in found["shorter run"]
    assert "shorter run" not in lines(bar({**LONG, "boundary": {"left": GRIP}, **place}))  # between two that reflect


def test_echoes_are_named_with_side_and_monitor(bar) -> None:
    places = [{"name": "near", "position": [20.25, 0.75]}, {"name": "far", "position": [90.25, 0.75]}]
    found = lines(bar({**LONG, "monitor": places}))

    # 100 m there and 9.75 m back, a little before the pulse of 0.01 s has passed: 0.01 s + 1.02 · 0.09025 s
    assert found["echoes"] == "right (viscous) may reflect to far from 0.11 s on"
    assert "by 0.11 s" in found["shorter run"]
    assert "smaller scene" not in found


def test_a_blow_in_a_field_has_slow_waves_on_all_ways(bar) -> None:
    found = lines(bar(SQUARE))

    # S waves of 500 m/s over 10 m, 2 % more, and a pulse of 0.01 s
    assert "by 0.031 s; run.duration is 0.2 s" in found["shorter run"]
    # P waves and their precursor come 31 + 9.895 m. Over the right side at X: 2X = 40.895 + 40.25 + 30.25, X = 55.7 m;
    # over the top, 10 m across, 2Y = √(40.895² − 10²) + 60.5, Y = 50.1 m; the others alike, in whole disks
    x = "41.5 m instead of 60 m along x (left 14.5 m nearer and right 4 m nearer)"
    y = "40.5 m instead of 60 m along y (bottom 10 m nearer and top 9.5 m nearer)"
    assert found["smaller scene"] == f"{x}: no echo before 0.031 s; {y}: no echo before 0.031 s"


GRADED = {"pattern": "B", "size": [60.0, 60.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [10.0, 10.0]}


@pytest.mark.parametrize(
    "changes",
    [
        {"load": [STEADY]},
        {"wave.pulse": {"type": "constant", "amplitude": 1.0}},
        {"material.law": "linearpbond"},
        {"packing": GRADED},
    ],
)
def test_no_shorter_run_is_proposed_where_the_end_is_not_known(bar, changes) -> None:
    assert "shorter run" not in lines(bar({**SQUARE, **changes}))


def test_without_monitors_or_motion_nothing_is_proposed_and_under_gravity_no_smaller_scene(bar) -> None:
    assert lines(bar({**SQUARE, "monitor": []})) == {}
    assert lines(bar({**SQUARE, "load": []})) == {}
    assert "smaller scene" not in lines(bar({**SQUARE, "load": [STEADY, BLOW]}))
    supports = {"boundary": {"bottom": {"type": "fixed"}}}
    assert "smaller scene" not in lines(bar({**SQUARE, "load": [STEADY, BLOW], "static": supports}))


def test_a_rock_bar(spalling) -> None:
    unbroken = {"boundary.right": {"type": "viscous"}, "method": {"type": "finite_difference"}}
    unbroken |= {"run.duration": 0.01, "load.hit.nodes": 1, "bar.length": 4.0}
    case = spalling(unbroken)
    found = lines(loads(case.text.replace("strength = 8000000.0\n", "")))

    # 0.4 ms and 0.525 m at 1000 m/s, 2 % more: 0.94 ms
    assert "by 0.00094 s; run.duration is 0.01 s" in found["shorter run"]
    # precursor 10 (0.94 · 0.025²/8)^(1/3) = 0.419 m: half of 0.94 + 0.419 + 0.525 m, whole spacings
    assert found["smaller scene"] == "0.95 m instead of 4 m along x (right 3.05 m nearer): no echo before 0.00094 s"
    assert "shorter run" not in lines(case)  # a bar that may break


@pytest.mark.parametrize("by", [(-37.0, -81.0), (37.0, 11.0)])
def test_nearer_sides_are_proposed_wherever_a_scene_is(bar, by) -> None:
    """All of its sides are too far away, so that the sign of each counts."""
    case = bar({**SQUARE, "run.duration": 0.04})
    found = lines(case)

    for side in ("left", "right", "bottom", "top"):
        assert side in found["smaller scene"]
    assert lines(translated(case, by)) == found
    mirrored = bar({**SQUARE, "boundary.top": {"type": "free"}, "run.duration": 0.6})
    assert "shorter run" in lines(mirrored)
    assert lines(translated(mirrored, by)) == lines(mirrored)
