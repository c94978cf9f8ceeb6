"""Sides that hold some of their particles, or some components of their motion."""

from types import SimpleNamespace

import numpy as np
import pytest
from pydantic import ValidationError
from small_cases import BODY

from dembound.boundaries import Fixed, Roller, Velocity, driven_components
from dembound.boundaries.support import Edge, SupportBuilder
from dembound.casefile.disks import DiskCase
from dembound.casefile.model import as_kind
from dembound.disks.reflection.bricks import end_scene
from dembound.kinds import loads

ALONG = np.array([0.0, 1.0, 2.0, 3.0])
TOP = Edge("top", np.array([7, 3, 9, 5]), np.stack([ALONG, np.full(4, 5.0)], axis=1), np.ones(4), 4.0)
LEFT = Edge("left", np.array([7, 3, 9, 5]), np.stack([np.zeros(4), ALONG], axis=1), np.ones(4), 4.0)
WAVES = {"press": SimpleNamespace(velocity=np.cos)}


def rows(table, edge: Edge) -> dict[int, list[int]]:
    """Nodes of the prescribed rows of a side by component."""
    builder = SupportBuilder()
    table.support(edge, None, WAVES, builder)
    made = builder.table()
    assert made.prescribed.all()
    return {component: made.node[made.component == component].tolist() for component in np.unique(made.component)}


def test_a_platen_holds_the_components_and_the_particles_that_it_names() -> None:
    smooth = Velocity(type="velocity", wave_p="press", hold=("normal",))
    jaw = Velocity(type="velocity", wave_p="press", within=(1.0, 2.5))

    assert rows(smooth, TOP) == {1: [3, 5, 7, 9]}
    assert rows(smooth, LEFT) == {0: [3, 5, 7, 9]}
    assert rows(jaw, TOP) == rows(jaw, LEFT) == {0: [3, 9], 1: [3, 9]}
    assert rows(Fixed(type="fixed", within=(1.0, 2.0)), TOP) == {0: [3, 9], 1: [3, 9], 2: [3, 9]}
    assert rows(Roller(type="roller", within=(2.0, 9.0)), LEFT) == {0: [5, 9]}
    assert jaw.part_of(TOP).length == 1.5
    # at rest it is the wall with the same hold
    assert smooth.at_rest() == Roller(type="roller", within=None)
    assert jaw.at_rest() == Fixed(type="fixed", within=(1.0, 2.5))


def test_only_motion_that_a_wave_prescribes_is_driven() -> None:
    sides = {
        "top": Velocity(type="velocity", wave_p="press"),
        "left": Velocity(type="velocity", wave_p="press", wave_s="press"),
        "bottom": Fixed(type="fixed"),
    }
    assert list(driven_components(sides)) == [("top", 1), ("left", 0), ("left", 1)]


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"wave_s": "press", "hold": ["normal"]}, "wave_s: moves a component that hold does not name"),
        ({"wave_p": "press", "hold": []}, "at least 1 item"),
        ({"wave_p": "press", "within": [2.0, 1.0]}, "must have its lower end first"),
    ],
)
def test_a_platen_without_effect_is_refused(keys, message) -> None:
    with pytest.raises(ValidationError, match=message):
        Velocity.model_validate({"type": "velocity", **keys})


def test_the_depth_of_a_jaw_beside_the_first_brick_is_that_of_the_whole_side() -> None:
    """A strip one brick wide stands for the side, and a jaw may hold none of its disks."""
    jaw = """
[boundary.top]
type = "velocity"
wave_p = "press"
within = [2.0, 4.0]
[wave.press]
type = "constant"
amplitude = -0.1
rise = 0.01
"""
    case = as_kind(loads(BODY + jaw), DiskCase, "is of disks")
    assert len(end_scene(case, "top").supports.node) > 0
