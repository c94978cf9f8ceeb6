"""A pressure pulse in a bar, where the bar spalls, and the first longitudinal mode of a round bar."""

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
