"""Facts about a case of disks, in words."""

import math
from collections.abc import Iterator

import numpy as np

from dembound.boundaries.description import side_in_words
from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.load import FREE_FIELD, Load
from dembound.casefile.messages import counted
from dembound.disks.contacts.layout import fill
from dembound.disks.material.at_rest import StressAtRest
from dembound.disks.scene import DiskScene
from dembound.disks.supports import forces_of
from dembound.disks.surroundings.frequencies import mean_frequency
from dembound.formulas.disks.entry import MOTIONS
from dembound.formulas.disks.reflections import sent_back
from dembound.kinds.disks.continuum_facts import continuum_facts
from dembound.kinds.disks.ground import ground_facts, particles_per
from dembound.kinds.disks.incident_facts import incident_facts
from dembound.kinds.disks.intact import intact_facts
from dembound.kinds.disks.summary import describe_side
from dembound.kinds.disks.wave_warnings import highest_carried, particles_per_wavelength, strong_waves
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
    yield from _hole_facts(case)
    yield from _static_facts(scene)
    yield from intact_facts(scene)
    if scene.outside is not None:
        yield from continuum_facts(scene)
    if scene.ground_waves is not None:
        yield from incident_facts(scene)
    for side in scene.edges:
        yield f"{side} side", _side_fact(scene, side)
    yield from _load_facts(scene)
    yield from _monitor_facts(scene)
    yield from _tension_facts(scene)
    yield from _wave_facts(scene)


def _wave_facts(scene: DiskScene) -> Entries:
    """For each wave in use its shortest wavelength, up to which frequency disks carry it, and its joined samples."""
    carried = highest_carried(scene)
    for name, count in particles_per_wavelength(scene).items():
        few = f"{particles_per(count)} shortest wavelength"
        highest, joined = scene.case.wave[name].highest_frequency(), scene.case.wave[name].joined()
        at = f", at {with_unit(highest, 'Hz')}" if math.isfinite(highest) else ""
        parts = [f"{few}{at}"]
        if math.isfinite(carried):
            parts.append(f"disks carry waves up to {with_unit(carried, 'Hz')}")
        yield f"wave {name}", "; ".join([*parts, *([joined] if joined else [])])


def _monitor_facts(scene: DiskScene) -> Entries:
    """For each monitor its particle, or that it is in the continuum, its place, and its free-field twin."""
    places = scene.monitored
    for name in (monitor.name for monitor in scene.case.monitor):
        what = "in the continuum" if name in scene.between else f"particle {scene.monitors[name]}"
        x, y = places[name]
        twin = scene.monitors.get(f"{name}{FREE_FIELD}")
        column = "the ground without the body" if scene.seam is None else f"in the free-field column {twin}"
        beside = "" if twin is None else f", {column}"
        yield f"monitor {name}", f"{what} at ({x:.3f}, {y:.3f}) m{beside}"


def _tension_facts(scene: DiskScene) -> Entries:
    """Waves that would open contacts, for a run in which the law then changes."""
    law = scene.case.material.law
    if scene.has_history and scene.case.material.begins_elastic:
        for name, stress in strong_waves(scene).items():
            yield f"stress of {name}", f"ρcv = {stress}; in tension contacts open, and the law changes to {law}"


def _particles(scene: DiskScene) -> str:
    """Number of particles, also before an excavation."""
    loose = scene.assembly.loose
    before = f", {scene.before.disk_count:,} before the excavation" if scene.before is not None else ""
    severed = f"; {counted(loose, 'severed disk')} left out" if loose else ""
    return f"{scene.disk_count:,}{before}{severed}"


def _hole_facts(case: DiskCase) -> Entries:
    """Shape of every hole, and the stage in which it is made."""
    stages = {"before": "present from the start", "after": "excavated once the body has settled"}
    yield from (
        (f"hole {hole.name}", f"{hole.type}, {'shape of the sample' if hole.is_shape else stages[hole.stage]}")
        for hole in case.hole
    )


def _static_facts(scene: DiskScene) -> Entries:
    """Loads and supports of the static stage."""
    case, static = scene.case, scene.case.static
    if static is None:
        return
    acting = [load.name for load in case.load if load.wave is None]
    at_rest = scene.at_rest
    if at_rest is not None:
        acting.append("the stress at rest")
        yield "stress at rest", "; ".join(_at_heights(at_rest, (scene.low[1] + scene.size[1], scene.low[1])))
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


def _at_heights(at_rest: StressAtRest, heights: tuple[float, float]) -> Iterator[str]:
    """The stress at rest at heights (m), in words; once where it is the same everywhere."""
    for height, stress in zip(heights, at_rest.at(np.array(heights)).T.tolist(), strict=True):
        texts, unit = in_one_unit(stress, "Pa")
        where = "everywhere" if at_rest.is_uniform else f"at y = {height:.4g} m"
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
        f"D = {facts['diameter_min']:.3f}…{facts['diameter_max']:.3f} m, ΣD/H = {facts['diameter_sum_ratio']:.3g}"
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
