"""What a side returns of a pulse: its reflection, whichever side it is and whatever it sends itself."""

import numpy as np
import pytest

from dembound.studies.strip import calibration_pulse, linear_medium, returned

BARS = {
    "right": {},
    "left": {"boundary.left": {"type": "viscous_input", "wave_p": "pulse"}},
    "top": {
        "packing.size": [1.0, 40.0],
        "motion.held": ["x"],
        "boundary": {"bottom": {"type": "velocity", "wave_p": "pulse"}, "top": {"type": "viscous"}},
        "monitor": [{"name": "m", "position": [0.5, 5.0]}],
    },
}


@pytest.mark.parametrize("side", BARS)
def test_a_side_returns_what_its_dashpots_reflect(bar, side: str) -> None:
    case, _ = linear_medium(bar({"packing.size": [40.0, 1.0], "wave.pulse.period": 0.05, **BARS[side]}))
    found = returned(case, side, "p", calibration_pulse(case, side, "p"), [1.0, 0.5, 1.5])
    # equal disks: β0 = 1 and R = (1 − β)/(1 + β), 1/3 and −1/5. The end's whole mass adds −iωD/4c in quadrature, of
    # v ~ 1 − cos ωt by RMS ωD/(4√3 c), with cT = 50 m; alone at β0, where its square changes others by 1e-4
    assert found[0] == pytest.approx(2.0 * np.pi / 50.0 * 0.5 / (4.0 * np.sqrt(3.0)), rel=0.01)
    assert found[1:] == pytest.approx([1.0 / 3.0, 0.2], abs=1e-3)
