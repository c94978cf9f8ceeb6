"""With a fracture energy and a given horizon a bar breaks into the same pieces, however fine the spacing.

Without a fracture energy the number of pieces grows as nodes become more. With one, a crack that opens unloads others
at distances of EG_f/σ_t². The crest of a strong pulse brings all planes of a uniform bar to their strength one after
the other, and which of them open is decided by what differs between them: with local springs, by waves of the length of
a spacing. Bonds of a given length mΔx decide alike at every spacing.
"""

import numpy as np
import pytest

from dembound.bar.fracture import spalls
from dembound.motion.energy import Ledger
from dembound.motion.simulation import Simulation

HORIZON = 8e-3
PIECES = {200.0: 3, 50.0: 5}
"""Number of spalls by fracture energy (J/m²): EG_f/σ_t² is 39 and 9.8 mm."""


def pieces(rock, spacing: float, **bar) -> tuple[np.ndarray, np.ndarray, float]:
    """Places (m) of all spalls under a pulse of 26 MPa, their times (s), and the energy (J) of cracks."""
    horizon = round(HORIZON / spacing)
    scene = rock.scene(
        {"type": "peridynamics", "horizon": horizon},
        spacing=spacing,
        load={"pressure": 26e6, "nodes": horizon},
        wave=rock.triangle(0.12e-3),
        strength=rock.strength,
        **bar,
    )
    simulation = Simulation(scene, rock.step(scene, 0.9))
    ledger = Ledger(simulation, 500)
    simulation.track(ledger)
    simulation.run(int(0.6e-3 / simulation.time_step))
    (part,) = simulation.system.parts
    found = spalls(part.bonds, scene.positions[:, 0], simulation.time_step)
    found.sort(key=lambda spall: spall.end[0])
    for spall in found:
        assert spall.began is not None
        assert spall.began < spall.time
    places = np.array([0.5 * sum(spall.end) for spall in found])
    return places, np.array([spall.time for spall in found]), ledger.entries[-1].crack


SLOW = pytest.mark.slow


@pytest.mark.parametrize(
    ("energy", "fine"),
    [
        (50.0, 0.5e-3),
        *(pytest.param(*each, marks=SLOW) for each in ((200.0, 0.5e-3), (50.0, 0.25e-3), (200.0, 0.25e-3))),
    ],
)
def test_same_pieces_at_a_finer_spacing(rock, energy, fine):
    """The places of the coarser row are good to two spacings, and times to some EG_f/(σ_t²c), in which cracks open."""
    coarse, finer = (pieces(rock, spacing, fracture_energy=energy) for spacing in (1e-3, fine))
    opening = rock.density * rock.speed * energy / rock.strength**2
    assert len(coarse[0]) == len(finer[0]) == PIECES[energy]
    np.testing.assert_allclose(finer[0], coarse[0], rtol=0.0, atol=2.0 * 1e-3)
    np.testing.assert_allclose(finer[1], coarse[1], rtol=0.0, atol=3.0 * opening)
    assert finer[2] == pytest.approx(coarse[2], rel=0.1)
