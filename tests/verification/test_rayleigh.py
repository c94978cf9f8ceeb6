"""Rayleigh damping: waves decay and disperse as α and β say, its step limit is sharp, and rest is exact."""

import numpy as np
import pytest

from dembound.casefile.disks import DiskCase
from dembound.disks.scene import build
from dembound.disks.stability import choose_step, step_limit
from dembound.disks.trials import trials_of_disks
from dembound.exact.column import Column, Layer
from dembound.formulas.disks.entry import late_by
from dembound.kinds import loads, with_changes
from dembound.kinds.disks.kind import Disks
from dembound.motion.energy import Ledger
from dembound.motion.simulation import Simulation
from dembound.studies.stability import short_run

DENSITY, SPEED, HEIGHT, RADIUS = 2000.0, 400.0, 20.0, 0.25
BAND, QUALITY = (10.0, 80.0), 10.0
COLUMN = f"""
[packing]
pattern = "A"
bricks = [1, {round(HEIGHT / (2.0 * RADIUS))}]
radius = {RADIUS}
[material]
density = {DENSITY}
p_wave_speed = {SPEED}
quality_factor = {QUALITY}
[damping]
type = "rayleigh"
band = [{BAND[0]}, {BAND[1]}]
[run]
duration = 1.0
"""
PERIODIC = {side: {"type": "periodic"} for side in ("left", "right")}
BODY = {"packing": {"pattern": "B", "size": [8.0, 8.0], "radius": RADIUS, "radius_ratio": 1.5, "brick": [8.0, 4.0]}}
FREE_FIELD = {"boundary": {"bottom": {"type": "viscous"}} | {side: {"type": "free_field"} for side in PERIODIC}}
SOFT_ON_STIFF = {
    "layer": [
        {"thickness": 4.0, "quality_factor": 5.0, "p_wave_speed": 200.0},
        {"p_wave_speed": 500.0, "quality_factor": 40.0},
    ]
}


def case(changes: dict) -> DiskCase:
    return with_changes(loads(COLUMN), changes)


def test_standing_waves_decay_with_the_ratio_of_their_frequency() -> None:
    """Amplitudes q of a mode obey q'' = p q' − r q with r = (1 − h − b)/(1 + h), h = αΔt/2, b = βω²Δt.

    So −ln r is 2ξωΔt(1 + b/2) to the second order. Eigenvectors of a free chain are cosines.
    """
    scene = build(case({"boundary": PERIODIC}))
    step, count, modes = choose_step(scene)[0], scene.count, np.arange(1, 9)
    shapes = np.cos(np.pi * np.outer(modes, np.arange(count) + 0.5) / count)
    simulation = Simulation(scene, step, range(count))
    simulation.state.velocity = np.stack([0.0 * shapes[0], shapes.sum(axis=0), 0.0 * shapes[0]])
    amplitude = (simulation.advance(600)[:, :, 1] @ shapes.T).T
    damping = scene.ground.mechanisms
    omega = SPEED / RADIUS * np.sin(0.5 * np.pi * modes / count)
    ratio = 0.5 * damping.alpha / omega + 0.5 * damping.beta * omega
    for q, turn, expected in zip(amplitude, omega, ratio, strict=True):
        (_, r), *_ = np.linalg.lstsq(np.stack([q[1:-1], -q[:-2]], axis=1), q[2:])
        found, second = -0.5 * np.log(r) / (turn * step), 0.5 * damping.beta * turn**2 * step
        assert found == pytest.approx(expected, rel=1.1 * second)
    assert ratio[[0, -1]] == pytest.approx(0.5 / QUALITY, rel=0.02)  # waves on disks are slower
    assert ratio.min() < 0.7 * ratio[0]


@pytest.mark.parametrize("qualities", [(5.0, 5.0), (20.0, 20.0), (10.0, 40.0)])
def test_a_column_moves_as_one_of_the_same_moduli_and_densities(qualities: tuple[float, float]) -> None:
    """100 m, twice, until the dashpot returns what its disk's mass reflects. The shortest waves are 80 disks long."""
    tables = {
        "boundary": PERIODIC | {"bottom": {"type": "viscous_input", "wave_p": "rising"}},
        "wave": {"rising": {"type": "ricker", "amplitude": 1.0, "frequency": 4.0}},
        "packing.bricks": [1, 200],
        "damping.band": [1.0, 10.0],
        "layer": [{"thickness": 60.0, "quality_factor": qualities[0]}, {"quality_factor": qualities[1]}],
    }
    scene = build(case(tables))
    step = choose_step(scene)[0]
    found = Simulation(scene, step, [scene.count - 1]).advance(round(0.75 / step))[:, 0, 4]
    ground = [
        Layer(thickness, DENSITY, SPEED, relative=each.relative_modulus, heavier=each.relative_density)
        for thickness, each in zip((60.0, 40.0 + late_by(scene) * SPEED), scene.ground.mechanisms_by_layer, strict=True)
    ]
    pulse = scene.case.wave["rising"].velocity(np.arange(len(found)) * step)
    expected = Column([*ground, Layer(1.0, DENSITY, SPEED)]).history(pulse, step, RADIUS)

    assert np.linalg.norm(found - expected) < 5e-4 * np.linalg.norm(expected)


@pytest.mark.parametrize("changes", [BODY, BODY | SOFT_ON_STIFF], ids=["uniform", "layers"])
def test_noise_grows_only_above_the_step_limit(changes: dict) -> None:
    trial = trials_of_disks(case(changes | {"damping.band": [1.0, 10.0]}), full=True)[0][0]

    assert not short_run(trial, 0.999 * trial.limit).is_growing
    assert short_run(trial, 1.002 * trial.limit).is_growing
    assert trial.limit < 0.6 * step_limit(build(case(changes | {"damping": {}, "material.quality_factor": 1e4})))


@pytest.mark.parametrize("changes", [{}, SOFT_ON_STIFF], ids=["uniform", "layers"])
def test_a_settled_body_stays_at_rest_and_its_ledger_closes(changes: dict) -> None:
    weight = {"load": [{"name": "weight", "acceleration": [0.0, -9.81]}]}
    stage = {"static": {"ratio": 1e-10, "boundary": {"bottom": {"type": "fixed"}}}}
    scene = build(case(BODY | FREE_FIELD | weight | stage | changes))
    beginning = Disks().begin(scene, choose_step(scene)[0], None)
    simulation = Simulation(scene, choose_step(scene)[0], system=beginning.system, datum=beginning.datum)
    simulation.run(500)
    moved = np.abs(simulation.state.displacement - beginning.datum)

    assert moved.max() < 1e-12 * np.abs(beginning.datum).max()

    simulation.track(Ledger(simulation, 50))
    simulation.state.velocity = np.random.default_rng(1).normal(0.0, 1e-3, (3, scene.count)) * scene.moves
    simulation.run(1001)
    entries = simulation.trackers[-1].entries

    assert max(abs(entry.error) for entry in entries) < 1e-9 * entries[0].kinetic
    assert entries[-1].damping > 0.1 * entries[0].kinetic
