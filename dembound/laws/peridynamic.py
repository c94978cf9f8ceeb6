"""The bond-based peridynamic law on a grid of nodes, in one, two or three dimensions (L section 1).

A node is bonded to every other one within the horizon δ = mΔx. Families are determined once, by index offset. A
comparison of distances as floats would lose the nodes at |ξ| = δ, and a comparison of current positions would lose them
once the body is stretched.
"""

from dataclasses import dataclass

import numpy as np

CRACKED = 0.3
"""Local damage from which on a node is cracked (L section 1.2)."""

ROUNDING = 1e-12
"""Tolerance in the comparison of damage: next to a crack it is often exactly 0.3."""


def micromodulus(youngs_modulus: float, horizon: float, dimension: int, section: float = 1.0) -> float:
    """Stiffness c_m of the material's bonds, force per volume squared and unit stretch, N/m⁶ (L eq. 4).

    2E/(Aδ²) in a bar of section A (m²), 9E/(πδ³) in a plate of unit thickness (Poisson's ratio 1/3) and 12E/(πδ⁴) in
    space (1/4), with Young's modulus E in Pa and horizon δ in m.
    """
    factor = {1: 2.0 / section, 2: 9.0 / (np.pi * horizon), 3: 12.0 / (np.pi * horizon**2)}[dimension]
    return float(factor * youngs_modulus / horizon**2)


def volume_factor(distance: np.ndarray, spacing: float, horizon: float) -> np.ndarray:
    """Part of a node's volume that lies within the horizon of another one at this distance (L eq. 9), as distance.

    All lengths in m: 1 up to δ − Δx/2, then falling linearly to ½ at δ, 0 beyond.
    """
    part = np.clip((horizon - distance) / spacing + 0.5, 0.0, 1.0)
    return np.where(distance <= horizon * (1.0 + ROUNDING), part, 0.0)


@dataclass(frozen=True)
class Family:
    """All bonds of a grid of nodes, b of them, each listed once.

    pairs (b, 2) nodes; offset (b, d) index steps from the first to the second; factor (b,) volume factor.
    """

    pairs: np.ndarray
    offset: np.ndarray
    factor: np.ndarray


def families(shape: tuple[int, ...], horizon: int) -> Family:
    """The bonds within `horizon` spacings on a grid of this shape, its nodes numbered with the last axis fastest."""
    offsets = half_offsets(horizon, len(shape))
    nodes = np.arange(np.prod(shape)).reshape(shape)
    pairs, owners = [], []
    for offset in offsets:
        low = np.maximum(0, -offset)
        high = np.maximum(low, shape - np.maximum(0, offset))
        here, there = nodes[tuple(map(slice, low, high))], nodes[tuple(map(slice, low + offset, high + offset))]
        pairs.append(np.stack([here.ravel(), there.ravel()], axis=1))
        owners.append(np.broadcast_to(offset, (here.size, len(shape))))
    offset = np.concatenate(owners)
    factor = volume_factor(np.sqrt(np.sum(offset**2, axis=1)), 1.0, float(horizon))
    return Family(np.concatenate(pairs), offset, factor)


def half_offsets(horizon: int, dimension: int) -> np.ndarray:
    """Index steps (o, d) to half of a node's family, nearest first: of ξ and −ξ the later one in order."""
    steps = np.stack(np.meshgrid(*[np.arange(-horizon, horizon + 1)] * dimension, indexing="ij"), axis=-1)
    steps = steps.reshape(-1, dimension)
    length = np.sum(steps**2, axis=1)
    later = np.arange(len(steps)) > len(steps) // 2  # the middle one is the node itself
    chosen = later & (length <= horizon**2)
    return steps[chosen][np.argsort(length[chosen], kind="stable")]


def stretch(apart: np.ndarray, moved: np.ndarray) -> np.ndarray:
    """Stretch s (b,) of bonds (L eq. 5).

    apart (b, d) m from one node to the other in the reference configuration, ξ; moved (b, d) m, the difference of their
    displacements, η.
    """
    length = np.linalg.norm(apart, axis=1)
    return (np.linalg.norm(apart + moved, axis=1) - length) / length


def bond_forces(
    apart: np.ndarray, moved: np.ndarray, stiffness: np.ndarray | float, volumes: np.ndarray, intact: np.ndarray
) -> np.ndarray:
    """Forces (b, d) N on the first node of each bond (L eqs 3, 4 and 8); on the second they are the opposite.

    apart and moved (b, d) m as for `stretch`; stiffness c_m, a number or (b,); volumes (b,) m⁶, the product of the two
    nodes' volumes and the volume factor; intact (b,) bool, μ.
    """
    now = apart + moved
    direction = now / np.linalg.norm(now, axis=1)[:, None]
    return (stiffness * stretch(apart, moved) * volumes * intact)[:, None] * direction


def damage(pairs: np.ndarray, weight: np.ndarray, intact: np.ndarray, count: int) -> np.ndarray:
    """Local damage φ (count,) of nodes: the part of their family, by volume, that they have lost (L eq. 7).

    pairs (b, 2) nodes of each bond; weight (b, 2), the volume of the other node for each of them; intact (b,), or (b,
    2) where the two may differ.
    """
    whole = np.bincount(pairs.ravel(), weights=weight.ravel(), minlength=count)
    held = weight * intact.reshape(len(pairs), -1)
    left = np.bincount(pairs.ravel(), weights=held.ravel(), minlength=count)
    return 1.0 - np.divide(left, whole, out=np.ones(count), where=whole > 0.0)
