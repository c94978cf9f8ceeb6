"""Reflection of ends of bars: matched layers and dashpots, compared with an endless bar and at every wavelength."""

from functools import cache
from typing import Any

import numpy as np
from scenes import ROCK_SPEED, bar

from dembound.bar.scene import BarScene, build_bar
from dembound.formulas.bars.ends import returned
from dembound.motion.simulation import Simulation

CELLS, SPACING = 120, 5e-3
"""Spacings of the bar, and their length in m."""

VISCOUS = {"type": "viscous"}


def layer(nodes: int = 40, **keys: Any) -> dict[str, Any]:
    """The table of an end."""
    return {"type": "matched_layer", "nodes": nodes} | keys


def pushed(horizon: int, cells: int, end: dict[str, Any] | None, attenuation: float = 0.0) -> BarScene:
    """A bar under a cosine pulse 20 spacings long on its left end; horizon 1: finite differences."""
    method = {"type": "peridynamics", "horizon": horizon, "corrected_ends": True}
    return build_bar(
        bar(
            method if horizon > 1 else {"type": "finite_difference"},
            SPACING,
            bar={"length": cells * SPACING, "attenuation": attenuation},
            boundary={} if end is None else {"right": end},
            wave={"pulse": {"type": "cosine", "amplitude": 1.0, "period": 20 * SPACING / ROCK_SPEED}},
            load=[{"name": "hit", "pressure": 1e6, "wave": "pulse", "nodes": horizon}],
        )
    )


def sharp_echo(horizon: int, end: dict[str, Any], share: float, attenuation: float = 0.0) -> float:
    """Largest difference of velocity from an endless bar over its peak, while waves run five lengths.

    share : of the stability limit. At both ends and in the middle.
    """
    step, expected = _endless(horizon, share, attenuation)
    got = _motion(pushed(horizon, CELLS, end, attenuation), step)
    return float(np.abs(got - expected).max() / np.abs(expected).max())


@cache
def _endless(horizon: int, share: float, attenuation: float) -> tuple[float, np.ndarray]:
    """Time step (s), and the motion of a bar from whose end nothing has returned yet."""
    scene = pushed(horizon, 4 * CELLS, None, attenuation)
    step = share * scene.step_limit()
    return step, _motion(scene, step)


def _motion(scene: BarScene, step: float) -> np.ndarray:
    """Velocity (steps, 3) at the first node, and those in the middle and at the end of the short bar."""
    steps = int(5 * CELLS * SPACING / ROCK_SPEED / step)
    return Simulation(scene, step, [0, CELLS // 2, CELLS]).advance(steps)[:, :, 3]


def harmonic_echo(horizon: int, nodes: int, cells: float, share: float = 0.9) -> float:
    """Returned amplitude of a wave of c/(f Δx) spacings, from the equations of the layer."""
    scene = pushed(horizon, CELLS, layer(nodes))
    step = share * pushed(horizon, 4 * CELLS, None).step_limit()
    return returned(scene.layers["right"], ROCK_SPEED / (cells * SPACING), step)


def dashpot_echo(cells: float, courant: float = 0.9) -> float:
    """Reflection of a dashpot on half a node, finite differences: (ν sin θ − sin ωΔt)/(ν sin θ + sin ωΔt)."""
    angle = 2.0 * np.pi * courant / cells
    theta = 2.0 * np.arcsin(np.sin(0.5 * angle) / courant)
    out, taken = courant * np.sin(theta), np.sin(angle)
    return float(abs((out - taken) / (out + taken)))
