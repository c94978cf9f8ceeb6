"""A column in time beside independent solutions in time."""

import numpy as np

from dembound.exact.column import Column, ColumnMotion, Layer

WEIGHTS, TIMES, UNRELAXED = np.array([0.0641, 0.0472, 0.0749]), np.array([0.56, 0.0917, 0.0146]), 1.107
"""Mechanisms of Q = 20."""

DENSITIES, SPEEDS = (1800.0, 2000.0, 2300.0), (200.0, 350.0, 700.0)
THICKNESSES = 30.0, 40.0


def pulse(t: np.ndarray) -> np.ndarray:
    """A Ricker wavelet of 3 Hz, m/s."""
    power = (3.0 * np.pi * (t - 0.6)) ** 2
    return np.asarray((1.0 - 2.0 * power) * np.exp(-power))


def motion(modulus=None, until: float = 3.0) -> ColumnMotion:
    """Of two layers, maybe with a modulus of their own, on an elastic half-space."""
    two = [Layer(*each, relative=modulus) for each in zip(THICKNESSES, DENSITIES[:2], SPEEDS[:2], strict=True)]
    return ColumnMotion(Column([*two, Layer(1.0, DENSITIES[2], SPEEDS[2])]), pulse, 70.0, 0.0, until)


def scattered(until: float) -> tuple[np.ndarray, np.ndarray]:
    """Times (k,) and velocities (k, 3) of surface, joint and base, of waves from interface to interface of thin cells.

    Exact in cells of equal travel time (Goupillaud, Geophysics 26, 1961).
    """
    cells, step = (84, 64), 0.15 / 84
    z = np.repeat(np.multiply(DENSITIES, SPEEDS), [*cells, 1])
    up, down, found = np.zeros(len(z)), np.zeros(len(z)), []  # about to meet the top of each cell from below and above
    for time in step * np.arange(round(until / step) + 1):
        up[-1] = pulse(time)
        rising = (2.0 * z[1:] * up[1:] + (z[:-1] - z[1:]) * down[1:]) / (z[:-1] + z[1:])
        falling = (2.0 * z[:-1] * down[1:] + (z[1:] - z[:-1]) * up[1:]) / (z[:-1] + z[1:])
        found.append([2.0 * up[0], rising[cells[0] - 1] + down[cells[0]], rising[-1] + down[-1]])
        down[1:] = np.append(up[0], falling[:-1])
        up[:-1] = rising
    return step * np.arange(len(found)), np.array(found)


def test_elastic_layers_move_as_by_scattering_at_interfaces() -> None:
    (times, expected), column, depths = scattered(3.0), motion(), (0.0, 30.0, 70.0)
    found = column.at("velocity", times, depths)
    assert np.abs(found - expected).max() < 1e-8 * np.abs(expected).max()
    moved = np.diff(column.at("displacement", times, depths), axis=0) / times[1]
    between = column.at("velocity", times[1:] - 0.5 * times[1], depths)
    assert np.abs(moved - between).max() < 1e-4 * np.abs(expected).max()  # the differences err by (ω Δt)²/24


def test_times_after_the_last_one_continue_the_motion() -> None:
    times = np.linspace(0.0, 3.0, 50)
    early = motion(until=0.8)
    early.at("velocity", times[:5], (0.0,))
    expected = motion().at("velocity", times, (0.0,))
    np.testing.assert_allclose(early.at("velocity", times, (0.0,)), expected, atol=1e-7 * np.abs(expected).max())
