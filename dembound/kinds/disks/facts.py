"""Facts about a case of disks, in words."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from dembound.boundaries.description import side_in_words
from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.load import FREE_FIELD, Load
from dembound.casefile.magnitudes import waves_used
from dembound.casefile.messages import counted
from dembound.damping import Mechanisms, Rayleigh
from dembound.disks.contacts.layout import fill
from dembound.disks.material.at_rest import StressAtRest
from dembound.disks.scene import DiskScene
from dembound.disks.stability import viscous_share
from dembound.disks.supports import forces_of
from dembound.disks.surroundings.frequencies import mean_frequency
from dembound.formulas.disks.entry import MOTIONS
from dembound.formulas.disks.reflections import sent_back
from dembound.kinds.disks.continuum_facts import continuum_facts
from dembound.kinds.disks.incident_facts import incident_facts
from dembound.kinds.disks.intact import intact_facts
from dembound.kinds.disks.micro_macro import Own, materials_of
from dembound.kinds.disks.summary import describe_layers, describe_packing, describe_side
from dembound.kinds.disks.wave_warnings import highest_carried, particles_per_wavelength, strong_waves
from dembound.words import Entries, in_one_unit, percent, with_unit

BALANCED = 1e-9
"""Part of the forces of a pressure below which their sum is a rounding error."""

FOUND_DIGITS = 5
"""Digits of micro-parameters that have been found."""

RETURNED = 0.01
"""Share of the amplitude of plane waves along the normal from which on what whole cells return is said."""

MICRONS = 6
"""Digits of heights in m."""


def disk_facts(scene: DiskScene) -> Entries:
    """Facts about a packing, its law and what acts on it."""
    case = scene.case
    yield "particles", _particles(scene)
    yield "contacts", f"{len(scene.assembly.pairs):,}"
    if not scene.layout.is_plain:
        yield "vector lanes", f"{100.0 * fill(scene.layout):.0f} % hold particles"
    yield from _packing_facts(scene)
    yield from _law_facts(scene)
    yield from _damping_facts(scene)
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
        few = f"{_particles_per(count)} shortest wavelength"
        highest, joined = scene.case.wave[name].highest_frequency(), scene.case.wave[name].joined()
        at = f", at {with_unit(highest, 'Hz')}" if math.isfinite(highest) else ""
        parts = [f"{few}{at}"]
        if math.isfinite(carried):
            parts.append(f"disks carry waves up to {with_unit(carried, 'Hz')}")
        yield f"wave {name}", "; ".join([*parts, *([joined] if joined else [])])


def _particles_per(count: float) -> str:
    """Text on a number of particles per some length."""
    return f"{count:.0f} particles per" if count >= 1.0 else "less than one particle per"


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


def _packing_facts(scene: DiskScene) -> Entries:
    packing = describe_packing(scene)
    speeds = [
        f"{name} = {with_unit(packing[key], 'm/s')}"
        for name, key in (("c_p", "p_wave_speed"), ("c_s", "s_wave_speed"))
        if packing[key] is not None
    ]
    disks = counted(packing["disks_per_brick"], "disk")
    solid = f"solid fraction {packing['solid_fraction']:.3f}"
    yield "brick", f"{disks}, {solid}, {packing['coordination']:.3g} contacts per disk"
    if (pressure := scene.ground.packed_pressure) > 0.0:  # a lattice needs none
        ratio = f"residual force ratio {packing['residual_ratio']:.1e}"
        yield "brick equilibrium", f"{ratio}, packed under {with_unit(pressure, 'Pa')}"
    for own in materials_of(scene):
        yield from _found_facts(own)
    if layers := describe_layers(scene):
        yield from _layer_facts(scene, layers)
        return
    moduli = ("C11", "C22", "C12", "C66")
    texts, unit = in_one_unit([packing[name] for name in moduli], "Pa")
    yield "homogenised stiffness", f"{', '.join(map(' '.join, zip(moduli, texts, strict=True)))} {unit}"
    yield "wave speeds", ", ".join(speeds) or "no motion is free"


def _found_facts(own: Own) -> Entries:
    """Stiffness of contacts and bonds that follows from targets of the body."""
    if own.material.target is not None:
        moduli = own.ground.moduli
        texts, unit = in_one_unit([moduli.emod, moduli.pb_emod], "Pa", FOUND_DIGITS)
        ratio = f"kratio = pb_kratio = {moduli.kratio:.{FOUND_DIGITS}g}"
        asked = " and ".join(own.material.target.keys)
        yield f"found{own.name}", f"emod {texts[0]}, pb_emod {texts[1]} {unit}, {ratio} from {asked}"


def _layer_facts(scene: DiskScene, layers: Sequence[Mapping[str, Any]]) -> Entries:
    """For each layer its heights, density, speeds, and disks in its shortest wave; for each joint where it comes out.

    layers : see `describe_layers`.
    """
    used = waves_used(scene.case)
    highest = max((wave.highest_frequency() for name, wave in scene.case.wave.items() if name in used), default=0.0)
    diameter, bottom = scene.ground.brick.mean_diameter, scene.case.side("bottom")
    goes_on = bottom.is_outside or (bool(bottom.factors) and getattr(bottom, "rock", None) is None)
    for layer, below in zip(layers, [*layers[1:], None], strict=True):
        speeds = {"c_p": layer["p_wave_speed"], "c_s": layer["s_wave_speed"]}
        runs = [speed for speed in speeds.values() if speed is not None]
        parts = [_heights_of(layer, below is None and goes_on), with_unit(layer["density"], "kg/m³")]
        parts += [f"{sign} = {with_unit(speed, 'm/s')}" for sign, speed in speeds.items() if speed is not None]
        if runs and 0.0 < highest < math.inf:
            parts.append(f"{_particles_per(min(runs) / highest / diameter)} wavelength at {with_unit(highest, 'Hz')}")
        yield f"layer {layer['name']}", ", ".join(parts)
        if below is not None:
            yield f"joint {layer['name']}/{below['name']}", _joint_fact(layer)


def _heights_of(layer: Mapping[str, Any], goes_on: bool) -> str:
    """The heights of a layer, and whether it goes on below."""
    top, bottom = layer["top"], layer["bottom"]
    if goes_on and bottom >= top:
        return f"below y = {top:.6g} m"
    return f"y = {top:.6g} to {bottom:.6g} m{' and on below' if goes_on else ''}"


def _joint_fact(layer: Mapping[str, Any]) -> str:
    """Where the effective heights of the joint below a layer come out."""
    names = {"mass": "for the mass", "p": "for P waves", "s": "for S waves"}
    found = {words: round(above, MICRONS) for key, words in names.items() if (above := layer["joint"][key]) is not None}
    each = ", ".join(f"{with_unit(above + 0.0, 'm')} {words}" for words, above in found.items())
    comes_out = f"; as packed above that by {each}; corrected by the disks beside it" if each else ""
    return f"y = {layer['bottom']:.6g} m{comes_out}"


def _law_facts(scene: DiskScene) -> Entries:
    """The law, dashpots with what they cost, and the limits of contacts and bonds."""
    material = scene.case.material
    if not scene.has_history:
        linear = "" if scene.ground.law.is_linear else "not linear; "
        yield "law", f"{material.law}: {linear}contacts neither open nor slip, bonds do not break"
        return
    start = ", elastic until a contact opens, slips or closes or a bond yields" if material.begins_elastic else ""
    yield "law", f"{material.law}{start}"
    if material.has_dashpots:
        ratios = f"{material.dp_nratio:g} normal, {material.dp_sratio:g} shear of the critical damping of two disks"
        yield "dashpots", f"{ratios}, at closed contacts; the step is {viscous_share(scene):.2f} times as long"
    for own in materials_of(scene):
        yield from _strength_facts(own)


def _strength_facts(own: Own) -> Entries:
    """The limits of contacts and bonds of a material."""
    material, ground, name, bonds = own.material, own.ground, own.name, "no bonds"
    if ground.moduli.pb_emod > 0.0:
        tension, shear = (
            "unbreakable" if strength is None else with_unit(strength, "Pa")
            for strength in (material.pb_ten, material.pb_coh)
        )
        pressed = f" + σ·tan {material.pb_fa:g}°" if material.pb_fa > 0.0 else ""
        bonds = f"bonds {tension} in tension, {shear}{pressed} in shear"
        if material.pb_scatter is not None:
            bonds += f", each times a factor of its own, {material.pb_scatter.in_words}"
    yield f"strength{name}", f"{bonds}; contacts slip at {material.fric:g} of their normal force"
    if ground.moduli.emod > 0.0:
        yield (
            f"tension{name}",
            f"in tension the stiffness falls to {100.0 * ground.bond_share:.0f} %, as contacts open and only "
            "bonds carry; confine the contacts (static.stress) or lower material.contact_share",
        )
    if material.locked_in is not None:
        shares = [
            f"{percent(material.locked_in / strength, 3)} of {key}"
            for key, strength in (("pb_ten", material.pb_ten), ("pb_coh", material.pb_coh))
            if strength is not None
        ]
        locked_in = f"{with_unit(material.locked_in, 'Pa')} before the static stage"
        yield f"locked-in stress{name}", ", ".join([locked_in, *shares])


def _damping_facts(scene: DiskScene) -> Entries:
    """Q over its band, the frequency at which wave speeds hold, the unrelaxed stiffness, and what the step costs."""
    names = [f" of {name}" for name in scene.case.layer_names] if scene.ground.is_layered else [""]
    for name, found in zip(names, scene.ground.mechanisms_by_layer, strict=True):
        if isinstance(found, Mechanisms):
            yield from _quality_facts(name, found)
        elif isinstance(found, Rayleigh):
            yield f"Rayleigh damping{name}", _rayleigh_fact(found)
    if scene.case.is_damped and scene.case.damping.type == "rayleigh":
        yield "step limit", f"{viscous_share(scene):.3g} times that without damping"


def _rayleigh_fact(found: Rayleigh) -> str:
    """Coefficients of Rayleigh damping, and Q over its band."""
    (low, high), (least, most) = found.band, found.range
    texts, unit = in_one_unit((low, high), "Hz")
    return (
        f"α = {found.alpha:.3g}/s, β = {with_unit(found.beta, 's')}; Q = {least:.3g} at {texts[0]} and {texts[1]} "
        f"{unit}, up to {most:.3g} between"
    )


def _quality_facts(name: str, found: Mechanisms) -> Entries:
    """The damping of ground by mechanisms; name : of the layer, after the name of each fact."""
    (low, high), (least, most) = found.band, found.range
    texts, unit = in_one_unit((low, high), "Hz")
    yield (
        f"damping{name}",
        f"Q = {least:.3g} to {most:.3g} over {texts[0]} to {texts[1]} {unit}, by {len(found.weights)} mechanisms; wave "
        f"speeds hold at {with_unit(found.frequency, 'Hz')}",
    )
    step = "" if name else f": the step is {found.unrelaxed**-0.5:.3g} times as long"  # in layers the stiffest does
    yield (
        f"unrelaxed stiffness{name}",
        f"{found.unrelaxed:.4g} times that of the wave speeds{step}",
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
