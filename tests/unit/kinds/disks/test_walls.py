"""Walls in check: how many disks touch them, and those that they overlap at the start."""

import numpy as np
import pytest
from small_cases import problems_in, small

from dembound.disks.scene import build
from dembound.kinds.disks.kind import Disks
from dembound.kinds.disks.walls import overlaps, wall_facts, wall_warnings

LOOSE = {
    "packing": {"pattern": "A", "size": [4.0, 2.0], "radius": 0.25},
    "material": {"density": 2500.0, "law": "linearpbond", "emod": 1e8, "pb_emod": 0.0, "fric": 0.5},
    "wall": [{"name": "floor", "points": [[-1.0, 0.0], [1.5, 0.0], [9.0, 0.0]]}],
    "run": {"duration": 0.01},
}


def with_wall(**changes):
    """The case with a changed wall."""
    return small(LOOSE | {"wall": [LOOSE["wall"][0] | changes]})


def test_facts_say_how_many_disks_touch_a_wall_and_how_it_moves() -> None:
    scene = build(with_wall(velocity=[0.5, 0.0], until=0.004, dp_nratio=0.2))
    ((name, text),) = wall_facts(scene)
    assert name == "wall floor"
    assert text == (
        "2 segments, 10 m; k_n = 200 MN/m, friction 0; dashpots of 20 % of the critical one; 8 disks touch it at the "
        "start; it moves at (500, 0) mm/s until 4 ms"
    )


@pytest.mark.parametrize(("height", "count"), [(-0.1, 0), (0.0, 0), (0.01, 8)])
def test_a_wall_that_overlaps_disks_is_warned_of(height: float, count: int) -> None:
    case = with_wall(points=[[-1.0, height], [9.0, height]])
    scene = build(case)
    assert overlaps(scene, case.wall[0]).max() == pytest.approx(height / 0.25 if height >= 0.0 else -np.inf, abs=1e-12)
    found = list(wall_warnings(scene))
    assert len(found) == (count > 0)
    if found:
        assert found[0].startswith("wall[1, floor].points: overlaps 8 disks at the start, up to 4 % of a radius, and")


def test_a_wall_that_cuts_disks_is_refused() -> None:
    case = with_wall(points=[[0.2, -1.0], [0.2, 9.0]])
    (line,) = problems_in(lambda: Disks().build(case))
    assert line.startswith("wall[1, floor].points: cuts 4 disks at the start, that at (0.25, 0.25) m by 0.80 of its")
