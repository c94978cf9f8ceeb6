"""The numbering of the particles is bookkeeping: another one gives the same motion."""

from dataclasses import replace

import numpy as np
import pytest

from dembound.disks.beyond.edges import find_edges
from dembound.disks.contacts.rows import contact_rows
from dembound.disks.scene import with_boundaries
from dembound.disks.stability import choose_step
from dembound.kernels.tables import NeighbourTable
from dembound.motion.simulation import Simulation

STEPS = 1000


@pytest.fixture(scope="module")
def scene(lab):
    boundary = {"left": {"type": "viscous_input", "wave_p": "pulse", "wave_s": "pulse"}, "right": "viscous"}
    scene = lab.scene("B", (30.0, 10.0), held=(), boundary=boundary, wave=lab.pulse(0.02))
    return replace(scene, slots=None, rows=(contact_rows(scene.assembly, scene.ground),))


@pytest.fixture(scope="module")
def number(scene):
    """New number of every particle."""
    return np.random.default_rng(0).permutation(scene.count)


def renumbered(scene, number):
    """The scene under new numbers, put together as if it had been tiled so."""
    old, body = np.argsort(number), scene.assembly
    pairs = number[body.pairs]
    order = np.lexsort((body.contact_type, pairs[:, 0]))
    body = replace(
        body,
        positions=body.positions[old],
        radii=body.radii[old],
        brick_particle=body.brick_particle[old],
        tile=body.tile[old],
        pairs=pairs[order],
        contact_type=body.contact_type[order],
    )
    edges = find_edges(body, (False, False))
    scene = replace(scene, assembly=body, rows=(contact_rows(body, scene.ground),), edges=edges)
    return with_boundaries(scene, scene.case)


def rows_in_old_order(scene, number):
    """The rows of contacts under new numbers, each row's contacts in the order of the old one."""
    (contacts,), old = scene.rows, np.argsort(number)
    counts = np.diff(contacts.start.astype(int))
    start = np.concatenate([[0], np.cumsum(counts[old])])
    entries = np.concatenate([np.arange(contacts.start[i], contacts.start[i + 1]) for i in old])
    return NeighbourTable(
        0,
        start.astype(np.uint32),
        number[contacts.neighbour[entries]].astype(np.uint32),
        contacts.contact_type[entries],
        contacts.constants,
    )


def motion(scene, step):
    simulation = Simulation(scene, step)
    simulation.advance(STEPS)
    return simulation


def test_edges_are_the_same_particles(scene, number):
    other = renumbered(scene, number)
    for side, edge in scene.edges.items():
        np.testing.assert_array_equal(other.edges[side].nodes, number[edge.nodes])


def test_same_motion(scene, number):
    step = choose_step(scene)[0]
    before, after = motion(scene, step), motion(renumbered(scene, number), step)
    # sums in another order differ by the rounding of displacements, a few ε·u/Δt of velocity per step, and the
    # motion is stable: the worst sum is proportional to the steps
    largest = np.abs(before.state.displacement).max()
    tolerance = 4.0 * np.finfo(float).eps * largest / step * STEPS
    np.testing.assert_allclose(after.state.velocity[:, number], before.state.velocity, rtol=0, atol=tolerance)
    assert np.abs(before.state.velocity).max() > 0.1  # the pulses did run


def test_same_bits_when_rows_keep_their_order(scene, number):
    step = choose_step(scene)[0]
    other = replace(renumbered(scene, number), rows=(rows_in_old_order(scene, number),))
    before, after = motion(scene, step), motion(other, step)
    np.testing.assert_array_equal(after.state.velocity[:, number], before.state.velocity)
    np.testing.assert_array_equal(after.state.displacement[:, number], before.state.displacement)
