"""The ground of a scene of disks in numbers and in words: packing, layers, law, strengths and damping."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from dembound.casefile.disks import DiskCase
from dembound.casefile.magnitudes import waves_used
from dembound.casefile.messages import counted
from dembound.damping import Mechanisms, Rayleigh
from dembound.disks.loose import reserve
from dembound.disks.material.layered import LayeredGround
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.material.unlike import UnlikeGround
from dembound.disks.scene import DiskScene
from dembound.disks.stability import viscous_share
from dembound.kinds.disks.micro_macro import Own, brick_quantities, materials_of
from dembound.words import Entries, Quantity, in_one_unit, numbers, percent, sentences, with_unit

FOUND_DIGITS = 5
"""Digits of micro-parameters that have been found."""

MICRONS = 6
"""Digits of heights in m."""

MODULI = ("emod", "pb_emod", "kratio", "pb_kratio")
"""Micro-parameters that give the stiffness."""

STIFFNESS = {"C11": (0, 0), "C22": (1, 1), "C12": (0, 1), "C66": (3, 3)}
"""Printed moduli, and their places in the stiffness of a ground."""


def packing_quantities(scene: DiskScene) -> list[Quantity]:
    """The brick, stresses and stiffnesses, and speeds along x, without numbers where the motion is held.

    In layers they are those of the slowest.
    """
    ground, brick, tensor = scene.ground, scene.ground.brick, scene.ground.material_tensor
    p_speed, s_speed = speeds_along(ground, 0)
    moduli = {name: getattr(ground.moduli, name) for name in MODULI}
    return [
        Quantity("disks_per_brick", "1", len(brick.radii), counted(len(brick.radii), "disk")),
        *brick_quantities(brick),
        Quantity("residual_ratio", "1", brick.residual_ratio, "residual force ratio {:.1e}"),
        Quantity("stress", "Pa", (brick.stress * ground.moduli.emod).tolist()),
        *(Quantity(name, "1" if "ratio" in name else "Pa", value) for name, value in moduli.items()),
        *(Quantity(name, "Pa", tensor[at]) for name, at in STIFFNESS.items()),
        Quantity("p_wave_speed", "m/s", p_speed, "c_p = {}"),
        Quantity("s_wave_speed", "m/s", s_speed, "c_s = {}"),
    ]


def speeds_along(ground: PackedMaterial, axis: int) -> list[float | None]:
    """Speeds (m/s) of P and S waves along an axis; None where the motion is held."""
    return [None if np.isnan(speed) else speed for speed in ground.wave_speeds(axis)]


def describe_layers(scene: DiskScene) -> list[dict[str, Any]]:
    """The layers from the surface down: heights (m), density, moduli (Pa), and speeds along y (m/s, null where held).

    The lowest ends with the ground's box, or where it begins if that is below. Where they differ at the left and right:
    those of the left side and then those of the right one, with the `side`.

    `joint` : of the joint below, null without one: the effective heights of mass, and of stiffness for P and S waves,
    before they are corrected, in m above the plane; null where the layers do not differ.
    """
    ground, case = scene.ground, scene.case
    if not isinstance(ground, LayeredGround):
        return []
    if not isinstance(ground, UnlikeGround):
        return _layers_of(case, ground)
    return [
        {"name": each["name"], "side": side} | each
        for side in ("left", "right")
        for each in _layers_of(case.beside(side), ground.beside(side))
    ]


def _layers_of(case: DiskCase, ground: LayeredGround) -> list[dict[str, Any]]:
    """The layers of a case that are the same at both sides, see `describe_layers`."""
    heights = (case.box[3], *case.layer_planes, min([case.box[1], *case.layer_planes[-1:]]))
    joints = [*reversed(ground.joints), None]
    found = []
    for number, (name, material, joint) in enumerate(zip(case.layer_names, ground.materials, joints, strict=True)):
        p_speed, s_speed = speeds_along(material, 1)
        found.append(
            {
                "name": name,
                "top": heights[number],
                "bottom": heights[number + 1],
                "density": material.density,
                **{key: getattr(material.moduli, key) for key in MODULI},
                "p_wave_speed": p_speed,
                "s_wave_speed": s_speed,
                "joint": joint
                and {
                    key: None if np.isnan(at) else at
                    for key, at in (("mass", joint.mass), ("p", joint.p), ("s", joint.s))
                },
            }
        )
    return found


def ground_facts(scene: DiskScene) -> Entries:
    """Facts about a packing, its stiffness or layers, its law and strengths, and its damping."""
    yield from _packing_facts(scene)
    yield from _law_facts(scene)
    yield from _damping_facts(scene)


def _packing_facts(scene: DiskScene) -> Entries:
    """The brick, and stiffness and speeds that it gives, or those of layers."""
    found = packing_quantities(scene)
    yield "brick", sentences(found, "disks_per_brick", "solid_fraction", "coordination")
    if (pressure := scene.ground.packed_pressure) > 0.0:  # a lattice needs none
        yield "brick equilibrium", f"{sentences(found, 'residual_ratio')}, packed under {with_unit(pressure, 'Pa')}"
    for own in materials_of(scene):
        yield from _found_facts(own)
    if layers := describe_layers(scene):
        yield from _layer_facts(scene, layers)
        return
    if not scene.ground.has_stiffness:
        yield "wave speeds", "none: without pressure contacts have no stiffness; static.stress gives one"
        return
    texts, unit = in_one_unit([numbers(found)[name] for name in STIFFNESS], "Pa")
    yield "homogenised stiffness", f"{', '.join(map(' '.join, zip(STIFFNESS, texts, strict=True)))} {unit}"
    yield "wave speeds", sentences(found, "p_wave_speed", "s_wave_speed") or "no motion is free"


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
    for layer, after in zip(layers, [*layers[1:], None], strict=True):
        at, below = f", {layer['side']}" if "side" in layer else "", after if layer["joint"] else None
        speeds = {"c_p": layer["p_wave_speed"], "c_s": layer["s_wave_speed"]}
        runs = [speed for speed in speeds.values() if speed is not None]
        parts = [_heights_of(layer, below is None and goes_on), with_unit(layer["density"], "kg/m³")]
        parts += [f"{sign} = {with_unit(speed, 'm/s')}" for sign, speed in speeds.items() if speed is not None]
        if runs and 0.0 < highest < math.inf:
            parts.append(f"{particles_per(min(runs) / highest / diameter)} wavelength at {with_unit(highest, 'Hz')}")
        yield f"layer {layer['name']}{at}", ", ".join(parts)
        if below is not None:
            yield f"joint {layer['name']}/{below['name']}{at}", _joint_fact(layer)


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
    start = ", elastic until a contact opens, slips or closes or a bond yields" if scene.case.begins_elastic else ""
    yield "law", f"{material.law}{start}"
    if scene.case.rolls:
        yield "rolling", "springs against rolling act from the start; wave speeds, sides and estimates leave them out"
    if scene.ground.overlaps is not None:
        yield "overlap", _overlap_fact(scene.ground)
    if material.has_dashpots:
        ratios = f"{material.dp_nratio:g} normal, {material.dp_sratio:g} shear of the critical damping of two disks"
        where = "closed contacts" if scene.case.damps_bonds else "closed contacts without an intact bond"
        yield "dashpots", f"{ratios}, at {where}; the step is {viscous_share(scene):.2f} times as long"
    for own in materials_of(scene):
        yield from _strength_facts(own)


def _overlap_fact(ground: PackedMaterial) -> str:
    """Overlaps at rest, and that up to which the step limit holds, where the stiffness grows with it."""
    assert ground.overlaps is not None
    texts, unit = in_one_unit([float(ground.overlaps.max(initial=0.0)), reserve(ground)], "m")
    rest = f"up to {texts[0]} {unit} at rest; " if ground.has_stiffness else ""
    return f"{rest}the step limit holds up to {texts[1]} {unit}, beyond which a run stops"


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
        if material.pb_mcf < 1.0:
            bonds += f", where {percent(material.pb_mcf)} of moments count"
    rolls = f", and roll at {material.rr_fric:g} R̄ of it" if material.rr_fric > 0.0 else ""
    yield f"strength{name}", f"{bonds}; contacts slip at {material.fric:g} of their normal force{rolls}"
    if ground.moduli.emod > 0.0 and ground.law.starts_elastic:
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
            yield from _quality_facts(name, found, relaxes=scene.ground.relaxes)
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


def _quality_facts(name: str, found: Mechanisms, *, relaxes: bool) -> Entries:
    """The damping of ground by mechanisms; name : of the layer, after the name of each fact.

    relaxes : whether bonds have relaxation arms, and settle without them.
    """
    (low, high), (least, most) = found.band, found.range
    texts, unit = in_one_unit((low, high), "Hz")
    yield (
        f"damping{name}",
        f"Q = {least:.3g} to {most:.3g} over {texts[0]} to {texts[1]} {unit}, by {len(found.weights)} mechanisms; wave "
        f"speeds hold at {with_unit(found.frequency, 'Hz')}",
    )
    step = "" if name else f": the step is {found.unrelaxed**-0.5:.3g} times as long"  # in layers the stiffest does
    yield (f"unrelaxed stiffness{name}", f"{found.unrelaxed:.4g} times that of the wave speeds{step}")
    if relaxes:
        yield (
            f"stiffness at rest{name}",
            f"{found.relaxed * found.unrelaxed:.4g} times that of the wave speeds: the ground settles by "
            f"{percent(1.0 / (found.relaxed * found.unrelaxed) - 1.0)} more",
        )


def particles_per(count: float) -> str:
    """Text on a number of particles per some length."""
    return f"{count:.0f} particles per" if count >= 1.0 else "less than one particle per"
