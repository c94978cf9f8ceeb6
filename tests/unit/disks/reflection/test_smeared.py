"""Reflections by a continuum with smeared supports, beside formulas and beside those of the disks."""

import math

import pytest
from small_cases import GRAINS, small

from dembound.disks.reflection import measure_side
from dembound.disks.reflection.bricks import end_scene
from dembound.disks.reflection.smeared import by_smeared_supports
from dembound.errors import CaseError


def test_springs_and_dashpots_along_the_normal_reflect_by_their_impedance() -> None:
    """R = (ρc − z)/(ρc + z) with z = c + k/iω of all supports per m of the side; on a lattice no P wave becomes S."""
    lattice = {"pattern": "A", "size": [8.0, 4.0], "radius": 0.25}
    table = {"type": "viscoelastic", "distance": 3.0, "alpha_n": 2.0, "beta_p": 0.7}
    scene = end_scene(small({**GRAINS, "packing": lattice, "boundary": {"right": table}}), "right")
    found = by_smeared_supports(scene, "right", [15.0], [0.0])
    ground, supports = scene.ground, scene.supports
    length, own = scene.assembly.size[1], supports.component == 0
    z = (supports.damping[own].sum() + supports.stiffness[own].sum() / (2j * math.pi * 15.0)) / length
    impedance = ground.density * ground.wave_speeds(0)[0]
    assert found.same["p"][0, 0] == pytest.approx(abs((impedance - z) / (impedance + z)) ** 2, rel=1e-9)
    assert found.converted["p"][0, 0] < 1e-20


def test_a_side_is_answered_quickly_beside_matched_factors() -> None:
    case = small(GRAINS, changes={"boundary.right.beta_p": 1.0})
    found = measure_side(case, "right", [0.0, 30.0], 3, quick=True)
    assert found.matched is not None
    assert found.continuum is None
    # at its own factors nothing comes back, but for what cut bonds turn of P into S
    assert found.matched.total("p")[:, 0].max() < 1e-4 < found.found.total("p")[:, 0].min()
    assert measure_side(small(GRAINS), "right", [0.0], 3, quick=True).matched is None  # it has these factors
    outside = small({**GRAINS, "boundary": {"right": {"type": "outside"}}})
    with pytest.raises(CaseError, match="--quick: is not possible for side right"):
        measure_side(outside, "right", quick=True)
