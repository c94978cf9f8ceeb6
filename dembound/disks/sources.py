"""Where the motion of a scene of disks starts: driven sides, oblique waves, loads, and holes that scatter them."""

from collections.abc import Iterator

import numpy as np

from dembound.boundaries import axis_of_motion, normal_axis, plane_of
from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.load import Load
from dembound.continuum.medium import layered
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.material.packing_waves import front_of, slowest_speed
from dembound.disks.surroundings.ground_waves import incident_in
from dembound.disks.surroundings.media import medium_of
from dembound.motion.paths import Source
from dembound.table import EVERYWHERE, Box


def sources_of(case: DiskCase, ground: PackedMaterial) -> list[Source]:
    """All sources of a scene of a case; holes are local sources from the first arrival of a driven side's waves on.

    Steady loads are no sources if a static stage balances them, else they start at once and never end.
    """
    driven = [*_sides(case, ground), *_incident(case, ground)]
    speed = front_of(ground, case.run.safety).speed
    return [*driven, *_loads(case, ground), *_holes(case, driven, speed, slowest_speed(ground))]


def _sides(case: DiskCase, ground: PackedMaterial) -> Iterator[Source]:
    """Driven sides, each with its waves."""
    for side, waves in case.driving.items():
        axis, box = normal_axis(side), list(EVERYWHERE)
        box[axis] = box[2 + axis] = plane_of(side, case.box)
        for motion, name in waves.items():
            if axis_of_motion(side, motion) not in ground.held:
                wave, kind = case.wave[name], 0 if motion == "p" else 1
                speed = min(layer.wave_speeds(axis)[kind] for layer in ground.materials)
                yield Source((box[0], box[1], box[2], box[3]), wave.start, wave.duration(), speed)


def _incident(case: DiskCase, ground: PackedMaterial) -> Iterator[Source]:
    """The oblique wave, which is everywhere: from its first arrival in the ground until its reflection has left."""
    if case.incident is None:
        return
    wave, signal = incident_in(case, layered(medium_of(ground)).media[0]), case.wave[case.incident.wave]
    left, bottom, right, top = case.box
    corners = np.array([(left, bottom), (right, bottom), (left, top), (right, top)])
    delays, slowest = wave.delays(corners), slowest_speed(ground)
    down = signal.duration() + delays.max() + case.size[1] / slowest
    yield Source(EVERYWHERE, signal.start + delays.min(), down, slowest)


def _loads(case: DiskCase, ground: PackedMaterial) -> Iterator[Source]:
    """Loads, by their places."""
    slowest = slowest_speed(ground)
    for load in case.load:
        place = place_of(case, load)
        if load.wave is not None:
            wave = case.wave[load.wave]
            yield Source(place, wave.start, wave.duration(), slowest, is_local=place != EVERYWHERE)
        elif case.static is None:
            yield Source(place, 0.0, np.inf, slowest, is_local=place != EVERYWHERE)


def place_of(case: DiskCase, load: Load) -> Box:
    """The rectangle that a load acts on; for a pressure the one round its hole, or the disks."""
    if load.sides is not None:
        return case.packing.box
    if load.pressure is not None:
        return case.hole_of(load).box
    if load.position is not None:
        return *load.position, *load.position
    return EVERYWHERE if load.region is None else load.region


def _holes(case: DiskCase, driven: list[Source], fastest: float, slowest: float) -> Iterator[Source]:
    """Holes, for the waves of driven sides; other waves reach a column over its side anyway."""
    if not driven:
        return
    for hole in (each for each in case.holes if not each.is_shape):
        x0, y0, x1, y1 = hole.box
        corners = np.array([[x0, y0], [x0, y1], [x1, y0], [x1, y1]])
        first = min(source.start + float(source.distance(corners).min()) / fastest for source in driven)
        last = max(source.over + float(source.distance(corners).max()) / source.slowest for source in driven)
        yield Source(hole.box, first, last, slowest, is_local=True)
