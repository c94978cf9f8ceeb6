"""Where the motion that a wave is of has no meaning."""

import pytest

from tests.small_cases import BODY, problems_of

BELOW = """
[boundary.bottom]
type = "viscous_input"
wave_s = "w"
[boundary.left]
type = "periodic"
[boundary.right]
type = "periodic"
"""


def text(motion: str, sides: str = BELOW) -> str:
    wave = f'[wave.w]\ntype = "cosine"\namplitude = 1.0\nperiod = 0.01\nmotion = "{motion}"\n'
    return BODY + wave + sides


@pytest.mark.parametrize("motion", ["incident", "outcrop", "within"])
def test_an_absorbing_side_below_a_free_surface_takes_all(motion: str) -> None:
    assert problems_of(text(motion)) == []


PRESCRIBED = BELOW.replace("viscous_input", "velocity")
LOAD = '[[load]]\nname = "push"\nposition = [5.0, 2.5]\nforce = [1.0, 0.0]\nwave = "w"\n'
HOLE = '[[hole]]\ntype = "circle"\nname = "h"\ncentre = [5.0, 2.5]\nradius = 1.0\n'


@pytest.mark.parametrize(
    ("motion", "sides", "message"),
    [
        ("outcrop", PRESCRIBED, "but boundary.bottom prescribes the motion within the ground"),
        ("incident", LOAD, "is for waves of sides, but this one is the factor of load[1, push]; leave it out"),
        ("within", BELOW + '[boundary.top]\ntype = "viscous"\n', "which needs a free surface at the top"),
        ("within", BELOW + HOLE, "which needs ground without holes"),
        (
            "within",
            BELOW.replace("periodic", "viscous"),
            "which needs level ground: boundary.left and boundary.right take from",
        ),
        (
            "within",
            BELOW.replace('_s = "w"', '_s = "w"\nwave_p = "w"'),
            "every wave_p and wave_s to name a wave of its",
        ),
        ("within", BELOW.replace('"viscous_', '"viscoelastic_').replace("wave_s", "distance = 9.0\nwave_s"), "springs"),
    ],
)
def test_elsewhere_it_is_refused_in_one_line(motion: str, sides: str, message: str) -> None:
    problems = problems_of(text(motion, sides))
    assert len(problems) == 1, problems
    assert problems[0].startswith("wave.w.motion: ")
    assert message in problems[0]
