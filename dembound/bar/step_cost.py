"""The time of a step of a bar on one core, by what is stepped."""

from __future__ import annotations

from dembound.bar.scene import BarScene

STEP, BOND, LAYER_BOND = 250.0, 0.45, 6.0
"""Nanoseconds of a step in any case, of a spring or bond (benchmarks/bar_rate.py), and of a bond in a layer: 0.3 µs for
40 nodes (docs/evidence/bar_ends.md).
"""


def of_bar(scene: BarScene) -> float:
    """Nanoseconds of a step of a bar with its first bonds."""
    layers = sum(len(each.inner) * each.count for each in scene.layers.values())
    return STEP + BOND * scene.case.method.begin(scene.rod).alive + LAYER_BOND * layers
