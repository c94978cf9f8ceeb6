"""Scenes with and without rows that move identically."""

import pytest

from dembound.disks.reduced import OneRow, reduced
from dembound.disks.scene import build

P_INPUT = {"boundary.left": {"type": "viscous_input", "wave_p": "pulse"}}
S_INPUT = {"motion.held": ["x"], "boundary.left": {"type": "viscous_input", "wave_s": "pulse"}}
PERIODIC = {"boundary.bottom": {"type": "periodic"}, "boundary.top": {"type": "periodic"}}
SPRINGS = {"type": "viscoelastic", "distance": 20.0}
HOLE = {"hole": [{"name": "gap", "type": "circle", "centre": [5.25, 1.25], "radius": 0.1}]}
BROAD = {"packing.size": [10.0, 2.0]}
"""20 × 4 disks."""


@pytest.fixture
def scene(bar):
    """Makes scenes of 20 × 4 disks under a P pulse, y held, with keys of the case changed."""

    def make(changes=None):
        return build(bar({**BROAD, "motion.held": ["y"], **P_INPUT, **(changes or {})}))

    return make


def load(**keys):
    return {"load": [{"name": "push", **keys}]}


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"monitor": [{"name": "corner", "position": [0.0, 2.0]}]},
        {"boundary.bottom": {"type": "roller"}, "boundary.top": {"type": "roller"}, "motion.held": []},
        {"boundary.bottom": {"type": "symmetry"}, "boundary.top": {"type": "symmetry"}, "motion.held": []},
        {"boundary.right": SPRINGS},
        S_INPUT | PERIODIC | {"motion.held": []},
        load(region=[2.0, 0.0, 4.0, 2.0], force=[1e6, 0.0]),
        load(region=[2.0, 0.0, 4.0, 2.0], force=[1e6, 0.0], wave="pulse"),
    ],
)
def test_rows_that_move_identically_are_stepped_as_one(scene, changes) -> None:
    whole = scene(changes)
    row = reduced(whole).scene

    assert isinstance(row, OneRow)
    assert row.whole is whole
    assert row.count == 20
    assert row.weight == pytest.approx(4.0, rel=1e-15)
    assert row.low.tolist() == [0.0, 1.0]  # of the third of four rows
    assert row.reduced == ("rows: 4 identical rows are stepped as one, 20 of 80 disks",)


@pytest.mark.parametrize(
    "changes",
    [
        {"reduce.rows": False},
        {"packing.size": [10.0, 0.5]},  # a single row
        HOLE,
        load(position=[5.25, 1.25], force=[1e3, 0.0]),
        load(region=[2.0, 0.0, 4.0, 1.0], force=[1e6, 0.0]),
        {"motion.held": [], **load(acceleration=[0.0, -9.81])},
        {"boundary.bottom": {"type": "viscous", "beta_s": 1e-9}},
        {"boundary.bottom": SPRINGS | {"alpha_n": 0.0}},
        {"boundary.right": {"type": "viscoelastic", "source": [0.0, 1.0]}},
        S_INPUT,  # the outer rows have one contact less that resists their rotation
        S_INPUT | {"motion.held": [], "boundary.bottom": {"type": "symmetry"}, "boundary.top": {"type": "symmetry"}},
        {"material.law": "linearpbond"},
        {"static.stress": [-1e6, -1e6, 0.0]},
        {"boundary.right": {"type": "free_field"}, "motion.held": []},
    ],
)
def test_rows_that_differ_are_stepped_one_by_one(scene, changes) -> None:
    whole = scene(changes)

    assert reduced(whole).scene is whole
    assert whole.whole is whole
    assert whole.reduced == ()
    assert whole.weight == 1.0
