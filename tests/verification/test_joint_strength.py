"""Faces under uniform stress part at `ten`, slide at `coh` + μσ, and keep friction alone afterwards."""

import numpy as np
import pytest

from dembound.disks.faces.tie import JointTie
from dembound.disks.scene import build
from dembound.kernels.joints import push_faces
from dembound.kinds import with_changes

TENSION, COHESION, FRICTION, STIFFNESS = 2e5, 5e5, 0.6, 1e10
LEVEL = 1.0


@pytest.fixture
def pulled(lab):
    """See `halves`, of a joint that fails."""
    return halves(lab, {"ten": TENSION, "coh": COHESION, "fric": FRICTION})


def halves(lab, keys):
    """A function (rise, shift) m of the upper half of 2 × 2 m of lattice -> mean stresses of its joint, in its turn."""
    case = lab.case("A", (2.0, 2.0), held=())
    joint = {"name": "joint", "points": [[-1.0, LEVEL], [3.0, LEVEL]], "kn": STIFFNESS, "ks": STIFFNESS}
    scene = build(with_changes(case, {"joint": [joint | keys]}))
    step = 1.0  # so long that friction follows at once
    gives = np.zeros((3, scene.count))
    tie = JointTie(scene.faces[0], scene.positions, scene.ground, gives, scene.layout, step)
    upper = scene.positions[:, 1] > LEVEL

    def move(rise, shift):
        moved = np.zeros((3, scene.count))
        moved[0, upper], moved[1, upper] = shift, rise
        bundle = tie.bundle(np.arange(scene.count))
        push_faces(bundle, scene.layout.spread(moved), np.zeros_like(scene.layout.spread(moved)))
        pairs = tie.acting
        force = np.zeros(2)
        for face in range(tie.faces.split):
            force += bundle.force[face, :2]
        np.testing.assert_allclose(force, tie.forces(pairs).sum(axis=1), rtol=1e-12, atol=1e-6)
        return np.array([force[1], force[0]]) / np.sum(pairs.length)  # the pressure, and the shear stress on the upper

    return move, tie


def test_tension(pulled):
    move, tie = pulled
    opening = TENSION / tie.faces.stiffness[0, 0]
    stresses = np.array([move(share * opening, 0.0)[0] for share in np.linspace(0.0, 1.2, 241)])
    np.testing.assert_allclose(-stresses.min(), TENSION, rtol=5e-3)  # steps of half a percent
    assert stresses[-1] == 0.0
    cracks = tie.take_cracks()
    assert len(cracks) == 4
    assert not cracks.shear.any()
    np.testing.assert_allclose(move(-opening, 0.0)[0], TENSION, rtol=1e-9)  # it still bears pressure


def test_cohesion_and_friction(pulled):
    move, tie = pulled
    pressure = 4e5
    closed, way = -pressure / tie.faces.stiffness[0, 0], (COHESION + FRICTION * pressure) / tie.faces.stiffness[1, 0]
    found = np.array([move(closed, share * way) for share in np.linspace(0.0, 1.2, 241)])
    # the upper half moves by at most 0.1 mm, which changes no overlap by more than 4e-4
    np.testing.assert_allclose(found[:, 0], pressure, rtol=1e-9)
    np.testing.assert_allclose(-found[:, 1].min(), COHESION + FRICTION * pressure, rtol=5e-3)
    np.testing.assert_allclose(found[-1, 1], -FRICTION * pressure, rtol=1e-9)
    assert tie.take_cracks().shear.all()
    back = move(closed, 1.2 * way - 2.0 * FRICTION * pressure / tie.faces.stiffness[1, 0])
    np.testing.assert_allclose(back[1], FRICTION * pressure, rtol=1e-9)


def test_faces_that_come_to_lie_opposite_each_other_begin_without_shear(lab):
    move, tie = halves(lab, {})
    for shift in np.linspace(0.0, 0.75, 151):
        move(0.0, shift)
    pairs = tie.acting
    apart = tie.faces.ends[pairs.second].mean(axis=1)[:, 0] - tie.faces.ends[pairs.first].mean(axis=1)[:, 0]
    # those a diameter ahead have met at the start, those two ahead after a shift of one, within a step
    assert set(np.round(apart, 9)) == {0.5, 1.0}
    met = np.where(apart > 0.75, 0.5, 0.0)
    np.testing.assert_allclose(
        pairs.shear, -tie.faces.stiffness[1, 0] * (0.75 - met), atol=0.006 * tie.faces.stiffness[1, 0]
    )


def test_dilation_under_fixed_volume(lab):
    """Pressure grows by k_n tan ψ per slip up to the end of dilation, and falls again as the joint slides back."""
    end, pressure, tangent = 0.02, 4e5, np.tan(np.radians(10.0))
    move, tie = halves(lab, {"fric": FRICTION, "dilation": 10.0, "dilation_end": end})
    kn, ks = tie.faces.stiffness[:, 0]
    shifts = np.linspace(0.0, 0.1, 401)
    push, rub = np.array([move(-pressure / kn, shift) for shift in shifts]).T
    # of stresses means over the overlap; slip is the shift less its elastic part
    slip = shifts + rub / ks
    np.testing.assert_allclose(push, pressure + kn * tangent * np.minimum(slip, end), rtol=1e-9)
    # friction is that of the pressure before the rise of this step, of at most 0.25 mm
    sliding = slip > 1e-6
    np.testing.assert_allclose(-rub[sliding], FRICTION * push[sliding], atol=FRICTION * kn * tangent * 2.6e-4)
    for shift in shifts[::-1]:
        back = move(-pressure / kn, shift)
    slip = tie.slip(tie.acting).mean()
    assert abs(slip) < 1e-3
    np.testing.assert_allclose(back[0], pressure + kn * tangent * abs(slip), rtol=1e-9)


def test_sliding_back_and_forth_loses_twice_friction_times_the_way(pulled):
    move, tie = pulled
    closed, way = -4e5 / tie.faces.stiffness[0, 0], 0.3
    move(closed, 1e-3)  # it has lost its cohesion
    stresses = []
    for shift in [*np.linspace(1e-3, way, 400), *np.linspace(way, 1e-3, 400)]:
        stresses.append(move(closed, shift))
        assert np.isclose(np.sum(tie.acting.length), 2.0 - shift, atol=0.0, rtol=1e-9)
    pushed, rubbed = np.array(stresses).T
    np.testing.assert_allclose(pushed, 4e5, rtol=1e-9)
    np.testing.assert_allclose(rubbed[50:400], -FRICTION * 4e5, rtol=1e-9)  # also of pairs that have just begun
    np.testing.assert_allclose(rubbed[450:], FRICTION * 4e5, rtol=1e-9)
