"""Overlaps of contacts whose stiffness grows with them, beside the one up to which a time step is stable."""

import numpy as np

from dembound.disks.stepping.system import DiskSystem
from dembound.errors import RunError
from dembound.kernels.compiler.start_strain import began_with
from dembound.motion.trackers import Every, Run
from dembound.pairwise import P

LOOKS = 64
"""Steps between two looks at overlaps, a few of the shortest period of the contacts."""


class Overlaps(Every):
    """Stops a run in which contacts overlap so far that the step is not stable.

    Parameters
    ----------
    most : overlap (m) that is allowed.
    """

    name = "overlaps"

    def __init__(self, most: float) -> None:
        super().__init__(LOOKS)
        self._most = most

    def see(self, run: Run) -> None:
        """Raise RunError, with time and place, for a contact that is too stiff for the step."""
        system, u = run.system, run.state.u
        assert isinstance(system, DiskSystem)
        for part in system.disks.parts:
            pairs = part.pairs
            rows = pairs.constants[pairs.contact_type]
            x, y = (rows[:, :2] + (u[:2, pairs.second] - u[:2, pairs.first]).T).T
            began = began_with(pairs.began, pairs.contact_type, 0)
            overlap = rows[:, P.touch] - np.hypot(x, y) - began
            if overlap[most := int(np.argmax(overlap))] > self._most:
                place = run.scene.positions[run.scene.layout.node[pairs.first[most]]]
                shorter = run.time_step * (self._most / overlap[most]) ** 0.25
                raise RunError(
                    f"contacts have become too stiff for the time step: at t = {run.time:g} s near ({place[0]:.4g}, "
                    f"{place[1]:.4g}) m one overlaps by {overlap[most]:.3g} m, the step of {run.time_step:.3g} s is "
                    f"stable up to {self._most:.3g} m; give run.time_step = {0.5 * shorter:.2g}, or slower disks"
                )
