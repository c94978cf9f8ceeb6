"""The exact curves beside cases with a hole under a plane wave that comes at an angle."""

import math

import numpy as np
import pytest
import tomli_w

from dembound.accuracy.of_disks import exact as module
from dembound.accuracy.of_disks.exact import exact_motions
from dembound.disks.scene import build
from dembound.errors import CaseError
from dembound.exact import PlaneWave, Solid, scattered_motion
from dembound.kinds import loads, with_changes

CASE = tomli_w.dumps(
    {
        "ground": {"size": [100.0, 120.0]},
        "packing": {"pattern": "A", "size": [20.0, 20.0], "origin": [40.0, 40.0], "radius": 0.5},
        "material": {"density": 2500.0, "p_wave_speed": 1000.0, "fric": 0.5},
        "outside": {"element": 10.0},
        "boundary": {side: {"type": "outside"} for side in ("left", "right", "bottom", "top")},
        "incident": {"type": "sv", "angle": 30.0, "wave": "pulse", "point": [50.0, 20.0]},
        "wave": {"pulse": {"type": "cubic_spline", "amplitude": 0.5, "period": 0.1}},
        "hole": [{"name": "tunnel", "type": "circle", "centre": [50.0, 50.0], "radius": 5.0}],
        "monitor": [{"name": "left", "position": [44.5, 50.5]}, {"name": "above", "position": [50.5, 56.5]}],
        "run": {"duration": 0.3},
    }
)

SOLID = Solid(2500.0, 1000.0, 1000.0 / math.sqrt(2.0))


def test_before_the_surface_reflects_it_is_the_incident_wave_scattered(monkeypatch) -> None:
    """Direction, polarisation, and the delay from the point to the hole."""
    monkeypatch.setattr(module, "SAMPLES", 300)  # times
    angle, case = math.radians(30.0), with_changes(loads(CASE), {"run.duration": 0.16})
    problem, motions = exact_motions(build(case))
    assert problem.name == "scattering"
    delay = 30.0 * math.cos(angle) / SOLID.s_wave_speed
    wave = PlaneWave("sv", 0.5 * math.pi - angle, case.wave["pulse"].velocity)
    for name, place in (("left", [-5.5, 0.5]), ("above", [0.5, 6.5])):
        motion = motions[name]
        # what the surface sends back needs 120 m − 20 m up and 120 m − 57 m down, at 1000 m/s or less
        early = motion.time < (100.0 + 60.0) * math.cos(angle) / 1000.0
        expected = scattered_motion(motion.time[early] - delay, np.array([place]), wave, 5.0, SOLID)
        assert np.abs(expected.velocity).max() > 0.3
        for found, moved in ((motion.displacement, expected.displacement), (motion.velocity, expected.velocity)):
            size = np.abs(moved).max()
            np.testing.assert_allclose(found[early, :2], moved[0].T, rtol=0.0, atol=1e-4 * size)


def test_what_the_surface_sends_back_is_part_of_it_until_the_holes_echo(monkeypatch) -> None:
    """A vertical P wave of 0.1 s is doubled at the surface, far beside the hole."""
    monkeypatch.setattr(module, "SAMPLES", 300)  # times
    far = {"name": "far", "position": [250.5, 119.5]}
    changes = {"incident.type": "p", "incident.angle": 0.0, "outside.margin": 20, "monitor": [far]}
    case = with_changes(loads(CASE), changes)
    problem, motions = exact_motions(build(case))
    # the wave meets the wall 25 m above the point, and what the hole scatters returns from its image above the surface
    echo = (25.0 + math.hypot(200.5, 240.0 - 50.0 - 119.5) - 5.0) / 1000.0
    assert problem.until["far"] == pytest.approx(echo, rel=1e-9)
    motion = motions["far"]
    assert 0.2 < motion.time[-1] <= echo
    velocity, early = case.wave["pulse"].velocity, motion.time < 0.2
    twice = velocity(motion.time - 0.0995) + velocity(motion.time - 0.1005)
    np.testing.assert_allclose(motion.velocity[early, 1], twice[early], rtol=0.0, atol=1e-4)
    np.testing.assert_allclose(motion.velocity[early, 0], 0.0, rtol=0.0, atol=1e-4)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"hole": [{"name": "h", "type": "rectangle", "corners": [48.0, 48.0, 52.0, 52.0]}]}, "that of one circle"),
        ({"load": [{"name": "blow", "force": [1.0, 0.0], "position": [45.5, 45.5], "wave": "pulse"}]}, "alone"),
    ],
)
def test_other_problems_are_refused(changes, message) -> None:
    with pytest.raises(CaseError, match=message):
        exact_motions(build(with_changes(loads(CASE), changes)))
