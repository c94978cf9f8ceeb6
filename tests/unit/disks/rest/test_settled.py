"""Mean stress of blocks where it is known by hand, which blocks there are, and the reports on their differences."""

import numpy as np
import pytest
from disk_systems import BODY, TWO_BRICKS, WRAP, fitted, shaken, turn

from dembound.boundaries import OPPOSITE
from dembound.disks.rest.settled import Blocks, Uniformity, block_stress
from dembound.disks.rest.static_scene import Tractions
from dembound.disks.scene import DiskScene, build
from dembound.disks.side_forces import packing_pieces, side_forces
from dembound.disks.stepping.system import DiskSystem
from dembound.motion.sides import _bearers

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


HALF = {"boundary": {side: {"type": "viscous", "half_mass": True} for side in ("bottom", "right")}}
PATTERNS = {
    "A": {"packing.size": [6.0, 4.0]},
    "half cells": {"packing.size": [6.0, 4.0], **HALF},
    "B": {"packing": TWO_BRICKS},
    "C": {"packing": TWO_BRICKS | {"pattern": "C", "edge_radius": 0.25}},
    "held rotation": {"packing": TWO_BRICKS, "motion.held": ["rotation"]},
}
STRESSES = [(-3e6, 0.0, 0.0), (0.0, 2e6, 0.0), (0.0, 0.0, 1e6)]


ALL = tuple(zip(PATTERNS, [*STRESSES, STRESSES[2], STRESSES[0]], strict=True))
"""Each pattern under a stress, each stress twice or once."""


@pytest.mark.parametrize(("pattern", "stress"), [*ALL, ("B", STRESSES[0])])
def test_an_elastic_body_rests_where_its_packing_does(bar, pattern: str, stress: tuple) -> None:
    """All displacements are those of the endless packing: a mean gradient and the corrector of each disk."""
    scene = build(bar({**BODY, **PATTERNS[pattern], "material.fric": 0.5}))
    continuum = scene.ground.continuum
    asked = np.array([stress[0], stress[1], stress[2], stress[2]])
    gradient = np.linalg.lstsq(continuum.tensor, asked, rcond=1e-9)[0]
    u = np.einsum("cng,g->cn", continuum.corrector, gradient)[:, scene.assembly.brick_particle]
    x, y = scene.positions.T
    xx, yy, xy, yx = gradient
    u[:2] += np.stack([xx * x + xy * y, yx * x + yy * y])
    force = scene.system(1e-5).forces.elastic(u)
    for each in side_forces(scene).values():
        force[:, each.node] += each.under(np.array(stress))
    held = list(scene.ground.held)
    force[held] = 0.0
    # the solve for correctors, of some hundred unknowns, and k·u of displacements of strain × 8 m
    assert np.abs(force).max() < 1e-9 * 3e6


@pytest.mark.parametrize(("pattern", "stress"), [*ALL[:4], ("B", STRESSES[1])])
def test_a_side_is_recorded_with_the_stress_times_its_length(bar, pattern: str, stress: tuple) -> None:
    """To rounding, also where contacts cross a corner, and all sides together with what acts on the body: nothing."""
    scene = build(bar({**BODY, **PATTERNS[pattern], "static": {"stress": stress}}))
    force, sides = Tractions(scene, stress).forces(np.zeros((3, scene.count))), list(scene.sides.values())
    xx, yy, xy = stress
    for edge, (node, share) in zip(sides, _bearers(sides, scene.forces_by_side), strict=True):
        outward = 1.0 if edge.side in ("right", "top") else -1.0
        expected = outward * edge.length * np.array([[xx, xy], [xy, yy]])[edge.axis]
        # the solve for correctors, and sums of a hundred forces
        np.testing.assert_allclose((share * force[:2, node]).sum(axis=1), expected, rtol=0.0, atol=1e-9 * 3e6 * 8.0)
