"""Tractions of a static stage: what they come to, that they turn no body, and how they are corrected."""

import numpy as np
import pytest

from dembound.boundaries import OPPOSITE
from dembound.disks.block_stress import RIM
from dembound.disks.scene import DiskScene, build
from dembound.disks.tractions import CLOSE, CORRECTIONS, Tractions

BODY = {"wave": {}, "monitor": [], "motion.held": [], "boundary": {}}
FOLLOWING = {"material.law": "linearpbond"}
STILL = {"elastic": {}, "reference": {"material.law": "linearpbond", "material.geometry": "reference"}}
RANDOM = {"pattern": "B", "size": [8.0, 4.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [4.0, 4.0]}
STRESS = (-3e6, 2e6, 1e6)
OUTWARD = {"left": (-1.0, 0.0), "right": (1.0, 0.0), "bottom": (0.0, -1.0), "top": (0.0, 1.0)}


@pytest.fixture
def lattice(bar):
    """Makes lattices of disks of 0.5 m that nothing holds."""

    def make(width: float, height: float, **changes: object) -> DiskScene:
        return build(bar({**BODY, "packing.size": [width, height], **changes}))

    return make


@pytest.fixture
def random_body(bar):
    """Makes two random bricks side by side, whose sides are uneven."""

    def make(**changes: object) -> DiskScene:
        return build(bar({**BODY, "packing": RANDOM, **changes}))

    return make


def turn(angle: float) -> np.ndarray:
    """Rotation matrix (2, 2)."""
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def moved(scene: DiskScene, seed: int = 1, size: float = 0.1) -> np.ndarray:
    """Random displacements (3, n)."""
    return size * np.random.default_rng(seed).uniform(-1.0, 1.0, (3, scene.count))


def turned(scene: DiskScene, angle: float) -> np.ndarray:
    """Displacements (3, n) of a turn about the origin."""
    return np.vstack([(turn(angle) - np.eye(2)) @ scene.positions.T, np.full(scene.count, angle)])


def torque(scene: DiskScene, force: np.ndarray, displacement: np.ndarray) -> float:
    """Of all forces about a point outside the body."""
    x, y = scene.positions.T + displacement[:2] + [[7.0], [-5.0]]
    return float(np.sum(x * force[1] - y * force[0]))


def fitted(places: np.ndarray, moved: np.ndarray) -> float:
    """Rotation that is nearest to the motion of some places (2, m), by a polar decomposition."""
    a, r = (x - x.mean(axis=1, keepdims=True) for x in (places, places + moved))
    left, _, right = np.linalg.svd(r @ a.T)
    rotation = left @ np.diag([1.0, np.linalg.det(left @ right)]) @ right
    return float(np.arctan2(rotation[1, 0], rotation[0, 0]))


@pytest.mark.parametrize(("size", "stress"), [((8.0, 4.0), (-3e6, 2e6, 0.0)), ((4.0, 4.0), STRESS)])
def test_each_disk_of_a_lattice_has_the_traction_of_its_diameter(lattice, size: tuple, stress: tuple) -> None:
    scene = lattice(*size)
    force = Tractions(scene, stress).forces(np.zeros((3, scene.count)))
    tensor = np.array([[stress[0], stress[2]], [stress[2], stress[1]]])

    # equal disks in rows: nothing is left to turn the body; what rounding leaves of it is 1e-15 of each sum
    expected = np.zeros((2, scene.count))
    for side, edge in scene.edges.items():
        expected[:, edge.nodes] += (tensor @ OUTWARD[side])[:, None] * 0.5
    np.testing.assert_allclose(force[:2], expected, rtol=0.0, atol=1e-13 * 3e6)
    assert not force[2].any()


@pytest.mark.parametrize("follows", [False, True])
def test_a_body_of_uneven_sides_gets_what_lacks_for_balance(random_body, follows: bool) -> None:
    scene = random_body(**FOLLOWING)
    displacement = moved(scene) * follows
    force = Tractions(scene, STRESS).forces(displacement)
    tensor = np.array([[STRESS[0], STRESS[2]], [STRESS[2], STRESS[1]]])
    own = {side: fitted(edge.positions.T, displacement[:2, edge.nodes]) for side, edge in scene.edges.items()}
    plain = np.zeros((2, scene.count))
    for side, edge in scene.edges.items():
        share = edge.diameters / edge.diameters.sum()
        pull = turn(0.5 * (own[side] + own[OPPOSITE[side]])) @ tensor @ OUTWARD[side]
        plain[:, edge.nodes] += pull[:, None] * edge.length * share
    loaded = np.unique(np.concatenate([edge.nodes for edge in scene.edges.values()]))
    arm = (scene.positions.T + displacement[:2])[:, loaded]
    arm -= arm.mean(axis=1, keepdims=True)
    unbalanced = np.sum(arm[0] * plain[1, loaded] - arm[1] * plain[0, loaded])
    plain[:, loaded] -= unbalanced / np.sum(arm**2) * np.array([-arm[1], arm[0]])

    # angles and sums of some fifty terms
    np.testing.assert_allclose(force[:2], plain, rtol=0.0, atol=1e-13 * 8.0 * 3e6)
    assert abs(unbalanced) > 1e-3 * 3e6
    inner = np.setdiff1d(np.arange(scene.count), loaded)
    assert not force[:, inner].any()
    assert not force[2].any()
    # opposite sides have not turned alike, nor have both pairs
    assert not follows or abs(own["left"] - own["right"]) > 1e-3
    assert not follows or abs(own["left"] + own["right"] - own["bottom"] - own["top"]) > 1e-3


@pytest.mark.parametrize("changes", [FOLLOWING, *STILL.values()], ids=["updated", *STILL])
def test_tractions_neither_move_nor_turn_a_body(random_body, changes: dict) -> None:
    scene = random_body(**changes)
    tractions = Tractions(scene, STRESS)
    for displacement in (np.zeros((3, scene.count)), moved(scene), turned(scene, 0.7) + moved(scene, 2)):
        force = tractions.forces(displacement)
        where = displacement if changes is FOLLOWING else np.zeros_like(displacement)
        scale = np.abs(force).sum()
        # sums of some fifty terms, of arms of 20 m
        assert np.abs(force.sum(axis=1)).max() < 1e-14 * scale
        assert abs(torque(scene, force, where)) < 20.0 * 1e-14 * scale


@pytest.mark.parametrize("angle", [0.02, -2.0])
def test_tractions_turn_with_a_body_whose_law_follows_the_motion(random_body, angle: float) -> None:
    scene = random_body(**FOLLOWING)
    tractions = Tractions(scene, STRESS)
    before, after = tractions.forces(np.zeros((3, scene.count))), tractions.forces(turned(scene, angle))

    # angles as of sums over twenty disks
    np.testing.assert_allclose(after[:2], turn(angle) @ before[:2], rtol=0.0, atol=1e-13 * 8.0 * 3e6)


@pytest.mark.parametrize("changes", STILL.values(), ids=STILL)
def test_tractions_stay_where_the_law_stays(random_body, changes: dict) -> None:
    scene = random_body(**changes)
    tractions = Tractions(scene, STRESS)
    before = tractions.forces(np.zeros((3, scene.count)))

    assert np.array_equal(tractions.forces(turned(scene, 0.3)), before)
    assert np.array_equal(tractions.forces(moved(scene)), before)


def test_stress_that_lacks_is_added_until_it_is_close(lattice) -> None:
    tractions = Tractions(lattice(8.0, 8.0), STRESS)
    near = np.array(STRESS) + np.array([0.0, 0.99, -0.99]) * CLOSE * 3e6
    assert not tractions.correct(near)
    assert tractions.applied.tolist() == list(STRESS)

    # the largest component counts, in whichever the error is
    for component in range(3):
        lacking = 1.01 * CLOSE * 3e6 * np.eye(3)[component]
        before = tractions.applied.copy()
        assert tractions.correct(np.array(STRESS) - lacking)
        # rounding of differences of 3e6
        np.testing.assert_allclose(tractions.applied, before + lacking, rtol=0.0, atol=1e-9)
    assert tractions.asked.tolist() == list(STRESS)


def test_what_is_applied_is_what_pulls(lattice) -> None:
    scene = lattice(8.0, 8.0)
    corrected = Tractions(scene, STRESS)
    assert corrected.correct(np.array([-2e6, 2.5e6, 0.0]))
    twice = Tractions(scene, (-4e6, 1.5e6, 2e6))
    still = np.zeros((3, scene.count))

    # rounding of sums
    np.testing.assert_allclose(corrected.forces(still), twice.forces(still), rtol=0.0, atol=1e-13 * 4e6)


def test_tractions_are_corrected_a_few_times_at_most(lattice) -> None:
    tractions = Tractions(lattice(8.0, 8.0), STRESS)
    done = [tractions.correct(np.zeros(3)) for _ in range(CORRECTIONS + 2)]

    assert done == [True] * CORRECTIONS + [False] * 2
    np.testing.assert_allclose(tractions.applied, (1.0 + CORRECTIONS) * np.array(STRESS), rtol=1e-14)


@pytest.mark.parametrize(
    ("size", "boundary", "corrected"),
    [
        # disks of 0.5 m: the rim of both sides and as much again inside are 8 m
        ((8.0, 8.0), {}, True),
        ((7.5, 8.0), {}, False),
        ((8.0, 7.5), {}, False),
        # a periodic body has no rim
        ((8.0, 2.0), {side: {"type": "periodic"} for side in ("bottom", "top")}, True),
        ((2.0, 8.0), {side: {"type": "periodic"} for side in ("left", "right")}, True),
    ],
)
def test_narrow_bodies_are_never_corrected(lattice, size: tuple[float, float], boundary: dict, corrected: bool) -> None:
    assert 4.0 * RIM * 0.5 == 8.0
    assert Tractions(lattice(*size, boundary=boundary), STRESS).correct(np.zeros(3)) is corrected
