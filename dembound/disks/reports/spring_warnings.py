"""Warnings about springs of sides that differ from the ground beyond: wrong source, or another modulus."""

import math
from collections.abc import Iterator

import numpy as np

from dembound.boundaries.viscoelastic import Springs
from dembound.disks.loads import forces_of
from dembound.disks.scene import DiskScene
from dembound.disks.side_media import media_of
from dembound.words import with_unit

UNLIKE = 2.0
"""Factor by which the springs' mean 1/L may differ from that of the nearest place where waves begin."""

FAR = 10.0
"""Distance of a given source, over the scene's diagonal, above which it is taken for a mistake, if no place where
waves begin is near it."""

OTHER_MODULUS = 10.0
"""Factor by which the springs' G may differ from that of the disks."""


def spring_warnings(scene: DiskScene) -> Iterator[str]:
    """Warnings about springs of sides, one line each."""
    places = places_of_sources(scene)
    for side in scene.edges:
        table = scene.case.side(side)
        if isinstance(table, Springs) and table.alpha_n == table.alpha_s == 0.0:
            yield f'boundary.{side}: alpha_n and alpha_s are 0, so it has no springs; type = "viscous" is the same'
        elif isinstance(table, Springs):
            yield from _wrong_source(scene, side, table, places)
            yield from _wrong_modulus(scene, side, table)


def places_of_sources(scene: DiskScene) -> dict[str, np.ndarray]:
    """Places where waves begin or are scattered, by table: the middle (2,) m of localised loads, and of holes."""
    places = {}
    for load in scene.case.load:
        if not load.is_everywhere:
            nodes, forces = forces_of(load, scene)
            weight = np.hypot(forces[:, 0], forces[:, 1])
            places[f"load.{load.name}"] = (weight @ scene.positions[nodes]) / weight.sum()
    for hole in scene.case.hole:
        x0, y0, x1, y1 = hole.box
        places[f"hole.{hole.name}"] = 0.5 * np.array([x0 + x1, y0 + y1])
    return places


def _wrong_source(scene: DiskScene, side: str, table: Springs, places: dict[str, np.ndarray]) -> Iterator[str]:
    """A warning about a source with which springs are far softer or stiffer than for the places where waves begin."""
    if table.source is None:
        times = (table.distance or 0.0) / math.hypot(*scene.size)
        if times > FAR:
            yield (
                f"boundary.{side}.distance: is {table.distance:g} m, {times:.3g} times the scene's diagonal; "
                "the springs hold nearly nothing; is it in m?"
            )
        return
    edge, where = scene.edges[side], f"boundary.{side}.source: is ({table.source[0]:g}, {table.source[1]:g}) m"
    own = np.mean(1.0 / np.hypot(*(edge.positions - np.array(table.source)).T))
    if not places:
        middle = 0.5 * (np.array(scene.case.packing.box[:2]) + np.array(scene.case.packing.box[2:]))
        away, diagonal = math.dist(table.source, middle), math.hypot(*scene.size)
        if away > FAR * diagonal:
            yield (
                f"{where}, {away:.4g} m from the middle of the scene, {away / diagonal:.3g} times its diagonal: the "
                "springs hold nearly nothing; is it in m?"
            )
        return
    ratios = {}
    for name, place in places.items():
        distances = np.maximum(np.hypot(*(edge.positions - place).T), 0.5 * edge.diameters)
        ratios[name] = own / float(np.mean(1.0 / distances))
    nearest = min(ratios, key=lambda name: abs(math.log(ratios[name])))
    if abs(math.log(ratios[nearest])) > math.log(UNLIKE):
        x, y = places[nearest]
        yield (
            f"{where}, but waves come from {nearest}, at ({x:.4g}, {y:.4g}) m; the springs are on average "
            f"{ratios[nearest]:.2g} times as stiff as for that place; give source = [{x:.4g}, {y:.4g}]"
        )


def _wrong_modulus(scene: DiskScene, side: str, table: Springs) -> Iterator[str]:
    """A warning about a given modulus of springs that differs from that of the disks, of layers from the nearest."""
    if table.young_modulus is None:
        return
    media = [medium for _, medium in media_of(scene, side) if medium.shear_modulus > 0.0]
    if not media:
        return
    nearest = {abs(math.log(table.shear_modulus(each) / each.shear_modulus)): each for each in media}
    medium = nearest[min(nearest)]
    ratio = table.shear_modulus(medium) / medium.shear_modulus
    if ratio > OTHER_MODULUS or ratio < 1.0 / OTHER_MODULUS:
        yield (
            f"boundary.{side}.young_modulus: gives springs of G = {with_unit(table.shear_modulus(medium), 'Pa')}, "
            f"{ratio:.2g} times that of the disks, {with_unit(medium.shear_modulus, 'Pa')}; is it in Pa? "
            "Without it that is taken"
        )
