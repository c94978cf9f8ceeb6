"""Forces on sides: a body cut out of a packing under stress is at rest under them, whatever its pattern and sides."""

import numpy as np
import pytest
from disk_systems import BODY, TWO_BRICKS

from dembound.disks.rest.static_scene import Tractions
from dembound.disks.scene import build
from dembound.disks.side_forces import side_forces
from dembound.motion.sides import _bearers

HALF = {"boundary": {side: {"type": "viscous", "half_mass": True} for side in ("bottom", "right")}}
PATTERNS = {
    "A": {"packing.size": [6.0, 4.0]},
    "half cells": {"packing.size": [6.0, 4.0], **HALF},
    "B": {"packing": TWO_BRICKS},
    "C": {"packing": TWO_BRICKS | {"pattern": "C", "edge_radius": 0.25}},
    "held rotation": {"packing": TWO_BRICKS, "motion.held": ["rotation"]},
}
STRESSES = [(-3e6, 0.0, 0.0), (0.0, 2e6, 0.0), (0.0, 0.0, 1e6)]


ALL = tuple(zip(PATTERNS, [*STRESSES, STRESSES[2], STRESSES[0]], strict=True))
"""Each pattern under a stress, each stress twice or once."""


@pytest.mark.parametrize(("pattern", "stress"), [*ALL, ("B", STRESSES[0])])
def test_an_elastic_body_rests_where_its_packing_does(bar, pattern: str, stress: tuple) -> None:
    """All displacements are those of the endless packing: a mean gradient and the corrector of each disk."""
    scene = build(bar({**BODY, **PATTERNS[pattern], "material.fric": 0.5}))
    continuum = scene.ground.continuum
    asked = np.array([stress[0], stress[1], stress[2], stress[2]])
    gradient = np.linalg.lstsq(continuum.tensor, asked, rcond=1e-9)[0]
    u = np.einsum("cng,g->cn", continuum.corrector, gradient)[:, scene.assembly.brick_particle]
    x, y = scene.positions.T
    xx, yy, xy, yx = gradient
    u[:2] += np.stack([xx * x + xy * y, yx * x + yy * y])
    force = scene.system(1e-5).forces.elastic(u)
    for each in side_forces(scene).values():
        force[:, each.node] += each.under(np.array(stress))
    held = list(scene.ground.held)
    force[held] = 0.0
    # the solve for correctors, of some hundred unknowns, and k·u of displacements of strain × 8 m
    assert np.abs(force).max() < 1e-9 * 3e6


@pytest.mark.parametrize(("pattern", "stress"), [*ALL[:4], ("B", STRESSES[1])])
def test_a_side_is_recorded_with_the_stress_times_its_length(bar, pattern: str, stress: tuple) -> None:
    """To rounding, also where contacts cross a corner, and all sides together with what acts on the body: nothing."""
    scene = build(bar({**BODY, **PATTERNS[pattern], "static": {"stress": stress}}))
    force, sides = Tractions(scene, stress).forces(np.zeros((3, scene.count))), list(scene.sides.values())
    xx, yy, xy = stress
    for edge, (node, share) in zip(sides, _bearers(sides, scene.forces_by_side), strict=True):
        outward = 1.0 if edge.side in ("right", "top") else -1.0
        expected = outward * edge.length * np.array([[xx, xy], [xy, yy]])[edge.axis]
        # the solve for correctors, and sums of a hundred forces
        np.testing.assert_allclose((share * force[:2, node]).sum(axis=1), expected, rtol=0.0, atol=1e-9 * 3e6 * 8.0)
