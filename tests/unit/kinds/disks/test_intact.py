"""Facts and warnings about forces at rest where bonds may break."""

from typing import Any

import pytest
from small_cases import GRAINS, small

from dembound.disks.scene import DiskScene, build
from dembound.disks.stepping.side_watch import lasting_force_warnings, reach_warnings
from dembound.kinds.disks.facts import creep, intact_facts, intact_warnings

WEIGHT = {"name": "weight", "acceleration": [0.0, -9.81]}
BOTTOM = {"type": "viscous_input", "wave_s": "pulse"}
VISCOUS = {side: {"type": "viscous"} for side in ("left", "right")}
FREE_FIELD = {side: {"type": "free_field"} for side in ("left", "right")}
HELD = {"bottom": {"type": "fixed"}, "left": {"type": "roller"}, "right": {"type": "roller"}}
PUSH = {"name": "push", "force": [3e4, -4e4], "region": [2.0, 2.0, 6.0, 4.0], "wave": "on"}
WAVES = GRAINS["wave"] | {"on": {"type": "constant", "amplitude": 0.5, "rise": 0.01}}


def scene(boundary: dict[str, Any], **tables: object) -> DiskScene:
    material = GRAINS["material"] | {"law": "linearpbond", "pb_ten": 1e6}
    ground = {"material": material, "load": [WEIGHT], "static": {"boundary": HELD}, "boundary": boundary}
    return build(small(GRAINS | ground | tables))  # type: ignore[arg-type]


def test_zones_and_springs_are_among_the_facts() -> None:
    body = scene(FREE_FIELD | {"bottom": BOTTOM})
    facts = dict(intact_facts(body))
    inside = len(set().union(*(set(nodes.tolist()) for nodes in body.intact_zones.values())))
    own = body.disk_count - body.column_count
    assert facts["bonds kept"] == (
        f"2 disks from left and right and bottom: {inside:,} of {own:,} disks have bonds that do not break; all of the "
        "free-field column"
    )
    # a tenth of the weight over α_n G ΣD/L of the bottom
    weight = -float(body.steady_load[1, body.column_count :].sum())
    sag = 1e6 * 0.1 * weight / float(body.bearing.stiffness[:, 1].sum())
    assert facts["bottom springs"].startswith("α_n 1 and α_s 0.5, on the motion relative to the free-field column; ")
    assert f"sags by {sag:.3g} µm" in facts["bottom springs"]
    assert "they bear no net force" in dict(intact_facts(scene(VISCOUS | {"bottom": BOTTOM})))["bottom springs"]
    assert dict(intact_facts(scene(VISCOUS | {"bottom": BOTTOM | {"intact": 0}}))).keys() == {"bonds kept"}


def test_sides_without_a_zone_are_warned_of_where_forces_at_rest_act() -> None:
    ground = FREE_FIELD | {"bottom": BOTTOM | {"intact": 0}}
    said, drifts = intact_warnings(scene(ground))
    assert drifts.startswith("boundary: dashpots alone bear this ground")  # as there are no springs either
    assert said.startswith("boundary.bottom.intact: is 0, but forces of the static stage go on acting there")
    tough = GRAINS["material"] | {"law": "linearpbond"}
    assert list(intact_warnings(scene(ground, material=tough))) == []


def test_a_load_that_lasts_creeps_on_dashpots_and_the_weight_that_leaves_too() -> None:
    body = scene(VISCOUS | {"bottom": BOTTOM}, load=[WEIGHT, PUSH], wave=WAVES)
    rates = [creep(body, axis) for axis in (0, 1)]
    supports = body.supports
    for axis, rate in enumerate(rates):
        assert rate == pytest.approx(1.0 / supports.damping[supports.component == axis].sum())
    weight, *lasting = intact_warnings(body)
    assert weight.startswith("boundary: dashpots alone bear this ground")
    for axis, said in enumerate(lasting):
        force = (1.5e4, 2e4)[axis]
        assert said.startswith(f"load.push: lasts until the end of the run, {force / 1e3:g} kN along {'xy'[axis]}")
        assert f"the body creeps at {1e6 * force * rates[axis]:.4g} µm/s" in said
    assert len(lasting) == 2


FOUND = {
    "work": {"size": 0.06, "side": "left", "time": 0.5},
    "turn": {"size": 0.2, "side": "right", "time": 0.25},
    "ended": 0.2,
    "reached": {"left": {"bonds": 1200, "time": 0.125}, "free-field column": {"bonds": 1, "time": 0.5}},
}


def test_forces_at_rest_that_became_a_motor_are_warned_of() -> None:
    work, turn, ended = lasting_force_warnings(FOUND)
    assert work.startswith("boundary.left: until t = 0.5 s forces at rest have done 6 % of the energy")
    assert turn.startswith("boundary.right: a disk on which forces at rest act has turned by 0.2 rad by t = 0.25 s")
    assert ended.startswith("static: disks that bore 20 % of the forces at rest have broken off")
    quiet = {"work": {**FOUND["work"], "size": 0.05}, "turn": {**FOUND["turn"], "size": 0.15}, "ended": 0.1}
    assert list(lasting_force_warnings(quiet)) == []
    assert list(lasting_force_warnings({"work": None, "turn": None, "ended": 0.0})) == []
    assert list(lasting_force_warnings(None)) == []


def test_sides_that_cracks_would_have_reached_are_named_in_one_line() -> None:
    (said,) = reach_warnings(FOUND)
    assert said.startswith(
        "boundary.left: cracks would have reached the left side (at least 1,200 bonds, from t = 0.125 s), "
        "the free-field column (at least 1 bond, from t = 0.5 s), whose bonds do not break"
    )
    assert list(reach_warnings(None)) == list(reach_warnings({"reached": {}})) == []
