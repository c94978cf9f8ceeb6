"""Probable mistakes in a case of disks: loads, stages, holes, factors and speeds."""

import numpy as np
import pytest
from small_cases import SURROUNDED, small
from warned_cases import DENSE, SLOW, warned

from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.reports.warnings import _s_speed_of_the_packing, _steady_without_static
from dembound.disks.scene import build
from dembound.running import plan, warnings_before

PERIODIC = {f"boundary.{side}": {"type": "periodic"} for side in ("left", "right", "bottom", "top")}

BELOW = {side: {"type": "outside"} for side in ("left", "right", "bottom")}


@pytest.mark.parametrize(
    ("changes", "beyond"),
    [
        ({"material.pb_ten": 3.4e6}, True),
        ({"material.pb_ten": 4.5e6}, False),
        ({}, False),
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
    ("stress", "tension"),
    [
        ([-9e6, -9e6, 0.0], None),
        ([-9e6, 1.1e6, 0.0], "1.1 MPa"),
        ([0.9e6, 0.9e6, 0.0], None),
        ([0.5e6, 0.5e6, -0.6e6], "1.1 MPa"),  # 0.5 + 0.6
        ([0.9e6, -0.7e6, 0.6e6], "1.1 MPa"),  # 0.1 + (0.8² + 0.6²)^½
        ([0.9e6, -0.7e6, 0.3e6], None),  # 0.95
    ],
)
def test_settling_under_a_tension_above_the_strength_is_warned_of(bar, stress, tension) -> None:
    brittle = {"material.law": "linearpbond", "material.pb_ten": 1e6, "material.pb_coh": 2e6}
    found = warned(bar({**brittle, **SLOW, "motion.held": [], "static": {"stress": stress}}))
    said = f"static.stress: has a tension of {tension}, above material.pb_ten = 1 MPa; bonds break in the static stage"

    assert [line for line in found if "tension of" in line] == ([] if tension is None else [said])


@pytest.mark.parametrize(
    ("static", "sudden"), [({}, True), ({"static": {"boundary": {"left": {"type": "fixed"}}}}, False)]
)
def test_a_steady_load_without_a_static_stage_is_warned_of(bar, static: dict, sudden: bool) -> None:
    weight = {"name": "weight", "acceleration": [10.0, 0.0]}
    tap = {"name": "tap", "acceleration": [1.0, 0.0], "wave": "pulse"}
    found = warned(bar({"load": [weight, tap], **SLOW, **static}))

    assert [warning.split(",")[0] for warning in found if "load.weight" in warning] == [
        "load.weight: is steady"
    ] * sudden


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"boundary": {"right": {"type": "viscous"}}}, "; viscous sides creep under it"),
        ({"boundary": BELOW}, "; the ground beyond the sides, of which nothing is held, moves under it as long as the"),
        ({"boundary": BELOW, "load": [{"name": "weight", "force": [0.0, -1.0], "position": [5.0, 2.5]}]}, "t = 0"),
        ({"boundary": {"bottom": {"type": "fixed"}}}, "t = 0"),
    ],
    ids=["viscous", "outside", "in one place", "fixed"],
)
def test_what_moves_on_under_a_steady_load_is_said(changes: dict, said: str) -> None:
    base = {key: table for key, table in SURROUNDED.items() if key != "boundary"}
    weight = {"load": [{"name": "weight", "acceleration": [0.0, -10.0]}]}
    (line,) = _steady_without_static(build(small(base | weight | changes)))
    assert line.startswith("load.weight: is steady, and without [static] acts suddenly at t = 0")
    assert said in line
    assert line.endswith(said) or "as long as the run lasts" in line


@pytest.mark.parametrize(("ratio", "other"), [(1.09, False), (1.11, True), (0.91, False), (0.89, True)])
def test_a_packing_of_another_speed_is_warned_of(bar, monkeypatch, ratio: float, other: bool) -> None:
    monkeypatch.setattr(PackedMaterial, "wave_speeds", lambda self, axis: (1000.0 * ratio, np.nan))
    found = [each for each in warned(bar({**SLOW})) if each.startswith("material")]

    assert found == other * [
        f"material.p_wave_speed: is 1000 m/s of the square lattice; P waves along x run at {1000 * ratio:.4g} m/s in "
        'this packing; give match = "assembly"'
    ]


def test_the_speed_along_y_counts_where_waves_go_there(bar, monkeypatch) -> None:
    monkeypatch.setattr(PackedMaterial, "wave_speeds", lambda self, axis: (1000.0 if axis == 0 else 1200.0, np.nan))
    tap = {"name": "tap", "force": [1.0, 0.0], "position": [5.0, 0.5], "wave": "pulse"}
    below = {"boundary.bottom": {"type": "velocity", "wave_p": "pulse"}, "motion.held": []}
    for changes, there in (({}, False), ({"load": [tap]}, True), (below, True)):
        found = warned(bar({**SLOW, **changes}))
        assert any("along y run at 1200 m/s" in each for each in found) == there


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
    [(0.0, "left"), (10.0, "right"), (5.0, None), (1.5, None)],
    ids=["left", "right", "inside", "at it"],
)
def test_a_hole_that_a_periodic_side_cuts_is_warned_of(bar, middle: float, cut: str | None) -> None:
    """The circle of 1.5 m touches the side at x = 0 with its middle at 1.5 m."""
    hole = {"name": "t", "type": "circle", "centre": [middle, 5.0], "radius": 1.5}
    ring = {"left": {"type": "periodic"}, "right": {"type": "periodic"}, "top": {"type": "velocity", "wave_s": "pulse"}}
    case = bar({**SLOW, "motion.held": [], "packing.size": [10.0, 10.0], "hole": [hole], "boundary": ring})
    found = [line.split(", and")[0] for line in warned(case) if line.startswith("hole")]
    assert found == ([] if cut is None else [f"hole[1, t]: is cut by the periodic {cut} side"])


def test_a_wave_that_nothing_uses_is_warned_of_alone(bar) -> None:
    """Also where it would be too short for the disks."""
    other = {"wave.other": {"type": "cosine", "amplitude": 1.0, "period": 1e-4}}
    lines = warnings_before(plan(bar({**SLOW, **other})))
    assert [line for line in lines if "other" in line] == ["wave.other: no side and no load uses it"]


@pytest.mark.parametrize(("stages", "is_said"), [(("before", "after"), True), (("after", "before"), False)])
def test_a_hole_within_an_earlier_one_is_warned_of(bar, stages, is_said) -> None:
    wide, narrow = (
        {"name": name, "type": "rectangle", "corners": [x, 0.0, 6.0 - x, 0.4], "stage": stage}
        for name, x, stage in zip(("wide", "narrow"), (1.8, 2.3), stages, strict=True)
    )
    lines = warned(bar({"packing.size": [10.0, 1.0], "hole": [wide, narrow], "static": {"stress": [-1e5, -1e5, 0.0]}}))
    said = ["hole[2, narrow]: lies within hole.wide, so it removes no more particles"]
    assert [line for line in lines if "lies within" in line] == (said if is_said else [])


def test_holes_that_remove_nothing_are_warned_of(bar) -> None:
    """Between four disks of 0.5 m, above the rows, or with the centre of a single one at their upper right."""
    between, above, one = (
        {"name": name, "type": "rectangle", "corners": corners}
        for name, corners in (
            ("between", [1.8, 0.3, 2.2, 0.7]),
            ("above", [3.0, 0.8, 4.0, 2.0]),
            ("one", [5.8, 0.3, 6.26, 0.76]),
        )
    )
    lines = warned(bar({"packing.size": [10.0, 1.0], "hole": [between, above, one]}))
    assert [line for line in lines if line.startswith("hole")] == [
        f"hole[{number}, {name}]: no particle is centred in it, so it removes none"
        for number, name in ((1, "between"), (2, "above"))
    ]


@pytest.mark.parametrize(("share", "told"), [(0.85, True), (1.0, False)])
def test_a_speed_of_s_waves_that_the_packing_lacks_is_warned_of(share: float, told: bool) -> None:
    """A square lattice of p_wave_speed 1000 m/s with springs of a quarter in shear has S waves of 500 m/s."""
    material = {"density": 2500.0, "p_wave_speed": 1000.0, "s_wave_speed": share * 500.0}
    ground = {"packing": {"pattern": "A", "size": [20.0, 10.0], "radius": 0.5}, "material": material}
    lines = list(_s_speed_of_the_packing(build(small({**ground, "run": {"duration": 0.01}}))))
    assert [line[:80] for line in lines] == told * [
        "material.s_wave_speed: is 425 m/s, S waves along x run at 500 m/s in this packing"[:80]
    ]
