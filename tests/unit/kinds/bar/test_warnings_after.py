"""Warnings about probable mistakes in a bar's case, after the run."""

import json
from pathlib import Path

import h5py
import pytest
from small_cases import SPALLING, small

from dembound.bar.scene import build_bar
from dembound.kinds.bar.warnings_after import warnings_after_bar
from dembound.running import resume_case, run_case


def _summary(folder: Path) -> dict:
    return json.loads((folder / "summary.json").read_text())


def after(case, folder: Path) -> list[str]:
    return warnings_after_bar(build_bar(case), _summary(folder), folder / "run.h5")


@pytest.fixture
def run(spalling, tmp_path):
    """Warnings after a run of the spalling bar with keys changed."""

    def make(changes: dict) -> list[str]:
        case = spalling({"output.pictures": False, **changes})
        return after(case, run_case(case, tmp_path))

    return make


def summary_of(*spalls: dict) -> dict:
    """A summary with these spalls, with the entries that warnings use."""
    energy = {"supplied": 1.0, "closing": 0.0, "relative_error": 0.0}
    rest = {"breaks_at_ends": {}, "open_contacts": [], "crack_strain_rates": None, "energy": energy}
    return {"duration": 1.0, "spalls": list(spalls), **rest}


def test_a_bar_that_spalls_is_not_warned_of(run) -> None:
    assert run({}) == []


def blow(pressure: float, nodes: int, side: str = "left") -> dict:
    return {"load": [{"name": "blow", "pressure": pressure, "nodes": nodes, "wave": "hit", "side": side}]}


def test_contacts_that_never_close_are_warned_of(tmp_path) -> None:
    """At 10 m/s a gap of 2 mm is closed at 0.2 ms; in 2 ms the rod does not come as far as the next one of 0.1 m."""
    ranges = [
        {"name": "striker", "length": 0.2, "velocity": 10.0},
        {"name": "rod", "length": 0.2, "interface": "contact", "gap": 2e-3},
        {"name": "far", "length": 0.2, "interface": "contact", "gap": 0.1},
    ]
    bar = {"spacing": 0.025, "density": 2500.0, "wave_speed": 1000.0, "range": ranges}
    tables = {"bar": bar, "method": SPALLING["method"], "run": {"duration": 1e-4}, "output": {"pictures": False}}
    folder = run_case(small(tables), tmp_path)
    assert _summary(folder)["open_contacts"] == ["rod", "far"]
    folder = resume_case(folder, until=2e-3)  # the striker is back, and its contact open again
    assert _summary(folder)["open_contacts"] == ["far"]
    (line,) = (line for line in _summary(folder)["warnings"] if "contact" in line)
    assert line.startswith("bar.range[3, far]: its contact with rod, 0.1 m wide at the start, has never closed until ")


SUDDEN = {"wave.hit.rise": 2.5e-5, "wave.hit.fall": 2.5e-4}


def entering(speed: float, side: str) -> dict:
    """A wave inwards at an end; 10 m/s are 25 MPa, three times the strength."""
    end = {side: {"type": "viscous_input", "wave_p": "hit"}}
    return SUDDEN | {"load": [], "wave.hit.amplitude": speed if side == "left" else -speed, "boundary": end}


LONG_BONDS = {"method": {"type": "peridynamics", "horizon": 5, "corrected_ends": True}, "run": {"duration": 1.5e-3}}
FINER = "take a smaller bar.spacing, or a weaker or slower wave"
PUSHES = "change the sign of wave.hit if it is to push"
OTHER_SIGN = "change the sign of load.blow.pressure if it is to push"


@pytest.mark.parametrize(
    ("side", "load", "speed", "changes", "key", "what", "cure"),
    [
        ("left", 9e7, None, {}, "load.blow", "load itself", "give load.blow.nodes = 3"),
        # peridynamics swings behind a front shorter than its horizon
        ("left", None, 10.0, LONG_BONDS, "boundary", "incoming wave itself", FINER),
        ("right", 3e7, None, {"wave.hit.amplitude": -1.0}, "load.blow", "load pulls, with ", OTHER_SIGN),
        ("left", None, -10.0, {}, "boundary", "incoming wave pulls, with ", PUSHES),
    ],
)
def test_what_tears_the_end_where_it_enters_is_warned_of(run, side, load, speed, changes, key, what, cure) -> None:
    given = SUDDEN | blow(load, 1 if load == 9e7 else 3, side) if load else entering(speed, side)
    (warning,) = run(given | changes)

    assert warning.startswith(f"{key}: the {what}" if load else f"{key}.{side}: the {what}")
    assert warning.endswith(f" m from the {side} end, before any reflected wave had returned there; {cure}")
    if changes is LONG_BONDS:  # fifty cells in a pulse
        assert not run(given | changes | {"bar.spacing": 0.0025})


def spall(time: float, start: list[float]) -> dict:
    return {"time": time, "start": start, "end": start}


@pytest.mark.parametrize(
    ("side", "place", "time", "warned"),
    [
        ("left", 0.07, 1e-4, True),
        ("left", 0.0, 1.99e-3, True),
        ("left", 0.0, 2.01e-3, False),  # the wave is back from the free end
        ("right", 0.08, 1e-4, False),
    ],
)
def test_the_first_spall_tells_who_tore_the_bar(spalling, spalled_run, side, place, time, warned) -> None:
    """Cracks from the middle up to a place counted from the loaded end, with loads on as many nodes as the horizon."""
    first = spall(time, [place, 0.5] if side == "left" else [0.5, 1.0 - place])
    scene = build_bar(spalling(blow(12e6, 3, side)))
    found = warnings_after_bar(scene, summary_of(first, spall(1e-6, [0.0, 0.0])), spalled_run)

    said = f"load.blow: the load itself broke the bar, at {time:.4g} s and {place:g} m from the {side} end, before any "
    assert found == warned * [f"{said}reflected wave had returned there; take a smaller bar.spacing"]


FIRM = {"method": {"type": "finite_difference"}, "boundary.right": {"type": "viscous"}}
"""Changes with which, at ν = 1, the right end absorbs all, and nothing pulls but rounding."""


def test_a_bar_that_nothing_pulls_is_warned_of(spalling, tmp_path) -> None:
    case = spalling({"output.pictures": False, **FIRM})
    folder = run_case(case, tmp_path)
    (warning,) = after(case, folder)
    assert warning.startswith("bar: the largest tension reached is ")
    for tension, warned in ((4.1e5, False), (3.9e5, True)):
        with h5py.File(folder / "run.h5", "r+") as file:
            file["histories/gauge/stress"][3] = tension
        said = "bar: the largest tension reached is 390 kPa, 4.9 % of the strength, 8 MPa; nothing can break"
        assert after(case, folder) == warned * [said]
    unbroken = {"length": 1.0, "spacing": 0.025, "density": 2500.0, "wave_speed": 1000.0}
    assert after(spalling({**FIRM, "bar": unbroken}), folder) == []


@pytest.mark.parametrize(("rates", "beyond"), [([1e-3, 2e-3], "above 0.002"), ([1e4, 2e4], "below 10000")])
def test_cracks_at_strain_rates_without_a_strength_are_warned_of(run, rates: list[float], beyond: str) -> None:
    law = {"bar.fracture_energy": 2e3, "bar.strength_per_decade": 1e3, "bar.strength_rates": rates}
    law |= {"bar.spacing": 0.0125, "run.duration": 2.4e-3, **blow(20e6, 3)}
    (warning,) = (each for each in run(law) if "rates" in each)

    assert warning.startswith("bar.strength_rates: cracks had strain rates of ")
    assert f"{beyond}; the strength is constant there" in warning
