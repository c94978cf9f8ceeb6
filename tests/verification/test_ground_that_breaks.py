"""Ground that breaks beside artificial sides comes to rest, and its base bears it as before.

Weak level ground at rest under its weight is shaken by an S burst until most of its bonds have broken. When the burst
has left, nothing but weight and the ground beyond acts on it.
"""

from functools import cache

import numpy as np
import pytest
from small_cases import small

from dembound.casefile.disks import DiskCase
from dembound.disks.scene import DiskScene
from dembound.motion.trackers import Clock
from dembound.running.planning import plan, simulation_of

FREE_FIELD = {side: {"type": "free_field"} for side in ("left", "right")}
WEAK = {
    "packing": {
        "pattern": "B", "size": [24.0, 8.0], "brick": [8.0, 8.0], "radius": 0.5, "radius_ratio": 1.5, "seed": 1,
    },
    "material": {
        "law": "linearpbond", "density": 2500.0, "emod": 5e8, "pb_emod": 5e8, "fric": 0.3, "pb_ten": 1e5, "pb_coh": 2e5,
    },
    "load": [{"name": "gravity", "acceleration": [0.0, -9.81]}],
    "static": {
        "boundary": {"bottom": {"type": "fixed"}, "left": {"type": "roller"}, "right": {"type": "roller"}},
    },
    "boundary": FREE_FIELD | {"bottom": {"type": "viscous_input", "wave_s": "burst"}},
    "wave": {"burst": {"type": "sine_burst", "amplitude": 0.5, "frequency": 5.0, "cycles": 2}},
    "run": {"duration": 3.5},
}  # fmt: skip


class Broken:
    """A run of the ground, and its bottom's mean displacement (k, 2) m over the last quarter of it."""

    def __init__(self, changes: dict[str, object]) -> None:
        case = small(WEAK, changes=changes)
        assert isinstance(case, DiskCase)
        planned = plan(case)
        assert isinstance(planned.scene, DiskScene)
        self.scene = planned.scene
        beginning = planned.kind.begin(planned.scene, planned.time_step, lambda *_: None)
        self.run, self.ledger = simulation_of(planned, beginning, Clock())
        self.run.track(self.ledger)
        base = self.scene.sides["bottom"].nodes
        self.base = []
        for _ in range(20):
            self.run.advance(planned.steps // 20)
            moved = self.run.state.displacement - self.run.state.datum
            self.base.append(moved[:2, base].mean(axis=1))
        self.cracks = self.run.system.take_cracks(self.run.state.step)

    @property
    def kinetic(self) -> np.ndarray:
        """Kinetic energy (J) of the entries of the ledger."""
        return np.array([entry.kinetic for entry in self.ledger.entries])

    @property
    def drift(self) -> np.ndarray:
        """Velocity (2,) m/s of the base over the last fifth of the run."""
        return (self.base[-1] - self.base[-5]) / (4.0 / 20.0 * self.run.time)


@cache
def broken(**changes: object) -> Broken:
    """A run with some keys of the boundary tables changed; a key is written with two underscores for a point."""
    return Broken({key.replace("__", "."): value for key, value in changes.items()})


def test_the_ground_comes_to_rest_and_its_base_to_its_place() -> None:
    found = broken()
    assert len(found.cracks) > 150
    assert found.kinetic.max() > 1e4
    # 0.1 J is a mean velocity of 0.8 mm/s, 1/600 of the wave's
    assert found.kinetic[-1] < 0.1
    assert np.abs(found.drift).max() < 1e-5
    # springs bear what has moved away from the sides: a twentieth of the weight, 0.2 MN, on those along the bottom,
    # which are the softest, α_s G = 0.4 GPa; with the sides' it moves less
    assert np.abs(found.base[-1]).max() < 5e-4


@pytest.mark.slow
def test_without_springs_the_base_creeps_and_without_a_zone_it_sinks() -> None:
    """What each of the two does: dashpots alone have no force at rest."""
    sides = ("left", "right", "bottom")
    creeps = broken(**{f"boundary__{side}__bearing": False for side in sides})
    assert np.abs(creeps.drift).max() > 20.0 * max(1e-5, float(np.abs(broken().drift).max()))
    sinks = broken(**{f"boundary__{side}__intact": 0 for side in sides})
    assert sinks.drift[1] < -0.01


def test_no_bond_of_the_zone_breaks_though_some_reach_their_strength() -> None:
    found = broken()
    scene, system = found.scene, found.run.system
    assert scene.intact is not None
    assert not scene.intact[found.cracks.pair].any()
    reached = system.side_watch.describe()["reached"]
    assert set(reached) == {"left", "right", "bottom", "free-field column"}
    assert all(each["bonds"] > 5 for each in reached.values())
    assert scene.intact[: scene.column_count].all()


def test_a_watched_run_that_holds_is_not_warned_of() -> None:
    said = broken().run.system.side_watch.describe()
    assert said["work"]["size"] < 0.05
    assert said["turn"]["size"] < 0.1
    assert said["ended"] == 0.0


def test_where_the_sides_do_not_hold_the_watch_says_so() -> None:
    said = broken(**{f"boundary__{side}__intact": 0 for side in ("left", "right", "bottom")}).run.system.side_watch
    assert said.ended > 0.1


def test_the_springs_are_in_the_account_of_their_side() -> None:
    """The ledger closes; the work of all sides is that of the outside, and the springs' a part of the bottom's."""
    found = broken()
    entry, sides = found.ledger.entries[-1], found.ledger.side_columns[-1]
    assert abs(entry.error) < 1e-4 * entry.supplied
    net = sides @ (1.0, -1.0, -1.0)
    assert net.sum() == pytest.approx(entry.outside, rel=1e-9)
