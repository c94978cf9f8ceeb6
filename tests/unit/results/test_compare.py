"""Histories beside those of a reference run: smooth ones at other times by cubics, jumps without overshoot."""

import h5py
import numpy as np
import pytest

from dembound.results.compare import at_times, compare

TIME = np.linspace(0.0, 1.0, 101)


def record(path, name, histories, place=(0.0, 0.0)):
    """A record with histories of motion along x and y, name -> (time, x, y); place : of all, or by name."""
    with h5py.File(path, "w") as file:
        file.attrs["name"], file.attrs["size"] = name, (10.0, 5.0)
        for monitor, (time, x, y) in histories.items():
            group = file.create_group(f"histories/{monitor}")
            group["time"] = time
            group["velocity"] = np.column_stack([x, y, np.zeros_like(time)])
            group.attrs["requested"] = (0.0, 0.0)
            group.attrs["position"] = place[monitor] if isinstance(place, dict) else place
    return path


def test_errors_are_those_of_the_component_that_moves_most_in_the_reference(tmp_path):
    nothing = np.zeros_like(TIME)
    reference = record(tmp_path / "a.h5", "a", {"P": (TIME, 0.75 * TIME, TIME), "Q": (TIME, TIME, nothing)})
    # twice as finely sampled and half as long
    time = np.linspace(0.0, 0.5, 101)
    histories = {"P": (time, 0.75 * 1.2 * time, 1.1 * time), "R": (time, time, time)}
    run = record(tmp_path / "b.h5", "b", histories, (3.0, 4.0))

    (found,) = compare(reference, [run], "velocity")

    assert (found.run, found.monitor, found.component) == ("b", "P", "y")
    assert (found.rms, found.peak, found.across) == tuple(pytest.approx(error) for error in (0.1, 0.1, 0.2))
    assert (found.last, found.reference_last) == (pytest.approx(0.55), pytest.approx(0.5))
    assert (found.unit, found.place, found.reference_place) == ("m/s", "(3.00, 4.00) m", "(0.00, 0.00) m")
    assert found.apart == pytest.approx(5.0)


def test_a_component_that_the_reference_hardly_has_gives_no_error(tmp_path):
    wave = np.sin(6.0 * TIME)
    reference = record(tmp_path / "a.h5", "a", {"P": (TIME, 1e-9 * wave, wave)}, (1.0, 2.0))
    run = record(tmp_path / "b.h5", "b", {"P": (TIME, 0.3 * wave, wave)}, (1.0, 2.0 + 1e-12))

    (found,) = compare(reference, [run], "velocity")

    assert (found.component, found.rms, found.across) == ("y", 0.0, None)
    assert found.apart == 0.0  # rounding


def test_what_is_still_in_the_reference_is_left_out_and_the_others_are_compared(tmp_path):
    moves, noise, late = np.sin(TIME), 1e-12 * np.sin(50.0 * TIME), 1.0 * (TIME > 0.6)
    columns = {"P": moves, "P.free_field": noise, "Q": 0.0 * TIME, "late": late}
    reference = record(tmp_path / "a.h5", "a", {name: (TIME, x, noise) for name, x in columns.items()})
    time, left_out = 0.5 * TIME, []
    run = record(tmp_path / "b.h5", "b", {name: (time, 1.1 * np.sin(time), 0.0 * time) for name in columns})
    found = compare(reference, [run], "velocity", leave_out=left_out.append)
    assert [(line.monitor, round(line.rms, 4)) for line in found] == [("P", 0.1)]
    assert left_out == ["P.free_field", "Q", "late"]


def test_a_shift_is_taken_off_only_where_both_records_know_theirs(tmp_path):
    wave, still = np.sin(6.0 * TIME), np.zeros_like(TIME)
    early = record(tmp_path / "a.h5", "a", {"P": (TIME, wave, still)})
    late = record(tmp_path / "b.h5", "b", {"P": (TIME + 0.01, wave, still)})
    assert compare(early, [late], "velocity")[0].shift == 0.0
    for path, by in ((early, -0.002), (late, 0.008)):
        with h5py.File(path, "r+") as file:
            file.attrs["late"] = by
    (found,) = compare(early, [late], "velocity")
    assert found.shift == pytest.approx(0.01)
    assert found.rms < 1e-6
    assert compare(early, [late], "velocity", as_recorded=True)[0].rms > 0.05  # ωΔt = 0.06


REQUESTED = np.sort(np.random.default_rng(0).uniform(0.0, 10.0, 5000))


def error(motion, samples: int) -> tuple[float, float, float]:
    """RMS over RMS of the error of `samples` a second, that by straight lines, and the largest value found."""
    time = np.linspace(0.0, 10.0, 10 * samples + 1)
    found, expected = at_times(time, motion(time), REQUESTED), motion(REQUESTED)
    straight = np.interp(REQUESTED, time, motion(time))
    by_cubics, by_lines = (float(np.linalg.norm(each - expected)) for each in (found, straight))
    return by_cubics / np.linalg.norm(expected), by_lines / np.linalg.norm(expected), float(found.max())


@pytest.mark.parametrize("samples", [5, 20])
def test_sines_have_the_error_of_a_spline(samples: int) -> None:
    # a cubic spline errs by h⁴f⁗/384 at most, (2π/n)⁴/384 of a sine; at its ends, of f⁗h⁴ times 9/384, twice in 10
    # periods of n intervals; RMS over RMS of a sine √2 of it where it errs alike everywhere
    found, straight, _ = error(lambda time: np.sin(2.0 * np.pi * time + 0.3), samples)
    assert found < 2.5 * (2.0 * np.pi / samples) ** 4 / 384.0
    assert found < 0.12 * straight


JUMPS = {
    "step": lambda time: 1.0 * (time > 3.03),
    "sine that jumps to another": lambda t: np.where(t < 5.03, np.sin(2 * np.pi * t), 1.5 + np.sin(4 * np.pi * t)),
}


@pytest.mark.parametrize("name", JUMPS)
def test_a_jump_is_crossed_straight(name: str) -> None:
    """Where the motion jumps between two samples nothing is known, and nothing rings beside it."""
    found, straight, largest = error(JUMPS[name], 20)
    assert found <= straight * (1.0 + 1e-12)
    assert largest <= max(JUMPS[name](REQUESTED)) * (1.0 + 1e-3)


def test_samples_are_kept_and_ends_go_on() -> None:
    time, values = np.linspace(0.0, 1.0, 11), np.random.default_rng(1).standard_normal((11, 2))
    assert at_times(time, values, time) is values
    np.testing.assert_allclose(at_times(time, values, time[2:7] + 1e-15), values[2:7], atol=1e-13)
    np.testing.assert_allclose(at_times(time, values, np.array([-1.0, 2.0])), values[[0, -1]], atol=1e-13)
