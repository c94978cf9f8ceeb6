"""Damped ground: waves decay as their exact modulus says, noise decays, and a settled body stays at rest."""

import numpy as np
import pytest

from dembound.casefile.disks import DiskCase
from dembound.damping import Mechanisms
from dembound.disks.scene import build
from dembound.disks.stability import choose_step, step_limit
from dembound.disks.trials import trials_of_disks
from dembound.exact.column import Layer
from dembound.exact.transform import DECAY
from dembound.kinds import loads, with_changes
from dembound.kinds.disks.kind import Disks
from dembound.motion.simulation import Simulation
from dembound.studies.stability import short_run

DENSITY, SPEED = 2000.0, 400.0
BELOW, ABOVE = 100.25, 300.25
"""Heights (m) of two disks."""

COLUMN = f"""
[packing]
pattern = "A"
bricks = [1, 2000]
radius = 0.25
[material]
density = {DENSITY}
p_wave_speed = {SPEED}
[boundary.left]
type = "periodic"
[boundary.right]
type = "periodic"
[boundary.bottom]
type = "viscous_input"
wave_p = "rising"
[wave.rising]
type = "ricker"
amplitude = 1.0
frequency = 2.0
[[monitor]]
name = "below"
position = [0.25, {BELOW}]
[[monitor]]
name = "above"
position = [0.25, {ABOVE}]
[run]
duration = 4.0
"""
SMALL = {"packing": {"pattern": "A", "bricks": [8, 12], "radius": 0.25}, "monitor": [], "material.quality_factor": 20.0}
SETTLED = SMALL | {
    "packing": {"pattern": "B", "size": [8.0, 8.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [8.0, 4.0]},
    "load": [{"name": "weight", "acceleration": [0.0, -9.81]}],
    "static": {"ratio": 1e-10, "boundary": {"bottom": {"type": "fixed"}}},
}


def case(changes: dict) -> DiskCase:
    return with_changes(loads(COLUMN), changes)


def travelled(motion: np.ndarray, mechanisms: Mechanisms, step: float) -> np.ndarray:
    """Motion (n,) at the upper disk from that at the lower one, exactly: e^(−ikΔz), by a Fourier transform."""
    count = 4 * len(motion)
    rate = DECAY / (count * step)
    decay = np.exp(-rate * step * np.arange(len(motion)))
    omega = 2.0 * np.pi * np.fft.rfftfreq(count, step) - 1j * rate
    modulus = Layer(0.0, DENSITY, SPEED, relative=mechanisms.relative_modulus).modulus(omega, "elastic", 1.0)
    spectrum = np.fft.rfft(motion * decay, count) * np.exp(-1j * omega * np.sqrt(DENSITY / modulus) * (ABOVE - BELOW))
    return np.fft.irfft(spectrum, count)[: len(motion)] / decay


@pytest.mark.parametrize("quality", [5.0, 20.0, 100.0])
def test_a_wave_decays_as_the_modulus_says(quality: float) -> None:
    """200 m are two waves of 4 Hz, the highest frequency of much energy, 200 disks long: dispersion is below 1e-4."""
    scene = build(case({"material.quality_factor": quality, "damping.band": [0.3, 10.0]}))
    step = choose_step(scene)[0]
    record = Simulation(scene, step, list(scene.monitors.values())).advance(round(4.0 / step))
    below, above = record[:, :, 4].T
    expected = travelled(below, scene.ground.mechanisms, step)

    assert np.linalg.norm(above - expected) < 3e-4 * np.linalg.norm(expected)
    assert np.abs(above).max() < 0.97 * np.abs(below).max()


def test_the_step_limit_is_that_of_the_unrelaxed_moduli() -> None:
    undamped, damped = (build(case(SMALL | {"material.quality_factor": q})) for q in (None, 5.0))
    factor = damped.ground.unrelaxed

    assert factor > 1.4
    assert step_limit(damped) == pytest.approx(step_limit(undamped) / np.sqrt(factor), rel=1e-4)


@pytest.mark.parametrize("sides", ["free", "outside"])
def test_noise_grows_only_above_the_step_limit(sides: str) -> None:
    boundary = {side: {"type": sides} for side in ("left", "right", "bottom")}
    changes = SMALL | {"boundary": boundary, "wave": {}} | ({"outside.element": 2.0} if sides == "outside" else {})
    trial = trials_of_disks(case(changes), full=True)[0][0]

    assert not short_run(trial, 0.998 * trial.limit).is_growing
    assert short_run(trial, 1.002 * trial.limit).is_growing


@pytest.mark.parametrize("sides", ["free_field", "outside"])
def test_a_settled_body_stays_at_rest_and_its_twins_move_as_it_does(sides: str) -> None:
    bottom = {"type": "viscous"} if sides == "free_field" else {"type": "outside"}
    boundary = {"left": {"type": sides}, "right": {"type": sides}, "bottom": bottom}
    more = {"outside.element": 2.0} if sides == "outside" else {}
    still = case(SETTLED | more | {"boundary": boundary, "wave": {}})
    scene = build(still)
    step = choose_step(scene)[0]
    beginning = Disks().begin(scene, step, None)
    simulation = Simulation(scene, step, system=beginning.system, datum=beginning.datum)
    simulation.run(1000)
    moved, settled = np.abs(simulation.state.displacement - beginning.datum), np.abs(beginning.datum).max()

    assert moved.max() < 1e-12 * settled
    assert settled > 1e-5

    body = np.arange(scene.column_count, scene.disk_count)
    twin = scene.seams[0].twin[body]
    of_disks = np.arange(scene.count) < scene.disk_count  # a continuum has the difference from the column
    simulation.state.velocity = np.outer([1e-3, 1e-3, 0.0], of_disks) * scene.moves
    simulation.run(1300)
    moved = simulation.state.displacement - beginning.datum

    assert np.abs(moved[:, body] - moved[:, twin]).max() < 1e-9 * np.abs(moved).max()
