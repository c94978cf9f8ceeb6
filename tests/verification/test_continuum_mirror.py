"""Half of a symmetric body in a continuum, beside a mirror plane, moves as that half of the whole does."""

import numpy as np

from dembound.disks.scene import build
from dembound.disks.stability import choose_step
from dembound.kinds import with_changes
from dembound.motion.simulation import Simulation

PULSE = {"type": "cosine", "amplitude": 1.0, "period": 0.05}
OUTSIDE = {"type": "outside"}
WIDTH, HEIGHT = 8.0, 20.0


def motion(case, places: np.ndarray, steps: int, step: float) -> np.ndarray:
    """Displacements and velocities (steps, p, 4) of the disks at places (p, 2) m."""
    scene = build(case)
    disks = scene.positions[: scene.recorded]
    nodes = [int(np.argmin(np.hypot(*(disks - place).T))) for place in places]
    assert np.abs(disks[nodes] - places).max() < 1e-9
    return Simulation(scene, step, nodes).advance(steps)[:, :, [0, 1, 3, 4]]


def test_half_a_body_beside_a_mirror_moves_as_the_whole(lab) -> None:
    """To rounding, also where waves have been in the layers and back: both have the same elements.

    The mesh is higher than wide, so that the layers of both have the same settings. Some 1,500 steps of ten rounding
    errors each, relative to the largest motion: 1e-11 at most if they add up at random, as the error of a wave does.
    """
    force = {"force": [0.0, -1e6], "wave": "pulse"}
    whole = lab.case(
        "A",
        (2.0 * WIDTH, HEIGHT),
        radius=0.5,
        held=(),
        material={"fric": 0.5, "p_wave_speed": 1000.0},
        boundary=dict.fromkeys(("left", "right", "bottom"), "outside"),
        wave=PULSE,
        load=[{"name": f"f{x:g}", "position": [x, HEIGHT - 0.5], **force} for x in (WIDTH - 0.5, WIDTH + 0.5)],
    )
    whole = with_changes(whole, {"outside": {"element": 4.0, "layers": 2}})
    half = with_changes(
        whole,
        {
            "packing.size": [WIDTH, HEIGHT],
            "boundary.left": {"type": "symmetry"},
            "load": [{"name": "f", "position": [0.5, HEIGHT - 0.5], **force}],
        },
    )
    places = np.array([[0.5, 19.5], [6.5, 19.5], [0.5, 0.5], [7.5, 10.5], [7.5, 0.5]])
    step = choose_step(build(whole))[0]
    assert abs(choose_step(build(half))[0] / step - 1.0) < 2e-3
    one, other = motion(half, places, 1500, step), motion(whole, places + np.array([WIDTH, 0.0]), 1500, step)
    largest = np.abs(other).max(axis=(0, 1))
    assert (np.abs(one - other).max(axis=(0, 1)) < 1e-9 * largest).all()
    assert (largest > 0.0).all()
