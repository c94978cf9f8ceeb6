"""Networks condensed to some disks, beside the same by dense algebra."""

import math

import numpy as np
import pytest
from small_cases import GRAINS, small

from dembound.disks.reflection.bricks import BrickInRow, end_of, end_scene
from dembound.disks.reflection.condensed import Body, Condensed, Oscillation
from dembound.disks.scene import build, ground_of


def dense(body: Body, interface: np.ndarray, oscillation: Oscillation, phase: complex) -> np.ndarray:
    """D_kk − D_ki D_ii⁻¹ D_ik of all degrees of freedom that move."""
    matrix = np.zeros((len(body.mass), len(body.mass)), dtype=complex)
    for network, phases in ((body.within, 1.0), (body.beyond, phase**body.periods)):
        ways = network.motion_matrix(phases).toarray()
        matrix += ways.conj().T @ (network.springs[:, None] * ways)
    matrix += np.diag(body.stiffness - oscillation.square * body.mass + oscillation.rate * body.damping)
    others = np.setdiff1d(np.flatnonzero(body.moves), interface)
    k, i = np.ix_(interface, interface), np.ix_(others, others)
    inner = np.linalg.solve(matrix[i], matrix[np.ix_(others, interface)])
    return matrix[k] - matrix[np.ix_(interface, others)] @ inner


@pytest.mark.parametrize("held", [(), ("y",)])
def test_one_factorisation_condenses_as_dense_algebra_does(held) -> None:
    """Of a brick in the row, and of the end with its dashpots, beside copies with a phase."""
    plain = {"boundary": {"right": {"type": "viscous"}}}
    case = small({**GRAINS, **plain, "motion": {"held": list(held)}})
    row = BrickInRow(ground_of(case), "right")
    oscillation, phase = Oscillation(2.0 * math.pi * 60.0, 2e-4), np.exp(0.7j)
    for condensed in (row.condensed, end_of(end_scene(case, "right"), row)):
        assert isinstance(condensed, Condensed)
        condensed.at(oscillation)
        expected = dense(condensed.body, condensed.interface, oscillation, phase)
        np.testing.assert_allclose(condensed.stiffness(phase), expected, atol=1e-9 * np.abs(expected).max())


def test_parts_that_are_not_connected_condense_alike() -> None:
    """Without friction and bonds' shear, x and y of a lattice have nothing to do with each other."""
    changes = {"packing": {"pattern": "A", "size": [4.0, 4.0], "radius": 0.5}, "material.fric": 0.0}
    case = small(GRAINS, changes=changes)
    scene = build(case)
    row = BrickInRow(scene.ground, "right")
    row.condensed.at(Oscillation(30.0, 0.0))
    found = row.condensed.stiffness(1.0)
    expected = dense(row.condensed.body, row.condensed.interface, Oscillation(30.0, 0.0), 1.0)
    np.testing.assert_allclose(found, expected, atol=1e-9 * np.abs(expected).max())


def test_steps_of_central_differences_change_frequencies() -> None:
    """In u e^{iωt}: (u₊ − 2u + u₋)/Δt² = −(2/Δt sin(ωΔt/2))² u, (u₊ − u₋)/2Δt = i sin(ωΔt)/Δt u."""
    omega, step = 50.0, 7e-3
    before, now, after = np.exp(1j * omega * step * np.arange(-1, 2))
    oscillation = Oscillation(omega, step)
    assert -(after - 2.0 * now + before) / step**2 == pytest.approx(oscillation.square)
    assert (after - before) / (2.0 * step) == pytest.approx(oscillation.rate)
    assert Oscillation(omega, 0.0).square == omega**2
    assert Oscillation(omega, 0.0).rate == 1j * omega
