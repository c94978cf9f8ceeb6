"""Parts of histories, and which monitors count."""

import numpy as np
import pytest
from small_cases import around

from dembound.formulas.history import History, error_of_delay, error_of_steps, loud
from dembound.motion.kind import echoes
from dembound.running import plan

TIME = np.linspace(0.0, 1.0, 11)


def history(x: float, y: float) -> History:
    """A motion that grows with these speeds along x and y, and turns faster."""
    motion = np.outer(TIME, [x, y, 9.0])
    return History.of(np.zeros(2), TIME, motion, 2.0 * motion, 3.0 * TIME)


def test_parts_end_at_a_time_and_all_quantities_are_known_at_other_times() -> None:
    found = history(1.0, 2.0)
    assert found.until(0.5).time[-1] == TIME[5]
    assert found.before(0.5).time[-1] == TIME[4]
    assert len(found.before(0.5).values["stress"]) == 5
    assert found.until(1.0) is found
    found = history(1.0, 2.0).at(np.array([0.05, 0.95]))
    np.testing.assert_allclose(found.displacement[:, :2], [[0.05, 0.1], [0.95, 1.9]])
    np.testing.assert_allclose(found.values["stress"], [[0.15], [2.85]])


def test_monitors_below_a_hundredth_of_the_loudest_do_not_count() -> None:
    sizes = {"loud": -2.0, "just": 0.0201, "quiet": 0.0199}
    plain = {name: History(np.zeros(2), TIME, {"velocity": size * TIME[:, None]}) for name, size in sizes.items()}
    still = History(np.zeros(2), TIME, {})
    assert loud(plain | {"none": still}, "velocity") == ["loud", "just"]


TIMES = np.linspace(0.0, 4.0, 801)
LATE = 0.05


def pulse(t):
    return np.exp(-((t - 1.5) ** 2) / 0.08)


def test_a_constant_delay_is_taken_out_of_the_record():
    # The record is late by LATE, so the exact motion is pulse(t), and the error of the record the difference. The FFT
    # of a pulse that is 7 standard deviations off both ends of the record is exact to its values there, below 1e-10.
    record = np.column_stack([pulse(TIMES - LATE), 2.0 * pulse(TIMES - LATE)])
    velocity, displacement = error_of_delay(TIMES, record, lambda omega: np.full_like(omega, LATE))
    expected = pulse(TIMES - LATE) - pulse(TIMES)
    np.testing.assert_allclose(velocity[:, 0], expected, atol=1e-5)
    np.testing.assert_allclose(velocity[:, 1], 2.0 * expected, atol=2e-5)
    # the displacement lags by at most LATE times the largest velocity, and catches up with the exact one
    assert displacement[:, 0].min() == pytest.approx(-LATE, rel=1e-2)
    assert abs(displacement[-1, 0]) < 1e-4


@pytest.mark.parametrize(("last", "off"), [(2.4, 0.1), (2.0, 0.3)], ids=["on a slope", "on a bend"])
def test_a_record_may_end_within_a_wave(last, off):
    """A delay τ = κω² adds κ times the third derivative, and κ²/2 times the sixth, below 1 % of it here.

    The motion rises from rest to a constant slope, where its continuation is exact. On the bend to it the curvature is
    2.6 % of the largest one; what is added then by its jump is as large as the largest error, but only in the last
    κ^(1/3) = 0.01 s of some 0.3 s: the root of 1/30 or so, times 1/2 as it decays. A corner there would add 1 or more.
    """
    kappa, width = 1e-6, 0.1
    time = np.linspace(0.0, last, round(200 * last) + 1)
    x = (time - 1.5) / width
    sigmoid = 1.0 / (1.0 + np.exp(-x))
    expected = kappa * sigmoid * (1.0 - sigmoid) * (1.0 - 2.0 * sigmoid) / width**2

    velocity, _ = error_of_delay(time, width * np.logaddexp(0.0, x)[:, None], lambda omega: kappa * omega**2)

    assert np.linalg.norm(velocity[:, 0] - expected) < off * np.linalg.norm(expected)


def test_steps_make_velocities_smaller_and_displacements_larger():
    # a mass that is driven by the velocity v at half steps: u grows by Δt v(t + Δt/2), and the mean of two half steps
    # is recorded, so that what is found is exact but for (ωΔt)⁴, 4e-4 of it here
    step, omega = 0.2, 1.0
    time = np.linspace(0.0, 40.0, 201)
    halves = np.cos(omega * (time + 0.5 * step))
    recorded = 0.5 * (halves[1:] + halves[:-1])
    displacement = np.cumsum(step * halves)[:-1]
    exact = np.cos(omega * time)[1:], np.sin(omega * time)[1:] / omega
    velocity_error, displacement_error = error_of_steps(time[1:], recorded[:, None], step)
    inside = slice(2, -2)  # differences at the ends are one-sided
    drift = displacement - exact[1] - displacement_error[:, 0]  # a constant, as u begins with half a step
    np.testing.assert_allclose(velocity_error[inside, 0], (recorded - exact[0])[inside], atol=0.04 * step**2 / 8.0)
    assert np.ptp(drift[inside]) < 0.04 * step**2 / 24.0


BLOW = {"name": "blow", "force": [1e5, 0.0], "position": [30.25, 30.25], "wave": "pulse"}
COLUMN = {"packing.size": [60.0, 60.0], "motion.held": [], "load": [BLOW], "run.duration": 0.2} | {
    "boundary": around("free_field", "left", "right") | around("viscous", "bottom"),
    "monitor": [{"name": "P", "position": [40.25, 30.25]}],
}


def lines(case):
    return dict(echoes(plan(case)))


def test_columns_send_back_the_waves_of_local_sources_only(bar) -> None:
    # over the right side 29.75 + 19.75 m, over the left one 30.25 + 40.25 m, over the bottom 30.25 m twice, 10 m apart
    found = lines(bar(COLUMN))["echoes"].split("; ")
    sides = ("left (free_field)", "right (free_field)", "bottom (viscous)")
    assert [text.split(" from ")[0] for text in found] == [f"{side} may reflect to P" for side in sides]
    times = [float(text.split(" from ")[1].split(" s")[0]) for text in found]
    for time, way in zip(times, (70.5, 49.5, 61.3), strict=True):
        assert 0.9 * way < 1000.0 * time <= way
    from_below = {"boundary.bottom": {"type": "viscous_input", "wave_s": "pulse"}, "load": []}
    assert lines(bar({**COLUMN, **from_below})) == {}
