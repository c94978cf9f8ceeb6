"""A wave at an angle in words, in monitors and in snapshots."""

import pytest
from small_cases import SURROUNDED, small

from dembound.disks.scene import build
from dembound.kinds.disks.incident_wave import incident_facts

BESIDE = {"name": "beside", "position": [-1.5, 3.5]}
CASE = SURROUNDED | {
    "incident": {"type": "sv", "angle": 30.0, "wave": "pulse"},
    "wave": {"pulse": {"type": "cosine", "amplitude": 1.0, "period": 0.05, "start": 0.01}},
    "monitor": [*SURROUNDED["monitor"], BESIDE],
}


def test_facts_of_the_waves() -> None:
    """s_x = sin 30°/c_s = 1/1414 s/m, |A| as at a free surface; at the first disk, (0.5, 0.5) m, 0.97 ms later."""
    facts = dict(incident_facts(build(small(CASE))))

    assert facts["incident wave"].startswith("SV, 30° from the vertical to the right, with the velocity of wave pulse")
    assert "at (0, 0) m, at 1414.2 m/s along the surface; reaches the disks at 0.01097 s" in facts["incident wave"]
    expected = "SV at 30° with 0.268 of the amplitude; P at 45° with 0.897 of the amplitude; critical from 45° on"
    assert facts["reflected waves"] == expected
    assert facts["less exact monitors"] == "near the corners where layers begin: (-3, -3), (15, -3) m"


@pytest.mark.parametrize(
    ("changes", "wave", "reflected"),
    [
        ({"incident.angle": -20.0}, ("20° from the vertical to the left, ", " at (12, 0) m, "), ""),
        (
            {"incident.angle": 0.0},
            ("SV, straight up, with the velocity of wave pulse at (0, 0) m; ",),
            "SV at 0° with 1 of the amplitude; critical from 45° on",
        ),
        (
            {"boundary.top": {"type": "outside"}},
            ("at (0, 0) m, at 1414.2 m/s along x; reaches",),
            "none, as the ground has no surface",
        ),
    ],
)
def test_other_waves_are_reported(changes, wave: tuple[str, ...], reflected: str) -> None:
    facts = dict(incident_facts(build(small(CASE, changes=changes))))
    assert all(words in facts["incident wave"] for words in wave)
    assert reflected in facts["reflected waves"]
