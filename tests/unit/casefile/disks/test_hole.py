"""Holes: their keys, alone and beside the other tables."""

import pytest
from small_cases import BODY, problems_of, rows

CIRCLE = 'type = "circle"\ncentre = [5.0, 2.5]\nradius = 1.0'
STATIC = "[static]\nstress = [-1e6, -1e6, 0.0]\n"


def hole(keys: str = CIRCLE, name: str = "tunnel") -> str:
    return f'[[hole]]\nname = "{name}"\n{keys}\n'


def monitor(x: float, y: float) -> str:
    return f'[[monitor]]\nname = "P1"\nposition = [{x}, {y}]\n'


def load(place: str) -> str:
    return f'[[load]]\nname = "tap"\nforce = [1.0, 0.0]\n{place}\n'


def problems(*tables: str) -> list[str]:
    return problems_of(BODY + "".join(tables))


MISTAKES = r"""
type = "rectangle"\ncorners = [5, 1, 4, 2] | hole[1, tunnel].corners: must have x0 < x1 and y0 < y1, in the order x0, y
type = "polygon"\npoints = [[1, 1], [2, 2]] | hole[1, tunnel].points: has 2, must have at least three
"""


@pytest.mark.parametrize(("keys", "line"), rows(MISTAKES))
def test_each_mistake_gets_one_plain_line(keys: str, line: str) -> None:
    (found,) = problems(hole(keys))
    assert found.startswith(line)


def test_a_hole_beside_the_scene_is_refused() -> None:
    for x, y in ((11.0, 2.5), (5.0, -1.5)):
        assert problems(hole(f'type = "circle"\ncentre = [{x}, {y}]\nradius = 1.0')) == [
            "hole[1, tunnel]: lies outside the scene, [0, 0] to [10, 5] (m)"
        ]
    assert problems(hole('type = "circle"\ncentre = [10.9, 2.5]\nradius = 1.0')) == []  # it may reach beyond


def test_excavating_takes_a_static_stage() -> None:
    after = hole(f'{CIRCLE}\nstage = "after"')
    assert problems(after, STATIC) == []
    assert problems(after) == ['hole[1, tunnel].stage: is "after", but the case has no [static] stage to come after']
    # a stage that is invalid is there all the same
    assert problems(after, "[static]\ndamp = 2\n") == ["static.damp: is 2, must be less than 1"]


def test_nothing_is_watched_or_pushed_where_nothing_is_left() -> None:
    assert problems(hole(), monitor(5.0, 3.4), load("position = [4.1, 2.5]")) == [
        "load[1, tap].position: lies in hole[1, tunnel]; must be where particles remain",
        "monitor[1, P1].position: lies in hole[1, tunnel]; must be where particles remain",
    ]
    assert problems(hole(), monitor(5.0, 3.6), load("position = [3.9, 2.5]")) == []
    # a region is loaded where particles are left in it
    assert problems(hole(), load("region = [4.5, 2.0, 5.5, 3.0]")) == []
