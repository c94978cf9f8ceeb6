"""The order in which kernels hold particles does not matter: rows of copies move as particles one by one do."""

from dataclasses import replace

import numpy as np
import pytest

from dembound.disks.contacts.layout import contact_rows
from dembound.disks.stability import choose_step
from dembound.motion.simulation import Simulation

STEPS = 400
SIDES = {"left": {"type": "viscous_input", "wave_p": "pulse", "wave_s": "pulse"}, "right": "viscous"}
FREE_FIELD = {"left": "free_field", "right": "free_field", "bottom": {**SIDES["left"]}}
HALF_CELLS = {"left": {"type": "viscous_input", "wave_p": "pulse"}, "right": {"type": "viscous", "half_mass": True}}


def in_order(scene):
    """The scene held particle by particle."""
    rows = tuple(contact_rows(scene.assembly.part(part), scene.ground, part.start) for part in scene.parts.values())
    return replace(scene, slots=None, rows=rows)


def assert_same_motion(scene, *, damp=0.0):
    step = choose_step(scene)[0] / np.sqrt(1.0 + damp)
    simulations = [Simulation(each, step, damp=damp) for each in (in_order(scene), scene)]
    for simulation in simulations:
        simulation.advance(STEPS)
    before, after = (simulation.state for simulation in simulations)
    # sums in another order differ by the rounding of displacements, a few ε·u/Δt of velocity per step
    largest = np.abs(before.displacement).max()
    tolerance = 4.0 * np.finfo(float).eps * largest / step * STEPS
    if damp > 0.0:  # its force jumps where a velocity changes its sign, which rounding may move by a step
        tolerance = 1e-7 * np.abs(before.peaks).max()
    assert not scene.layout.is_plain
    assert np.abs(before.peaks).max() > 0.1  # the pulse did run
    np.testing.assert_allclose(after.velocity, before.velocity, rtol=0.0, atol=tolerance)
    np.testing.assert_allclose(after.peaks, before.peaks, rtol=0.0, atol=tolerance)
    # works are differences of what came in and what went out, some STEPS terms of the size of the pulse's energy
    energy = 0.5 * scene.mass.sum() * np.abs(before.peaks).max() ** 2
    accuracy = 1e-7 if damp > 0.0 else np.finfo(float).eps * STEPS
    np.testing.assert_allclose(after.work, before.work, rtol=0.0, atol=accuracy * energy)


HELD = {"left": {"type": "viscous_input", "wave_s": "pulse"}, "right": "viscous", "top": "viscous"}
SCENES = {
    "nothing held": ("C", {"boundary": SIDES}),
    "half cells, y held": ("A", {"held": ("y", "rotation"), "boundary": HALF_CELLS}),
    "free field": ("B", {"boundary": FREE_FIELD}),
    "x held": ("B", {"held": ("x",), "boundary": HELD}),
    "rotation held": ("B", {"held": ("rotation",), "boundary": SIDES}),
}


@pytest.mark.parametrize("name", SCENES)
def test_they_move_alike(lab, name):
    pattern, words = SCENES[name]
    assert_same_motion(lab.scene(pattern, (20.0, 20.0), wave=lab.pulse(0.02), **({"held": ()} | words)))


def test_local_damping_and_its_work(lab):
    assert_same_motion(lab.scene("B", (20.0, 20.0), held=(), boundary=SIDES, wave=lab.pulse(0.02)), damp=0.3)


def assert_same_breaking(scene, steps):
    """Assert equal cracks in equal steps, and equal motion until rounding has grown in contacts that open."""
    step = choose_step(scene)[0]
    before, after = (Simulation(each, step) for each in (in_order(scene), scene))
    for simulation in (before, after):
        for contacts in simulation.system.contacts.values():  # pairs are searched for as if any two disks might meet
            contacts.cells = contacts.cells._replace(reach=0.0)
        simulation.advance(steps // 3)
    # disks that just touch open or stay closed by rounding: of a random packing a push of 1e-13 m/s moves velocities by
    # 1e-6 m/s within 25 steps
    accuracy = 1e-9 if scene.case.packing.pattern == "A" else 1e-5
    tolerance = accuracy * np.abs(before.state.peaks).max()
    np.testing.assert_allclose(after.state.velocity, before.state.velocity, rtol=0.0, atol=tolerance)
    energy = 0.5 * scene.mass.sum() * np.abs(before.state.peaks).max() ** 2
    np.testing.assert_allclose(after.state.work, before.state.work, rtol=0.0, atol=accuracy * energy)
    for simulation in (before, after):
        simulation.advance(steps - steps // 3)
    expected, found = (simulation.system.take_cracks(steps) for simulation in (before, after))
    np.testing.assert_array_equal(found.step, expected.step)
    np.testing.assert_array_equal(found.pair, expected.pair)
    np.testing.assert_array_equal(found.shear, expected.shear)
    for part in after.system.parts:
        assert part.contacts.rows is not None
        near = part.contacts.of("contact_type").max() >= len(part.contacts.bonds)
        assert near == (scene.case.packing.pattern == "B")  # pairs without a bond are there
        assert part.contacts.origin.any()  # pairs were searched for on the way
    return expected, after.state.work


def test_bonds_that_are_kept_beside_others_that_break(lab):
    strength = {"pb_ten": 4e5, "pb_coh": 4e5, "fric": 0.5}
    law = {"law": "linearpbond", "geometry": "reference", "elastic_start": False, **strength}
    sides = {"left": SIDES["left"], "right": "viscous", "bottom": {"type": "viscous", "intact": 3}}
    scene = lab.scene("A", (20.0, 20.0), held=(), boundary=sides, wave=lab.pulse(0.01), material=law)
    cracks, _ = assert_same_breaking(scene, 300)
    assert len(cracks) > 50
    assert not scene.intact[cracks.pair].any()
    assert scene.positions[cracks.pair, 1].min() < 2.5  # they reach the zone of three rows of 0.5 m


@pytest.mark.parametrize(("pattern", "geometry"), [("A", "reference"), ("B", "updated")])
def test_bonds_that_break_and_contacts_that_slide(lab, pattern, geometry):
    # pulses of ρcv = 1.25 MPa against a strength of some tenths of that
    strength = {"pb_ten": 4e5, "pb_coh": 4e5, "fric": 0.5}
    law = {"law": "linearpbond", "geometry": geometry, "elastic_start": False, **strength}
    scene = lab.scene(pattern, (20.0, 20.0), held=(), boundary=SIDES, wave=lab.pulse(0.01), material=law)
    cracks, work = assert_same_breaking(scene, 300)

    assert len(cracks) > 50
    assert work[0, 2] > 0.0  # friction
