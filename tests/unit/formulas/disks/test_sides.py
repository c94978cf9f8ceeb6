"""Errors by sides along a wave: axes and sides, the undisturbed ground, scenes without such sides."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from small_cases import PUSHED, SURROUNDED, Tables, around, small

from dembound.disks.scene import DiskScene, build
from dembound.formulas.disks import continuum as of
from dembound.formulas.disks.beside_wave import Grid, taken_from_waves, undisturbed
from dembound.formulas.disks.continuum import expected_errors
from dembound.formulas.disks.rest import CHANCE_LATTICE, causes_of_rest
from dembound.formulas.history import History
from dembound.holes import Circle

SPEED, PERIOD = 1000.0, 0.02


def scene_of(driven: str, along: dict, motion: str = "s", **others):
    """A lattice of 16 × 10 disks, the longer side along the wave's front, with two monitors on the way of the wave."""
    upright = driven in ("bottom", "top")
    size = [16.0, 10.0] if upright else [10.0, 16.0]
    depths = (2.5, 9.5) if driven in ("bottom", "left") else (7.5, 0.5)
    places = [[4.5, depth] if upright else [depth, 4.5] for depth in depths]
    sides = ("left", "right") if upright else ("bottom", "top")
    tables = {
        "packing": {"pattern": "A", "size": size, "radius": 0.5},
        "material": {"density": 2500.0, "p_wave_speed": SPEED, "fric": 0.5},
        "boundary": {driven: {"type": "viscous_input", f"wave_{motion}": "pulse"}} | dict.fromkeys(sides, along),
        "wave": {"pulse": {"type": "cosine", "amplitude": 1.0, "period": PERIOD}},
        "monitor": [{"name": name, "position": place} for name, place in zip("ab", places, strict=True)],
        "run": {"duration": 0.08},
    }
    return build(small(tables, changes=others))


def shares(*of, **others) -> list[float]:
    (found,) = taken_from_waves(scene_of(*of, **others))
    return list(found.shares.values())


@pytest.mark.parametrize(
    ("motion", "along"), [("p", {"type": "viscous"}), ("s", {"type": "viscoelastic", "distance": 10.0})]
)
def test_waves_from_all_sides_are_alike(motion: str, along: dict) -> None:
    up = shares("bottom", along, motion)
    assert min(up) > 0.1
    for driven in ("top", "left", "right"):
        assert shares(driven, along, motion) == pytest.approx(up, rel=1e-9)


def test_the_undisturbed_ground_carries_the_wave_and_its_surface_doubles_it() -> None:
    grid = Grid.of(scene_of("bottom", {"type": "viscous"}, "p"), 1)
    lengths = [grid.weights(side).sum() for side in ("left", "right", "bottom", "top")]
    assert lengths == pytest.approx([10.0, 10.0, 16.0, 16.0])
    step = grid.time_step
    times = step * np.arange(int(0.08 / step))
    incoming = np.zeros((len(times), 2))
    incoming[:, 1] = np.where(times < PERIOD, 0.5 - 0.5 * np.cos(2.0 * np.pi * times / PERIOD), 0.0)
    ground = undisturbed(grid, "bottom", incoming, np.zeros_like(incoming), step)

    # 1 m/s comes in; waves of 20 elements a period lose 1 % of their peak on the way
    assert np.abs(ground.v[:, -1, 1]).max() == pytest.approx(2.0, rel=0.02)
    # the surface sends them back through the bottom
    assert np.abs(ground.v[-5:]).max() < 0.02
    assert not ground.v[:, :, 0].any()


@pytest.mark.parametrize("along", [{"type": "free"}, {"type": "fixed", "artificial": False}, {"type": "free_field"}])
def test_sides_that_end_the_body_or_whose_ground_moves_are_not_asked_about(along: dict) -> None:
    assert list(taken_from_waves(scene_of("bottom", along))) == []


S_SPEED, DIAMETER = 1000.0 / math.sqrt(2.0), 1.0
MIDDLE = (10.0, 10.0)
SMOOTH = {"type": "sine_burst", "amplitude": 1.0, "cycles": 40}
"""A burst of next to one frequency."""


def scene(frequency: float, *, outside: Tables | None = None, **changes: object) -> DiskScene:
    """A force in the middle of 20 m × 20 m of an isotropic lattice, in a continuum all round."""
    push = {"name": "push", "force": [1e6, 0.0], "position": [10.1, 10.1], "wave": "w"}
    tables = SURROUNDED | {
        "packing": {"pattern": "A", "size": [20.0, 20.0], "radius": 0.5},
        "boundary": around("outside", "left", "right", "bottom", "top"),
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
    passed = 4.0 * S_SPEED / (of.PASSED * 20.0)
    coarse = {"element": 20.0}
    of_all = [velocity(scene(part * passed, outside=coarse)) for part in (0.8, 2.0)]
    of_others = [velocity(scene(part * passed, outside={"element": 2.0})) for part in (0.8, 2.0)]
    elements = [math.sqrt(a**2 - b**2) for a, b in zip(of_all, of_others, strict=True)]
    assert elements == pytest.approx([of.RETURNED * 0.8**of.STEEP, of.RETURNED], rel=0.05)


def test_ties_return_more_of_waves_that_have_come_as_far_and_meet_them_at_an_angle() -> None:
    """At r right of a force between sides at 10 m, whose images are 20 − r, 20 + r, and twice √(20² + r²) away."""
    frequency = 20.0
    made = scene(frequency, outside={"element": 2.0})
    k = 2.0 * math.pi * frequency / S_SPEED
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


def test_nothing_is_known_without_a_continuum_or_of_waves_that_jump() -> None:
    assert expected_errors(scene(20.0, wave={"w": {"type": "constant", "amplitude": 1.0}}), {}) is None
    assert expected_errors(scene(20.0, boundary={}), {}) is None
    assert expected_errors(scene(20.0), {}) == {}


STATIC: dict[str, Any] = {"elastic": False, "ratio": 1e-7, "mean_residual": 3e-3, "cracks": 0}
STATIC |= {"before": None, "column": None}
PEAK = 2e-3


def resting(packing: dict[str, Any] = PUSHED["packing"], share: float = 0.5, **static: float) -> DiskScene:
    weight = {"name": "weight", "acceleration": [0.0, -9.81]}
    boundary = around("periodic", "left", "right") | around("viscous", "bottom")
    held = {"boundary": {"bottom": {"type": "fixed"}}, **static}
    changes = {"boundary": boundary, "wave": {}, "load": [weight], "static": held, "packing": packing}
    return build(small(PUSHED, changes={**changes, "material.law": "linearpbond", "material.contact_share": share}))


def motions(peak: float) -> dict[str, History]:
    """A monitor that moves along y, and turns faster, which does not count."""
    velocity = np.array([[0.0, 0.0, 0.0], [0.0, -peak, 7.0], [0.0, 0.5 * peak, 0.0]])
    return {"front": History.of(np.zeros(2), np.arange(3.0), velocity, velocity)}


@pytest.mark.parametrize("static", [{}, {"k0": 0.5}])
def test_the_error_is_the_force_of_rest_over_that_of_the_wave(static: dict[str, float]) -> None:
    """S waves are the slower ones: without friction bonds alone bear shear, half of all, and C66 is half of that."""
    body = resting(**static)
    (cause,) = causes_of_rest(body, motions(PEAK), STATIC).found
    slow = 1000.0 * np.sqrt(0.25)
    force = 3e-3 + CHANCE_LATTICE * 3e-3 / 1e-7  # left, and by chance, of the mean contact force 3e4 N
    assert cause.parts["front"]["velocity"] == pytest.approx(force / (2500.0 * slow * 0.5 * PEAK), rel=1e-3)
    assert cause.parts["front"]["displacement"] == pytest.approx(0.3 * cause.parts["front"]["velocity"])


def test_nothing_is_said_without_sliding_and_nothing_is_known_with_breaks() -> None:
    body, moved = resting(), motions(PEAK)
    assert causes_of_rest(body, moved, STATIC | {"elastic": True}).found == []
    for broken in ({"cracks": 3}, {"column": STATIC | {"cracks": 3}}, {"before": STATIC | {"cracks": 3}}):
        (cause,) = causes_of_rest(body, moved, STATIC | broken).found
        assert cause.how == "unknown"
        assert cause.words.startswith("3 bonds broke while")
    cave = Circle(type="circle", name="cave", centre=(5.0, 1.2), radius=0.6)
    (cause,) = causes_of_rest(replace(body, case=replace(body.case, hole=(cave,))), moved, STATIC).unknown
    assert "hole" in cause.words
    (cause,) = causes_of_rest(resting(share=0.6), moved, STATIC).unknown
    assert "that they bear more than bonds" in cause.words
    assert np.isnan(causes_of_rest(body, motions(0.0), STATIC).found[0].parts["front"]["velocity"])
