"""The depth at which the free surface of the equivalent continuum lies below that of a packing.

Where a packing is cut, contacts are missing, so the disks at the surface are a soft skin, in which surface waves are
slower than in the continuum. A continuum whose surface lies deeper by the skin's depth δ has the packing's stiffness
along the surface; the mass ρδ of the skin then belongs on its surface. Stiffness and mass of a surface act on waves
that are long beside its thickness as those of a thin layer (Gurtin & Murdoch 1975, Arch. Rational Mech. Anal. 57,
291–323).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from dembound.continuum.edges import edge_lengths
from dembound.continuum.mesh import Mesh
from dembound.disks.material.homogenise import Network
from dembound.laws import Stiffness
from dembound.packings.brick import Brick
from dembound.packings.tiling import tile
from dembound.table import Box

SLENDER = 2.0
"""Least height of the strip over its width, so that its two surfaces do not interact: effects of a surface decay
with the depth y at least as exp(−2πy/width)."""

FAINT = 1e-9
"""Springs against single motions, see `Network.relaxed`: without bonds a disk at a surface may have one contact."""

LEAST_MASS = 0.5
"""Least mass of a node, over that of its medium, where a skin is stiff, of negative depth."""

TURNED = [1, 0, 3, 2]
"""The gradients xx, yy, xy, yx where x and y are exchanged."""


def skin_depths(brick: Brick, stiffness: Stiffness, tensor: np.ndarray, axis: int = 1) -> tuple[float, float]:
    """Depths δ (m) of a packing cut across x (axis 0), at left and right, or across y (1), at bottom and top.

    A strip of height H (along the axis) and one brick wide, periodic along its cut sides, is stretched along them by a
    unit mean strain while all else relaxes. A layer of the continuum with the same force N along the sides and the same
    moment M of this force about the strip's middle is thinner by δ_bottom + δ_top = H − N/E′ and lies higher by
    ½(δ_bottom − δ_top) = M/N, where E′ is the modulus along the sides without stress across them.

    stiffness : of the brick's contacts; tensor : (4, 4) Pa, its continuum's.

    Raises CaseError when the packing has no stiffness along the sides.
    """
    if axis == 0:
        brick, tensor = _turned(brick), tensor[np.ix_(TURNED, TURNED)]
    width, height = brick.size.tolist()
    strip = tile(brick, (1, int(np.ceil(SLENDER * width / height))), (True, False))
    network = Network.of_assembly(brick, stiffness, strip)
    stretched = network.gradient_matrix()[:, :1]
    elongations = stretched + network.motion_matrix() @ network.relaxed(stretched, faint=FAINT)
    force = network.springs * elongations[:, 0]
    normal = float(stretched[:, 0] @ force) / width
    moment = float(_curved(network, strip.positions, 0.5 * float(strip.size[1])) @ force) / width
    thinner, higher = float(strip.extent[1]) - normal / _along(tensor), moment / normal
    return 0.5 * thinner + higher, 0.5 * thinner - higher


def cut_at(brick: Brick, height: float) -> Brick:
    """The packing in bricks that end at a height (m) above the lower edge of one of its bricks.

    Disks centred on it are above. Its rows along y = 0 are rows inside of it.
    """
    lowered = brick.positions[:, 1] - height
    over = np.floor(lowered / brick.size[1]).astype(np.int64)
    positions, images, rows = brick.positions.copy(), brick.images.copy(), brick.edge_rows.copy()
    positions[:, 1] = lowered - over * brick.size[1]
    images[:, 1] += over[brick.pairs[:, 1]] - over[brick.pairs[:, 0]]
    rows[:, 1] = False
    return replace(brick, positions=positions, images=images, edge_rows=rows)


def inset(box: Box, skins: Mapping[str, float]) -> Box:
    """A box without the skins at some of its sides: side -> depth, m."""
    left, bottom, right, top = (skins.get(side, 0.0) for side in ("left", "bottom", "right", "top"))
    return box[0] + left, box[1] + bottom, box[2] - right, box[3] - top


def mass_of(skins: Mapping[str, float | np.ndarray], mesh: Mesh, density: float | np.ndarray) -> np.ndarray:
    """Mass ρδ (n,) kg of skins on the nodes of a mesh's outer edges.

    skins : side -> depth (m), uniform or per node (n,). density : kg/m³, uniform or per node. Where the skin is
    stiff, nodes keep half their mass; only elements smaller than some two diameters are that light.
    """
    added = sum((depth * density * edge_lengths(mesh, side) for side, depth in skins.items()), np.zeros(mesh.count))
    return np.maximum(added, (LEAST_MASS - 1.0) * density * mesh.areas)


def _curved(network: Network, positions: np.ndarray, middle: float) -> np.ndarray:
    """Elongations (3b,) per unit curvature of a beam, u_x = x(y − middle), u_y = −½x², θ = −x.

    Taken about the middle of each contact, as a rotation of both disks does not strain it.
    """
    c, s = network.directions
    dx, dy = network.vectors.T
    up = positions[network.pairs[:, 0], 1] + 0.5 * dy - middle
    arms = network.stiffness.arm_i - network.stiffness.arm_j
    return np.concatenate([c * dx * up, -s * dx * up - 0.5 * arms * dx, -dx])


def _along(tensor: np.ndarray) -> float:
    """Modulus (Pa) along x without stress across it, of a stiffness (4, 4): C11 less the relaxation of ε_yy and γ."""
    across = np.ix_([1, 2], [1, 2])
    coupling = tensor[0, [1, 2]]
    return float(tensor[0, 0] - coupling @ np.linalg.solve(tensor[across], coupling))


def _turned(brick: Brick) -> Brick:
    """The brick's mirror image in which x and y are exchanged; the constants of its contacts are the same."""
    columns = ("size", "positions", "images", "edge_rows")
    return replace(brick, **{name: getattr(brick, name)[..., ::-1] for name in columns}, stress=brick.stress[[1, 0, 2]])
