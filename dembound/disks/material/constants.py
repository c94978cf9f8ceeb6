"""Contact data for the history-dependent law: constants, and the limits of contacts and bonds."""

from collections.abc import Callable, Iterable, Sequence

import numpy as np

from dembound.casefile.disks.material import Material
from dembound.casefile.types import LAWS
from dembound.disks.material.layered import LayeredGround
from dembound.disks.material.packed_material import PackedMaterial
from dembound.kernels.contacts import BONDED, REFERENCE, UPDATED
from dembound.kernels.limits import in_columns
from dembound.kernels.tables import Limits


def strength_of(material: Material) -> Limits:
    """Strengths and friction of a material in the geometry of the start, whatever its law."""
    return Limits(
        friction=float(material.fric),
        tension=np.inf if material.pb_ten is None else material.pb_ten,
        cohesion=np.inf if material.pb_coh is None else material.pb_coh,
        tan_fa=float(np.tan(np.radians(material.pb_fa))) if material.pb_coh is not None else 0.0,
        geometry=REFERENCE,
    )


def limits_of(material: Material) -> Limits:
    """Limits of contacts under their law; infinite for bonds under a law that is not history-dependent."""
    strength = strength_of(material)
    if not LAWS[material.law].has_history:
        return strength._replace(tension=np.inf, cohesion=np.inf)
    return strength._replace(geometry={"updated": UPDATED, "reference": BONDED}[material.geometry])


def limits_between(
    pairings: Iterable[tuple[Material, Material]], types: int, of: Callable[[Material], Limits] = limits_of
) -> Limits:
    """Columns (p,) of the limits of contacts between two materials: `types` rows for each pairing, in their order.

    The smaller friction and tensile strength hold, and the line of shear strength with the smaller cohesion. of :
    `limits_of` or `strength_of`.
    """
    rows = [_weaker(of(one), of(other)) for one, other in pairings]
    return in_columns(np.repeat([row[:4] for row in rows], types, axis=0), rows[0].geometry)


def ground_limits(
    ground: PackedMaterial, materials: Sequence[Material], of: Callable[[Material], Limits] = limits_of
) -> Limits:
    """Limits of the contacts of a ground: numbers, in layered ground columns by their types, see `limits_between`.

    materials : of its layers from the surface down.
    """
    if not isinstance(ground, LayeredGround):
        return of(materials[0])
    own = [materials[zone.layer] for zone in ground.zones]
    pairings = [(own[one], own[other]) for one, other in ground.pairings]
    return limits_between(pairings, 2 * len(ground.brick.pairs), of)


def _weaker(one: Limits, other: Limits) -> Limits:
    """Limits of contacts between materials of two limits."""
    sheared = min(one, other, key=lambda each: (each.cohesion, each.tan_fa))
    least = {name: min(getattr(one, name), getattr(other, name)) for name in ("friction", "tension")}
    return sheared._replace(**least)


def brick_constants(ground: PackedMaterial, *, gaps_close: bool, locked_in: float) -> np.ndarray:
    """Constants (2b, 15) of the brick's contacts, followed by the same with half their stiffness, for half cells.

    For each pairing of zones in a layered ground. Arguments as for `pair_constants`.
    """
    brick = ground.brick
    first, second = brick.radii[brick.pairs].T
    found = []
    for pairing in ground.pairings:
        constants = ground.pair_constants(
            (first, second), brick.vectors, pairing, gaps_close=gaps_close, locked_in=locked_in
        )
        half = constants.copy()
        half[:, 5:10] *= 0.5  # stiffnesses
        half[:, 10:12] *= 2.0  # and areas and section moduli too, so that stresses do not change
        found += [constants, half]
    return np.vstack(found)


def shared_constants(constants: np.ndarray, zones: np.ndarray, length: float) -> tuple[np.ndarray, np.ndarray]:
    """Distinct rows (p, 15 or 19) of the constants of pairs, to rounding, and the row of each pair (b,).

    Pairs at the same place of different bricks then share a row, if they are in the same zones (b, 2) and have the same
    limits; length (m) is the scale for rounding errors.
    """
    places = np.column_stack([np.round(constants[:, :5] / (1e-6 * length)), zones, constants[:, 12:]])
    _, first, row_of = np.unique(places, axis=0, return_index=True, return_inverse=True)
    return constants[first], row_of.reshape(-1)
