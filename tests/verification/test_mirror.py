"""A symmetric side answers like the other half of the body, moved as its mirror image."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

WIDTH, HEIGHT = 5.0, 4.0


@pytest.mark.parametrize("half_cells", [False, True])
@pytest.mark.parametrize(("side", "axis"), [("left", 0), ("right", 0), ("bottom", 1), ("top", 1)])
def test_half_a_body_with_its_mirror_is_the_whole(lab, side, axis, half_cells):
    across = {("top", "right")[axis]: {"type": "viscous", "half_mass": True}} if half_cells else {}
    words = {"held": (), "material": {"fric": 0.5}}
    half = lab.scene("A", (WIDTH, HEIGHT), boundary={side: "symmetry", **across}, **words)
    whole = lab.scene("A", (WIDTH * (2 - axis), HEIGHT * (1 + axis)), boundary=across, **words)
    u = np.random.default_rng(3).uniform(-1e-3, 1e-3, (3, half.count))
    force = lab.forces(half, u)
    table = half.supports
    force[table.component, table.node] -= table.stiffness * u[table.component, table.node]

    places = half.assembly.positions.copy()
    if side in ("left", "bottom"):  # the half stands beyond its image
        places[:, axis] += (WIDTH, HEIGHT)[axis]
    images = places.copy()
    images[:, axis] = whole.assembly.size[axis] - images[:, axis]
    tree = cKDTree(whole.assembly.positions)
    (_, own), (_, image) = tree.query(places), tree.query(images)
    mirrored = np.array([1.0, 1.0, -1.0])  # turns change their sense
    mirrored[axis] = -1.0
    both = np.empty((3, whole.count))
    both[:, own] = u
    both[:, image] = mirrored[:, None] * u
    # sums of some twenty products of stiffness and displacement
    rounding = 20.0 * np.finfo(float).eps * half.ground.stiffness.normal.max() * 1e-3
    np.testing.assert_allclose(force, lab.forces(whole, both)[:, own], rtol=0.0, atol=rounding)
