"""Contact data for the history-dependent law: lines of the palette, and the limits of contacts and bonds."""

import numpy as np

from dembound.casefile.disks.material import Material
from dembound.casefile.types import LAWS
from dembound.disks.packed_material import PackedMaterial
from dembound.kernels.contacts import BONDED, REFERENCE, UPDATED
from dembound.kernels.tables import Limits


def limits_of(material: Material) -> Limits:
    """Strengths and friction of a material; without limits for a law without history."""
    unbreakable = not LAWS[material.law].has_history
    return Limits(
        friction=float(material.fric),
        tension=np.inf if unbreakable or material.pb_ten is None else material.pb_ten,
        cohesion=np.inf if unbreakable or material.pb_coh is None else material.pb_coh,
        tan_fa=float(np.tan(np.radians(material.pb_fa))) if material.pb_coh is not None else 0.0,
        geometry=REFERENCE if unbreakable else {"updated": UPDATED, "reference": BONDED}[material.geometry],
    )


def brick_lines(ground: PackedMaterial, *, gaps_close: bool, locked_in: float) -> np.ndarray:
    """Palette lines (2b, 12) of the brick's contacts, then the same with half their stiffness, for half cells.

    Arguments as for `pair_lines`.
    """
    brick = ground.brick
    first, second = brick.radii[brick.pairs].T
    lines = ground.law.pair_lines(
        ground.moduli,
        first,
        second,
        brick.vectors,
        bonded=ground.moduli.pb_emod > 0.0,
        gaps_close=gaps_close,
        locked_in=locked_in,
    )
    half = lines.copy()
    half[:, 5:10] *= 0.5  # stiffnesses
    half[:, 10:] *= 2.0  # and areas and section moduli too, so that stresses do not change
    return np.vstack([lines, half])


def shared_lines(lines: np.ndarray, length: float) -> tuple[np.ndarray, np.ndarray]:
    """Palette lines (p, 12) of pairs, equal ones (to rounding) only once, and the line of each pair (b,).

    Pairs at the same place of different bricks then share a line; length (m) is the scale for rounding errors.
    """
    places = np.round(lines[:, :5] / (1e-6 * length))
    _, first, line_of = np.unique(places, axis=0, return_index=True, return_inverse=True)
    return lines[first], line_of.reshape(-1)
