"""Types of a side compared, in a run and by layer."""

import numpy as np
import pytest
from small_cases import OPEN, SOIL, small

from dembound import api
from dembound.disks.reflection import compare_types, layers_beside, measure_side
from dembound.disks.reflection.arrivals import amplitudes, signal_for
from dembound.errors import CaseError
from dembound.spectra import fourier_spectrum

LENGTH, SPEED, PERIOD = 100.0, 1000.0, 0.04
SPRINGS = {"type": "viscoelastic", "distance": 5.0, "alpha_n": 2.5}

STRIP = {
    "packing": {"pattern": "A", "size": [LENGTH, 0.5], "radius": 0.25},
    "material": {"density": 2500.0, "p_wave_speed": SPEED, "fric": 0.5},
    "boundary": {
        "left": {"type": "velocity", "wave_p": "pulse"},
        "right": SPRINGS,
        "bottom": {"type": "periodic"},
        "top": {"type": "periodic"},
    },
    "wave": {"pulse": {"type": "cosine", "amplitude": 1.0, "period": PERIOD}},
    "monitor": [{"name": "middle", "position": [0.5 * LENGTH, 0.25]}],
    "run": {"duration": 0.245, "time_step": 2e-4},
    "output": {"pictures": False, "history_interval": 2e-4},
}


def test_springs_return_in_a_run_what_is_computed_and_their_formula_says(tmp_path) -> None:
    """|R| = [1 + (2ωρc/k)²]^(−½) with k = αG/L, G = ρc²/2; run and computation within 0.1 % of each other.

    The returned pulse passes the monitor from 0.15 s on and ends as e^(−kt/ρc), kt/ρc = 14 when the next echo comes.
    The last mass, whole, and the lattice change the formula by (ωD/4c)(2ωρc/k), 3 % at 20 Hz.
    """
    case = small(STRIP)
    frequencies = [5.0, 10.0, 20.0]
    found, arrivals = compare_types(
        case, "right", [SPRINGS, {"type": "viscous", "half_mass": True}], [0.0], frequencies
    )
    assert [*found] == ["viscoelastic, distance 5.0, alpha_n 2.5", "viscous, half_mass"]
    computed = np.sqrt(found["viscoelastic, distance 5.0, alpha_n 2.5"].total("p")[:, 0])
    formula = 1.0 / np.sqrt(1.0 + (4.0 * np.pi * np.array(frequencies) / 250.0) ** 2)
    np.testing.assert_allclose(computed, formula, rtol=0.03)
    assert found["viscous, half_mass"].total("p").max() < 1e-7

    history = api.run(case, tmp_path).histories["middle"]
    velocity, step = history["velocity"][:, 0], float(history["time"][1])
    passed = history["time"] < 0.12
    spectra = [fourier_spectrum(np.where(window, velocity, 0.0), step) for window in (passed, ~passed)]
    returned = [np.interp(frequencies, every, np.abs(values)) for every, values in spectra]
    np.testing.assert_allclose(returned[1] / returned[0], computed, rtol=1e-3)

    signal = signal_for("p", arrivals)
    assert signal is not None
    assert signal.wave is case.wave["pulse"]
    assert signal_for("s", arrivals) is None
    np.testing.assert_allclose(amplitudes(signal, np.array([1.0, 50.0])), [1.0, 0.0], atol=0.06)
    usual = next(iter(compare_types(case, "right", [SPRINGS], [0.0])[0].values())).frequencies
    assert usual[-1] == pytest.approx(case.wave["pulse"].highest_frequency())


def test_a_side_reflects_by_layer() -> None:
    case = small(SOIL | OPEN)
    assert layers_beside(case, "left") == ["clay", "sand", "rock"]
    assert layers_beside(case, "bottom") == layers_beside(case.uniform_at(1.0), "left") == []
    with pytest.raises(CaseError, match="name one of clay, sand, rock"):
        measure_side(case, "left")

    def returned(side: str, layer: str | None, height: float | None = None) -> np.ndarray:
        one = case if height is None else case.uniform_at(height)
        return measure_side(one, side, [0.0], [10.0, 20.0], layer=layer).found.total("s")[:, 0]

    # the mass beyond whole cells reflects in proportion to the frequency over the speed
    clay = returned("left", "clay")
    for layer, slower in (("sand", 200.0 / 350.0), ("rock", 200.0 / 700.0)):
        np.testing.assert_allclose(returned("left", layer), clay * slower**2, rtol=0.02)
    np.testing.assert_allclose(returned("left", "rock"), returned("left", None, 1.0), rtol=1e-6)
    np.testing.assert_allclose(returned("bottom", None), returned("bottom", None, 1.0), rtol=1e-6)
