"""The time of a step of disks on one core, and bytes on disk of their results."""

from __future__ import annotations

import numpy as np

from dembound.casefile.tables import ParaView
from dembound.continuum.sizing import memories_bytes
from dembound.disks.ram import SceneSizes, checkpoint_bytes
from dembound.disks.scene import DiskScene
from dembound.motion.resources import POINT, Storage, mesh_bytes, paraview_bytes

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


CHANGING, CONSTANT = 44.0, 21.0
"""Bytes per disk for ParaView of its motion, and of the other fields; numbers of broken bonds count as constant, as
most are."""

NODE_HEADER, NODE_CELL, NODE_CHANGING = 62.0, 42.0, 52.0
"""Bytes of a node of a continuum in the record, positions and cells, of a cell in the VTKHDF file, and of its motion
and stress for ParaView; there is a cell for each node."""


def storage_of(scene: DiskScene) -> Storage:
    """Bytes on disk of a scene."""
    sizes, output = scene.sizes, scene.case.output
    own = 4.0 * scene.has_history + 24.0 * output.stress
    record = 48.0 + 8.0 * scene.has_history + 24.0 * output.stress
    layer = 4.0 * scene.ground.is_layered
    vtu = mesh_bytes(1.0, CHANGING + CONSTANT + own + 4.0 * output.peaks + layer, 1.0, 1, 0.0)
    files = output.paraview
    snapshot = sizes.disks * (record + paraview_bytes(files, vtu, POINT + CHANGING + own))
    if output.contacts:
        snapshot += sizes.contacts * _contact_bytes(files)
    # positions, radii, twins, bonds, layers; in the VTKHDF file what remains
    header = sizes.disks * (37.0 + layer + paraview_bytes(files, 0.0, 53.0 + layer))
    if sizes.grid is not None:
        shown = mesh_bytes(1.0, NODE_CHANGING + 1.0, 1.0, 4, 0.0)
        snapshot += sizes.grid.nodes * (72.0 + paraview_bytes(files, shown, POINT + NODE_CHANGING))
        header += sizes.grid.nodes * (NODE_HEADER + paraview_bytes(files, 0.0, NODE_CELL))
    return Storage(header, snapshot, _checkpoint_bytes(scene, sizes))


def _checkpoint_bytes(scene: DiskScene, sizes: SceneSizes) -> float:
    """Bytes of a checkpoint: motion, pairs, datum, both loads and speeds (104 n); convolution variables of a continuum.

    Under a history-dependent law also the velocity at its change, the state at the last entry of the ledger and origins
    (88 n); after a static stage the forces that balance the stress, before and after, and their datum (98 n).
    """
    own = 104.0 + 88.0 * scene.has_history + 98.0 * (scene.case.static is not None)
    beyond = 0.0 if sizes.grid is None else 104.0 * sizes.grid.nodes + memories_bytes(sizes.grid)
    return checkpoint_bytes(sizes, history=scene.has_history) + own * sizes.disks + beyond


def _contact_bytes(files: ParaView) -> float:
    """Bytes of a contact in a snapshot: 41 in the record; a line between two points of its own with two forces."""
    return 41.0 + paraview_bytes(files, mesh_bytes(2.0, 0.0, 1.0, 2, 17.0), 2.0 * POINT + 8.0)
