"""A pressure pulse in a bar, and where the bar spalls at its far end: d'Alembert's solution (L section 3.2).

Both ends reflect a wave, so the effect at x of a pulse p(t) on the end x = 0 is a sum over its passages there, the k-th
after a path of length w_k = kL + x or kL + L − x for even and odd k, of which only the first remains if the far end
absorbs. A wave to the right has the stress −p and the velocity p/(ρc), one to the left −p and −p/(ρc). A free end
reflects pressure as tension, a fixed one as pressure. Apart from its load the end x = 0 is free.

The place where a triangular pulse first reaches the strength σ_t = s p_m: behind the reflected crest, at a distance d
from the free end, the incident pulse has fallen by p_m·2d/(c t_f), which is the tension there. So a pulse whose fall is
not shorter than its rise, t_f ≥ t_r, breaks the bar when its crest is at

    d = ½ c t_f s,    t = t_r + (L + d)/c .

A pulse that falls faster gives more tension ahead of the reflected crest than behind it. At a time τ after its front,
once the tail of the incident pulse has passed, the tension is p_m τ/t_r. It first reaches the strength at τ = s t_r
behind the front, where

    d = ½ c (t_r + t_f − s t_r),    t = s t_r + (L + d)/c .
"""

from collections.abc import Callable, Iterator
from typing import Literal

import numpy as np

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
