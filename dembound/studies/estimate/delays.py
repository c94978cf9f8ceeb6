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

TAPER = 0.05
"""Part of the record after its end in which its last value fades out, so that its spectrum has no jump."""


def error_of_delay(time: np.ndarray, velocity: np.ndarray, delay: Delay) -> tuple[np.ndarray, np.ndarray]:
    """What a delay adds to a recorded velocity (k, c) m/s and its displacement (k, c) m, at evenly spaced times (k,).

    Frequencies at which no wave runs, whose delay is nan, count as an error as large as themselves.
    """
    step = float(time[1] - time[0]) if len(time) > 1 else 1.0
    count, fade = len(time), max(8, int(TAPER * len(time)))
    ramp = 0.5 * (1.0 + np.cos(np.pi * np.arange(1, fade + 1) / (fade + 1)))
    padded = np.concatenate([velocity, ramp[:, None] * velocity[-1]])
    length = 2 ** int(np.ceil(np.log2(2 * len(padded))))
    omega = 2.0 * np.pi * np.fft.rfftfreq(length, step)
    phase = np.exp(1j * omega * np.nan_to_num(delay(omega)))
    phase[~np.isfinite(delay(omega))] = 0.0
    spectrum = np.fft.rfft(padded, length, axis=0)
    error = np.fft.irfft(spectrum * (1.0 - phase)[:, None], length, axis=0)[:count]
    displacement = step * (np.cumsum(error, axis=0) - 0.5 * (error + error[0]))
    return error, displacement
