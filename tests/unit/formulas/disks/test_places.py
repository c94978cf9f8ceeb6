"""Motion between the disks of a lattice, and where loads start waves."""

import numpy as np
import pytest
import tomli_w
from scene_tables import ISOTROPIC, lattice, pulse
from small_cases import PUSHED, around, small

from dembound.casefile.disks import DiskCase
from dembound.continuum.sizing import mean_frequency
from dembound.disks.material.packing_waves import slowest_speed
from dembound.disks.scene import build
from dembound.disks.surroundings.near_fields import signals_of
from dembound.formulas.cause import MOTIONS
from dembound.formulas.disks import near_disks
from dembound.formulas.disks.near_disks import BETWEEN, CREEP, DARK, LIT, OF_WAVES, SHORT, wall_errors
from dembound.formulas.disks.places import NINE, middle_of_loads, weights_at
from dembound.holes import Circle, Rectangle
from dembound.holes.rectangle import STRAIGHT
from dembound.kinds import loads
from dembound.packings import Square


def test_quadratic_motion_is_found_at_any_place() -> None:
    """Products of parabolas along x and along y are what Lagrange's polynomials through nine places are made of."""
    patch = 0.5 * NINE + [3.25, 1.25]

    def motion(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return np.asarray((1.0 - 2.0 * x + 0.5 * x**2) * (3.0 + y - 0.25 * y**2))

    for place in ([3.25, 1.25], [3.4, 1.1], [3.75, 0.9], [2.6, 1.9]):
        found = weights_at(patch, np.array(place)) @ motion(*patch.T)
        assert found == pytest.approx(float(motion(*np.array(place))), rel=1e-12)
    assert weights_at(patch[:1], np.array([9.0, 9.0])) == pytest.approx([1.0])
    assert weights_at(patch, np.array([9.0, 1.3])) == pytest.approx(weights_at(patch, np.array([4.25, 1.3])))


def test_places_are_seen_from_the_middle_of_the_loads_by_their_force() -> None:
    """The middle of 1 at (2.5, 1) and 3 at (6.5, 1) is (5.5, 1); a pressure counts from the middle of its hole."""
    loads = [
        {"name": "a", "force": [1e5, 0.0], "region": [2.0, 0.5, 3.0, 1.5], "wave": "push"},
        {"name": "b", "force": [0.0, -3e5], "region": [6.0, 0.5, 7.0, 1.5], "wave": "push"},
    ]
    cave = {"name": "cave", "type": "rectangle", "corners": [4.0, 0.5, 6.0, 1.5]}
    blast = {"name": "c", "pressure": 1e5, "hole": "cave", "wave": "push"}
    free = {"boundary": {}}

    def middle(**changes: object) -> np.ndarray | None:
        return middle_of_loads(build(small(PUSHED, changes=changes)))

    assert middle(load=loads, **free) == pytest.approx(np.array([5.5, 1.0]))
    assert middle(load=[blast], hole=[cave], **free) == pytest.approx(np.array([5.0, 1.0]))
    assert middle() is None  # driven


def test_errors_of_walls_are_of_first_order() -> None:
    """4 % for a circle with 10 disks along the radius, 6.7 % for a rectangle with 3 disks along the smaller half."""
    circle = Circle.model_validate({"type": "circle", "name": "a", "centre": (0.0, 0.0), "radius": 10.0})
    long = Rectangle.model_validate({"type": "rectangle", "name": "b", "corners": (0.0, 0.0, 6.0, 20.0)})

    def between(axis: int, place: float) -> float:
        return 0.0

    assert circle.wall_error(1.0, between) == pytest.approx(0.04)
    assert circle.wall_error(0.5, between) == pytest.approx(0.02)
    assert long.wall_error(1.0, between) == pytest.approx(0.2 / 3.0)
    assert long.wall_error(0.5, between) == pytest.approx(0.1 / 3.0)


def test_walls_that_are_not_between_disks_change_the_size_of_a_hole() -> None:
    """With disks of 1 m from the origin on, walls at 2, 8 and 20 m fit; a wall at 8.4 m is off by 0.4 m of 6.4 m."""

    def misfit(right: float, diameter: float = 1.0, top: float = 20.0, origin: float = 0.0) -> float:
        corners = (2.0, 2.0, right, top)
        hole = Rectangle.model_validate({"type": "rectangle", "name": "b", "corners": corners})
        lattice = Square(radius=0.5 * diameter, size=(30.0, 30.0), origin=(origin, 0.0))
        whole, between = hole.wall_error(diameter, lattice.apart), hole.wall_error(diameter, lambda axis, place: 0.0)
        return float(np.sqrt(whole**2 - between**2))

    assert misfit(8.0) == pytest.approx(0.0, abs=1e-7)
    assert misfit(8.4) == pytest.approx(0.4 / 6.4)
    assert misfit(8.4, origin=0.4) == pytest.approx(0.4 / 6.4)  # there the left one is off
    assert misfit(8.4, diameter=0.4) == pytest.approx(0.0, abs=1e-7)
    assert misfit(8.0, top=31.5) == pytest.approx(0.0, abs=1e-7)  # open at the surface


CAVE = {"name": "cave", "type": "rectangle", "corners": [4.0, 0.5, 6.1, 2.0]}


def scattered(case: DiskCase, lowest: float = np.inf) -> float:
    """The error of waves round a hole with a smaller half of 0.75 m, over the error of a pressure in it."""
    frequency = mean_frequency(signals_of(case)[0], lowest)
    return OF_WAVES * 2.0 * np.pi * frequency / slowest_speed(build(case).ground) * 0.75


def test_waves_have_the_part_of_the_error_of_a_pressure_that_a_hole_scatters() -> None:
    """A smaller half of 0.75 m, three half disks, with one wall of a rectangle 0.1 m off."""

    def errors(hole: dict, period: float = 0.01, **changes: object) -> tuple[DiskCase, dict[str, float]]:
        of_wave = {"wave.push.period": period, "wave.shake.period": period, "run.duration": 2.0 * period}
        case = small(PUSHED, changes={"hole": [hole], "packing.size": [10.0, 3.0]} | of_wave | changes)
        return case, wall_errors(case, build(case).ground, 0.5)

    burst = {"name": "burst", "hole": "cave", "pressure": 1e5, "wave": "push"}
    bore = {"name": "cave", "type": "circle", "centre": [5.0, 1.5], "radius": 0.75}
    half, box, round_hole = 1.5, np.hypot(STRAIGHT / 1.5, 0.05 / 0.75), 0.4 / 1.5
    case, slow = errors(CAVE, 0.1)
    numbers = [scattered(case) / OF_WAVES, scattered(case, 1.0 / case.run.duration) / OF_WAVES]
    assert list(slow.values()) == pytest.approx([box * BETWEEN * OF_WAVES * number for number in numbers])
    assert errors(CAVE, 0.0001)[1]["velocity"] == pytest.approx(box * BETWEEN)
    # on the mean of all directions, at the wall
    expected = [number * (LIT + 0.5 * (DARK + CREEP * numbers[0])) / half for number in numbers]
    assert list(errors(bore, 0.1)[1].values()) == pytest.approx(expected)
    shortest = SHORT * (LIT + 0.5 * (DARK + CREEP * SHORT)) / half
    assert errors(bore, 0.0001)[1]["velocity"] == pytest.approx(shortest)
    for hole, pressed in ((CAVE, box), (bore, round_hole)):
        assert errors(hole, load=[burst])[1] == pytest.approx(dict.fromkeys(MOTIONS, pressed))
    without = small(PUSHED)
    assert wall_errors(without, build(without).ground, 0.5) == dict.fromkeys(MOTIONS, 0.0)


def test_short_waves_are_most_wrong_behind_a_hole_but_not_where_the_surface_cuts_it() -> None:
    """An SV wave at 30° to the right of the vertical: the wall behind is up and to the right of the middle."""
    bore = {"name": "bore", "type": "circle", "centre": [10.0, 10.0], "radius": 2.0}
    way = np.array([np.sin(np.radians(30.0)), np.cos(np.radians(30.0))])

    def errors(kind: str, height: float = 10.0, far: float = 2.0, period: float = 0.005) -> list[float]:
        tables = {
            "packing": lattice(20.0, 20.0, 0.5),
            "material": ISOTROPIC,
            "boundary": around("outside"),
            "hole": [bore | {"centre": [10.0, height]}],
            "incident": {"type": kind, "angle": 30.0, "wave": "pulse"},
            "wave": pulse(period),
            "run": {"duration": 0.1},
        }
        case = loads(tomli_w.dumps(tables), name="bore")
        ground = build(case).ground
        places = ([10.0, height] + far * sign * way for sign in (-1.0, 1.0))
        return [wall_errors(case, ground, 0.5, place)["velocity"] for place in places]

    # v ~ 1 − cos ωt has the RMS rate ω/√3 of its RMS value
    number = 2.0 * np.pi / 0.005 / np.sqrt(3.0) * 2.0
    for kind, speed in (("sv", 1000.0 / np.sqrt(2.0)), ("p", 1000.0)):
        along = number / speed
        behind = along * (LIT + DARK + CREEP * along) / 4.0
        assert errors(kind) == pytest.approx([along * LIT / 4.0, behind], rel=1e-3)
        assert errors(kind, far=4.0)[1] == pytest.approx(behind / 2.0**near_disks.FALL, rel=1e-3)
        mean = along * (LIT + 0.5 * (DARK + CREEP * along)) / 4.0
        assert errors(kind, height=20.0) == pytest.approx([mean, mean], rel=1e-3)
