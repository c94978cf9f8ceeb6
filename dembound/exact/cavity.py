"""A cylindrical cavity in a full space under a pressure on its wall, in plane strain.

All motion is radial and a function of the distance r from the axis. With u = ∂φ/∂r and φ ~ K₀(sr/c_p) the Laplace
transforms of displacement and stresses (tension positive) are, with k = s/c_p and the cavity's radius a,

    u = A K₁(kr),    σ_r = −A [(λ+2μ) k K₀(kr) + 2μ K₁(kr)/r],    σ_θ = A [2μ K₁(kr)/r − λ k K₀(kr)],

    A = p̂ / [(λ+2μ) k K₀(ka) + 2μ K₁(ka)/a] ,

so that σ_r = −p at the wall; inverted by `transform.respond`. At the front, t = (r − a)/c_p, the velocity is
p √(a/r)/(ρc_p); the front's share √(a/r) e^{−k(r−a)} of velocity and stresses is subtracted from the transforms and
added in closed form, which keeps steep fronts steep.

A line source. A line of isotropic moment M(t) per unit length (N; the body force −M ∇δ, M > 0 is an explosion) moves
the full space by û = M̂ k K₁(kr)/(2πρc_p²), as this cavity does outside of it with

    M̂ = 2πρc_p² A/k ,    which is    M = πa² p (λ+2μ)/μ = πa² p (c_p/c_s)²

if the pressure is slow, T ≫ a/c_p. In an intact body radial forces of q (N/m) per metre of a circle of radius a have
the moment M = πa² q · 2I₁(ka)/(ka), where the last factor is 1 if they are slow, and two pairs of forces ±F at distance
d, one along each axis, M = Fd. A pressure in a hole has (c_p/c_s)² times the moment of the same forces in an intact
body, because the wall yields more than intact material.
"""

import math
from typing import NamedTuple

import numpy as np

from dembound.exact.solid import Solid
from dembound.exact.transform import Signal, respond

SAMPLES = 2000
"""Number of times at which the largest pressure is sought."""


class CavityMotion(NamedTuple):
    """Radial motion at k times, each (k,); stresses are positive in tension."""

    displacement: np.ndarray
    """m, positive outwards"""
    velocity: np.ndarray
    """m/s, positive outwards"""
    radial_stress: np.ndarray
    """Pa"""
    hoop_stress: np.ndarray
    """Pa"""


def cavity_motion(
    times: np.ndarray, distance: float, pressure: Signal, radius: float, solid: Solid, tolerance: float = 1e-6
) -> CavityMotion:
    """Motion at times (k,) s, at a distance r ≥ `radius` (m) from the cavity's axis.

    pressure : Pa on the wall at an array of times t ≥ 0, nothing before, positive outwards. tolerance : of each
    history over its largest value.

    Raises ValueError for a radius that is not positive and a distance inside the cavity; RuntimeError if the tolerance
    is not reached, as with a pressure that jumps.
    """
    _require_outside(distance, radius)
    spread = math.sqrt(radius / distance)
    delay = (distance - radius) / solid.p_wave_speed
    share = np.array([0.0, 1.0 / (solid.density * solid.p_wave_speed), -1.0, -solid.lame / solid.uniaxial])
    front = spread * share[:, None]

    def behind_front(s: np.ndarray) -> list[np.ndarray]:
        """Four transforms (m,) of the response to a unit impulse of pressure, without the front."""
        return list(np.exp(-s * delay) * (_transforms(s, distance, radius, solid) - front))

    since = np.asarray(times, dtype=float) - delay
    arrived = np.where(since >= 0.0, pressure(np.maximum(since, 0.0)), 0.0)
    largest = _largest(pressure, times)
    sizes = largest * np.abs(front[:, 0])
    sizes[0] = 0.5 * largest * radius**2 / (solid.shear * distance)  # at rest
    return CavityMotion(*respond(behind_front, pressure, times, tolerance, sizes.tolist(), known=list(front * arrived)))


def cavity_moment(
    times: np.ndarray, pressure: Signal, radius: float, solid: Solid, tolerance: float = 1e-5
) -> np.ndarray:
    """Isotropic moment M and its first two derivatives, (3, k), N, N/s and N/s², at times (k,) s.

    A line source of this moment on the axis moves the full space outside the cavity exactly as the pressure does. The
    wave leaves the axis a/c_p before it leaves the wall, so M begins at t = −a/c_p. Arguments and errors as of
    `cavity_motion`; the second derivative needs a pressure without kinks.
    """
    _require_outside(radius, radius)

    def moment(s: np.ndarray) -> list[np.ndarray]:
        k = s / solid.p_wave_speed
        unit = 2.0 * math.pi * solid.uniaxial / k * np.exp(k * radius) / _wall(k, radius, solid)
        return [unit, s * unit, s**2 * unit]

    advance, slow = radius / solid.p_wave_speed, math.pi * radius**2 * solid.uniaxial / solid.shear
    sizes = [_largest(pressure, times) * slow / advance**order for order in range(3)]
    return np.stack(respond(moment, pressure, times, tolerance, sizes))


def _largest(pressure: Signal, times: np.ndarray) -> float:
    """Largest size of a pressure (Pa) up to the last of some times."""
    return float(np.abs(pressure(np.linspace(0.0, float(np.abs(times).max(initial=0.0)), SAMPLES))).max())


def _transforms(s: np.ndarray, distance: float, radius: float, solid: Solid) -> np.ndarray:
    """Displacement, velocity and stresses (4, m) for p̂ = 1, without the factor e^{−s(r − a)/c_p}."""
    from scipy.special import kve

    k = s / solid.p_wave_speed
    zero, one = kve(0, k * distance), kve(1, k * distance)
    strain, pull = k * zero, 2.0 * solid.shear * one / distance
    rows = [one, s * one, -(solid.uniaxial * strain + pull), pull - solid.lame * strain]
    return np.stack(rows) / _wall(k, radius, solid)


def _wall(k: np.ndarray, radius: float, solid: Solid) -> np.ndarray:
    """e^{ka} p̂/A (m,)."""
    from scipy.special import kve

    return solid.uniaxial * k * kve(0, k * radius) + 2.0 * solid.shear * kve(1, k * radius) / radius


def _require_outside(distance: float, radius: float) -> None:
    if radius <= 0.0:
        raise ValueError(f"radius ({radius} m) must be positive")
    if distance < radius:
        raise ValueError(f"distance ({distance} m) must not be below the radius ({radius} m), inside the cavity")
