"""Warnings about waves and loads: too short for the disks, too late, too strong or too weak."""

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from dembound.boundaries import axis_of_motion, normal_axis
from dembound.casefile import magnitudes
from dembound.casefile.disks.load import Load
from dembound.disks.material.packing_waves import slowest_speed
from dembound.disks.scene import DiskScene
from dembound.disks.sides import boundary_medium, medium_of_side
from dembound.disks.surroundings.frequencies import share_above
from dembound.errors import CaseError
from dembound.kinds.disks.incident_wave import arrival
from dembound.kinds.disks.micro_macro import materials_of
from dembound.places import spans_all
from dembound.waves.constant import Constant
from dembound.waves.wave import HANN_FADE, Wave
from dembound.words import percent, with_unit

FEWEST_PER_WAVELENGTH = 20.0
"""Below this many particles per wavelength the lattice's phase error (qa)²/24 exceeds 0.4 %."""

ROTATION = 2
"""The component of held motions that is the rotation of disks."""

ROTATION_MATTERS = 0.02
"""Relative change of the speed of S waves from which on there is a warning that disks do not rotate."""

_TOO_LARGE = {
    False: "the elastic law is for small strains, are the units right?",
    True: "rock and soil break at some 0.3 %, are the units right?",
}
"""Advice on large strains, by whether the law is history-dependent."""


def wave_warnings(scene: DiskScene, time_step: float) -> Iterator[str]:
    """Warnings about waves, one line each; time_step in s."""
    yield from _tension(scene)
    yield from _too_few_per_wavelength(scene)
    yield from _never_arrives(scene)
    yield from magnitudes.time_warnings(scene.case, time_step, _travel_time(scene))
    yield from _stress_beside_strength(scene)
    yield from _large_strains(scene)
    yield from _rotation_held(scene)


def _tension(scene: DiskScene) -> Iterator[str]:
    """Waves that would open real contacts, where the elastic law keeps them closed."""
    if scene.has_history or not _confinement(scene):  # a lattice is packed without stress; see the docs
        return
    for name, stress in strong_waves(scene).items():
        yield (
            f"wave.{name}: has a stress ρcv of {stress}; real contacts would open in tension, "
            "the elastic law keeps them closed"
        )


def strong_waves(scene: DiskScene) -> dict[str, str]:
    """Waves of boundaries whose stress ρcv exceeds the pressure on the contacts; both in words."""
    pressure = _confinement(scene)
    if pressure is None:
        return {}
    entering = scene.case.entering
    medium = boundary_medium(scene.ground.at(scene.case.box[1]), axis=0)
    impedance = medium.density * medium.p_wave_speed
    stresses = {name: impedance * wave.peak() for name, wave in scene.case.wave.items() if name in entering}
    return {
        name: f"{with_unit(stress, 'Pa')}, above the confining stress of {with_unit(pressure, 'Pa')}"
        for name, stress in stresses.items()
        if stress > pressure
    }


def _confinement(scene: DiskScene) -> float | None:
    """Pressure (Pa) on contacts at the start of the run; None if it results from the static stage."""
    static = scene.case.static
    if static is not None:
        return None if static.stress is None else 0.0 - 0.5 * (static.stress[0] + static.stress[1])
    return 0.0 if scene.has_history else scene.ground.packed_pressure


def _too_few_per_wavelength(scene: DiskScene) -> Iterator[str]:
    """Waves that are too short for the size of the particles, except for those of a slow grip."""
    travel = _travel_time(scene)
    for name, count in particles_per_wavelength(scene).items():
        if count < FEWEST_PER_WAVELENGTH and not magnitudes.is_quasi_static(scene.case, name, travel):
            wave = scene.case.wave[name]
            if isinstance(wave, Constant):
                yield f"wave.{name}: {_too_sudden(scene, wave)}; the packing will disperse it"
            else:
                yield f"wave.{name}: {_too_short(scene, wave, count)}"


def particles_per_wavelength(scene: DiskScene) -> dict[str, float]:
    """Shortest wavelength of waves in use, at their highest frequency and the scene's slowest speed, in diameters."""
    speed = slowest_speed(scene.ground)
    spacing = scene.ground.brick.mean_diameter
    return {
        name: speed / wave.highest_frequency() / spacing if np.isfinite(speed) else np.inf
        for name, wave in scene.case.wave.items()
        if name in magnitudes.waves_used(scene.case)
    }


def highest_carried(scene: DiskScene) -> float:
    """Frequency (Hz) up to which the disks carry waves: 20 particles in the slowest's wavelength; nan if none runs."""
    return slowest_speed(scene.ground) / (FEWEST_PER_WAVELENGTH * scene.ground.brick.mean_diameter)


def _too_short(scene: DiskScene, wave: Wave, count: float) -> str:
    """The problem of a wave with `count` particles in its shortest wavelength, and the share of its energy."""
    carried = highest_carried(scene)
    if count < 1.0:
        few = "has a shortest wavelength below the diameter of a particle"
    else:
        few = f"has {count:.1f} particles in its shortest wavelength, fewer than {FEWEST_PER_WAVELENGTH:g}"
    above = percent(share_above(wave, carried))
    return f"{few}: disks carry waves up to {with_unit(carried, 'Hz')}, and disperse {above} of its energy above"


def _too_sudden(scene: DiskScene, wave: Constant) -> str:
    """The problem of a constant that rises too fast for the particles, and a rise that is long enough, in words."""
    least = FEWEST_PER_WAVELENGTH * HANN_FADE * scene.ground.brick.mean_diameter / slowest_speed(scene.ground)
    rise = f"rises within {wave.rise:g} s" if wave.rise > 0.0 else "is a step (rise = 0)"
    return f"{rise}, which is shorter than the particles can follow, {least:.2g} s"


def _never_arrives(scene: DiskScene) -> Iterator[str]:
    """A warning about an oblique wave that does not reach the body before the run ends."""
    duration = scene.case.run.duration
    if scene.ground_waves is not None and (begin := arrival(scene, scene.ground_waves)) >= duration:
        yield f"incident: its wave reaches the disks at {begin:.4g} s only, after the end of the run at {duration:g} s"


def _travel_time(scene: DiskScene) -> float:
    """Time (s) the fastest wave takes along the scene's longer side; nan if no motion along it is possible."""
    axis = int(np.argmax(scene.size))
    times = []
    for side in ("left", "right"):
        fastest = [
            max((speed for speed in layer.wave_speeds(axis) if not math.isnan(speed)), default=math.nan)
            for layer in scene.ground.beside(side).materials
        ]
        if axis == 0 or len(fastest) == 1:
            times.append(float(scene.size[axis]) / max(fastest))
            continue
        _, bottom, _, top = scene.case.box
        times.append(float(sum(-np.diff([top, *scene.case.beside(side).layer_planes, bottom]) / fastest)))
    return max(times)


def _stress_beside_strength(scene: DiskScene) -> Iterator[str]:
    """Warnings about waves and loads whose stress is tiny or huge relative to the weakest bonds' tensile strength."""
    given = {own.key("pb_ten"): own.material.pb_ten for own in materials_of(scene) if own.material.pb_ten is not None}
    if not given:
        return
    (key, strength), static = min(given.items(), key=lambda item: item[1]), scene.case.static
    stresses: dict[str, tuple[str, float]] = {}
    for name, what, stress in _wave_stresses(scene, strength):
        if stress > stresses.get(name, ("", 0.0))[1]:  # a wave may drive several sides
            stresses[name] = (what, stress)
    for load in scene.case.load:
        stresses[f"load.{load.name}"] = _load_stress(scene, load)
    if static is not None and static.stress is not None:
        stresses["static.stress"] = ("its largest component", max(map(abs, static.stress)))
    yield from magnitudes.stress_warnings(stresses, strength, key)


def _wave_stresses(scene: DiskScene, strength: float) -> Iterator[tuple[str, str, float]]:
    """For every wave on every side it drives: its table, description and value (Pa) of its largest stress."""
    for edge in scene.edges.values():
        table = scene.case.side(edge.side)
        grips = set(table.prescribed(edge.axis))
        medium, length = medium_of_side(scene, edge.side), float(scene.size[edge.axis])
        for motion, name in table.waves.items():
            wave, speed = scene.case.wave[name], medium.p_wave_speed if motion == "p" else medium.s_wave_speed
            if axis_of_motion(edge.side, motion) in grips:
                yield (
                    f"wave.{name}",
                    *magnitudes.grip_stress(wave, medium.density, speed, length, scene.case.run.duration, strength),
                )
            else:
                yield f"wave.{name}", "its stress ρcv", medium.density * speed * wave.peak()
    if (incident := scene.case.incident) is not None:
        ground = scene.ground.at(scene.case.box[1])
        speed = ground.wave_speeds(1)[0 if incident.type == "p" else 1]
        peak = scene.case.wave[incident.wave].peak()
        yield f"wave.{incident.wave}", "its stress ρcv", ground.density * speed * peak


def _load_stress(scene: DiskScene, load: Load) -> tuple[str, float]:
    """Description and value (Pa) of the stress of a load: ρaL, a pressure, or the force over the width it acts on."""
    factor = 1.0 if load.wave is None else scene.case.wave[load.wave].peak()
    if load.pressure is not None:
        return "its pressure", abs(load.pressure) * factor
    size = scene.size if load.region is None else np.subtract(load.region[2:], load.region[:2])
    extent = np.abs(load.vector) * factor
    if load.acceleration is not None:
        density = max(layer.density for layer in scene.ground.materials)
        return "its stress ρaL", float(density * (extent * size).max())
    widths = size[::-1] if load.region is not None else np.full(2, scene.ground.brick.mean_diameter)
    return "its force over the width it acts on", float((extent / widths).max())


def _entering_speeds(scene: DiskScene) -> dict[str, tuple[str, float]]:
    """For every wave that enters its slowest part in words, such as "P waves along x", and its least speed (m/s)."""
    found: dict[str, tuple[str, float]] = {}
    ways: list[tuple[int, str, str]] = [
        (normal_axis(side), motion, name) for side, each in scene.case.driving.items() for motion, name in each.items()
    ]
    if (incident := scene.case.incident) is not None:
        ways.append((1, incident.type, incident.wave))
    for axis, motion, name in ways:
        speed = min(layer.wave_speeds(axis)[0 if motion == "p" else 1] for layer in scene.ground.materials)
        if not speed >= found.get(name, ("", math.inf))[1] and not math.isnan(speed):
            found[name] = f"{motion.upper()} waves along {'xy'[axis]}", speed
    return found


def _large_strains(scene: DiskScene) -> Iterator[str]:
    """Waves, loads and strengths whose strains are far beyond those of solids; none of ground without stiffness."""
    if not scene.ground.has_stiffness:
        return
    moduli = [float(np.diag(layer.material_tensor)[:2].min()) for layer in scene.ground.materials]
    reason, owns = _TOO_LARGE[scene.has_history], list(materials_of(scene))
    for name, (words, speed) in sorted(_entering_speeds(scene).items()):
        wave, place = scene.case.wave[name], f"wave.{name}"
        strained = list(magnitudes.large_velocity(place, wave.peak(), speed, reason, words))
        yield from strained or magnitudes.fast_ground(place, wave)
    compared = scene.has_history and any(own.material.pb_ten is not None for own in owns)  # with the strength
    for load in () if compared else scene.case.load:
        what, stress = _load_stress(scene, load)
        yield from magnitudes.large_stress(f"load.{load.name}: {what}", stress, min(moduli), reason)
    if (static := scene.case.static) is not None and static.stress is not None:
        xx, yy, xy = static.stress
        largest = abs(0.5 * (xx + yy)) + float(np.hypot(0.5 * (xx - yy), xy))
        yield from magnitudes.large_stress("static.stress: its largest principal stress", largest, min(moduli), reason)
    strengths = {
        own.key(key): (strength, modulus)
        for modulus, own in sorted(zip(moduli, owns, strict=True), key=lambda each: -each[0])  # the softest layer last
        for key, strength in (("pb_ten", own.material.pb_ten), ("pb_coh", own.material.pb_coh))
        if strength is not None
    }
    for key, (strength, modulus) in strengths.items():
        yield from magnitudes.large_stress(f"{key}:", strength, modulus, _TOO_LARGE[True])


def _rotation_held(scene: DiskScene) -> Iterator[str]:
    """A body that shears while its disks do not turn, by which its S waves are faster."""
    ground = scene.ground
    if ROTATION not in ground.held:
        return
    turning = replace(ground, held=tuple(component for component in ground.held if component != ROTATION))
    for axis in filter(lambda axis: _shears(scene, axis), (0, 1)):
        held, p_speed = ground.wave_speeds(axis)[1], replace(ground, held=(ROTATION,)).wave_speeds(axis)[0]
        try:
            free = turning.wave_speeds(axis)[1]
        except CaseError:  # nothing resists rotations
            free = math.nan
        if np.isfinite(held) and not abs(held / free - 1.0) < ROTATION_MATTERS:
            known = f"{free:.4g} m/s, {percent(1.0 - free / held)} less" if np.isfinite(free) else "no speed"
            yield (
                f"motion.held: holds rotation in a body that shears: S waves along {'xy'[axis]} run at {held:.4g} "
                f"m/s, beside P waves of {p_speed:.4g} m/s; where disks turn they have {known}"
            )
            return


def _shears(scene: DiskScene, axis: int) -> bool:
    """Whether motion across an axis may vary along it: sides or loads hold or push a part of the body."""
    case, translations = scene.case, [component for component in scene.ground.held if component != ROTATION]
    if 1 - axis in translations:
        return False
    sides = {edge.side: case.side(edge.side) for edge in scene.edges.values()}
    ends = [table for side, table in sides.items() if normal_axis(side) == axis and not table.is_free]
    if translations:  # all motion is across the axis: else the body moves as a row of bars
        return bool(ends) or any(not _spans(scene, load, axis) for load in case.load)
    if len({normal_axis(side) for side in sides}) > 1 or case.holes or case.load:
        return True
    return any(normal_axis(side) == axis and "s" in table.waves for side, table in sides.items())  # plane waves


def _spans(scene: DiskScene, load: Load, axis: int) -> bool:
    """Whether a load acts on all disks along an axis alike."""
    if load.is_everywhere:
        return True
    return load.region is not None and spans_all(load.region, scene.case.packing.box, axis)
