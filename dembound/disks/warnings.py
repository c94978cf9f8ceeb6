"""Warnings about probable mistakes in a case of disks, before and after the run."""

import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from dembound.boundaries import SIDES, Motion, axis_of_motion
from dembound.casefile.disks.load import Load
from dembound.casefile.magnitudes import grip_stress, is_quasi_static, stress_in_words, stress_warnings, time_warnings
from dembound.casefile.messages import numbered
from dembound.disks.continuum_facts import continuum_warnings
from dembound.disks.incident_facts import arrival
from dembound.disks.matching import homogenised_beta, reflected
from dembound.disks.near_ties import near_tie_warnings
from dembound.disks.scene import DiskScene, boundary_medium
from dembound.results.reader import cracks_until, open_record
from dembound.results.warnings import still_moving
from dembound.waves.constant import Constant
from dembound.waves.spectrum import HANN_FADE

FEWEST_PER_WAVELENGTH = 20.0
"""Below this many particles per wavelength the lattice's phase error (qa)²/24 exceeds 0.4 %."""

REFLECTED = 0.02
"""Share of a wave that a side with default factors may reflect without a warning.

Homogenised and calibrated β differ by 0.5 % at most, 2 % in bars of 20 disks, which is half of that in the reflection.
"""

LARGEST_PULL = 3.5
"""Largest tensile stress of a bond over the mean one, where contacts under a locked-in stress relax.

The mean is the bonds' share of the stiffness times the locked-in pressure; the largest of 1,900 bonds was 2.8 to 3.5
times that (three bricks, radius ratio 1.5).
"""

SPEED_ERROR = 0.1
"""Share by which the P-wave speed of the packing may differ from the given one without a warning."""


AT_REST = 1e-14
"""Velocity over that of waves, so strain, below which the motion of a settled body is rounding.

Settled strains of 1e-6 to 1e-2 are known to 1e-16 of themselves; slopes under their weight move by 1e-17.
"""

LARGE_STRAIN = 0.03
"""Strain of a wave, velocity over that of the wave, or stress over stiffness, above which the elastic law is not valid.

Its error is of the order of the strain. Rock and soil break at a tenth of this, so larger ones are mostly wrong units.
"""


def disk_warnings(scene: DiskScene, time_step: float) -> list[str]:
    """All of them, one line each; time_step in s."""
    return [
        *_empty_holes(scene),
        *_steady_without_static(scene),
        *_locked_in(scene),
        *_settles_in_tension(scene),
        *_tension(scene),
        *_too_few_per_wavelength(scene),
        *_never_arrives(scene),
        *time_warnings(scene.case, time_step, _travel_time(scene)),
        *_stress_beside_strength(scene),
        *_large_strains(scene),
        *_default_factors(scene),
        *_speed_of_the_packing(scene),
        *continuum_warnings(scene, scene.case.run.duration / time_step),
    ]


def _empty_holes(scene: DiskScene) -> Iterator[str]:
    """Holes that remove no disk, as none of the packing is centred in them."""
    brick, (left, bottom, right, top) = scene.ground.brick, scene.case.packing.box
    origin = np.array([left, bottom])
    for place, hole in numbered("hole", scene.case.hole):
        x0, y0, x1, y1 = hole.box
        low, high = np.array([max(x0, left), max(y0, bottom)]), np.array([min(x1, right), min(y1, top)])
        first, last = np.floor((low - origin) / brick.size), np.floor((high - origin) / brick.size)
        last = np.minimum(last, np.array(scene.case.packing.copies) - (not brick.edge_rows.any()))
        across, up = (np.arange(begin, end + 1.0) for begin, end in zip(first, last, strict=True))
        tiles = np.stack(np.meshgrid(across, up), axis=-1).reshape(-1, 1, 2)
        if not hole.contains((origin + tiles * brick.size + brick.positions).reshape(-1, 2)).any():
            yield f"{place}: no particle is centred in it, so it removes none"


def _steady_without_static(scene: DiskScene) -> Iterator[str]:
    """Steady loads that act suddenly, as there is no static stage."""
    if scene.case.static is not None:
        return
    for load in scene.case.load:
        if load.wave is None:
            yield f"load.{load.name}: is steady, and without [static] acts suddenly at t = 0{_gives_way(scene, load)}"


def _never_arrives(scene: DiskScene) -> Iterator[str]:
    """A wave at an angle that is not in the body before the run ends."""
    duration = scene.case.run.duration
    if scene.ground_waves is not None and (begin := arrival(scene, scene.ground_waves)) >= duration:
        yield f"incident: its wave reaches the disks at {begin:.4g} s only, after the end of the run at {duration:g} s"


def _gives_way(scene: DiskScene, load: Load) -> str:
    """What does not come to rest under a load that stays, in words."""
    tables = scene.case.boundary.values()
    if any(table.factors for table in tables):
        return "; viscous sides creep under it"
    if any(table.is_outside for table in tables) and load.position is None and load.region is None:
        return "; the ground beyond the sides, of which nothing is held, moves under it as long as the run lasts"
    return ""


def _locked_in(scene: DiskScene) -> Iterator[str]:
    """Locked-in stress that breaks bonds where it relaxes."""
    material = scene.case.material
    cut = not all(scene.case.side(side).is_periodic for side in SIDES)
    if material.locked_in is None or material.pb_ten is None or not cut:
        return
    pulled = LARGEST_PULL * scene.ground.bond_share * material.locked_in
    if pulled > material.pb_ten:
        yield (
            f"material.locked_in: is {material.locked_in / 1e6:.3g} MPa; where it relaxes, the largest bond stress is "
            f"about {pulled / 1e6:.3g} MPa of tension, above material.pb_ten = {material.pb_ten / 1e6:.3g} MPa, and "
            "break in the static stage"
        )


def _settles_in_tension(scene: DiskScene) -> Iterator[str]:
    """A stress to settle under whose largest principal stress is a tension above the bonds' strength."""
    static, strength = scene.case.static, scene.case.material.pb_ten
    if static is None or static.stress is None or strength is None:
        return
    xx, yy, xy = static.stress
    largest = 0.5 * (xx + yy) + math.hypot(0.5 * (xx - yy), xy)
    if largest > strength:
        yield (
            f"static.stress: has a tension of {stress_in_words(largest)}, above material.pb_ten = "
            f"{stress_in_words(strength)}; bonds break in the static stage"
        )


def _tension(scene: DiskScene) -> Iterator[str]:
    """Waves that would open real contacts, where the elastic law keeps them closed."""
    if scene.has_history or not _confinement(scene):  # a lattice is packed without stress; see the docs
        return
    for name, stress in strong_waves(scene).items():
        yield (
            f"wave.{name}: has a stress ρcv of {stress}; real contacts would open in tension, "
            "the elastic law keeps them closed"
        )


def _too_few_per_wavelength(scene: DiskScene) -> Iterator[str]:
    """Waves that are too short for the size of the particles, except for those of a slow grip."""
    travel = _travel_time(scene)
    for name, count in particles_per_wavelength(scene).items():
        if count < FEWEST_PER_WAVELENGTH and not is_quasi_static(scene.case, name, travel):
            wave = scene.case.wave[name]
            words = _too_sudden(scene, wave) if isinstance(wave, Constant) else _too_short(count)
            yield f"wave.{name}: {words}; the packing will disperse it"


def _too_short(count: float) -> str:
    """What is wrong with a wave with this number of particles in its shortest wavelength."""
    if count < 1.0:
        return "has a shortest wavelength below the diameter of a particle"
    return f"has {count:.1f} particles in its shortest wavelength, fewer than {FEWEST_PER_WAVELENGTH:g}"


def _too_sudden(scene: DiskScene, wave: Constant) -> str:
    """What is wrong with a constant that rises too fast for the particles, and which rise is long enough."""
    least = FEWEST_PER_WAVELENGTH * HANN_FADE * scene.ground.brick.mean_diameter / _slowest(scene)
    rise = f"rises within {wave.rise:g} s" if wave.rise > 0.0 else "is a step (rise = 0)"
    return f"{rise}, which is shorter than the particles can follow, {least:.2g} s"


def _stress_beside_strength(scene: DiskScene) -> Iterator[str]:
    """Waves and loads whose stress is a very small part, or a large multiple, of the bonds' tensile strength."""
    strength, static = scene.case.material.pb_ten, scene.case.static
    if strength is None:
        return
    stresses: dict[str, tuple[str, float]] = {}
    for name, what, stress in _wave_stresses(scene, strength):
        if stress > stresses.get(name, ("", 0.0))[1]:  # a wave may drive several sides
            stresses[name] = (what, stress)
    for load in scene.case.load:
        stresses[f"load.{load.name}"] = _load_stress(scene, load)
    if static is not None and static.stress is not None:
        stresses["static.stress"] = ("its largest component", max(map(abs, static.stress)))
    yield from stress_warnings(stresses, strength, "material.pb_ten")


def _large_strains(scene: DiskScene) -> Iterator[str]:
    """Waves and loads whose strains are far beyond those that the elastic law is for."""
    if scene.has_history:
        return
    modulus = float(np.diag(scene.ground.material_tensor)[:2].min())
    stresses = [(f"load.{load.name}", *_load_stress(scene, load)) for load in scene.case.load]
    slowest = _slowest(scene)
    for name in sorted(scene.case.entering):
        peak = scene.case.wave[name].peak()
        if peak > LARGE_STRAIN * slowest:
            yield (
                f"wave.{name}: its velocity, {peak:.3g} m/s, is {100.0 * peak / slowest:.2g} % of that of waves, "
                f"{slowest:.4g} m/s, and so are strains; {_TOO_LARGE}"
            )
    for where, what, stress in stresses:
        if stress > LARGE_STRAIN * modulus:
            yield (
                f"{where}: {what}, {stress_in_words(stress)}, is {100.0 * stress / modulus:.2g} % of the stiffness, "
                f"{stress_in_words(modulus)}, and so are strains; {_TOO_LARGE}"
            )


_TOO_LARGE = "the elastic law is for small ones, are the units right?"


def _wave_stresses(scene: DiskScene, strength: float) -> Iterator[tuple[str, str, float]]:
    """For every wave on every side it drives: its table, description and value (Pa) of its largest stress."""
    for edge in scene.edges.values():
        table = scene.case.side(edge.side)
        grips = set(table.prescribed(edge.axis))
        medium, length = boundary_medium(scene.case, scene.ground, edge.axis), float(scene.size[edge.axis])
        for motion, name in table.waves.items():
            wave, speed = scene.case.wave[name], medium.p_wave_speed if motion == "p" else medium.s_wave_speed
            if axis_of_motion(edge.side, motion) in grips:
                yield (
                    f"wave.{name}",
                    *grip_stress(wave, medium.density, speed, length, scene.case.run.duration, strength),
                )
            else:
                yield f"wave.{name}", "its stress ρcv", medium.density * speed * wave.peak()
    if (incident := scene.case.incident) is not None:
        speed = scene.ground.wave_speeds(1)[0 if incident.type == "p" else 1]
        peak = scene.case.wave[incident.wave].peak()
        yield f"wave.{incident.wave}", "its stress ρcv", scene.ground.density * speed * peak


def _load_stress(scene: DiskScene, load: Load) -> tuple[str, float]:
    """Description and value (Pa) of the stress of a load: ρaL, a pressure, or the force over the width it acts on."""
    factor = 1.0 if load.wave is None else scene.case.wave[load.wave].peak()
    if load.pressure is not None:
        return "its pressure", abs(load.pressure) * factor
    low, high = np.zeros(2), scene.size
    if load.region is not None:
        low, high = np.array(load.region[:2]), np.array(load.region[2:])
    extent = np.abs(load.vector) * factor
    if load.acceleration is not None:
        return "its stress ρaL", float(scene.ground.density * (extent * (high - low)).max())
    widths = (high - low)[::-1] if load.region is not None else np.full(2, scene.ground.brick.mean_diameter)
    return "its force over the width it acts on", float((extent / widths).max())


def _default_factors(scene: DiskScene) -> Iterator[str]:
    """Sides with default factors on packings that need other factors."""
    wrong = {side: found for side in scene.edges if (found := _factors_off(scene, side))}
    each = [f"--boundary {side} --wave {motion}" for side, found in wrong.items() for motion in found]
    which = "--all" if len(each) > 1 else "".join(each)
    for side, found in wrong.items():
        factors = scene.case.side(side).factors
        waves = " and ".join(
            f"{100.0 * abs(reflected(factors[motion], matched)):.2g} % of {motion.upper()}"
            for motion, matched in found.items()
        )
        defaults = " and ".join(
            f"beta_{motion} = {factors[motion]:g} (matched: about {matched:.3g})" for motion, matched in found.items()
        )
        yield (
            f"boundary.{side}: reflects {waves} waves with the default {defaults}; "
            f"run: dembound calibrate {scene.case.file or 'CASE'} {which}"
        )


def _factors_off(scene: DiskScene, side: str) -> dict[Motion, float]:
    """Kinds of waves whose factor of a side is the default and reflects too much -> the matched factor."""
    table = scene.case.side(side)
    matched = {
        motion: homogenised_beta(scene, side, motion)
        for motion in table.factors
        if f"beta_{motion}" not in table.model_fields_set
    }
    return {
        motion: beta
        for motion, beta in matched.items()
        if abs(reflected(table.factors[motion], beta)) > REFLECTED  # nan where the motion is held
    }


def _speed_of_the_packing(scene: DiskScene) -> Iterator[str]:
    """A given wave speed that holds for the square lattice but not for the packing."""
    material = scene.case.material
    if material.p_wave_speed is None or material.match == "assembly":
        return
    for axis in _axes_in_use(scene):
        own = scene.ground.wave_speeds(axis)[0]
        if abs(own / material.p_wave_speed - 1.0) > SPEED_ERROR:  # nan where the motion is held
            yield (
                f"material.p_wave_speed: is {material.p_wave_speed:g} m/s of the square lattice; P waves along "
                f'{"xy"[axis]} run at {own:.4g} m/s in this packing; give match = "assembly"'
            )
            return


def _axes_in_use(scene: DiskScene) -> list[int]:
    """Axes along which waves run: x, and y if waves enter through bottom or top, or come from loads."""
    vertical = any(scene.case.side(edge.side).waves for edge in scene.edges.values() if edge.axis == 1)
    return [0, 1] if vertical or scene.case.load or scene.case.incident else [0]


def _travel_time(scene: DiskScene) -> float:
    """Time (s) the fastest wave takes along the scene's longer side; nan if no motion along it is possible."""
    axis = int(np.argmax(scene.size))
    speeds = [speed for speed in scene.ground.wave_speeds(axis) if not math.isnan(speed)]
    return float(scene.size[axis]) / max(speeds, default=math.nan)


def particles_per_wavelength(scene: DiskScene) -> dict[str, float]:
    """Shortest wavelength of every wave, at its highest frequency and the scene's slowest speed, in diameters."""
    speed = _slowest(scene)
    spacing = scene.ground.brick.mean_diameter
    return {
        name: speed / wave.highest_frequency() / spacing if np.isfinite(speed) else np.inf
        for name, wave in scene.case.wave.items()
    }


def _slowest(scene: DiskScene) -> float:
    """Lowest wave speed of the scene along x or y, m/s; inf if no motion is possible."""
    speeds = [speed for axis in (0, 1) for speed in scene.ground.wave_speeds(axis) if np.isfinite(speed)]
    return min(speeds, default=np.inf)


def strong_waves(scene: DiskScene) -> dict[str, str]:
    """Waves of boundaries whose stress ρcv exceeds the pressure on the contacts; both in words."""
    pressure = _confinement(scene)
    if pressure is None:
        return {}
    entering = scene.case.entering
    medium = boundary_medium(scene.case, scene.ground, axis=0)
    impedance = medium.density * medium.p_wave_speed
    stresses = {name: impedance * wave.peak() for name, wave in scene.case.wave.items() if name in entering}
    return {
        name: f"{stress / 1e6:.3g} MPa, above the confining stress of {pressure / 1e6:.3g} MPa"
        for name, stress in stresses.items()
        if stress > pressure
    }


def _confinement(scene: DiskScene) -> float | None:
    """Pressure (Pa) on contacts at the start of the run; None if it results from the static stage."""
    static = scene.case.static
    if static is not None:
        return None if static.stress is None else 0.0 - 0.5 * (static.stress[0] + static.stress[1])
    return 0.0 if scene.has_history else scene.ground.packed_pressure


def warnings_after_disks(scene: DiskScene, summary: Mapping[str, Any], record: Path) -> list[str]:
    """Warnings from the summary and record of a run of disks, one line each."""
    with open_record(record) as file:
        cracks = cracks_until(file, np.inf)
        at_rest = 0.0 if scene.case.static is None else AT_REST * _slowest(scene)
        moving = still_moving(scene, summary["duration"], file, _pieces(scene, cracks["particles"]), at_rest)
        return [*moving, *near_tie_warnings(scene, summary, cracks)]


def _pieces(scene: DiskScene, broken: np.ndarray) -> np.ndarray:
    """Number (n,) of the piece of each particle; pieces are connected by pairs of the start that have not broken.

    broken (k, 2) particles; without any, the body is in one piece, as built.
    """
    if len(broken) == 0:
        return np.zeros(scene.disk_count, dtype=np.int8)
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    pairs = scene.assembly.pairs
    listed, gone = (np.sort(each.astype(np.int64), axis=1) @ [scene.disk_count, 1] for each in (pairs, broken))
    pairs = pairs[~np.isin(listed, gone)]
    joined = coo_matrix((np.ones(len(pairs), np.int8), tuple(pairs.T)), shape=(scene.disk_count, scene.disk_count))
    return connected_components(joined, directed=False)[1]
