"""Facts about a case of disks, in words, also about the forces at rest at the sides of a body that may break."""

import math
from collections.abc import Iterator

import numpy as np

from dembound.boundaries.description import side_in_words
from dembound.boundaries.platen import Keeping
from dembound.boundaries.viscous import Bearing
from dembound.casefile.disks.load import FREE_FIELD, Load
from dembound.casefile.disks.monitor_rows import shown_names
from dembound.casefile.disks.static import can_break, keeps_forces
from dembound.casefile.messages import counted
from dembound.disks.contacts.layout import fill
from dembound.disks.material.at_rest import AtRest
from dembound.disks.scene import DiskScene
from dembound.disks.supports import forces_of
from dembound.disks.surroundings.frequencies import mean_frequency
from dembound.formulas.disks.entry import MOTIONS
from dembound.formulas.disks.reflections import sent_back
from dembound.kinds.disks.continuum_facts import continuum_facts
from dembound.kinds.disks.ground import ground_facts, particles_per
from dembound.kinds.disks.groups import group_facts, hole_facts, later_facts
from dembound.kinds.disks.incident_wave import incident_facts
from dembound.kinds.disks.joints import joint_facts
from dembound.kinds.disks.slopes import slope_facts
from dembound.kinds.disks.summary import describe_side
from dembound.kinds.disks.walls import wall_facts
from dembound.kinds.disks.wave_warnings import highest_carried, particles_per_wavelength, strong_waves
from dembound.motion.scene import Mean
from dembound.words import Entries, in_one_unit, percent, with_unit

BALANCED = 1e-9
"""Part of the forces of a pressure below which their sum is a rounding error."""

RETURNED = 0.01
"""Share of the amplitude of plane waves along the normal from which on what whole cells return is said."""


def disk_facts(scene: DiskScene) -> Entries:
    """Facts about a packing, its law and what acts on it."""
    case = scene.case
    yield "particles", _particles(scene)
    yield "contacts", f"{len(scene.assembly.pairs):,}"
    if not scene.layout.is_plain:
        yield "vector lanes", f"{100.0 * fill(scene.layout):.0f} % hold particles"
    yield from ground_facts(scene)
    yield from hole_facts(case)
    yield from joint_facts(scene)
    yield from group_facts(scene)
    yield from later_facts(case)
    yield from _static_facts(scene)
    yield from intact_facts(scene)
    yield from slope_facts(scene)
    if scene.outside is not None:
        yield from continuum_facts(scene)
    if scene.ground_waves is not None:
        yield from incident_facts(scene)
    for side in scene.edges:
        yield f"{side} side", _side_fact(scene, side)
    yield from wall_facts(scene)
    yield from _load_facts(scene)
    yield from _monitor_facts(scene)
    yield from _tension_facts(scene)
    yield from _wave_facts(scene)


def _wave_facts(scene: DiskScene) -> Entries:
    """For each wave in use its shortest wavelength, up to which frequency disks carry it, and its joined samples."""
    carried = highest_carried(scene)
    for name, count in particles_per_wavelength(scene).items():
        highest = scene.case.wave[name].highest_frequency()
        at = f", at {with_unit(highest, 'Hz')}" if math.isfinite(highest) else ""
        up_to = f"disks carry waves up to {with_unit(carried, 'Hz')}" if math.isfinite(carried) else ""
        parts = f"{particles_per(count)} shortest wavelength{at}", up_to, scene.case.wave[name].joined()
        yield f"wave {name}", "; ".join(filter(None, parts))


def _monitor_facts(scene: DiskScene) -> Entries:
    """Of each monitor, of long rows of the ends: its particle, or that it is in the continuum, its place, its twin."""
    places = scene.monitored
    for name in shown_names([monitor.name for monitor in scene.case.monitor]):
        what = "in the continuum" if name in scene.between else f"particle {scene.monitors[name]}"
        if isinstance(mean := scene.between.get(name), Mean):
            what = f"mean of {len(mean.node):,} particles, their centre"
        x, y = places[name]
        twin = scene.monitors.get(f"{name}{FREE_FIELD}")
        column = "the ground without the body" if not scene.seams else f"in the free-field column {twin}"
        if len(scene.seams) > 1 and twin is not None:
            column = f"in the column of the {'left' if twin < scene.seams[0].disks.stop else 'right'} side {twin}"
        beside = "" if twin is None else f", {column}"
        yield f"monitor {name}", f"{what} at ({x:.3f}, {y:.3f}) m{beside}"


def _tension_facts(scene: DiskScene) -> Entries:
    """Waves that would open contacts, for a run in which the law then changes."""
    law = scene.case.material.law
    if scene.has_history and scene.case.begins_elastic:
        for name, stress in strong_waves(scene).items():
            yield f"stress of {name}", f"ρcv = {stress}; in tension contacts open, and the law changes to {law}"


def _particles(scene: DiskScene) -> str:
    """Number of particles, also before an excavation."""
    loose = scene.assembly.loose
    before = f", {scene.before.disk_count:,} before the excavation" if scene.before is not None else ""
    severed = f"; {counted(loose, 'severed disk')} left out" if loose else ""
    return f"{scene.disk_count:,}{before}{severed}"


def _static_facts(scene: DiskScene) -> Entries:
    """Loads and supports of the static stage."""
    case, static = scene.case, scene.case.static
    if static is None:
        return
    acting = [load.name for load in case.load if load.wave is None]
    at_rest = scene.at_rest
    if at_rest is not None:
        acting.append("the stress at rest")
        yield "stress at rest", "; ".join(_at_heights(scene, at_rest))
    elif static.stress is not None:
        texts, unit = in_one_unit(static.stress, "Pa")
        acting.append(f"σ_xx, σ_yy, σ_xy = {', '.join(texts)} {unit}")
    if case.material.locked_in:
        acting.append("the locked-in stress")
    sides = ", ".join(f"{side} {table.type}" for side, table in static.boundary.items()) or "all free"
    ratio, sliding = (static.enough(slides=slides) for slides in (False, scene.has_history))
    more = "" if sliding == ratio else f", of {sliding:g} once contacts slide or open"
    yield "static stage", f"under {' and '.join(acting)}, to an unbalanced force ratio of {ratio:g}{more}"
    yield "static sides", sides


def _at_heights(scene: DiskScene, at_rest: AtRest) -> Iterator[str]:
    """The stress at rest at the top and bottom, in words; once where it is the same everywhere.

    Below a surface that is not level, or in layers that differ: at the bottom, once if both ends are alike.
    """
    (left, bottom), (wide, high) = scene.low.tolist(), scene.size.tolist()
    unlike, ends = scene.case.is_unlike, [(left, bottom + high), (left + wide, bottom + high)]
    if at_rest.surface is not None:
        ends = at_rest.surface[:, [0, -1]].T.tolist()
    places: list[tuple[float, float, str]] = [(height, left, "") for height in (bottom + high, bottom)]
    if at_rest.surface is not None or unlike:
        named = zip(ends, (" below the left end", " below the right end"), strict=True)
        by_top = {of if unlike else top: (bottom, x, of) for (x, top), of in named}
        places = [(y, x, of if len(by_top) > 1 else "") for y, x, of in by_top.values()]
    for height, x, of in places:
        texts, unit = in_one_unit(at_rest.at(np.array([height]), np.array([x]))[:, 0].tolist(), "Pa")
        where = "everywhere" if at_rest.is_uniform else f"at y = {height:.4g} m{of}"
        yield f"σ_xx, σ_yy, σ_xy = {', '.join(texts)} {unit} {where}"
        if at_rest.is_uniform:
            return


def _load_facts(scene: DiskScene) -> Entries:
    """For each load its particles or surface, its total force, and its time factor."""
    for load in scene.case.load:
        nodes, forces = forces_of(load, scene)
        what = "particle" if nodes[0] < scene.disk_count else "node"
        on = counted(len(nodes), what) + (" of the continuum" if what == "node" else "")
        factor = "steady" if load.wave is None else f"times wave {load.wave}"
        whole = f"{_whole_of(load, scene, forces)} on {on}, {factor}"
        yield f"load {load.name}", f"{whole}{_images(scene, nodes, forces)}"


def _images(scene: DiskScene, nodes: np.ndarray, forces: np.ndarray) -> str:
    """Text on the total force of a load and its image, if its nodes (k,) are all beside a plane of symmetry."""
    for side, edge in scene.edges.items():
        if scene.case.side(side).is_mirror and np.isin(nodes, edge.nodes).all():
            both = 2.0 * forces[:, :2].sum(axis=0) * (np.arange(2) != edge.axis)
            return f"; with the images beyond {side} {_force(both)}"
    return ""


def _whole_of(load: Load, scene: DiskScene, forces: np.ndarray) -> str:
    """The total force of a load, or its pressure with the length of wall for its forces (k, 3)."""
    whole = forces[:, :2].sum(axis=0)
    if load.pressure is None:
        return _force(whole)
    all_forces = np.hypot(*forces[:, :2].T).sum()
    whole[np.abs(whole) < BALANCED * all_forces] = 0.0
    left = f", {_force(whole)} in all" if whole.any() else ""
    length = all_forces / abs(load.pressure)
    where = f"wall of hole {load.hole}" if load.sides is None else f"the sides {', '.join(load.sides)}"
    return f"{with_unit(load.pressure, 'Pa')} on {length:.3g} m of {where}{left},"


def _force(whole: np.ndarray) -> str:
    """A force (2,) N/m as text."""
    texts, unit = in_one_unit(whole.tolist(), "N/m")
    return f"({', '.join(texts)}) {unit}"


def _side_fact(scene: DiskScene, side: str) -> str:
    facts, alike = describe_side(scene, side), dict[str, list[str]]()
    for each in facts.pop("layers", []):
        alike.setdefault(side_in_words({"type": facts["type"], **each}), []).append(each["layer"])
    edge = scene.edges[side]
    held = len(scene.case.side(side).part_of(edge).nodes)
    some = f", {held} of them held" if held < len(edge.nodes) else ""
    words = [f"{text} beside {' and '.join(names)}" for text, names in alike.items()]
    return (
        f"{'; '.join(words) if len(words) > 1 else side_in_words(facts)}; {facts['particles']} particles{some}, "
        f"D = {facts['diameter_min']:.3f}…{facts['diameter_max']:.3f} m, in all "
        f"{facts['diameter_sum_ratio']:.3g} times the side's length"
        f"{_whole_cells(scene, side)}"
    )


def _whole_cells(scene: DiskScene, side: str) -> str:
    """What dashpots return as their disks are not half cells, though they may be; empty if it is little."""
    case, table = scene.case, scene.case.side(side)
    may_halve = table.may_halve and side in case.packing.regular_sides and not (table.half_cells or table.is_interface)
    frequency = mean_frequency(case) if may_halve else math.nan
    if math.isnan(frequency):
        return ""
    found = []
    for motion in MOTIONS:
        share, of_factors = (sent_back(scene, side, motion, at) for at in (frequency, math.nan))
        if share > max(RETURNED, 2.0 * of_factors):
            found.append(f"{percent(share)} of {motion.upper()}")
    if not found:
        return ""
    kinds = f"{' and '.join(found)} waves at {frequency:.3g} Hz"
    return f"; whole cells return {kinds}, half cells (half_mass) the square of that"


TENTH = 0.1
"""Share of the weight in examples of sag and creep."""

STEADY, LATE, SAMPLES = 0.01, 0.75, 50
"""A wave counts as lasting if its value, sampled so often after this share of the run, changes by less than STEADY."""


def intact_facts(scene: DiskScene) -> Entries:
    """Where the zones lie in which bonds do not break, and the springs of sides on relative motion."""
    zones = scene.intact_zones
    if zones:
        depths: dict[int, list[str]] = {}
        for side in zones:
            depths.setdefault(scene.case.intact[side], []).append(side)
        parts = [f"{counted(depth, 'disk')} from {' and '.join(sides)}" for depth, sides in depths.items()]
        inside = len(np.unique(np.concatenate(list(zones.values()))))
        count = scene.disk_count - scene.column_count
        column = "; all of the free-field column" if any(side in scene.case.column_sides for side in zones) else ""
        yield "bonds kept", f"{', '.join(parts)}: {inside:,} of {count:,} disks have bonds that do not break{column}"
    if (springs := scene.bearing) is not None:
        beyond = "the free-field column" if scene.twin is not None else "its own mean, so that they bear no net force"
        by_side: dict[Bearing, list[str]] = {}
        for side, bearing in scene.case.bearing.items():
            by_side.setdefault(bearing, []).append(side)
        factors = ", ".join(
            f"α_n {each.alpha_n:g} and α_s {each.alpha_s:g} at {' and '.join(sides)}" for each, sides in by_side.items()
        )
        stiffness = float(springs.stiffness[:, 1].sum())
        sags = ""
        if scene.twin is not None and stiffness > 0.0 and (weight := _weight(scene)) > 0.0:
            sag = TENTH * weight / stiffness
            sags = f"; a tenth of the weight more sags by {with_unit(sag, 'm')}, in proportion to the width of the body"
        yield "side springs", f"{factors}, on the motion relative to {beyond}{sags}"


def intact_warnings(scene: DiskScene) -> Iterator[str]:
    """Warnings about forces at rest without a zone, and about loads that dashpots alone bear."""
    yield from _without_zone(scene)
    yield from _change_of_weight(scene)
    yield from _lasting_loads(scene)


def _without_zone(scene: DiskScene) -> Iterator[str]:
    """Sides without a zone although forces at rest act on them."""
    case = scene.case
    if not (scene.has_history and can_break(case.materials)):
        return
    sides = [
        side
        for side, table in case.boundary.items()
        if isinstance(table, Keeping) and table.intact == 0 and keeps_forces(case.static, side, table)
    ]
    if sides:
        keys = " and ".join(f"boundary.{side}.intact" for side in sides)
        yield (
            f"{keys}: {'is' if len(sides) == 1 else 'are'} 0, but forces of the static stage go on acting there when "
            "bonds break, on whatever is left of the ground, and may move it without end; leave it out, or give 2"
        )


def creep(scene: DiskScene, axis: int) -> float | None:
    """Velocity (m/s) of a body per newton of a lasting force along an axis, if dashpots alone bear it; else None."""
    supports = scene.supports
    own = (supports.component == axis) & (supports.node >= scene.column_count) & (supports.node < scene.disk_count)
    springs = scene.bearing is not None and scene.twin is not None and scene.bearing.stiffness[:, axis].any()
    held = scene.free[axis] == 0.0 or supports.prescribed[own].any() or supports.stiffness[own].any()
    damping = float(supports.damping[own].sum())
    return None if held or springs or scene.continua or damping == 0.0 else 1.0 / damping


def _change_of_weight(scene: DiskScene) -> Iterator[str]:
    """Ground in which bonds may break and that dashpots alone bear: weight that falls off makes it drift."""
    rate = creep(scene, 1)
    if not scene.intact_zones or not scene.has_history or rate is None or (weight := _weight(scene)) == 0.0:
        return
    drift = with_unit(TENTH * weight * rate, "m/s")
    yield (
        "boundary: dashpots alone bear this ground, whose weight is in balance at rest; where ground falls off or is "
        f"added it moves without end, at {drift} for a tenth of the weight; anchor it: hold a side, or take "
        '"free_field" or "outside" sides'
    )


def _lasting_loads(scene: DiskScene) -> Iterator[str]:
    """Loads that last until the end of a run, beside dashpots alone."""
    times = scene.case.run.duration * np.linspace(LATE, 1.0, SAMPLES)
    for load in scene.case.load:
        if load.wave is None:
            continue
        values = scene.case.wave[load.wave].velocity(times)
        if not values.any() or np.ptp(values) > STEADY * np.abs(values).max():
            continue
        force = forces_of(load, scene)[1].sum(axis=0) * values.mean()
        for axis in (0, 1):
            rate = creep(scene, axis)
            if rate is not None and abs(force[axis]) > STEADY * np.hypot(*force[:2]):
                speed = with_unit(abs(force[axis]) * rate, "m/s", 4)
                yield (
                    f"load.{load.name}: lasts until the end of the run, {with_unit(abs(force[axis]), 'N', 4)} along "
                    f"{'xy'[axis]}, and dashpots alone bear it: the body creeps at {speed}; hold a side, or take "
                    '"outside" sides'
                )


def _weight(scene: DiskScene) -> float:
    """Size (N) of the steady force along y on the disks of the body."""
    return abs(float(scene.steady_load[1, scene.column_count : scene.disk_count].sum()))
