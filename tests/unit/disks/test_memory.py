"""Memory is counted from the shapes of arrays, and numbers of disks and contacts are known before a scene is built."""

import pytest
from disk_systems import LAMB

from dembound.disks.memory import SceneSizes, expected_bytes
from dembound.disks.scene import build
from dembound.errors import CaseError
from dembound.machine import Memory
from dembound.motion import memory
from dembound.packings import random_brick

RANDOM = {"pattern": "B", "bricks": [20, 4], "radius": 0.25, "radius_ratio": 1.5, "brick": [4.0, 4.0]}
FRAMED = {**RANDOM, "pattern": "C", "edge_radius": 0.25}
PATTERNS = {
    "A": {"pattern": "A", "size": [40.0, 10.0], "radius": 0.25},
    "B": RANDOM,
    "C": FRAMED,
    "two": {**RANDOM, "bricks": [2, 1], "brick": [8.0, 8.0]},
}
FREE = {"monitor": [], "wave": {}, "boundary": {}}


@pytest.fixture(params=PATTERNS)
def scene(bar, request):
    return build(bar({**FREE, "packing": PATTERNS[request.param]}))


def test_sizes_are_known_before_the_scene_is_built(scene) -> None:
    expected, sizes = SceneSizes.expected(scene.case), scene.sizes

    # bricks of 80 disks have a few more or less than the mean of large ones, and regular rows have fewer contacts
    assert expected.disks == pytest.approx(sizes.disks, rel=0.15)
    assert expected.slots / expected.disks == pytest.approx(sizes.slots / sizes.disks, rel=0.15)
    assert expected.contacts / expected.disks == pytest.approx(sizes.contacts / sizes.disks, rel=0.17)
    assert expected.in_rows == sizes.in_rows


def test_a_scene_too_large_is_refused_before_its_brick_is_packed(bar, monkeypatch) -> None:
    monkeypatch.setattr(memory, "memory_here", lambda: Memory(8e9, 6e9))
    monkeypatch.setattr(random_brick, "load_or_pack", None)  # a call would raise a TypeError
    case = bar({**FREE, "packing": {**RANDOM, "bricks": [1000, 1000]}})

    with pytest.raises(CaseError, match=r"^packing.bricks: 6.84e\+07 disks need about [\d.]+ GB of memory, this "):
        build(case)


def test_the_continuum_is_known_before_the_scene_is_built(bar) -> None:
    case = bar(LAMB | {"outside": {"element": 5.0, "margin": 20}})
    scene = build(case)
    expected, sizes = SceneSizes.expected(case), scene.sizes

    assert expected.grid == sizes.grid
    assert sizes.grid.nodes == scene.outside.count == scene.count - sizes.disks
    assert sizes.moving == pytest.approx(scene.layout.count, rel=0.01)
    assert sizes.ties == 80
    assert expected_bytes(case) == pytest.approx(scene.largest_memory, rel=0.02)
