"""The rotation of a body as a whole: which bodies can turn, and the motion of one that has."""

import numpy as np
import pytest
from disk_systems import BODY, turn

from dembound.disks.scene import DiskScene, build
from dembound.disks.stepping.fields import turned_as_a_whole, turns_freely

RANDOM = {
    "pattern": "C",
    "size": [4.0, 4.0],
    "radius": 0.25,
    "radius_ratio": 1.5,
    "brick": [4.0, 4.0],
    "edge_radius": 0.25,
}
VISCOUS = {"type": "viscous"}
PUSHED = {"wave": {"pulse": {"type": "cosine", "amplitude": 1.0, "period": 0.1}}}
SIDES = ("left", "right", "bottom", "top")


def wrapped(*sides: str) -> dict[str, dict[str, str]]:
    """Some sides periodic."""
    return {side: {"type": "periodic"} for side in sides}


@pytest.mark.parametrize(
    ("changes", "free"),
    [
        ({"boundary": {side: VISCOUS for side in SIDES}}, True),
        ({"boundary": {"left": {"type": "viscous_input", "wave_p": "pulse", "half_mass": True}}, **PUSHED}, True),
        ({"boundary": {"left": VISCOUS, "bottom": {"type": "fixed"}}}, False),
        ({"boundary": {"left": {"type": "velocity", "wave_p": "pulse"}}, **PUSHED}, False),
        ({"boundary": {"right": {"type": "viscoelastic", "distance": 40.0}}}, False),
        ({"boundary": wrapped("left", "right")}, False),
        ({"boundary": wrapped("bottom", "top")}, False),
        ({"boundary": {"left": {"type": "free_field"}}}, False),
        ({"motion.held": ["y"]}, False),
        ({"motion.held": ["rotation"]}, False),
    ],
)
def test_only_what_nothing_but_dashpots_holds_turns_freely(bar, changes: dict, free: bool) -> None:
    assert turns_freely(build(bar({**BODY, "packing.size": [4.0, 2.0], **changes}))) is free


@pytest.fixture
def body(bar) -> DiskScene:
    """Random disks, those on the left half cells: masses differ, and their centre is not that of the places."""
    return build(bar({**BODY, "packing": RANDOM, "boundary": {"left": {**VISCOUS, "half_mass": True}}}))


def datum_of(body: DiskScene) -> np.ndarray:
    """Displacements (3, n) of a body that has settled."""
    return 0.1 * np.random.default_rng(1).uniform(-1.0, 1.0, (3, body.count))


def arms(body: DiskScene, datum: np.ndarray) -> np.ndarray:
    """Places (2, n) at the datum from the centre of mass."""
    places = body.positions.T + datum[:2]
    return places - (places * body.mass).sum(axis=1, keepdims=True) / body.mass.sum()


def tangent(body: DiskScene, datum: np.ndarray, angle: float) -> np.ndarray:
    """Displacements (3, n) of a turn as the law of small displacements has it."""
    x, y = arms(body, datum)
    return angle * np.stack([-y, x, np.ones(body.count)])


@pytest.mark.parametrize("angle", [0.01, -0.4])
def test_a_turn_along_the_tangent_becomes_one_that_keeps_all_distances(body: DiskScene, angle: float) -> None:
    datum = datum_of(body)
    drift = np.array([[3.0], [-2.0], [0.0]])
    moved = datum + tangent(body, datum, angle) + drift
    spun = moved[2].copy()
    moved, _ = turned_as_a_whole(body, moved, np.zeros((3, body.count)), datum)
    arm = arms(body, datum)

    # the centre of mass goes on as before; sums of 60 numbers of size 10
    np.testing.assert_allclose(moved[:2], datum[:2] + drift[:2] + (turn(angle) - np.eye(2)) @ arm, rtol=0.0, atol=1e-13)
    places = [body.positions.T + displacement[:2] for displacement in (datum, moved)]
    before, after = (np.hypot(*(p[:, None] - p[:, :, None])) for p in places)
    np.testing.assert_allclose(after, before, rtol=0.0, atol=2e-13)
    assert np.array_equal(moved[2], spun)
