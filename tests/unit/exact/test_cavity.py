"""A cavity with a pressure in it, or under a plane wave: its wall, front, equations and causality; their transforms.

Outgoing functions that obey the equations and make the wall free of tractions are the only solution.
"""

import math

import numpy as np
import pytest

from dembound.exact import PlaneWave, ScatteredMotion, Solid, cavity_motion, scattered_motion, scattering, transform
from dembound.exact.scattering import WaveKind
from dembound.exact.transform import decaying_ratios, growing_ratios, respond

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


ONCE, INSIDE = np.array([0.1]), np.array([[9.9, 0.0]])


LONG = 0.06


def smooth(t: np.ndarray) -> np.ndarray:
    """A pulse of 1 m/s, smooth up to its fifth derivative."""
    return np.where(t < LONG, np.sin(math.pi * np.clip(t / LONG, 0.0, 1.0)) ** 6, 0.0)


def motion(times, places, kind: WaveKind, angle: float = 0.0, tolerance: float = 1e-6) -> ScatteredMotion:
    return scattered_motion(times, places, PlaneWave(kind, angle, smooth), RADIUS, SOLID, tolerance)


def circle(radius: float, number: int) -> np.ndarray:
    angle = 2.0 * math.pi * (np.arange(number) + 0.3) / number
    return radius * np.column_stack([np.cos(angle), np.sin(angle)])


@pytest.mark.parametrize("kind", ["p", "sv"])
def test_wall_is_free_of_tractions_and_orders_are_enough(kind: WaveKind, monkeypatch) -> None:
    times, wall = np.linspace(-0.02, 0.1, 31), circle(RADIUS, 7)
    few, orders = motion(times, wall, kind, 0.4), scattering._Cavity._orders
    monkeypatch.setattr(scattering._Cavity, "_orders", lambda cavity, s: orders(cavity, s) + 20)
    many = motion(times, wall, kind, 0.4)
    # the equations of orders far above k_s a lose digits as their two waves become alike; 1e-9 leaves some
    for free in (few.stress[:, 0], few.stress[:, 2]):
        assert np.abs(free).max() < 1e-9 * np.abs(few.stress[:, 1]).max()
    np.testing.assert_allclose(few.velocity, many.velocity, rtol=0.0, atol=1e-10)


@pytest.mark.parametrize(("kind", "place"), [("p", (18.0, 7.0)), ("sv", (-13.0, 4.0))])
def test_scattered_motion_obeys_hookes_and_newtons_laws(kind: WaveKind, place: tuple[float, float]) -> None:
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
    speed = np.gradient(u[0], times, axis=-1)[:, 1:-1]
    np.testing.assert_allclose(speed, v[:, 1:-1], rtol=0.0, atol=2e-3 * np.abs(v).max())

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
    free = np.where(since > 0.0, smooth(np.maximum(since, 0.0)), 0.0)
    assert free.max() > 0.9
    np.testing.assert_allclose(found.velocity[0], polarised[:, None] * free, rtol=0.0, atol=1e-5)

    times = np.linspace(-0.2, 0.2, 201)
    behind = motion(times, 1.5 * RADIUS * direction[None], kind, angle)
    early = times < -RADIUS / speed + 2.5 * RADIUS / SOLID.p_wave_speed  # through the cavity
    assert np.abs(behind.velocity[..., early]).max() < 1e-5 < 0.1 < np.abs(behind.velocity).max()


LASTS, DELAY, RATE = 0.5, 0.2, 3.0


def hump(t: np.ndarray) -> np.ndarray:
    return np.where(t < LASTS, 0.5 * (1.0 - np.cos(2.0 * math.pi * t / LASTS)), 0.0)


def decay(s: np.ndarray) -> list[np.ndarray]:
    """A delay, then u̇ + RATE·u = p; and twice as much of it."""
    one = np.exp(-s * DELAY) / (s + RATE)
    return [one, 2.0 * np.stack([one, s * one])]


def expected(times: np.ndarray) -> np.ndarray:
    """Convolution of the pulse with the decay, in closed form."""
    t = np.clip(times - DELAY, 0.0, LASTS)
    w = 2.0 * math.pi / LASTS
    during = (1.0 - np.exp(-RATE * t)) / RATE
    during -= (RATE * np.cos(w * t) + w * np.sin(w * t) - RATE * np.exp(-RATE * t)) / (RATE**2 + w**2)
    return 0.5 * during * np.exp(-RATE * np.maximum(times - DELAY - LASTS, 0.0))


@pytest.mark.parametrize("window", [8.0, 16.0])
def test_response_is_the_convolution_for_any_window_and_before_t_0(window: float, monkeypatch) -> None:
    monkeypatch.setattr(transform, "WINDOW", window)
    times = np.linspace(-0.3, 2.0, 97)
    single, double = respond(decay, hump, times, 1e-8, [0.0, 0.0])
    # the window leaves 1e-8 of the largest response, times the growth e^(ct) = 10 at most
    np.testing.assert_allclose(single, expected(times), rtol=0.0, atol=1e-7 * expected(times).max())
    np.testing.assert_allclose(double[0], 2.0 * expected(times), rtol=0.0, atol=1e-7 * double[0].max())


def test_a_velocity_that_jumps_does_not_converge() -> None:
    times = np.linspace(0.0, 1.0, 500)
    with pytest.raises(RuntimeError, match="does not converge to 1e-06"):
        respond(lambda s: [np.exp(-s * DELAY)], lambda t: 1.0 * (t < 0.1), times, 1e-6, [0.0], most=2**14)


def test_orders_of_thousands_obey_the_wronskian() -> None:
    """Orders above those of cavities, whose motion other tests check."""
    # I_n K_(n+1) + I_(n+1) K_n = 1/z, so (K_(n+1)/K_n + I_(n+1)/I_n) falls with I_n K_n → 1/2n
    z, orders = np.array([0.2 + 3.0j, 0.2 + 1500.0j]), 4000
    product = 1.0 / (z * (decaying_ratios(z, orders) + growing_ratios(z, orders)))
    assert np.isfinite(product).all()
    # Debye's expansion: I_n K_n = 1/(2√(n² + z²)) (1 + O(1/n²))
    np.testing.assert_allclose(product[-1], 0.5 / np.sqrt((orders - 1) ** 2 + z**2), rtol=1e-6)


def test_moduli_follow_from_the_speeds() -> None:
    solid = Solid(2500.0, 1000.0, 1000.0 / math.sqrt(3.0))
    assert solid.uniaxial == pytest.approx(2.5e9)
    assert solid.shear == pytest.approx(2.5e9 / 3.0)
    assert solid.lame == pytest.approx(solid.shear)  # ν = 1/4
