"""Contacts that leave the elastic range near the ties to a continuum are noted, with time, place and side."""

import numpy as np
import pytest
from small_cases import SURROUNDED, small

from dembound.boundaries.edge import SIDES
from dembound.disks.scene import DiskScene, build
from dembound.disks.stepping.system import DiskSystem
from dembound.motion.simulation import Simulation

FULL = {"material.law": "linearpbond", "material.elastic_start": False}
STEP = 1e-4


@pytest.fixture(scope="module")
def scene() -> DiskScene:
    """12 × 6 disks of 1 m, tied at x = 0.5 and 11.5 m and at y = 0.5 m."""
    return build(small(SURROUNDED, "near", FULL))


class Watched:
    """A run of a scene at its beginning, whose pairs and displacements are changed by hand."""

    def __init__(self, scene: DiskScene) -> None:
        self.scene = scene
        self.run = Simulation(scene, STEP)
        system = self.run.system
        assert isinstance(system, DiskSystem)
        self.system, self.watch, self.pairs = system, system.near_ties, system.contacts["body"]
        self.pairs.arrays.force[0, self.pairs.live[-1]] = 1e6
        self.stiffness = float(self.pairs.arrays.constants[0, 6])

    def between(self, *places: tuple[float, float]) -> int:
        """Place in the arrays of the pair of disks at two places."""
        positions = self.pairs.assembly.positions
        disks = [int(np.argmin(np.hypot(*(positions - place).T))) for place in places]
        (found,) = np.flatnonzero([set(pair) == set(disks) for pair in np.transpose(self.pairs.pairs)])
        return int(self.pairs.live[found])

    def look(self, step: int) -> dict[str, dict]:
        """The findings near each side once this step is done."""
        self.run.state.step = step
        self.watch.look(self.run.state, self.pairs)
        found = {side: self.watch.describe(side, STEP) for side in SIDES}
        return {side: event for side, event in found.items() if event is not None}


@pytest.mark.parametrize(("way", "opens"), [(1.0, True), (-1.0, False)])
def test_a_contact_that_is_open_without_slip_is_found(scene, way, opens) -> None:
    run = Watched(scene)
    displacement = np.zeros((3, scene.count))
    displacement[0, : scene.disk_count] = 1e-2 * way * (scene.assembly.positions[:, 0] > 10.0)
    run.run.state.displacement = displacement
    found = run.look(7)
    assert set(found) == ({"right", "bottom"} if opens else set())  # and below, where the nearest ties are those
    if opens:
        assert {event["position"][0] for event in found.values()} == {10.0}


def test_a_continued_run_remembers_it(scene) -> None:
    run, later = Watched(scene), Watched(scene)
    near = run.between((2.5, 4.5), (3.5, 4.5))
    run.pairs.arrays.slip[near] = 0.3
    run.watch.begin(run.pairs)
    run.pairs.arrays.slip[run.between((5.5, 0.5), (5.5, 1.5))] = 0.1
    found = run.look(50)
    later.run.state.take(run.run.state.arrays() | {"step": np.array(0)})  # to which no tracker has gone on
    later.pairs = later.system.contacts["body"]
    later.pairs.arrays.force[0, later.pairs.live[0]] = 1e6
    assert later.look(60) == found == {"bottom": {"time": 50 * STEP, "position": [5.5, 1.0]}}
