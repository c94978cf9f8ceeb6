"""Stress over strain of a compressed lattice, from the histories of its sides, is its exact modulus."""

import h5py
import numpy as np
import pytest
import tomli_w

from dembound.kinds import loads
from dembound.running import run_case

RISE, DURATION, SPEED = 0.2, 0.4, 1e-3
DENSITY, WAVE_SPEED = 2500.0, 1000.0


def record_of(folder, reduce: bool) -> dict[str, np.ndarray]:
    """Histories of the sides, and the length of the left one."""
    case = {
        "packing": {"pattern": "A", "size": [5.0, 3.0], "radius": 0.25},
        "material": {"density": DENSITY, "p_wave_speed": WAVE_SPEED},
        "motion": {"held": ["y", "rotation"]},
        "boundary": {"left": {"type": "fixed"}, "right": {"type": "velocity", "wave_p": "push"}},
        "wave": {"push": {"type": "constant", "amplitude": -SPEED, "rise": RISE}},
        "run": {"duration": DURATION},
        "output": {"snapshots": 0, "pictures": False, "history_interval": 1e-3},
        "reduce": {"rows": reduce},
    }
    with h5py.File(run_case(loads(tomli_w.dumps(case), name=f"sample_{reduce}"), folder) / "run.h5") as file:
        found = {f"{side}/{name}": file[f"boundaries/{side}/{name}"][:] for side in ("left", "right") for name in
                 ("time", "displacement", "force")}  # fmt: skip
        return found | {"length": file["boundaries/left"].attrs["body_length"]}


@pytest.mark.parametrize("reduce", [True, False])
def test_the_slope_is_the_modulus_of_the_lattice(tmp_path, reduce):
    """E = ρc², as rows of disks do not act on each other; from centre to centre a row is a diameter shorter.

    The strain is uniform up to what the wave that goes to and fro adds: a half of ρ L a at most, of the acceleration
    a, in this case 1e-4 of the stress after the rise, where a = 0 and an eigenmode that the rise excites, of period
    4L/c = 20 ms, has v c/(rise · …) of it: below ((T/2π)/rise)² = 3e-4.
    """
    found = record_of(tmp_path, reduce)
    late = found["right/time"] > 0.5 * DURATION
    stress = found["right/force"][late, 0] / found["length"]
    strain = (found["right/displacement"] - found["left/displacement"])[late, 0] / (5.0 - 0.5)
    modulus = DENSITY * WAVE_SPEED**2
    assert stress[-1] < 0.0  # compressed: tension is positive
    np.testing.assert_allclose(stress, modulus * strain, rtol=0.0, atol=2e-3 * np.abs(stress).max())
    slope = np.polyfit(strain, stress, 1)[0]
    assert slope == pytest.approx(modulus, rel=1e-3)


def test_the_held_side_pushes_back_as_much(tmp_path):
    """Both ends of a bar in equilibrium, as above, so their time means are opposite."""
    found = record_of(tmp_path, True)
    late = found["right/time"] > 0.75 * DURATION
    right, left = (found[f"{side}/force"][late, 0].mean() for side in ("right", "left"))
    assert left == pytest.approx(-right, rel=1e-3)
    assert found["right/displacement"][-1, 0] == pytest.approx(-SPEED * (DURATION - 0.5 * RISE), rel=0.01)
    np.testing.assert_array_equal(found["left/displacement"], 0.0)
