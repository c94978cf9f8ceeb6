"""Mean stress of blocks where it is known by hand, which blocks there are, and the reports on their differences."""

import numpy as np
import pytest
from disk_systems import BODY, WRAP

from dembound.disks.rest.settled import Blocks, Uniformity, block_stress
from dembound.disks.scene import DiskScene, build
from dembound.disks.side_forces import packing_pieces
from dembound.disks.stepping.system import DiskSystem

K = 2500.0 * 1000.0**2
"""Normal stiffness of a lattice contact and its bond, N/m."""
RANDOM = {"pattern": "B", "size": [8.0, 8.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [4.0, 4.0]}


@pytest.fixture
def body(bar):
    """Makes bodies of disks of 0.5 m."""

    def make(width: float, height: float, **changes: object) -> DiskScene:
        return build(bar({**BODY, "packing.size": [width, height], **changes}))

    return make


def strained(scene: DiskScene, xx: float, yy: float) -> np.ndarray:
    """Displacements (3, n) of uniform strains."""
    x, y = scene.positions.T
    return np.stack([xx * x, yy * y, 0.0 * x])


@pytest.mark.parametrize("boundary", [{}, WRAP], ids=["free", "periodic"])
def test_a_strained_lattice_has_its_stress_in_every_block_wherever_it_ends(body, boundary) -> None:
    scene = body(13.0, 17.5, boundary=boundary)  # blocks of no whole number of disks
    displacement = strained(scene, 1e-6, -2e-6) if not boundary else np.zeros((3, scene.count))
    if boundary:  # uniform strain of a periodic body is none; a shift changes nothing
        displacement[0] = 1.0
    stress = block_stress(scene, DiskSystem(scene, 1e-5), displacement)
    expected = [0.0, 0.0, 0.0] if boundary else [K * 1e-6, K * -2e-6, 0.0]
    # sums of some hundred contacts; displacements are rounded by 1e-16
    np.testing.assert_allclose(stress, np.broadcast_to(expected, stress.shape), rtol=0.0, atol=1e-6 * K * 2e-6)


@pytest.mark.parametrize("pattern", ["A", "B"])
def test_the_packing_has_the_stress_on_the_whole(body, pattern: str) -> None:
    scene = body(8.0, 8.0, boundary=WRAP, **({"packing": RANDOM} if pattern == "B" else {}))
    asked = np.array([-3e6, 2e6, 1e6])
    stress = Blocks.of(scene).stress(packing_pieces(scene, asked), scene.positions)
    np.testing.assert_allclose(stress.mean(axis=(0, 1)), asked, rtol=0.0, atol=1e-9 * 3e6)


def test_the_worst_block_is_reported_with_its_place_and_holes_apart(body) -> None:
    hole = {"name": "hole", "type": "circle", "centre": [4.0, 4.0], "radius": 1.0}
    scene = body(24.0, 14.0, hole=[hole])
    asked = np.array([-3.0, -5.0, 0.0]) * 1e6
    displacement = strained(scene, -3e6 / K, -5e6 / K)
    x, y = scene.positions.T
    displacement[1] += np.where(x > 18.0, 1e-4 * (y - 7.0), 0.0)
    found = Uniformity.of(scene, DiskSystem(scene, 1e-5), displacement, asked)
    # a block is 5 m wide, and all of the last one is strained by 1e-4 more
    np.testing.assert_allclose(found.place[0], 19.5)
    assert found.deviation == pytest.approx(1e-4 * K / 5e6 * 4.0 / 5.0, rel=0.05)
    assert found.beyond == pytest.approx(found.deviation, rel=1e-6)
    assert found.packing < 1e-9
    assert found.near_holes > 0.05
    kept = Uniformity.restored(found.saved_arrays())
    assert kept.saved_arrays().keys() == found.saved_arrays().keys()
    assert all(np.array_equal(kept.saved_arrays()[name], values) for name, values in found.saved_arrays().items())
