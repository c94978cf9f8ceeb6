"""The cheapest box of disks in place of a scene, and the time of a step that it is compared by."""

from typing import Any

import pytest

from dembound.accuracy.of_disks.arrangements import WORTH, BoxOfDisks, box_tables, cheapest_box, may_be_boxed
from dembound.api import case
from dembound.boundaries.edge import SIDES
from dembound.casefile.disks import DiskCase
from dembound.disks import step_cost
from dembound.disks.scene import DiskScene, build
from dembound.kinds import with_changes

SIZE = (120.0, 100.0)
VISCOUS = {"type": "viscous"}


def tunnel(**changes: Any) -> DiskCase:
    """A hole of 8 m in 120 m × 100 m of disks of 1 m under a pulse of 0.2 s from below."""
    tables: dict[str, Any] = {
        "packing": {"pattern": "A", "size": list(SIZE), "radius": 0.5},
        "material": {"density": 2500.0, "p_wave_speed": 1000.0, "fric": 0.5},
        "boundary": {
            "left": VISCOUS,
            "right": VISCOUS,
            "bottom": {"type": "viscous_input", "wave_s": "pulse", "half_mass": True},
        },
        "hole": [{"name": "tunnel", "type": "circle", "centre": [60.0, 50.0], "radius": 8.0}],
        "wave": {"pulse": {"type": "cosine", "amplitude": 0.5, "period": 0.2}},
        "run": {"duration": 0.1},
    }
    return case("tunnel", **(tables | changes))


def boxed(case: DiskCase) -> tuple[BoxOfDisks, DiskScene]:
    """The cheapest box of a case, and the scene of its tables, which differ only by the box."""
    found = cheapest_box(build(case))
    tables = box_tables(case, found.box)
    packing = {"pattern": "A", "radius": 0.5} | tables.pop("packing")
    return found, build(with_changes(case, {"packing": packing, **tables}))


def test_the_box_holds_the_hole_in_its_middle_and_is_cheaper() -> None:
    found, scene = boxed(tunnel())
    left, bottom, right, top = found.box

    assert 16.0 < right - left < 0.5 * SIZE[0]
    assert (0.5 * (left + right), 0.5 * (bottom + top)) == (60.0, 50.0)
    assert found.cost < WORTH * sum(step_cost.times_of_scene(build(tunnel())).values())
    assert {side: table.type for side, table in scene.case.boundary.items()} == dict.fromkeys(SIDES, "outside")
    assert scene.case.side("bottom").waves == {"s": "pulse"}
    assert (scene.disk_count, scene.outside.count) == (found.disks, found.nodes)
    assert cheapest_box(scene) is None  # it is one already


def test_a_load_near_the_surface_has_a_box_up_to_it() -> None:
    load = [{"name": "blow", "position": [60.0, 98.0], "force": [0.0, -1.0], "wave": "pulse"}]
    sides = dict.fromkeys(("left", "right", "bottom"), VISCOUS)
    assert boxed(tunnel(hole=[], load=load, boundary=sides))[0].box[3] == SIZE[1]


@pytest.mark.parametrize(
    "changes",
    [
        {"hole": []},
        {"boundary": {"left": VISCOUS, "right": {"type": "free"}, "bottom": VISCOUS}},
        {"boundary": {"left": {"type": "periodic"}, "right": {"type": "periodic"}, "bottom": VISCOUS}},
        {"boundary": {"left": {"type": "viscous_input", "wave_p": "pulse"}, "right": VISCOUS, "bottom": VISCOUS}},
    ],
    ids=["nothing in it", "not ground all round", "periodic", "a wave from the left"],
)
def test_there_is_no_box(changes: dict[str, Any]) -> None:
    assert not may_be_boxed(tunnel(**changes))


SLOPE = {"name": "slope", "type": "polygon", "points": [[60.0, 101.0], [75.0, 80.0], [121.0, 80.0], [121.0, 101.0]]}
BLOW = {"name": "blow", "force": [0.0, 1.0], "position": [50.5, 99.5], "wave": "pulse"}


def test_a_box_round_a_slope_ends_on_its_floor() -> None:
    """Beyond the floor the ground has its height, and no nodes above."""
    changes = {"boundary": {side: VISCOUS for side in ("left", "right", "bottom")}, "hole": [SLOPE], "load": [BLOW]}
    found, scene = boxed(tunnel(**changes))
    assert {side: table.type for side, table in scene.case.boundary.items()} == dict.fromkeys(SIDES[:3], "outside")
    assert (scene.disk_count, scene.outside.count) == (found.disks, found.nodes)
    assert scene.outside.levels["right"].surface == pytest.approx(80.0, abs=1e-9)
    assert 79.0 <= scene.outside.box[2] < 115.0
