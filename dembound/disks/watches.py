"""What a run is watched for: disks that have fallen far below the scene, and bonds that have turned."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from dembound.casefile.disks.targets import with_history
from dembound.disks.contacts.pairs import PIECE, acting
from dembound.disks.scene import DiskScene
from dembound.disks.stepping.system import DiskSystem
from dembound.kernels.contacts import BONDED, INTACT
from dembound.motion.trackers import Every, Run
from dembound.words import percent

STEPS = 1024
"""Steps between two looks, which take less time than one step: a multiple of those at which the loop returns anyway."""


def far_below(scene: DiskScene) -> float:
    """Height y (m) below the base by the height of the scene, below which disks count as fallen out of it.

    Where walls reach further down than the base, their lowest point stands in for it.
    """
    _, low, _, high = scene.case.box
    return min([low, *(float(line[:, 1].min()) for line in scene.lines["walls"].values())]) - (high - low)


class FarDisks(Every):
    """Counts the disks that touch nothing and have fallen below the base by more than the height of the scene.

    Parameters
    ----------
    scene : the scene. retires : whether they are put to rest, unless the sides move them.

    Attributes
    ----------
    far : (m,) bool. first : step at which the first was found, −1 for none.
    """

    name = "far"
    evolving = ("due", "far", "first")

    def __init__(self, scene: DiskScene, *, retires: bool) -> None:
        super().__init__(STEPS)
        self._height, self._depth = scene.assembly.positions[:, 1], far_below(scene)
        self._retires = retires
        self._moved_by_sides = np.isin(np.arange(scene.disk_count), scene.supports.node)
        self.far = np.zeros(scene.disk_count, dtype=np.bool_)
        self.first = -1

    def see(self, run: Run) -> None:
        """Find disks that have fallen far since the last look."""
        system = run.system
        assert isinstance(system, DiskSystem)
        if not system.uses_history:
            return
        below = self._height + run.state.displacement[1, : len(self.far)] < self._depth
        if not (below & ~self.far).any():
            return
        touching = [part.contacts.coordination(part.geometry) for part in system.disks.parts if part.contacts]
        fresh = below & ~self.far & (np.concatenate(touching) == 0)
        if system.walls is not None:
            fresh[system.walls.touching.disk] = False
        if not fresh.any():
            return
        self.far |= fresh
        self.first = run.state.step if self.first < 0 else self.first
        if self._retires:
            system.retire(fresh & ~self._moved_by_sides, run.state, run.time_step)

    def describe(self, time_step: float) -> dict[str, Any] | None:
        """Number of disks, whether they were put to rest, and time (s) of the first, for a summary; None for none."""
        if self.first < 0:
            return None
        return {"disks": int(self.far.sum()), "retired": self._retires, "time": self.first * time_step}


def far_warnings(found: Mapping[str, Any] | None) -> Iterator[str]:
    """A warning about disks that have fallen far below the scene; found : of the summary."""
    if found is None:
        return
    cure = "" if found["retired"] else '; with run.far = "retire" such disks stop, which makes steps cheaper'
    yield (
        f"run.far: of {found['disks']:,} disks each has fallen below the base by more than the height of the scene and "
        f"touches nothing, the first by t = {found['time']:.4g} s{cure}"
    )


WARNS = 0.1
"""Turn (rad) of a bond above which a run is warned of: a body then grows by 0.5 %, and held from that bears a stress of
0.005 ρc².
"""


class Turns(Every):
    """Finds the largest turn of a bond.

    Attributes
    ----------
    found : largest turn (rad), its step and its place x, y (m).
    """

    name = "turns"
    evolving = ("due", "found")

    def __init__(self) -> None:
        super().__init__(STEPS)
        self.found = np.zeros(4)

    def see(self, run: Run) -> None:
        """Measure all bonds and contacts that act and keep their directions."""
        system, u = run.system, run.state.u
        assert isinstance(system, DiskSystem)
        for part in system.disks.parts:
            pairs, geometry = part.pairs, part.geometry
            kept = np.flatnonzero(pairs.state == INTACT if geometry == BONDED else acting(pairs, geometry))
            for begin in range(0, len(kept), PIECE):
                some = kept[begin : begin + PIECE]
                first, second = pairs.first[some], pairs.second[some]
                x, y = pairs.constants[pairs.contact_type[some], :2].T
                turn = np.abs(x * (u[1, second] - u[1, first]) - y * (u[0, second] - u[0, first])) / (x * x + y * y)
                if turn[most := int(np.argmax(turn))] > self.found[0]:
                    place = run.scene.positions[run.scene.layout.node[first[most]]] + 0.5 * np.array([x[most], y[most]])
                    self.found[:] = turn[most], run.state.step, *place

    def describe(self, run: Run) -> dict[str, Any]:
        """Largest turn (rad) until now, its time (s) and its place (m), as plain JSON values for a summary."""
        self.see(run)
        turn, step, *place = self.found.tolist()
        return {"turn": turn, "time": step * run.time_step, "position": place}


def turn_warnings(found: Mapping[str, Any] | None, law: str, *, has_history: bool) -> Iterator[str]:
    """A warning about bonds that have turned too far; found : of the summary, law : of the material."""
    if found is None or found["turn"] <= WARNS:
        return
    where, cure = f'law: is "{law}"', f'law = {with_history()}, whose geometry = "updated" turns'
    if has_history:
        where, cure = 'geometry: is "reference"', '"updated", which turns'
    x, y = found["position"]
    grown = percent(math.hypot(1.0, found["turn"]) - 1.0)
    yield (
        f"material.{where}, so bonds keep their directions of the start, but by t = {found['time']:.4g} s one near "
        f"({x:.4g}, {y:.4g}) m has turned by {found['turn']:.3g} rad: a body that turns so grows by {grown}; take "
        f"{cure} with the motion"
    )
