"""Sets of joints: their lines, the share that is cut, and where lines end at others."""

import numpy as np
import pytest
import tomli_w
from small_cases import problems_in

from dembound.kinds import loads

KEYS = {"kn": 1e9, "ks": 1e9, "fric": 0.5}
GROUND = {
    "packing": {"pattern": "A", "size": [40.0, 20.0], "radius": 0.25},
    "material": {"density": 2500.0, "p_wave_speed": 1000.0},
    "run": {"duration": 0.01},
}
SET = KEYS | {"name": "bed", "dip": 20.0, "spacing": 3.0}


def case_of(*joints, **more):
    """A case with some joints."""
    return loads(tomli_w.dumps(GROUND | more | {"joint": [*joints]}))


def lines_of(*joints, **more):
    """Points (l, 2, 2) m of straight joints."""
    return np.array([joint.points for joint in case_of(*joints, **more).joint])


def lengths(lines):
    """Lengths (l,) m of lines (l, 2, 2) m."""
    return np.hypot(*(lines[:, 1] - lines[:, 0]).T)


def test_lines_fall_to_the_right_by_the_dip_at_equal_distances_from_side_to_side():
    lines = lines_of(SET)
    way = np.array([np.cos(np.radians(20.0)), -np.sin(np.radians(20.0))])
    np.testing.assert_allclose(lines[:, 1] - lines[:, 0], lengths(lines)[:, None] * way, atol=1e-6)
    np.testing.assert_allclose(np.diff(lines[:, 0] @ [-way[1], way[0]]), 3.0)
    x, y = lines.reshape(-1, 2).T
    assert (np.isclose(x, -3.0) | np.isclose(x, 43.0) | np.isclose(y, -3.0) | np.isclose(y, 23.0)).all()  # outside
    assert [joint.name for joint in case_of(SET).joint] == [f"bed_{k}" for k in range(1, len(lines) + 1)]
    assert np.array_equal(lines_of(SET), lines)
    assert not np.array_equal(lines_of(SET | {"seed": 1})[0], lines[0])


def test_persistence_is_the_share_of_the_lines_that_is_cut():
    whole = SET | {"spacing": 1.5, "region": [0.0, 0.0, 40.0, 20.0]}
    cut = lengths(lines_of(whole | {"persistence": 0.6, "trace": 6.0}))
    # some 60 cuts and bridges with a uniform spread of ±50 %: a standard error of 0.6·0.4·0.29·√2/√60 = 1.3 %, and ends
    np.testing.assert_allclose(cut.sum() / lengths(lines_of(whole)).sum(), 0.6, atol=0.05)
    assert cut.max() <= 9.0


def test_a_polygon_and_a_box_limit_a_set():
    corners = [[10.0, 2.0], [30.0, 2.0], [20.0, 18.0]]
    inside = lines_of(SET | {"dip": 0.0, "region": corners})
    y = inside[:, 0, 1]
    np.testing.assert_allclose(inside[:, 0, 0], 10.0 + 10.0 * (y - 2.0) / 16.0, atol=1e-6)
    np.testing.assert_allclose(inside[:, 1, 0], 30.0 - 10.0 * (y - 2.0) / 16.0, atol=1e-6)
    assert lines_of(SET | {"dip": 0.0, "region": [5.0, 5.0, 15.0, 10.0]})[:, :, 0].tolist() == [[5.0, 15.0]] * 2


def test_a_second_set_ends_at_the_first_so_that_blocks_form():
    lines = lines_of(SET | {"dip": 0.0, "spacing": 4.0}, SET | {"name": "cross", "dip": 60.0, "spacing": 5.0})
    bed, cross = (lines[np.isclose(lines[:, 0, 1], lines[:, 1, 1]) == flat] for flat in (True, False))
    x, y = cross.reshape(-1, 2).T
    inner = (x > 0.0) & (x < 40.0) & (y > 0.0) & (y < 20.0)
    assert np.abs(y[inner, None] - bed[:, 0, 1]).min(axis=1).max() < 1e-6
    assert np.count_nonzero(inner) > 40


def test_lines_stay_three_diameters_from_those_that_they_do_not_cross():
    fault = KEYS | {"name": "fault", "points": [[15.0, 10.0], [25.0, 10.0]]}
    case = case_of(fault, SET | {"dip": 10.0})
    places = np.concatenate([np.linspace(*joint.points, 400) for joint in case.joint[1:]])
    x, y = places.T
    assert np.hypot(x - np.clip(x, 15.0, 25.0), y - 10.0).min() >= 1.5 * (1.0 - 1e-9)
    assert case.joint[1].left_out > 5.0
    assert not any(joint.left_out for joint in case.joint[2:])


def test_a_line_that_crosses_an_earlier_one_becomes_two_and_a_short_end_beyond_it_is_dropped():
    fault = KEYS | {"name": "fault", "points": [[-1.0, 10.0], [41.0, 10.0]]}
    other = KEYS | {"name": "other", "points": [[20.0, -1.0], [20.0, 21.0]]}
    assert [joint.points for joint in case_of(fault, other).joint[1:]] == [
        ((20.0, -1.0), (20.0, 10.0)), ((20.0, 10.0), (20.0, 21.0)),
    ]  # fmt: skip
    (short,) = case_of(fault, other | {"points": [[20.0, -1.0], [20.0, 11.0]]}).joint[1:]
    assert (short.name, short.points) == ("other", ((20.0, -1.0), (20.0, 10.0)))
    read = loads(case_of(fault, other).text)
    assert read.joint == case_of(fault, other).joint


def test_sets_end_three_diameters_before_sides_beyond_which_the_ground_goes_on():
    lines = lines_of(SET | {"dip": 0.0}, boundary={side: {"type": "periodic"} for side in ("left", "right")})
    assert lines[:, :, 0].tolist() == [[1.5, 38.5]] * len(lines)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"spacing": 1.4}, "spacing: is 1.4, must be three diameters of the disks, 1.5 m, or more"),
        ({"spacing": None}, "spacing: is missing; a set needs it"),
        ({"persistence": 0.5}, "trace: is missing; bridges need it"),
        ({"trace": 4.0}, "trace: needs persistence below 1"),
        ({"persistence": 0.9, "trace": 5.0}, "persistence: makes bridges of 0.5556, must be six diameters"),
        ({"points": [[0.0, 1.0], [9.0, 1.0]]}, "points: is not allowed together with dip"),
        ({"dip": None}, "points: is missing; give it, or dip"),
        ({"region": [[1.0, 2.0], [3.0, 4.0]]}, "region: must be a box or at least three corners"),
        ({"region": [90.0, 90.0, 95.0, 95.0]}, "spacing: no line of three diameters of the disks, 1.5 m, is in"),
    ],
)
def test_mistakes(changes, said):
    table = {key: value for key, value in (SET | changes).items() if value is not None}
    found = problems_in(lambda: case_of(table))
    assert any(line.startswith(f"joint[1, bed].{said}") for line in found), found


def test_a_line_that_crosses_at_a_small_angle_is_refused():
    fault = KEYS | {"name": "fault", "points": [[-1.0, 10.0], [41.0, 10.0]]}
    (line,) = problems_in(lambda: case_of(fault, KEYS | {"name": "other", "points": [[5.0, 5.0], [35.0, 15.0]]}))
    assert line.startswith(
        "joint[2, other].points: comes within three diameters of the disks, 1.5 m, of joint[1, fault]"
    )
