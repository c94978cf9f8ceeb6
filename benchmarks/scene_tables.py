"""Tables of case files of which the scenes of benchmarks are made: materials, packings, waves, loads, sides."""

from typing import Any

Tables = dict[str, Any]

ROCK: Tables = {"density": 2500.0, "p_wave_speed": 1000.0}
ISOTROPIC: Tables = ROCK | {"fric": 0.5}
SIDES = ("left", "right", "bottom", "top")
VISCOUS: Tables = {"type": "viscous", "beta_p": 1.0, "beta_s": 1.0}


def lattice(wide: float, high: float, diameter: float) -> Tables:
    """Pattern A."""
    return {"pattern": "A", "size": [wide, high], "radius": 0.5 * diameter}


def grains(wide: float, high: float, diameter: float, brick: float, seed: int = 1, pattern: str = "B") -> Tables:
    """Pattern B or C of square bricks (m)."""
    edge = {"edge_radius": 0.52 * diameter} if pattern == "C" else {}
    return lattice(wide, high, diameter) | {
        "pattern": pattern, "radius_ratio": 1.5, "brick": [brick, brick], "seed": seed, **edge,
    }  # fmt: skip


def pulse(period: float, amplitude: float = 0.5, kind: str = "cosine") -> Tables:
    """The wave "pulse"."""
    return {"pulse": {"type": kind, "amplitude": amplitude, "period": period}}


def monitors(**places: tuple[float, float]) -> list[Tables]:
    """Monitors at places, m."""
    return [{"name": name, "position": list(place)} for name, place in places.items()]


def point(force: tuple[float, float], place: tuple[float, float], name: str = "hammer") -> Tables:
    """A force on a disk."""
    return {"name": name, "force": list(force), "position": list(place), "wave": "pulse"}


def viscoelastic(source: tuple[float, float], normal: float = 1.0, across: float = 0.5) -> Tables:
    """A viscoelastic side."""
    return VISCOUS | {"type": "viscoelastic", "alpha_n": normal, "alpha_s": across, "source": list(source)}
