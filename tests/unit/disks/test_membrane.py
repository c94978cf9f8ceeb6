"""Pressures on sides: the polygon of their membranes."""

import numpy as np
import pytest
from small_cases import GRAINS, problems_of, small

from dembound.disks.pressure import in_run, membranes_of
from dembound.disks.scene import build
from dembound.disks.supports import forces_of

P = 1e6
ALL = {"name": "cell", "pressure": P, "sides": ["left", "right", "bottom", "top"]}
BODY = {"packing": GRAINS["packing"], "material": GRAINS["material"], "run": {"duration": 0.01}}
CRACKED = BODY | {"material": GRAINS["material"] | {"law": "linearpbond", "pb_ten": 1e5, "pb_coh": 1e5}}


def resultants(scene, displacement: np.ndarray, force: np.ndarray) -> np.ndarray:
    """Sums of the forces (3, n) along x and y, and of their torques."""
    x, y = scene.positions.T + displacement[:2]
    return np.array([force[0].sum(), force[1].sum(), (x * force[1] - y * force[0] + force[2]).sum()])


def test_membranes_on_opposite_sides_are_in_balance_as_built() -> None:
    scene = build(small(BODY | {"load": [ALL | {"sides": ["left", "right"]}]}))
    force = scene.steady_load
    left = next(membranes_of(scene.case.load[0], scene))
    width, height = scene.size

    assert np.abs(resultants(scene, np.zeros_like(force), force)).max() < 1e-9 * P * width * height
    assert left.forces(scene.positions, np.zeros_like(force))[:, 0].sum() == pytest.approx(P * height, rel=1e-12)
    nodes, each = forces_of(scene.case.load[0], scene)
    assert np.array_equal(force[:, nodes], each.T)
    # no disk is pushed by more than the pressure on some three diameters
    assert np.hypot(*each[:, :2].T).max() < P * 3.0 * scene.ground.brick.mean_diameter


def test_a_closed_membrane_is_in_balance_wherever_its_disks_are() -> None:
    scene = build(small(CRACKED | {"load": [ALL]}))
    displacement = np.random.default_rng(1).uniform(-0.1, 0.1, (3, scene.count))
    force = in_run(scene, displacement, scene.steady_load)
    width, height = scene.size

    assert np.abs(resultants(scene, displacement, force)).max() < 1e-9 * P * width * height
    # its work is the pressure times the area that the polygon of its disks loses
    each = {membrane.side: membrane.nodes for membrane in membranes_of(scene.case.load[0], scene)}
    ring = np.concatenate([each["bottom"], each["right"][1:], each["top"][-2::-1], each["left"][-2:0:-1]])
    change = np.random.default_rng(2).uniform(-0.1, 0.1, (2, scene.count))

    def area(sign: float) -> float:
        x, y = (scene.positions.T + displacement[:2] + sign * change)[:, ring]
        return 0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))

    loss = 0.5 * (area(-1.0) - area(1.0))  # of the second degree, so that this is exact
    assert float(np.sum(force[:2] * change)) == pytest.approx(P * loss, rel=1e-9)


def test_a_membrane_ends_at_platens_and_does_not_follow_an_elastic_body() -> None:
    platens = {"top": {"type": "roller"}, "bottom": {"type": "roller"}}
    scene = build(small(CRACKED | {"load": [ALL], "boundary": platens}))
    still, rng = np.zeros((3, scene.count)), np.random.default_rng(1)
    sides = build(small(CRACKED | {"load": [ALL | {"sides": ["left", "right"]}]})).steady_load
    assert np.allclose(in_run(scene, still, scene.steady_load), sides, atol=1e-9 * P)

    elastic = build(small(BODY | {"load": [ALL]}))
    moved = in_run(elastic, rng.uniform(-0.1, 0.1, still.shape), elastic.steady_load)
    assert np.allclose(moved, elastic.steady_load, atol=1e-9 * P)


HEAD = """
[packing]
pattern = "A"
size = [10.0, 5.0]
radius = 0.25
[material]
density = 2500.0
p_wave_speed = 1000.0
[run]
duration = 1.0
[wave.w]
type = "constant"
amplitude = 1.0
"""


@pytest.mark.parametrize(
    ("tables", "problem"),
    [
        ('sides = ["left"]\nhole = "h"', "hole: is not allowed together with sides"),
        ('sides = ["left"]\nwave = "w"', "wave: is not allowed together with sides, on which a pressure is steady"),
        ('sides = ["left", "left"]', "sides: names a side twice"),
        ("", "hole: is missing; a pressure needs the name of a hole, or sides"),
        (
            'sides = ["left"]\n[boundary.left]\ntype = "outside"',
            'sides: names left, "outside", where the body goes on; must be a free side',
        ),
        (
            'sides = ["left"]\n[static]\n',
            'nothing holds the body along x against load[1, cell]; give a side "fixed" or "roller"',
        ),
        (
            'sides = ["left", "right"]\n'
            '[[hole]]\nname = "h"\ntype = "circle"\ncentre = [5.0, 2.5]\nradius = 2.0\nkeep = "inside"',
            "sides: is for a rectangular body, and a hole keeps what is inside; must not be together",
        ),
    ],
)
def test_pressures_that_cannot_act_are_refused(tables: str, problem: str) -> None:
    found = problems_of(f'{HEAD}[[load]]\nname = "cell"\npressure = 1e6\n{tables}')
    assert [line for line in found if problem in line], found
