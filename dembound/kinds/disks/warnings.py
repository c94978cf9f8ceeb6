"""Warnings about probable mistakes in a case of disks, before the run."""

import math
from collections.abc import Callable, Iterator

import numpy as np

from dembound.boundaries import SIDES, normal_axis
from dembound.casefile.disks.load import Load
from dembound.casefile.disks.stiffness import MODULI_KEYS
from dembound.casefile.unlikely import unlikely_in
from dembound.disks.scene import DiskScene
from dembound.kinds.disks.continuum_facts import continuum_warnings
from dembound.kinds.disks.facts import intact_warnings
from dembound.kinds.disks.groups import group_warnings
from dembound.kinds.disks.micro_macro import Own, materials_of
from dembound.kinds.disks.side_warnings import load_warnings, side_warnings, spring_warnings
from dembound.kinds.disks.slopes import slope_warnings
from dembound.kinds.disks.walls import wall_warnings
from dembound.kinds.disks.wave_warnings import wave_warnings
from dembound.meanings import MEANINGS
from dembound.words import percent, with_unit

LARGEST_PULL = 3.5
"""Largest tensile stress of a bond over the mean one, where contacts under a locked-in stress relax.

The mean is the bonds' share of the stiffness times the locked-in pressure; the largest of 1,900 bonds was 2.8 to 3.5
times that (three bricks, radius ratio 1.5).
"""

UNLIKE_STRENGTHS = 100.0
"""Factor between the strengths of bonds in tension and shear above which one is taken for a mistake."""

SPEED_ERROR = 0.1
"""Share by which the P-wave speed of the packing may differ from the given one without a warning."""

GIVES_WAY = 6.0
"""By how much the wall of a hole moves too far in a body that only forces hold, over (hole / body)² of their widths.

The second harmonic of holes in the middle: 7.6, 6.4, 5.7, 5.2 for bodies 3, 4, 6, 8 times as wide; the mean less.
"""

TOO_FAR = 0.05
"""Share by which the wall of a hole may move too far without a warning."""


def disk_warnings(scene: DiskScene, time_step: float) -> list[str]:
    """Warnings about a scene of disks, one line each; time_step in s."""
    return [
        *_empty_holes(scene),
        *_holes_at_periodic_sides(scene),
        *_holes_between_forces(scene),
        *_excavated_stiffly(scene),
        *_of_each_layer(scene, _unlike_strengths),
        *_steady_without_static(scene),
        *_hangs(scene),
        *_of_each_layer(scene, _locked_in),
        *_of_each_layer(scene, _settles_in_tension),
        *wave_warnings(scene, time_step),
        *side_warnings(scene),
        *slope_warnings(scene),
        *wall_warnings(scene),
        *group_warnings(scene),
        *intact_warnings(scene),
        *spring_warnings(scene),
        *load_warnings(scene),
        *_of_each_layer(scene, _speed_of_the_packing),
        *_of_each_layer(scene, _s_speed_of_the_packing),
        *_of_each_layer(scene, _uneven_speed),
        *_of_each_layer(scene, _unlikely_speed),
        *continuum_warnings(scene, scene.case.run.duration / time_step),
    ]


def _of_each_layer(scene: DiskScene, warn: Callable[[DiskScene, Own], Iterator[str]]) -> Iterator[str]:
    """Warnings about the material of each layer, or of uniform ground; those of keys for several layers once."""
    yield from dict.fromkeys(line for own in materials_of(scene) for line in warn(scene, own))


def _empty_holes(scene: DiskScene) -> Iterator[str]:
    """Holes that remove no disk, as none of the packing is centred in them, or others have removed all of them."""
    brick, (left, bottom, right, top) = scene.ground.brick, scene.case.packing.box
    origin, span = np.array([left, bottom]), scene.case.packing.span
    for number, (place, hole) in enumerate(scene.case.named_holes):
        if hole.is_shape:
            continue
        x0, y0, x1, y1 = hole.box
        low, high = np.array([max(x0, left), max(y0, bottom)]), np.array([min(x1, right), min(y1, top)])
        first, last = np.floor((low - origin) / brick.size), np.floor((high - origin) / brick.size)
        last = np.minimum(last, np.array(scene.case.packing.copies) - (not brick.edge_rows.any()))
        across, up = (np.arange(begin, end + 1.0) for begin, end in zip(first, last, strict=True))
        tiles = np.stack(np.meshgrid(across, up), axis=-1).reshape(-1, 1, 2)
        places = (origin + tiles * brick.size + brick.positions).reshape(-1, 2)
        inside = places[hole.takes(places, span)]
        if len(inside) == 0:
            yield f"{place}: no particle is centred in it, so it removes none"
        for other in scene.case.holes[:number]:
            if len(inside) and other.takes(inside, span).all() and (other.stage == "before" or hole.stage == "after"):
                yield f"{place}: lies within hole.{other.name}, so it removes no more particles"


def _unlike_strengths(scene: DiskScene, own: Own) -> Iterator[str]:
    """Strengths of bonds in tension and in shear that differ by more than `UNLIKE_STRENGTHS`."""
    tension, shear = own.material.pb_ten, own.material.pb_coh
    if tension is not None and shear is not None and not 1.0 / UNLIKE_STRENGTHS <= shear / tension <= UNLIKE_STRENGTHS:
        yield (
            f"{own.key('pb_coh')}: is {shear / tension:.3g} times {own.key('pb_ten')}, more than a factor of "
            f"{UNLIKE_STRENGTHS:g} apart; are both in Pa?"
        )


def _holes_at_periodic_sides(scene: DiskScene) -> Iterator[str]:
    """Holes that a periodic side cuts: the part beyond it does not come in again at the opposite side."""
    left, bottom, right, top = scene.case.packing.box
    for place, hole in scene.case.named_holes:
        x0, y0, x1, y1 = hole.box
        cut = {"left": x0 < left < x1, "right": x0 < right < x1, "bottom": y0 < bottom < y1, "top": y0 < top < y1}
        for side in (side for side in SIDES if cut[side] and scene.case.side(side).is_periodic):
            yield (
                f"{place}: is cut by the periodic {side} side, and the part beyond it is not removed at the opposite "
                "side; move it, or give that part as a hole of its own"
            )


def _holes_between_forces(scene: DiskScene) -> Iterator[str]:
    """Holes excavated where no support or continuum at left or right carries what they set free."""
    static, case, box = scene.case.static, scene.case, scene.case.packing.box
    sides = [side for side in ("left", "right") if side in scene.edges and not case.side(side).is_outside]
    if static is None or len(sides) < 2:
        return
    if any(table is not None and side in sides and 0 in table.prescribed(0) for side, table in static.boundary.items()):
        return
    for place, hole in case.named_holes:
        x0, y0, x1, y1 = hole.box
        inside = box[0] < x0 and x1 < box[2] and box[1] < y0 and y1 < box[3]
        more = GIVES_WAY * (max(x1 - x0, y1 - y0) / min(box[2] - box[0], box[3] - box[1])) ** 2
        if hole.stage == "after" and inside and more > TOO_FAR:
            yield (
                f"{place}: is excavated in a body that only forces hold at left and right, and its wall will move "
                f'about {percent(more)} too far; take "outside" sides, a larger body, or hold left and right in '
                "[static.boundary]"
            )


def _excavated_stiffly(scene: DiskScene) -> Iterator[str]:
    """Holes excavated from damped ground, whose springs are stiffer than its wave speeds say."""
    stiffer = max((each.unrelaxed for each in scene.ground.mechanisms_by_layer if each is not None), default=1.0)
    if scene.before is not None and stiffer > 1.0 and not scene.ground.relaxes:
        yield (
            f"static: holes are excavated from damped ground with its unrelaxed stiffness, {stiffer:.4g} times that of "
            f"the wave speeds, so that it moves {percent(1.0 - 1.0 / stiffer)} less; for its settlement settle the "
            "ground without quality_factor"
        )


def _steady_without_static(scene: DiskScene) -> Iterator[str]:
    """Steady loads that act suddenly, as there is no static stage."""
    if scene.case.static is not None:
        return
    for load in scene.case.load:
        if load.wave is None:
            yield f"load.{load.name}: is steady, and without [static] acts suddenly at t = 0{_gives_way(scene, load)}"


def _hangs(scene: DiskScene) -> Iterator[str]:
    """Supports of the static stage that are not there in the run, where reactions alone bear the steady loads."""
    case, static = scene.case, scene.case.static
    if static is None or scene.seams or scene.outside is not None:
        return
    rows = scene.supports
    borne = set(rows.component[rows.prescribed | (rows.stiffness > 0.0) | (rows.damping > 0.0)].tolist())
    for axis in sorted({0, 1} - borne - {*scene.ground.held}):
        loads = [load.name for load in case.load if load.wave is None and load.moves_along(axis)]
        sides = [side for side, table in static.boundary.items() if axis in table.prescribed(normal_axis(side))]
        own = {side: vars(static.boundary[side]) for side in sides}
        kept = [side for side in sides if own[side].get("reactions") == "kept" and own[side].get("until") is None]
        if loads and kept:
            yield (
                f"static.boundary.{kept[0]}: bears load.{loads[0]} along {'xy'[axis]}, as no side does in the run; its "
                "reactions stay as constant forces, on which the body goes on resting: hold a side, or take the "
                'support away with reactions = "none"'
            )


def _gives_way(scene: DiskScene, load: Load) -> str:
    """The part of the body that does not come to rest under a lasting load, in words."""
    tables = scene.case.boundary.values()
    if any(table.factors for table in tables):
        return "; viscous sides creep under it"
    if any(table.is_outside for table in tables) and load.position is None and load.region is None:
        return "; the ground beyond the sides, of which nothing is held, moves under it as long as the run lasts"
    return ""


def _locked_in(scene: DiskScene, own: Own) -> Iterator[str]:
    """Locked-in stress that breaks bonds where it relaxes."""
    material = own.material
    cut = not all(scene.case.side(side).is_periodic for side in SIDES)
    if material.locked_in is None or material.pb_ten is None or not cut:
        return
    pulled = LARGEST_PULL * own.ground.bond_share * material.locked_in
    if pulled > material.pb_ten:
        yield (
            f"material.locked_in: is {with_unit(material.locked_in, 'Pa')}; where it relaxes, the largest bond stress "
            f"is about {with_unit(pulled, 'Pa')} of tension, above {own.key('pb_ten')} = "
            f"{with_unit(material.pb_ten, 'Pa')}, and bonds break in the static stage"
        )


def _settles_in_tension(scene: DiskScene, own: Own) -> Iterator[str]:
    """A warning about a target stress whose largest principal stress is a tension above the bonds' strength."""
    static, strength = scene.case.static, own.material.pb_ten
    if static is None or static.stress is None or strength is None:
        return
    xx, yy, xy = static.stress
    largest = 0.5 * (xx + yy) + math.hypot(0.5 * (xx - yy), xy)
    if largest > strength:
        yield (
            f"static.stress: has a tension of {with_unit(largest, 'Pa')}, above {own.key('pb_ten')} = "
            f"{with_unit(strength, 'Pa')}; bonds break in the static stage"
        )


def _speed_of_the_packing(scene: DiskScene, own: Own) -> Iterator[str]:
    """A given wave speed that holds for the square lattice but not for the packing."""
    material = own.material
    if material.p_wave_speed is None or material.match == "assembly" or material.target is not None:
        return
    for axis in _axes_in_use(scene):
        speed = own.ground.wave_speeds(axis)[0]
        if abs(speed / material.p_wave_speed - 1.0) > SPEED_ERROR:  # nan where the motion is held
            yield (
                f"{own.key('p_wave_speed')}: is {material.p_wave_speed:g} m/s of the square lattice; P waves along "
                f'{"xy"[axis]} run at {speed:.4g} m/s in this packing; give match = "assembly"'
            )
            return


def _s_speed_of_the_packing(scene: DiskScene, own: Own) -> Iterator[str]:
    """A warning about a given speed of S waves that the packing does not have: only dashpots of sides use it."""
    given = own.material.s_wave_speed
    if given is None or own.material.target is not None:
        return
    for axis in _axes_in_use(scene):
        speed = own.ground.wave_speeds(axis)[1]
        if abs(speed / given - 1.0) > SPEED_ERROR:  # nan where the motion is held
            yield (
                f"{own.key('s_wave_speed')}: is {given:g} m/s, S waves along {'xy'[axis]} run at {speed:.4g} m/s in "
                "this packing; only factors of sides follow it, so leave it out, or change what gives the packing its "
                "shear stiffness"
            )
            return


def _uneven_speed(scene: DiskScene, own: Own) -> Iterator[str]:
    """Targets of the body that waves along an axis do not have, as the packing differs by direction."""
    target, ground = own.material.target, own.ground
    if target is None:
        return
    by_waves = "give" if target.by_waves else "give p_wave_speed and s_wave_speed with"
    asked = np.sqrt(np.array([target.moduli.uniaxial, target.moduli.shear]) / ground.density)
    for axis in _axes_in_use(scene):
        for name, speed, meant in zip("PS", ground.wave_speeds(axis), asked, strict=True):
            if abs(speed / meant - 1.0) > SPEED_ERROR:
                closer = f'{by_waves} along = "{"xy"[axis]}"'
                yield (
                    f'{own.key("along")}: is "{target.along}", for which {name} waves have {meant:.4g} m/s, but along '
                    f"{'xy'[axis]} they run at {speed:.4g} m/s; {closer}, or a larger random brick"
                )
                return


def _unlikely_speed(scene: DiskScene, own: Own) -> Iterator[str]:
    """Moduli and density that are likely, but give waves of no solid."""
    material = own.material
    if material.p_wave_speed is not None or not own.ground.has_stiffness or any(unlikely_in("", material, scene.case)):
        return
    speed = own.ground.wave_speeds(0)[0]
    if found := MEANINGS["wave speed"].doubt(speed, "m/s", given=False):  # nan is not
        named = tuple(key.name for key in own.ground.law.keys[:1]) or MODULI_KEYS
        keys: tuple[str, ...] = named if material.target is None else material.target.keys[:1]
        are = f"{'is' if len(keys) == 1 else 'are'} {' and '.join(keys)}"
        yield f"{own.key(keys[0])}: makes P waves of a speed that {found}; {are} in Pa, density in kg/m³?"


def _axes_in_use(scene: DiskScene) -> list[int]:
    """Axes along which waves run: x, and y if waves enter through bottom or top, or come from loads; in layers y."""
    if scene.ground.is_layered:
        return [1]
    vertical = any(scene.case.side(edge.side).waves for edge in scene.edges.values() if edge.axis == 1)
    return [0, 1] if vertical or scene.case.load or scene.case.incident else [0]
