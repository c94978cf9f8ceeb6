"""A circular cavity in a full space under a plane P or SV wave, in plane strain.

The wave travels in the direction d; angles θ are counted from d, anticlockwise, and x, y are along d and 90° to its
left. Its particle velocity is v(t − x/c), along d in a P wave, and to the right of d, −y, in an SV wave (+x for a wave
straight up), so that v(t) is the motion at the cavity's axis without the cavity. With u = ∇φ + (∂ψ/∂y, −∂ψ/∂x) the
Laplace transforms of the incident potentials, and their expansion about the axis (Abramowitz & Stegun 9.6.34), are

    φ = −(c_p/s) ĝ e^{−k_p x}   or   ψ = −(c_s/s) ĝ e^{−k_s x},    e^{−kx} = Σ ε_n (−1)ⁿ I_n(kr) cos nθ,

with ĝ = v̂/s, k_p = s/c_p, k_s = s/c_s, ε_0 = 1 and other ε_n = 2. The scattered potentials are

    φ = Σ A_n K_n(k_p r)/K_n(k_p a) T_n(θ),    σψ = Σ B_n K_n(k_s r)/K_n(k_s a) T_n′(θ) ,

T = cos nθ, T′ = sin nθ, σ = 1 for P and T = sin nθ, T′ = cos nθ, σ = −1 for SV. For functions F(r) of φ and G(r) of
σψ, with F* = rF′/F and G* = rG′/G, displacements and stresses are

    r u_r = (F* F + n G) T,    r u_θ = −σ(n F + G* G) T′,
    r²/μ σ_r = ([k_s²r² + 2(n² − F*)] F + 2n(G* − 1) G) T,
    r²/μ σ_rθ = −σ(2n(F* − 1) F + [k_s²r² + 2(n² − G*)] G) T′,
    r²/μ σ_θ = ([(k_s² − 2k_p²)r² + 2(F* − n²)] F − 2n(G* − 1) G) T,

and A_n and B_n make σ_r and σ_rθ zero at r = a: two equations for each n (Pao & Mow 1973, Diffraction of elastic waves
and dynamic stress concentrations, chapter III, for harmonic waves). Terms of orders beyond |k_s a| fall faster than
exponentially. Time histories by `transform.respond`.
"""

from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from dembound.exact.solid import Solid
from dembound.exact.transform import Signal, decaying_ratios, from_ratios, growing_ratios, respond

MOST = 2**16
"""Largest number of samples in time; orders are as many as the highest frequency needs."""

BLOCK = 128
"""Number of frequencies computed at once, with the orders of the highest."""

SAMPLES = 2000
"""Number of times at which the size of a wave is sought."""

WaveKind = Literal["p", "sv"]


class ScatteredMotion(NamedTuple):
    """Total motion, of the incident and the scattered wave, at m places and k times."""

    displacement: np.ndarray
    """(m, 2, k) along x and y, m"""
    velocity: np.ndarray
    """(m, 2, k) along x and y, m/s"""
    stress: np.ndarray
    """(m, 3, k) σ_r, σ_θ, σ_rθ about the cavity's axis, Pa, tension positive"""


@dataclass(frozen=True)
class PlaneWave:
    """A plane wave and the direction in which it travels.

    kind : P or SV. angle : of the direction, rad anticlockwise from the x axis of the places. velocity : m/s at the
    cavity's axis, without the cavity, at an array of times t ≥ 0, nothing before; along the direction (P), or 90° to
    the right of it (SV).
    """

    kind: WaveKind
    angle: float
    velocity: Signal


def scattered_motion(
    times: np.ndarray, places: np.ndarray, wave: PlaneWave, radius: float, solid: Solid, tolerance: float = 1e-5
) -> ScatteredMotion:
    """Motion of places (m, 2), in m from the cavity's axis and not inside the cavity, at times (k,) s.

    The wave is at the axis at t = 0, so it meets the wall before, at t = −a/c; times may be negative. tolerance : of
    displacements, velocities and stresses over their largest value among all places, or over that of the incident wave.

    Raises ValueError for a radius that is not positive and places in the cavity; RuntimeError if the tolerance is not
    reached, as with a wave that jumps.
    """
    if radius <= 0.0:
        raise ValueError(f"radius ({radius} m) must be positive")
    distance, angle = np.hypot(*places.T), np.arctan2(places[:, 1], places[:, 0])
    if distance.min() < radius * (1.0 - 1e-12):
        raise ValueError(f"places must be outside the cavity of {radius} m, one is {distance.min()} m from its axis")
    cavity = _Cavity(wave.kind, radius, solid)
    distance = radius * np.maximum(np.round(distance / radius, 12), 1.0)  # places on one circle are computed at once
    turned = angle - wave.angle

    def transforms(s: np.ndarray) -> list[np.ndarray]:
        """Displacement and velocity (2, m, 2, n) and stress (m, 3, n) at frequencies (n,), for v̂ = 1."""
        total = cavity.incident(s, distance, turned)
        for begin in range(0, len(s), BLOCK):
            part = slice(begin, begin + BLOCK)
            total[..., part] += cavity.scattered(s[part], distance, turned)
        return [total[:, :2], s * total[:, :2], total[:, 2:]]

    moved, moving, stress = respond(transforms, wave.velocity, times, tolerance, _sizes(wave, times, solid), most=MOST)
    turn = np.moveaxis(np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]), 2, 0)
    return ScatteredMotion(turn @ moved, turn @ moving, stress)


def _sizes(wave: PlaneWave, times: np.ndarray, solid: Solid) -> list[float]:
    """Displacement, velocity and stress of the incident wave, up to the last of some times."""
    grid = np.linspace(0.0, float(np.abs(times).max(initial=0.0)), SAMPLES)
    velocity = np.abs(wave.velocity(grid))
    largest = float(velocity.max())
    return [float(np.trapezoid(velocity, grid)), largest, largest * solid.density * solid.p_wave_speed]


class _Radial(NamedTuple):
    """Functions of the distance for all orders (N, n)."""

    value: np.ndarray
    """F"""
    slope: np.ndarray
    """F* = rF′/F"""


@dataclass(frozen=True)
class _Cavity:
    """The cavity and the kind of the wave; fields are u_r, u_θ, σ_r, σ_θ, σ_rθ, for v̂ = 1."""

    kind: WaveKind
    radius: float
    solid: Solid

    def incident(self, s: np.ndarray, distance: np.ndarray, angle: np.ndarray) -> np.ndarray:
        """Fields (m, 5, n) of the incident wave at m places and frequencies (n,)."""
        cosine, sine = np.cos(angle)[:, None], np.sin(angle)[:, None]
        twice_cosine, twice_sine = cosine**2 - sine**2, 2.0 * sine * cosine
        k = s / (self.solid.p_wave_speed if self.kind == "p" else self.solid.s_wave_speed)
        moved = np.exp(-k * distance[:, None] * cosine) / s
        if self.kind == "p":
            mean, half = -(self.solid.lame + self.solid.shear) * k * moved, -self.solid.shear * k * moved
            motion = [cosine * moved, -sine * moved]
            stress = [mean + half * twice_cosine, mean - half * twice_cosine, -half * twice_sine]
        else:
            shear = self.solid.shear * k * moved
            motion = [-sine * moved, -cosine * moved]
            stress = [shear * twice_sine, -shear * twice_sine, shear * twice_cosine]
        return np.stack([*motion, *stress], axis=1)

    def scattered(self, s: np.ndarray, distance: np.ndarray, angle: np.ndarray) -> np.ndarray:
        """Fields (m, 5, n) of the scattered wave at m places and frequencies (n,)."""
        from scipy.special import kve

        orders = self._orders(s)
        n = np.arange(orders)[:, None]
        wave_numbers = s / self.solid.p_wave_speed, s / self.solid.s_wave_speed
        at_wall = [decaying_ratios(k * self.radius, orders) for k in wave_numbers]
        amplitudes = self._amplitudes(s, at_wall)
        total = np.empty((len(distance), 5, len(s)), dtype=complex)
        for r in np.unique(distance):
            outgoing = []
            for k, wall, amplitude in zip(wave_numbers, at_wall, amplitudes, strict=True):
                here = decaying_ratios(k * r, orders)
                first = kve(0, k * r) / kve(0, k * self.radius) * np.exp(-k * (r - self.radius))
                outgoing.append(_Radial(amplitude * from_ratios(first, here / wall), n - k * r * here))
            chosen = distance == r
            shapes = self._shapes(n[:, 0], angle[chosen])
            total[chosen] = np.moveaxis(shapes @ self._fields(s, r, *outgoing), 0, 1)
        return total

    def _orders(self, s: np.ndarray) -> int:
        """Number of orders: I_n(z) is below 1e-16 from n = z + 11.4 z^⅓ on, and for small z from n = 16 on."""
        most = float(np.abs(s).max()) * self.radius / self.solid.s_wave_speed
        return int(most + 12.0 * most ** (1.0 / 3.0)) + 16

    def _amplitudes(self, s: np.ndarray, at_wall: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
        """A_n and B_n (N, n); at_wall : ratios of outgoing functions there."""
        from scipy.special import ive

        orders, a = len(at_wall[0]), self.radius
        n = np.arange(orders)[:, None]
        speed = self.solid.p_wave_speed if self.kind == "p" else self.solid.s_wave_speed
        z, none = s / speed * a, _Radial(np.zeros((orders, len(s))), np.zeros((orders, len(s))))
        ratios = growing_ratios(z, orders)
        factor = np.where(n == 0, 1.0, 2.0) * (-1.0) ** n
        factor = -factor if self.kind == "p" else factor  # of φ, and of −ψ
        wave = _Radial(speed / s**2 * factor * from_ratios(ive(0, z) * np.exp(z.real), ratios), n + z * ratios)
        speeds = zip((self.solid.p_wave_speed, self.solid.s_wave_speed), at_wall, strict=True)
        unit = [_Radial(np.ones((orders, len(s))), n - s / c * a * wall) for c, wall in speeds]
        pairs = ((wave, none) if self.kind == "p" else (none, wave)), (unit[0], none), (none, unit[1])
        (t, t_shear), (p, p_shear), (q, q_shear) = (self._fields(s, a, *pair)[[2, 4]] for pair in pairs)
        determinant = p * q_shear - q * p_shear
        return (q * t_shear - t * q_shear) / determinant, (t * p_shear - p * t_shear) / determinant

    def _fields(self, s: np.ndarray, r: float, f: _Radial, g: _Radial) -> np.ndarray:
        """Fields (5, N, n) of the functions F and G at a distance r, without their shapes along θ."""
        n = np.arange(len(f.value))[:, None]
        p, q = (s * r / self.solid.p_wave_speed) ** 2, (s * r / self.solid.s_wave_speed) ** 2
        moved = [f.slope * f.value + n * g.value, n * f.value + g.slope * g.value]
        mixed = 2.0 * n * (g.slope - 1.0) * g.value
        stress = [
            (q + 2.0 * (n**2 - f.slope)) * f.value + mixed,
            (q - 2.0 * p + 2.0 * (f.slope - n**2)) * f.value - mixed,
            2.0 * n * (f.slope - 1.0) * f.value + (q + 2.0 * (n**2 - g.slope)) * g.value,
        ]
        return np.stack([*(row / r for row in moved), *(row * self.solid.shear / r**2 for row in stress)])

    def _shapes(self, n: np.ndarray, angle: np.ndarray) -> np.ndarray:
        """T or −σT′ of each of the fields (6, m, N) at angles (m,)."""
        phase = n * angle[:, None]
        if self.kind == "p":
            even, odd = np.cos(phase), -np.sin(phase)
        else:
            even, odd = np.sin(phase), np.cos(phase)
        return np.stack([even, odd, even, even, odd])
