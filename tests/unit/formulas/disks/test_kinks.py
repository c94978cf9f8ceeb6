"""Errors at frequencies of kinks, which companions do not have."""

import numpy as np
import pytest
from small_cases import Tables, small

from dembound.disks.scene import build
from dembound.formulas.cause import GRID, STEP
from dembound.formulas.delays import part_above
from dembound.formulas.disks.dispersion import Dispersion
from dembound.formulas.disks.formulas import Formulas
from dembound.formulas.disks.kinks import SLOW, causes_of_kinks
from dembound.formulas.history import History

SPEED, LARGER = 1000.0, 2.0
COLUMN: Tables = {
    "packing": {"pattern": "A", "size": [5.0, 20.0], "radius": 0.25},
    "material": {"density": 2500.0, "p_wave_speed": SPEED},
    "boundary": {
        "bottom": {"type": "velocity", "wave_p": "pulse"},
        "top": {"type": "viscous"},
        "left": {"type": "periodic"},
        "right": {"type": "periodic"},
    },
    "wave": {"pulse": {"type": "triangle", "amplitude": 1.0, "rise": 0.01, "fall": 0.02}},
    "monitor": [{"name": "m", "position": [2.25, 12.25]}],
    "run": {"duration": 0.06},
}
TIME = np.arange(0.0, 0.06, 2e-4)


def record(velocity):
    """A record along y."""
    motion = np.stack([np.zeros_like(TIME), velocity], axis=1)
    values = {"velocity": motion, "displacement": 2e-4 * np.cumsum(motion, axis=0)}
    return {"m": History(np.array([2.25, 12.25]), TIME, values)}


@pytest.mark.parametrize("name", [GRID, STEP])
def test_what_companions_lack_and_have_make_up_the_error_of_all_frequencies(name: str) -> None:
    """Squares of errors add up, as frequencies are separate: for the triangle, and for its part below the frequency."""
    scene = build(small(COLUMN))
    formulas = Formulas(scene, 2e-4)
    own = record(scene.case.wave["pulse"].velocity(TIME - 12.25 / SPEED))
    above = part_above(TIME, own["m"].velocity[:, 1], SLOW * 2.0 * SPEED / LARGER)[1]
    whole, below = (
        next(cause for cause in formulas.causes(each) if cause.name == name).share("m", "velocity", own["m"])
        for each in (own, record(own["m"].velocity[:, 1] - above))
    )
    (kinks,) = [each for each in causes_of_kinks(formulas.dispersion, own, LARGER) if each.name == f"{name} at kinks"]
    assert kinks.of_disks == (name == GRID)
    assert whole > 2.0 * below
    # the error of the whole is that within the record; the filter is not causal, by less than 5 % of the error
    assert np.hypot(below, kinks.share("m", "velocity", own["m"])) == pytest.approx(whole, rel=0.05)


def test_smooth_waves_have_nothing_that_companions_lack() -> None:
    ricker = {"pulse": {"type": "ricker", "amplitude": 1.0, "frequency": 40.0}}
    dispersion = Dispersion(build(small(COLUMN | {"wave": ricker})), 2e-4)
    assert not list(causes_of_kinks(dispersion, record(np.sin(100.0 * TIME)), LARGER))


def test_waves_of_a_force_in_a_place_have_more_high_frequencies_than_plane_ones() -> None:
    """By a factor √ω, so that kinks have more than twice the share above frequencies far above those of the wave."""
    sides = {"boundary": {"top": {"type": "viscous"}}}
    load = {"name": "f", "force": [0.0, 1.0], "wave": "pulse"}
    sizes = []
    for region in ([0.0, 0.0, 5.0, 0.5], [2.0, 0.0, 3.0, 0.5]):
        scene = build(small(COLUMN | sides | {"load": [load | {"region": region}]}))
        (step,) = [
            each
            for each in causes_of_kinks(Dispersion(scene, 2e-4), record(np.sin(100.0 * TIME)), LARGER)
            if each.name.startswith(STEP)
        ]
        sizes.append(step.parts["m"]["velocity"])
    assert 2.0 * sizes[0] < sizes[1] < 10.0 * sizes[0]  # by a factor ω they would have 26 times the share
