"""The box of disks that check proposes, and the time of a step that it is compared by."""

import tomllib
from typing import Any

import pytest

from dembound.accuracy.of_disks.boxes import box_facts
from dembound.api import case
from dembound.casefile.disks import DiskCase
from dembound.disks.scene import build

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
    made = case("tunnel", **(tables | changes))
    assert isinstance(made, DiskCase)
    return made


def test_the_box_holds_the_hole_in_its_middle_and_is_cheaper() -> None:
    words = dict(box_facts(build(tunnel())))["smaller box"]
    width, height = (float(part.split(" m")[0]) for part in words.split(" × ")[:2])
    left, bottom = (float(part) for part in words[words.index("(") + 1 : words.index(")")].split(", "))

    assert 16.0 < width < 0.5 * SIZE[0]
    assert (left + 0.5 * width, bottom + 0.5 * height) == (60.0, 50.0)
    assert int(words.split("%")[0].split()[-1]) < 80


def test_the_proposed_box_has_the_disks_and_nodes_it_says() -> None:
    """Its tables are those of a case in which nothing else has changed."""
    facts = dict(box_facts(build(tunnel())))
    words, tables = facts["smaller box"], tomllib.loads(facts["its tables"])
    assert tables["boundary"].pop("bottom") == {"type": "outside", "wave_s": "pulse"}
    assert tables["boundary"] == {side: {"type": "outside"} for side in ("left", "right", "top")}
    packing = {"pattern": "A", "radius": 0.5} | tables.pop("packing")
    tables["boundary"]["bottom"] = {"type": "outside", "wave_s": "pulse"}
    boxed = build(tunnel(packing=packing, **tables))
    assert boxed.outside is not None
    assert f": {boxed.disk_count:,} disks and {boxed.outside.count:,} nodes instead of " in words
    assert dict(box_facts(boxed)) == {}


def test_a_load_near_the_surface_has_a_box_up_to_it() -> None:
    load = [{"name": "blow", "position": [60.0, 98.0], "force": [0.0, -1.0], "wave": "pulse"}]
    sides = dict.fromkeys(("left", "right", "bottom"), VISCOUS)
    words = dict(box_facts(build(tunnel(hole=[], load=load, boundary=sides))))["smaller box"]
    height = float(words.split(" × ")[1].split(" m")[0])
    bottom = float(words[words.index("(") + 1 : words.index(")")].split(", ")[1])

    assert bottom + height == SIZE[1]


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
    assert dict(box_facts(build(tunnel(**changes)))) == {}


SLOPE = {"name": "slope", "type": "polygon", "points": [[60.0, 101.0], [75.0, 80.0], [121.0, 80.0], [121.0, 101.0]]}
BLOW = {"name": "blow", "force": [0.0, 1.0], "position": [50.5, 99.5], "wave": "pulse"}


def test_a_box_round_a_slope_ends_on_its_floor() -> None:
    """Beyond it the ground is as high as the floor, and has no nodes above."""
    changes = {"boundary": {side: VISCOUS for side in ("left", "right", "bottom")}, "hole": [SLOPE], "load": [BLOW]}
    facts = dict(box_facts(build(tunnel(**changes))))
    tables = tomllib.loads(facts["its tables"])
    assert tables["boundary"] == {side: {"type": "outside"} for side in ("left", "right", "bottom")}
    packing = {"pattern": "A", "radius": 0.5} | tables.pop("packing")
    boxed = build(tunnel(**(changes | {"packing": packing} | tables)))
    assert f": {boxed.disk_count:,} disks and {boxed.outside.count:,} nodes instead of " in facts["smaller box"]
    assert boxed.outside.levels["right"].surface == pytest.approx(80.0, abs=1e-9)
    assert 79.0 <= boxed.outside.box[2] < 115.0


@pytest.mark.parametrize(
    "changes",
    [
        {"hole": [SLOPE]},  # under a wave from below
        {"hole": [SLOPE | {"points": [[60.0, 101.0], [121.0, 70.0], [121.0, 101.0]]}], "load": [BLOW]},
    ],
)
def test_without_a_level_floor_or_under_waves_there_is_no_box(changes: dict[str, Any]) -> None:
    if "load" in changes:
        changes = {"boundary": {side: VISCOUS for side in ("left", "right", "bottom")}} | changes
    assert dict(box_facts(build(tunnel(**changes)))) == {}
