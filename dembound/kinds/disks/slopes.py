"""What is said of ground of two heights or unlike layers: columns, what free fields send back, and stress at rest."""

import math
from collections.abc import Iterator

import numpy as np

from dembound.boundaries.roller import Roller
from dembound.casefile.disks import DiskCase
from dembound.disks.material.packing_waves import slowest_speed
from dembound.disks.scene import DiskScene
from dembound.disks.surroundings.frequencies import mean_frequency
from dembound.words import Entries, percent

APART = np.array([0.5, 1.0, 2.0, 4.0])
"""Distances of sides from the crest and the toe, over the height of the slope, of `SENT_BACK`."""

LONG = np.array([1.0, 2.0, 4.0, 8.0])
"""Lengths of the slowest waves at their mean frequency over the height of the slope, of `SENT_BACK`."""

SENT_BACK = np.array(
    [[0.21, 0.22, 0.20, 0.14], [0.15, 0.13, 0.11, 0.073], [0.097, 0.11, 0.074, 0.05], [0.06, 0.06, 0.05, 0.04]]
)
"""Error of the velocity between free-field sides beside a slope, RMS over RMS at the worst of six places, by distance
(rows) and wave length. Slopes of 45° in square lattices under SV waves, with sides 13 heights away for comparison;
under P waves it is three quarters of that (benchmarks/slopes.py)."""

AT_REST = {True: 0.025, False: 0.08}
"""Difference of the stress at rest from that of ground five times as wide and deep, RMS over RMS, with the foot one
height of the slope below its toe, on rollers and fixed; it falls with the depth over the height to the power 0.8.
Measured in random packings with K0 = 0.5, sides half a height and a height away: 2.3 and 2.5 % on rollers, 4.1 and
7.7 % fixed; with two heights 1.6 and 1.1 %, and 2.3 and 3.5 %. In a square lattice 0.9 and 12.6 %, with two heights 0.9
and 2.0 %."""


def slope_facts(scene: DiskScene) -> Entries:
    """Facts about ground that is not as high at both sides."""
    case = scene.case
    heights = surface_heights(case)
    if case.is_unlike:
        yield "layers", f"those of the left side and of the right one meet at x = {case.ground.meet:.6g} m"
    if len(scene.seams) > 1:
        border = "where the layers meet" if case.is_unlike else "the middle of the slope"
        yield (
            "free field",
            f"a column for each side, up to y = {heights['left']:.4g} m at the left and {heights['right']:.4g} m at "
            f"the right; that of monitors left of x = {case.middle:.4g} m, {border}, is the left one",
        )
    static, high = case.static, abs(heights["left"] - heights["right"])
    if static is None or high == 0.0 or "bottom" not in static.boundary:
        return
    below = (min(heights.values()) - case.packing.box[1]) / high
    foot = static.boundary["bottom"]
    rolls = isinstance(foot, Roller)
    if static.k0 is None:
        yield "foot", "without static.k0 the higher ground settles more the deeper the foot is, which strains the slope"
        return
    size = AT_REST[rolls] / max(below, 0.1) ** 0.8
    better = "" if rolls else ', less on a "roller"'
    yield (
        "foot",
        f"{below:.2g} heights of the slope below its toe: near it stresses at rest differ by about {percent(size)} "
        f"from those of ground five times as wide and deep{better}",
    )


def surface_heights(case: DiskCase) -> dict[str, float]:
    """Height y (m) of the surface at the left and right side of the disks."""
    top = case.packing.box[3]
    return {side: case.floors[side].height if side in case.floors else top for side in ("left", "right")}


def slope_warnings(scene: DiskScene) -> Iterator[str]:
    """A warning about free-field sides beside a slope, which send back what it scatters."""
    case = scene.case
    if len(scene.seams) < 2 or not case.free_field_sides:
        return
    sides, heights = " and ".join(f"boundary.{side}" for side in case.free_field_sides), surface_heights(case)
    if case.is_unlike and heights["left"] == heights["right"]:
        yield (
            f"{sides}: free-field sides send back what is scattered where the layers meet, how much is not predicted; "
            'take "outside" there and at bottom'
        )
        return
    found = sent_back_beside_slope(case, slowest_speed(scene.ground))
    if not math.isfinite(found):
        return
    apart = min(case.level[side] for side in case.free_field_sides) / abs(heights["left"] - heights["right"])
    yield (
        f"{sides}: beside ground of two heights free-field sides send back what the slope scatters: about "
        f"{percent(found)} of the velocity is wrong (RMS), as they are {apart:.2g} times its height away; take "
        '"outside" there and at bottom'
    )


def sent_back_beside_slope(case: DiskCase, speed: float) -> float:
    """Error of the velocity by free-field sides beside a slope, by `SENT_BACK`; nan without waves.

    speed : of the slowest waves, m/s.
    """
    heights = surface_heights(case)
    high = abs(heights["left"] - heights["right"])
    apart = min(case.level[side] for side in case.free_field_sides) / high
    long = speed / (mean_frequency(case) * high)
    if not math.isfinite(long):
        return math.nan
    rows = [np.interp(math.log(long), np.log(LONG), row) for row in SENT_BACK]
    return float(np.interp(math.log(apart), np.log(APART), rows))
