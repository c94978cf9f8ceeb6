"""A bar: a pressure pulse in it, where it spalls, and the dispersion of waves on its nodes.

Dispersion of a peridynamic bar: wave speeds on its nodes (L section 2).

A harmonic wave u = exp j(ωnΔt − kiΔx) on nodes Δx apart, each bonded to m neighbours on either side, obeys L eq. 12,
here with the half weight of the outermost neighbours counted once, and written with squared half angles to reduce
rounding errors,

    sin²(ωΔt/2) = ν² q(θ),    q = (2/m²) Σ_{p=1..m} (w_p/p) sin²(pθ/2),    θ = kΔx,  ν = cΔt/Δx,

w_m = ½ and the other weights 1. With m = 1 this is the central difference scheme. The slope has a closed form,

    dq/dθ = (1/m²) Σ w_p sin pθ = sin²(mθ/2) cot(θ/2) / m² ≥ 0    for 0 < θ ≤ π,

so ω does not decrease with k, and the shortest wave, θ = π, is the first to become unstable, for odd and for even m.
Waves whose length is the horizon mΔx divided by a whole number transport no energy.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from dembound.roots import root

End = Literal["free", "fixed", "absorbing"]
Pulse = Callable[[np.ndarray], np.ndarray]


def bar_stress(
    place: float, time: np.ndarray, pressure: Pulse, length: float, speed: float, far_end: End = "free"
) -> np.ndarray:
    """Stress (k,) Pa, tension positive, at a place (m) of a bar and at times (k,) s.

    pressure: Pa on the end x = 0 at times in s, nothing before 0; length m of the bar; speed m/s of its waves. The end
    x = length is free, fixed or absorbs all.
    """
    far = {"free": -1.0, "fixed": 1.0, "absorbing": 0.0}[far_end]
    stress = np.zeros_like(time)
    for turn, way in _passages(place, length, time.max() * speed):
        stress -= far ** ((turn + 1) // 2) * (-1.0) ** (turn // 2) * pressure(time - way / speed)
    return stress


def bar_velocity(
    place: float,
    time: np.ndarray,
    pressure: Pulse,
    length: float,
    speed: float,
    impedance: float,
    far_end: End = "free",
) -> np.ndarray:
    """Velocity (k,) m/s, positive away from the loaded end, for an impedance ρc in Pa·s/m.

    Other arguments as in `bar_stress`.
    """
    far = {"free": 1.0, "fixed": -1.0, "absorbing": 0.0}[far_end]
    velocity = np.zeros_like(time)
    for turn, way in _passages(place, length, time.max() * speed):
        velocity += far ** ((turn + 1) // 2) * pressure(time - way / speed) / impedance
    return velocity


def triangle_spall(
    length: float, speed: float, rise: float, fall: float, crest: float, strength: float
) -> tuple[float, float]:
    """Place (m) and time (s) at which a bar with a free end x = length first breaks under a triangular pulse on x = 0.

    length m, longer than the pulse; speed m/s of waves; the pulse rises from t = 0 for `rise` s to `crest` Pa and falls
    for `fall` s; strength Pa. Raises ValueError where the strength exceeds the crest: the bar does not break.
    """
    if not 0.0 < strength <= crest:
        raise ValueError(f"strength ({strength:g} Pa) must be positive and at most the crest ({crest:g} Pa)")
    share = strength / crest
    behind, after = (share * fall, rise) if fall >= rise else (rise + fall - share * rise, share * rise)
    distance = 0.5 * speed * behind
    return length - distance, after + (length + distance) / speed


def _passages(place: float, length: float, longest: float) -> Iterator[tuple[int, float]]:
    """Number of reflections and path length (m) from x = 0 of each passage at a place, up to the longest path."""
    for turn in range(int(longest / length) + 1):
        yield turn, turn * length + (place if turn % 2 == 0 else length - place)


ROUNDING = 1e-12
"""Rounding error allowed in sin(ωΔt/2) ≤ 1, so that a step exactly at the limit is stable."""

SAMPLES = 100
"""Number of wave numbers per extremum of a speed; there are up to m extrema between 0 and π/Δx."""

Speed = Literal["phase", "group"]


@dataclass(frozen=True)
class Lattice:
    """An infinite row of nodes, bonded and stepped in time.

    horizon : neighbours m on either side; 1 is central differences.
    spacing : Δx, m.
    time_step : Δt, s; 0 means exact integration in time.
    wave_speed : c of long waves, m/s.
    shares : (m,) shares of the stress under uniform strain that bonds of one, two … spacings carry; their sum is 1. By
    default those of L's bonds, 2w_p p/m².

    Raises ValueError for a horizon below 1, a spacing or speed that is not positive, a negative step, and shares that
    are not m numbers with the sum 1.
    """

    horizon: int
    spacing: float
    time_step: float
    wave_speed: float
    shares: tuple[float, ...] | None = None

    def __post_init__(self) -> None:
        if self.horizon < 1:
            raise ValueError(f"horizon ({self.horizon}) must be at least 1")
        if not (0.0 < self.spacing < math.inf and 0.0 < self.wave_speed < math.inf):
            raise ValueError(f"spacing ({self.spacing} m) and wave speed ({self.wave_speed} m/s) must be positive")
        if not 0.0 <= self.time_step < math.inf:
            raise ValueError(f"time step ({self.time_step} s) must not be negative")
        if self.shares is not None and (len(self.shares) != self.horizon or abs(sum(self.shares) - 1.0) > 1e-9):
            raise ValueError(f"shares ({self.shares}) must be {self.horizon} numbers that add up to 1")

    @property
    def courant(self) -> float:
        """Courant number ν = cΔt/Δx."""
        return self.wave_speed * self.time_step / self.spacing

    @property
    def stable(self) -> bool:
        """Whether no wave grows."""
        return self.courant <= self.courant_limit * (1.0 + ROUNDING)

    @property
    def courant_limit(self) -> float:
        """Largest Courant number with which no wave grows, see the function of that name."""
        return courant_limit(self.horizon, self.shares)

    @property
    def shortest(self) -> float:
        """Wave number π/Δx (rad/m) of the shortest wave, two spacings long."""
        return math.pi / self.spacing

    def frequency(self, wavenumber: np.ndarray | float) -> np.ndarray:
        """Angular frequency ω (rad/s) at wave numbers k (rad/m) of any shape; nan where the wave grows (L eq. 12)."""
        return np.asarray(wavenumber) * self.phase_velocity(wavenumber)

    def phase_velocity(self, wavenumber: np.ndarray | float) -> np.ndarray:
        """Speed ω/k (m/s) of the crests at wave numbers 0 ≤ k ≤ π/Δx (rad/m), same shape; nan where the wave grows."""
        half = self._half_angle(wavenumber)
        root = self._root(half)
        sine = self.courant * half * root
        angle = np.arcsin(np.where(sine <= 1.0 + ROUNDING, np.minimum(sine, 1.0), np.nan))
        return self.wave_speed * root / np.sinc(angle / np.pi)

    def group_velocity(self, wavenumber: np.ndarray | float) -> np.ndarray:
        """Speed dω/dk (m/s) of energy at wave numbers 0 ≤ k ≤ π/Δx (rad/m), same shape; nan where the wave grows.

        Also nan for a wave at the stability limit, where ωΔt = π and ω(k) ends.
        """
        half = self._half_angle(wavenumber)
        root = self._root(half)
        square = (self.courant * half * root) ** 2
        cosine = np.sqrt(np.where(square < 1.0 - ROUNDING, 1.0 - square, np.nan))
        if self.shares is None:
            slope = np.sinc(self.horizon * half / np.pi) ** 2 * np.cos(half) / np.sinc(half / np.pi)
        else:  # this sum has no closed form
            slope = sum(share * np.sinc(2 * p * half / np.pi) for p, share in enumerate(self.shares, start=1))
        return self.wave_speed * slope / (root * cosine)

    def _half_angle(self, wavenumber: np.ndarray | float) -> np.ndarray:
        """θ/2 = kΔx/2."""
        return 0.5 * self.spacing * np.asarray(wavenumber, dtype=float)

    def _root(self, half: np.ndarray) -> np.ndarray:
        """√q / (θ/2), which is 1 for long waves, at half angles θ/2."""
        return np.sqrt(_square(half, self.horizon, self.shares))


def _square(half: np.ndarray, horizon: int, shares: tuple[float, ...] | None) -> np.ndarray:
    """Q / (θ/2)², which is 1 for long waves, at half angles θ/2."""
    if shares is not None:
        return sum((share * np.sinc(p * half / np.pi) ** 2 for p, share in enumerate(shares, start=1)), 0.0 * half)
    square = sum(w * p * np.sinc(p * half / np.pi) ** 2 for p, w in enumerate(_weights(horizon), start=1))
    return 2.0 * square / horizon**2


def courant_limit(horizon: int, shares: tuple[float, ...] | None = None) -> float:
    """Largest ν = cΔt/Δx with which no wave grows: m/√(2 Σ w_p/p over odd p ≤ m).

    At this ν, ν²q reaches 1. The largest q is that of the shortest wave, kΔx = π, for odd and for even m (see above;
    for even m the curvature of q is also zero there). 1 for m = 1, √2 for 2, 1.964 for 3, 5.289 for 10.

    With shares other than L's, see `Lattice`, the largest q is searched among all waves.
    """
    if shares is not None:
        return _searched_limit(horizon, shares)
    odd = np.arange(1, horizon + 1, 2)
    return float(horizon / np.sqrt(2.0 * np.sum(_weights(horizon)[::2] / odd)))


def _searched_limit(horizon: int, shares: tuple[float, ...]) -> float:
    """1/√q for the largest q of all waves."""
    from scipy.optimize import minimize_scalar

    def less(half: float) -> float:
        return -float(half**2 * _square(np.array(half), horizon, shares))

    half = np.linspace(0.0, 0.5 * np.pi, SAMPLES * horizon)
    most = int(np.argmax(half**2 * _square(half, horizon, shares)))
    around = half[max(most - 1, 0)], half[min(most + 1, len(half) - 1)]
    found = minimize_scalar(less, bounds=around, method="bounded", options={"xatol": 1e-12})
    return float(1.0 / np.sqrt(-min(found.fun, less(half[most]))))


def cells_per_wavelength(
    horizon: int, courant: float, error: float = 0.01, of: Speed = "phase", shares: tuple[float, ...] | None = None
) -> float:
    """Spacings per wavelength from which on the relative error of a wave's speed c is at most `error`.

    This holds for all longer waves, too. `of` chooses the speed: of the crests (phase) or of the energy (group). To
    leading order the phase speed is c(1 − (kΔx)²((m²+1)/2 − ν²)/24), and the error of the group speed is three times as
    large. For a bar without error, as with m = 1 and ν = 1, the result is 2, the shortest wave. shares : see `Lattice`.

    Raises ValueError for a ν above its limit and an error that is not between 0 and 1.
    """
    if not 0.0 < error < 1.0:
        raise ValueError(f"error ({error}) must be between 0 and 1")
    lattice = Lattice(horizon, spacing=1.0, time_step=courant, wave_speed=1.0, shares=shares)
    if not lattice.stable:
        raise ValueError(f"Courant number ({courant}) must not be above {lattice.courant_limit:.6g}, its limit")
    speed = lattice.phase_velocity if of == "phase" else lattice.group_velocity

    def margin(wavenumber: Any) -> Any:
        return error - np.abs(speed(wavenumber) - 1.0)

    tried = np.linspace(0.0, np.pi, SAMPLES * horizon)[:-1]  # a curve may end at π
    beyond = np.flatnonzero(margin(tried) < 0.0)
    if not beyond.size:
        return 2.0
    return float(2.0 * np.pi / root(margin, tried[beyond[0] - 1], tried[beyond[0]]))


def usual_shares(horizon: int) -> tuple[float, ...]:
    """Shares (m,) of the stress under uniform strain that L's bonds of one, two … spacings carry: 2w_p p/m²."""
    lengths = np.arange(1, horizon + 1)
    return tuple((2.0 * _weights(horizon) * lengths / horizon**2).tolist())


def _weights(horizon: int) -> np.ndarray:
    """w_p (m,): the outermost neighbours are at the horizon, with half their volume inside it (L eq. 9)."""
    weights = np.ones(horizon)
    weights[-1] = 0.5
    return weights
