"""Errors of bars, estimated from their equations, beside exact motions and runs without the cause."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from estimated_bars import RICKER, SCENES, dalembert, estimated, recorded_of, rows, scene, true_errors
from small_cases import SPALLING, small

from dembound.accuracy.budget import Budget
from dembound.accuracy.choice import Choice
from dembound.accuracy.judge import extended
from dembound.accuracy.of_bars.causes import NO_ECHO, NO_GRID, ExactMotion, causes_of_bar
from dembound.accuracy.of_bars.judge import BarJudge
from dembound.accuracy.runner import Run
from dembound.bar.scene import build_bar
from dembound.formulas.bars.rods import Window
from dembound.formulas.cause import SIDES, Causes
from dembound.formulas.history import History
from dembound.kinds import with_changes
from dembound.running import plan

LATE = (
    "attenuation",
    "finite differences, ν = 0.5",
    "m = 1, soft ends",
    "m = 8, corrected ends",
    "ricker",
    "fine bar, m = 3",
    "viscous end",
    "viscous end, β = 0.7",
    "viscous soft end, m = 8",
    "matched layer, m = 8",
    "input",
    "attenuation, m = 3, viscous end",
)
"""Scenes with ``-m slow``: others have each of their methods, ends and waves."""


def share(causes: Causes, cause: str, monitor: str, quantity: str) -> np.ndarray:
    (found,) = [each for each in causes.found if each.name == cause]
    return found.parts[monitor][quantity][:, 0]


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.slow) if name in LATE else name for name in sorted(SCENES)]
)
def test_estimated_errors_are_the_true_ones(name: str) -> None:
    # The finer reference has 1/8² = 1.6 % of the error of the bar. Elsewhere the exact motion is summed from samples an
    # eighth of a step apart, which miss the corners of a triangle that rises in 18 steps by 0.1/(18·8) of its crest:
    # 7e-4 for some steps of 54 are 1e-4 in the RMS, 2 % of the smallest errors here, 6e-3, if all adds up.
    found = list(rows(name))

    assert len(found) == 6
    for row in found:
        if row.truth >= 1e-3:
            assert row.ratio == pytest.approx(1.0, abs=0.03), row
        else:
            assert row.estimate < 1.1e-3, row


def test_a_load_that_stays() -> None:
    # The body goes on beyond the record, ever faster without an absorbing end, and must not come in again. The exact
    # motion, from samples an eighth of a step apart, misses each of up to four jumps in 335 steps by half of it for an
    # eighth of a step: √(4/8/4/335) = 2 %, beside errors of 4.2 % another 11 % of these.
    case = with_changes(scene("finite differences, ν = 0.9"), {"wave.pulse": {"type": "constant", "amplitude": 1.0}})
    recorded, causes = estimated(case)

    assert not causes.limits
    for monitor, own in recorded.items():
        error = true_errors(case, own)["velocity"]
        assert Budget(recorded, causes).total(monitor, "velocity").value == pytest.approx(error, rel=0.12)


@pytest.mark.parametrize(
    "name", ["viscous soft end, m = 3", "wall in place of rock", "attenuation, m = 3, viscous end"]
)
def test_the_error_of_ends_is_the_difference_from_a_longer_bar(name: str) -> None:
    # both are linear bars in the same steps: precursors in the longer one are 1e-9, what comes after the window 1e-6
    case = scene(name)
    recorded, causes = estimated(case)
    longer, step = recorded_of(extended(case).case)

    assert step == plan(case).time_step
    for monitor, own in recorded.items():
        for quantity, values in own.values.items():
            true = values[:, 0] - longer[monitor].values[quantity][:, 0]
            rest = share(causes, SIDES, monitor, quantity) - true
            assert np.linalg.norm(rest) < 1e-5 * np.linalg.norm(values)


def test_nothing_is_said_about_a_bar_that_has_broken_but_about_the_time_before() -> None:
    case = small(SPALLING, changes={"run.duration": 3e-3, "monitor": [{"name": "gauge", "position": 0.5}]})
    recorded, causes = estimated(case)
    before = {name: _until(each, 1e-3) for name, each in recorded.items()}  # the crest comes back at 1.3 ms

    known = causes_of_bar(case, before, plan(case).time_step)

    assert not causes.found
    assert "gauge: its record differs by" in causes.limits[0]
    assert not known.limits
    error = true_errors(with_changes(case, {"wave.pulse": case.wave["hit"].given()}), before["gauge"])["velocity"]
    assert Budget(before, known).total("gauge", "velocity").value == pytest.approx(error, rel=0.03)


AT_ONE = {"run": {"duration": 1.1e-3, "courant": 1.0}}
EVEN = {"range": [{"name": "a", "length": 0.6}, {"name": "b", "length": 0.4, "wave_speed": 1370.0, "spacing": 0.005}]}


@pytest.mark.parametrize(
    ("name", "changes"),
    [
        ("viscous end", {}),
        ("viscous ends, loaded", RICKER),
        ("wall", {"method": {"type": "finite_difference"}}),
        ("viscous end", {"bar.range": EVEN["range"]}),
        ("patch", {"boundary.right": {"type": "viscous"}}),
    ],
)
def test_finite_differences_at_courant_number_1_are_exact(name: str, changes: dict[str, Any]) -> None:
    """Errors of grid and ends are reported as zero; only the error of summing displacements over steps remains."""
    case = with_changes(scene(name), AT_ONE | changes)
    recorded, causes = estimated(case)
    found = {each.name: each for each in causes.found}

    assert found["grid"].words == NO_GRID
    assert "sides" not in found or found["sides"].words == NO_ECHO
    for monitor, own in recorded.items():
        shares = Budget(recorded, causes).shares
        for quantity in ("velocity", "stress"):  # a window of e^{-13.8} and samples up to 1e-8 of the waves
            assert shares(monitor, quantity) == pytest.approx(dict.fromkeys(found, 0.0), abs=1e-6)
        if not case.bar.range:  # steps sum up rounding errors, Ricker's tail ends at 1e-9
            errors = true_errors(case, own)
            assert max(errors["velocity"], errors["stress"]) < 3e-7
            expected = pytest.approx(errors["displacement"], rel=0.03, abs=5e-5)
            assert shares(monitor, "displacement")["time step"] == expected


def test_loads_on_several_nodes_are_a_cause_of_their_own_at_courant_number_1() -> None:
    case = with_changes(scene("viscous end"), AT_ONE | {"load.hit.nodes": 3})
    recorded, causes = estimated(case)

    for monitor, own in recorded.items():
        shares = Budget(recorded, causes).shares(monitor, "velocity")
        assert shares["near loads"] == pytest.approx(true_errors(case, own)["velocity"], rel=0.01)
        assert shares["time step"] < 1e-6


def test_a_monitor_between_nodes_is_at_its_place() -> None:
    case = with_changes(scene("m = 3, soft ends"), {"monitor.far.position": 0.804, "bar.spacing": 0.01})
    recorded, causes = estimated(case)
    found = Budget(recorded, causes)

    assert recorded["far"].place[0] == pytest.approx(0.8)
    for quantity, values in recorded["far"].values.items():
        true = dalembert(case, 0.804, recorded["far"].time, quantity)
        error = np.linalg.norm(values[:, 0] - true) / np.linalg.norm(values[:, 0])
        assert found.total("far", quantity).value == pytest.approx(error, rel=0.03, abs=1e-4)
    assert found.shares("far", "velocity")["places"] > 0.01
    assert found.shares("near", "velocity")["places"] < 1e-12


def _until(recorded: History, time: float) -> History:
    kept = recorded.time <= time
    return replace(recorded, time=recorded.time[kept], values={q: v[kept] for q, v in recorded.values.items()})


def test_a_record_of_another_bar_is_noticed() -> None:
    case = scene("m = 3, soft ends")
    recorded, step = recorded_of(case)
    far = recorded["far"]
    recorded["far"] = replace(far, values=far.values | {"velocity": 1.05 * far.values["velocity"]})

    found = causes_of_bar(case, recorded, step)

    assert [line.split(":")[0] for line in found.limits] == ["far"]  # 5 % of 10 % is more than a third of the error
    assert "differs by 4.8 %" in found.limits[0]
    assert set(found.found[0].parts) == {"near"}

    recorded, causes = estimated(with_changes(scene("finite differences, ν = 0.9"), {"run.duration": 1.2e-4}))
    assert causes.limits == ["far: hardly moves"]  # which no wave has reached
    assert set(causes.found[0].parts) == {"near"}
    assert "far" in recorded


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        ({"bar.range.soft.interface": "contact"}, "bars with contacts, which open and close"),
        ({"bar.range.rock.velocity": 1.0}, "bars whose ranges move at the start"),
        ({"method.horizon": 31}, "bars with a horizon of more than 30 spacings"),
    ],
)
def test_what_is_not_estimated(changes: dict[str, object], line: str) -> None:
    case = scene("ranges" if "method.horizon" not in changes else "m = 3, soft ends")
    recorded = {"near": History(np.zeros(2), np.zeros(9), {"velocity": np.zeros((9, 2))})}

    found = causes_of_bar(with_changes(case, changes), recorded, 1e-6)

    assert (list(found.found), found.limits) == ([], [line])


def outcome(*positions: float) -> Run:
    """An outcome with gauges at these places, m."""
    nothing = np.zeros((1, 3))
    gauges = {f"g{k}": History.of(np.array([x, 0.0]), np.zeros(1), nothing, nothing) for k, x in enumerate(positions)}
    return Run(motions=gauges)


def choices(case, *spacings: float) -> list[Choice]:
    return [Choice(f"{size}", {}, with_changes(case, {"bar.spacing": size})) for size in spacings]


@pytest.mark.parametrize(
    ("spacings", "cells"),
    [
        ((0.05,), 80),
        ((0.05, 0.025), 160),
        ((0.1, 1.0 / 12.0), 60),  # 10 and 12 cells
        ((1.0 / 39.0, 0.025), 160),  # 39 · 40 would be 39 times as many as the finest
    ],
)
def test_its_nodes_are_where_those_of_all_choices_are(spalling, spacings, cells: int) -> None:
    case = spalling()
    found = BarJudge().finer(case, choices(case, *spacings), [outcome(0.5)])
    assert found.case.bar.cells == found.cells == cells
    assert found.spacing == pytest.approx(1.0 / cells)


def test_it_is_the_same_bar_by_finite_differences_at_courant_one(spalling) -> None:
    case = spalling(
        {
            "run": {"duration": 1e-3, "safety": 0.5, "until": "silent", "silent_level": 0.01},
            "method": {"type": "peridynamics", "horizon": 3},
            "load.1.nodes": 3,
        }
    )
    found = BarJudge().finer(case, choices(case, 0.025), [outcome(0.5)]).case
    assert found.run.model_dump(exclude_unset=True) == {"duration": 1e-3, "courant": 1.0}
    assert found.method.type == "finite_difference"
    assert found.load[0].nodes == 1  # on the end, at any spacing
    assert (found.load[0].pressure, found.wave, found.boundary) == (case.load[0].pressure, case.wave, case.boundary)


def test_it_records_at_the_places_of_every_choice(spalling) -> None:
    case = spalling()
    of_choices = [outcome(0.35, 1.0), outcome(0.325, 1.0)]
    found = BarJudge().finer(case, choices(case, 0.05, 0.025), of_choices)
    assert [monitor.position for monitor in found.case.monitor] == pytest.approx([0.325, 0.35, 1.0])
    run = Run(motions={m.name: outcome(m.position).motions["g0"] for m in found.case.monitor})
    for choice in of_choices:
        places = {name: gauge.place[0] for name, gauge in found.motions(run, choice).items()}
        assert places == pytest.approx({name: gauge.place[0] for name, gauge in choice.motions.items()})


def test_it_is_known_at_the_steps_of_every_choice() -> None:
    case = scene("viscous end")
    exact = ExactMotion(build_bar(case))
    assert exact.places == pytest.approx({"near": 0.2, "far": 0.8})

    # the last step ends after the run; the first two have their samples in common
    for step in (2.1e-6, 3.7e-6, 9.1e-6):
        window = Window.up_to(case.run.duration, step)
        found = exact.at(window)
        for name, place in exact.places.items():
            for quantity in ("velocity", "displacement", "stress"):
                expected = dalembert(case, place, window.time, quantity)
                rest = np.linalg.norm(found[name].values[quantity][:, 0] - expected)
                # corners between samples, an eighth of a step h apart, differ by up to h/8 of a slope: velocities that
                # rise within 60 µs by h/16/60 µs < 0.6 %, at three of the hundreds of samples
                assert rest < 1e-3 * np.linalg.norm(expected)
    assert len(exact._found) == 2  # steps from 2⁻¹⁹ s = 1.9 µs to 2⁻¹⁸ s = 3.8 µs share it
