"""A side of the scene and the medium that it represents: impedances by hand, normals, cover."""

from dataclasses import replace

import numpy as np
import pytest

from dembound.boundaries.edge import BoundaryMedium, Edge


def no_mirror(diameters: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return 0.0 * diameters, 0.0 * diameters


MEDIUM = BoundaryMedium(density=2000.0, p_wave_speed=1000.0, s_wave_speed=500.0, mirror_stiffness=no_mirror)


def test_a_medium_gives_p_dashpots_along_the_normal_and_s_across() -> None:
    # βρc by hand: 0.5·2000·1000 and 3·2000·500
    assert MEDIUM.impedances(0.5, 3.0, normal_axis=0).tolist() == [1e6, 3e6]
    assert MEDIUM.impedances(0.5, 3.0, normal_axis=1).tolist() == [3e6, 1e6]
    assert MEDIUM.shear_modulus == 5e8  # 2000·500²


def test_matched_factors_make_up_for_speeds_and_for_what_the_disks_cover() -> None:
    edge = Edge("right", np.arange(2), positions=np.zeros((2, 2)), diameters=np.array([0.5, 1.0]), length=1.2)

    # ΣD/H = 1.25; own speeds of 900 and 600 m/s where 1000 and 500 are nominal
    assert MEDIUM.matched(edge) == pytest.approx({"p": 0.8, "s": 0.8}, rel=1e-15)
    own = replace(MEDIUM, own_speeds=lambda: (900.0, 600.0))
    assert own.matched(edge) == pytest.approx({"p": 0.72, "s": 0.96}, rel=1e-15)
    # no S waves in the medium, and a held motion
    fluid = replace(MEDIUM, s_wave_speed=0.0, own_speeds=lambda: (np.nan, 0.0))
    assert fluid.matched(edge) == pytest.approx({"p": np.nan, "s": 0.8}, rel=1e-15, nan_ok=True)


def test_an_edge_knows_its_normal_and_how_much_its_disks_cover() -> None:
    for side, axis in (("left", 0), ("right", 0), ("bottom", 1), ("top", 1)):
        edge = Edge(side, np.array([4, 2]), positions=np.zeros((2, 2)), diameters=np.array([0.5, 1.0]), length=1.25)
        assert (edge.axis, edge.diameter_sum_ratio) == (axis, 1.2)


def test_a_disk_shared_by_two_sides_takes_its_part_of_the_width() -> None:
    diameters, shares = np.array([0.5, 1.0]), np.array([0.5, 1.0])
    edge = Edge("right", np.arange(2), np.zeros((2, 2)), diameters, length=1.25, shares=shares)
    assert edge.widths.tolist() == [0.25, 1.0]
