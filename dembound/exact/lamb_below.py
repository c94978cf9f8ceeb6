"""Lamb's problem below the surface: a line load on an elastic half-space moves a place inside it, in plane strain.

In the notation of `exact/lamb.py` the load F(t) moves the place at x, z by a sum over two rays (Cagniard, de Hoop),

    u(t) = 1/(πμ) Σ ∫ F(t − τ) Im[f dp/dτ] dτ ,    τ real along the path of p:

    ray    τ − px    f_x               f_z
    P      η_a z     p (b² − 2p²)/R    η_a (b² − 2p²)/R
    S      η_b z     −2pη_aη_b/R       2p²η_a/R

On the surface both have τ = px, and their sum is the solution there. With L = √(x² + z²) both paths are hyperbolas as
in `exact/explosion.py`, from τ = aL and bL on. Where x/L > a/b, S begins with the head wave: p real from a to bx/L.

Rayleigh's pole lies z√(p_R² − b²) beside the real time p_R x, towards which intervals of integration become shorter.
"""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from dembound.exact.lamb import rayleigh_speed, refined
from dembound.exact.solid import Solid
from dembound.exact.transform import Signal

NODES, WEIGHTS = np.polynomial.legendre.leggauss(16)
ROOTS = 0.5 + 0.5 * NODES[:, None]
"""v of τ = low + (high − low) v², which removes a square root at the lower end; (16, 1)."""

SLOPES = ROOTS[:, 0] * WEIGHTS
"""Weights of these nodes, dτ = 2v dv over high − low; (16,)."""

FEWEST_PANELS, MOST_PANELS = 8, 1024


def buried_displacement(
    times: np.ndarray, distance: float, depth: float, load: Signal, solid: Solid, tolerance: float = 1e-6
) -> np.ndarray:
    """Displacement (2, k) m at the `times` (k,) s of a place `distance` m beside a line load and `depth` m below it.

    Row 0 is horizontal, positive away from the load; row 1 vertical, positive downwards. `load` is the force per metre
    of line (N/m), positive downwards, at an array of times t ≥ 0 of any shape, nothing before; it may begin with a jump
    and must be continuous afterwards.

    The integrals are done by quadrature whose panels are halved until the last halving changed the displacements by
    less than `tolerance` times the largest of them.

    Raises ValueError for a distance or depth that is not positive; RuntimeError if the tolerance is not reached.
    """
    if distance <= 0.0 or depth <= 0.0:
        raise ValueError(f"distance ({distance} m) and depth ({depth} m) must be positive")
    times = np.asarray(times, dtype=float)
    rays = _Rays(distance, depth, 1.0 / solid.p_wave_speed, 1.0 / solid.s_wave_speed)
    panels = FEWEST_PANELS, MOST_PANELS
    found = refined(lambda number: _sum(rays, times, load, number), panels, tolerance, "Lamb's integral", "load")
    return found / (math.pi * solid.density * solid.s_wave_speed**2)


@dataclass(frozen=True)
class _Rays:
    """P and S to the place at x, z in a half-space with the slownesses a and b."""

    x: float
    z: float
    a: float
    b: float

    @property
    def length(self) -> float:
        """Distance L of the place from the load."""
        return math.hypot(self.x, self.z)

    @property
    def head(self) -> tuple[float, float]:
        """The times of the head wave: its arrival and that of S, the same where there is none."""
        behind = self.b * self.length
        if self.b * self.x <= self.a * self.length:
            return behind, behind
        return self.a * self.x + self.z * math.sqrt(self.b**2 - self.a**2), behind

    def marks(self, latest: float) -> list[float]:
        """Times up to the latest between which the kernel is smooth: arrivals, and some towards Rayleigh's pole."""
        pole = 1.0 / rayleigh_speed(1.0 / self.a, 1.0 / self.b)
        middle, apart = pole * self.x, self.z * math.sqrt(pole**2 - self.b**2)
        first, last = self.a * self.length, max(latest, self.a * self.length)
        away = apart * 2.0 ** np.arange(max(1.0, math.log2(max(last, middle) / apart)))
        found = np.concatenate([[first, self.b * self.length, middle], middle - away, middle + away])
        return sorted({first, last, *(float(time) for time in found if first < time < last)})

    def kernel(self, tau: np.ndarray) -> np.ndarray:
        """Σ Im[f dp/dτ] (2, …) on the hyperbolas, at times (…) that all lie between the same two marks."""
        p, eta_a, over = self._hyperbola(tau, self.a)
        gamma, rayleigh = _rayleigh(p, eta_a, np.sqrt(self.b**2 - p**2), self.b)
        total = (np.stack([p, eta_a]) * gamma / rayleigh * over).imag
        if tau.flat[0] > self.b * self.length:
            p, eta_b, over = self._hyperbola(tau, self.b)
            eta_a = np.sqrt(self.a**2 - p**2)
            _, rayleigh = _rayleigh(p, eta_a, eta_b, self.b)
            total += (np.stack([-eta_b, p]) * 2.0 * p * eta_a / rayleigh * over).imag
        return total

    def _hyperbola(self, tau: np.ndarray, slowness: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """p, η of this slowness, and dp/dτ."""
        arrival = slowness * self.length
        late = np.sqrt((tau - arrival) * (tau + arrival))
        p, eta = (self.x * tau + 1j * self.z * late), (self.z * tau - 1j * self.x * late)
        return p / self.length**2, eta / self.length**2, 1j * eta / (self.length**2 * late)

    def head_wave(self, times: np.ndarray, load: Signal, panels: int) -> np.ndarray:
        """The part of the head wave (2, k) at times (k,) after its arrival, with Gauss panels in √(p − a)."""
        _, high = self.head
        squares = np.minimum(times, high) ** 2
        late = np.sqrt(high**2 - squares)
        width = (self.x * np.sqrt(squares) - self.z * late) / self.length**2 - self.a
        total = np.zeros((2, len(times)))
        for number in range(panels):
            v = (number + ROOTS) / panels
            p = self.a + width * v**2
            eta_a, eta_b = -1j * np.sqrt((p - self.a) * (p + self.a)), np.sqrt(self.b**2 - p**2)
            _, rayleigh = _rayleigh(p, eta_a, eta_b, self.b)
            kernel = (np.stack([-eta_b, p]) * 2.0 * p * eta_a / rayleigh).imag * (v / panels)
            force = load(np.maximum(times - self.x * p - self.z * eta_b, 0.0))
            total += np.einsum("n,cnk,nk->ck", WEIGHTS, kernel, force)
        return width * total


def _rayleigh(p: np.ndarray, eta_a: np.ndarray, eta_b: np.ndarray, b: float) -> tuple[np.ndarray, np.ndarray]:
    """b² − 2p² and R."""
    gamma = b**2 - 2.0 * p**2
    return gamma, gamma**2 + 4.0 * p**2 * eta_a * eta_b


def _sum(rays: _Rays, times: np.ndarray, load: Signal, panels: int) -> np.ndarray:
    """Σ ∫ F Im[f dp] (2, k) with panels of at most 1/`panels` of all time."""
    total, latest = np.zeros((2, len(times))), float(times.max(initial=0.0))
    begin, end = rays.head
    late = np.flatnonzero(times > begin)
    if len(late) > 0 and end > begin:
        total[:, late] = rays.head_wave(times[late], load, _number(end - begin, latest, panels))
    for mark, following in pairwise(rays.marks(latest)):
        count = _number(following - mark, latest, panels)
        for low, high in pairwise(np.linspace(mark, following, count + 1)):
            whole, part = np.flatnonzero(times >= high), np.flatnonzero((low < times) & (times < high))
            for chosen, ends in ((whole, np.array([high])), (part, times[part])):
                if len(chosen) > 0:
                    tau = low + (ends - low) * ROOTS**2
                    force = load(np.maximum(times[chosen] - tau, 0.0))
                    kernel = np.broadcast_to(rays.kernel(tau) * (ends - low), (2, *force.shape))
                    total[:, chosen] += np.einsum("n,cnk,nk->ck", SLOPES, kernel, force)
    return total


def _number(width: float, latest: float, panels: int) -> int:
    """Number of panels for a part of time."""
    return max(panels // FEWEST_PANELS, math.ceil(panels * width / latest))
