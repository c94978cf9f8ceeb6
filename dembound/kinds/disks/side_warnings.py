"""Warnings about sides that represent the ground beyond them poorly, or carry part of a load, and about springs."""

import math
from collections.abc import Collection, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from dembound.boundaries.description import TOO_MUCH, poor_factor, reflected, too_much
from dembound.boundaries.edge import Edge, Motion, is_far, normal_axis
from dembound.boundaries.viscoelastic import Springs
from dembound.casefile.disks.load import Load
from dembound.casefile.disks.model import DiskCase
from dembound.disks.matching import Held, factors_in, homogenised_beta
from dembound.disks.material.constants import continues
from dembound.disks.scene import DiskScene
from dembound.disks.sides import layers_beside, media_of
from dembound.disks.supports import forces_of
from dembound.disks.surroundings.frequencies import mean_frequency
from dembound.formulas.disks.beside_wave import taken_from_waves
from dembound.formulas.disks.reflections import sent_back
from dembound.words import percent, with_unit

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
    for hole in scene.case.holes:
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


def side_warnings(scene: DiskScene) -> Iterator[str]:
    """Warnings about sides, one line each."""
    yield from _send_back(scene)
    yield from _take_from_waves(scene)
    yield from _hold_monitors(scene)
    yield from _mirror_otherwise(scene)
    yield from _hold_round_faces(scene)


ROUND = 0.5
"""How much deeper, in diameters, the outer disks of a held side are than those in its middle, on an average, where its
face counts as round: at most 0.4 on flat faces of random packings 20 diameters wide, 0.7 to 1.4 on round samples 14 to
60 wide.
"""

FEWEST = 8
"""Number of held disks below which their depths say nothing about the face."""

TAKEN = 0.1
"""Error, over a wave's velocity, by sides along it up to which there is no warning; known to within that."""


class _Poor(NamedTuple):
    """Why a side sends back much: a factor β, where a wave of this name may enter, or else its springs or its disks."""

    beta: float | None = None
    wave: str | None = None
    springs: bool = False


def _send_back(scene: DiskScene) -> Iterator[str]:
    """Warnings about dashpots and springs that reflect much of plane waves along the side's normal.

    Sides that do so for the same reason share a line.
    """
    tables = {side: scene.case.side(side) for side in scene.edges}
    sides = [side for side, table in tables.items() if table.factors and not table.is_interface]
    frequency = mean_frequency(scene.case) if sides else math.nan
    alike: dict[tuple[_Poor, tuple[Motion, ...]], dict[tuple[str, int], list[float]]] = {}
    for side, part in ((each, part) for each in sides for part in range(len(media_of(scene, each)))):
        found: dict[_Poor, dict[Motion, float]] = {}
        for motion, beta in factors_in(scene, side, part).items():
            share = sent_back(scene, side, motion, frequency, part)
            if share > TOO_MUCH:  # nan where the motion is held
                found.setdefault(_reason(scene, side, motion, beta, part), {})[motion] = share
        for poor, own in found.items():
            alike.setdefault((poor, tuple(own)), {})[side, part] = list(own.values())
    for (poor, motions), by_part in alike.items():
        names, count = _parts_in_words(scene, by_part), len({side for side, _ in by_part})
        shares = [share for each in by_part.values() for share in each]
        if poor.beta is None:
            yield f"{names}: {too_much(motions, shares, count)} {_cause(poor, count, frequency)}"
            continue
        matched = [homogenised_beta(scene, side, motion, part) for side, part in by_part for motion in motions]
        yield f"{names}: {poor_factor(motions, shares, poor.beta, matched, poor.wave, count)}"


def _parts_in_words(scene: DiskScene, parts: Collection[tuple[str, int]]) -> str:
    """The keys of sides, each with the layers beside those of its parts that are meant if others are not."""
    found = []
    for side in dict.fromkeys(side for side, _ in parts):
        layers = layers_beside(scene, side)
        meant = [layers[part] for each, part in parts if each == side]
        own = scene.case.beside("right" if side == "right" else "left").layer_names
        names = [own[number] for number in meant] if len(meant) < len(layers) else []
        found.append(f"boundary.{side}" + (f" (beside {' and '.join(names)})" if names else ""))
    return " and ".join(found)


def _reason(scene: DiskScene, side: str, motion: Motion, beta: float, part: int) -> _Poor:
    """The cause of the reflection of a part of a side: its factor, or else its springs or disks."""
    if abs(reflected(beta, homogenised_beta(scene, side, motion, part))) > TOO_MUCH:
        return _Poor(beta, scene.case.side(side).waves.get(motion))
    return _Poor(springs=bool(Held.of(scene, side, part).stiffness.any()))


def _cause(poor: _Poor, sides: int, frequency: float) -> str:
    """The end of a warning about springs, or about disks."""
    why = (
        'springs hold; take springs of a larger distance, or "outside"'
        if poor.springs
        else "disks are whole cells, large beside such waves; take smaller ones, or half_mass on regular sides"
    )
    return f"at their mean frequency, {frequency:.3g} Hz, as {'its' if sides == 1 else 'their'} {why}"


def _take_from_waves(scene: DiskScene) -> Iterator[str]:
    """Warnings about sides along the wave of a driven side that do not move as ground beyond them would."""
    for found in taken_from_waves(scene):
        place, most = max(found.shares.items(), key=lambda each: each[1])
        if most <= TAKEN:
            continue
        least = f", {100.0 * min(found.shares.values()):.0f} % where least" if len(found.shares) > 1 else ""
        sides = " and ".join(f"boundary.{side}" for side in found.sides)
        cure = _moves_with_waves(scene.case, found.driven)
        yield (
            f"{sides}: along wave {' and '.join(found.waves)} from {found.driven} no side moves as ground beyond it "
            f"would; at {place} about {100.0 * most:.0f} % of the velocity is wrong{least} (RMS); take {cure}"
        )


def _moves_with_waves(case: DiskCase, driven: str) -> str:
    """Sides along the waves of a driven side that move with them, in words."""
    if normal_axis(driven) == 0:
        return '"periodic"'
    return f'"free_field", or "outside" there and at {driven}'


def _hold_monitors(scene: DiskScene) -> Iterator[str]:
    """Warnings about sides that hold the disk of a monitor, so that it records no motion."""
    for side, edge in scene.edges.items():
        table = scene.case.side(side)
        if table.waves or not {0, 1} <= {*table.prescribed(edge.axis), *scene.ground.held}:
            continue
        for name, particle in scene.monitors.items():
            if particle in edge.nodes:
                yield f"monitor.{name}: its disk is on boundary.{side}, which holds it still: its motion is zero"


def _hold_round_faces(scene: DiskScene) -> Iterator[str]:
    """Warnings about flat sides that hold disks of a round sample, which then is too strong."""
    for side, edge in scene.edges.items() if scene.case.holes else ():
        table = scene.case.side(side)
        part = table.part_of(edge)
        if edge.axis not in table.prescribed(edge.axis) or len(part.nodes) < FEWEST:
            continue
        depth, along = depths_of(part), part.positions[:, 1 - edge.axis]
        away = np.abs(along - 0.5 * (along.min() + along.max()))
        outer = away > 0.5 * away.max()
        if depth[outer].mean() - depth[~outer].mean() > ROUND * scene.ground.brick.mean_diameter:
            yield (
                f"boundary.{side}: is flat, but holds {len(depth)} disks of a round face, from {along.min():.4g} to "
                f"{along.max():.4g} m, up to {depth.max():.2g} m below its plane: such a grip makes a sample too "
                "strong, a Brazilian disk twice; give the width of the jaw, within = [from, to]"
            )


def depths_of(edge: Edge) -> np.ndarray:
    """Depths (k,) m of the faces of an edge's disks below the outermost of them."""
    outward = (1.0 if is_far(edge.side) else -1.0) * edge.positions[:, edge.axis] + 0.5 * edge.diameters
    depth: np.ndarray = outward.max() - outward
    return depth


def _mirror_otherwise(scene: DiskScene) -> Iterator[str]:
    """Warnings about planes of symmetry across which a lattice does not continue as its own mirror image."""
    packing, brick = scene.case.packing, scene.ground.brick
    for side, edge in scene.edges.items():
        mirrored = scene.case.side(side).is_mirror and packing.is_lattice
        if mirrored and not continues(brick, edge.axis, edge.diameters):
            yield (
                f"boundary.{side}: the disks of pattern {packing.pattern} have no neighbours straight across this side "
                "and touch their mirror images: near there the body is not half of a larger one of this lattice"
            )


HELD = 0.1
"""Share of a load that disks of held sides may have without a warning: a region often reaches such a side."""

ONE_WAY = 0.5
"""Share of the sizes of all steady forces that their resultant must exceed to pull the whole body one way."""


def load_warnings(scene: DiskScene) -> Iterator[str]:
    """Warnings about loads, one line each."""
    yield from _twice(scene.case.load)
    yield from _hung(scene)
    yield from _not_borne(scene)
    for load in scene.case.load:
        if load.force is None:
            continue
        nodes, forces = forces_of(load, scene)
        for edge in scene.edges.values():
            on_side = np.isin(nodes, edge.nodes)
            if on_side.any():
                yield from (f"load.{load.name}: {words}" for words in _at_side(scene, load, edge, forces, on_side))


def _hung(scene: DiskScene) -> Iterator[str]:
    """Warnings about bodies that steady loads pull towards a free side, held at the opposite one, all in tension."""
    static = scene.case.static
    if static is None or static.stress is not None:
        return
    before = scene if scene.before is None else scene.before
    for axis, (low, high) in enumerate((("left", "right"), ("bottom", "top"))):
        forces = before.steady_load[axis]
        if axis in scene.ground.held or abs(forces.sum()) <= ONE_WAY * np.abs(forces).sum():
            continue
        towards, held = (high, low) if forces.sum() > 0.0 else (low, high)
        if any(scene.case.side(side).is_periodic or scene.case.side(side).is_outside for side in (low, high)):
            continue
        table = static.boundary.get(held)
        if towards not in static.boundary and table is not None and axis in table.prescribed(axis):
            yield (
                f"static: the steady loads pull the body along {'xy'[axis]} towards its {towards}, which is free in "
                f"the static stage, and static.boundary.{held} holds it: it hangs, all in tension; give "
                f"static.boundary.{towards} where it is to rest on it"
            )


def _not_borne(scene: DiskScene) -> Iterator[str]:
    """A warning about a stress at rest that contacts cannot bear by friction."""
    if scene.at_rest is not None and not scene.at_rest.is_borne:
        key = "static.stress" if scene.case.static is not None and scene.case.static.k0 is None else "static.k0"
        yield (
            f"{key}: contacts and bonds of the packing cannot bear the stress at rest without sliding further and "
            "further; the static stage loses a part of it, or does not end: give more friction (fric), bonds, or a "
            "smaller difference of the principal stresses"
        )


def _at_side(scene: DiskScene, load: Load, edge: Edge, forces: np.ndarray, on_side: np.ndarray) -> Iterator[str]:
    """Effect of a side on a load with forces (k, 3), of which some (k,) are on the side's disks, in words."""
    table, side = scene.case.side(edge.side), edge.side
    prescribed = [axis for axis in load.axes if axis in table.prescribed(edge.axis)]
    if table.factors and on_side.all():
        yield (
            f"acts on disks of boundary.{side} alone, whose dashpots take a part of it: of a plane wave about half "
            "enters; put it on disks away from that side"
        )
    elif prescribed and (share := abs(forces[on_side, prescribed[0]].sum() / forces[:, prescribed[0]].sum())) > HELD:
        yield (
            f"has {percent(share, 3)} of its force along {'xy'[prescribed[0]]} on disks of boundary.{side}, which "
            "prescribes their motion, so that this part moves nothing"
        )


def _twice(loads: Sequence[Load]) -> Iterator[str]:
    """Warnings about loads that equal an earlier one except for their name."""
    seen: dict[str, str] = {}
    for load in loads:
        same = repr(load.model_copy(update={"name": ""}))
        if same in seen:
            yield f"load.{load.name}: is the same as load.{seen[same]}, so that it acts twice"
        seen.setdefault(same, load.name)
