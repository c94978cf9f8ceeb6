"""Reflection of plane waves by a side with a continuum beyond: little more than its layers' formula.

Three layers with R0 = 1e-4 and 17 nodes in the S wave; `angles` is exact for the discrete equations, which the last two
tests are about.
"""

from dataclasses import replace

import numpy as np
import pytest
from angles import FREQUENCY, Side, reflection
from element_row import ROWS, Row

from dembound.continuum.layer import Absorption
from dembound.continuum.part import GridPart
from dembound.disks.scene import DiskScene
from dembound.kernels.grid import move
from dembound.kernels.tables import Body
from dembound.motion.state import Layout, aligned_zeros

FLOOR = 4e-4
"""Reflection by elements with 17 nodes in the shortest S wave: 2e-4 was measured at normal incidence."""


@pytest.fixture(scope="module")
def side() -> Side:
    return Side.of()


def with_layers(scene: DiskScene, absorption: Absorption) -> DiskScene:
    """The scene with other settings of its layers."""
    body = replace(scene.outside.body, absorption=absorption)
    return replace(scene, outside=replace(scene.outside, body=body))


@pytest.mark.parametrize("motion", ["p", "s"])
@pytest.mark.parametrize("angle", [0.0, 30.0, 45.0, 75.0])
def test_the_formula_bounds_what_comes_back(side: Side, motion: str, angle: float) -> None:
    """Waves that change their kind at the outer edge go in as one and out as the other: the mean of both exponents.

    An edge at rest makes of an S wave at θ a P wave of sin 2θ/cos(θ − θ_p) times its amplitude, at most √2 (at 45°,
    where θ_p is 90°), and of a P wave an S wave of less.
    """
    found, other = reflection(side, motion, angle), "sp"["ps".index(motion)]
    own, beyond = (side.speeds["ps".index(kind)] for kind in (motion, other))
    turned = float(np.degrees(np.arcsin(min(1.0, np.sin(np.radians(angle)) * beyond / own))))

    assert found[motion] <= side.formula(motion, angle) + FLOOR
    assert found[other] <= np.sqrt(2.0 * side.formula(motion, angle) * side.formula(other, turned)) + FLOOR


def test_without_absorption_all_comes_back() -> None:
    """The outer edge is at rest: energy is conserved by disks, ties and elements to rounding."""
    side = Side.of(damping=0.0)
    still = replace(side, scene=with_layers(side.scene, Absorption(reflection=1.0, delay=0.0)))
    for motion in "ps":
        assert reflection(still, motion, 40.0)["energy"] == pytest.approx(1.0, abs=1e-6)


def test_forces_of_a_row_are_those_of_the_kernels(side: Side) -> None:
    """For all elements moved by a wave of any shape along the side, once convolution variables have become periodic.

    A large α makes them forget faster, by e^(−αΔt) or less for 1,000 steps: e⁻²⁵.
    """
    scene = with_layers(side.scene, Absorption(shift=30.0))
    body = replace(scene.outside.body, first_slot=0)
    row = Row(scene, side.step, 2.0 * np.pi * FREQUENCY, 0.07)
    rng = np.random.default_rng(5)
    motion = np.zeros(row.count, dtype=complex)
    motion[row.moving] = np.array([1.0, 1.0j]) @ rng.standard_normal((2, len(row.moving)))
    phase = np.exp(1j * row.along * row.size[1])
    u = np.zeros((2, body.count), dtype=complex)
    for element, own in enumerate(row.elements):
        for k in range(ROWS):
            beside = np.flatnonzero((row.mesh.elements == row.mesh.elements[own] + [0, k - ROWS // 2]).all(axis=1))
            values = (row.spread(element) @ motion).reshape(2, -1) * phase ** (k - ROWS // 2)
            u[:, row.mesh.nodes[beside[0]].ravel()] = values
    forces = _forces(GridPart(body, side.step), u, row)
    expected = row.grid() @ motion

    assert len(row.elements) > 2
    for element, own in enumerate(row.elements):
        nodes = row.mesh.nodes[own][:-1].ravel()  # its upper edge is that of the next row
        found = forces[:, nodes] + row.accelerated**2 * body.mass[nodes] * u[:, nodes]
        exact = (row.spread(element) @ expected).reshape(2, -1)[:, : len(nodes)]
        moves = ~row.mesh.held[nodes]
        np.testing.assert_allclose(found[:, moves], exact[:, moves], rtol=0.0, atol=1e-8 * np.abs(exact).max())


def _forces(part: GridPart, u: np.ndarray, row: Row) -> np.ndarray:
    """Forces (2, n) of the kernels on all nodes, complex, after 1,000 steps of a given motion u e^(−iωt)."""
    layout, law = Layout(part.body.blocks.slot, part.body.blocks.end), part.law()
    body = Body(np.zeros(layout.count), np.zeros(layout.count), np.ones(3), np.zeros((3, 0)), 0.0, row.step)
    supported, found = np.zeros(0, dtype=np.int64), []
    for quarter in (1.0, 1.0j):  # a motion a quarter of a period later gives the imaginary part
        for saved in part.saved_arrays().values():
            saved[:] = 0.0
        for step in range(-1000, 1):
            now = quarter * u * np.exp(-1j * row.frequency * row.step * step)
            at, rate = (aligned_zeros(3, layout.count) for _ in range(2))
            at[:2, layout.slot], rate[:2, layout.slot] = now.real, (row.rate * now).real
            force = aligned_zeros(3, layout.count)
            move(law, at, force, rate, body, supported)
        found.append(force[:2, layout.slot])
    return found[0] - 1j * found[1]
