"""The depth at which the free surface of the equivalent continuum lies below that of a packing.

Where a packing is cut, contacts are missing, so the disks at the surface are a soft skin, in which surface waves are
slower than in the continuum. A continuum whose surface lies deeper by the skin's depth δ has the packing's stiffness
along the surface; the mass ρδ of the skin then belongs on its surface.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from dembound.disks.homogenise import Network
from dembound.laws import Stiffness
from dembound.packings.brick import Brick
from dembound.packings.tiling import tile

BRICKS = 2
"""Height of the strip in bricks: both its surfaces are then apart."""


class Skin(NamedTuple):
    """Depths (m) of the free surface of the equivalent continuum at the bottom and at the top of a packing."""

    bottom: float
    top: float


def skin_of(brick: Brick, stiffness: Stiffness, tensor: np.ndarray, bricks: int = BRICKS) -> Skin:
    """The skin of a packing that is cut along x, from a strip one brick wide that is periodic along x.

    The strip is stretched along x by a unit mean strain while all else relaxes. A layer of the continuum with the same
    force N and the same moment M of σ_xx about the strip's middle is thinner by δ_bottom + δ_top = H − N/E′ and lies
    higher by ½(δ_bottom − δ_top) = M/N, where E′ is the modulus along x without stress across it.

    stiffness : of the brick's contacts; tensor : (4, 4) Pa, its continuum's.
    """
    strip = tile(brick, (1, bricks), (True, False))
    network = Network.of_assembly(brick, stiffness, strip)
    stretched = network.gradient_matrix()[:, :1]
    elongations = stretched + network.motion_matrix() @ network.relaxed(stretched)
    force = network.springs * elongations[:, 0]
    height = float(strip.extent[1])
    middle = 0.5 * float(strip.size[1])
    normal = float(stretched[:, 0] @ force) / brick.size[0]
    moment = float(_curved(network, strip.positions, middle) @ force) / brick.size[0]
    thinner, higher = height - normal / _along(tensor), moment / normal
    return Skin(0.5 * thinner + higher, 0.5 * thinner - higher)


def _curved(network: Network, positions: np.ndarray, middle: float) -> np.ndarray:
    """Elongations (3b,) per unit curvature of a beam, u_x = x(y − middle), u_y = −½x², θ = −x.

    Those of a contact are taken about its own middle, as a rotation of both disks does not strain it.
    """
    c, s = network.directions
    dx, dy = network.vectors.T
    up = positions[network.pairs[:, 0], 1] + 0.5 * dy - middle
    arms = network.stiffness.arm_i - network.stiffness.arm_j
    return np.concatenate([c * dx * up, -s * dx * up - 0.5 * arms * dx, -dx])


def _along(tensor: np.ndarray) -> float:
    """Modulus (Pa) along x without stress across it, of a stiffness (4, 4): C11 less what relaxing ε_yy and γ takes."""
    across = np.ix_([1, 2], [1, 2])
    coupling = tensor[0, [1, 2]]
    return float(tensor[0, 0] - coupling @ np.linalg.solve(tensor[across], coupling))
