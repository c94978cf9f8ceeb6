"""The rotation of a body as a whole, and stress, particle by particle, where it is known by hand."""

import numpy as np
import pytest
from disk_systems import BODY, DENSE, WRAP, turn

from dembound.disks.contacts.pairs import plain_contacts
from dembound.disks.scene import DiskScene, build
from dembound.disks.stability import choose_step
from dembound.disks.stepping.fields import particle_stress, turned_as_a_whole, turns_freely
from dembound.kernels.contacts import REFERENCE
from dembound.motion.simulation import Simulation

RANDOM = DENSE | {"pattern": "C", "edge_radius": 0.25}
VISCOUS = {"type": "viscous"}
PUSHED = {"wave": {"pulse": {"type": "cosine", "amplitude": 1.0, "period": 0.1}}}
SIDES = ("left", "right", "bottom", "top")


@pytest.mark.parametrize(
    ("changes", "free"),
    [
        ({"boundary": {side: VISCOUS for side in SIDES}}, True),
        ({"boundary": {"left": {"type": "viscous_input", "wave_p": "pulse", "half_mass": True}}, **PUSHED}, True),
        ({"boundary": {"left": VISCOUS, "bottom": {"type": "fixed"}}}, False),
        ({"boundary": {"right": {"type": "viscoelastic", "distance": 40.0}}}, False),
        ({"boundary": {side: WRAP[side] for side in ("left", "right")}}, False),
        ({"boundary": {"left": {"type": "free_field"}}}, False),
        ({"motion.held": ["rotation"]}, False),
    ],
)
def test_only_what_nothing_but_dashpots_holds_turns_freely(bar, changes: dict, free: bool) -> None:
    assert turns_freely(build(bar({**BODY, "packing.size": [4.0, 2.0], **changes}))) is free


@pytest.fixture
def body(bar) -> DiskScene:
    """Random disks, those on the left half cells: masses differ, and their centre is not that of the places."""
    return build(bar({**BODY, "packing": RANDOM, "boundary": {"left": {**VISCOUS, "half_mass": True}}}))


def datum_of(body: DiskScene) -> np.ndarray:
    """Displacements (3, n) of a body that has settled."""
    return 0.1 * np.random.default_rng(1).uniform(-1.0, 1.0, (3, body.count))


def arms(body: DiskScene, datum: np.ndarray) -> np.ndarray:
    """Places (2, n) at the datum from the centre of mass."""
    places = body.positions.T + datum[:2]
    return places - (places * body.mass).sum(axis=1, keepdims=True) / body.mass.sum()


def tangent(body: DiskScene, datum: np.ndarray, angle: float) -> np.ndarray:
    """Displacements (3, n) of a turn as the law of small displacements has it."""
    x, y = arms(body, datum)
    return angle * np.stack([-y, x, np.ones(body.count)])


@pytest.mark.parametrize("angle", [0.01, -0.4])
def test_a_turn_along_the_tangent_becomes_one_that_keeps_all_distances(body: DiskScene, angle: float) -> None:
    datum = datum_of(body)
    drift = np.array([[3.0], [-2.0], [0.0]])
    moved = datum + tangent(body, datum, angle) + drift
    spun = moved[2].copy()
    v = np.random.default_rng(2).uniform(-1.0, 1.0, (3, body.count)) + np.array([[5.0], [3.0], [1.0]])
    moved, turned = turned_as_a_whole(body, moved, v.copy(), datum)
    arm, mean = arms(body, datum), np.average(v[:2], axis=1, weights=body.mass)[:, None]

    # the centre of mass goes on as before; sums of 60 numbers of size 10
    np.testing.assert_allclose(moved[:2], datum[:2] + drift[:2] + (turn(angle) - np.eye(2)) @ arm, rtol=0.0, atol=1e-13)
    places = [body.positions.T + displacement[:2] for displacement in (datum, moved)]
    before, after = (np.hypot(*(p[:, None] - p[:, :, None])) for p in places)
    np.testing.assert_allclose(after, before, rtol=0.0, atol=2e-13)
    assert np.array_equal(moved[2], spun)
    # velocities turn about that of the centre
    np.testing.assert_allclose(turned[:2], mean + turn(angle) @ (v[:2] - mean), rtol=0.0, atol=1e-13)
    assert np.array_equal(turned[2], v[2])


K = 2500.0 * 1000.0**2
"""Normal stiffness of a lattice contact and its bond, N/m; without friction the bond's half carries the shear."""
BRICK = {"pattern": "B", "size": [5.0, 5.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [5.0, 5.0]}


def elastic_stress(scene: DiskScene, displacement: np.ndarray) -> np.ndarray:
    """Stress from the pairs of the elastic law, which store no forces."""
    return particle_stress(
        scene, plain_contacts(scene.ground, scene.assembly, scene.layout.slot), displacement, REFERENCE
    )


def test_a_strained_lattice_answers_with_its_stiffness(bar) -> None:
    scene = build(bar({**BODY, "packing.size": [4.0, 4.0]}))
    xx, yy, shear = 1e-6, -2e-6, 3e-6
    x, y = scene.assembly.positions.T
    displacement = np.stack([xx * x + shear * y, yy * y, np.full(scene.count, -0.5 * shear)])
    inner = ((scene.assembly.positions > 0.5) & (scene.assembly.positions < 3.5)).all(axis=1)
    stress = elastic_stress(scene, displacement)[inner]

    # one contact per row and column: no Poisson effect; with a rotation of −γ/2 both shear stresses are k_s γ/2.
    # Displacements of 1e-5 m are rounded by 1e-21 m, 2e-15 of a contact's stretch
    expected = [K * xx, K * yy, 0.5 * K * 0.5 * shear]
    np.testing.assert_allclose(stress, np.tile(expected, (len(stress), 1)), rtol=0.0, atol=1e-14 * K * shear)


def test_half_cells_answer_as_whole_ones_do(bar) -> None:
    sides = {side: {"type": "viscous", "half_mass": True} for side in ("left", "bottom")}
    scene = build(bar({**BODY, "packing.size": [4.0, 4.0], "boundary": sides}))
    xx, yy = 1e-6, -2e-6
    x, y = scene.assembly.positions.T
    displacement = np.stack([xx * x, yy * y, 0.0 * x])
    stress = elastic_stress(scene, displacement)

    assert set(scene.cell_fraction) == {0.25, 0.5, 1.0}
    kept = (x < 3.5) & (y < 3.5)  # right and top are whole cells with one contact less
    # rounding as above
    np.testing.assert_allclose(stress[kept, :2], np.tile([K * xx, K * yy], (kept.sum(), 1)), atol=1e-14 * K * abs(yy))


LOCKED_IN = {"material.law": "linearpbond", "material.locked_in": 3e6, "static": {}}


def test_the_locked_in_stress_is_in_it(bar) -> None:
    scene = build(bar({**BODY, "boundary": WRAP, "packing": BRICK, **LOCKED_IN}))
    simulation = Simulation(scene, choose_step(scene)[0])
    system, displacement = simulation.system, simulation.state.displacement
    system.contacts["body"].push(displacement)
    area = np.pi * scene.assembly.radii**2
    mean = np.average(system.stress(displacement), axis=0, weights=area)

    # 3 MPa in place of the 10 MPa it was packed under; overlaps are 2e-3 of the diameter, rounding is 1e-13 of them
    packed = scene.ground.brick.stress
    np.testing.assert_allclose(mean, 3e6 * packed / -(0.5 * packed[:2].sum()), rtol=1e-11)
