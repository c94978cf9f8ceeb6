"""The choices of a chart: from the table [chart], and the choices when case and command give none."""

import pytest

from dembound.accuracy.chart.study import defaults, from_table
from dembound.accuracy.choice import changed, choices_of
from dembound.errors import CaseError
from dembound.kinds import with_changes


def test_the_table_gives_choices(bar) -> None:
    case = bar(
        {
            "chart": {
                "vary": {"run.safety": [0.5, 0.9]},
                "choice": [{"name": "free", "set": {"boundary.right": {"type": "free"}}}],
            }
        }
    )
    assert from_table(case) == {
        "safety 0.5": {"run.safety": 0.5},
        "safety 0.9": {"run.safety": 0.9},
        "free": {"boundary.right": {"type": "free"}},
    }
    assert from_table(bar()) == {}
    twice = [{"name": "free", "set": {}}, {"name": "free", "set": {"run.safety": 0.5}}]
    with pytest.raises(CaseError, match=r"chart.choice: two choices have the name free"):
        from_table(bar({"chart": {"choice": twice}}))


def test_of_disks_one_thing_changes_at_a_time(bar) -> None:
    found = defaults(bar({"boundary.right.beta_p": 0.8}))
    assert found == {
        "as in the case": {},
        "radius 0.5 m": {"packing.radius": 0.5},  # ×1.25 and ×1.5 do not divide 10 m × 1 m
        "safety 0.45": {"run.safety": 0.45},
        "right, matched β": {"boundary.right.beta_p": "matched"},
        "right viscoelastic": {"boundary.right": {"type": "viscoelastic", "distance": 5.0, "beta_p": 0.8}},
        "right free": {"boundary.right": {"type": "free"}},
    }


TUNNEL = {
    "packing": {"pattern": "A", "size": [120.0, 100.0], "radius": 0.5},
    "motion.held": [],
    "boundary": {
        "left": {"type": "free_field"},
        "right": {"type": "free_field"},
        "bottom": {"type": "viscous_input", "wave_s": "pulse", "half_mass": True},
    },
    "hole": [{"name": "tunnel", "type": "circle", "centre": [60.0, 50.0], "radius": 8.0}],
    "monitor": [{"name": "crown", "position": [60.0, 58.5]}],
}
OUTSIDE = {"type": "outside"}


def test_waves_from_below_enter_through_the_continuum_where_the_sides_have_one(bar) -> None:
    case = bar(TUNNEL)
    through = {"boundary.bottom": {"type": "outside", "wave_s": "pulse"}}
    around = {"boundary.left": OUTSIDE, "boundary.right": OUTSIDE, **through}
    assert defaults(case)["left, right and bottom outside"] == around
    periodic = {f"boundary.{side}": {"type": "periodic"} for side in ("left", "right")}
    assert defaults(bar(TUNNEL | periodic))["bottom outside"] == through
    found = list(defaults(with_changes(case, around)))  # other sides would need another base
    assert not any("viscous" in name or "free" in name or name.endswith("bottom outside") for name in found)


def test_a_box_round_holes_is_a_choice_where_it_saves_much(bar) -> None:
    case = bar(TUNNEL)
    (changes,) = (changes for name, changes in defaults(case).items() if name.startswith("box"))
    (left, bottom), (wide, high) = changes["packing"]["origin"], changes["packing"]["size"]
    assert changes["ground.size"] == [120.0, 100.0]
    assert (left + 0.5 * wide, bottom + 0.5 * high) == (60.0, 50.0)
    assert 16.0 < wide < 60.0
    sides = {side: changes[f"boundary.{side}"] for side in ("left", "right", "top")}
    assert sides == dict.fromkeys(sides, OUTSIDE)
    assert changes["boundary.bottom"] == {"type": "outside", "wave_s": "pulse"}
    assert not any(name.startswith("box") for name in defaults(with_changes(case, changes)))  # it is one
    far = {"name": "far", "position": [0.5, 99.5]}  # in the layer that absorbs
    assert not any(name.startswith("box") for name in defaults(with_changes(case, {"monitor": [far]})))


def test_coarser_disks_fill_the_same_extent_where_bricks_are_counted(bar) -> None:
    case = bar({"packing": {"pattern": "A", "radius": 0.25, "bricks": [24, 12]}, "monitor": []})
    coarser = {name: changed(case, each).packing for name, each in defaults(case).items() if "radius" in name}
    assert {packing.radius for packing in coarser.values()} == {0.375, 0.5}
    assert all(packing.extent == case.packing.extent for packing in coarser.values())


def test_of_bars_all_methods_with_all_spacings(spalling) -> None:
    case = spalling({"run": {"duration": 1.5e-3, "time_step": 1e-6}})
    found = defaults(case)
    assert next(iter(found.items())) == ("as in the case", {})
    others = list(found.values())[1:]
    assert {changes["bar.spacing"] for changes in others} == {0.025, 0.03125, 0.05}
    types = [changes["method"]["type"] for changes in others if changes["bar.spacing"] == 0.05]
    assert types == ["finite_difference", "finite_difference", "peridynamics", "switch", "patch"]
    assert [changes["run"] for changes in others[:2]] == [
        {"duration": 1.5e-3, "courant": 1.0},
        {"duration": 1.5e-3},  # automatic
    ]


@pytest.mark.parametrize("step", [{"safety": 0.5}, {"courant": 0.3}])
def test_all_choices_are_valid_whatever_step_the_bar_has(spalling, step) -> None:
    case = spalling({"run": {"duration": 1.5e-3, **step}})
    choices, left_out = choices_of(case, defaults(case))
    assert not left_out
    steps = {(choice.case.run.courant, choice.case.run.time_step, choice.case.run.safety) for choice in choices[1:]}
    assert steps == {(1.0, "auto", 0.9), (None, "auto", step.get("safety", 0.9))}


def test_methods_have_the_keys_of_the_case_which_counts_once(spalling) -> None:
    case = spalling({"method": {"type": "switch", "horizon": 5, "trigger": 0.8, "corrected_ends": True}})
    methods = {changes["method"]["type"]: changes["method"] for changes in list(defaults(case).values())[1:]}
    assert methods == {
        "finite_difference": {"type": "finite_difference"},
        "peridynamics": {"type": "peridynamics", "horizon": 5, "corrected_ends": True},
        "switch": {"type": "switch", "horizon": 5, "trigger": 0.8, "corrected_ends": True},
        "patch": {"type": "patch", "horizon": 5, "trigger": 0.8},
    }
    # methods that wait for a break are for bars that can break
    whole = with_changes(spalling(), {"bar": {"length": 1.0, "spacing": 0.025, "density": 2500.0, "wave_speed": 1e3}})
    types = {changes["method"]["type"] for changes in list(defaults(whole).values())[1:]}
    assert types == {"finite_difference", "peridynamics"}
    method = {"type": "peridynamics", "horizon": 2, "corrected_ends": True}
    own = spalling({"method": method, "run": {"duration": 1.5e-3}})
    choices, _ = choices_of(own, defaults(own))
    assert choices[0].name == "as in the case"
    assert len([choice for choice in choices if choice.case.method == own.method]) == 3  # one for each spacing
