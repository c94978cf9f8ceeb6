"""Mistakes in [[joint]] tables, each in one line."""

import pytest
import tomli_w
from small_cases import PUSHED, SOIL, problems_in

from dembound.kinds import loads

JOINT = {"name": "fault", "points": [[3.0, -1.0], [6.0, 3.0]], "kn": 1e10, "ks": 1e10}


def problems_of(changes=None, tables=PUSHED, more=()):
    """The mistakes of a case with a joint."""
    return problems_in(lambda: loads(tomli_w.dumps(tables | {"joint": [JOINT | (changes or {}), *more]})))


def test_a_joint_from_one_free_side_to_another_is_right():
    assert problems_of() == []


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"points": [[3.0, 1.0]]}, "joint[1, fault].points: must be two or more, none of them twice in turn"),
        (
            {"points": [[3.0, -1.0], [4.0, 1.0], [8.0, 1.5]]},
            "joint[1, fault].points: turn by 56.3° at once, must turn by at most 10°",
        ),
        ({"ten": 1e6}, "joint[1, fault].ten: needs fric, the friction that is left once the joint has failed"),
        (
            {"fric": 0.3, "dilation": 17.0},
            "joint[1, fault].dilation: is 17, must be below the angle of fric, 16.7 (degrees)",
        ),
        ({"fric": 0.3, "dilation_end": 0.1}, "joint[1, fault].dilation_end: needs dilation"),
        ({"kn": 0.0}, "joint[1, fault].kn: is 0.0, must be greater than 0"),
        ({"points": [[3.0, 5.0], [6.0, 7.0]]}, "joint[1, fault].points: a segment has no part in the disks, in"),
    ],
)
def test_one_joint(changes, said):
    (line,) = problems_of(changes)
    assert line.startswith(said)


def test_a_joint_that_runs_beside_another():
    (line,) = problems_of(more=[JOINT | {"name": "other", "points": [[4.0, -1.0], [7.0, 3.0]]}])
    assert line.startswith(
        "joint[2, other].points: comes within three diameters of the disks, 1.5 m, of joint[1, fault]"
    )


def test_two_of_one_name():
    (line,) = problems_of(more=[JOINT | {"points": [[7.0, -1.0], [9.0, 3.0]]}])
    assert 'name: "fault" is taken by' in line


@pytest.mark.parametrize(
    ("changes", "said"),
    [({"material": {"law": "hertz", "density": 2500.0, "hz_shear": 1e9, "hz_poiss": 0.2}}, "is for contacts whose")],
)
def test_with_other_tables(changes, said):
    assert any(line.startswith(f"joint[1, fault]: {said}") for line in problems_of(tables=PUSHED | changes))


def test_at_a_periodic_side():
    (line,) = problems_of({"points": [[-1.0, 5.0], [0.2, 5.0]]}, SOIL)
    assert line.startswith('joint[1, fault].points: reaches boundary.left, "periodic", beyond which the ground goes on')
