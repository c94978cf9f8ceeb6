"""P or S waves at normal incidence in a stack of layers on a half-space, after Thomson and Haskell.

With e^{+iωt}, z downwards from the top of a layer, and complex wave number k = ω√(ρ/M) the displacement of layer m is
u = A_m e^{ikz} + B_m e^{−ikz}, A running up and B down. The free surface makes A_1 = B_1; displacement and traction are
continuous at the interface of layers m and m + 1, with α = √(ρ_m M_m)/√(ρ_{m+1} M_{m+1}):

    A_{m+1} = ½[A_m (1 + α) e^{ikh} + B_m (1 − α) e^{−ikh}] ,  B_{m+1} = ½[A_m (1 − α) e^{ikh} + B_m (1 + α) e^{−ikh}] .

(Haskell, The dispersion of surface waves on multilayered media, BSSA 43, 1953; Kramer, Geotechnical Earthquake
Engineering, 1996, section 7.2.1.) A is the incident wave of the half-space; 2A moves its outcrop, A + B its top.

Moduli M with ρc² of the speed c and the quality Q of a layer:

    elastic       ρc²
    hysteretic    ρc² (1 + i/Q)
    constant_q    ρc² cos²(πγ/2) (iω/ω₀)^{2γ},  γ = arctan(1/Q)/π: phase speed c at ω₀  (Kjartansson, JGR 84, 1979)
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

Damping = Literal["elastic", "hysteretic", "constant_q"]
"""How the quality of layers enters their moduli."""

Reference = Literal["incident", "outcrop", "within"]
"""Motion at the top of the half-space: up-going wave, its surface without layers, or the motion there."""

PADDED = 4
"""Length of the window of a history over that of the history, at least; a power of two in samples."""

DECAY = math.log(1e8)
"""Decay of signals over a window: what comes round again has 1e-8 of its size."""


@dataclass(frozen=True)
class Layer:
    """A layer of a stack: thickness m (of the half-space unused), density kg/m³, speed m/s of its waves, quality Q."""

    thickness: float
    density: float
    speed: float
    quality: float = math.inf

    def modulus(self, omega: np.ndarray, damping: Damping, reference: float) -> np.ndarray:
        """M (k,) Pa at angular frequencies (k,) rad/s, which may be complex; reference : f₀ = ω₀/2π, Hz."""
        elastic = self.density * self.speed**2 * np.ones(np.shape(omega), dtype=complex)
        if damping == "elastic" or math.isinf(self.quality):
            return elastic
        if damping == "hysteretic":
            return elastic * (1.0 + 1j / self.quality)
        gamma = math.atan(1.0 / self.quality) / math.pi
        power: np.ndarray = (1j * omega / (2.0 * math.pi * reference)) ** (2.0 * gamma)
        return elastic * math.cos(0.5 * math.pi * gamma) ** 2 * power


@dataclass(frozen=True)
class Column:
    """Layers from the free surface down, the last one the half-space; reference : frequency of "constant_q", Hz."""

    layers: Sequence[Layer]
    damping: Damping = "elastic"
    reference: float = 1.0

    def transfer(self, frequencies: np.ndarray, depth: float = 0.0, over: Reference = "incident") -> np.ndarray:
        """Displacement (k,) at a depth (m) over a motion at the top of the half-space, at frequencies (k,) Hz.

        frequencies : with a positive or zero real part; a negative imaginary one makes signals decay.
        """
        omega = 2.0 * math.pi * np.asarray(frequencies)
        omega = np.where(omega == 0.0, 1e-9 * 2.0 * math.pi * self.reference, omega)  # where powers have no phase
        up = down = np.ones(omega.shape, dtype=complex)
        top, moved = 0.0, None
        for number, layer in enumerate(self.layers):
            modulus, last = layer.modulus(omega, self.damping, self.reference), number == len(self.layers) - 1
            wave_number = omega * np.sqrt(layer.density / modulus)
            if moved is None and (last or depth < top + layer.thickness):
                phase = np.exp(1j * wave_number * (depth - top))
                moved = up * phase + down / phase
            if last:
                break
            following = self.layers[number + 1]
            below = following.density * following.modulus(omega, self.damping, self.reference)
            alpha, phase = np.sqrt(layer.density * modulus / below), np.exp(1j * wave_number * layer.thickness)
            rising, falling = up * phase, down / phase
            up, down = (0.5 * ((1.0 + a) * rising + (1.0 - a) * falling) for a in (alpha, -alpha))
            top += layer.thickness
        assert moved is not None
        return np.asarray(moved / {"incident": up, "outcrop": 2.0 * up, "within": up + down}[over])

    def history(
        self, motion: np.ndarray, time_step: float, depth: float = 0.0, over: Reference = "incident"
    ) -> np.ndarray:
        """Motion (n,) at a depth (m) under a motion (n,) at the top of the half-space, sampled at a time step (s).

        Both are displacements, velocities or accelerations, zero before. By a Fourier transform of signals that decay,
        in a window of `PADDED` times their length; a hysteretic modulus, which is not causal, is taken without decay.
        """
        count = 2 ** math.ceil(math.log2(PADDED * len(motion)))
        rate = 0.0 if self.damping == "hysteretic" else DECAY / (count * time_step)
        decay = np.exp(-rate * time_step * np.arange(len(motion)))
        frequencies = np.fft.rfftfreq(count, time_step) - 1j * rate / (2.0 * math.pi)
        spectrum = np.fft.rfft(motion * decay, count) * self.transfer(frequencies, depth, over)
        found: np.ndarray = np.fft.irfft(spectrum, count)[: len(motion)] / decay
        return found
