"""Between free-field sides an untouched body moves as its column does, whatever the packing and the wave.

Body and column are of the same bricks; what comes across the seam is what the column's particles feel there, static
part and moment included, so nothing is calibrated and nothing is left over.
"""

import numpy as np
import pytest

from dembound.disks.rest.stage import settle
from dembound.disks.scene import build
from dembound.disks.stability import choose_step
from dembound.kinds import with_changes
from dembound.motion.simulation import Simulation

HEIGHT, WIDTH = 20.0, 20.0
"""m, two bricks each way: the fewest that make a body wider than its column, which is one brick wide."""
EPS = np.finfo(float).eps


def ground(
    lab, pattern: str, period: float, *, width=WIDTH, height=HEIGHT, material=None, wave="s", half=False, **words
):
    """Ground between free-field sides, a pulse from below and a free top."""
    base = {"type": "viscous_input", "half_mass": half} | {f"wave_{way}": "pulse" for way in wave}
    sides = {side: {"type": "free_field"} for side in ("left", "right")}
    return lab.case(
        pattern,
        (width, height),
        held=(),
        material=material,
        boundary={**sides, "bottom": base},
        wave=lab.pulse(period),
        **words,
    )


@pytest.mark.parametrize("wave", ["s", "ps"])
@pytest.mark.parametrize("pattern", ["A", "B", "C"])
def test_every_particle_moves_as_its_twin(lab, pattern, wave):
    """Up, reflected at the surface and out through the base, to 1e-9 of the peak for the whole run."""
    scene = build(ground(lab, pattern, 0.05, wave=wave))
    step, _ = choose_step(scene)
    simulation = Simulation(scene, step)
    furthest = peak = 0.0
    for _ in range(int(0.15 / step / 20)):
        simulation.advance(20)
        apart = simulation.state.velocity - simulation.state.velocity[:, scene.seam.twin]
        furthest = max(furthest, np.abs(apart[:2]).max())
        peak = max(peak, np.abs(simulation.state.velocity[:2]).max())
    assert peak > 0.9
    assert furthest < 1e-9 * peak


def test_contacts_with_a_memory_are_met_across_the_seam_too(lab):
    material = {"law": "linearpbond", "fric": 0.5, "elastic_start": False}
    case = ground(lab, "C", 0.05, material=material)
    # when contacts open depends on the base's factors, and multiplies rounding: 1e-13 apart at 1, 1e-9 at 0.95
    scene = build(with_changes(case, {"boundary.bottom.beta_p": 1.0, "boundary.bottom.beta_s": 1.0}))
    simulation = Simulation(scene, choose_step(scene)[0])
    simulation.run(400)
    apart = np.abs(simulation.state.velocity - simulation.state.velocity[:, scene.seam.twin])[:2].max()
    assert np.abs(simulation.state.velocity[:2]).max() > 0.2
    assert apart < 1e-9 * 0.5


@pytest.mark.parametrize("half", [False, True])
def test_the_surface_doubles_and_the_base_lets_go(lab, half):
    """2.000 times the incident peak on the lattice; afterwards only what an end of whole masses leaves, if it has them.

    An end of whole cells returns (D/4c)·π/T of the peak, and more as its disks turn less than those inside (1.27 is
    derived in test_shear_bar); the surface doubles it. Half cells leave its square.
    """
    period, height = 0.1, 60.0
    scene = build(ground(lab, "A", period, width=5.0, height=height, material={"fric": 0.5}, half=half))
    speed = scene.ground.wave_speeds(1)[1]
    step, _ = choose_step(scene)
    top = scene.edges["top"].nodes
    simulation = Simulation(scene, step, top)
    record = simulation.advance(int((2.0 * height / speed + 2.2 * period) / step))[:, :, 3]
    assert record.max() == pytest.approx(2.0 * 0.5, rel=2e-3)
    late = step * np.arange(len(record)) > height / speed + 1.15 * period
    whole = 2.0 * 0.5 * np.pi * lab.diameter / (4.0 * speed * period)
    left = np.abs(record[late]).max()
    if half:
        # (D/4c·π/T)² twice, and as much from the wave's own dispersion over 120 disks
        assert left < 1e-3 * 0.5
    else:
        assert whole < left < 1.4 * whole


def test_p_and_sv_at_once_are_the_sum(lab):
    motions = []
    for wave in ("p", "s", "ps"):
        scene = build(ground(lab, "B", 0.05, wave=wave))
        simulation = Simulation(scene, choose_step(scene)[0])
        simulation.run(250)
        motions.append(simulation.state.velocity[:2])
    alone = motions[0] + motions[1]
    # 250 steps of sums that each round by ε of the whole, met by contact forces some ten times those of the wave
    assert np.abs(alone - motions[2]).max() < 10.0 * 250 * EPS * np.abs(alone).max()


@pytest.mark.parametrize("pattern", ["A", "B", "C"])
def test_gravity_settles_between_free_field_sides(lab, pattern):
    case = with_changes(
        ground(lab, pattern, 0.05),
        {
            "static": {"boundary": {"bottom": {"type": "fixed"}}},
            "load": [{"name": "gravity", "acceleration": [0.0, -9.81]}],
            "wave.pulse.start": 100.0,
        },
    )
    scene = build(case)
    settled = settle(scene)
    sunk = settled.start.displacement
    # body and column each come to rest within the force ratio of 1e-5, which the body's width of two bricks and its
    # height of 40 disks multiply in displacements
    assert np.abs(sunk - sunk[:, scene.seam.twin])[1].max() < 1e-2 * np.abs(sunk).max()
    simulation = lab.settled(scene, settled.start)
    simulation.run(1000)
    assert np.abs(simulation.state.velocity).max() < 1e-9 * 0.5
