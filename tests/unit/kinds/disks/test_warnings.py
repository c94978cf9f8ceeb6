"""Probable mistakes in a case of disks: loads, stages, holes, factors and speeds."""

import numpy as np
import pytest
from small_cases import small
from warned_cases import DENSE, SLOW, warned

from dembound.disks.scene import build
from dembound.kinds.disks.micro_macro import materials_of
from dembound.kinds.disks.warnings import _s_speed_of_the_packing

PERIODIC = {f"boundary.{side}": {"type": "periodic"} for side in ("left", "right", "bottom", "top")}


HOLE = {"name": "tunnel", "type": "circle", "centre": [5.0, 5.0], "radius": 1.5, "stage": "after"}


@pytest.mark.parametrize(
    ("changes", "beyond"),
    [
        ({"material.pb_ten": 3.4e6}, True),
        ({"material.pb_ten": 4.5e6}, False),
        ({"material.pb_ten": 3.4e6, "wave": {}, **PERIODIC}, False),  # nothing is cut
    ],
)
def test_locked_in_stress_that_breaks_bonds_is_warned_of(bar, changes: dict, beyond: bool) -> None:
    locked_in = {"material.law": "linearpbond", "material.locked_in": 2e6, "static": {}}
    found = warned(bar({**DENSE, **locked_in, **changes}))

    # more than half of 2 MPa, the bonds share of the stiffness as contacts without friction bear no shear, times 3.5
    start = "material.locked_in: is 2 MPa; where it relaxes, the largest bond stress is about 3."
    assert [warning[: len(start)] for warning in found] == [start] * beyond


@pytest.mark.parametrize(
    ("stress", "tensile"),
    [
        ([0.9e6, 0.9e6, 0.0], False),
        ([0.9e6, -0.7e6, 0.6e6], True),  # 0.1 + (0.8² + 0.6²)^½
        ([0.9e6, -0.7e6, 0.3e6], False),  # 0.95
    ],
)
def test_settling_under_a_tension_above_the_strength_is_warned_of(bar, stress, tensile: bool) -> None:
    brittle = {"material.law": "linearpbond", "material.pb_ten": 1e6, "material.pb_coh": 2e6}
    found = warned(bar({**brittle, **SLOW, "motion.held": [], "static": {"stress": stress}}))
    said = "static.stress: has a tension of 1.1 MPa, above material.pb_ten = 1 MPa; bonds break in the static stage"

    assert [line for line in found if "tension of" in line] == [said] * tensile


@pytest.mark.parametrize(
    ("changes", "too_far"),
    [
        ({}, "54 %"),  # 6·(3/10)²
        ({"boundary": {"left": {"type": "outside"}, "right": {"type": "outside"}}, "motion.held": []}, None),
        ({"hole": [HOLE | {"radius": 0.4}]}, None),
    ],
)
def test_a_hole_between_sides_that_give_way_is_warned_of(bar, changes: dict, too_far: str | None) -> None:
    body = {"packing.size": [10.0, 10.0], "static": {"stress": [-1e6, -1e6, 0.0]}, "hole": [HOLE], "motion.held": []}
    found = [line for line in warned(bar({**SLOW, **body, **changes})) if "only forces hold" in line]
    assert [too_far in line for line in found] == [True] * (too_far is not None)


@pytest.mark.parametrize(("share", "said"), [(0.02, False), (0.04, True)])
def test_a_stress_at_rest_that_strains_beyond_solids_is_warned_of(bar, share: float, said: bool) -> None:
    body = {**SLOW, "motion.held": []}
    stiffness = float(np.diag(build(bar(body)).ground.material_tensor)[:2].min())
    for stress in ([-1.0, -0.5, 0.0], [0.0, 0.0, 1.0], [-0.5, -0.5, 0.5]):  # of each the largest principal one is 1
        static = {"stress": [share * stiffness * each for each in stress]}
        found = [line for line in warned(bar({**body, "static": static})) if "static.stress: its largest" in line]
        assert [f"{100.0 * share:.2g} % of the stiffness" in line for line in found] == [True] * said


@pytest.mark.parametrize("settles", [False, True])
def test_a_steady_load_without_a_static_stage_is_warned_of(bar, settles: bool) -> None:
    weight = {"name": "weight", "acceleration": [10.0, 0.0]}
    tap = {"name": "tap", "acceleration": [1.0, 0.0], "wave": "pulse"}
    static = {"static": {"boundary": {"left": {"type": "fixed"}}}} if settles else {}
    found = [line for line in warned(bar({"load": [weight, tap], **SLOW, **static})) if "load.weight" in line]
    assert [line.split(",")[0] for line in found] == ["load.weight: is steady"] * (not settles)


def test_a_packing_that_was_given_its_speed_or_no_speed_is_not_warned_of(bar) -> None:
    # contacts without friction carry no shear, which slows P waves of a random packing
    soft = {**DENSE, "motion.held": [], "material.contact_share": 0.9}
    (found,) = warned(bar(soft))
    assert found.startswith("material.p_wave_speed: is 1000 m/s of the square lattice; P waves along x run at ")
    assert warned(bar({**soft, "material.match": "assembly"})) == []
    moduli = {"density": 2500.0, "emod": 2.25e9, "pb_emod": 0.25e9}
    assert warned(bar({**DENSE, "motion.held": [], "material": moduli})) == []


@pytest.mark.parametrize(
    ("middle", "cut"),
    [(0.0, "left"), (1.5, None)],
)
def test_a_hole_that_a_periodic_side_cuts_is_warned_of(bar, middle: float, cut: str | None) -> None:
    """The circle of 1.5 m touches the side at x = 0 with its middle at 1.5 m."""
    hole = {"name": "t", "type": "circle", "centre": [middle, 5.0], "radius": 1.5}
    ring = {"left": {"type": "periodic"}, "right": {"type": "periodic"}, "top": {"type": "velocity", "wave_s": "pulse"}}
    case = bar({**SLOW, "motion.held": [], "packing.size": [10.0, 10.0], "hole": [hole], "boundary": ring})
    found = [line.split(", and")[0] for line in warned(case) if line.startswith("hole")]
    assert found == ([] if cut is None else [f"hole[1, t]: is cut by the periodic {cut} side"])


@pytest.mark.parametrize(("share", "reported"), [(0.85, True), (1.0, False)])
def test_a_speed_of_s_waves_that_the_packing_lacks_is_warned_of(share: float, reported: bool) -> None:
    """A square lattice of 1000 m/s for P waves with springs of a quarter in shear has S waves of 500 m/s."""
    material = {"density": 2500.0, "emod": 1.25e9, "pb_emod": 1.25e9, "s_wave_speed": share * 500.0}
    ground = {"packing": {"pattern": "A", "size": [20.0, 10.0], "radius": 0.5}, "material": material}
    scene = build(small({**ground, "run": {"duration": 0.01}}))
    lines = [line for own in materials_of(scene) for line in _s_speed_of_the_packing(scene, own)]
    assert [line[:80] for line in lines] == reported * [
        "material.s_wave_speed: is 425 m/s, S waves along x run at 500 m/s in this packing"[:80]
    ]


def test_holes_that_remove_nothing_are_warned_of(bar) -> None:
    """Between four disks of 0.5 m, or within an earlier hole; not with the centre of one at its upper right."""
    corners = {"between": [1.8, 0.3, 2.2, 0.7], "one": [5.8, 0.3, 6.26, 0.76]}
    corners |= {"wide": [7.3, 0.0, 9.7, 0.4], "narrow": [7.8, 0.0, 9.2, 0.4]}
    holes = [{"name": name, "type": "rectangle", "corners": each} for name, each in corners.items()]
    expected = [
        "hole[1, between]: no particle is centred in it, so it removes none",
        "hole[4, narrow]: lies within hole.wide, so it removes no more particles",
    ]
    for later, said in (("narrow", expected), ("wide", expected[:1])):
        each = [{**hole, "stage": "after" if hole["name"] == later else "before"} for hole in holes]
        static = {"static": {"stress": [-1e5, -1e5, 0.0]}}
        lines = warned(bar({"packing.size": [10.0, 1.0], "hole": each, **static}))
        assert [line for line in lines if line.startswith("hole")] == said
