"""A continuum at the end of a row of bricks."""

from dataclasses import replace

import numpy as np
import pytest
from angles import FREQUENCY, Side, reflection
from small_cases import GRAINS, small

from dembound.continuum.layer import Absorption
from dembound.disks.reflection import beyond, measure_side
from dembound.disks.reflection.bricks import BrickInRow
from dembound.disks.reflection.continuum_end import ContinuumEnd, beside_elements
from dembound.disks.reflection.meter import Meter
from dembound.disks.scene import build

ANGLES = [0.0, 25.0, 60.0]


@pytest.fixture(scope="module")
def side() -> Side:
    return Side.of()


@pytest.mark.parametrize(("kind", "angle"), [("p", 0.0), ("p", 75.0), ("s", 30.0)])
def test_of_a_lattice_it_sends_back_what_waves_of_rows_of_disks_say(side, kind, angle) -> None:
    """`angles` adds up the lattice's own waves, wave number by wave number, beside one row of elements.

    There sin θ/c is that of the lattice in steps, here that of the continuum: (qa)²/24 = 2e-4 of it, by which an
    exponent ln R0 · tan² θ of the energy differs, 2·9·14·2e-4.
    """
    row = BrickInRow(beside_elements(side.scene.ground, "right", side.scene.outside), "right")
    (found,) = Meter(row, side.step, ContinuumEnd(side.scene.outside, row)).measure([FREQUENCY], [angle], [kind])
    expected = reflection(side, kind, angle)["energy"]
    assert found.total(kind)[0, 0] == pytest.approx(expected, rel=5e-2 if angle > 70.0 else 2e-3)


@pytest.mark.parametrize(("name", "element"), [("left", 2.0), ("bottom", 12.0)])
def test_without_absorption_all_comes_back(name, element) -> None:
    """For P and S waves of a random packing, at all sides: the outer edge is at rest, and ties take no energy.

    Elements are a half and three times as long as bricks: two along a brick, and three bricks along an element.
    """
    changes = {"boundary": {name: {"type": "outside"}}, "outside": {"element": element, "layers": 2, "damping": 0.0}}
    scene = build(small(GRAINS, changes=changes | {"packing.size": [24.0, 24.0]}))
    body = replace(scene.outside.body, absorption=Absorption(reflection=1.0, delay=0.0))
    (found,) = beyond(replace(scene, outside=replace(scene.outside, body=body)), name, 1e-4).measure([20.0], ANGLES)
    for kind in found.kinds:
        np.testing.assert_allclose(found.total(kind), 1.0, rtol=1e-7)
        assert found.converted[kind][0, 1] > 0.01


def test_beside_a_narrow_body_only_waves_along_the_normal_are_measured() -> None:
    """Periodic and as wide as one element: its ties have the mean motion, as in a run."""
    lateral = {"type": "periodic"}
    ends = {"right": {"type": "outside"}, "left": {"type": "viscous", "beta_p": 1.0}}
    ends |= {"bottom": lateral, "top": lateral}
    case = small({**GRAINS, "boundary": ends, "outside": {"element": 4.0}})
    found = measure_side(case, "right", [0.0, 30.0], [30.0])
    assert found.found.angles.tolist() == [0.0]
    beside = measure_side(case, "left", [0.0, 30.0], [30.0])
    assert beside.found.angles.tolist() == [0.0, 30.0]
    _, reflections = beside.continuum
    assert reflections.angles.tolist() == [0.0]
    assert 0.0 < reflections.total("p")[0, 0] < 1e-3 < beside.found.total("p")[0, 0]
