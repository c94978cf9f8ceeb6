"""At a corner of a side of half cells the side across acts on half a disk, so that uniform motion stays uniform.

A row of half cells has half the stiffness and mass of a whole one, so half the impedance. With a whole dashpot at each
end of two such rows, a side of N disks has N/(N − 1) times the impedance of the scene, and reflects −1/(2N − 1) of a P
wave.
"""

import numpy as np
import pytest

ROWS, LENGTH = 4, 20.0
"""Number of rows, with which whole dashpots would reflect a seventh, and length in m."""

WEIGHTLESS = {"type": "viscous", "beta_p": 0.0, "beta_s": 0.0, "half_mass": True}
"""A side of half cells on which no force acts."""

ENDS = {
    "dashpots": ({"type": "viscous_input", "wave_p": "pulse"}, {"type": "viscous"}),
    "dashpots and springs": (
        {"type": "viscoelastic_input", "wave_p": "pulse", "distance": 15.0},
        {"type": "viscoelastic", "distance": 15.0},
    ),
    "mirror": ({"type": "viscous_input", "wave_p": "pulse"}, {"type": "symmetry"}),
    "half cells, too": (
        {"type": "viscous_input", "wave_p": "pulse", "half_mass": True},
        {"type": "viscous", "half_mass": True},
    ),
}


@pytest.mark.parametrize(("ends", "upright"), list(zip(ENDS, (False, True, False, True), strict=True)))
def test_a_p_wave_between_half_cells_moves_as_in_an_endless_lattice(lab, ends, upright):
    def motion(sides):
        names = ("bottom", "top", "left", "right") if upright else ("left", "right", "bottom", "top")
        boundary = dict(zip(names, (*ENDS[ends], sides, sides), strict=True))
        size = (LENGTH, ROWS * lab.diameter)
        scene = lab.scene("A", size[::-1] if upright else size, held=("x",) if upright else ("y",), boundary=boundary,
                          wave=lab.pulse(0.01))  # fmt: skip
        order = np.lexsort(np.round(scene.positions, 6).T)
        duration = 3.0 * LENGTH / lab.speed  # the echo of the far side comes back to both
        return lab.run(scene, order, duration, 0.4 * lab.diameter / lab.speed).velocity[..., int(upright)]

    between, endless = motion(WEIGHTLESS), motion("periodic")
    # sums of a step in another order: rounding of each of 150 steps
    assert np.abs(endless).max() > 0.4
    assert np.abs(between - endless).max() < 150 * 8.0 * np.finfo(float).eps * np.abs(endless).max()
