"""Errors of waves that a grid, or steps in time, delay: by formula, from the recorded motion itself.

A wave of the angular frequency ω on a grid comes late by τ(ω) = s(1/c(ω) − 1/c) on its way of s m, where c(ω) is its
phase speed there and c that of long waves. The exact motion is that of the record with this delay taken out, and the
error of the record is the difference.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

Delay = Callable[[np.ndarray], np.ndarray]
"""Returns delays (k,) s at angular frequencies (k,) rad/s."""


def error_of_delay(time: np.ndarray, velocity: np.ndarray, delay: Delay) -> tuple[np.ndarray, np.ndarray]:
    """Errors that a delay adds to a recorded velocity (k, c) m/s and its displacement (k, c) m, at even times (k,) s.

    Frequencies at which no wave runs, whose delay is nan, count as an error of 100 %.
    """
    step = float(time[1] - time[0]) if len(time) > 1 else 1.0
    count = len(time)
    padded = np.concatenate([velocity, going_on(velocity)])
    length = 2 ** int(np.ceil(np.log2(2 * len(padded))))
    omega = 2.0 * np.pi * np.fft.rfftfreq(length, step)
    phase = np.exp(1j * omega * np.nan_to_num(delay(omega)))
    phase[~np.isfinite(delay(omega))] = 0.0
    spectrum = np.fft.rfft(padded, length, axis=0)
    error = np.fft.irfft(spectrum * (1.0 - phase)[:, None], length, axis=0)[:count]
    displacement = step * (np.cumsum(error, axis=0) - 0.5 * (error + error[0]))
    return error, displacement


def error_of_steps(time: np.ndarray, velocity: np.ndarray, step: float) -> tuple[np.ndarray, np.ndarray]:
    """Errors that central differences with a step (s) add to a velocity (k, c) m/s and its displacement (k, c) m.

    time : even times (k,) s. The steps move the body as it would move at the frequency ω̂ = (2/Δt) sin(ωΔt/2); the
    recorded velocity is the mean of two half steps, cos(ωΔt/2) iω̂u. Waves keep the amplitude of iω̂u, so that the
    velocity is too small by (ωΔt)²/8, and the displacement too large by (ωΔt)²/24.
    """
    if len(time) < 2:
        return np.zeros_like(velocity), np.zeros_like(velocity)
    acceleration = np.gradient(velocity, time, axis=0)
    return step**2 / 8.0 * np.gradient(acceleration, time, axis=0), -(step**2) / 24.0 * acceleration


def going_on(values: np.ndarray) -> np.ndarray:
    """Continuation (k - 1, c) of values (k, c) that end within a wave: same slope at first, then fading to zero.

    The values turned about the last one, times a polynomial that falls from 1 to 0 without slope and curvature at its
    ends. Corners would add high frequencies that no wave of the record has, whose long delays would enter the record.
    """
    turned = 2.0 * values[-1] - values[-2::-1]
    s = np.arange(1, len(values)) / len(values)
    fading = 1.0 - s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
    return np.asarray(fading[:, None] * turned)


def part_above(
    time: np.ndarray, velocity: np.ndarray, least: float, power: float = 0.0
) -> tuple[np.ndarray, np.ndarray]:
    """A velocity (k,) at even times (k,) s with its spectrum times ω^power, and its part above `least` rad/s."""
    padded = np.concatenate([velocity, going_on(velocity[:, None])[:, 0]])
    length = 2 ** int(np.ceil(np.log2(2 * len(padded))))
    omega = 2.0 * np.pi * np.fft.rfftfreq(length, float(time[1] - time[0]))
    spectrum = np.fft.rfft(padded, length) * omega**power
    whole, above = (np.fft.irfft(each, length)[: len(time)] for each in (spectrum, spectrum * (omega > least)))
    return np.asarray(whole), np.asarray(above)
