"""Continua as parts of a system of disks, and their ties to the disks."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from dembound.disks.beyond.surroundings import Surroundings
from dembound.disks.body import DiskBody
from dembound.kernels.tables import Repeats, WallTies
from dembound.motion.layout import Layout
from dembound.motion.part import Tie
from dembound.outside.part import GridPart


class WallTie(Tie):
    """The half bonds between the disks and the continuum.

    Parameters
    ----------
    surroundings : the continuum and its half bonds. layout : the slots of all nodes of the scene.
    """

    def __init__(self, surroundings: Surroundings, layout: Layout) -> None:
        self._surroundings, self._layout = surroundings, layout
        self._last: tuple[np.ndarray, WallTies] | None = None

    @property
    def nodes(self) -> np.ndarray:
        """Disks and nodes of the continuum (k,) that it acts on, ascending."""
        return self._surroundings.tied

    def bundle(self, supported: np.ndarray) -> NamedTuple:
        """The arrays of the tie for the kernels; supported (s,) are all nodes of the support table, ascending."""
        if self._last is None or self._last[0] is not supported:  # it is asked for at every return of the loop
            self._last = supported, self._surroundings.ties(self._layout, supported)
        return self._last[1]


class TwinTie(Tie):
    """Repeats the forces that earlier ties exert on the twins of some disks on these disks.

    Parameters
    ----------
    disks : (k,) ascending. twin : (n,) twin of each of the scene's nodes.
    """

    def __init__(self, disks: np.ndarray, twin: np.ndarray) -> None:
        self._disks, self._twin = disks, twin

    @property
    def nodes(self) -> np.ndarray:
        """Disks (k,) that it acts on, ascending."""
        return self._disks

    def bundle(self, supported: np.ndarray) -> NamedTuple:
        """The arrays of the tie for the kernels; supported (s,) are all nodes of the support table, ascending."""
        return Repeats(*(np.searchsorted(supported, nodes) for nodes in (self._twin[self._disks], self._disks)))


def disks_on_foot(scene: DiskBody) -> np.ndarray:
    """Disks (k,) of the body that have the forces of the foot on their twins in the column, ascending."""
    if scene.foot is None or scene.seam is None:
        return np.zeros(0, dtype=np.int64)
    disks = np.arange(scene.seam.count, scene.disk_count)
    return disks[np.isin(scene.seam.twin[disks], scene.foot.wall.bonds.particle)]


def tied_nodes(scene: DiskBody) -> np.ndarray:
    """Nodes (k,) of a scene that ties act on."""
    tied = [np.zeros(0, dtype=np.int64), *(each.tied for each in scene.continua), disks_on_foot(scene)]
    if scene.seam is not None:
        tied.append(scene.seam.node)
    return np.concatenate(tied)


def grids(scene: DiskBody, time_step: float, *, damped: bool) -> list[GridPart]:
    """The continua of a scene, as parts to be stepped by time_step (s); damped : whether their damping acts."""
    return [
        GridPart(each.body, time_step, name=name, first_node=each.first, supported=each.wall.nodes, damped=damped)
        for each, name in ((scene.outside, "continuum"), (scene.foot, "foot"))
        if each is not None
    ]


def walls(scene: DiskBody) -> list[Tie]:
    """The ties of a scene to its continua, and the tie that repeats the forces of the column's foot on the body."""
    walls: list[Tie] = [] if scene.outside is None else [WallTie(scene.outside, scene.layout)]
    if scene.foot is not None:
        assert scene.twin is not None
        foot, repeats = WallTie(scene.foot, scene.layout), TwinTie(disks_on_foot(scene), scene.twin)
        walls = [foot, repeats, *walls]  # these forces are there before they are repeated
    return walls
