"""What a bar's case would come to."""

import numpy as np
import pytest

from dembound.bar.check import bar_facts, bar_warnings, cells_of_waves, method_in_words
from dembound.check import check, precautions
from dembound.exact.dispersion import cells_per_wavelength, courant_limit
from dembound.run import plan

PULSE = 5.36 / 4e-4
"""Where the spectrum of the even triangle of 0.4 ms has faded, Hz: 5.36 over its length."""

LONG = {"wave.hit.rise": 1e-2, "wave.hit.fall": 1e-2}
"""That triangle drawn out to waves far longer than the bar."""


def facts_of(case) -> dict[str, str]:
    planned = plan(case)
    return bar_facts(planned.scene, planned.time_step)


def test_facts_are_those_of_the_bar(spalling) -> None:
    ends = {"boundary.right": {"type": "viscous"}, "bar.attenuation": 0.2}
    facts = facts_of(spalling(ends))

    assert facts["nodes"] == "41, 0.025 m apart"
    assert facts["method"] == "peridynamics, horizon = 3, corrected_ends = False"
    assert facts["Courant number"] == "1"
    assert facts["bar"] == "1 m long, section 1 m², density 2500 kg/m³"
    assert facts["stiffness"] == "E = 2.5 GPa, c = 1000 m/s"
    assert facts["strength"] == "8 MPa, critical stretch 0.0032"
    assert facts["attenuation"] == "0.2 1/m"
    assert (facts["left end"], facts["right end"]) == ("free", "viscous")
    assert facts["load hit"] == "up to 12 MPa, 1.2e+07 Pa times wave hit, on 3 node(s) at the left end"
    assert facts["monitor gauge"] == "node 21 at 0.525 m"


def test_what_a_bar_lacks_is_not_told(spalling) -> None:
    bar = {"length": 1.0, "spacing": 0.025, "density": 2500.0, "wave_speed": 1000.0}
    facts = facts_of(spalling({"bar": bar, "monitor": [], "load": []}))

    assert facts["strength"] == "unbreakable"
    assert not {"attenuation", "load hit", "monitor gauge"} & set(facts)


def test_the_largest_pressure_is_told_whatever_a_wave_reaches(spalling) -> None:
    load = {"name": "hit", "pressure": -1.0, "side": "right", "wave": "hit"}
    facts = facts_of(spalling({"load": [load], "wave.hit.amplitude": 9e6}))

    assert facts["load hit"] == "up to 9 MPa, -1 Pa times wave hit, on 1 node(s) at the right end"


def test_methods_in_words(spalling) -> None:
    assert method_in_words(spalling({"method": {"type": "finite_difference"}})) == "finite_difference"
    patch = {"type": "patch", "horizon": 3, "reach": 5}
    assert method_in_words(spalling({"method": patch})) == "patch, horizon = 3, trigger = 0.9, reach = 5"


def test_cells_in_the_shortest_wavelength(spalling) -> None:
    found, needed = cells_of_waves(spalling(), 2e-5)["hit"]

    # 5.36 is given to two decimals
    assert found == pytest.approx(1000.0 / PULSE / 0.025, rel=1e-3)
    assert needed == cells_per_wavelength(3, 0.8, 0.01)


@pytest.mark.parametrize(
    "method",
    [
        {"type": "finite_difference"},
        {"type": "peridynamics", "horizon": 1},
        {"type": "switch", "horizon": 3},
        {"type": "patch", "horizon": 3},
    ],
    ids=str,
)
def test_cells_needed_are_those_of_the_horizon_that_carries_waves(spalling, method: dict) -> None:
    # families of three spacings come about only where something breaks
    needed = cells_of_waves(spalling({"method": method}), 2e-5)["hit"][1]
    assert needed == cells_per_wavelength(1, 0.8, 0.01)
    assert needed < cells_of_waves(spalling(), 2e-5)["hit"][1]


def test_waves_count_where_they_load_the_bar_or_enter_it(spalling) -> None:
    short = {"type": "triangle", "amplitude": 1.0, "rise": 1e-6, "fall": 1e-6}
    entrance = {"type": "viscous_input", "wave_p": "in"}
    ends = {"boundary.left": entrance, "method.corrected_ends": True}
    case = spalling({**LONG, **ends, "wave.in": short, "wave.spare": short})

    assert set(cells_of_waves(case, 2e-5)) == {"hit", "in"}
    assert [warning.split(":")[0] for warning in bar_warnings(case, 2e-5)] == ["wave.in"]


def test_cells_needed_at_the_limit_of_a_short_bar(spalling) -> None:
    # ends make a bar stable a little beyond the limit of an endless one, for which cells are counted
    step = courant_limit(3) * (1.0 + 1e-6) * 0.025 / 1000.0
    assert cells_of_waves(spalling(), step)["hit"][1] == cells_per_wavelength(3, courant_limit(3), 0.01)


@pytest.mark.parametrize(("share", "warned"), [(0.99, True), (1.01, False)])
def test_waves_too_short_for_the_nodes_are_warned_of(spalling, share: float, warned: bool) -> None:
    _, needed = cells_of_waves(spalling(), 0.8 * 2.5e-5)["hit"]
    half = 0.5 * 5.363 * share * needed * 2.5e-5  # 5.363 is what 5.36 comes to for an even triangle
    case = spalling({"wave.hit.rise": half, "wave.hit.fall": half, "run.courant": 0.8})

    warnings = bar_warnings(case, 0.8 * 2.5e-5)
    assert precautions(case) == warnings
    assert [warning.split(":")[0] for warning in warnings] == warned * ["wave.hit"]
    if warned:
        assert f"fewer than the {needed:.3g}" in warnings[0]
        assert warnings[0].endswith("take a smaller bar.spacing or method.horizon")


def test_only_a_horizon_can_be_made_smaller(spalling) -> None:
    for method in (
        {"type": "finite_difference"},
        {"type": "peridynamics", "horizon": 1},
        {"type": "switch", "horizon": 3},
        {"type": "patch", "horizon": 3},
    ):
        case = spalling({"method": method, "wave.hit.rise": 1e-6, "wave.hit.fall": 1e-6})
        (warning,) = bar_warnings(case, 1e-6)
        assert warning.endswith("take a smaller bar.spacing")


def test_a_wave_that_has_no_highest_frequency_is_never_long_enough(spalling) -> None:
    step = {"type": "constant", "amplitude": 1.0}
    found, needed = cells_of_waves(spalling({"wave.hit": step}), 2e-5)["hit"]

    assert found == 0.0 < needed < np.inf


@pytest.mark.parametrize(
    ("method", "warned"),
    [
        ({"type": "finite_difference"}, False),
        ({"type": "patch", "horizon": 3}, False),
        ({"type": "peridynamics", "horizon": 3}, True),
        ({"type": "peridynamics", "horizon": 3, "corrected_ends": True}, False),
        ({"type": "switch", "horizon": 3}, True),
        ({"type": "switch", "horizon": 3, "corrected_ends": True}, False),
    ],
    ids=str,
)
def test_dashpots_at_soft_ends_are_warned_of(spalling, method: dict, warned: bool) -> None:
    ends = {"left": {"type": "viscous_input", "wave_p": "hit"}, "right": {"type": "viscous"}}
    case = spalling({"method": method, "boundary": ends, **LONG})

    warnings = bar_warnings(case, 2e-5)
    assert [warning.split(":")[0] for warning in warnings] == warned * ["boundary.left", "boundary.right"]
    assert all(warning.endswith("give method.corrected_ends = true") for warning in warnings)
    # without dashpots nothing has to be absorbed
    ends = {"left": {"type": "fixed"}, "right": {"type": "free"}}
    assert bar_warnings(spalling({"method": method, "boundary": ends, "load": []}), 2e-5) == []


@pytest.mark.parametrize(("unit", "warned"), [(1.0, False), (1e6, True)])
def test_a_record_in_microseconds_is_warned_of(spalling, tmp_path, unit: float, warned: bool) -> None:
    # of a millisecond, sampled often enough that what its spectrum holds is long beside the nodes
    time = np.linspace(0.0, 1e-3, 101)
    path = tmp_path / "blow.txt"
    np.savetxt(path, np.column_stack([unit * time, 1.0 - np.cos(2e3 * np.pi * time)]))
    case = spalling({"wave.hit": {"type": "file", "path": str(path), "start": 1e4}})

    said = "wave.hit: its 1000 s are longer than the run of 0.0015 s; are its file's times in s?"
    assert [warning for warning in bar_warnings(case, 2.5e-5) if "times" in warning] == warned * [said]


def test_check_tells_of_the_run_and_the_bar(spalling) -> None:
    facts, warnings = check(spalling())

    assert facts["steps"] == "60 for 0.0015 s"
    assert facts["time step"].startswith("2.5e-05 s, ")
    assert facts["estimated time"].startswith("about ")
    assert facts["nodes"] == "41, 0.025 m apart"
    assert warnings == bar_warnings(spalling(), 2.5e-5)
