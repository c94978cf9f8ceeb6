"""What a side returns of a pulse with given factors β, beside the same body that goes on beyond the side.

The pulse runs along the normal towards the side, from the opposite one; an input side absorbs, too, as its β0 is the
same. The mean motion over a section near the side, less that in a body twice as long, is what the side returned:
scattering by disks and dispersion on the way are in both.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from dembound.boundaries import Motion, axis_of_motion, normal_axis
from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.monitor import Monitor
from dembound.disks.scene import build, ground_of
from dembound.disks.stability import choose_step
from dembound.motion.simulation import Simulation
from dembound.studies.strip import driven, in_strip
from dembound.waves import Cosine

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
    length = ground_of(case).wave_speeds(axis)[0 if motion == "p" else 1] * pulse.period
    strip = in_strip(case, axis, LONG * length)
    duration = (strip.packing.extent[axis] / length + DEEP + WINDOW) * pulse.period
    copies = list(strip.packing.copies)
    copies[axis] *= 2
    farther = replace(strip, packing=strip.packing.with_copies(copies[0], copies[1]))
    within = strip.packing.extent[axis] - DEEP * length
    time, incident = _at_section(farther, side, motion, within, duration)
    found = []
    for beta in betas:
        table = strip.side(side).with_factors({motion: beta})
        trial = replace(strip, boundary={**strip.boundary, side: table})
        own, values = _at_section(trial, side, motion, within, duration)
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
