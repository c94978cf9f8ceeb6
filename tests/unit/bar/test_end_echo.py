"""Of which ends and waves it is computed what returns; that it is right is held by tests/verification."""

import numpy as np
import pytest

from dembound.api import case
from dembound.bar.end_echo import ROUNDING, returned_of_waves
from dembound.bar.scene import build_bar

TABLES = {
    "bar": {"length": 0.4, "spacing": 0.01, "density": 2000.0, "wave_speed": 2000.0},
    "method": {"type": "finite_difference"},
    "load": [{"name": "hit", "pressure": 1e6, "wave": "p"}],
    "wave": {"p": {"type": "cosine", "amplitude": 1.0, "period": 1e-4}},
    "run": {"duration": 1e-3},
}
STEP = 4e-6


def shares(side: str = "right", **tables) -> dict[str, float]:
    return returned_of_waves(build_bar(case(**TABLES | tables)), side, STEP).shares


@pytest.mark.parametrize("end", [{"type": "free"}, {"type": "fixed"}, {"type": "viscous_input", "wave_p": "p"}])
def test_nothing_is_computed_of_ends_that_do_not_absorb_and_of_dashpots_that_let_a_wave_in(end):
    assert shares(boundary={} if end["type"] == "free" else {"right": end}) == {}


def test_nothing_is_computed_of_very_long_layers_and_bonds():
    assert shares(boundary={"right": {"type": "matched_layer", "nodes": 1001}}) == {}
    bar = TABLES["bar"] | {"length": 0.8}
    far = {"type": "peridynamics", "horizon": 31}
    assert shares(bar=bar, method=far, boundary={"right": {"type": "matched_layer", "nodes": 62}}) == {}


def test_every_wave_has_a_share_of_its_own():
    """A short one more than a long one; one that does not begin within the run none."""
    waves = {
        name: {"type": "cosine", "amplitude": 1.0, "period": period, "start": start}
        for name, period, start in (("short", 3e-5, 0.0), ("long", 3e-4, 0.0), ("late", 1e-4, 1e7))
    }
    loads = [{"name": name, "pressure": 1e6, "wave": name} for name in waves]
    found = shares(wave=waves, load=loads, boundary={"right": {"type": "matched_layer"}})
    assert found.keys() == {"short", "long"}
    assert found["short"] > 10.0 * found["long"] > 10.0 * ROUNDING


def test_waves_that_stay_are_followed_to_the_end_of_the_run():
    """A pressure that stays moves the bar at p/(ρc), of which a dashpot of nine tenths returns r = 1/19 each time.

    At the free end each time twice: 2r + 2r² + … = 2/18.
    """
    wave = {"p": {"type": "constant", "amplitude": 1.0, "rise": 2e-4}}
    found = shares(wave=wave, boundary={"right": {"type": "viscous", "beta_p": 0.9}})
    assert found["p"] == pytest.approx(2.0 / 18.0, rel=0.01)
    assert np.isinf(returned_of_waves(build_bar(case(**TABLES | {"wave": wave})), "right", STEP).within)
