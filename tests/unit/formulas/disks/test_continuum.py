"""Errors of the motion by a continuum, by formula."""

import math

import numpy as np
import pytest
from small_cases import SURROUNDED, Tables, small

from dembound.continuum.sizing import slowest
from dembound.disks.scene import DiskScene, build
from dembound.formulas.disks import continuum as of
from dembound.formulas.disks.continuum import expected_errors

SPEED, DIAMETER = 1000.0 / math.sqrt(2.0), 1.0
SIDES = ("left", "right", "bottom", "top")
MIDDLE = (10.0, 10.0)
SMOOTH = {"type": "sine_burst", "amplitude": 1.0, "cycles": 40}
"""A burst of next to one frequency."""


def scene(frequency: float, *, outside: Tables | None = None, **changes: object) -> DiskScene:
    """A force in the middle of 20 m × 20 m of an isotropic lattice, in a continuum all round."""
    push = {"name": "push", "force": [1e6, 0.0], "position": [10.1, 10.1], "wave": "w"}
    tables = SURROUNDED | {
        "packing": {"pattern": "A", "size": [20.0, 20.0], "radius": 0.5},
        "boundary": {side: {"type": "outside"} for side in SIDES},
        "outside": {"order": 4, "element": 5.0, "layers": 4, "reflection": 1e-6} | (outside or {}),
        "wave": {"w": SMOOTH | {"frequency": frequency}},
        "load": [push],
        "run": {"duration": 40.0 / frequency},
    }
    return build(small(tables | changes))


def velocity(made: DiskScene, place: tuple[float, float] = (10.0, 14.0)) -> float:
    found = expected_errors(made, {"here": np.array(place)})
    return found["here"][0]


def test_elements_return_half_of_the_shortest_waves_and_less_of_longer_ones() -> None:
    """Elements of 20 m of order 4 pass on waves down to 22.5 m, 31.4 Hz; at 0.8 of that it is 0.8⁸."""
    passed = 4.0 * SPEED / (of.PASSED * 20.0)
    coarse = {"element": 20.0}
    of_all = [velocity(scene(part * passed, outside=coarse)) for part in (0.8, 2.0)]
    of_others = [velocity(scene(part * passed, outside={"element": 2.0})) for part in (0.8, 2.0)]
    elements = [math.sqrt(a**2 - b**2) for a, b in zip(of_all, of_others, strict=True)]
    assert elements == pytest.approx([of.RETURNED * 0.8**of.STEEP, of.RETURNED], rel=0.05)


def test_ties_return_more_of_waves_that_have_come_as_far_and_meet_them_at_an_angle() -> None:
    """At r right of a force between sides at 10 m, whose images are 20 − r, 20 + r, and twice √(20² + r²) away."""
    frequency = 20.0
    made = scene(frequency, outside={"element": 2.0})
    k = 2.0 * math.pi * frequency / SPEED
    plain = of.TIES * (1.0 / 16.0 + 0.1 / 8.0 / math.sqrt(2.0)) * (k * DIAMETER) ** 2
    for r in (4.0, 8.0):
        slant = math.hypot(20.0, r)
        spread = r / (20.0 - r) + r / (20.0 + r) + 2.0 * r / slant / (20.0 / slant) ** 2
        found = velocity(made, (10.1 + r, 10.1))
        assert found == pytest.approx(plain * math.sqrt(spread), rel=0.05), r  # 40 cycles, the middle 0.1 m off


def test_layers_return_a_part_of_r0_and_are_too_steep_for_what_lasts() -> None:
    """A pulse whose displacement stays: half of its energy and more is slower than the ground is long."""
    pulse = {"wave": {"w": {"type": "cosine", "amplitude": 1.0, "period": 0.5}}, "run": {"duration": 1.0}}

    def displacement(layers: int, reflection: float) -> float:
        made = scene(1.0, outside={"layers": layers, "reflection": reflection, "element": 5.0}, **pulse)
        found = expected_errors(made, {"here": np.array(MIDDLE)})
        return found["here"][1]

    assert displacement(6, 0.01) == pytest.approx(of.KEPT * 0.01, rel=0.01)
    steep, flat = displacement(2, 1e-8), displacement(2, 1e-4)
    assert flat == pytest.approx(of.LAYERS * 7e-3, rel=0.05)  # all of it lasts; ties and R0 are next to nothing
    assert steep == pytest.approx(4.0 * flat, rel=0.05)


def test_of_waves_that_come_through_it_a_part_leaves_through_it_again_and_places_are_alike() -> None:
    entering = {"load": [], "boundary": {side: {"type": "outside"} for side in SIDES[:3]}}
    entering["boundary"]["bottom"] = {"type": "outside", "wave_s": "w"}
    made = scene(20.0, **entering)
    k = 2.0 * math.pi * 20.0 / SPEED
    ties = of.TIES * (1.0 / 16.0 + 0.1 / 8.0 / math.sqrt(2.0)) * k**2
    assert velocity(made) == pytest.approx(of.SCATTERED * ties, rel=0.05)
    assert velocity(made, (1.0, 3.0)) == velocity(made)


def test_beside_a_blast_elements_and_ties_err_in_its_static_field_where_it_is() -> None:
    """A burst of 1 Hz in a hole of 3 m amid elements as wide as the box, and in place of it a wave from below."""
    hole = {"name": "cave", "type": "circle", "centre": list(MIDDLE), "radius": 3.0}
    blast = {"name": "blast", "hole": "cave", "pressure": 1e6, "wave": "w"}
    wide = {"element": 20.0}
    made = scene(1.0, outside=wide, hole=[hole], load=[blast])
    largest = math.hypot(2e-2, 0.2 / 10.0**2)
    for x in (14.0, 17.0):
        assert velocity(made, (x, 10.0)) == pytest.approx(largest * ((x - 10.0) / 10.0) ** 2, rel=0.01)
    below = {side: {"type": "outside"} for side in SIDES[:2]} | {"bottom": {"type": "outside", "wave_s": "w"}}
    passed = scene(1.0, outside=wide, hole=[hole], load=[], boundary=below)
    k = 2.0 * math.pi / SPEED
    assert velocity(passed) == pytest.approx(2e-2 * 1.5 * k * 3.0 * 0.3, rel=0.02)


def test_nothing_is_known_without_a_continuum_or_of_waves_that_jump() -> None:
    assert expected_errors(scene(20.0, wave={"w": {"type": "constant", "amplitude": 1.0}}), {}) is None
    assert expected_errors(scene(20.0, boundary={}), {}) is None
    assert expected_errors(scene(20.0), {}) == {}


def test_what_random_bricks_would_scatter_is_missing_beside_a_continuum(monkeypatch) -> None:
    """0.06 k²LD of a burst about one frequency; waves shorter than a brick are as those of its length."""
    packing = {"pattern": "B", "size": [20.0, 20.0], "radius": 0.5, "radius_ratio": 1.5, "brick": [10.0, 10.0]}
    for frequency in (20.0, 200.0):
        made = scene(frequency, packing=packing)
        k = 2.0 * math.pi * min(frequency / slowest(made.outside.body.medium), 1.0 / 10.0)
        both = velocity(made)
        monkeypatch.setattr(of, "BRICKS", 0.0)
        bricks = math.sqrt(both**2 - velocity(made) ** 2)
        monkeypatch.undo()
        assert bricks == pytest.approx(0.06 * k**2 * 10.0 * made.ground.brick.mean_diameter, rel=0.02)
