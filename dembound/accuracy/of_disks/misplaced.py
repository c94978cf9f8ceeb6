"""Errors by disks at other places than asked for, from companions: at monitors, under loads, and held by sides.

To the first order they are the change of motion by one more row of larger disks at sides that stay.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

import numpy as np

from dembound.accuracy.of_disks.companions import QUANTITIES, Companions
from dembound.boundaries import SIDES, is_far, normal_axis
from dembound.casefile.disks import DiskCase
from dembound.disks.scene import DiskScene
from dembound.formulas.disks.entry import depths_held
from dembound.formulas.disks.places import places_of_loads

LEAST_SHIFT = 1e-6
"""Shift of a load, over the diameter of companions, from which on its way to surfaces counts."""


def errors_of_places(companions: Companions, scene: DiskScene) -> dict[str, dict[str, np.ndarray | float]]:
    """Error (k, 2) by monitors and loads that are not at the requested places, by monitor and quantity.

    Monitors and loads act at the nearest disks. Of several loads, of whose motion only the sum is known, the one
    with the largest error counts. A load at another place also has other distances from surfaces, from which its
    waves return earlier or later.
    """
    there, asked, loads = companions.places_of(scene), _asked(companions.case, scene), _shifts_of_loads(scene)
    own = companions.motion_at(companions.far, there)
    each = [_unmoved(companions, {name: there[name] + asked[name] + load for name in there}, load) for load in loads]
    return {
        name: {q: max((own[name][q] - other[name][q] for other in each), key=np.linalg.norm) for q in QUANTITIES}
        for name in own
    }


def _unmoved(
    companions: Companions, places: Mapping[str, np.ndarray], shift: np.ndarray
) -> dict[str, dict[str, np.ndarray]]:
    """Motion (k, 2) at places (2,) m, by monitor, before they and the loads were shifted relative to fixed sides.

    shift : (2,) m. To the first order, from the change by one more row of disks at these sides.
    """
    far, cell = companions.motion_at(companions.far, places), companions.lattice.ground.brick.mean_diameter
    found = {name: dict(own) for name, own in far.items()}
    for side in filter(partial(_stays, companions.case), SIDES):
        towards = float(shift[normal_axis(side)]) * (1.0 if is_far(side) else -1.0) / cell
        if abs(towards) < LEAST_SHIFT:
            continue
        away = companions.motion_at(companions.with_row_at(side), places)
        for name, own in far.items():
            for q, values in own.items():
                found[name][q] = found[name][q] + towards * (away[name][q] - values)
    return found


def errors_of_held_side(
    companions: Companions, scene: DiskScene, side: str
) -> dict[str, dict[str, np.ndarray | float]]:
    """Error (k, 2) of a side that holds disks at a depth s inside of its plane, by monitor and quantity.

    Companions are lattices, which hold disks of the diameter D' at D'/2. One more row of them puts these as far
    outside of the plane, so that the difference v(D'/2) - v(-D'/2) is the change over D' about the plane. Where
    motion along the side is free, mass begins at the plane and must stay there: a mirror plane holds the same
    components at the plane, and the difference is the change over D'/2. To the first order the error is s over that
    distance times the difference, with the mean s of P and S waves, of which motion is the sum: on a lattice D/2
    and 0.77 D at a fixed side.
    """
    places, table = companions.places_of(scene), companions.case.side(side)
    far, cell = companions.motion_at(companions.far, places), companions.lattice.ground.brick.mean_diameter
    depths = depths_held(scene, side).values()
    if {0, 1} & {*table.prescribed(normal_axis(side))} == {normal_axis(side)}:
        other, way = companions.with_mirror_at(side), 0.5 * cell
    else:
        other, way = companions.with_row_at(side), cell
    there = companions.motion_at(other, places)
    share = sum(depths) / (len(depths) * way)
    return {name: {q: share * (own[q] - there[name][q]) for q in QUANTITIES} for name, own in far.items()}


def is_moved(scene: DiskScene) -> bool:
    """Whether a monitor or a load that starts waves is at another place than the requested one, but for rounding."""
    shifts = [*_asked(scene.case, scene).values(), *_shifts_of_loads(scene)]
    return bool(np.abs(shifts).max() > LEAST_SHIFT * scene.ground.brick.mean_diameter)


def _asked(case: DiskCase, scene: DiskScene) -> dict[str, np.ndarray]:
    """By monitor, the way (2,) m from its disk in a scene to its place in the case that the scene stands for."""
    return {each.name: np.subtract(each.position, scene.monitored[each.name]) for each in case.monitor}


def _shifts_of_loads(scene: DiskScene) -> list[np.ndarray]:
    """The ways (2,) m from requested to real places of the loads that start waves; one of 0 without such loads."""
    return [each.middle - each.asked for each in places_of_loads(scene)] or [np.zeros(2)]


def _stays(case: DiskCase, side: str) -> bool:
    """Whether a side reflects and cannot move: a surface or the end of a block."""
    table = case.side(side)
    return not (table.is_artificial or table.is_periodic or table.waves)
