"""The watch of forces at rest: their work and the disks they act on, and the end of a run that they drive."""

import numpy as np
import pytest
from disk_systems import BODY

from dembound.disks.scene import build
from dembound.disks.stepping.balance import Balance
from dembound.disks.stepping.side_watch import SideWatch
from dembound.disks.stepping.system import DiskSystem
from dembound.errors import RunError

LATTICE = {"pattern": "A", "size": [6.0, 5.0], "radius": 0.25}
BOTTOM = {"type": "viscous", "intact": 2}
STEP = 0.5


class Watched:
    """A body of 12 × 10 disks that its bottom bears, each disk there with 1 N, watched at displacements of one disk."""

    def __init__(self, bar) -> None:
        changes = {**BODY, "material.law": "linearpbond", "material.pb_ten": 1e6, "packing": LATTICE}
        self.scene = build(bar({**changes, "boundary": {"bottom": BOTTOM}}))
        still = np.zeros((3, self.scene.count))
        self.bottom = self.scene.sides["bottom"].nodes
        force = still.copy()
        force[1, self.bottom] = 1.0
        self.system = DiskSystem(self.scene, STEP)
        self.balance = Balance(self.scene, force, still, still, still)
        self.watch = SideWatch(self.scene, STEP)

    def look(self, step: int, moved: float = 0.0, turned: float = 0.0, energy: float = 100.0, borne: float = -1e9):
        displacement = np.zeros((3, self.scene.count))
        displacement[:, self.bottom[4]] = [0.0, moved, turned]
        self.watch.look(self.balance, self.system.contacts, displacement, step, borne, energy)
        return self.watch.describe()


def test_work_is_that_on_a_disk_which_leaves_its_side_over_the_energy_that_came_in(bar) -> None:
    watched = Watched(bar)
    said = watched.look(3, moved=12.0)
    # 1 N over 12 m, less the mean motion of twelve disks, on each of which 1 N acts
    assert said["work"] is None
    watched.balance.force[1, watched.bottom[4]] = 2.0
    assert watched.look(4, moved=12.0)["work"] == {"size": pytest.approx(0.11), "side": "bottom", "time": 2.0}
    assert watched.look(5, energy=220.0)["work"]["size"] == pytest.approx(0.05)  # the largest so far, over all energy
    with pytest.raises(RunError, match=r"boundary\.bottom: until t = 3 s forces at rest have done work"):
        watched.look(6, moved=72.0)


def test_all_forces_together_count_where_the_side_moves_as_a_whole(bar) -> None:
    watched = Watched(bar)
    # 1 N over 60 m, of which 20 J have lifted weight
    assert watched.look(3, moved=60.0, borne=-20.0)["work"]["size"] == pytest.approx(0.4)
    with pytest.raises(RunError, match="51 %"):
        watched.look(4, moved=60.0, borne=-9.0)


def test_findings_are_kept_over_a_restart(bar) -> None:
    watched = Watched(bar)
    watched.balance.force[1, watched.bottom[4]] = 2.0
    watched.look(4, moved=12.0, turned=0.2)
    again = SideWatch(watched.scene, STEP)
    saved = {name: values.copy() for name, values in watched.watch.saved_arrays().items()}
    again.restore(saved)
    again.sides = watched.balance.sides
    assert again.describe() == watched.watch.describe()  # also where the run ends before it looks again
    again.look(watched.balance, watched.system.contacts, np.zeros((3, watched.scene.count)), 5, 0.0, 100.0)
    assert again.describe() == watched.watch.describe()
