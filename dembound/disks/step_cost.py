"""The time of a step of disks on one core, from constants that `benchmarks/overview.py --sections constants` prints."""

from __future__ import annotations

import numpy as np

from dembound.casefile.disks.static import can_break
from dembound.disks.scene import DiskScene
from dembound.motion.kind import Slower

ELASTIC_NODE, ABSORBING_NODE, TIE = 6.3, 12.0, 19.0
"""Nanoseconds of a step on one core (benchmarks/continuum_rate.py): nodes of order 4, outside and inside of layers.

Ties are those of random packings; a tie of a lattice, which acts on the nodes of edges only, takes 15."""

BROKEN = 95.0
"""Nanoseconds of a step of a disk of ground all broken, whose pairs are listed anew as disks fly."""

DRIVE = 18.0
"""Nanoseconds of a force by which an oblique wave enters (cases/oblique.toml, 772 of them)."""

DISK = {(True, False): 4.3, (False, False): 18.0, (True, True): 16.0, (False, True): 43.0}
"""Nanoseconds of a step of a disk (benchmarks/rates.py), in rows of copies or one by one, with a history or without."""

DASHPOTS = 2.8
"""Nanoseconds of a step of a disk by dashpots of its contacts."""

DAMPED = 2.7
"""Nanoseconds of a step of a disk by three mechanisms of damping."""


ARMS = {True: 17.0, False: 46.0}
"""Nanoseconds of a step of a disk by three relaxation arms of its bonds, in rows of copies or one by one."""


def time_per_disk(scene: DiskScene, has_history: bool | None = None) -> float:
    """Nanoseconds of a step per disk; has_history : under the elastic law before its own; None: under its own."""
    has_history = scene.has_history if has_history is None else has_history
    in_rows = scene.slots is not None and not scene.slots.is_plain
    damped = DAMPED if scene.ground.is_damped else 0.0
    damped = ARMS[in_rows] if scene.ground.relaxes else damped
    damped += DASHPOTS if scene.case.material.has_dashpots else 0.0
    return DISK[in_rows, has_history] + damped


def slower(scene: DiskScene) -> Slower | None:
    """The slowest pace that a scene may come to; None if all steps take as long as the first."""
    if not scene.has_history:
        return None
    case, begun = scene.case, sum(times_of_scene(scene).values())
    first = begun - (time_per_disk(scene) - time_per_disk(scene, not case.begins_elastic)) * scene.disk_count
    breaks, bonded = can_break(case.materials), all(each.moduli.pb_emod > 0.0 for each in scene.ground.materials)
    if bonded and not breaks:
        return Slower("once contacts open or slide", first, begun) if first < begun else None
    broken = begun + max(0.0, BROKEN - time_per_disk(scene)) * scene.disk_count
    return Slower("all broken" if bonded else "all loose", first, broken)


def times_of_continuum(nodes: float, absorbing: float, ties: float) -> dict[str, float]:
    """Nanoseconds of a step of `nodes` nodes, `absorbing` of them in layers, and of ties, by name."""
    return {"elements": ELASTIC_NODE * (nodes - absorbing) + ABSORBING_NODE * absorbing, "ties": TIE * ties}


def times_of_scene(scene: DiskScene) -> dict[str, float]:
    """Nanoseconds of a step of a scene, by its parts."""
    absorbing = sum(int(np.count_nonzero(beyond.body.mesh.depth.any(axis=1))) for beyond in scene.continua)
    nodes = sum(beyond.count for beyond in scene.continua)
    ties = sum(len(beyond.wall.element) for beyond in scene.continua)
    column = scene.column_count
    each = time_per_disk(scene)
    disks = {"free-field column": each * column, "disks": each * (scene.disk_count - column)}
    wave = 0.0 if scene.ground_waves is None else DRIVE * len(scene.supports.drive_row)
    return times_of_continuum(nodes, absorbing, ties) | disks | {"incident wave": wave}


def seconds_of(scene: DiskScene, steps: float) -> float:
    """CPU seconds of so many steps of a scene."""
    return 1e-9 * steps * sum(times_of_scene(scene).values())
