"""The time of a step of disks on one core."""

from __future__ import annotations

import numpy as np

from dembound.disks.scene import DiskScene

ELASTIC_NODE, ABSORBING_NODE, TIE = 8.1, 15.0, 26.0
"""Nanoseconds of a step on one core (benchmarks/continuum_rate.py): nodes of order 4, outside and inside of layers.

Ties are those of random packings; a tie of a lattice, which acts on the nodes of edges only, takes 15."""

DRIVE = 18.0
"""Nanoseconds of a force by which an oblique wave enters (cases/oblique.toml, 772 of them)."""

DISK = {(True, False): 7.0, (False, False): 27.0, (True, True): 20.0, (False, True): 55.0}
"""Nanoseconds of a step of a disk (benchmarks/rates.py), in rows of copies or one by one, with a history or without."""

DASHPOTS = 30.0
"""Nanoseconds of a step of a disk by dashpots of its contacts, which are computed one by one."""

DAMPED = 7.0
"""Nanoseconds of a step of a disk by three mechanisms of damping."""


def time_per_disk(scene: DiskScene) -> float:
    """Nanoseconds of a step per disk of a scene."""
    damped = DAMPED if scene.ground.is_damped else 0.0
    damped += DASHPOTS if scene.case.material.has_dashpots else 0.0
    return DISK[scene.slots is not None and not scene.slots.is_plain, scene.has_history] + damped


def times_of_continuum(nodes: float, absorbing: float, ties: float) -> dict[str, float]:
    """Nanoseconds of a step of `nodes` nodes, `absorbing` of them in layers, and of ties, by name."""
    return {"elements": ELASTIC_NODE * (nodes - absorbing) + ABSORBING_NODE * absorbing, "ties": TIE * ties}


def times_of_scene(scene: DiskScene) -> dict[str, float]:
    """Nanoseconds of a step of a scene, by its parts."""
    absorbing = sum(int(np.count_nonzero(beyond.body.mesh.depth.any(axis=1))) for beyond in scene.continua)
    nodes = sum(beyond.count for beyond in scene.continua)
    ties = sum(len(beyond.wall.element) for beyond in scene.continua)
    column = 0 if scene.seam is None else scene.seam.count
    each = time_per_disk(scene)
    disks = {"free-field column": each * column, "disks": each * (scene.disk_count - column)}
    wave = 0.0 if scene.ground_waves is None else DRIVE * len(scene.supports.drive_row)
    return times_of_continuum(nodes, absorbing, ties) | disks | {"incident wave": wave}
