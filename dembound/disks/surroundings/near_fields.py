"""The motion near the sources of a case: signals, how long they last, and places where near fields are strong."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Literal

import numpy as np

from dembound.boundaries.edge import normal_axis
from dembound.casefile.disks import DiskCase
from dembound.continuum import sizing
from dembound.continuum.interpolation import NearField
from dembound.continuum.medium import Ground
from dembound.continuum.sizing import Signal
from dembound.holes import Hole
from dembound.table import Box
from dembound.waves import Constant


def signals_of(case: DiskCase) -> list[Signal]:
    """The forces of a case, and its other waves as velocities; steady forces jump, unless there is a static stage."""
    factors = {load.wave for load in case.load}
    velocities = [name for name in case.wave if name in case.entering or name not in factors]
    signals = [Signal(case.wave[name], is_force=False) for name in velocities]
    for load in case.load:
        if load.wave is not None:
            signals.append(Signal(case.wave[load.wave], is_force=True))
        elif case.static is None:
            signals.append(Signal(Constant(type="constant", amplitude=1.0), is_force=True))
    return signals


def lasting_time(case: DiskCase) -> float:
    """Longest time (s) for which a force that begins to act in the run and stays does so; 0 for none.

    A pressure on a closed wall is in balance: the displacement that it makes in the plane does not grow for ever.
    """
    starts = [case.run.duration]
    for load in case.load:
        if load.hole is not None and _is_in_body(case, case.hole_of(load)):
            continue
        if load.wave is None and case.static is None:
            starts.append(0.0)
        elif load.wave is not None and case.wave[load.wave].stays:
            starts.append(case.wave[load.wave].start)
    return max(case.run.duration - min(starts), 0.0)


def _is_in_body(case: DiskCase, hole: Hole) -> bool:
    """Whether a hole reaches no side of the disks."""
    (x0, y0, x1, y1), (left, bottom, right, top) = hole.box, case.packing.box
    return left < x0 and bottom < y0 and x1 < right and y1 < top


def near_fields(
    case: DiskCase, medium: Ground, box: Box, sides: Sequence[str], lowest: float = math.inf
) -> list[NearField]:
    """The static fields of the holes and forces of a case beside sides of a box (m).

    lowest : frequency (Hz) from which on wave numbers of waves that pass holes are those of displacements, see
    `sizing.energies`.
    """
    number = sizing.wave_number(signals_of(case), medium, lowest)
    ends = dict(zip(("left", "bottom", "right", "top"), box, strict=True))
    found = []
    for low, high, source in sources_near(case):
        place = float(low[0]), float(low[1]), float(high[0]), float(high[1])
        for side in sides:
            axis = normal_axis(side)
            gap = min(abs(ends[side] - low[axis]), abs(ends[side] - high[axis]))
            found.append(NearField(place, float(gap), source, number))
    return found


def extents(case: DiskCase) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Lower left and upper right corners (m) of holes; for each localised force its middle, twice.

    Of a hole that leaves a floor at a side only the part that is not level.
    """
    for low, high, _ in sources_near(case):
        yield low, high


def sources_near(case: DiskCase) -> Iterator[tuple[np.ndarray, np.ndarray, Literal["force", "pressure", "waves"]]]:
    """The `extents`, each with the kind of source of its static field."""
    left, _, right, _ = case.packing.box
    pressed = case.pressed if signals_of(case) else {hole.name for hole in case.holes}
    for hole in case.holes:
        low, high = np.array(hole.box[:2]), np.array(hole.box[2:])
        for side, floor in case.floors.items():
            if side == "left" and low[0] <= left + floor.width:
                low[0] = min(left + floor.width, high[0])
            elif side == "right" and high[0] >= right - floor.width:
                high[0] = max(right - floor.width, low[0])
        yield low, high, "pressure" if hole.name in pressed else "waves"
    for load in case.load:
        if load.position is not None:
            yield np.array(load.position), np.array(load.position), "force"
        elif load.region is not None:
            middle = 0.5 * (np.array(load.region[:2]) + load.region[2:])
            yield middle, middle, "force"
