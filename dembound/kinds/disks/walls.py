"""Facts and warnings about walls, and the disks that they overlap before anything moves."""

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from dembound.casefile.disks.wall import Wall
from dembound.casefile.messages import counted, numbered
from dembound.disks.scene import DiskScene
from dembound.disks.stepping.walls import bottom_waves
from dembound.errors import CaseError
from dembound.words import Entries, in_one_unit, percent, with_unit

TOUCHES = 1e-3
"""Overlap, in radii, above which disks that a wall pushes off at the start are a probable mistake."""

CUTS = 0.5
"""Overlap, in radii, from which on a wall is refused, as it may push disks to the other side."""


def overlaps(scene: DiskScene, wall: Wall) -> np.ndarray:
    """Overlap (n,) of a wall with each disk as built, in radii; negative where they do not touch."""
    disks = slice(scene.column_count, scene.disk_count)
    positions, radii = scene.assembly.positions[disks], scene.assembly.radii[disks]
    least, reach = np.full(len(radii), np.inf), float(radii.max())
    line = np.array(wall.line)
    for one, two in pairwise(line):
        low, high = np.minimum(one, two) - reach, np.maximum(one, two) + reach
        near = np.flatnonzero(((positions >= low) & (positions <= high)).all(axis=1))
        arm, way = positions[near] - one, two - one
        along = np.clip(arm @ way / (way @ way), 0.0, 1.0)
        least[near] = np.minimum(least[near], np.hypot(*(arm - along[:, None] * way).T))
    found: np.ndarray = 1.0 - least / radii
    return found


def require_clear(scene: DiskScene) -> None:
    """Raise CaseError for walls that cut disks at the start."""
    built = scene.before or scene
    problems = []
    for place, wall in numbered("wall", built.case.wall):
        found = overlaps(built, wall)
        if (cut := found > CUTS).any():
            x, y = built.assembly.positions[built.column_count + int(found.argmax())]
            problems.append(
                f"{place}.points: cuts {counted(int(cut.sum()), 'disk')} at the start, that at ({x:.4g}, {y:.4g}) m by "
                f"{found.max():.2f} of its radius; must be less than {CUTS:g}: move it, or leave disks out by a hole"
            )
    if problems:
        raise CaseError(problems)


def wall_warnings(scene: DiskScene) -> Iterator[str]:
    """Walls that overlap disks at the start."""
    built = scene.before or scene
    for place, wall in numbered("wall", built.case.wall):
        found = overlaps(built, wall)
        if (deep := found > TOUCHES).any():
            most = percent(float(found.max()))
            yield (
                f"{place}.points: overlaps {counted(int(deep.sum()), 'disk')} at the start, up to {most} of a radius, "
                "and pushes them off; move it, or let them settle in [static]"
            )


def wall_facts(scene: DiskScene) -> Entries:
    """For each wall its length, stiffness, friction and motion, and how many disks touch it."""
    for wall in scene.case.wall:
        line = np.array(wall.line)
        length = float(np.hypot(*np.diff(line, axis=0).T).sum())
        kn = {wall.kn or 2.0 * each.moduli.emod for each in scene.ground.materials}
        texts, unit = in_one_unit([min(kn), max(kn)][: len(kn)], "N/m")
        rolling = f", and roll at {wall.rr_fric:g} R of it" if wall.rr_fric else ""
        parts = [
            f"{counted(len(line) - 1, 'segment')}, {with_unit(length, 'm')}",
            f"k_n = {'…'.join(texts)} {unit}, friction {wall.fric:g}{rolling}",
        ]
        if wall.dp_nratio:
            parts.append(f"dashpots of {percent(wall.dp_nratio)} of the critical one")
        touching = int((overlaps(scene.before or scene, wall) > -TOUCHES).sum())
        parts += [f"{counted(touching, 'disk')} touch it at the start" if touching != 1 else "one disk touches it"]
        yield f"wall {wall.name}", "; ".join([*parts, _motion(scene, wall)])


def _motion(scene: DiskScene, wall: Wall) -> str:
    """How a wall moves, in words."""
    if wall.moves and bottom_waves(scene):
        return "it moves as the bottom"
    if wall.moves:
        x, y = wall.place
        return f"it moves as the free field at ({x:.4g}, {y:.4g}) m"
    if not wall.is_driven:
        return "it stands"
    until = "" if wall.until is None else f" until {with_unit(wall.until, 's')}"
    if wall.velocity is not None:
        texts, unit = in_one_unit(wall.velocity, "m/s")
        return f"it moves at ({', '.join(texts)}) {unit}{until}"
    waves = [f"wave {name} along {'xy'[axis]}" for axis, name in wall.waves.items()]
    return f"it moves as {' and '.join(waves)}{until}"
