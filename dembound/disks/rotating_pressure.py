"""Pressures on sides that follow the disks of their sides during a run."""

from __future__ import annotations

from dembound.disks.pressure import in_run
from dembound.disks.scene import DiskScene
from dembound.disks.stepping.system import DiskSystem
from dembound.motion.trackers import Every, Run

STEPS = 64
"""Steps from one position of the membranes to the next: a wave crosses some thirty disks meanwhile."""


class Membranes(Every):
    """Moves the membranes of pressures on sides to where their disks are."""

    name = "membranes"

    def __init__(self, scene: DiskScene) -> None:
        super().__init__(STEPS)
        self._scene = scene

    def see(self, run: Run) -> None:
        """Replace the forces of membranes by those on the disks in their present places."""
        assert isinstance(run.system, DiskSystem)
        load = in_run(self._scene, run.state.displacement, self._scene.steady_load)
        run.system.follow(load, run.state, run.time_step)
