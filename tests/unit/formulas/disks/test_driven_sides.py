"""The predicted error of a side on rock beside the true one."""

import numpy as np
import pytest
import tomli_w

from dembound.accuracy.of_disks.causes import Formulas
from dembound.disks.scene import build
from dembound.disks.stability import choose_step
from dembound.exact.column import Column, Layer
from dembound.formulas.disks.entry import late_by
from dembound.formulas.history import History
from dembound.kinds import loads
from dembound.motion.simulation import Simulation


@pytest.mark.parametrize(("alpha", "half_mass"), [(4.0, False), (0.5, True)])
def test_it_is_that_of_a_layer_on_the_plane_of_the_side(alpha: float, half_mass: bool) -> None:
    """Its RMS within a fifth, and its shape: the second order, and dispersion, are a tenth of these errors."""
    rock = {"density": 1900.0, "p_wave_speed": 300.0 * alpha, "s_wave_speed": 212.132 * alpha}
    bottom = {"type": "viscous_input", "wave_s": "w", "half_mass": half_mass, "rock": rock}
    tables = {
        "packing": {"pattern": "A", "size": [0.5, 20.0], "radius": 0.25},
        "material": {"density": 1900.0, "p_wave_speed": 300.0, "fric": 0.5},
        "boundary": {side: {"type": "periodic"} for side in ("left", "right")} | {"bottom": bottom},
        "wave": {"w": {"type": "ricker", "amplitude": 1.0, "frequency": 3.0}},
        "run": {"duration": 1.5},
    }
    scene = build(loads(tomli_w.dumps(tables)))
    step, top = choose_step(scene)[0], int(np.argmax(scene.positions[:, 1]))
    record = Simulation(scene, step, [top]).advance(int(1.5 / step))[:, 0]
    time = step * np.arange(len(record))
    own = History(scene.positions[top], time, {"velocity": record[:, 3:5], "displacement": record[:, :2]})
    (cause,) = [each for each in Formulas(scene, step).causes({"top": own}) if each.name == "bottom side"]

    column = Column([Layer(20.0, 1900.0, 212.132), Layer(1.0, 1900.0, 212.132 * alpha)])
    exact = column.history(scene.case.wave["w"].velocity(time - late_by(scene)), step, 0.25)
    found, error = cause.parts["top"]["velocity"][:, 0], own.values["velocity"][:, 0] - exact
    assert np.linalg.norm(found) == pytest.approx(np.linalg.norm(error), rel=0.2)
    assert np.linalg.norm(found - error) < 0.3 * np.linalg.norm(error)
    assert not cause.parts["top"]["velocity"][:, 1].any()
