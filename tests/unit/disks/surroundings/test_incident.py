"""The forces by which plane waves of the ground enter a body, and which waves are refused."""

import numpy as np
import pytest
from ground_motions import GENERAL, ground, sine
from small_cases import SURROUNDED, small

from dembound.disks.scene import build
from dembound.disks.surroundings.incident import power_through
from dembound.errors import CaseError

INCIDENT = {"type": "sv", "angle": 20.0, "wave": "pulse"}
PULSE = {"type": "cosine", "amplitude": 1.0, "period": 0.05}
BELOW = SURROUNDED | {"incident": INCIDENT, "wave": {"pulse": PULSE}}


def test_the_power_through_a_side_is_that_of_the_waves_that_run_inwards() -> None:
    """Through the left side all three, as all run to the right; of a sine ½ F per m² in the mean; none on the right."""
    waves = ground(sine(20.0))
    edges, times = (-3.0, 5.0, 2.0, 12.0), np.linspace(0.0, 1.0, 4001)[:-1]
    along = sum(wave.flux(GENERAL)[0] for wave in waves.waves)

    assert power_through("left", edges, waves)(times).mean() == pytest.approx(0.5 * 10.0 * along, rel=1e-6)
    assert power_through("left", edges, waves, 0.25)(times).mean() == pytest.approx(0.125 * 10.0 * along, rel=1e-6)
    assert not power_through("right", edges, waves)(times).any()
    up = waves.waves[0].flux(GENERAL)[1]
    assert power_through("bottom", edges, waves)(times).mean() == pytest.approx(0.5 * 8.0 * up, rel=1e-6)
    assert power_through("top", edges, waves)(times).mean() == pytest.approx(0.5 * 8.0 * up, rel=1e-6)

    # a mass on the surface sends back as much; its delay is of the first order in ωm/ρc = 0.006, energies of the second
    heavy = ground(sine(20.0), mass=0.05 * GENERAL.density)
    for side, expected in (("left", 10.0 * along), ("top", 8.0 * up)):
        assert power_through(side, edges, heavy)(times).mean() == pytest.approx(0.5 * expected, rel=1e-3)


@pytest.mark.parametrize(
    ("changes", "problem"),
    [
        ({"boundary.left": {"type": "viscous"}}, 'boundary.left.type: is "viscous", but the wave of [incident]'),
        ({"boundary.top": {"type": "fixed"}}, 'boundary.top.type: is "fixed", but the wave of [incident]'),
        ({"boundary.bottom.wave_s": "pulse"}, "boundary.bottom.wave_s: is not allowed together with [incident]"),
        # of the scene
        ({"incident.angle": 45.0}, "incident.angle: is 45; from the critical angle of this packing on, 45 degrees"),
        ({"incident.point": [30.0, 30.0]}, "incident.point: "),
    ],
)
def test_what_is_refused(changes, problem: str) -> None:
    with pytest.raises(CaseError) as error:
        build(small(BELOW, changes=changes))
    assert problem in str(error.value)
    if "point" in problem:
        assert "give wave.pulse.start = 0.05" in str(error.value)
