"""Measured thresholds of dashpots, springs and columns."""

import numpy as np
from oblique import reflection
from scenes import DENSITY, PERIODIC, RADIUS, SPEED, disks

from dembound.disks.matching import homogenised_beta
from dembound.disks.stability import choose_step, step_limit
from dembound.kinds import kind_of
from dembound.motion.simulation import Simulation
from dembound.studies.asked import Calibrating
from dembound.studies.calibration import calibrate
from dembound.studies.stability import short_run

DIAMETER = 2.0 * RADIUS
ALL = ("left", "right", "bottom", "top")


def lagged_limit(beta: float, end_mass: float = 0.5, disks: int = 40, centred: bool = False) -> float:
    """Largest stable step of a chain with dashpots at its ends over that without; they act on the velocity before.

    Masses and stiffnesses are 1, and so is ρcD. centred : dashpots act on the mean of both velocities, as in dembound.
    """
    mass = np.ones(disks)
    mass[[0, -1]] = end_mass
    damping = np.zeros(disks)
    damping[[0, -1]] = beta
    stiffness = np.diag(np.full(disks, 2.0)) - np.eye(disks, k=1) - np.eye(disks, k=-1)
    stiffness[0, 0] = stiffness[-1, -1] = 1.0
    limit = 2.0 / np.sqrt(np.linalg.eigvalsh(stiffness / np.sqrt(np.outer(mass, mass))).max())

    def is_stable(step: float) -> bool:
        share = 0.5 if centred else 0.0
        down = 1.0 / (mass / step + share * damping)
        keep = (mass / step - (1.0 - share) * damping) * down
        velocity = np.concatenate([np.diag(keep), -down[:, None] * stiffness], axis=1)
        place = np.concatenate([step * velocity[:, :disks], np.eye(disks) + step * velocity[:, disks:]], axis=1)
        return np.abs(np.linalg.eigvals(np.concatenate([velocity, place]))).max() < 1.0 + 1e-7

    low, high = 0.0, 1.1 * limit
    for _ in range(24):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if is_stable(middle) else (low, middle)
    return low / limit


def strong_dashpot(beta: float) -> tuple[float, bool]:
    """Reflected part of a P wave at a side with factor β, and whether noise grows at 0.9995 of the undamped limit."""
    side = {"type": "viscous", "beta_p": beta, "beta_s": beta}
    scene = disks("A", (5.0, 5.0), boundary=dict.fromkeys(ALL, side))
    trial = kind_of(scene.case).trials(scene.case, full=True)[0][0]
    limit = step_limit(disks("A", (5.0, 5.0)))
    return reflection(side, "p", 0.0, per_wavelength=2000.0)["p"], short_run(trial, 0.9995 * limit).is_growing


def spring_limit(distance: float, sides: tuple[str, ...] = ("left", "bottom")) -> float:
    """Stability limit of a lattice with springs of sources this far away (m), over that without any."""
    side = {"type": "viscoelastic", "distance": distance}
    plain = step_limit(disks("A", (5.0, 5.0), material={"fric": 0.5}))
    return step_limit(disks("A", (5.0, 5.0), material={"fric": 0.5}, boundary=dict.fromkeys(sides, side))) / plain


def reach_of_springs(lost: float, sides: tuple[str, ...]) -> float:
    """Distance (m) of sources from which on springs at these sides take a part `lost` of the stable step."""
    low, high = 1e-3, 10.0
    while high / low > 1.001:
        middle = np.sqrt(low * high)
        low, high = (middle, high) if spring_limit(middle, sides) < 1.0 - lost else (low, middle)
    return float(high)


def drift(acceleration: float = 1.0, duration: float = 0.6) -> tuple[float, float]:
    """Velocity (m/s) to which a steady acceleration (m/s²) drives a lattice between viscous sides, and F/ΣC."""
    sides = {"left": {"type": "viscous"}, "right": {"type": "viscous"}}
    load = [{"name": "push", "acceleration": (acceleration, 0.0)}]
    scene = disks("A", (10.0, 5.0), ("y",), boundary=sides, load=load)
    step = choose_step(scene)[0]
    simulation = Simulation(scene, step)
    simulation.run(int(duration / step))
    velocity = float(scene.mass @ simulation.state.velocity[0] / scene.mass.sum())
    return velocity, float(
        scene.mass.sum() * acceleration / scene.supports.damping[scene.supports.component == 0].sum()
    )


def on_springs(per_distance: float) -> tuple[float, float]:
    """Reflected part of a P wave of wavelength L·per_distance on a viscoelastic side, and its formula."""
    distance = 200.0
    wavelength = per_distance * distance
    side = {"type": "viscoelastic", "distance": distance, "half_mass": True}
    measured = reflection(side, "p", 0.0, per_wavelength=wavelength / DIAMETER)["p"]
    frequency = 2.0 * np.pi * SPEED / wavelength
    modulus = DENSITY * 0.5 * SPEED**2
    return measured, 1.0 / np.hypot(1.0, 2.0 * frequency * distance * DENSITY * SPEED / modulus)


def corner(distance: float) -> bool:
    """Whether noise grows at 0.9995 of the limit of a lattice with springs of sources this close (m) at four sides."""
    side = {"type": "viscoelastic", "distance": distance}
    scene = disks("A", (5.0, 5.0), material={"fric": 0.5}, boundary=dict.fromkeys(ALL, side))
    trial = kind_of(scene.case).trials(scene.case, full=True)[0][0]
    return short_run(trial, 0.9995 * trial.limit).is_growing


def narrow(height: float, free: bool = True) -> float:
    """Calibrated over homogenised β of a side of a random bar of this height (m), less 1."""
    boundary = {"left": {"type": "fixed"}, "right": {"type": "viscous"}} | ({} if free else PERIODIC)
    wave = {"pulse": {"type": "cosine", "amplitude": 0.5, "period": 0.1}}
    scene = disks("B", (40.0, height), ("y",), boundary=boundary, wave=wave)
    found = calibrate(scene.case, "right", Calibrating(tolerance=1e-4))
    return found.result / homogenised_beta(scene, "right", "p") - 1.0


def foot(half_mass: bool, per_wavelength: float) -> float:
    """Reflected part of an S wave at the foot of a column."""
    return reflection({"type": "viscous", "half_mass": half_mass}, "s", 0.0, per_wavelength)["s"]
