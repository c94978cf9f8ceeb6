"""Beside a round hole under a pressure disks have the error that is expected of its wall, within `WALL_FACTOR`.

The truth is the exact motion of the cavity in the medium that the packing is.
"""

import numpy as np
import pytest
from scene_tables import grains, lattice
from walls import QUANTITIES, RADII, exact, key, motions, row, scene

from dembound.disks.scene import build
from dembound.formulas.disks.near_disks import WALL_FACTOR, wall_errors


@pytest.mark.parametrize(
    ("packing", "along"),
    [
        (lattice(30.0, 30.0, 1.0), 5.0),
        pytest.param(lattice(60.0, 60.0, 1.0), 10.0, marks=pytest.mark.slow),
        pytest.param(grains(40.0, 40.0, 1.0, 10.0, 2), 6.0, marks=pytest.mark.slow),
        pytest.param(grains(40.0, 40.0, 1.0, 10.0, 4, "C"), 6.0, marks=pytest.mark.slow),
    ],
)
def test_motion_beside_a_hole_is_as_wrong_as_expected(packing: dict, along: float) -> None:
    middle = 0.5 * np.array(packing["size"])
    hole = {"type": "circle", "centre": middle.tolist(), "radius": along}
    case, own = motions(scene(packing, hole, along, middle, is_pressed=True))
    found = row("hole", own, exact(case, own, along, middle, is_pressed=True), along)
    for quantity in QUANTITIES:
        for radius in RADII:
            ratio = found[key(quantity, radius)] / (along * wall_errors(case, build(case).ground, 1.0)[quantity])
            assert 1.0 / WALL_FACTOR < ratio < WALL_FACTOR, (quantity, radius)
