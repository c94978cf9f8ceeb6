"""A cavity under a plane wave: its wall, the equations and causality.

Outgoing functions that obey the equations and make the wall free of tractions are the only solution, so the first tests
together leave no freedom.
"""

import math

import numpy as np
import pytest

from dembound.exact import PlaneWave, ScatteredMotion, Solid, scattered_motion
from dembound.exact import scattering as module
from dembound.exact.scattering import WaveKind

RADIUS, PERIOD = 10.0, 0.06
SOLID = Solid(2500.0, 1000.0, 600.0)
KINDS = ["p", "sv"]


def pulse(t: np.ndarray) -> np.ndarray:
    """A pulse of 1 m/s, smooth up to its fifth derivative."""
    return np.where(t < PERIOD, np.sin(math.pi * np.clip(t / PERIOD, 0.0, 1.0)) ** 6, 0.0)


def motion(
    times: np.ndarray, places: np.ndarray, kind: WaveKind, angle: float = 0.0, tolerance: float = 1e-6
) -> ScatteredMotion:
    return scattered_motion(times, places, PlaneWave(kind, angle, pulse), RADIUS, SOLID, tolerance)


def circle(radius: float, number: int) -> np.ndarray:
    angle = 2.0 * math.pi * (np.arange(number) + 0.3) / number
    return radius * np.column_stack([np.cos(angle), np.sin(angle)])


@pytest.mark.parametrize("kind", KINDS)
def test_wall_is_free_of_tractions_and_orders_are_enough(kind: WaveKind, monkeypatch) -> None:
    times, wall = np.linspace(-0.02, 0.1, 31), circle(RADIUS, 7)
    few, orders = motion(times, wall, kind, 0.4), module._Cavity._orders
    monkeypatch.setattr(module._Cavity, "_orders", lambda cavity, s: orders(cavity, s) + 20)
    many = motion(times, wall, kind, 0.4)
    # the equations of orders far above k_s a lose digits as their two waves become alike; 1e-9 leaves some
    for free in (few.stress[:, 0], few.stress[:, 2]):
        assert np.abs(free).max() < 1e-9 * np.abs(few.stress[:, 1]).max()
    np.testing.assert_allclose(few.velocity, many.velocity, rtol=0.0, atol=1e-10)


@pytest.mark.parametrize(("kind", "place"), [("p", (18.0, 7.0)), ("sv", (-13.0, 4.0))])
def test_motion_obeys_hookes_and_newtons_laws(kind: WaveKind, place: tuple[float, float]) -> None:
    h, times = 0.1, np.linspace(-0.02, 0.08, 401)
    offsets = h * np.array([[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1], [1, 1], [1, -1], [-1, 1], [-1, -1]])
    found = motion(times, place + offsets, kind, 0.4, tolerance=1e-7)
    u, v = found.displacement, found.velocity[0]
    xx, yy, xy = u[1] - 2.0 * u[0] + u[2], u[3] - 2.0 * u[0] + u[4], 0.25 * (u[5] - u[6] - u[7] + u[8])
    mixed = SOLID.lame + SOLID.shear
    force = SOLID.shear * (xx + yy) + mixed * np.stack([xx[0] + xy[1], xy[0] + yy[1]])
    inertia = SOLID.density * np.gradient(v, times, axis=-1)[:, 1:-1]
    # differences in time err by (2π·0.25e-3·3/0.06)²/6 = 1e-3 of a pulse of three such frequencies; those in space,
    # over 0.1 m of 36 m/3, by 4e-4, and the tolerance by 1e-7/(h k)² = 4e-5
    np.testing.assert_allclose(force[:, 1:-1] / h**2, inertia, rtol=0.0, atol=2e-3 * np.abs(inertia).max())
    np.testing.assert_allclose(
        np.gradient(u[0], times, axis=-1)[:, 1:-1], v[:, 1:-1], rtol=0.0, atol=2e-3 * np.abs(v).max()
    )

    x, y = (u[1] - u[2]) / (2.0 * h), (u[3] - u[4]) / (2.0 * h)
    mean, half, shear = mixed * (x[0] + y[1]), SOLID.shear * (x[0] - y[1]), SOLID.shear * (x[1] + y[0])
    twice = 2.0 * math.atan2(place[1], place[0])
    turned = half * math.cos(twice) + shear * math.sin(twice)
    expected = [mean + turned, mean - turned, shear * math.cos(twice) - half * math.sin(twice)]
    np.testing.assert_allclose(found.stress[0], expected, rtol=0.0, atol=2e-4 * np.abs(expected).max())


@pytest.mark.parametrize(("kind", "across"), [("p", False), ("sv", True)])
def test_wave_is_undisturbed_until_the_scattered_one_arrives(kind: WaveKind, across: bool) -> None:
    """At the axis at t = 0; an SV wave moves to the right of its direction; behind the cavity nothing moves before."""
    angle, speed = 0.4, SOLID.s_wave_speed if across else SOLID.p_wave_speed
    direction = np.array([math.cos(angle), math.sin(angle)])
    side = np.array([-direction[1], direction[0]])
    polarised = -side if across else direction
    place = -10.0 * RADIUS * direction + 3.0 * RADIUS * side
    # met where the wave touches the wall first; from there the scattered P wave needs (|place| − a)/c_p
    echo = -RADIUS / speed + (np.hypot(*place) - RADIUS) / SOLID.p_wave_speed
    times = np.linspace(-0.2, echo, 201)
    found = motion(times, place[None], kind, angle)
    since = times + 10.0 * RADIUS / speed
    free = np.where(since > 0.0, pulse(np.maximum(since, 0.0)), 0.0)
    assert free.max() > 0.9
    np.testing.assert_allclose(found.velocity[0], polarised[:, None] * free, rtol=0.0, atol=1e-5)

    times = np.linspace(-0.2, 0.2, 201)
    behind = motion(times, 1.5 * RADIUS * direction[None], kind, angle)
    early = times < -RADIUS / speed + 2.5 * RADIUS / SOLID.p_wave_speed  # through the cavity
    assert np.abs(behind.velocity[..., early]).max() < 1e-5 < 0.1 < np.abs(behind.velocity).max()


def test_places_in_the_cavity_are_refused() -> None:
    with pytest.raises(ValueError, match="outside the cavity"):
        motion(np.array([0.1]), np.array([[9.9, 0.0]]), "p")
    with pytest.raises(ValueError, match="radius"):
        scattered_motion(np.array([0.1]), np.array([[9.9, 0.0]]), PlaneWave("p", 0.0, pulse), 0.0, SOLID)
