"""A slope between two levels moves as by a program of its own: numpy, far sides, the exact wave of the lattice.

It is benchmarks/slope_reference.py, which shares neither packing, stiffnesses, waves nor sides with the package.
"""

import numpy as np
import pytest
import slope_reference
from slope_reference import Lattice, Scene, errors, ground_needed, run_of


@pytest.mark.filterwarnings("ignore::dembound.CaseWarning")
@pytest.mark.parametrize("kind", ["s", "p"])
def test_near_sides_leave_the_motion_that_another_program_finds(tmp_path, kind: str) -> None:
    """Waves of 20 diameters: 0.36 % (SV) and 0.35 % (P) of the worst of five places at the surface.

    Of second order in D/λ: 0.09 % at 40, 0.03 % at 80 diameters. S waves of 20 diameters come through a level bottom
    with 0.3 %. Without the jump below the lower side, or with one column for both, it is 10 % and more.
    """
    scene = Scene(kind, "cosine", 20, 1.0)
    step, times, own, disks = run_of(scene, tmp_path)
    assert disks == 1870  # 40·20 + 20·20 of level ground, 20·30 + 10 of the slope, 60 of columns
    exact = Lattice(scene, *ground_needed(scene)).run(scene, step, int(scene.duration / step) + 2)
    found = errors(own, exact, times, step)
    assert list(found) == list(slope_reference.SHARES)
    assert max(found.values()) < 5e-3


def test_its_lattice_moves_under_level_ground_as_two_waves() -> None:
    """A wavelet of 20 diameters goes up and comes back; below y = 0 nothing moves before it does."""

    class Level(Scene):
        def surface(self, x: np.ndarray) -> np.ndarray:
            return np.full(np.shape(x), 40.0)

        def places(self) -> dict[str, tuple[float, float]]:
            return {"surface": (0.5, 39.5), "below": (0.5, -10.5)}

    for kind, component in (("s", 0), ("p", 1)):
        scene, step, speed = Level(kind, "ricker", 20, 1.0), 3.5e-4, slope_reference.SPEEDS[kind]
        found = Lattice(scene, 3, 100).run(scene, step, 400)
        waves = sum(scene.velocity(step * np.arange(400) - y / speed) for y in (39.5, 40.5))
        own = found["surface"]
        # late by (2πD/λ)²/24 of 40 D, 0.16 D, of P waves; twice as late at the higher frequencies that velocities of a
        # wavelet have: 0.3·2π/20, 10 % of a wave of 20 D
        assert np.sqrt(((own[:, component] - waves) ** 2).sum() / (waves**2).sum()) < 0.12
        assert np.abs(own[:, 1 - component]).max() < 1e-12
        before = int((80.0 + 10.5) / speed / step)  # but for what is before its start, 1e-8, and its rise in a step
        assert np.abs(found["below"][:before]).max() < 1e-6
