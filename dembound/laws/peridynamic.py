"""The bond-based peridynamic law on a row of nodes (L section 1).

A node is bonded to every other one within the horizon δ = mΔx. Families are determined once, by index. A comparison of
distances as floats would lose the nodes at |ξ| = δ, and a comparison of current positions would lose them once the body
is stretched.
"""

from dataclasses import dataclass

import numpy as np

CRACKED = 0.3
"""Local damage from which on a node is cracked (L section 1.2)."""

ROUNDING = 1e-12
"""Tolerance in the comparison of damage: next to a crack it is often exactly 0.3."""


def micromodulus(youngs_modulus: float, horizon: float, section: float) -> float:
    """Stiffness c_m = 2E/(Aδ²) of bonds, force per volume squared and unit stretch, N/m⁶ (L eq. 4).

    Young's modulus E in Pa, horizon δ in m, section A in m².
    """
    return 2.0 / section * youngs_modulus / horizon**2


def volume_factor(apart: np.ndarray, horizon: int) -> np.ndarray:
    """Part of a node's volume that lies within the horizon of another one, by their distance in spacings (L eq. 9).

    1 below m = `horizon` spacings, ½ at m, 0 beyond.
    """
    return np.clip(horizon - apart + 0.5, 0.0, 1.0) * (apart <= horizon)


@dataclass(frozen=True)
class Family:
    """All bonds of a row of nodes, b of them, each listed once.

    pairs (b, 2) nodes, the first one left of the second; apart (b,) spacings between them; factor (b,) volume factor.
    """

    pairs: np.ndarray
    apart: np.ndarray
    factor: np.ndarray


def families(count: int, horizon: int) -> Family:
    """The bonds within `horizon` spacings in a row of `count` nodes, the shortest first."""
    lengths = range(1, min(horizon, count - 1) + 1)
    first = np.concatenate([np.arange(count - p) for p in lengths])
    apart = np.repeat(lengths, [count - p for p in lengths])
    return Family(np.stack([first, first + apart], axis=1), apart, volume_factor(apart, horizon))


def damage(pairs: np.ndarray, weight: np.ndarray, intact: np.ndarray, count: int) -> np.ndarray:
    """Local damage φ (count,) of nodes: the part of their family, by volume, that they have lost (L eq. 7).

    pairs (b, 2) nodes of each bond; weight (b, 2), the volume of the other node for each of them; intact (b,), or (b,
    2) where the two may differ.
    """
    whole = np.bincount(pairs.ravel(), weights=weight.ravel(), minlength=count)
    held = weight * intact.reshape(len(pairs), -1)
    left = np.bincount(pairs.ravel(), weights=held.ravel(), minlength=count)
    return 1.0 - np.divide(left, whole, out=np.ones(count), where=whole > 0.0)
