"""Loads, holes, boxes of disks and lower ground beyond a side: their keys and places, alone and beside other tables."""

import pytest
from small_cases import BODY, GROUND, PUSHED, Tables, around, problems_in, problems_of, rows, small

from dembound.casefile import Case
from dembound.casefile.disks.ground import UPWARDS, reach
from dembound.kinds import loads

TAP = '[wave.tap]\ntype = "cubic_spline"\namplitude = 1.0\nperiod = 0.05\n'
CIRCLE = 'type = "circle"\ncentre = [5.0, 2.5]\nradius = 1.0'
BOW_TIE = 'type = "polygon"\npoints = [[2, 1], [4, 3], [4, 1], [2, 3]]'


def table(kind: str, *keys: str, name: str = "a") -> str:
    return "\n".join([f"[[{kind}]]", f'name = "{name}"', *keys, ""])


def problems(*tables: str) -> list[str]:
    return problems_of("".join([BODY, TAP, *tables]))


MISTAKES = r"""
load |  | .force: is missing; give one of force, acceleration, pressure
load | force = [1, 0] | .position: is missing; a force needs either position or region
load | acceleration = [0, 0]\nposition = [1, 1] | .acceleration: is zero along x and y, must not be
load | pressure = 1e6 | .hole: is missing; a pressure needs the name of a hole, or sides
load | force = [1, 0]\nposition = [1, 1]\nhole = "h" | .hole: is for a pressure
load | force = [1, 0]\nposition = [10.5, 1.0] | .position: is [10.5, 1.0], must be in the scene, [0, 0] to [10, 5] (m)
load | force = [1, 0]\nregion = [0, 0, 6, 5.5] | .region: is [0.0, 0.0, 6.0, 5.5], must be in the scene, [0, 0] to [10,
hole | type = "rectangle"\ncorners = [5, 1, 4, 2] | .corners: must have x0 < x1 and y0 < y1, in the order x0, y
hole | type = "polygon"\npoints = [[1, 1], [2, 2]] | .points: has 2, must have at least three
"""


@pytest.mark.parametrize(("kind", "keys", "line"), rows(MISTAKES))
def test_each_mistake_gets_one_plain_line(kind: str, keys: str, line: str) -> None:
    (found,) = problems(table(kind, keys))
    assert found.startswith(f"{kind}[1, a]{line}")


HOLE, PRESSED = table("hole", CIRCLE, name="tunnel"), table("load", "pressure = 1e6", 'hole = "tunnel"')


def test_a_pressure_acts_on_a_hole_of_the_case_and_on_nothing_else() -> None:
    case = loads(BODY + HOLE + PRESSED)
    (pressed,) = case.load
    assert (pressed.key, pressed.axes, pressed.on, pressed.is_everywhere) == ("pressure", (0, 1), "outline", False)
    assert case.hole_of(pressed).name == "tunnel"
    assert problems(PRESSED) == ['load[1, a].hole: "tunnel" is not a hole of this case; none is defined']
    assert problems(HOLE.replace("tunnel", "tunnels") + PRESSED) == [
        'load[1, a].hole: "tunnel" is not a hole of this case; defined: tunnels (did you mean tunnels?)'
    ]
    assert problems("[static]\n", HOLE, PRESSED) == []  # steady, it needs no supports
    # an outline without crossings, unless it is on bonds
    crossed = table("hole", BOW_TIE, name="tunnel")
    said = 'load[1, a].on: "outline" needs edges that do not cross; give hole tunnel such, or on = "bonds"'
    assert problems(crossed, PRESSED) == [said]
    assert problems(crossed, PRESSED, 'on = "bonds"\n') == []


def test_a_pressure_cannot_act_where_a_periodic_side_closes_the_wall() -> None:
    sides = '[boundary.left]\ntype = "periodic"\n[boundary.right]\ntype = "periodic"\n'
    for centre, side in ((1.0, "left"), (1.01, ""), (8.99, ""), (9.0, "right")):
        line = f'load[1, a].hole: "tunnel" reaches the periodic side {side}, which closes its wall otherwise'
        assert problems(sides, HOLE.replace("5.0", str(centre)), PRESSED) == ([line] if side else [])


def test_a_held_direction_cannot_be_loaded() -> None:
    line, held = "load[1, a].{}: acts along {}, which motion.held holds for every particle", '[motion]\nheld = ["x"]\n'
    assert problems(held, table("load", "acceleration = [0.0, 1.0]")) == []
    assert problems(held, table("load", "acceleration = [1.0, 1.0]")) == [line.format("acceleration", "x")]
    assert problems(held.replace("x", "y"), HOLE, PRESSED) == [line.format("pressure", "y")]


def test_a_hole_beside_the_scene_is_refused() -> None:
    said = "hole[1, tunnel]: lies outside the scene, [0, 0] to [10, 5] (m)"
    for place, lines in (("11.0, 2.5", [said]), ("5.0, -1.5", [said]), ("10.9, 2.5", [])):  # it may reach beyond
        assert problems(HOLE.replace("5.0, 2.5", place)) == lines


def test_excavating_takes_a_static_stage() -> None:
    after = HOLE + 'stage = "after"\n'
    assert problems(after, "[static]\nstress = [-1e6, -1e6, 0.0]\n") == []
    assert problems(after) == ['hole[1, tunnel].stage: is "after", but the case has no [static] stage to come after']
    # a stage that is invalid is there all the same
    assert problems(after, "[static]\ndamp = 2\n") == ["static.damp: is 2, must be less than 1"]


def test_nothing_is_watched_or_pushed_where_nothing_is_left() -> None:
    def found(*keys: str) -> list[str]:
        return problems(HOLE, *(table("load" if "force" in each else "monitor", each) for each in keys))

    push, said = "force = [1.0, 0.0]\n", ".position: lies in hole[1, tunnel]; must be where particles remain"
    lines = [f"load[1, a]{said}", f"monitor[1, a]{said}"]
    assert found("position = [5.0, 3.4]", f"{push}position = [4.1, 2.5]") == lines
    assert found("position = [5.0, 3.6]", f"{push}position = [3.9, 2.5]") == []
    # a region is loaded where particles are left in it
    assert found(f"{push}region = [4.5, 2.0, 5.5, 3.0]") == []


FAR = float("inf")
ALL = ("left", "right", "bottom", "top")
GRAINS = {"pattern": "B", "radius": 0.5, "radius_ratio": 1.5, "brick": [5.0, 10.0], "size": [20.0, 20.0]}


def box(*origin: float, sides: tuple[str, ...] = ALL, **tables: object) -> Case:
    """A box of disks at a place in ground of 60 m × 40 m."""
    packing = GRAINS | {"origin": list(origin or (20.0, 10.0))}
    whole = {"ground": {"size": [60.0, 40.0]}, "packing": packing, "material": PUSHED["material"]}
    return small(whole | {"boundary": around("outside", *sides), "run": {"duration": 0.1}} | tables)


def refused(*origin: float, **words: object) -> list[str]:
    return problems_in(lambda: box(*origin, **words))


def test_disks_and_ground_may_begin_anywhere() -> None:
    case = box()
    assert (case.packing.box, case.column_rows, case.size) == ((20.0, 10.0, 40.0, 30.0), (1, 4), (60.0, 40.0))
    filled = box(-30.0, 7.0, ground={}, boundary={})
    assert filled.box == filled.packing.box == (-30.0, 7.0, -10.0, 27.0)
    assert (filled.size, filled.column_rows) == ((20.0, 20.0), (0, 2))
    moved = box(-17.0, -23.0, ground={"size": [60.0, 40.0], "origin": [-37.0, -33.0]})
    assert moved.box == (-37.0, -33.0, 23.0, 7.0)
    assert moved.column_rows == case.column_rows
    assert not moved.reaches_surface
    assert box(20.0, 20.0, sides=ALL[:3]).reaches_surface


def test_the_box_lies_in_the_ground_and_heights_are_whole_bricks() -> None:
    for origin in ((-1.0, 10.0), (20.0, 30.0)):
        (line,) = refused(*origin)
        assert line.startswith("packing.origin: the box of disks is ")
        assert line.endswith(", must lie in the ground, [0, 0] to [60, 40] (m)")
    said = "m, is not a whole number of bricks of 10 m"
    assert refused(20.0, 12.0) == [f"packing.origin: its height, 12 {said}; 10 or 20 would be"]
    tall = {"size": [60.0, 45.0]}
    assert refused(ground=tall) == [f"ground.size: its height, 45 {said}; 40 or 50 would be"]
    assert box(17.3, 10.0).packing.origin[0] == 17.3  # sideways it may be any


def test_where_the_ground_goes_on_a_side_is_outside() -> None:
    for missing, gap in (("left", "20"), ("top", "10")):
        others = around("outside", *(side for side in ALL if side != missing))
        said = f'boundary.{missing}.type: the ground goes on {gap} m beyond this side, so it must be "outside"'
        assert refused(boundary=others) == [said]
        assert refused(boundary=others | {missing: {"type": "viscous"}}) == [said]


def test_the_reach_of_monitors_and_loads() -> None:
    def found(*origin: float, **words: object) -> tuple[float, ...]:
        made = box(*origin, **words)
        return reach(made.ground, made.packing, made.boundary)

    assert found() == (-FAR, -FAR, FAR, 40.0)  # beside the ground too, above it nowhere
    assert found(0.0, 20.0, sides=("right", "bottom")) == (0.0, -FAR, FAR, 40.0)
    moved = {"size": [60.0, 40.0], "origin": [-50.0, -20.0]}
    assert found(-30.0, -10.0, ground=moved) == (-FAR, -FAR, FAR, 20.0)


CUT = {"name": "cut", "type": "polygon", "points": [[10.0, 21.0], [18.0, 11.5], [31.0, 11.5], [31.0, 21.0]]}
WEIGHT = {"load": [{"name": "weight", "acceleration": [0.0, -9.81]}]}
FIXED, ROLLER = {"type": "fixed"}, {"type": "roller"}
STAGE = {"static": {"boundary": {"bottom": FIXED, "left": ROLLER, "right": FIXED}}}
WHY = (
    "as the ground is no half-space, with its surface at y = 11.5 m beyond the right side; end the holes inside the "
    "disks, with the surface at its height at both sides"
)


def sloped(changes: Tables) -> Case:
    return small(GROUND | {"hole": [CUT]}, changes=changes)


def test_floors_are_those_of_all_holes() -> None:
    found = small(GROUND | {"hole": [CUT]}).floors
    assert found.keys() == {"right"}
    assert found["right"].height == pytest.approx(11.5, abs=1e-12)
    second = {"name": "other", "type": "rectangle", "corners": [-1.0, 14.0, 6.0, 21.0], "stage": "after"}
    both = sloped(WEIGHT | STAGE | {"hole": [CUT, second]})
    assert {side: floor.height for side, floor in both.floors.items()} == pytest.approx({"right": 11.5, "left": 14.0})
    assert both.floors_of(both.hole[1:]).keys() == {"left"}


def test_beside_a_floor_waves_rise_and_loads_on_all_disks_need_a_stage() -> None:
    line = f"load[1, weight]: acts on all disks, which needs a [static] stage and no wave, {WHY}"
    waved = {"load": [WEIGHT["load"][0] | {"wave": "w"}]} | STAGE
    oblique = {"incident": {"type": "sv", "angle": 10.0, "wave": "w"}}
    where = (
        "where the ground beyond a side is lower than the disks, with its surface at y = 11.5 m beyond the right side"
    )
    for stage in ({}, WEIGHT | {"static": {"boundary": {"bottom": FIXED, "left": ROLLER, "right": ROLLER}}}):
        assert problems_in(lambda stage=stage: sloped(oblique | stage)) == []
    assert problems_in(lambda: sloped(oblique | {"layer": [{"thickness": 8.0}, {}]})) == [
        f"incident: is not known together with layers {where}; leave one out, or give {UPWARDS}"
    ]
    assert sloped({}).column_sides == ()
    assert sloped({"boundary.bottom.wave_p": "w"}).column_sides == ("left", "right", "bottom")
    assert line in problems_in(lambda: sloped(WEIGHT))
    assert line in problems_in(lambda: sloped(waved))


def test_the_stage_holds_both_sides() -> None:
    def staged(**sides: dict[str, str]) -> Case:
        return sloped(WEIGHT | {"static": {"boundary": {"bottom": FIXED, **sides}}})

    assert staged(left=ROLLER, right=FIXED).column_sides == ()
    line = 'static.boundary.{}: must be "roller" or "fixed", as the ground beyond is no half-space'
    for sides, wrong in (({}, ["left", "right"]), ({"left": ROLLER, "right": {"type": "free"}}, ["right"])):
        assert problems_in(lambda sides=sides: staged(**sides)) == [line.format(side) for side in wrong]
