"""Springs of a bottom on the motion relative to the ground beyond: their forces, rest, stiffness and step."""

from typing import Any

import numpy as np
import pytest
from small_cases import GRAINS, small

from dembound.disks.bearing import BearingTie
from dembound.disks.scene import DiskScene, build
from dembound.disks.sides import medium_of_side
from dembound.kernels.follower import bearing_forces

FREE_FIELD = {side: {"type": "free_field"} for side in ("left", "right")}
PERIODIC = {side: {"type": "periodic"} for side in ("left", "right")}


def scene(sides: dict[str, Any], **bearing: float) -> DiskScene:
    bottom = {"type": "viscous_input", "wave_s": "pulse", "bearing": bearing or True}
    made = build(small(GRAINS | {"boundary": sides | {"bottom": bottom}}))  # type: ignore[arg-type]
    assert made.bearing is not None
    return made


def forces(body: DiskScene, moved: np.ndarray, datum: np.ndarray | None = None) -> np.ndarray:
    """Forces (3, n) of the springs at displacements (3, n)."""
    assert body.bearing is not None
    tie = BearingTie(body.bearing, body.layout)
    tie.rest_at(np.zeros_like(moved) if datum is None else datum)
    supported = np.union1d(tie.nodes, [0, body.count - 1])
    force, found = np.zeros((len(supported), 3)), np.zeros((3, body.count))
    u = body.layout.spread(moved)
    bearing_forces(tie.bundle(supported), u, u, force)
    assert np.array_equal(force, tie.force_on(supported))
    found[:, supported] = force.T
    return found


@pytest.mark.parametrize("sides", [FREE_FIELD, PERIODIC], ids=["twins", "mean"])
def test_motion_of_the_ground_without_the_body_meets_no_force(sides) -> None:
    body = scene(sides)
    rng = np.random.default_rng(1)
    own = np.repeat(rng.uniform(-1.0, 1.0, (3, 1)), body.count, axis=1)
    if body.seam is not None:
        own = rng.uniform(-1.0, 1.0, (3, body.count))[:, body.seam.twin]
    assert np.abs(forces(body, own)).max() < 1e-15 * body.bearing.stiffness.max() * len(body.bearing.node)


@pytest.mark.parametrize("sides", [FREE_FIELD, PERIODIC], ids=["twins", "mean"])
def test_one_disk_is_pulled_back_by_its_share_of_the_shear_modulus(sides) -> None:
    body = scene(sides, alpha_n=3.0, alpha_s=0.25)
    edge, datum = body.sides["bottom"], 0.1 * np.random.default_rng(2).uniform(-1.0, 1.0, (3, body.count))
    node, moved = int(edge.nodes[5]), datum.copy()
    moved[:, node] += [0.01, 0.02, 0.3]
    found = forces(body, moved, datum)
    modulus = medium_of_side(body, "bottom").shear_modulus
    stiffness = np.outer([0.25, 3.0], modulus * edge.widths / edge.length)
    share = edge.widths / edge.widths.sum() if body.twin is None else np.zeros(len(edge.nodes))
    apart = np.outer([0.01, 0.02], (edge.nodes == node) - share[5])
    # differences of numbers of size 0.1
    np.testing.assert_allclose(found[:2, edge.nodes], -stiffness * apart, rtol=0.0, atol=1e-15 * stiffness.max())
    assert not found[2].any()
    assert not np.delete(found, edge.nodes, axis=1).any()
    if body.twin is None:  # they bear no net force
        assert np.abs(found.sum(axis=1)).max() < 1e-12 * np.abs(found).max()
