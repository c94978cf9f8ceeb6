"""The ``[run]`` table of disks."""

from typing import Literal

from dembound.casefile.run import Run
from dembound.table import quantity


class DiskRun(Run):
    """The simulated time and the time step of disks, and what becomes of disks that have fallen far below the scene."""

    far: Literal["keep", "retire"] = quantity(
        "keep",
        unit="1",
        help='disks that touch nothing and have fallen below the base by more than the height of the scene; "keep": '
        'they fall on; "retire": they stop there, and their energy counts as taken by damping',
    )
