"""The pulse that a calibration sends, how long it waits for its peak, and what a side returns of it."""

import numpy as np
import pytest
from small_cases import OPEN, SOIL, small

from dembound.casefile.disks import DiskCase
from dembound.casefile.model import as_kind
from dembound.errors import CaseError
from dembound.studies.asked import Calibrating
from dembound.studies.calibration import calibrate
from dembound.studies.strip import calibration_pulse, in_one_layer, linear_medium, returned


@pytest.fixture
def case(bar):
    """Makes cases: the bar free to move across, with keys changed."""

    def make(changes: dict) -> DiskCase:
        return as_kind(bar({"motion.held": ["rotation"], **changes}), DiskCase, "is no case of disks")

    return make


def test_a_pulse_is_as_long_as_the_wave_of_its_own_kind(case) -> None:
    waves = {
        "pulse": {"type": "cosine", "amplitude": 0.5, "period": 0.01},
        "shake": {"type": "ricker", "amplitude": -0.2, "frequency": 25.0},
    }
    left = {"type": "velocity", "wave_p": "pulse", "wave_s": "shake"}
    both = case({"wave": waves, "boundary.left": left})
    found = {motion: calibration_pulse(both, "right", motion) for motion in ("p", "s")}

    # the dominant frequencies are 1/T = 100 Hz and that of the wavelet's crest; 1/f rounds once
    assert [found[motion].amplitude for motion in ("p", "s")] == [0.5, 0.2]
    assert [found[motion].period for motion in ("p", "s")] == pytest.approx([0.01, 0.04], rel=1e-15)


def test_without_a_usable_wave_a_pulse_is_two_hundred_diameters_long(case) -> None:
    step = case({"wave": {"pulse": {"type": "constant", "amplitude": 0.5}}})
    # disks of 0.5 m; rotations are held, so that shear springs of half the stiffness carry S waves. The speeds are
    # square roots of sums of a few springs
    for motion, speed in (("p", 1000.0), ("s", 1000.0 / np.sqrt(2.0))):
        assert calibration_pulse(step, "right", motion).period == pytest.approx(200.0 * 0.5 / speed, rel=1e-12)


@pytest.mark.parametrize(("side", "travel"), [("right", 0.0175), ("left", 0.0)])
def test_a_pass_goes_on_for_a_tenth_of_the_pulse_after_its_peak_is_due(bar, side: str, travel: float) -> None:
    step = 1e-4
    long = bar({"wave.pulse.period": 0.05, "run.time_step": step})
    found = calibrate(long, side, Calibrating(tolerance=2.0, start=1.0))

    # the peak leaves the opposite end at T/2 and takes L/c through 17.5 m at 1000 m/s; an input side lets it in itself.
    # A whole number of steps may round to either side
    assert found.steps == pytest.approx((travel + (0.5 + 0.1) * 0.05) / step, abs=1.0)


def test_beside_layers_the_slowest_is_everywhere_and_its_factor_suits_all() -> None:
    open_soil = small(SOIL | OPEN)
    found, (said,) = in_one_layer(open_soil, "left", "s")
    assert found.layer_names == ("clay",)
    assert said.startswith("the layer clay everywhere")
    assert in_one_layer(open_soil, "bottom", "s")[0].layer_names == ("rock",)
    assert in_one_layer(found, "left", "s") == (found, [])

    # a P-wave speed is that of the square lattice, an S-wave speed that of the packing
    grains = {"pattern": "B", "radius": 0.25, "radius_ratio": 1.5, "brick": [4.0, 4.0], "size": [4.0, 12.0]}
    tables = {key: table for key, table in OPEN.items() if key != "load"} | {"packing": grains, "monitor": []}
    unlike = small(SOIL | tables, changes={"layer.rock": {"name": "rock", "p_wave_speed": 1400.0}})
    assert in_one_layer(unlike, "bottom", "p")[0].layer_names == ("rock",)
    with pytest.raises(CaseError, match=r"clay 1, sand 1, rock 0\..*matched"):
        in_one_layer(unlike, "left", "p")


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
