"""Faces in series with rock as measured: exact on lattices, not stiffer than contacts, by pieces of a line."""

import numpy as np
import tomli_w
from small_cases import GRAINS

from dembound.disks.scene import build
from dembound.kinds import loads

LATTICE = {
    "packing": {"pattern": "A", "size": [10.0, 10.0], "radius": 0.25},
    "material": {"density": 2500.0, "p_wave_speed": 1000.0},
    "run": {"duration": 0.01},
}


def faces_along(points, tables, stiffness):
    """The faces of a joint of a normal stiffness (Pa/m) along points, and half of that in shear."""
    joint = {"name": "joint", "points": points, "kn": stiffness, "ks": 0.5 * stiffness}
    (faces,) = build(loads(tomli_w.dumps(tables | {"joint": [joint]}))).faces
    return faces


def test_between_rows_of_a_lattice_the_rock_is_the_contacts():
    for points in ([[-1.0, 5.0], [11.0, 5.0]], [[5.0, 1.0], [5.0, 8.0]]):  # of which the second ends inside
        faces = faces_along(points, LATTICE, 1e10)
        np.testing.assert_allclose(faces.rock * faces.removed, 1.0, rtol=1e-5)
        np.testing.assert_allclose(faces.whole, [1e10, 5e9], rtol=1e-5)


def test_across_a_lattice_it_is_measured_and_the_same_in_both_directions():
    for points in ([[0.1, -1.0], [9.2, 11.0]], [[9.2, 11.0], [0.1, -1.0]]):
        faces = faces_along(points, LATTICE, 1e9)
        np.testing.assert_allclose(faces.whole, [1e9, 5e8], rtol=2e-3)
        assert (np.abs(faces.rock * faces.removed - 1.0) > 0.05).all()


def test_faces_as_stiff_as_the_ground_do_not_become_stiffer_than_contacts():
    tables = GRAINS | {"boundary": {}, "wave": {}, "monitor": []}
    faces = faces_along([[-1.0, 1.6], [9.0, 2.4]], tables, 1e10)
    series = 1.0 / (1.0 / faces.asked[:, None] + 1.0 / faces.removed)
    limit = np.maximum(0.75 * faces.removed, series)
    assert (faces.stiffness <= limit * (1.0 + 1e-12)).all()
    assert (faces.whole < 0.98 * faces.asked).any()


def test_a_line_of_short_pieces_keeps_the_contacts():
    bent = [[0.1 + 2.4 * k, 5.0 + 0.2 * (k % 2)] for k in range(5)]
    faces = faces_along(bent, LATTICE, 1e9)
    assert faces.whole is None
    assert faces.rock is None
    straight = faces_along([[-1.0, 5.0], [9.0, 5.0], [11.0, 5.2]], LATTICE, 1e9)
    np.testing.assert_allclose(straight.rock * straight.removed, 1.0, rtol=0.2)
    np.testing.assert_allclose(straight.whole, [1e9, 5e8], rtol=2e-3)
