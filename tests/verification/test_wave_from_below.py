"""A plane wave enters a periodic column from a continuum below, doubles at the free top, and leaves.

Disks and continuum differ by the dispersion of the lattice, (κD)²/24 of the phase, and the ties by about as much. Z's
pulse of 0.1 s has most of its spectrum below 10 Hz: κD ≤ 0.044 for S waves of 707 m/s and disks of 0.5 m, 0.063 where
they run at 500 m/s. In random packings the local motion differs by what the correctors leave out, of second order, too,
in the size of the brick, κL ≤ 0.45.
"""

import numpy as np
import pytest

from dembound.disks.scene import build
from dembound.disks.stability import choose_step
from dembound.motion.simulation import Simulation

PERIOD = 0.1
PULSE = {"type": "cosine", "amplitude": 1.0, "period": PERIOD}
BELOW = {"left": "periodic", "right": "periodic"}


@pytest.mark.parametrize(("pattern", "motion", "fric"), [("A", "p", 0.5), ("A", "s", 0.0), ("B", "s", 0.5)])
def test_it_enters_at_its_time_doubles_at_the_top_and_leaves(lab, pattern: str, motion: str, fric: float) -> None:
    size, packing = ((0.5, 30.0), {}) if pattern == "A" else ((5.0, 20.0), {"brick": (5.0, 5.0)})
    boundary = BELOW | {"bottom": {"type": "outside", f"wave_{motion}": "pulse"}}
    case = lab.case(pattern, size, held=(), material={"fric": fric}, boundary=boundary, wave=PULSE, **packing)
    scene = build(case)
    axis, height = (1 if motion == "p" else 0), size[1]
    speed = float(scene.outside.body.medium.plane_waves((0.0, 1.0))[0][axis])
    step = choose_step(scene)[0]
    times = step * np.arange(int((2.0 * height / speed + PERIOD + 0.2) / step))
    velocity = Simulation(scene, step, np.arange(scene.count)).advance(len(times))[:, :, 3:5]
    y, disks, nodes = scene.positions[: scene.recorded, 1], velocity[:, : scene.recorded], velocity[:, scene.recorded :]

    # datum: the wave passes y = 0 at its own time, with the packing's own motion; an error of one diameter would be κD,
    # 0.03 and more. Until the surface has reflected it
    low = np.flatnonzero(y < 0.7)
    incident = case.wave["pulse"].velocity(times[:, None] - y[low] / speed)
    along_y = (2, 1)[axis]  # of u_x and of u_y, see homogenise.GRADIENTS
    own = scene.ground.continuum.corrector[axis, scene.assembly.brick_particle[low], along_y]
    expected = incident - own * np.gradient(incident, times, axis=0) / speed
    before = times < (2.0 * height - 0.7) / speed - 0.01
    assert np.abs(disks[before][:, low, axis] - expected[before]).max() < (3e-4 if pattern == "A" else 1e-3)
    # the free top doubles it
    assert abs(disks[:, y > height - 0.5, axis].max() - 2.0) < (1e-3 if pattern == "A" else 1e-2)
    # till then the continuum is at rest; surfaces of random packings also reflect P waves for S waves, earlier
    before = times < 2.0 * height / speed - 0.02
    assert np.abs(nodes[before][:, :, axis]).max() < (2e-4 if pattern == "A" else 1e-3)
    assert np.abs(nodes[:, :, axis]).max() > 0.9
    # disks near the cut surface of a random packing go on moving for a while; those in its middle do not
    after = times > 2.0 * height / speed + PERIOD + 0.1
    assert np.abs(disks[after][:, y < 0.5 * height]).max() < 1e-3


@pytest.mark.parametrize("pattern", ["A", "B"])
def test_its_energy_comes_in_through_the_bottom_and_leaves_there(lab, pattern) -> None:
    """∫ρc v² dt = ⅜ρcT per metre and wave comes in. The dashpots of ties take what the continuum does not get."""
    size, packing = ((0.5, 10.0), {}) if pattern == "A" else ((5.0, 10.0), {"brick": (5.0, 5.0)})
    boundary = BELOW | {"bottom": {"type": "outside", "wave_s": "pulse", "wave_p": "pulse"}}
    wave = PULSE | {"period": 0.05}
    scene = build(lab.case(pattern, size, held=(), material={"fric": 0.5}, boundary=boundary, wave=wave, **packing))
    simulation = lab.simulation(scene, side_stride=1)
    ledger = lab.ledger(simulation, 50)
    simulation.run(int(0.25 / simulation.time_step))
    last, most = ledger.entries[-1], max(entry.kinetic for entry in ledger.entries)
    of = dict(zip(ledger.side_names, ledger.side_columns[-1].tolist(), strict=True))
    speeds, polarisations = scene.outside.body.medium.plane_waves((0.0, 1.0))
    both = (polarisations.T @ [1.0, 1.0]) ** 2
    came_in, left, _ = of["bottom"]
    assert came_in == pytest.approx(0.375 * 0.05 * scene.size[0] * 2500.0 * float(speeds @ both), rel=1e-6)
    assert left == pytest.approx(came_in, rel=2e-3)
    assert of["bottom.continuum"][0] == pytest.approx(left, rel=1e-2)
    assert last.damping == pytest.approx(of["bottom.continuum"][0], rel=1e-2)
    assert abs(last.loads) < 1e-12 * most
    # sums of some thousand steps, each rounded by ε of the total
    assert max(abs(entry.error) for entry in ledger.entries) < 2000 * np.finfo(float).eps * most
