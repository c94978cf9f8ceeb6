"""Rows of monitors along the surface: at equal steps of x, on the outline of the uppermost ground."""

import numpy as np
import pytest
from small_cases import GROUND, Tables, problems_in, rows, small

from dembound.disks.scene import build
from dembound.kinds import with_changes

ROW = {"name": "surface", "along": "surface", "spacing": 2.5}
CANYON = {"name": "canyon", "type": "circle", "centre": [14.0, 20.0], "radius": 6.0}
TUNNEL = {"name": "tunnel", "type": "circle", "centre": [24.0, 15.0], "radius": 2.0}
SLOPE = {"name": "slope", "type": "polygon", "points": [[10.0, 21.0], [10.0, 20.0], [20.0, 8.0], [31.0, 8.0], [31, 21]]}


def on_ground(*holes: Tables, **row: object) -> Tables:
    """The tables of ground with holes and one row, with other keys."""
    return GROUND | {"hole": list(holes), "monitor": [ROW | row]}


def places(tables: Tables) -> np.ndarray:
    """Places (k, 2) m of the monitors."""
    return np.array([monitor.position for monitor in small(tables).monitor])


def test_a_row_follows_the_outline_of_the_uppermost_ground():
    x, y = places(on_ground(CANYON, TUNNEL)).T
    np.testing.assert_allclose(x, np.arange(1.25, 30.0, 2.5))  # as far from the left as from the right side
    inside = np.abs(x - 14.0) < 6.0
    expected = np.where(inside, 20.0 - np.sqrt(np.maximum(36.0 - (x - 14.0) ** 2, 0.0)), 20.0)
    np.testing.assert_allclose(y, expected, atol=2e-9)  # nine digits; the tunnel below is not the surface
    assert [monitor.name for monitor in small(on_ground()).monitor][::11] == ["surface_1", "surface_12"]
    x, y = places(on_ground(SLOPE, **{"from": 10.5, "to": 19.0})).T
    np.testing.assert_allclose(x, [10.5, 13.0, 15.5, 18.0])
    np.testing.assert_allclose(y, 20.0 - 1.2 * (x - 10.0), atol=2e-9)


def test_a_row_follows_ground_that_is_less_than_half_a_disk_below_the_top():
    """Disks of 1 m: a surface that falls from the top by 0.1 m; at the top's height a monitor would be in the air."""
    line = [[0.0, 20.0], [15.0, 20.0], [20.0, 19.9], [30.0, 19.9]]
    x, y = places(GROUND | {"ground": {"surface": line}, "monitor": [ROW]}).T
    np.testing.assert_allclose(y, np.interp(x, *np.transpose(line)), atol=2e-9)


def test_the_ground_goes_on_at_the_height_of_its_side_and_its_places_do_not_depend_on_the_disks():
    x, y = places(on_ground(SLOPE, **{"from": -3.0, "to": 34.0})).T
    assert (x[0], y[0], y[-1]) == (-3.0, 20.0, pytest.approx(8.0))
    large = small(on_ground(CANYON))
    box = {"packing.radius": 0.25, "packing.origin": [3.0, 10.0], "packing.size": [24.0, 10.0], "ground.size": [30, 20]}
    assert with_changes(large, box).monitor == large.monitor
    deep = box | {
        "boundary.top": {"type": "outside"},
        "packing.origin": [3.0, 5.0],
        "packing.size": [24.0, 8.0],
        "hole": [TUNNEL | {"centre": [15.0, 9.0]}],
    }
    assert {monitor.position[1] for monitor in with_changes(large, deep).monitor} == {20.0}


def test_the_disks_of_a_row_are_the_uppermost():
    """Of a lattice of 1 m: the disk nearest to the outline is below it by less than a diameter, with none above it."""
    scene = build(small(on_ground(CANYON)))
    for name, place in scene.monitored.items():
        above = (scene.positions[:, 0] == place[0]) & (scene.positions[:, 1] > place[1] + 1e-6)
        asked = scene.places[name]
        assert not above.any() or abs(asked[0] - 14.0) > 4.0  # but on walls steeper than 45°
        assert -1.0 < place[1] - asked[1] < 0.7


def test_a_row_beyond_the_motion_has_few_lines():
    """A row in the layers that absorb, of more than ten monitors."""
    found = problems_in(lambda: build(small(on_ground(**{"from": -500.0, "to": -450.0}))))
    assert len(found) == 11
    assert found[-1] == "monitor: so do 11 more; limit a row by from and to"


MISTAKES = """
from | -1.0 | .from: is -1, must be an x of the ground, from 0 to 30 (m)
spacing | 1e-4 | .spacing: makes 300,000 monitors, must make 1,000 or less
spacing | 100.0 | .spacing: leaves no place for a monitor; give another one, or other from and to
spacing | None | .spacing: is missing; a row needs it
along | None | .position: is missing; give it, along or points
position | [1.0, 2.0] | .position: is not allowed together with along
along | "ground" | .along: is "ground", must be "surface"
"""


@pytest.mark.parametrize(("key", "value", "line"), rows(MISTAKES))
def test_each_mistake_gets_a_plain_line(key: str, value: str, line: str):
    tables = on_ground() | {"boundary": {"left": {"type": "viscous"}}}
    tables["monitor"] = [{k: v for k, v in (ROW | {key: eval(value)}).items() if v is not None}]
    assert problems_in(lambda: small(tables))[0] == f"monitor[1, surface]{line}"


def test_a_row_needs_ground_and_a_free_surface():
    cut = {"name": "cut", "type": "rectangle", "corners": [10.0, -1.0, 12.0, 21.0]}
    (line,) = problems_in(lambda: small(on_ground(cut)))
    assert line == "monitor[1, surface].along: there is no ground at x = 11.25 m; give other from and to"
    held = on_ground() | {"boundary": {"top": {"type": "fixed"}}}
    (line,) = problems_in(lambda: small(held))
    assert line == 'monitor[1, surface].along: needs a free surface, but boundary.top.type is "fixed"'
    twice = on_ground() | {"monitor": [ROW, {"name": "surface_3", "position": [5.0, 5.0]}]}
    (line,) = problems_in(lambda: small(twice))
    assert line == 'monitor[13].name: "surface_3" is taken by monitor[3]'
