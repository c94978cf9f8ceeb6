"""The wave that enters a bar at an end."""

import numpy as np
import pytest

from dembound.bar.scene import entering_pressure

TIME = np.array([-1e-5, 5e-5, 2e-4, 4e-4])
SHAPE = np.array([0.0, 0.25, 1.0, 0.0])
"""An even triangle of 0.4 ms."""
DASHPOT = {"type": "viscous_input", "beta_p": 0.5}


@pytest.mark.parametrize(
    ("side", "end", "wave", "load"),
    [
        # of ρcA v = F − βρcA v + 2βρcA v_i, with ρc = 2.5e6 Pa·s/m
        ("left", DASHPOT, 2.5e6 * 2.0 * 0.5 / 1.5, 12e6 / 1.5),
        ("right", DASHPOT, 2.5e6 * 2.0 * 0.5 / 1.5, 12e6 / 1.5),
        ("right", {"type": "matched_layer"}, 2.5e6, 6e6),
    ],
)
def test_a_dashpot_takes_its_part_of_a_load_and_lets_its_wave_in(spalling, side, end, wave, load) -> None:
    hit = {"name": "hit", "pressure": 12e6, "wave": "hit", "side": side}
    velocity = 1.0 if side == "left" else -1.0  # inwards
    shape = {"type": "triangle", "amplitude": velocity, "rise": 2e-4, "fall": 2e-4}
    case = spalling({"load": [hit], f"boundary.{side}": end | {"wave_p": "in"}, "wave.in": shape})

    np.testing.assert_allclose(entering_pressure(case, side, TIME, loads=False), wave * SHAPE, rtol=1e-12, atol=1e-6)
    np.testing.assert_allclose(entering_pressure(case, side, TIME), (wave + load) * SHAPE, rtol=1e-12, atol=1e-6)
    assert entering_pressure(case, side, np.zeros((2, 3))).shape == (2, 3)
