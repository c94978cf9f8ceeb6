"""Lamb's problem: a line load on the surface of an elastic half-space, in plane strain (the problem of Z section 3.2).

x runs along the surface away from the load, z into the half-space. Solved by a Laplace transform in time and a
Fourier transform along the surface, inverted by deforming the path of the wave-number integral around the branch cut
(Cagniard's method). With a = 1/c_p, b = 1/c_s, η_a = √(a²−p²), η_b = √(b²−p²), Im η ≤ 0, and Rayleigh's function R =
(b²−2p²)² + 4p²η_aη_b, a unit impulse moves the surface at distance x > 0, at the time t = px > ax, by

    u_x = Im[p (b² − 2p² − 2η_aη_b) / R] / (πμx),    u_z = Im[b²η_a / R] / (πμx).

R has one root p_R = 1/c_R beyond b. In u_z it is a simple pole, whose principal value is taken; in u_x it gives a Dirac
impulse, as beyond b the fraction is real.

Below, slownesses p are in units of b, and κ = (a/b)² = (c_s/c_p)². R times its conjugate is a cubic in p²,

    Q = 1 − 8p² + 8(3−2κ)p⁴ − 16(1−κ)p⁶ = (p_R² − p²) D(p²),

so the root can be divided out exactly, without cancellation near it.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.polynomial import Polynomial

NODES, WEIGHTS = np.polynomial.legendre.leggauss(16)
FEWEST_PANELS = 4
MOST_PANELS = 2048
BLOCK = 16384
"""Number of values computed at once: few enough for the processor's cache, enough to make calls cheap."""

LoadFrom = Callable[..., np.ndarray]
"""Returns the load that acts with a slowness, at all times or at some."""


@dataclass(frozen=True)
class _Kernel:
    """Im[...] of the two fractions above, without the pole, as functions of the slowness p (units of 1/c_s)."""

    ratio: float
    """κ"""
    pole: float
    """p_R"""
    rest: Polynomial
    """D(p²)"""

    def vertical(self, p: np.ndarray | float) -> np.ndarray:
        """Im[η_a/R]·(p − p_R), same shape as p: smooth at p_R, square roots at √κ and 1."""
        w = np.square(p)
        alpha, beta = _root(w - self.ratio), _root(w - 1.0)
        return alpha * ((1.0 - 2.0 * w) ** 2 + 4.0 * w * alpha * beta) / ((p + self.pole) * self._divisor(w))

    def horizontal(self, p: np.ndarray) -> np.ndarray:
        """Im[p(1 − 2p² − 2η_aη_b)/R], same shape as p, without the impulse at p_R; zero from p = 1 on."""
        w = np.minimum(np.square(p), 1.0)
        roots = _root(w - self.ratio) * np.sqrt(1.0 - w)
        return 2.0 * p * roots * (1.0 - 2.0 * w) / ((self.pole**2 - w) * self._divisor(w))

    def horizontal_impulse(self) -> float:
        """Strength of the impulse of the horizontal fraction at p_R: −π times its residue there."""
        w = self.pole**2
        return float(-math.pi * (2.0 * w - 1.0) ** 3 / (2.0 * w * self._divisor(w)))

    def _divisor(self, w: np.ndarray | float) -> np.ndarray:
        """D(w), positive for w > κ; a lower bound keeps it positive, as for κ = ½ its root is κ."""
        return np.maximum(self.rest(w), 1e-15)


def rayleigh_speed(p_wave_speed: float, s_wave_speed: float) -> float:
    """Speed c_R of Rayleigh's surface wave, in the unit of the two wave speeds given.

    ξ = (c_R/c_s)² is the root of ξ³ − 8ξ² + 8(3−2κ)ξ − 16(1−κ), κ = (c_s/c_p)², in 0 < ξ < 1. It is the only root
    there: the cubic is concave, negative at 0 and equal to 1 at 1.

    Raises ValueError unless 0 < s_wave_speed < p_wave_speed.
    """
    from scipy.optimize import brentq

    if not 0.0 < s_wave_speed < p_wave_speed:
        raise ValueError(f"speeds must be 0 < S ({s_wave_speed} m/s) < P ({p_wave_speed} m/s)")
    ratio = (s_wave_speed / p_wave_speed) ** 2
    cubic = Polynomial([-16.0 * (1.0 - ratio), 8.0 * (3.0 - 2.0 * ratio), -8.0, 1.0])
    return s_wave_speed * math.sqrt(brentq(cubic, 0.0, 1.0, xtol=1e-15))


def surface_displacement(
    times: np.ndarray,
    distance: float,
    load: Callable[[np.ndarray], np.ndarray],
    density: float,
    p_wave_speed: float,
    s_wave_speed: float,
    tolerance: float = 1e-6,
) -> np.ndarray:
    """Displacement (2, k) of the surface (m) at the `times` (k,) (s), `distance` metres from a line load.

    Row 0 is horizontal, positive away from the load; row 1 vertical, positive into the half-space. `load` gives the
    force per metre of line (N/m), positive into the half-space, at an array of times t ≥ 0 of any shape; before t = 0
    there is none. It may start with a jump; u_z is then infinite at the arrival of the Rayleigh wave. Afterwards it
    must be continuous. Smoother loads take less time.

    The convolution with the impulse response above is done by quadrature whose panels are halved until the last
    halving changed the displacements by less than `tolerance` times the largest of them. The remaining error is
    smaller: every halving divides it by 4 if the load has kinks, by more if it has none.

    A model of disks differs in two ways: its receiver is the centre of a disk, half a diameter below the surface, where
    `buried_displacement` gives the motion, and its load acts on one or two disks instead of a line.

    Raises ValueError for a distance or density that is not positive and unless 0 < s_wave_speed < p_wave_speed;
    RuntimeError if the tolerance is not reached, for example with a load that jumps after its start.
    """
    if distance <= 0.0 or density <= 0.0:
        raise ValueError(f"distance ({distance} m) and density ({density} kg/m³) must be positive")
    kernel = _kernel(p_wave_speed, s_wave_speed)
    s_arrival = distance / s_wave_speed
    times = np.asarray(times, dtype=float)

    latest = times / s_arrival

    def load_from(p: np.ndarray | float, chosen: np.ndarray | slice = slice(None)) -> np.ndarray:
        """Load that acts with slowness p, a number, (n, 1) or (n, k'), at the k' times `chosen`."""
        return load(np.maximum(times[chosen] - p * s_arrival, 0.0))

    at_pole = np.where(latest > kernel.pole, load_from(kernel.pole), 0.0)
    whole = _converged(kernel, load_from, latest, at_pole, tolerance)
    return whole / (math.pi * density * s_wave_speed**2)


def _root(square: np.ndarray) -> np.ndarray:
    """√ where the square is positive, else 0."""
    return np.sqrt(np.maximum(square, 0.0))


def _kernel(p_wave_speed: float, s_wave_speed: float) -> _Kernel:
    """The kernel of a half-space with these wave speeds."""
    ratio = (s_wave_speed / p_wave_speed) ** 2
    pole = s_wave_speed / rayleigh_speed(p_wave_speed, s_wave_speed)
    cubic = Polynomial([1.0, -8.0, 8.0 * (3.0 - 2.0 * ratio), -16.0 * (1.0 - ratio)])
    return _Kernel(ratio, pole, cubic // Polynomial([pole**2, -1.0]))


def _converged(
    kernel: _Kernel, load_from: LoadFrom, latest: np.ndarray, at_pole: np.ndarray, tolerance: float
) -> np.ndarray:
    """∫ load · kernel dp (2, k) up to the slownesses `latest` (k,), quadrature refined to the tolerance.

    The vertical integrand is load·vertical/(p − p_R). Its numerator's value at p_R is subtracted, which removes the
    singularity; the principal value of the subtracted part is a logarithm.
    """
    residue = at_pole * kernel.vertical(kernel.pole)
    beyond = np.where(latest > kernel.pole, latest - kernel.pole, 1.0)
    logarithm = np.log(beyond / (kernel.pole - math.sqrt(kernel.ratio)))
    rayleigh = np.stack([kernel.horizontal_impulse() * at_pole, residue * logarithm])

    def integral(panels: int) -> np.ndarray:
        return rayleigh + _integral(kernel, load_from, latest, residue, panels)

    return refined(integral, (FEWEST_PANELS, MOST_PANELS), tolerance, "Lamb's integral", "load")


def refined(
    integral: Callable[[int], np.ndarray], panels: tuple[int, int], tolerance: float, name: str, of: str
) -> np.ndarray:
    """An integral with so many panels that the last halving of them has changed it by less than the tolerance.

    integral : it, with a number of panels. panels : the least and the largest number. tolerance : over its largest
    value. name, of : the integral and its history, in words. Raises RuntimeError if the tolerance is not reached.
    """
    number, most = panels
    change, finer = math.inf, integral(number)
    while change > tolerance * np.abs(finer).max(initial=0.0):
        if number == most:
            raise RuntimeError(f"{name} did not converge to {tolerance:g}: is the {of} continuous?")
        number *= 2
        coarser, finer = finer, integral(number)
        change = np.abs(finer - coarser).max(initial=0.0)
    return finer


def _integral(kernel: _Kernel, load_from: LoadFrom, latest: np.ndarray, residue: np.ndarray, panels: int) -> np.ndarray:
    """The regular part of the integral (2, k), with a number of Gauss panels on each of its pieces.

    The pieces end at P, S and Rayleigh arrival. p = low + width·sin²(πv/2), 0 < v < 1, removes the square roots at
    their ends. It also concentrates nodes near p_R, so that the quotient there keeps its digits.
    """
    total = np.zeros((2, len(latest)))
    marks = (math.sqrt(kernel.ratio), 1.0, kernel.pole, math.inf)
    for low, high in pairwise(marks):
        whole, part = np.flatnonzero(latest >= high), np.flatnonzero((low < latest) & (latest < high))
        if len(whole) > 0:  # one width for all, so the kernel is computed once
            total[:, whole] += _piece(kernel, load_from, whole, residue, low, np.array([high - low]), panels)
        if len(part) > 0:
            total[:, part] += _piece(kernel, load_from, part, residue, low, latest[part] - low, panels)
    return total


def _piece(
    kernel: _Kernel,
    load_from: LoadFrom,
    chosen: np.ndarray,
    residue: np.ndarray,
    low: float,
    width: np.ndarray,
    panels: int,
) -> np.ndarray:
    """The part (2, k') of the integral from slowness `low` on, over widths (k',) or (1,), for times `chosen` (k',)."""
    nodes = ((np.arange(panels)[:, None] + 0.5 + 0.5 * NODES) / panels).ravel()
    slopes = np.tile(WEIGHTS, panels) / (2 * panels) * 0.5 * math.pi * np.sin(math.pi * nodes)
    total = np.zeros((2, len(chosen)))
    many = max(1, BLOCK // len(chosen))
    for begin in range(0, len(nodes), many):
        v, slope = nodes[begin : begin + many, None], slopes[begin : begin + many]
        p = low + width * np.sin(0.5 * math.pi * v) ** 2
        load = load_from(p, chosen)
        regular = load * kernel.vertical(p) - residue[chosen]
        away = p - kernel.pole
        total[1] += slope @ np.divide(regular, away, out=np.zeros_like(regular), where=away != 0.0)
        if low < 1.0:
            total[0] += slope @ (load * kernel.horizontal(p))
    return width * total
