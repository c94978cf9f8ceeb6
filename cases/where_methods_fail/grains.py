"""Measured thresholds of packings and contact laws."""

from typing import Any

import numpy as np
from scenes import DENSITY, PERIODIC, RADIUS, SPEED, disks, section

from dembound.disks.rest.stage import settle
from dembound.disks.scene import DiskScene
from dembound.disks.stability import choose_step
from dembound.kernels.elastic import contact_forces
from dembound.kinds import kind_of
from dembound.motion.kind import StalledError
from dembound.motion.simulation import Simulation
from dembound.studies.stability import short_run

DIAMETER = 2.0 * RADIUS


def pulse_along_bar(pattern: str, per_wavelength: float) -> tuple[float, float]:
    """A Ricker pulse of P waves in a bar: its delay and its loss of peak over 60 m.

    As parts of the travel time at the homogenised speed, and of the peak before. per_wavelength : mean diameters in the
    wavelength of its dominant frequency.
    """
    frequency = SPEED / (per_wavelength * DIAMETER)
    scene = wave_bar(pattern, 160.0, {"type": "ricker", "amplitude": 1.0, "frequency": frequency})
    speed = scene.ground.wave_speeds(0)[0]
    (times, first), (_, second) = (section(scene, place, 110.0 / speed + 2.0 / frequency) for place in (20.0, 80.0))
    late = _crest(times, second) - _crest(times, first)
    return late * speed / 60.0 - 1.0, float(1.0 - second.max() / first.max())


def coda(wavelength: float, brick: float = 10.0) -> float:
    """Largest motion scattered by a random bar behind a burst of four waves, over that of the burst.

    wavelength : m; brick : its length along the bar, m.
    """
    burst = {"type": "sine_burst", "amplitude": 1.0, "frequency": SPEED / wavelength, "cycles": 4}
    scene = wave_bar("B", 200.0, burst, {"brick": (brick, 10.0)})
    speed = scene.ground.wave_speeds(0)[0]
    times, velocity = section(scene, 20.0, 380.0 / speed)  # the far end's echo arrives after that
    behind = times > 20.0 / speed + 4.5 * wavelength / SPEED
    return float(np.abs(velocity[behind]).max() / np.abs(velocity).max())


def wave_bar(pattern: str, length: float, wave: dict[str, Any], packing: dict[str, Any] | None = None) -> DiskScene:
    """A bar of this length (m), periodic sideways, into which a P wave is sent from the left."""
    boundary = {"left": {"type": "viscous_input", "wave_p": "pulse", "beta_p": 1.0}} | PERIODIC
    height = 2.0 * RADIUS if pattern == "A" else 10.0
    return disks(pattern, (length, height), ("y",), boundary=boundary, wave={"pulse": wave}, packing=packing or {})


def _crest(times: np.ndarray, velocity: np.ndarray) -> float:
    """Time (s) of the largest value, by a parabola through three samples."""
    at = int(np.argmax(velocity))
    low, mid, high = velocity[at - 1 : at + 2]
    return float(times[at] + 0.5 * (low - high) / (low - 2.0 * mid + high) * (times[1] - times[0]))


def speed_of_tension(contact_share: float = 0.5) -> tuple[float, float]:
    """Speeds of a pull and a push over that of the elastic law, in an unconfined lattice without tension."""
    found = []
    for sign in (-1.0, 1.0):
        boundary = {"left": {"type": "velocity", "wave_p": "pulse"}} | PERIODIC
        wave = {"pulse": {"type": "cosine", "amplitude": sign * 0.01, "period": 0.04}}
        material = {"law": "linearpbond", "contact_share": contact_share}
        scene = disks("A", (200.0, 0.5), ("y",), material=material, boundary=boundary, wave=wave)
        arrivals = []
        for place in (40.0, 100.0):
            times, velocity = section(scene, place, 0.19)
            arrivals.append(times[np.argmax(sign * velocity > 0.005)])
        found.append(60.0 / (arrivals[1] - arrivals[0]) / SPEED)
    return found[0], found[1]


def locked_in_breaks(strength: float, seed: int = 1, pressure: float = 1e6) -> bool:
    """Whether bonds of this strength, over a locked-in pressure (Pa), break as it relaxes at cut faces."""
    material = {"law": "linearpbond", "locked_in": pressure, "pb_ten": strength * pressure}
    scene = disks("B", (10.0, 10.0), material=material, static={}, packing={"seed": seed})
    try:
        return len(settle(scene).cracks) > 0
    except StalledError as stalled:
        return len(stalled.cracks) > 0


def locked_in_tension(seed: int = 1) -> float:
    """Largest tension of bonds after a locked-in pressure has relaxed, over that pressure, to 5 %."""
    low, high = 0.5, 4.0
    while high / low > 1.05:
        middle = np.sqrt(low * high)
        low, high = (middle, high) if locked_in_breaks(middle, seed) else (low, middle)
    return float(np.sqrt(low * high))


def thin_bond(ratio: float) -> float:
    """Mean tension of a row at which its bonds of this pb_rmul break, over pb_ten."""
    strength = 1e6
    boundary = {"left": {"type": "fixed"}, "right": {"type": "velocity", "wave_p": "pull"}}
    wave = {"pull": {"type": "constant", "amplitude": 1e-3, "start": 0.0}}
    material = {"law": "linearpbond", "pb_ten": strength, "pb_rmul": ratio, "contact_share": 0.5}
    scene = disks("A", (5.0, 0.5), ("y", "rotation"), material=material, boundary=boundary, wave=wave)
    step = choose_step(scene)[0]
    simulation = Simulation(scene, step)
    while len(simulation.system.take_cracks(simulation.state.step)) == 0:
        simulation.run(simulation.state.step + 50)
    stretch = 1e-3 * simulation.time / 4.5
    return 0.5 * DENSITY * SPEED**2 * stretch / strength


def stress_of_rotation(angle: float) -> float:
    """Largest stress that a rigid rotation by an angle (rad) causes under the geometry of the start, over ρc²."""
    scene = disks("A", (5.0, 5.0), material={"fric": 0.5})
    u = scene.layout.spread(rotated(scene, angle))
    force = np.zeros_like(u)
    for rows in scene.rows:
        contact_forces(u, rows, force)
    return float(np.abs(scene.layout.gather(force)[:2]).max() / (DENSITY * SPEED**2 * DIAMETER))


def rotated(scene: DiskScene, angle: float) -> np.ndarray:
    """Displacements (3, n) of a body that has rotated as a whole about its middle by an angle (rad)."""
    arm = scene.positions.T - scene.positions.mean(axis=0)[:, None]
    turn = np.array([[np.cos(angle) - 1.0, -np.sin(angle)], [np.sin(angle), np.cos(angle) - 1.0]])
    return np.concatenate([turn @ arm, np.full((1, scene.count), angle)])


def end_of_elastic_start() -> float:
    """Rotation (rad) of a free body from which on a run leaves the elastic law at once."""
    scene = disks("A", (2.0, 2.0), material={"law": "linearpbond", "fric": 0.5})
    low, high = 1e-4, 0.1
    while high / low > 1.001:
        angle = np.sqrt(low * high)
        simulation = Simulation(scene, choose_step(scene)[0])
        simulation.state.displacement = rotated(scene, angle)
        simulation.run(1)
        low, high = (low, angle) if len(simulation.state.laws) > 1 else (angle, high)
    return float(high)


def opening_limit() -> tuple[float, float]:
    """Largest stable step of a row whose contacts open and close, and the limit used, over that of the linear law."""
    material = {"law": "linearpbond", "elastic_start": False}
    scene = disks("A", (100.0, DIAMETER), ("y", "rotation"), material=material)
    linear, full = kind_of(scene.case).trials(scene.case, full=True)[0]
    low, high = full.limit, linear.limit
    while high - low > 2e-3 * linear.limit:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if short_run(full, middle).is_growing else (middle, high)
    return 0.5 * (low + high) / linear.limit, full.limit / linear.limit
