"""A line source of isotropic moment, in plane strain: a pressure in a cavity of a full space, and Garvin's problem.

A cylindrical cavity in a full space under a pressure on its wall, in plane strain.

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

Garvin's problem: an explosion along a line in an elastic half-space, in plane strain.

x runs along the surface, z into the half-space, whose surface is free; the source is at x = 0, z = h. It is a line of
isotropic moment M(t) per unit length (N): the body force −M ∇δ, or two equal pairs of forces, along x and z; see
above for the moment of a pressure in a hole. With a = 1/c_p, b = 1/c_s, η_a = √(a²−p²), η_b = √(b²−p²), Γ =
b² − 2p² and Rayleigh's function R = Γ² + 4p²η_aη_b, the motion is a sum over rays,

    u(t) = 1/(2πρc_p²) Σ ∫ M′(t − τ) Im[F dp/dτ] dτ ,    with real τ = px + …  along the path of p (Cagniard, de Hoop):

    ray         τ − px          F_x                    F_z
    direct      η_a |z − h|     p/η_a                  sgn(z − h)
    P to P      η_a (z + h)     R_PP p/η_a             R_PP               R_PP = (4p²η_aη_b − Γ²)/R
    P to S      η_a h + η_b z   4pη_bΓ/R               −4p²Γ/R
    surface     η_a h           4pη_b b²/R             −2Γb²/R            (z = 0: the sum of the three)

(Garvin 1956, Proc. R. Soc. Lond. A 234, 528–541, for the surface; Sánchez-Sesma et al. 2013 for the interior.)

A path begins at the ray's arrival τ₀, where dp/dτ is infinite as (τ − τ₀)^−½. All paths but that of P to S are
hyperbolas: at distance x and height H from the source or its mirror image, L = √(x² + H²), they are

    p = (xτ + iH√(τ²−τ₀²))/L²,    η_a = (Hτ − ix√(τ²−τ₀²))/L²,    dp/dτ = iη_a/√(τ²−τ₀²),    τ₀ = aL .

The other one is found by Newton's method.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from dembound.exact.lamb import refined
from dembound.exact.solid import Solid
from dembound.exact.transform import Signal, respond
from dembound.roots import root

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


NODES, WEIGHTS = np.polynomial.legendre.leggauss(16)
FEWEST_PANELS = 4
MOST_PANELS = 2048
BLOCK = 2**16
"""Number of values computed at once."""

NEWTON_STEPS = 60
"""Largest number of steps; 25 were enough for distances and depths of a ratio up to 1e5."""


def buried_explosion(
    times: np.ndarray,
    distance: float,
    depth: float,
    source_depth: float,
    moment_rate: Signal,
    solid: Solid,
    tolerance: float = 1e-6,
) -> np.ndarray:
    """Displacement (2, k) m at times (k,) s, along x and z, of the place (distance, depth) m.

    depth : 0 at the surface. moment_rate : M′, N/s, at an array of times t ≥ 0 of any shape, nothing before; it may
    begin with a jump and must be continuous afterwards. With M″ instead the result is the velocity in m/s.

    The integrals are done by quadrature whose panels are halved until the last halving changed the motion by less than
    `tolerance` times its largest value.

    Raises ValueError for a source that is not below the surface, a place above it or at the source; RuntimeError if the
    tolerance is not reached.
    """
    if source_depth <= 0.0 or depth < 0.0:
        raise ValueError(f"depths must be positive (source: {source_depth} m) and not negative (place: {depth} m)")
    if distance == 0.0 and depth == source_depth:
        raise ValueError("the place is at the source, where the motion is infinite")
    times = np.asarray(times, dtype=float)
    rays = _rays(abs(distance), depth, source_depth, solid)

    def integral(panels: int) -> np.ndarray:
        return _sum(rays, times, moment_rate, panels)

    found = refined(integral, (FEWEST_PANELS, MOST_PANELS), tolerance, "Garvin's integral", "rate")
    found[0] *= np.sign(distance)
    return found / (2.0 * math.pi * solid.uniaxial)


@dataclass(frozen=True)
class _Ray:
    """The arrival τ₀ (s) of a ray, and Im[F dp/dτ] (2, …) at times τ > τ₀ of any shape (…)."""

    arrival: float
    kernel: Callable[[np.ndarray], np.ndarray]


def _rays(x: float, z: float, h: float, solid: Solid) -> list[_Ray]:
    """The rays from the source to a place with x ≥ 0."""
    a, b = 1.0 / solid.p_wave_speed, 1.0 / solid.s_wave_speed
    if z == 0.0:
        return [_hyperbola(x, h, a, lambda p, eta: _surface(p, eta, b))]
    up = math.copysign(1.0, z - h)
    direct = _hyperbola(x, abs(z - h), a, lambda p, eta: np.stack([p, up * eta]))
    return [direct, _hyperbola(x, z + h, a, lambda p, eta: _p_to_p(p, eta, b)), _p_to_s(x, z, h, a, b)]


def _hyperbola(x: float, height: float, a: float, fraction: Callable[[np.ndarray, np.ndarray], np.ndarray]) -> _Ray:
    """A ray with a single slowness a; fraction : η_aF (2, …) at p and η_a."""
    length = math.hypot(x, height)

    def kernel(tau: np.ndarray) -> np.ndarray:
        late = np.sqrt((tau - a * length) * (tau + a * length))
        p, eta = (x * tau + 1j * height * late) / length**2, (height * tau - 1j * x * late) / length**2
        return fraction(p, eta).real / np.where(late > 0.0, late, math.inf)  # dp/dτ = iη_a/late

    return _Ray(a * length, kernel)


def _surface(p: np.ndarray, eta_a: np.ndarray, b: float) -> np.ndarray:
    """η_aF of the surface."""
    eta_b, gamma, rayleigh = _rayleigh(p, eta_a, b)
    return 2.0 * b**2 * eta_a / rayleigh * np.stack([2.0 * p * eta_b, -gamma])


def _p_to_p(p: np.ndarray, eta_a: np.ndarray, b: float) -> np.ndarray:
    """η_aF of P to P."""
    _, gamma, rayleigh = _rayleigh(p, eta_a, b)
    return (1.0 - 2.0 * gamma**2 / rayleigh) * np.stack([p, eta_a])


def _p_to_s(x: float, z: float, h: float, a: float, b: float) -> _Ray:
    """P to S: Snell's law gives its first p, Newton's method the others, from the hyperbola of a single slowness."""

    def beyond(p: float) -> float:
        return x - p * (h / math.sqrt(a**2 - p**2) + z / math.sqrt(b**2 - p**2))

    first = root(beyond, 0.0, float(np.nextafter(a, 0.0))) if x > 0.0 else 0.0
    arrival = first * x + h * math.sqrt(a**2 - first**2) + z * math.sqrt(b**2 - first**2)
    square = x**2 + (h + z) ** 2

    def kernel(tau: np.ndarray) -> np.ndarray:
        late = np.sqrt((tau - arrival) * (tau + arrival))
        p = (x * tau + 1j * (h + z) * late) / square + (first - x * arrival / square) * (arrival / (tau + late)) ** 2
        for _ in range(NEWTON_STEPS):
            eta_a, eta_b = np.sqrt(a**2 - p**2), np.sqrt(b**2 - p**2)
            error, slope = p * x + h * eta_a + z * eta_b - tau, x - p * (h / eta_a + z / eta_b)
            p = p - error / slope
            p = np.where(p.imag < 0.0, p.conj(), p)
            if np.all(np.abs(error) < 1e-14 * tau):
                break
        eta_a = np.sqrt(a**2 - p**2)
        eta_b, gamma, rayleigh = _rayleigh(p, eta_a, b)
        slope = np.where(late > 0.0, x - p * (h / eta_a + z / eta_b), math.inf)
        return (4.0 * p * gamma / (rayleigh * slope) * np.stack([eta_b, -p])).imag

    return _Ray(arrival, kernel)


def _rayleigh(p: np.ndarray, eta_a: np.ndarray, b: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """η_b, Γ and R at p in the first quadrant."""
    eta_b, gamma = np.sqrt(b**2 - p**2), b**2 - 2.0 * p**2
    return eta_b, gamma, gamma**2 + 4.0 * p**2 * eta_a * eta_b


def _sum(rays: list[_Ray], times: np.ndarray, rate: Signal, panels: int) -> np.ndarray:
    """Σ ∫ M′ Im[F dp] (2, k) with `panels` Gauss panels on each piece of time between arrivals.

    Rays are added before they are integrated: at late times P to P and P to S grow as τ² and nearly cancel.
    """
    rays = sorted(rays, key=lambda ray: ray.arrival)
    total = np.zeros((2, len(times)))
    for number, (begin, end) in enumerate(pairwise([*(ray.arrival for ray in rays), math.inf])):
        begun = rays[: number + 1]
        whole, part = np.flatnonzero(times >= end), np.flatnonzero((begin < times) & (times < end))
        if len(whole) > 0 and end > begin:
            total[:, whole] += _piece(begun, begin, np.array([end]), times[whole], rate, panels)
        if len(part) > 0:
            total[:, part] += _piece(begun, begin, times[part], times[part], rate, panels)
    return total


def _piece(rays: list[_Ray], begin: float, end: np.ndarray, times: np.ndarray, rate: Signal, panels: int) -> np.ndarray:
    """The part (2, k) of the integral from `begin` to `end`, (k,) or (1,), at times (k,), over rays that have begun.

    With τ = begin cosh ξ, ξ = ξ_end (1 − v³), 0 < v < 1, nothing is infinite at the beginning, and nodes are
    concentrated at the end, where M′ begins; late after a short pulse nothing else contributes.
    """
    v = ((np.arange(panels)[:, None] + 0.5 + 0.5 * NODES) / panels).ravel()
    weights = np.tile(WEIGHTS, panels) / (2 * panels) * 3.0 * v**2
    last, total = np.arccosh(end / begin), np.zeros((2, len(times)))
    many = max(1, BLOCK // len(times))
    for first in range(0, len(v), many):
        xi = (1.0 - v[first : first + many, None] ** 3) * last
        tau = begin * np.cosh(xi)
        kernel = sum((ray.kernel(tau) for ray in rays), np.zeros(())) * begin * np.sinh(xi)
        force = rate(np.maximum(times - tau, 0.0)) * weights[first : first + many, None]
        total += np.einsum("nk,cnk->ck", force, np.broadcast_to(kernel, (2, *force.shape)))
    return last * total
