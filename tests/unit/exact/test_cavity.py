"""A pressure in a cavity: its wall, front, equations, rest and energy."""

import math

import numpy as np
import pytest

from dembound.exact import Solid, cavity_motion

RADIUS, PERIOD, PRESSURE = 10.0, 0.03, 1e6
SOLID = Solid(2500.0, 1000.0, 600.0)


def pulse(t: np.ndarray) -> np.ndarray:
    return np.where(t < PERIOD, 0.5 * PRESSURE * (1.0 - np.cos(2.0 * math.pi * t / PERIOD)), 0.0)


def test_radial_stress_at_the_wall_is_the_pressure() -> None:
    times = np.linspace(0.0, 0.1, 101)
    motion = cavity_motion(times, RADIUS, pulse, RADIUS, SOLID)
    np.testing.assert_allclose(motion.radial_stress, -pulse(times), rtol=0.0, atol=1e-6 * PRESSURE)


def test_step_arrives_as_a_front_that_spreads() -> None:
    distance = 2.5 * RADIUS
    arrival = (distance - RADIUS) / SOLID.p_wave_speed
    times = arrival + 1e-6 * np.array([-100.0, -10.0, 10.0])
    motion = cavity_motion(times, distance, lambda t: np.full_like(t, PRESSURE), RADIUS, SOLID, tolerance=1e-4)
    front = math.sqrt(RADIUS / distance) * PRESSURE
    # 10 µs behind the front the velocity has changed by less than 10 µs·c_p/a = 1e-3; before it there is the tolerance
    for history, jump in (
        (motion.velocity, front / (SOLID.density * SOLID.p_wave_speed)),
        (motion.radial_stress, -front),
        (motion.hoop_stress, -front * SOLID.lame / SOLID.uniaxial),
    ):
        np.testing.assert_allclose(history / jump, [0.0, 0.0, 1.0], rtol=0.0, atol=2e-3)


def test_motion_obeys_hookes_and_newtons_laws() -> None:
    r, step, times = 17.0, 0.02, np.linspace(0.0, 0.1, 1001)
    inner, here, outer = (cavity_motion(times, r + d, pulse, RADIUS, SOLID, 1e-8) for d in (-step, 0.0, step))
    strain = (outer.displacement - inner.displacement) / (2.0 * step)
    around = here.displacement / r
    # central differences of a pulse 30 m long err by (2π·0.02/30)²/6 = 3e-6, in time by (2π·1e-4/0.03)²/6 = 7e-5, and
    # at the kinks of the pulse's second derivative by 2π times 1e-4/0.03
    size = np.abs(here.radial_stress).max()
    np.testing.assert_allclose(SOLID.uniaxial * strain + SOLID.lame * around, here.radial_stress, atol=2e-5 * size)
    np.testing.assert_allclose(SOLID.lame * strain + SOLID.uniaxial * around, here.hoop_stress, atol=2e-5 * size)
    speed = np.gradient(here.displacement, times)[1:-1]
    np.testing.assert_allclose(speed, here.velocity[1:-1], atol=1e-3 * np.abs(here.velocity).max())
    force = (outer.radial_stress - inner.radial_stress) / (2.0 * step) + (here.radial_stress - here.hoop_stress) / r
    inertia = SOLID.density * np.gradient(here.velocity, times)
    np.testing.assert_allclose(force[1:-1], inertia[1:-1], atol=1e-2 * np.abs(force).max())


def test_places_in_the_cavity_are_refused() -> None:
    with pytest.raises(ValueError, match="inside the cavity"):
        cavity_motion(np.array([1.0]), 9.0, pulse, RADIUS, SOLID)
    with pytest.raises(ValueError, match="radius"):
        cavity_motion(np.array([1.0]), 9.0, pulse, 0.0, SOLID)
