"""A scene of a box of disks in the ground: its column, its continua, and what is refused."""

import pytest
from small_cases import GROUND, Tables, small

from dembound.casefile import Case
from dembound.disks.scene import DiskScene, build
from dembound.disks.surroundings.mesh import box_of
from dembound.errors import CaseError

BOX: Tables = GROUND | {
    "ground": {"size": [40.0, 30.0]},
    "packing": {
        "pattern": "B",
        "size": [12.0, 12.0],
        "origin": [14.0, 6.0],
        "brick": [6.0, 6.0],
        "radius": 0.5,
        "radius_ratio": 1.5,
    },
    "boundary": {side: {"type": "outside"} for side in ("left", "right", "bottom", "top")},
    "outside": {"element": 6.0},
}
WAVE = {"boundary.bottom.wave_s": "w"}
WEIGHT = {"load": [{"name": "weight", "acceleration": [0.0, -10.0]}], "static.boundary.bottom": {"type": "fixed"}}


def case(**changes) -> Case:
    return small(BOX, changes=changes)


def scene(*changes: dict) -> DiskScene:
    return build(case(**{key: value for each in changes for key, value in each.items()}))


@pytest.fixture(scope="module")
def shaken() -> DiskScene:
    return scene(WAVE)


def test_the_continuum_reaches_from_the_box_to_the_surface(shaken: DiskScene) -> None:
    mesh = shaken.outside.body.mesh
    offset = shaken.ground.brick.mass_offset
    assert box_of(shaken.assembly.part(slice(shaken.seam.count, shaken.disk_count))) == (14.0, 6.0, 26.0, 18.0)
    assert shaken.outside.box == (14.0, 6.0, 26.0, 18.0)
    surface = 30.0 + offset[1]
    assert mesh.positions[:, 1].max() == pytest.approx(surface, abs=0.5)  # less the packing's skin
    assert mesh.positions[:, 1].min() == pytest.approx(6.0 + offset[1] - 4 * 6.0, abs=1e-9)
    assert (shaken.foot.box[1], shaken.foot.sides) == (0.0, ("bottom",))


def test_a_hole_that_reaches_a_side_is_refused() -> None:
    hole = {"name": "shaft", "type": "circle", "centre": [20.0, 17.0], "radius": 2.0, "stage": "after"}
    with pytest.raises(CaseError, match=r"^hole\[1, shaft\]: reaches boundary.top, where the continuum has no hole"):
        scene({"hole": [hole]}, WEIGHT)


def test_between_box_and_surface_there_is_room_for_an_element() -> None:
    lattice = {"packing": {"pattern": "A", "radius": 0.5, "size": [12.0, 12.0], "origin": [14.0, 14.0]}}
    with pytest.raises(CaseError) as caught:
        scene(lattice)
    (line,) = caught.value.problems
    assert line == (
        "packing.origin: the disks end 4 m below the surface of the ground; they must reach it, or end at least 5 m "
        "below, the smallest useful element"
    )
    up_to_it = {side: {"type": "outside"} for side in ("left", "right", "bottom")}
    lattice["packing"]["origin"] = [14.0, 18.0]
    assert scene(lattice, {"boundary": up_to_it}).outside.count > 0
