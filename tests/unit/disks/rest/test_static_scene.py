"""Forces of a given stress on the sides of a body: that it is at rest under them, and that they turn no body."""

import numpy as np
import pytest
from disk_systems import BODY, TWO_BRICKS, fitted, shaken, turn

from dembound.boundaries import OPPOSITE
from dembound.disks.rest.static_scene import Tractions
from dembound.disks.scene import DiskScene, build
from dembound.disks.side_forces import side_forces

FOLLOWING = {"material.law": "linearpbond"}
STILL = {"elastic": {}, "reference": {"material.law": "linearpbond", "material.geometry": "reference"}}
STRESS = (-3e6, 2e6, 1e6)


@pytest.fixture
def random_body(bar):
    """Makes two random bricks side by side, whose sides are uneven."""

    def make(**changes: object) -> DiskScene:
        return build(bar({**BODY, "packing": TWO_BRICKS, **changes}))

    return make


def moved(scene: DiskScene, seed: int = 1) -> np.ndarray:
    return shaken(scene, 0.1, seed)


def turned(scene: DiskScene, angle: float) -> np.ndarray:
    """Displacements (3, n) of a turn about the origin."""
    return np.vstack([(turn(angle) - np.eye(2)) @ scene.positions.T, np.full(scene.count, angle)])


def torque(scene: DiskScene, force: np.ndarray, displacement: np.ndarray) -> float:
    """Torque of all forces about a point outside the body."""
    x, y = scene.positions.T + displacement[:2] + [[7.0], [-5.0]]
    return float(np.sum(x * force[1] - y * force[0]) + np.sum(force[2]))


@pytest.mark.parametrize("follows", [False, True])
def test_sides_turn_with_their_opposites_and_grow_with_their_length(random_body, follows: bool) -> None:
    scene = random_body(**FOLLOWING)
    displacement = moved(scene) * follows
    tractions = Tractions(scene, STRESS)
    force, still = tractions.forces(displacement), np.zeros((3, scene.count))
    own = {side: fitted(edge.positions.T, displacement[:2, edge.nodes]) for side, edge in scene.edges.items()}
    where = scene.positions.T + displacement[:2]
    middle = {side: where[:, edge.nodes].mean(axis=1) for side, edge in scene.edges.items()}
    before = {side: edge.positions.mean(axis=0) for side, edge in scene.edges.items()}
    plain = np.zeros((3, scene.count))
    for side, (nodes, pull) in scene_forces(scene).items():
        low, high = ("bottom", "top") if side in ("left", "right") else ("left", "right")
        longer = np.hypot(*(middle[high] - middle[low])) / np.hypot(*(before[high] - before[low]))
        plain[:2, nodes] += longer * turn(0.5 * (own[side] + own[OPPOSITE[side]])) @ pull
        plain[2, nodes] += longer * moments(scene)[side]
    loaded = tractions.nodes
    left = plain[:2].sum(axis=1)
    plain[:2, loaded] -= left[:, None] / len(loaded)
    arm = where[:, loaded] - where[:, loaded].mean(axis=1, keepdims=True)
    unbalanced = np.sum(arm[0] * plain[1, loaded] - arm[1] * plain[0, loaded]) + plain[2].sum()
    plain[:2, loaded] -= unbalanced / np.sum(arm**2) * np.array([-arm[1], arm[0]])

    # angles and sums of some fifty terms
    np.testing.assert_allclose(force, plain, rtol=0.0, atol=1e-13 * 8.0 * 3e6)
    assert (abs(unbalanced) > 1e-3 * 3e6) == follows  # forces of a packing at rest turn nothing
    assert not np.array_equal(force, tractions.forces(still)) or not follows


def scene_forces(scene: DiskScene) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Nodes and forces (2, k) of the sides under STRESS as built."""
    return {side: (each.node, each.under(np.array(STRESS))[:2]) for side, each in side_forces(scene).items()}


def moments(scene: DiskScene) -> dict[str, np.ndarray]:
    """Moments (k,) of the sides under STRESS."""
    return {side: each.under(np.array(STRESS))[2] for side, each in side_forces(scene).items()}


@pytest.mark.parametrize("changes", [FOLLOWING, *STILL.values()], ids=["updated", *STILL])
def test_tractions_neither_move_nor_turn_a_body(random_body, changes: dict) -> None:
    scene = random_body(**changes)
    tractions = Tractions(scene, STRESS)
    for displacement in (np.zeros((3, scene.count)), moved(scene), turned(scene, 0.7) + moved(scene, 2)):
        force = tractions.forces(displacement)
        where = displacement if changes is FOLLOWING else np.zeros_like(displacement)
        scale = np.abs(force).sum()
        # sums of some fifty terms, of arms of 20 m
        assert abs(torque(scene, force, where)) < 20.0 * 1e-14 * scale
        assert np.abs(force[:2].sum(axis=1)).max() < 1e-14 * scale
