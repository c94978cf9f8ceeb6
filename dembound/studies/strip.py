"""The scene of a calibration: the case under one pulse, no larger than necessary; what a side returns of it."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from dembound.boundaries.boundary import Boundary
from dembound.boundaries.edge import OPPOSITE, Motion, axis_of_motion, normal_axis
from dembound.boundaries.periodic import Periodic
from dembound.boundaries.velocity import Velocity
from dembound.casefile.disks.load import Monitor
from dembound.casefile.disks.model import DiskCase
from dembound.casefile.types import linear_law
from dembound.disks.material.layered import LayeredGround
from dembound.disks.scene import build, ground_of
from dembound.disks.sides import boundary_medium
from dembound.disks.small_motion import small_motion
from dembound.disks.stability import choose_step
from dembound.errors import CaseError
from dembound.motion.simulation import Simulation
from dembound.waves.cosine import Cosine

PULSE = "calibration"
STRIP = 0.35
"""Strip length in pulse lengths cT. The front is T/2 before the peak and needs 2L/c for an echo; a pass ends AFTER
the peak, 0.6 T after the front, so with L > 0.3 cT no echo affects M_out; a sixth is added as a reserve."""

ALIKE = 1e-3
"""Relative difference of factors of layers up to which one serves all, as many as the tolerance of a calibration."""

AFTER = 0.1
"""Time from the expected peak at the side to the end of a pass, in pulse lengths T, as the peak may be late."""


def _waves_of(case: DiskCase, motion: Motion) -> Iterator[str]:
    """Names of the waves that drive this kind of motion, then of all others."""
    for table in case.boundary.values():
        if motion in table.waves:
            yield table.waves[motion]
    yield from case.wave


def calibration_pulse(case: DiskCase, side: str, motion: Motion) -> Cosine:
    """The calibrating pulse: a cosine with the peak and dominant period of the case's own wave.

    Without a usable wave: 1 m/s and a length of 200 mean diameters.
    """
    for name in _waves_of(case, motion):
        wave = case.wave[name]
        frequency = wave.dominant_frequency()
        if np.isfinite(frequency) and frequency > 0.0:
            return Cosine(type="cosine", amplitude=wave.peak(), period=1.0 / frequency)
    speed = _speed_of(case, normal_axis(side), motion)
    return Cosine(type="cosine", amplitude=1.0, period=400.0 * case.packing.radius / speed)


def in_one_layer(case: DiskCase, side: str, motion: Motion) -> tuple[DiskCase, list[str]]:
    """The case with the slowest layer at a side everywhere, and a sentence on this; in uniform ground the case itself.

    Raises CaseError where factors β that suit the layers along the side differ by more than `ALIKE`.
    """
    case = case.beside("right" if side == "right" else "left")
    ground, axis, number = ground_of(case), normal_axis(side), 0 if motion == "p" else 1
    if not isinstance(ground, LayeredGround):
        return case, []
    box = case.packing.box
    ends = {"bottom": (box[1], box[1]), "top": (box[3], box[3])}.get(side, (box[1], box[3]))
    heights = [0.5 * (max(low, ends[0]) + min(high, ends[1])) for low, high, *_ in ground.layers if low <= ends[1]]
    heights = [height for height in heights if ends[0] <= height <= ends[1]]
    speeds = {height: ground.at(height).wave_speeds(axis)[number] for height in heights}
    ratios = {}
    for height, speed in speeds.items():
        medium = boundary_medium(ground.at(height), axis)
        name = case.layer_names[case.layer_at(height)]
        ratios[name] = speed / (medium.p_wave_speed if motion == "p" else medium.s_wave_speed)
    if max(ratios.values()) > (1.0 + ALIKE) * min(ratios.values()):
        each = ", ".join(f"{name} {ratio:.4g}" for name, ratio in reversed(ratios.items()))
        what = f"its layers have different wave speeds over those given ({each})"
        raise CaseError([f'boundary.{side}.beta_{motion}: {what}, and no number suits all; write "matched"'])
    slowest = min(speeds, key=lambda height: speeds[height])
    name = case.layer_names[case.layer_at(slowest)]
    return case.uniform_at(slowest), [f"the layer {name} everywhere; β multiplies ρc of each layer"]


def linear_medium(case: DiskCase) -> tuple[DiskCase, list[str]]:
    """The case reduced to dashpots on a linear medium, for which β is defined, and sentences about what was left out.

    Springs reflect for any β; seam forces of a column depend on the wave; holes scatter; loads, a static stage and a
    history-dependent law cause motion that does not belong to the wave.

    Raises CaseError for a law that is not linear.
    """
    given, case = case, small_motion(case)
    boundary = {side: table.dashpots_alone() for side, table in case.boundary.items()}
    material = case.material.model_copy(update={"law": linear_law(case.material.law)})
    left_out = {
        **{table.beyond_dashpots: True for table in case.boundary.values() if table.beyond_dashpots},
        "no groups": bool(case.group),
        "no holes": bool(case.holes),
        "no static stage": given.static is not None,
        "no walls": bool(case.wall),
        "no loads": bool(case.load),
        f"the {material.law} law": given.material.law != material.law,
    }
    none: dict[str, Any] = dict.fromkeys(("group", "hole", "wall", "joint", "load"), ())
    plain = replace(case, boundary=boundary, material=material, static=None, ground=case.ground.level(), **none)
    return plain, [sentence for sentence, applies in left_out.items() if applies]


def driven(case: DiskCase, side: str, motion: Motion, pulse: Cosine) -> DiskCase:
    """The case with the pulse as its only wave: sent from the opposite side, or from an input side itself."""
    boundary = {name: table.at_rest() for name, table in case.boundary.items()}
    table = case.boundary[side]
    if table.waves:
        boundary[side] = table.driven_by({motion: PULSE})
    else:
        boundary[OPPOSITE[side]] = Velocity.model_validate({"type": "velocity", f"wave_{motion}": PULSE})
    return replace(case, boundary=boundary, wave={PULSE: pulse}, monitor=())


def _least_length(case: DiskCase, axis: int, motion: Motion, pulse: Cosine) -> float:
    """Length (m) along the normal with which no echo affects M_out."""
    return STRIP * _speed_of(case, axis, motion) * pulse.period


def full_scene(case: DiskCase, side: str, motion: Motion, pulse: Cosine) -> tuple[DiskCase, list[str]]:
    """The whole scene, if it is long enough to calibrate on."""
    axis = normal_axis(side)
    least, length = _least_length(case, axis, motion, pulse), case.packing.extent[axis]
    if length < least:
        late = f"echoes need {least:.4g} m to come late enough"
        raise CaseError([f"--full: the scene is {length:g} m long, {late}; leave it out"])
    return driven(case, side, motion, pulse), ["each pass ends once the peak has left the side"]


def short_strip(case: DiskCase, side: str, motion: Motion, pulse: Cosine) -> tuple[DiskCase, list[str]]:
    """The smallest scene that gives M_out, and sentences about its differences from the scene of the case.

    Long sides that are free stay where P waves run, as a bar is softer than the ground and its side has other disks,
    and where motion across is held. Between others plane waves are taken, periodic sideways; S waves bend a bar.
    """
    case = driven(case, side, motion, pulse)
    axis = normal_axis(side)
    plane = motion == "p" or "xy"[1 - axis] in case.motion.held
    keeps = plane and all(table.is_free for table in _beside(case, axis))
    strip = in_strip(case, axis, _least_length(case, axis, motion, pulse), keeps)
    shortened = [
        f"a strip of {strip.packing.extent[axis]:g} m, the scene has {case.packing.extent[axis]:g} m",
        "each pass ends once the peak has left the side",
    ]
    periodic = all(table.is_periodic for table in _beside(case, axis))
    if not keeps and not (periodic and case.packing.copies[1 - axis] == 1):
        shortened.append("one brick wide and periodic sideways")
    return strip, shortened


def in_strip(case: DiskCase, axis: int, length: float, keeps: bool | None = None) -> DiskCase:
    """The case with bricks of at least this length (m) along an axis.

    keeps : whether it keeps its long sides and width, by default where neither of them absorbs; else it is one brick
    wide and periodic sideways.
    """
    lateral, bricks = ("bottom", "top") if axis == 0 else ("left", "right"), list(case.packing.copies)
    bricks[axis] = max(1, int(np.ceil(length / case.packing.brick_size[axis])))
    keeps = not any(table.absorbs for table in _beside(case, axis)) if keeps is None else keeps
    if not keeps or all(table.is_periodic for table in _beside(case, axis)):
        case = replace(case, boundary={**case.boundary, **{name: Periodic(type="periodic") for name in lateral}})
        bricks[1 - axis] = 1
    return replace(case, packing=case.packing.with_copies(bricks[0], bricks[1]))


def _beside(case: DiskCase, axis: int) -> list[Boundary]:
    """The tables of the sides along an axis."""
    return [case.side(name) for name in (("bottom", "top") if axis == 0 else ("left", "right"))]


def _speed_of(case: DiskCase, axis: int, motion: Motion) -> float:
    """The wave speed (m/s) of the packing along an axis."""
    return ground_of(case).wave_speeds(axis)[0 if motion == "p" else 1]


def with_beta(case: DiskCase, side: str, motion: Motion, beta: float) -> DiskCase:
    """The case with another factor of a side."""
    return replace(case, boundary={**case.boundary, side: case.side(side).with_factors({motion: beta})})


DEEP, LONG, WINDOW = 0.1, 0.65, 1.1
"""Depth of the section, length of the strip in pulse lengths cT, and time for the pulse and what returns, in T.

Of a strip of L > WINDOW/2 + DEEP nothing comes back from the driven end to the section, and of the body of 2L nothing
from its far end, before the time (L + DEEP) T + WINDOW T at which what the side returns has passed."""

PLACES = 16
"""Monitors across the section, over which motion is averaged."""


def returned(case: DiskCase, side: str, motion: Motion, pulse: Cosine, betas: Sequence[float]) -> list[float]:
    """Returned over incident velocity, RMS over RMS, for each factor of a side; case : from `linear_medium`.

    Raises the errors of `build` and of runs.
    """
    axis = normal_axis(side)
    tables = {**case.boundary, side: case.side(side).at_rest()}
    case = driven(replace(case, boundary=tables), side, motion, pulse)
    length = _speed_of(case, axis, motion) * pulse.period
    strip = in_strip(case, axis, LONG * length)
    duration = (strip.packing.extent[axis] / length + DEEP + WINDOW) * pulse.period
    copies = list(strip.packing.copies)
    copies[axis] *= 2
    farther = replace(strip, packing=strip.packing.with_copies(copies[0], copies[1]))
    within = strip.packing.extent[axis] - DEEP * length
    time, incident = _at_section(farther, side, motion, within, duration)
    found = []
    for beta in betas:
        own, values = _at_section(with_beta(strip, side, motion, beta), side, motion, within, duration)
        found.append(float(np.linalg.norm(np.interp(time, own, values) - incident) / np.linalg.norm(incident)))
    return found


def _at_section(
    case: DiskCase, side: str, motion: Motion, within: float, duration: float
) -> tuple[np.ndarray, np.ndarray]:
    """Times (k,) s up to a duration (s), and the mean velocity (k,) m/s over the section.

    within : its distance from the driven end, m.
    """
    scene = build(replace(case, monitor=tuple(_section(case, side, within))))
    step, _ = choose_step(scene)
    steps = int(np.ceil(duration / step))
    record = Simulation(scene, step, np.array(list(scene.monitors.values()))).advance(steps)
    return step * np.arange(len(record)), record[:, :, 3 + axis_of_motion(side, motion)].mean(axis=1)


def _section(case: DiskCase, side: str, within: float) -> Iterator[Monitor]:
    """Monitors across the body at a distance (m) from the end opposite of a side."""
    axis, box = normal_axis(side), np.reshape(case.packing.box, (2, 2))
    place = np.empty(2)
    place[axis] = box[0, axis] + within if side in ("right", "top") else box[1, axis] - within
    for k in range(PLACES):
        place[1 - axis] = box[0, 1 - axis] + (k + 0.5) / PLACES * (box[1] - box[0])[1 - axis]
        yield Monitor(name=f"section_{k}", position=(float(place[0]), float(place[1])))
