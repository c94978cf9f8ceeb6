"""Building the scene of a case."""

import numpy as np
import pytest

from dembound.disks.scene import build
from dembound.disks.sides import boundary_medium
from dembound.errors import CaseError, PackingError

RANDOM = {
    "packing": {"pattern": "B", "size": [12.0, 10.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [6.0, 5.0]},
    "motion.held": [],
}


def test_a_mirror_image_is_held_like_a_touching_disk(bar) -> None:
    scene = build(bar({"motion.held": [], "boundary.top": {"type": "symmetry"}}))
    supports, law = scene.supports, scene.ground.stiffness
    top = np.isin(supports.node, scene.edges["top"].nodes)

    # all disks of the lattice are alike, so its own contacts are what stands between disk and image
    for component, stiffness in ((1, law.normal[0]), (2, law.bending[0])):
        chosen = supports.stiffness[top & (supports.component == component)]
        np.testing.assert_allclose(chosen, 20 * [2.0 * stiffness], rtol=1e-14)


def test_dashpots_absorb_into_the_speeds_named_else_into_the_packings_own(bar) -> None:
    moduli = {"density": 2500.0, "emod": 1.25e9, "pb_emod": 1.25e9}
    media = []
    for material in ({"density": 2500.0, "p_wave_speed": 900.0}, moduli | {"s_wave_speed": 300.0}, moduli):
        case = bar({"material": material})
        media.append(boundary_medium(build(case).ground, axis=0))

    assert (media[0].density, media[0].p_wave_speed, media[1].s_wave_speed) == (2500.0, 900.0, 300.0)
    # the lattice with μ = 0: c_p² = (E_c + Ē_c)/ρ, c_s = c_p/2; a solve with one unknown
    assert media[2].p_wave_speed == pytest.approx(1000.0, rel=1e-12)
    assert media[2].s_wave_speed == pytest.approx(500.0, rel=1e-12)


TUNNEL = {"name": "tunnel", "type": "circle", "centre": [6.0, 5.0], "radius": 2.0}


def test_a_hole_takes_out_what_is_centred_in_it_and_leaves_the_sides_alone(bar) -> None:
    whole, hollow = build(bar(RANDOM)), build(bar({**RANDOM, "hole": [TUNNEL]}))
    away = np.hypot(*(hollow.assembly.positions - [6.0, 5.0]).T)

    assert away.min() >= 2.0
    near = np.hypot(*(whole.assembly.positions - [6.0, 5.0]).T) < 2.0
    assert hollow.count == whole.count - np.count_nonzero(near) - hollow.assembly.loose + whole.assembly.loose
    assert (hollow.before, hollow.kept) == (None, None)
    for side, edge in whole.edges.items():
        left = hollow.edges[side]
        assert np.array_equal(left.positions, edge.positions)
        assert np.array_equal(hollow.assembly.positions[left.nodes], left.positions)
        assert left.length == edge.length


def test_holes_that_leave_nothing_are_refused(bar) -> None:
    tables = {"packing.size": [4.0, 4.0], "monitor": []}
    for corners, error, line in (
        ([-1.0, -1.0, 5.0, 5.0], PackingError, "no disk is left of the body"),
        ([-1.0, 3.0, 5.0, 5.0], CaseError, "hole: holes remove all "),
    ):
        with pytest.raises(error, match=line):
            build(bar({**tables, "hole": [{"name": "pit", "type": "rectangle", "corners": corners}]}))
