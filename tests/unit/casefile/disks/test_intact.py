"""Where bonds are kept from breaking by default, and where a bottom has springs."""

import pytest
from small_cases import GRAINS, problems_of, small

from dembound.boundaries.viscous import Bearing
from dembound.casefile.disks import DiskCase

WEIGHT = {"name": "weight", "acceleration": [0.0, -9.81]}
BREAKS = GRAINS["material"] | {"law": "linearpbond", "pb_ten": 1e6}
BOTTOM = {"type": "viscous_input", "wave_s": "pulse"}
FREE_FIELD = {"type": "free_field"}
VISCOUS = {"type": "viscous"}
PERIODIC = {side: {"type": "periodic"} for side in ("left", "right")}
PLATEN = {"type": "velocity", "wave_p": "pulse", "hold": ["normal"]}
FIXED = {"type": "fixed"}
HELD = {"bottom": FIXED, "left": {"type": "roller"}, "right": {"type": "roller"}}
ALL = {"left": 2, "right": 2, "bottom": 2}


def case_of(boundary: dict, static: dict | None = None, **tables: object) -> DiskCase:
    static = {"boundary": HELD} if static is None else static
    return small(GRAINS | {"material": BREAKS, "load": [WEIGHT], "static": static, "boundary": boundary, **tables})


@pytest.mark.parametrize(
    ("boundary", "expected"),
    [
        ({"bottom": BOTTOM, "left": FREE_FIELD, "right": FREE_FIELD}, ALL),
        ({"bottom": BOTTOM | {"intact": 3}, "left": VISCOUS | {"intact": 0}}, {"bottom": 3}),
        # other rock below belongs to the problem, but the ground stands on it
        ({"bottom": BOTTOM | {"rock": {"density": 2700.0, "p_wave_speed": 3e3, "s_wave_speed": 2e3}}}, {"bottom": 2}),
        # a base that shakes the ground; a platen that presses on a sample
        ({"bottom": {"type": "velocity", "wave_s": "pulse"}, "left": FREE_FIELD, "right": FREE_FIELD}, ALL),
        ({"bottom": FIXED, "top": PLATEN}, {}),
        # a side that says it is artificial makes the body a part of the ground, one that says it is not never counts
        ({"bottom": FIXED | {"artificial": True}}, {"bottom": 2}),
        ({"bottom": FIXED | {"artificial": False}, "left": VISCOUS, "right": VISCOUS}, {"left": 2, "right": 2}),
        # jaws hold a part of a side
        ({"bottom": FIXED | {"within": [1.0, 3.0]}, "left": VISCOUS}, {"left": 2}),
    ],
)  # fmt: skip
def test_zones_lie_where_forces_at_rest_act_on_sides_that_stand_for_ground(boundary, expected) -> None:
    assert case_of(boundary).intact == expected


def test_sides_without_forces_at_rest_have_none() -> None:
    sides = {"bottom": BOTTOM, "left": VISCOUS, "right": VISCOUS}
    assert case_of(sides, {"boundary": {"bottom": FIXED}}).intact == {"bottom": 2}
    assert case_of(sides, {"boundary": {"bottom": FIXED}, "k0": 0.5}).intact == ALL
    assert case_of(PERIODIC | {"bottom": BOTTOM}, {"boundary": {"bottom": FIXED}}).intact == {"bottom": 2}
    without = {key: value for key, value in GRAINS.items() if key != "static"}
    moving = small(without | {"material": BREAKS, "boundary": sides})
    assert moving.intact == {}


def test_bonds_without_strength_need_none_but_load_factors_do() -> None:
    sides = {"bottom": BOTTOM, "left": VISCOUS, "right": VISCOUS}
    tough = {key: value for key, value in BREAKS.items() if key != "pb_ten"}
    assert case_of(sides, material=tough).intact == {}
    assert case_of(sides, material=tough, layer=[{"thickness": 2.0, "pb_coh": 1e6}, {}]).intact == ALL
    elastic = case_of(sides, material=BREAKS | {"law": "elastic"}, output={"load_factor": True})
    assert elastic.intact == ALL
    assert elastic.bearing is None


@pytest.mark.parametrize(
    ("bottom", "expected"),
    [
        (BOTTOM, Bearing()),
        (BOTTOM | {"intact": 0}, None),
        (BOTTOM | {"intact": 0, "bearing": True}, Bearing()),
        (BOTTOM | {"bearing": {"alpha_n": 2.0}}, Bearing(alpha_n=2.0)),
        ({"type": "viscoelastic_input", "wave_s": "pulse", "distance": 9.0}, None),  # has springs of its own
        ({"type": "velocity", "wave_s": "pulse"}, None),
    ],
)  # fmt: skip
def test_bottoms_of_dashpots_have_springs_where_they_have_a_zone(bottom, expected) -> None:
    assert case_of({"bottom": bottom, "left": FREE_FIELD, "right": FREE_FIELD}).bearing == expected


def test_keys_of_other_sides_and_of_bars_are_refused() -> None:
    method = '[method]\ntype = "finite_difference"\n'
    bar = f"{method}[bar]\nlength = 1.0\nspacing = 0.1\ndensity = 1.0\nwave_speed = 1.0\n[run]\nduration = 1.0\n"
    assert problems_of(f'{bar}[boundary.right]\ntype = "viscous"\nintact = 2') == [
        "boundary.right.intact: is for sides of disks"
    ]
    body = '[packing]\npattern = "A"\nsize = [9.0, 9.0]\nradius = 0.5\n[material]\ndensity = 1.0\np_wave_speed = 1.0\n'
    run = "[run]\nduration = 1.0\n"
    assert problems_of(f'{body}{run}[boundary.right]\ntype = "viscous"\nbearing = true') == [
        "boundary.right.bearing: is for the bottom of disks"
    ]
