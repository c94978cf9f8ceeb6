"""Warnings about probable mistakes in a case of disks, before and after the run."""

import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from dembound.boundaries import SIDES, Motion
from dembound.casefile.disks.load import Load
from dembound.casefile.disks.material import with_history
from dembound.casefile.magnitudes import stress_in_words
from dembound.casefile.messages import numbered
from dembound.disks.continuum_facts import continuum_warnings
from dembound.disks.load_factor import load_factor_in_words
from dembound.disks.matching import homogenised_beta, reflected
from dembound.disks.near_ties import near_tie_warnings
from dembound.disks.scene import DiskScene
from dembound.disks.wave_front import slowest_speed
from dembound.disks.wave_warnings import wave_warnings
from dembound.results.reader import cracks_until, open_record
from dembound.results.warnings import energy_warnings, still_moving

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


def disk_warnings(scene: DiskScene, time_step: float) -> list[str]:
    """All of them, one line each; time_step in s."""
    return [
        *_empty_holes(scene),
        *_steady_without_static(scene),
        *_locked_in(scene),
        *_settles_in_tension(scene),
        *wave_warnings(scene, time_step),
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


def warnings_after_disks(scene: DiskScene, summary: Mapping[str, Any], record: Path) -> list[str]:
    """Warnings from the summary and record of a run of disks, one line each."""
    with open_record(record) as file:
        cracks = cracks_until(file, np.inf)
        at_rest = 0.0 if scene.case.static is None else AT_REST * slowest_speed(scene.ground)
        moving = still_moving(scene, summary["duration"], file, _pieces(scene, cracks["particles"]), at_rest)
        return [
            *moving,
            *_not_elastic(summary.get("load_factor")),
            *near_tie_warnings(scene, summary, cracks),
            *energy_warnings(scene, summary["energy"]),
        ]


def _not_elastic(found: Mapping[str, Any] | None) -> Iterator[str]:
    """A load factor below 1: the motion is not that of the material."""
    if found is not None and found["factor"] is not None and found["factor"] < 1.0:
        law = f"take law = {with_history()}, or smaller waves"
        yield f'material.law: is "elastic", but {load_factor_in_words(found)}; {law}'


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
