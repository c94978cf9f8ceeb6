"""A bond that is only bent breaks where pb_mcf |M|R̄/J reaches its tensile strength, and never with pb_mcf = 0."""

import numpy as np
import pytest

from dembound.disks.material.first_crack import first_crack
from dembound.laws.law import K

RADIUS, BONDS, STRENGTH = 0.25, 1e9, 1e6
MASS = 2500.0 * (2.0 * RADIUS) ** 2
BENDING = BONDS * RADIUS**2 / 3.0  # k̄_n J = pb_emod/(2R) · 2R³/3
SECTION = 1.5 / RADIUS**2  # R̄/J


def turned(lab, share: float, factor: float) -> tuple[bool, float]:
    """Two bonded disks get opposite spins, by which they turn to a `share` of the angle at which their bond breaks.

    Returns whether it broke, and the largest relative rotation over the one expected.
    """
    material = {"law": "linearpbond", "emod": 1e6, "pb_emod": BONDS, "pb_ten": STRENGTH, "pb_coh": 1e9}
    scene = lab.disks(
        [[0.0, 0.0], [2.0 * RADIUS, 0.0]],
        [RADIUS, RADIUS],
        [(0, 1)],
        held=(),
        material=material | {"pb_mcf": factor, "elastic_start": False},
    )
    # φ'' = −2k φ/I for the relative rotation φ, so that its largest value is φ'/√(2k/I)
    rate = np.sqrt(2.0 * BENDING / scene.inertia[0])
    angle = share * STRENGTH / ((factor or 1.0) * SECTION * BENDING)
    simulation = lab.simulation(scene, step=0.02 / rate, probes=[0, 1])
    simulation.state.velocity = np.array([[0.0, 0.0], [0.0, 0.0], [-0.5 * angle * rate, 0.5 * angle * rate]])
    record = simulation.advance(400)
    broke = len(simulation.system.take_cracks(400)) > 0
    return broke, float(np.abs(record[:, 1, 2] - record[:, 0, 2]).max() / angle)


@pytest.mark.parametrize("factor", [1.0, 0.5, 0.0])
def test_it_breaks_at_the_moment_that_counts(lab, factor):
    """The half step before a run is not known at the first step: angles are exact to 1e-4 with 300 steps a period."""
    below, reached = turned(lab, 0.99, factor)
    assert not below
    assert reached == pytest.approx(1.0, abs=1e-3)
    above, _ = turned(lab, 1.01, factor)
    assert above == (factor > 0.0)
    far, _ = turned(lab, 20.0, factor)
    assert far == (factor > 0.0)


def test_the_first_crack_of_a_packing_and_load_factors_count_it_too(lab):
    """Without moments the first bond of a random packing breaks later, by the stress along bonds alone."""
    given = {"law": "linearpbond", "fric": 0.5, "pb_ten": 1e6, "pb_coh": 1e9}
    found = {}
    for factor in (1.0, 0.5, 0.0):
        ground = lab.scene("B", (5.0, 5.0), brick=(5.0, 5.0), material=given | {"pb_mcf": factor}).ground
        found[factor] = first_crack(ground, ground_material(lab, given | {"pb_mcf": factor}), 1.0).stress
        assert ground.contact_constants[0, K.per_section] == pytest.approx(
            factor * 1.5 / (ground.contact_constants[0, K.per_area] ** -1 / 2.0) ** 2
        )
    assert found[1.0] < found[0.5] < found[0.0]


def ground_material(lab, material):
    """The material of a case."""
    return lab.case("B", (5.0, 5.0), brick=(5.0, 5.0), material=material).material
