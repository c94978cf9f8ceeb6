"""A box of disks in ground that rests under its weight, or under the stress it was packed with, rests in a run, too.

A hole is excavated in it when it has settled. The weight it had lifts all ground round it: in a plane, such a force
moves everything as far as the logarithm of the distance to what holds it, here the end of the continuum. So the motion
of the wall is compared without its mean.
"""

from typing import NamedTuple

import numpy as np
import pytest

from dembound.disks.rest.settled import Settled
from dembound.disks.rest.stage import settle
from dembound.disks.scene import DiskScene, build

WEIGHT = [{"acceleration": (0.0, -9.81)}]
RATIO = 3e-6
STATIC = {"ratio": RATIO, "boundary": {"bottom": {"type": "fixed"}}}
STRONG = {"law": "linearpbond", "pb_ten": 1e12, "pb_coh": 1e12}
HOLE = {"name": "hole", "type": "circle", "centre": [30.0, 30.0], "radius": 4.0, "stage": "after"}
SMALL, LARGE = (20.0, 20.0, 40.0, 40.0), (10.0, 10.0, 50.0, 40.0)


class Ground(NamedTuple):
    """Ground at rest."""

    scene: DiskScene
    settled: Settled

    @property
    def wall(self) -> np.ndarray:
        """Displacements (k, 2) m of the disks round the hole since the ground had settled, without their mean."""
        scene, before = self.scene, self.settled.before
        assert before is not None
        moved = self.settled.start.displacement[:, : scene.disk_count] - before.start.displacement[:, scene.kept]
        away = np.hypot(*(scene.assembly.positions - 30.0).T)
        near = np.flatnonzero(away < 6.0)
        order = near[np.lexsort(scene.assembly.positions[near].T.round(6))]
        return (moved[:2, order] - moved[:2, order].mean(axis=1, keepdims=True)).T


def ground(lab, pattern: str, box, *, hole: bool, **words) -> Ground:
    changes = {"hole": [HOLE]} if hole else {}
    scene = build(lab.window(pattern, box, wave="", static=STATIC, changes=changes, **words))
    return Ground(scene, settle(scene))


HOUSE = {"name": "house", "force": [2e4, -2e5], "region": [25.0, 59.0, 35.0, 60.0]}  # on the continuum's surface
CASES = {
    "lattice": ("A", {"load": WEIGHT}),
    "house": ("A", {"load": [*WEIGHT, HOUSE]}),
    "random": ("B", {"load": WEIGHT}),
    "history": ("B", {"load": WEIGHT, "material": STRONG}),
    "locked in": ("B", {"material": STRONG | {"locked_in": 1e6}}),
}


@pytest.mark.parametrize(
    ("name", "hole"),
    [
        ("random", True),
        *(
            pytest.param(name, hole, marks=pytest.mark.slow)
            for name, hole in (("house", False), ("locked in", True), ("history", True))
        ),
    ],
)
def test_it_rests(lab, name: str, hole: bool) -> None:
    """Pulses are some 0.5 m/s. All forces are balanced to rounding, ε of the weight of 30 m of ground per ρ c."""
    pattern, words = CASES[name]
    at = ground(lab, pattern, SMALL, hole=hole, **words)
    simulation = lab.simulation(at.scene, at.settled.start)
    simulation.run(500)

    assert np.abs(simulation.state.velocity[:2]).max() < 1e-11
    assert np.abs(at.scene.steady_load[:, at.scene.disk_count :]).any() == (name == "house")
    assert at.settled.ratio <= RATIO


@pytest.mark.parametrize("name", ["lattice", pytest.param("locked in", marks=pytest.mark.slow)])
def test_a_hole_deforms_as_in_a_larger_box(lab, name: str) -> None:
    """The elements have the moduli of the ground; those of random disks in a box differ from these by some per cent."""
    pattern, words = CASES[name]
    small, large = (ground(lab, pattern, box, hole=True, **words).wall for box in (SMALL, LARGE))

    assert small.shape == large.shape
    assert np.abs(large).max() > 1e-4
    assert np.abs(small - large).max() < (2e-3 if pattern == "A" else 2e-2) * np.abs(large).max()
