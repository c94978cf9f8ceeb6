"""Disks that have fallen far below the scene, where nothing can stop them: they are counted and may be put to rest."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from dembound.disks.scene import DiskScene
from dembound.disks.stepping.system import DiskSystem
from dembound.motion.state import Arrays
from dembound.motion.trackers import Every, Run

STEPS = 1024
"""Steps between two looks, which take less time than one step: a multiple of those at which the loop returns anyway."""


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

    def __init__(self, scene: DiskScene, *, retires: bool) -> None:
        super().__init__(STEPS)
        _, low, _, high = scene.case.box
        self._height = scene.assembly.positions[:, 1]
        self._depth = low - (high - low)
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

    def saved_arrays(self) -> Arrays:
        """The disks found so far, and the next step."""
        return {**super().saved_arrays(), "far": self.far, "first": np.array(self.first)}

    def restore(self, saved: Arrays) -> None:
        """Restore the arrays returned by `saved_arrays` in another run of the same case."""
        super().restore(saved)
        self.far, self.first = saved["far"].copy(), int(saved["first"])


def far_warnings(found: Mapping[str, Any] | None) -> Iterator[str]:
    """A warning about disks that have fallen far below the scene; found : of the summary."""
    if found is None:
        return
    cure = "" if found["retired"] else '; with run.far = "retire" such disks stop, which makes steps cheaper'
    yield (
        f"run.far: of {found['disks']:,} disks each has fallen below the base by more than the height of the scene and "
        f"touches nothing, the first by t = {found['time']:.4g} s{cure}"
    )
