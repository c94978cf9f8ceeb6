"""P or S waves at normal incidence in layers on a half-space, by frequency and in time."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from dembound.exact.transform import DECAY, PADDED, Histories

Damping = Literal["elastic", "hysteretic", "constant_q"]
"""How the quality of layers enters their moduli."""

Reference = Literal["incident", "outcrop", "within"]
"""Motion at the top of the half-space: up-going wave, its surface without layers, or the motion there."""

FAST = 1e15
"""A frequency, Hz, of which moduli no longer depend."""


@dataclass(frozen=True)
class Layer:
    """A layer of a stack: thickness m (of the half-space unused), density kg/m³, speed m/s of its waves, quality Q.

    relative : M/ρc² (k,) of a layer with a modulus of its own, from frequencies (k,) Hz, which may be complex; Q then
    has no effect. heavier : density over the given one (k,), likewise; None: 1.
    """

    thickness: float
    density: float
    speed: float
    quality: float = math.inf
    relative: Callable[[np.ndarray], np.ndarray] | None = None
    heavier: Callable[[np.ndarray], np.ndarray] | None = None

    def modulus(self, omega: np.ndarray, damping: Damping, reference: float) -> np.ndarray:
        """M (k,) Pa at angular frequencies (k,) rad/s, which may be complex; reference : f₀ = ω₀/2π, Hz."""
        elastic = self.density * self.speed**2 * np.ones(np.shape(omega), dtype=complex)
        if self.relative is not None:
            return elastic * self.relative(omega / (2.0 * math.pi))
        if damping == "elastic" or math.isinf(self.quality):
            return elastic
        if damping == "hysteretic":
            return elastic * (1.0 + 1j / self.quality)
        gamma = math.atan(1.0 / self.quality) / math.pi
        power: np.ndarray = (1j * omega / (2.0 * math.pi * reference)) ** (2.0 * gamma)
        return elastic * math.cos(0.5 * math.pi * gamma) ** 2 * power

    def density_at(self, omega: np.ndarray) -> np.ndarray | float:
        """Density (k,) kg/m³ at angular frequencies (k,) rad/s, which may be complex."""
        return self.density if self.heavier is None else self.density * self.heavier(omega / (2.0 * math.pi))

    def relaxation(self, frequencies: np.ndarray) -> np.ndarray:
        """M over that of fast motion (k,) at frequencies (k,) Hz, of a layer with a modulus of its own; else 1."""
        if self.relative is None:
            return np.ones(np.shape(frequencies), dtype=complex)
        return self.relative(frequencies) / self.relative(np.array([FAST])).real


@dataclass(frozen=True)
class Column:
    """Layers from the surface down, the last one the half-space; reference : frequency of "constant_q", Hz.

    mass : on the free surface, kg/m²; None: the uppermost layer goes on above, and nothing comes back from there.
    """

    layers: Sequence[Layer]
    damping: Damping = "elastic"
    reference: float = 1.0
    mass: float | None = 0.0

    def _turning(self, frequencies: np.ndarray) -> np.ndarray:
        """ω (k,) of frequencies (k,) Hz; nearly zero for zero, where powers have no phase."""
        omega = 2.0 * math.pi * np.asarray(frequencies)
        return np.where(omega == 0.0, 1e-9 * 2.0 * math.pi * self.reference, omega)

    def motion(self, frequencies: np.ndarray, depths: Sequence[float], number: int | None = None) -> np.ndarray:
        """Displacement u, m, gradient ∂u/∂y and traction M ∂u/∂y, Pa, (3, d, k), at depths (d,) m; y points upwards.

        Of an incident wave of 1 m at the top of the half-space, at frequencies (k,) Hz. The traction is that on planes
        facing up. All factors are of waves on their way, so that nothing overflows.

        frequencies : with a positive or zero real part; a negative imaginary one makes signals decay. number : of the
        layer of all depths, from 0, which may reach a little beyond it; by default each depth's own, at an interface
        the lower one.
        """
        omega = self._turning(frequencies)
        moduli = [layer.modulus(omega, self.damping, self.reference) for layer in self.layers]
        densities = [layer.density_at(omega) for layer in self.layers]
        impedances = [np.sqrt(density * each) for density, each in zip(densities, moduli, strict=True)]
        waves = [1j * omega * density / each for density, each in zip(densities, impedances, strict=True)]
        # returned: B/A at the top of each layer; gained: A at its bottom over A at the top of the next one
        late = 1j * omega * (self.mass or 0.0) / impedances[0]
        returned, gained = [np.zeros_like(late) if self.mass is None else (1.0 - late) / (1.0 + late)], []
        between = zip(self.layers[:-1], waves[:-1], impedances[:-1], impedances[1:], strict=True)
        for layer, turn, above, below in between:
            back, alpha = returned[-1] * np.exp(-2.0 * turn * layer.thickness), above / below
            gained.append(2.0 / (1.0 + alpha + (1.0 - alpha) * back))
            returned.append(0.5 * (1.0 - alpha + (1.0 + alpha) * back) * gained[-1])
        rising = [np.ones(omega.shape, dtype=complex)]  # A at the top of each layer, from the lowest up
        for layer, turn, gain in zip(self.layers[-2::-1], waves[-2::-1], gained[::-1], strict=True):
            rising.insert(0, rising[0] * gain * np.exp(-turn * layer.thickness))
        tops = np.concatenate([[0.0], np.cumsum([layer.thickness for layer in self.layers[:-1]])])
        found = np.empty((3, len(depths), *omega.shape), dtype=complex)
        for place, depth in enumerate(depths):
            own = max(int(np.searchsorted(tops, depth, "right")) - 1, 0) if number is None else number
            z, turn = depth - tops[own], waves[own]
            if own == len(gained):
                up = rising[own] * np.exp(turn * z)
            else:  # from the bottom of the layer, where waves come from
                up = rising[own + 1] * gained[own] * np.exp(turn * (z - self.layers[own].thickness))
            down = returned[own] * rising[own] * np.exp(-turn * z)
            found[:2, place] = up + down, turn * (down - up)
            found[2, place] = moduli[own] * found[1, place]
        return found

    def rising(self, frequencies: np.ndarray, depth: float) -> np.ndarray:
        """The incident wave (k,) at a depth (m) over that at the top of the half-space, continued if this is above."""
        omega, last = self._turning(frequencies), self.layers[-1]
        turn = 1j * omega * np.sqrt(last.density_at(omega) / last.modulus(omega, self.damping, self.reference))
        return np.asarray(np.exp(turn * (depth - sum(layer.thickness for layer in self.layers[:-1]))))

    def transfer(self, frequencies: np.ndarray, depth: float = 0.0, over: Reference = "incident") -> np.ndarray:
        """Displacement (k,) at a depth (m) over a motion at the top of the half-space, at frequencies (k,) Hz.

        frequencies : as of `motion`.
        """
        bottom = sum(layer.thickness for layer in self.layers[:-1])
        moved, within = self.motion(frequencies, [depth, bottom])[0]
        return np.asarray(moved / {"incident": 1.0, "outcrop": 2.0, "within": within}[over])

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
        return np.asarray(np.fft.irfft(spectrum, count)[: len(motion)] / decay)


Quantity = Literal["displacement", "velocity", "gradient", "rate", "traction", "impulse", "relaxed", "relaxed_rate"]
"""u m, v m/s, ∂u/∂y, ∂v/∂y 1/s, with y upwards, and on planes facing up the traction, Pa, and its integral, Pa·s.

relaxed, relaxed_rate : u and v under which the unrelaxed springs of a layer have the forces of the damped ones."""

QUANTITIES: dict[Quantity, tuple[int, int]] = {
    "displacement": (0, 0),
    "velocity": (0, 1),
    "gradient": (1, 0),
    "rate": (1, 1),
    "traction": (2, 0),
    "impulse": (2, -1),
    "relaxed": (0, 0),
    "relaxed_rate": (0, 1),
}
"""Row of `Column.motion`, and number of derivatives in time."""


class ColumnMotion:
    """The motion of a column.

    Parameters
    ----------
    column : its layers. velocity : m/s at times in s, of the incident wave alone at a depth, m, in its half-space or
    continued from there; or if `within` of the column at this depth. begin : time (s) before which it is zero. until :
    last time (s); later ones double the window.
    """

    def __init__(
        self,
        column: Column,
        velocity: Callable[[np.ndarray], np.ndarray],
        depth: float,
        begin: float,
        until: float,
        within: bool = False,
    ) -> None:
        self._column, self._depth, self._within = column, depth, within
        self._histories = Histories(velocity, begin, until)

    def at(self, of: Quantity, times: np.ndarray, depths: tuple[float, ...], number: int | None = None) -> np.ndarray:
        """A quantity (k, d) at times (k,) s and depths (d,) m; number : of the layer, see `Column.motion`."""
        self._histories.reach(times)
        samples = self._histories.kept((of, depths, number), lambda: self._sampled(of, depths, number))
        return self._histories.between(samples, times)

    def _sampled(self, of: Quantity, depths: tuple[float, ...], number: int | None) -> np.ndarray:
        """A quantity (n, d) at all samples."""
        window, (row, derivatives) = self._histories.window, QUANTITIES[of]
        incident = window.derived(derivatives)
        if self._within:
            incident = incident / self._column.motion(window.frequencies, [self._depth])[0, 0]
        else:
            incident = incident / self._column.rising(window.frequencies, self._depth)
        found = []
        for depth in depths:
            own = self._column.motion(window.frequencies, [depth], number)[row, 0]
            if of in ("relaxed", "relaxed_rate") and number is not None:
                own = own * self._column.layers[number].relaxation(window.frequencies)
            found.append(window.sampled(incident * own))
        return np.stack(found, axis=1)
