"""The [[group]] table, holes and supports with a time of the run: what they make of the ground, and mistakes."""

import pytest
from small_cases import problems_in, small

from dembound.accuracy.of_disks.exact.problem import law_problems
from dembound.accuracy.of_disks.judge import _require_linear
from dembound.disks.changes import times_of
from dembound.disks.material.grouped import BEFORE
from dembound.disks.rest.settled import settling_keys
from dembound.disks.scene import build
from dembound.kinds import kind_of
from dembound.studies.library.build import problems_of
from dembound.studies.strength.study import weaker

WEAK = {"name": "weak", "region": [1.0, 0.0, 2.0, 3.0], "fric": 0.2, "pb_ten": 1e3}
LATER = {"name": "later", "points": [[1.5, 0.0], [3.0, 0.0], [3.0, 3.0], [1.5, 3.0]], "pb_ten": 10.0, "time": 0.005}
BOX = {"name": "cut", "type": "rectangle", "corners": [1.0, 1.0, 2.0, 2.0], "stage": "run", "time": 0.005}
BLOCK = {
    "packing": {"pattern": "A", "size": [4.0, 3.0], "radius": 0.25},
    "material": {"density": 2500.0, "law": "linearpbond", "p_wave_speed": 1000.0, "fric": 0.5, "pb_ten": 1e6},
    "boundary": {"bottom": {"type": "fixed"}, "left": {"type": "viscous"}},
    "static": {"boundary": {"bottom": {"type": "fixed"}, "right": {"type": "roller", "until": 0.002}}},
    "load": [{"name": "weight", "acceleration": [0.0, -9.81]}],
    "group": [WEAK, LATER],
    "hole": [BOX],
    "run": {"duration": 0.01},
}


def test_later_groups_change_what_earlier_ones_left_and_layers_go_on_below_them() -> None:
    layers = [{"thickness": 1.5, "fric": 0.4}, {"name": "deep"}]
    case = small(BLOCK | {"layer": layers})
    scene = build(case)
    assert scene.groups is not None
    layer = scene.groups.layer_of(scene.positions)
    found = {time: scene.groups.materials_at(case, time) for time in (BEFORE, 0.005)}
    at = {place: int(number) for place, number in zip(map(tuple, scene.positions.tolist()), layer, strict=True)}
    own = {
        place: [(each.fric, each.pb_ten) for each in (found[time][at[place]] for time in found)]
        for place in ((0.25, 2.25), (1.25, 2.25), (1.75, 2.25), (2.75, 2.25), (0.25, 0.25), (2.75, 0.25))
    }
    assert list(own.values()) == [
        [(0.4, 1e6), (0.4, 1e6)],
        [(0.2, 1e3), (0.2, 1e3)],
        [(0.2, 1e3), (0.2, 10.0)],
        [(0.4, 1e6), (0.4, 10.0)],
        [(0.5, 1e6), (0.5, 1e6)],
        [(0.5, 1e6), (0.5, 10.0)],
    ]
    assert times_of(case) == [0.002, 0.005]


def test_what_changes_later_is_no_part_of_the_settled_state_and_is_refused_where_it_is_unknown() -> None:
    case, later = small(BLOCK), LATER | {"pb_ten": 1.0, "time": 0.007}
    other = small(BLOCK | {"group": [WEAK, later], "hole": [BOX | {"time": 0.006}]})
    weak = small(BLOCK | {"group": [WEAK | {"fric": 0.1}, LATER]})
    keys, *others = (settling_keys(build(each)) for each in (case, other, weak))
    assert [each == keys for each in others] == [True, False]
    assert weaker(case, 2.0).group[0].pb_ten == 500.0
    elastic = {"density": 2500.0, "p_wave_speed": 1000.0}
    stiff = small(
        BLOCK | {"material": elastic, "group": [{"name": "a", "region": WEAK["region"], "emod": 1e9, "pb_emod": 1e9}],
                 "hole": [], "boundary": {}}
    )  # fmt: skip
    assert any("group:" in line for line in problems_in(lambda: _require_linear(stiff)))
    assert any("group:" in line for line in problems_of(stiff))
    assert any("group:" in line for line in law_problems(stiff))


GROUP = "group[1, weak]"


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        ({"group": [{"name": "weak", "region": [0.0, 0.0, 1.0, 1.0]}]}, f"{GROUP}.pb_ten: is missing"),
        ({"group": [{"name": "weak", "fric": 0.1}]}, f"{GROUP}.region: is missing; give either region or points"),
        ({"group": [WEAK | {"points": LATER["points"]}]}, f"{GROUP}.points: is not allowed together with region"),
        ({"group": [WEAK | {"region": [2.0, 0.0, 1.0, 3.0]}]}, f"{GROUP}.region: must have x0 < x1"),
        ({"group": [WEAK | {"region": [7.0, 0.0, 8.0, 3.0]}]}, f"{GROUP}: lies outside the disks"),
        ({"group": [WEAK, WEAK]}, 'group[2].name: "weak" is taken by group[1]'),
        ({"group": [WEAK | {"pb_mcf": 0.5, "time": 0.0}]}, f"{GROUP}.pb_mcf: cannot change in a run"),
        ({"group": [WEAK | {"time": 0.02}]}, f"{GROUP}.time: is 0.02 s, after the end of the run at 0.01 s"),
        ({"group": [WEAK | {"pb_fa": 20.0}]}, f"{GROUP}.pb_fa: is only allowed together with pb_coh"),
        ({"group": [WEAK | {"fric": 0.0}]}, f"{GROUP}.fric: is 0, and 0.5 in the ground beside it"),
        ({"group": [WEAK | {"kratio": 2.0}]}, f"{GROUP}.kratio: comes within 1 m of the left side"),
        (
            {"material.quality_factor": 10.0, "group": [WEAK | {"kratio": 2.0}]},
            f"{GROUP}.kratio: other springs are for",
        ),
        ({"material.law": "elastic"}, f"{GROUP}.pb_ten: is only allowed with law ="),
        ({"material.law": "elastic"}, 'hole[1, cut].stage: is "run", which needs contacts that open'),
        ({"hole": [BOX | {"time": 0.02}]}, "hole[1, cut].time: is 0.02 s, after the end of the run"),
        ({"hole": [BOX | {"stage": "after"}]}, 'hole[1, cut].time: needs stage = "run"'),
        (
            {"hole": [{key: each for key, each in BOX.items() if key != "time"}]},
            'hole[1, cut].time: is missing, with stage = "run"',
        ),
        ({"static.boundary.right.until": 0.02}, "static.boundary.right.until: is 0.02 s, after the end"),
        ({"static.boundary.right.reactions": "none"}, 'static.boundary.right.until: is of reactions that are "kept"'),
        ({"boundary.bottom.until": 0.005}, "boundary.bottom.until: is of the static stage"),
    ],
)
def test_mistakes_have_a_line_each(changes: dict, line: str) -> None:
    found = problems_in(lambda: small(BLOCK, changes=changes))
    assert any(each.startswith(line) for each in found), found


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        ({"group": [WEAK | {"region": [1.3, 0.3, 1.4, 0.4]}]}, "group.weak: has no disks"),
        ({"hole": [BOX | {"corners": [1.3, 1.3, 1.4, 1.4]}]}, "hole.cut: takes no disks"),
        ({"hole": [BOX | {"corners": [1.0, 0.0, 2.0, 2.0]}]}, "hole.cut: takes 4 disks by which sides act"),
    ],
)
def test_groups_and_holes_take_disks_and_none_of_a_side(changes: dict, line: str) -> None:
    case = small(BLOCK, changes=changes)
    found = problems_in(lambda: kind_of(case).build(case))
    assert any(each.startswith(line) for each in found), found


def test_types_of_contacts_are_the_same_before_and_after_an_excavation() -> None:
    """The last contact across the border of a group is dug out."""
    drift = {"name": "drift", "type": "rectangle", "corners": [0.5, 1.0, 1.5, 2.0], "stage": "after"}
    scene = build(small(BLOCK, changes={"hole": [drift], "group": [WEAK | {"region": [0.5, 1.0, 1.5, 2.0]}, LATER]}))
    assert scene.before is not None
    assert scene.groups is scene.before.groups
