"""What a run has shown that was probably not meant."""

import json
import shutil
from pathlib import Path

import h5py
import numpy as np
import pytest

from dembound.any_scene import build_scene
from dembound.bar.scene import build_bar
from dembound.run import run_case
from dembound.run_warnings import run_warnings
from dembound.scene import build

TIME = np.linspace(0.0, 1.0, 1001)


@pytest.fixture
def moved(small_run, tmp_path):
    """What is warned of where the monitors of a case have moved at some velocities."""

    def find(case, broken=(), component: int = 0, **velocities: np.ndarray) -> list[str]:
        path = Path(shutil.copy(small_run, tmp_path / "run.h5"))
        with h5py.File(path, "r+") as file:
            del file["histories"], file["cracks/particles"]
            file["cracks/particles"] = np.array(broken, dtype=np.int64).reshape(-1, 2)
            file.create_group("histories", track_order=True)
            for name, velocity in velocities.items():
                three = np.zeros((len(velocity), 3))
                three[:, component] = velocity
                file[f"histories/{name.replace('__', '.')}/velocity"] = three
        return run_warnings(build_scene(case), {"duration": 1.0, "spalls": []}, path)

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


def test_one_monitor_or_none(bar, moved) -> None:
    assert moved(bar({"monitor": []})) == []
    assert moved(bar(), middle=np.zeros(1001)) == []


@pytest.fixture
def run(spalling, tmp_path):
    """What is warned of after a run of the spalling bar with keys changed."""

    def make(changes: dict) -> list[str]:
        case = spalling({"output.pictures": False, **changes})
        folder = run_case(case, tmp_path)
        return run_warnings(build_bar(case), _summary(folder), folder / "run.h5")

    return make


def _summary(folder: Path) -> dict:
    return json.loads((folder / "summary.json").read_text())


def test_a_bar_that_spalls_is_not_warned_of(run) -> None:
    assert run({}) == []


def blow(pressure: float, nodes: int, side: str = "left") -> dict:
    return {"load": [{"name": "blow", "pressure": pressure, "nodes": nodes, "wave": "hit", "side": side}]}


SUDDEN = {"wave.hit.rise": 2.5e-5, "wave.hit.fall": 2.5e-4}


@pytest.mark.parametrize("side", ["left", "right"])
def test_a_load_that_tears_its_own_end_is_warned_of(run, side: str) -> None:
    (warning,) = run(SUDDEN | blow(9e7, 1, side))

    assert warning.startswith("load.blow: the load itself tore the bar, at ")
    assert warning.endswith(" m from the loaded end, before any wave was back there; give load.blow.nodes = 3")


def test_a_load_that_is_spread_already_takes_finer_nodes(run) -> None:
    (warning,) = run(SUDDEN | blow(-3e7, 3))

    assert warning.endswith("take a smaller bar.spacing")


@pytest.mark.parametrize(
    ("place", "time", "warned"),
    [
        (0.0, 1e-4, True),
        (0.07, 1e-4, True),
        (0.08, 1e-4, False),  # beyond the horizon, which is 0.075 m
        (0.0, 1.99e-3, True),
        (0.0, 2.01e-3, False),  # the wave is back from the free end
    ],
)
def test_the_first_spall_tells_who_tore_the_bar(spalling, spalled_run, place: float, time: float, warned: bool) -> None:
    first = {"time": time, "start": [place, 0.5], "end": [place, 0.5]}
    later = {"time": 1e-6, "start": [0.0, 0.0], "end": [0.0, 0.0]}
    found = run_warnings(build_bar(spalling()), {"duration": 1.0, "spalls": [first, later]}, spalled_run)

    # the load of this bar is spread over the horizon
    said = f"load.hit: the load itself tore the bar, at {time:.4g} s and {place:g} m from the loaded end, before any "
    assert found == warned * [f"{said}wave was back there; take a smaller bar.spacing"]


FIRM = {"method": {"type": "finite_difference"}, "boundary.right": {"type": "viscous"}}
"""At ν = 1 the right end absorbs all, and nothing pulls but rounding."""


def test_a_bar_that_nothing_pulls_is_warned_of(run) -> None:
    (warning,) = run(FIRM)

    assert warning.startswith("bar: the largest tension reached is ")
    assert warning.endswith(" % of the strength, 8e+06 Pa; nothing can break")
    assert run({**FIRM, "bar": {"length": 1.0, "spacing": 0.025, "density": 2500.0, "wave_speed": 1000.0}}) == []


@pytest.mark.parametrize(("tension", "warned"), [(4.1e5, False), (3.9e5, True)])
def test_the_largest_tension_beside_the_strength(spalling, tmp_path, tension: float, warned: bool) -> None:
    folder = run_case(spalling({"output.pictures": False, **FIRM}), tmp_path)
    with h5py.File(folder / "run.h5", "r+") as file:
        file["histories/gauge/stress"][3] = tension
    said = "bar: the largest tension reached is 3.9e+05 Pa, 4.9 % of the strength, 8e+06 Pa; nothing can break"

    assert run_warnings(build_bar(spalling(FIRM)), _summary(folder), folder / "run.h5") == warned * [said]


@pytest.mark.parametrize("changes", [{"run.duration": 5e-4}, blow(5.0, 3)], ids=["too short", "too weak"])
def test_what_was_known_before_the_run_is_not_told_again(run, changes: dict) -> None:
    assert run({"method": {"type": "finite_difference"}, **changes}) == []


def test_a_bar_comes_to_rest_where_a_dashpot_holds_the_piece(spalling, spalled_run, tmp_path) -> None:
    path = Path(shutil.copy(spalled_run, tmp_path / "run.h5"))
    with h5py.File(path, "r+") as file:
        velocity = file["histories/gauge/velocity"]
        velocity[:, 0] = np.linspace(0.0, 1.0, len(velocity)) ** 4
    scene = build_bar(spalling({"boundary.left": {"type": "viscous"}}))
    spall = {"time": 1.2e-3, "start": [0.9, 0.9], "end": [0.9, 0.95]}
    for where, warned in ((spall, True), ({**spall, "end": [0.3, 0.4]}, False)):
        found = run_warnings(scene, {"duration": 1.5e-3, "spalls": [where]}, path)
        assert [warning.split(":")[0] for warning in found] == warned * ["monitor.gauge"]
