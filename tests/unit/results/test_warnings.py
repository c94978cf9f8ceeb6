"""Warnings after a run, for any kind of body."""

import shutil
from dataclasses import fields
from pathlib import Path

import h5py
import numpy as np
import pytest

from dembound.disks.scene import build
from dembound.kinds.disks.summary import warnings_after_disks
from dembound.motion.energy import Entry

TIME = np.linspace(0.0, 1.0, 1001)

KEPT = {"supplied": 1.0, "closing": 0.0, "relative_error": 0.0}
"""The energy ledger of a run in which nothing is missing."""


@pytest.fixture
def moved(small_run, tmp_path):
    """Warnings for monitors of a case that have moved at some velocities."""

    def find(case, broken=(), component: int = 0, energy: dict | None = None, **velocities: np.ndarray) -> list[str]:
        path = Path(shutil.copy(small_run, tmp_path / "run.h5"))
        with h5py.File(path, "r+") as file:
            del file["histories"], file["cracks"]
            for name in (each.name for each in fields(Entry)):
                file[f"energy/{name}"] = np.resize((energy or KEPT).get(name, 0.0), 2)
            file["cracks/particles"] = np.array(broken, dtype=np.int64).reshape(-1, 2)
            file["cracks/time"] = np.zeros(len(broken))
            file.create_group("histories", track_order=True)
            for name, velocity in velocities.items():
                three = np.zeros((len(velocity), 3))
                three[:, component] = velocity
                file[f"histories/{name.replace('__', '.')}/velocity"] = three
        return warnings_after_disks(build(case), {"duration": 1.0, "energy": energy or KEPT, "static": None}, path)

    return find


def two(bar, changes: dict | None = None):
    """The bar with two monitors."""
    places = [{"name": name, "position": [x, 0.5]} for name, x in (("near", 2.0), ("far", 8.0))]
    return bar({"monitor": places, **(changes or {})})


PULSE = np.where(TIME < 0.5, np.sin(2.0 * np.pi * TIME), 0.0) ** 2
"""A pulse that is over at half time."""


def test_a_motion_that_goes_on_is_warned_of(bar, moved) -> None:
    # it swings a hundred times, in the last twentieth five times
    swings = np.sin(200.0 * np.pi * TIME + 0.1) * (TIME > 0.5)
    said = (
        "monitor.near: its velocity is 20 % of its peak when the run ends after 1 s, and still changes "
        "(1 of 2 monitors); the motion is not over, take a longer run.duration"
    )
    for share, warned in ((0.0, False), (0.199, False), (0.201, True)):
        near = PULSE + share * swings / np.abs(swings).max()
        assert moved(two(bar), near=near, far=0.5 * PULSE) == warned * [said]
    # what the motion has not reached does not move
    for largest, names in ((0.011, ["monitor.far"]), (0.009, [])):
        found = moved(two(bar), near=PULSE, far=largest * TIME**40)
        assert [warning.split(":")[0] for warning in found] == names
    assert moved(bar({"monitor": []})) == moved(bar(), middle=np.zeros(1001)) == []


def test_a_steady_motion_is_over_and_a_crest_is_none(bar, moved) -> None:
    # from its peak on it slows evenly over the last tenth of the run, of which 100 samples hold 99 intervals
    for change, warned in ((0.199, False), (0.201, True)):
        flight = np.minimum(np.minimum(2.0 * TIME, 1.0), 1.0 - change * (TIME - 0.901) / 0.099)
        assert len(moved(two(bar), near=flight)) == warned
    # the last tenth of the run is its crest alone, 0.976 and more; three tenths, half of 0.6 s, begin at half of it
    crest = np.cos(np.pi * (TIME - 0.95)) ** 2
    for period, warned in ((0.2, False), (0.6, True)):
        assert len(moved(two(bar, {"wave.pulse.period": period}), near=crest)) == warned


def test_pieces_that_have_come_off_move_on(bar, moved) -> None:
    case = two(bar, {"boundary.right": {"type": "free"}})
    scene = build(case)
    x = scene.positions[:, 0]
    # all bonds across x = 5 m but one, and then that one, too
    first, second = scene.assembly.pairs.T
    across = scene.assembly.pairs[(x[first] < 5.0) != (x[second] < 5.0)]

    assert "(2 of 2 monitors)" in moved(case, broken=across[:-1], near=TIME**4, far=TIME**4)[0]
    assert "(1 of 1 monitors)" in moved(case, broken=across[:, ::-1], near=TIME**4, far=TIME**4)[0]
    assert moved(case, broken=across, near=PULSE, far=TIME**4) == []


def test_energy_that_steps_take_or_that_is_missing_is_warned_of(bar, moved) -> None:
    taken = "run.safety: contacts that open and close within a step have {}; shorter steps change it less"
    swings = (
        "energy.stepping: is opposite to contact and bond, both up to 2.9 times all the energy there was: velocities "
        "and forces swing from step to step by more than waves do; take shorter steps, or waves that rise slower"
    )
    for energy, said in (
        ({"closing": 0.0099, "relative_error": 0.0099}, []),
        ({"closing": 0.12}, [taken.format("taken 12 % of the supplied energy")]),
        ({"closing": -0.02, "supplied": 0.5}, [taken.format("added 4 % of the supplied energy")]),
        ({"relative_error": 0.03}, ["energy.error: 3 % of the supplied energy is unaccounted for; take shorter steps"]),
        ({"closing": 1.0, "supplied": 0.0}, [taken.format("taken energy though none came in")]),
        ({"stepping": -1.0, "contact": 3.0}, []),
        ({"stepping": np.array([-2.9, 0.0]), "contact": np.array([2.0, 0.0]), "bond": np.array([1.0, 0.0])}, [swings]),
        # what had been stored at the start is released
        ({"contact": -3.0, "kinetic": 3.0}, []),
    ):
        assert moved(two(bar), energy=KEPT | energy, near=PULSE, far=0.5 * PULSE) == said


def test_sides_that_keep_waves_are_named(bar, moved) -> None:
    coda = np.sin(200.0 * np.pi * TIME)
    for boundary, said in (
        ({"left": "viscous", "bottom": "viscous"}, "the motion is not over, take a longer"),
        ({"left": "viscous"}, "the motion is not over: waves between bottom (free) and top (free) are not"),
        (
            {"bottom": "viscous", "left": "fixed", "right": "roller"},
            "waves between left (fixed) and right (roller) are",
        ),
    ):
        sides = {side: {"type": kind} for side, kind in boundary.items()}
        (found,) = moved(two(bar, {"motion.held": [], "wave": {}, "boundary": sides}), near=coda, far=coda)
        assert said in found
