"""Stress, particle by particle, where it is known by hand, and that looking at it changes nothing."""

import numpy as np
from disk_systems import BODY, WRAP

from dembound.disks.contacts.pairs import plain_contacts
from dembound.disks.scene import DiskScene, build
from dembound.disks.stability import choose_step
from dembound.disks.stepping.fields import particle_stress
from dembound.kernels.contacts import REFERENCE
from dembound.motion.simulation import Simulation

K = 2500.0 * 1000.0**2
"""Normal stiffness of a lattice contact and its bond, N/m; without friction the bond's half carries the shear."""
RANDOM = {"pattern": "B", "size": [5.0, 5.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [5.0, 5.0]}


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
    scene = build(bar({**BODY, "boundary": WRAP, "packing": RANDOM, **LOCKED_IN}))
    simulation = Simulation(scene, choose_step(scene)[0])
    system, displacement = simulation.system, simulation.state.displacement
    system.contacts["body"].push(displacement)
    area = np.pi * scene.assembly.radii**2
    mean = np.average(system.stress(displacement), axis=0, weights=area)

    # 3 MPa in place of the 10 MPa it was packed under; overlaps are 2e-3 of the diameter, rounding is 1e-13 of them
    packed = scene.ground.brick.stress
    np.testing.assert_allclose(mean, 3e6 * packed / -(0.5 * packed[:2].sum()), rtol=1e-11)
