"""Probable mistakes in a case of disks: loads, stages, holes, speeds, and forces at rest where bonds may break."""

from typing import Any

import numpy as np
import pytest
from scene_tables import lattice
from small_cases import GRAINS, PUSHED, around, small
from warned_cases import DENSE, GROUND, SLOW, warned

from dembound.disks.scene import DiskScene, build
from dembound.disks.stepping.side_watch import lasting_force_warnings, reach_warnings
from dembound.kinds.disks.facts import creep, intact_facts, intact_warnings
from dembound.kinds.disks.groups import group_warnings
from dembound.kinds.disks.micro_macro import materials_of
from dembound.kinds.disks.side_warnings import load_warnings
from dembound.kinds.disks.warnings import _s_speed_of_the_packing

ALL = ("left", "right", "bottom", "top")
PERIODIC = {f"boundary.{side}": {"type": "periodic"} for side in ALL}
HOLE = {"name": "tunnel", "type": "circle", "centre": [5.0, 5.0], "radius": 1.5, "stage": "after"}
FREELY = {**SLOW, "motion.held": []}


LOCKED_IN = {**DENSE, "material.law": "linearpbond", "material.locked_in": 2e6, "static": {}}
RELAXED = "material.locked_in: is 2 MPa; where it relaxes, the largest bond stress is about 3."
BRITTLE = {**FREELY, "material.law": "linearpbond", "material.pb_ten": 1e6, "material.pb_coh": 2e6}
TENSION = "static.stress: has a tension of 1.1 MPa, above material.pb_ten = 1 MPa; bonds break in the static stage"
PRESSED = {**FREELY, "packing.size": [10.0, 10.0], "static": {"stress": [-1e6, -1e6, 0.0]}, "hole": [HOLE]}
TAP = {"name": "tap", "acceleration": [1.0, 0.0], "wave": "pulse"}
LOADED = {**SLOW, "load": [{"name": "weight", "acceleration": [10.0, 0.0]}, TAP]}
RING = around("periodic", "left", "right") | {"top": {"type": "velocity", "wave_s": "pulse"}}
CUT = {**FREELY, "packing.size": [10.0, 10.0], "boundary": RING}


@pytest.mark.parametrize(
    ("changes", "part", "said"),
    [
        # more than half of 2 MPa, the bonds' share as contacts without friction bear no shear, times 3.5
        (LOCKED_IN | {"material.pb_ten": 3.4e6}, "", RELAXED),
        (LOCKED_IN | {"material.pb_ten": 4.5e6}, "", None),
        (LOCKED_IN | {"material.pb_ten": 3.4e6, "wave": {}, **PERIODIC}, "", None),  # nothing is cut
        (BRITTLE | {"static": {"stress": [0.9e6, 0.9e6, 0.0]}}, "tension of", None),
        (BRITTLE | {"static": {"stress": [0.9e6, -0.7e6, 0.6e6]}}, "tension of", TENSION),  # 0.1 + (0.8² + 0.6²)^½
        (BRITTLE | {"static": {"stress": [0.9e6, -0.7e6, 0.3e6]}}, "tension of", None),  # 0.95
        (PRESSED, "only forces hold", "54 %"),  # 6·(3/10)²
        (PRESSED | {"boundary": around("outside", "left", "right")}, "only forces hold", None),
        (PRESSED | {"hole": [HOLE | {"radius": 0.4}]}, "only forces hold", None),
        (LOADED, "is steady", "load.weight: is steady,"),
        (LOADED | {"static": {"boundary": around("fixed", "left")}}, "is steady", None),
        # a circle of 1.5 m touches the side at x = 0 with its middle at 1.5 m
        (CUT | {"hole": [HOLE | {"centre": [0.0, 5.0], "stage": "before"}]}, "hole", "is cut by the periodic left"),
        (CUT | {"hole": [HOLE | {"centre": [1.5, 5.0], "stage": "before"}]}, "hole", None),
    ],
)
def test_a_probable_mistake_has_its_line(bar, changes: dict, part: str, said: str | None) -> None:
    found = [line for line in warned(bar(changes)) if part in line]
    assert [said is not None and said in line for line in found] == [True] * (said is not None)


@pytest.mark.parametrize(("share", "said"), [(0.02, False), (0.04, True)])
def test_a_stress_at_rest_that_strains_beyond_solids_is_warned_of(bar, share: float, said: bool) -> None:
    stiffness = float(np.diag(build(bar(FREELY)).ground.material_tensor)[:2].min())
    for stress in ([-1.0, -0.5, 0.0], [0.0, 0.0, 1.0], [-0.5, -0.5, 0.5]):  # of each the largest principal one is 1
        static = {"stress": [share * stiffness * each for each in stress]}
        found = [line for line in warned(bar({**FREELY, "static": static})) if "static.stress: its largest" in line]
        assert [f"{100.0 * share:.2g} % of the stiffness" in line for line in found] == [True] * said


def test_a_packing_that_was_given_its_speed_or_no_speed_is_not_warned_of(bar) -> None:
    # contacts without friction carry no shear, which slows P waves of a random packing
    soft = {**DENSE, "motion.held": [], "material.contact_share": 0.9}
    (found,) = warned(bar(soft))
    assert found.startswith("material.p_wave_speed: is 1000 m/s of the square lattice; P waves along x run at ")
    assert warned(bar({**soft, "material.match": "assembly"})) == []
    moduli = {"density": 2500.0, "emod": 2.25e9, "pb_emod": 0.25e9}
    assert warned(bar({**DENSE, "motion.held": [], "material": moduli})) == []


@pytest.mark.parametrize(("share", "reported"), [(0.85, True), (1.0, False)])
def test_a_speed_of_s_waves_that_the_packing_lacks_is_warned_of(share: float, reported: bool) -> None:
    """A square lattice of 1000 m/s for P waves with springs of a quarter in shear has S waves of 500 m/s."""
    material = {"density": 2500.0, "emod": 1.25e9, "pb_emod": 1.25e9, "s_wave_speed": share * 500.0}
    scene = build(small({"packing": lattice(20.0, 10.0, 1.0), "material": material, "run": {"duration": 0.01}}))
    said = "material.s_wave_speed: is 425 m/s, S waves along x run at 500 m/s in this pa"
    lines = [line for own in materials_of(scene) for line in _s_speed_of_the_packing(scene, own)]
    assert [line[: len(said)] for line in lines] == reported * [said]


def test_holes_that_remove_nothing_are_warned_of(bar) -> None:
    """Between four disks of 0.5 m, or within an earlier hole; not with the centre of one at its upper right."""
    corners = {"between": [1.8, 0.3, 2.2, 0.7], "one": [5.8, 0.3, 6.26, 0.76]}
    corners |= {"wide": [7.3, 0.0, 9.7, 0.4], "narrow": [7.8, 0.0, 9.2, 0.4]}
    holes = [{"name": name, "type": "rectangle", "corners": each} for name, each in corners.items()]
    none = "hole[1, between]: no particle is centred in it, so it removes none"
    within = "hole[4, narrow]: lies within hole.wide, so it removes no more particles"
    for later, said in (("narrow", [none, within]), ("wide", [none])):
        each = [{**hole, "stage": "after" if hole["name"] == later else "before"} for hole in holes]
        static = {"static": {"stress": [-1e5, -1e5, 0.0]}}
        lines = warned(bar({"packing.size": [10.0, 1.0], "hole": each, **static}))
        assert [line for line in lines if line.startswith("hole")] == said


@pytest.mark.parametrize(
    ("side", "place", "said"),
    [
        ("viscous", {"position": [0.5, 5.5]}, "acts on disks of boundary.left alone, whose dashpots take a part of it"),
        ("free", {"position": [0.5, 5.5]}, None),
        ("fixed", {"region": [0.0, 0.0, 4.0, 10.0]}, "has 25 % of its force along x"),
        ("fixed", {"region": [0.0, 0.0, 20.0, 10.0]}, None),
    ],
)
def test_a_load_on_disks_of_a_side_is_warned_of(side: str, place: dict, said: str | None) -> None:
    blow = {"name": "blow", "force": [3e5, -1e5], "wave": "blow", **place}
    found = list(load_warnings(build(small(GROUND | {"boundary": around(side, "left"), "load": [blow]}))))
    assert len(found) == (said is not None)
    assert said is None or said in found[0]


@pytest.mark.parametrize(
    ("pull", "side", "free"), [(9.81, "left", "right"), (-9.81, "left", ""), (-9.81, "right", "left")]
)
def test_a_body_that_hangs_while_it_settles_is_warned_of(pull: float, side: str, free: str) -> None:
    static = {"ratio": 1e-6, "boundary": around("fixed", side)}
    tables = {"load": [{"name": "weight", "acceleration": [pull, 0.0]}], "static": static, "wave": {}}
    found = [line for line in load_warnings(build(small(GROUND | tables))) if line.startswith("static:")]
    said = f"static: the steady loads pull the body along x towards its {free}, which is free"
    assert [line[: len(said)] for line in found] == [said] * bool(free)


WEIGHT = {"name": "weight", "acceleration": [0.0, -9.81]}
BOTTOM = {"type": "viscous_input", "wave_s": "pulse"}
VISCOUS, FREE_FIELD = (around(kind, "left", "right") for kind in ("viscous", "free_field"))
HELD = around("roller", "left", "right") | around("fixed", "bottom")
PUSH = {"name": "push", "force": [3e4, -4e4], "region": [2.0, 2.0, 6.0, 4.0], "wave": "on"}
WAVES = GRAINS["wave"] | {"on": {"type": "constant", "amplitude": 0.5, "rise": 0.01}}
TOUGH = PUSHED["material"] | {"law": "linearpbond"}


def breaking(boundary: dict[str, Any], **tables: object) -> DiskScene:
    ground = {"material": TOUGH | {"pb_ten": 1e6}, "load": [WEIGHT], "static": {"boundary": HELD}, "boundary": boundary}
    return build(small(GRAINS | ground | tables))


def test_zones_and_springs_are_among_the_facts() -> None:
    body = breaking(FREE_FIELD | {"bottom": BOTTOM})
    facts = dict(intact_facts(body))
    inside = len(set().union(*(set(nodes.tolist()) for nodes in body.intact_zones.values())))
    assert facts["bonds kept"] == (
        f"2 disks from left and right and bottom: {inside:,} of {body.disk_count - body.column_count:,} disks have "
        "bonds that do not break; all of the free-field column"
    )
    # a tenth of the weight over α_n G ΣD/L of the bottom
    weight = -float(body.steady_load[1, body.column_count :].sum())
    sag = 1e6 * 0.1 * weight / float(body.bearing.stiffness[:, 1].sum())
    assert facts["side springs"].startswith(
        "α_n 1 and α_s 0.5 at left and right and bottom, on the motion relative to the free-field column; "
    )
    assert f"sags by {sag:.3g} µm" in facts["side springs"]
    assert "they bear no net force" in dict(intact_facts(breaking(VISCOUS | {"bottom": BOTTOM})))["side springs"]
    assert dict(intact_facts(breaking(VISCOUS | {"bottom": BOTTOM | {"intact": 0}}))).keys() == {"bonds kept"}


def test_sides_without_a_zone_are_warned_of_where_forces_at_rest_act() -> None:
    ground = around({"type": "free_field", "bearing": False}, "left", "right") | {"bottom": BOTTOM | {"intact": 0}}
    said, drifts = intact_warnings(breaking(ground))
    assert drifts.startswith("boundary: dashpots alone bear this ground")  # as there are no springs either
    assert said.startswith("boundary.bottom.intact: is 0, but forces of the static stage go on acting there")
    assert list(intact_warnings(breaking(ground, material=TOUGH))) == []


def test_friction_of_a_group_at_a_free_field_of_loose_ground_is_warned_of() -> None:
    loose = {"material": TOUGH | {"contact_share": 1.0, "fric": 0.5}, "load": [WEIGHT]}

    def said(region: list[float], **own: float) -> list[str]:
        group = {"name": "slick", "region": region, **own}
        return list(group_warnings(breaking(FREE_FIELD | {"bottom": BOTTOM}, **loose, group=[group])))

    (line,) = said([0.0, 0.0, 2.0, 4.0], fric=0.2)
    assert line.startswith("group.slick.fric: reaches boundary.left, beyond which the free-field column slides by")
    assert said([2.0, 0.0, 4.0, 4.0], fric=0.2) == said([0.0, 0.0, 2.0, 4.0], fric=0.5) == []


def test_a_load_that_lasts_creeps_on_dashpots_and_the_weight_that_leaves_too() -> None:
    body = breaking(VISCOUS | {"bottom": BOTTOM}, load=[WEIGHT, PUSH], wave=WAVES)
    weight, *lasting = intact_warnings(body)
    assert weight.startswith("boundary: dashpots alone bear this ground")
    for (axis, name, force), said in zip(((0, "x", 1.5e4), (1, "y", 2e4)), lasting, strict=True):
        rate = 1.0 / body.supports.damping[body.supports.component == axis].sum()
        assert creep(body, axis) == pytest.approx(rate)
        assert said.startswith(f"load.push: lasts until the end of the run, {force / 1e3:g} kN along {name}")
        assert f"the body creeps at {1e6 * force * rate:.4g} µm/s" in said


FOUND = {
    "work": {"size": 0.06, "side": "left", "time": 0.5},
    "turn": {"size": 0.2, "side": "right", "time": 0.25},
    "ended": 0.2,
    "reached": {"left": {"bonds": 1200, "time": 0.125}, "free-field column": {"bonds": 1, "time": 0.5}},
}


def test_forces_at_rest_that_became_a_motor_and_sides_that_cracks_would_have_reached_are_warned_of() -> None:
    work, turn, ended = lasting_force_warnings(FOUND)
    assert work.startswith("boundary.left: until t = 0.5 s forces at rest have done 6 % of the energy")
    assert turn.startswith(
        "boundary.right: a disk on which forces at rest act has turned by 0.2 rad by t = 0.25 s: this"
    )
    assert ended.startswith("static: disks that bore 20 % of the forces at rest have broken off")
    quiet = {"work": {**FOUND["work"], "size": 0.05}, "turn": {**FOUND["turn"], "size": 0.01}, "ended": 0.1}
    for found in (quiet, {"work": None, "turn": None, "ended": 0.0}, None):
        assert list(lasting_force_warnings(found)) == []
    (said,) = reach_warnings(FOUND)
    assert said.startswith(
        "boundary.left: cracks would have reached the left side (at least 1,200 bonds, from t = 0.125 s), "
        "the free-field column (at least 1 bond, from t = 0.5 s), whose bonds do not break"
    )
    assert list(reach_warnings(None)) == list(reach_warnings({"reached": {}})) == []
