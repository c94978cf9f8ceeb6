"""The faces of joints in a body: sides, contacts that they replace, ends, kinks, and springs of closed joints."""

import numpy as np
import pytest
import tomli_w
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from small_cases import GRAINS

from dembound.disks.faces.found import in_series, merged, numbers_beside
from dembound.disks.faces.springs import filling_springs
from dembound.disks.scene import build
from dembound.errors import CaseError
from dembound.kinds import loads

LATTICE = {
    "packing": {"pattern": "A", "size": [10.0, 5.0], "radius": 0.25},
    "material": {"density": 2500.0, "p_wave_speed": 1000.0},
    "run": {"duration": 0.01},
}


def scene_with(points, tables=None, **keys):
    """A body with one joint along some points."""
    joint = {"name": "joint", "points": points, "kn": 1e10, "ks": 1e10} | keys
    return build(loads(tomli_w.dumps((tables or LATTICE) | {"joint": [joint]})))


def test_a_joint_between_two_rows_has_every_disk_of_both():
    scene = scene_with([[-1.0, 2.5], [11.0, 2.5]])
    (faces,) = scene.faces
    assert (faces.split, len(faces.disk), faces.cut) == (20, 40, 20)
    np.testing.assert_allclose(faces.length, 10.0)
    y = scene.positions[faces.disk, 1]
    assert (y[: faces.split] == 2.75).all()
    assert (y[faces.split :] == 2.25).all()
    # k_n/D and k_s/D of the contacts, in series with what is asked for
    springs = scene.ground.springs
    removed = np.array([springs.normal[0], springs.shear[0]]) / 0.5
    np.testing.assert_allclose(faces.removed, removed[:, None].repeat(40, axis=1))
    np.testing.assert_allclose(1.0 / faces.stiffness, 1e-10 + 1.0 / faces.removed)
    apart = scene.positions[scene.assembly.pairs]
    assert not ((apart[:, 0, 1] - 2.5) * (apart[:, 1, 1] - 2.5) < 0.0).any()


def test_a_joint_that_ends_inside_leaves_the_contacts_beyond():
    faces = scene_with([[2.0, 2.5], [7.0, 2.5]]).faces[0]
    assert faces.cut == 10
    np.testing.assert_allclose(faces.length, 5.0)


def test_both_sides_cover_the_line_in_random_ground():
    scene = scene_with([[-1.0, 1.0], [9.0, 3.0]], GRAINS | {"boundary": {}, "wave": {}, "monitor": []})
    (faces,) = scene.faces
    whole = np.hypot(8.0, 1.6)
    for own in (slice(0, faces.split), slice(faces.split, None)):
        ends = np.sum((faces.ends[own] - [0.0, 1.2]) * faces.along[0], axis=-1)
        assert (np.diff(ends[:, 0]) > 0.0).all()
        np.testing.assert_allclose(ends[1:, 0], ends[:-1, 1], atol=1e-9)  # each begins where the one before ends
        np.testing.assert_allclose(ends[-1, 1] - ends[0, 0], whole, rtol=0.08)  # disks end before the sides do
    first, second = scene.assembly.pairs.T
    assert (faces.side[first] * faces.side[second] >= 0).all()


def test_disks_at_a_kink_have_a_face_on_each_segment():
    faces = scene_with([[-1.0, 2.5], [5.1, 2.5], [11.0, 3.2]]).faces[0]
    assert len(np.unique(faces.along, axis=0)) == 2
    both = [len(own) - len(np.unique(own)) for own in np.split(faces.disk, [faces.split])]
    assert both == [1, 1]
    np.testing.assert_allclose(faces.length, 5.1 + np.hypot(4.9, 4.9 * 0.7 / 5.9), rtol=0.02)


def test_springs_of_a_closed_joint_resist_opening_sliding_and_rolling():
    scene = scene_with([[-1.0, 2.5], [11.0, 2.5]])
    (faces,) = scene.faces
    fill = filling_springs(scene.faces, scene.positions, scene.layout.slot)
    upper = scene.positions[:, 1] > 2.5

    def force_of(u):
        force = np.zeros((3, scene.layout.count))
        fill(scene.layout.spread(u), force)
        return scene.layout.gather(force)

    moved = np.zeros((3, scene.count))
    moved[0, upper], moved[1, upper] = 2e-3, 1e-3
    found = force_of(moved)
    np.testing.assert_allclose(found[:2, upper].sum(axis=1), -10.0 * faces.stiffness[::-1, 0] * [2e-3, 1e-3])
    np.testing.assert_allclose(found[:2].sum(axis=1), 0.0, atol=1e-6)
    # a body that turns as a whole is not strained
    arm = scene.positions - [5.0, 2.5]
    turned = 1e-3 * np.stack([-arm[:, 1], arm[:, 0], np.ones(scene.count)])
    assert np.abs(force_of(turned)).max() < 1e-9 * faces.stiffness.max()


@pytest.mark.parametrize("pattern", ["elastic", "linearpbond"])
def test_disks_of_both_sides_never_meet(pattern):
    tables = LATTICE | {"material": LATTICE["material"] | {"law": pattern, "fric": 0.5}}
    if pattern == "elastic":
        del tables["material"]["fric"]
    scene = scene_with([[-1.0, 2.5], [11.0, 2.5]], tables, fric=0.5)
    if pattern == "elastic":
        assert numbers_beside(scene.faces)[scene.faces[0].disk].all()
        return
    pairs = scene.system(1e-4).contacts["body"]
    moved = np.zeros((3, scene.count))
    moved[:2, scene.positions[:, 1] > 2.5] = [[0.26], [-0.02]]  # into the rows below, were they to touch
    pairs.search(moved)
    first, second = pairs.pairs
    sides = scene.faces[0].side
    assert not ((sides[first] * sides[second]) < 0).any()


def test_in_layers_each_face_is_in_series_with_the_springs_of_its_own():
    layers = {"layer": [{"bottom": 2.5, "p_wave_speed": 500.0}, {}]}
    size = {"packing": LATTICE["packing"] | {"size": [1.0, 20.0]}}  # zones that correct the plane between are thinner
    for points in ([[-1.0, 2.5], [2.0, 2.5]], [[0.5, -1.0], [0.5, 21.0]]):
        scene = scene_with(points, LATTICE | size | layers)
        (faces,), ground = scene.faces, scene.ground
        zone = ground.zone_of(scene.positions[faces.disk])
        each = [ground.zone_materials[number].stiffness for number in zone]
        along = np.array([[one.normal[0], one.shear[0]] for one in each]).T / 0.5
        np.testing.assert_allclose(faces.removed, along)
        assert np.ptp(faces.removed[0]) > 0.5 * faces.removed[0].max()
    # across the plane between layers springs are in series as those of contacts there
    one, other = np.array([[1.0], [2.0]]), np.array([[3.0], [2.0]])
    np.testing.assert_allclose(in_series(one, other), [[1.5], [2.0]])


@pytest.mark.parametrize(("side", "ends_at"), [("viscous", ("left",)), ("free", ())])
def test_before_a_side_beyond_which_ground_goes_on_it_ends(side, ends_at):
    faces = scene_with([[-1.0, 2.5], [7.0, 2.5]], LATTICE | {"boundary": {"left": {"type": side}}}).faces[0]
    assert faces.ended_at == ends_at
    # three diameters, with the disks there that are intact
    np.testing.assert_allclose(faces.ends[..., 0].min(), 1.5 if ends_at else 0.0, atol=1e-9)
    np.testing.assert_allclose(faces.length, 5.5 if ends_at else 7.0)


@pytest.mark.parametrize("points", [[[-1.0, 2.5], [1.0, 2.5]], [[3.0, 4.3], [7.0, 4.3]]])
def test_a_joint_outside_of_the_ground_is_a_mistake(points):
    air = [{"name": "air", "type": "rectangle", "corners": [-1.0, 3.0, 11.0, 6.0]}]
    with pytest.raises(CaseError, match=r"joint\[1, joint\].points: has no disks on both sides"):
        scene_with(points, LATTICE | {"boundary": {"left": {"type": "viscous"}}, "hole": air})


@pytest.mark.parametrize("tables", [LATTICE, GRAINS | {"boundary": {}, "wave": {}, "monitor": []}])
def test_two_joints_that_cross_cut_the_ground_into_four(tables):
    keys = {"kn": 1e10, "ks": 1e10, "fric": 0.5}
    wide, high = tables["packing"]["size"]
    level, at = 0.5 * high, 0.5 * wide
    first = keys | {"name": "first", "points": [[-1.0, level], [wide + 1.0, level]]}
    second = keys | {"name": "second", "points": [[at - 0.5 * high, -0.5], [at + 0.5 * high, high + 0.5]]}
    scene = build(loads(tomli_w.dumps(tables | {"joint": [first, second]})))
    assert [each.joint.name for each in scene.faces] == ["first", "second_1", "second_2"]
    _, piece = connected_components(
        coo_matrix((np.ones(len(scene.assembly.pairs)), scene.assembly.pairs.T), shape=(scene.count,) * 2)
    )
    sizes = np.sort(np.bincount(piece))
    assert sizes[-4] > 0.1 * scene.count  # besides single loose disks
    assert sizes[:-4].sum() < 0.02 * scene.count
    # both sides of the parts of the second have faces up to the first
    meets = np.array([at - 0.5 * high + (level + 0.5) * high / (high + 1.0), level])
    for faces, end in zip(scene.faces[1:], (1, 0), strict=True):
        for own in (slice(0, faces.split), slice(faces.split, None)):
            assert np.abs(faces.ends[own, end] - meets).max(axis=1).min() < 1e-9
            overlaps = np.sort(np.sum(faces.ends[own] * faces.along[0], axis=2), axis=0)
            np.testing.assert_allclose(overlaps[1:, 0], overlaps[:-1, 1], atol=1e-9)
    # disks on opposite sides of either joint never touch, also those that are beside both
    beside = numbers_beside(scene.faces)
    assert beside.shape[1] == 2
    (joint,) = merged(scene.faces)
    assert len(joint.joints) == 3
    np.testing.assert_allclose(joint.length, sum(each.length for each in scene.faces))
    for number, each in enumerate(scene.faces):
        np.testing.assert_array_equal(np.sort(joint.disk[joint.part == number]), np.sort(each.disk))
        left, right = (np.flatnonzero(each.side == way) for way in (1, -1))
        assert (beside[left] == number + 1).any(axis=1).all()
        assert (beside[right] == -number - 1).any(axis=1).all()
