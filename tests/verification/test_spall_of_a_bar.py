"""A compressive pulse turns round at a free end as tension and breaks the bar where the sum of both is too much.

A pulse that rises at once to a stress p_m and falls evenly over t_d runs along a bar of strength σ_t, of length L from
the driven disk. The crest comes back into the pulse's own tail, and at a distance d from the free end the sum is
p_m·2d/(c t_d). Hence the bar breaks at d = (σ_t/p_m)·c t_d/2 and t = (L + d)/c, and the piece leaves with the impulse
that went in, at (2p_m − σ_t)/(ρc). What is left of the pulse, of crest p_m − σ_t, does the same at the new end:
floor(p_m/σ_t) pieces in all.

At Δt = D/c a row of disks obeys d'Alembert's solution to rounding, at the bonds' middles and with the free end D/2
beyond the last centre. Contacts here have no stiffness: as they do not pull, the bar would else be
stiffer in compression than in tension.
"""

from dataclasses import dataclass

import numpy as np
import pytest

from dembound.motion.part import Cracks
from dembound.motion.simulation import Simulation

DISKS, DIAMETER = 200, 0.5
DENSITY, SPEED = 2500.0, 1000.0
STEP = DIAMETER / SPEED
LENGTH = (DISKS - 0.5) * DIAMETER
PEAK = 0.4  # particle velocity of the crest, m/s
STRENGTH = 0.39 * DENSITY * SPEED * PEAK  # reached between two bonds
FALL = 100.0 * STEP
DISTANCE = 0.5 * STRENGTH / (DENSITY * SPEED * PEAK) * SPEED * FALL
PIECES = int(DENSITY * SPEED * PEAK / STRENGTH)
PULSE = np.array([[0.0, 0.0], [0.5 * STEP, PEAK], [FALL, 0.0]])  # velocities live in the middle of steps
STEPS = 2 * DISKS


@dataclass(frozen=True)
class Spalled:
    """Cracks of the bar, and the velocity (DISKS,) m/s of its disks after the pulse has gone to and fro."""

    cracks: Cracks
    velocity: np.ndarray


@pytest.fixture(scope="module", params=[True, False], ids=["elastic start", "bonds from the start"])
def bar(request, lab, tmp_path_factory) -> Spalled:
    path = tmp_path_factory.mktemp("pulse") / "triangle.txt"
    np.savetxt(path, PULSE)
    modulus = DENSITY * SPEED**2
    material = {"law": "linearpbond", "emod": 0.0, "pb_emod": modulus, "pb_ten": STRENGTH}
    scene = lab.scene(
        "A",
        (DISKS * DIAMETER, DIAMETER),
        held=("y", "rotation"),
        material=material | {"elastic_start": request.param},
        boundary={"left": {"type": "velocity", "wave_p": "pulse"}},
        wave={"type": "file", "path": str(path)},
    )
    simulation = Simulation(scene, STEP)
    simulation.advance(STEPS)
    assert np.array_equal(lab.row(scene), np.arange(DISKS))
    return Spalled(simulation.system.contacts["body"].take_cracks(), simulation.state.velocity[0])


def expected_stress() -> np.ndarray:
    """Stress (STEPS, DISKS − 1) Pa in the bonds' middles at the beginning of each step as long as nothing breaks."""
    time = STEP * np.arange(STEPS)[:, None]
    place = DIAMETER * (np.arange(DISKS - 1) + 0.5)
    towards, back = (np.interp(time - way / SPEED, *PULSE.T) for way in (place, 2.0 * LENGTH - place))
    return DENSITY * SPEED * (back - towards)


def test_the_first_crack_is_where_and_when_dalembert_says(bar):
    beyond = expected_stress() >= STRENGTH
    step = int(np.argmax(beyond.any(axis=1)))
    (bond,) = np.flatnonzero(beyond[step])
    assert bar.cracks.step[0] == step
    assert bar.cracks.pair[0].tolist() == [bond, bond + 1]


def test_pieces_of_equal_length_break_off_one_after_the_other(bar):
    assert len(bar.cracks) == PIECES
    assert not bar.cracks.shear.any()
    depth = LENGTH - DIAMETER * (bar.cracks.pair[:, 0] + 0.5)
    number = np.arange(1, PIECES + 1)
    # each time it is the next bond on the way that breaks, less than D on, when the crest is there
    assert np.all(depth >= number * DISTANCE)
    assert np.all(depth < number * (DISTANCE + DIAMETER))
    # the crest is half a step behind the pulse's beginning
    np.testing.assert_array_equal(bar.cracks.step, np.rint((LENGTH + depth) / SPEED / STEP + 0.5))


def test_pieces_take_their_impulse_along(bar):
    # over the D more than d that a piece may be long the stress falls, and the sum rises, by p_m·2D/(c t_d); the n-th
    # piece's velocity, (2p_m − (2n − 1)σ_t)/(ρc), is out by as much for each σ_t in it
    for number, after in enumerate([DISKS, *bar.cracks.pair[:-1, 1]], start=1):
        piece = bar.velocity[bar.cracks.pair[number - 1, 1] : after]
        expected = 2.0 * PEAK - (2 * number - 1) * STRENGTH / (DENSITY * SPEED)
        uneven = (2 * number - 1) * PEAK * 2.0 * DIAMETER / (SPEED * FALL)
        assert piece.mean() == pytest.approx(expected, abs=uneven)
