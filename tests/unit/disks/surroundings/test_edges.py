"""Lengths of the sides of a scene, also with particles taken away."""

import numpy as np
import pytest

from dembound.boundaries.support import Edge
from dembound.disks.scene import build
from dembound.disks.surroundings.edges import edge_without

DIAMETERS = np.array([0.4, 0.6, 0.5, 0.8, 0.7])
EDGE = Edge("right", np.array([2, 3, 5, 7, 11]), np.column_stack([np.full(5, 9.0), np.arange(5.0)]), DIAMETERS, 3.6)


def test_what_is_left_of_a_side_stands_for_its_own_share_of_the_length() -> None:
    left = edge_without(EDGE, np.array([1, 2, 4, 5, 9, 11]))

    # by diameters: 0.4 + 0.5 + 0.7 of 3.0 m, whatever the number of disks; so every one stands for as much as before,
    # 1.2 of its diameter
    assert left.length == pytest.approx(1.6 * 1.2, rel=1e-14)
    assert left.nodes.tolist() == [1, 3, 5]  # where 2, 5 and 11 stand among what is kept
    assert left.diameters.tolist() == [0.4, 0.5, 0.7]
    assert left.positions[:, 1].tolist() == [0.0, 2.0, 4.0]
    assert left.side == "right"


@pytest.mark.parametrize("bottom", ["free", "periodic"])
def test_a_side_with_a_frame_is_as_long_as_its_disks_together(bar, bottom: str) -> None:
    packing = {"pattern": "C", "size": [4.0, 8.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [4.0, 4.0]}
    sides = {"left": {"type": "free"}, **{side: {"type": bottom} for side in ("bottom", "top")}}
    framed = {"packing": packing | {"edge_radius": 0.26}, "boundary": sides, "wave": {}, "monitor": []}
    edges = build(bar({**framed, "motion.held": []})).edges

    # eight equal disks to a brick of 4 m, each touching the next; where the frame is closed one more at the far end
    more = 0.0 if bottom == "periodic" else 0.5
    lengths = {"left": 8.0 + more, "right": 8.0 + more} | ({} if more == 0.0 else {"bottom": 4.5, "top": 4.5})
    assert {side: edge.length for side, edge in edges.items()} == pytest.approx(lengths, rel=1e-12)
    assert [edge.diameter_sum_ratio for edge in edges.values()] == pytest.approx([1.0] * len(edges), rel=1e-12)
