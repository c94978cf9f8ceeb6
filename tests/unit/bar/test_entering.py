"""The wave that enters a bar at an end."""

import numpy as np
import pytest

from dembound.bar.entering import entering_pressure, moments

TIME = np.array([-1e-5, 5e-5, 2e-4, 4e-4])
SHAPE = np.array([0.0, 0.25, 1.0, 0.0])
"""An even triangle of 0.4 ms."""


@pytest.mark.parametrize("side", ["left", "right"])
def test_a_dashpot_takes_its_part_of_a_load_and_lets_its_wave_in(spalling, side: str) -> None:
    load = {"name": "hit", "pressure": 12e6, "wave": "hit", "side": side}
    end = {"type": "viscous_input", "wave_p": "in", "beta_p": 0.5}
    velocity = 1.0 if side == "left" else -1.0  # inwards
    wave = {"type": "triangle", "amplitude": velocity, "rise": 2e-4, "fall": 2e-4}
    case = spalling({"load": [load], f"boundary.{side}": end, "wave.in": wave})

    # of ρcA v = F − βρcA v + 2βρcA v_i, with ρc = 2.5e6 Pa·s/m
    let_in = 2.5e6 * 2.0 * 0.5 / 1.5 * SHAPE
    np.testing.assert_allclose(entering_pressure(case, side, TIME, loads=False), let_in, rtol=1e-12, atol=1e-6)
    np.testing.assert_allclose(entering_pressure(case, side, TIME), let_in + 12e6 / 1.5 * SHAPE, rtol=1e-12, atol=1e-6)
    assert entering_pressure(case, side, np.zeros((2, 3))).shape == (2, 3)


@pytest.mark.parametrize("side", ["left", "right"])
def test_a_layer_takes_half_of_a_load_and_lets_its_wave_in(spalling, side: str) -> None:
    load = {"name": "hit", "pressure": 12e6, "wave": "hit", "side": side}
    velocity = 1.0 if side == "left" else -1.0  # inwards
    wave = {"type": "triangle", "amplitude": velocity, "rise": 2e-4, "fall": 2e-4}
    end = {"type": "matched_layer", "wave_p": "in"}
    case = spalling({"load": [load], f"boundary.{side}": end, "wave.in": wave})

    np.testing.assert_allclose(entering_pressure(case, side, TIME, loads=False), 2.5e6 * SHAPE, rtol=1e-12, atol=1e-6)
    np.testing.assert_allclose(entering_pressure(case, side, TIME), (2.5e6 + 6e6) * SHAPE, rtol=1e-12, atol=1e-6)


def test_a_wave_is_looked_at_from_its_start_to_its_end(spalling) -> None:
    time = moments(spalling({"wave.hit.start": 1e-3, "run.duration": 1e-2}), "left")

    # within two of 500 parts of the run
    assert time[0] == pytest.approx(1e-3, abs=4e-5)
    assert time[-1] == pytest.approx(1.4e-3, abs=4e-5)
    assert np.abs(time - 1.2e-3).min() < 1e-15


def test_where_nothing_enters_there_is_nothing_to_look_at(spalling) -> None:
    assert moments(spalling({"load": []}), "left").tolist() == [0.0]
