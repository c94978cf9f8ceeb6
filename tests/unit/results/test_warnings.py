"""What a run has shown that was probably not meant, whatever moved."""

import shutil
from pathlib import Path

import h5py
import numpy as np
import pytest

from dembound.disks.reports.warnings import warnings_after_disks
from dembound.disks.scene import build

TIME = np.linspace(0.0, 1.0, 1001)

KEPT = {"supplied": 1.0, "closing": 0.0, "relative_error": 0.0}
"""The energy ledger of a run in which nothing is missing."""


@pytest.fixture
def moved(small_run, tmp_path):
    """What is warned of where the monitors of a case have moved at some velocities."""

    def find(case, broken=(), component: int = 0, energy: dict | None = None, **velocities: np.ndarray) -> list[str]:
        path = Path(shutil.copy(small_run, tmp_path / "run.h5"))
        with h5py.File(path, "r+") as file:
            del file["histories"], file["cracks"]
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
"""One that is over at half time."""


def test_a_motion_that_is_over_is_not_warned_of(bar, moved) -> None:
    assert moved(two(bar), near=PULSE, far=0.5 * PULSE) == []


@pytest.mark.parametrize(("share", "warned"), [(0.199, False), (0.201, True)])
def test_a_motion_that_goes_on_is_warned_of(bar, moved, share: float, warned: bool) -> None:
    # it swings a hundred times, in the last twentieth five times
    coda = share * np.sin(200.0 * np.pi * TIME + 0.1) * (TIME > 0.5)
    crest = np.abs(coda).max() / share  # that of the samples
    said = (
        "monitor.near: its velocity is 20 % of its peak when the run ends after 1 s, and still changes "
        "(1 of 2 monitors); the motion is not over, take a longer run.duration"
    )
    assert moved(two(bar), near=PULSE + coda / crest, far=PULSE) == warned * [said]


@pytest.mark.parametrize(("change", "warned"), [(0.199, False), (0.201, True)])
def test_a_steady_motion_is_over(bar, moved, change: float, warned: bool) -> None:
    # from its peak on it slows evenly over the last tenth of the run, of which 100 samples hold 99 intervals
    flight = np.minimum(np.minimum(2.0 * TIME, 1.0), 1.0 - change * (TIME - 0.901) / 0.099)
    assert len(moved(two(bar), near=flight)) == warned


def test_the_worst_monitor_is_named_and_all_are_counted(bar, moved) -> None:
    rising = {"near": np.minimum(PULSE + TIME**40, 1.0), "far": PULSE + 0.4 * TIME**40}
    (warning,) = moved(two(bar), component=1, **rising)

    assert warning.startswith("monitor.near: its velocity is 100 % of its peak when the run ends after 1 s")
    assert "(2 of 2 monitors)" in warning


@pytest.mark.parametrize(("period", "warned"), [(0.2, False), (0.6, True)])
def test_a_crest_is_no_steady_motion(bar, moved, period: float, warned: bool) -> None:
    # the last tenth of the run is its crest alone, 0.976 and more; three tenths, half of 0.6 s, begin at half of it
    crest = np.cos(np.pi * (TIME - 0.95)) ** 2
    assert len(moved(two(bar, {"wave.pulse.period": period}), near=crest)) == warned


@pytest.mark.parametrize(("largest", "warned"), [(0.011, True), (0.009, False)])
def test_what_the_motion_has_not_reached_does_not_move(bar, moved, largest: float, warned: bool) -> None:
    found = moved(two(bar), near=PULSE, far=largest * TIME**40)
    assert [warning.split(":")[0] for warning in found] == warned * ["monitor.far"]


def test_bodies_that_nothing_brakes_move_on(bar, moved) -> None:
    free = {side: {"type": "free"} for side in ("left", "right")}
    free["left"] = {"type": "velocity", "wave_p": "pulse"}
    assert moved(two(bar, {"boundary": free}), near=TIME**4) == []
    assert len(moved(two(bar, {"boundary": free, "material.damp": 0.1}), near=TIME**4)) == 1


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


def test_twins_in_the_column_are_no_monitors(bar, moved) -> None:
    sides = {"left": {"type": "free_field"}, "bottom": {"type": "viscous_input", "wave_p": "pulse"}}
    case = two(bar, {"boundary": sides, "motion.held": [], "packing.size": [10.0, 5.0]})
    quiet = {"near": PULSE, "far": PULSE, "near__free_field": TIME**4, "far__free_field": TIME**4}
    assert moved(case, **quiet) == []


def test_monitors_in_a_continuum_come_to_rest(bar, moved) -> None:
    sides = {side: {"type": "outside"} for side in ("left", "right")}
    places = [{"name": name, "position": [x, 0.5]} for name, x in (("near", 2.0), ("far", -0.9))]
    case = bar({"boundary": sides, "outside.element": 1.0, "motion.held": [], "monitor": places})

    assert [warning.split(":")[0] for warning in moved(case, near=PULSE, far=TIME**4)] == ["monitor.far"]


def test_one_monitor_or_none(bar, moved) -> None:
    assert moved(bar({"monitor": []})) == []
    assert moved(bar(), middle=np.zeros(1001)) == []


@pytest.mark.parametrize(
    ("energy", "said"),
    [
        ({"closing": 0.0099, "relative_error": 0.0099}, []),
        (
            {"closing": 0.12},
            [
                "run.safety: contacts that open and close within a step have taken 12 % of the energy put in; "
                "shorter steps change it less"
            ],
        ),
        (
            {"closing": -0.02, "supplied": 0.5},
            [
                "run.safety: contacts that open and close within a step have added 4 % of the energy put in; "
                "shorter steps change it less"
            ],
        ),
        (
            {"relative_error": 0.03},
            ["energy.error: 3 % of the energy put in is unaccounted for; take shorter steps"],
        ),
    ],
)
def test_energy_that_steps_take_or_that_is_missing_is_warned_of(bar, moved, energy: dict, said: list[str]) -> None:
    assert moved(two(bar), energy=KEPT | energy, near=PULSE, far=0.5 * PULSE) == said
