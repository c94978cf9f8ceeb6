"""The choices of a chart: from the table [chart], and the choices when case and command give none."""

import h5py
import numpy as np
import pytest
from scene_tables import lattice, monitors
from small_cases import around

from dembound.accuracy.chart.record import Record
from dembound.accuracy.chart.study import TIE, Point, alike, cheapest_within, defaults, from_table, front, points_of
from dembound.accuracy.choice import changed, choices_of
from dembound.accuracy.runner import Run
from dembound.errors import CaseError, RecordError
from dembound.formulas.history import History
from dembound.kinds import with_changes
from dembound.motion.kind import Finding


def test_the_table_gives_choices(bar) -> None:
    free = {"boundary.right": {"type": "free"}}
    case = bar({"chart": {"vary": {"run.safety": [0.5, 0.9]}, "choice": [{"name": "free", "set": free}]}})
    assert from_table(case) == {"safety 0.5": {"run.safety": 0.5}, "safety 0.9": {"run.safety": 0.9}, "free": free}
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
    "packing": lattice(120.0, 100.0, 1.0),
    "motion.held": [],
    "boundary": around("free_field", "left", "right")
    | {"bottom": {"type": "viscous_input", "wave_s": "pulse", "half_mass": True}},
    "hole": [{"name": "tunnel", "type": "circle", "centre": [60.0, 50.0], "radius": 8.0}],
    "monitor": monitors(crown=(60.0, 58.5)),
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
    far = {"monitor": monitors(far=(0.5, 99.5))}  # in the layer that absorbs
    assert not any(name.startswith("box") for name in defaults(with_changes(case, far)))


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
    steps = [{"duration": 1.5e-3, "courant": 1.0}, {"duration": 1.5e-3}]  # and automatic
    assert [changes["run"] for changes in others[:2]] == steps


@pytest.mark.parametrize("step", [{"safety": 0.5}, {"courant": 0.3}])
def test_all_choices_are_valid_whatever_step_the_bar_has(spalling, step) -> None:
    case = spalling({"run": {"duration": 1.5e-3, **step}})
    choices, left_out = choices_of(case, defaults(case))
    assert not left_out
    steps = {(choice.case.run.courant, choice.case.run.time_step, choice.case.run.safety) for choice in choices[1:]}
    assert steps == {(1.0, "auto", 0.9), (None, "auto", step.get("safety", 0.9))}


@pytest.mark.parametrize(
    ("points", "expected"),
    [
        ([(0.1, 1.0), (0.05, 4.0), (0.2, 2.0), (0.01, 16.0), (0.01, 64.0)], [3, 1, 0]),
        # three sides of one scene: the times differ by 20 %, which a busy machine may add
        ([(0.1, 1.0), (0.05, 1.1), (0.2, 0.92)], [1]),
        ([(0.1, 1.0), (0.05, 1.3), (0.2, 0.9)], [1, 0]),
        # nothing is left of errors that cannot be drawn, and errors within a twentieth are one
        ([(1e-14, 1.0), (1e-16, 4.0)], [0]),
        ([(0.1000, 1.0), (0.0970, 4.0)], [0]),
        ([(0.1000, 1.0), (0.0930, 4.0)], [1, 0]),
        # at one place all are on the front
        ([(0.1, 1.0), (0.1, 1.0), (0.2, 1.0)], [0, 1]),
    ],
)
def test_the_front_is_of_those_that_none_dominates(points: list[tuple[float, float]], expected: list[int]) -> None:
    assert front(points_of(*zip(*points, strict=True))) == expected


@pytest.mark.parametrize("seed", range(4))
def test_all_that_is_dominated_is_off_the_front_and_nothing_else(seed: int) -> None:
    rng = np.random.default_rng(seed)
    errors, costs = 10.0 ** rng.uniform(-8, 0, 30), 10.0 ** rng.uniform(-2, 0, 30)
    errors[rng.integers(30, size=5)], costs[rng.integers(30, size=5)] = errors[0], costs[0]
    points = points_of(errors, costs)
    on = set(front(points))
    for k, (error, cost) in enumerate(points):
        others = [other for other in points if other != (error, cost)]
        assert (k in on) == (not any(other.error <= error and other.cost <= cost for other in others))
        if k not in on:  # what dominates it, or what dominates that, is on the front
            assert any(points[n].error <= error and points[n].cost <= cost for n in on)
    for level in (1e-9, 1e-4, 1e-2, 1.0):
        found = cheapest_within(points, level)
        assert found is None or found in on


def test_groups_are_of_the_nearest_and_no_wider_than_the_ratio() -> None:
    # a chain in which each is within 1.2 of the next: 1.1 and 1.15 first, then with 1.0, as 1.15 < 1.25; 1.35 is apart
    assert alike(np.array([1.35, 1.0, 1.15, 1.1]), TIE) == [1.35, 1.1, 1.1, 1.1]
    assert alike(np.array([0.3, 3.0]), TIE) == [0.3, 3.0]


def test_of_equal_costs_the_most_accurate_then_the_first_is_named() -> None:
    points = [Point(0.1, 1.0), Point(0.05, 4.0), Point(0.01, 16.0), Point(0.01, 16.0), Point(0.02, 16.0)]
    assert [cheapest_within(points, level) for level in (0.2, 0.06, 0.01, 0.001)] == [0, 1, 2, None]
    assert cheapest_within([Point(0.1, 1.0), Point(0.15, 0.2)], 0.2) == 1
    assert cheapest_within([Point(0.15, 1.0), Point(0.1, 1.0)], 0.2) == 1


KEY = "12ab"
GAUGE = f"runs/{KEY}/gauges/top"


@pytest.fixture
def record(tmp_path) -> Record:
    """A run of a case with one monitor, and its cost."""
    history = History.of(np.array([1.0, 0.0]), np.arange(4.0), np.ones((4, 3)), np.zeros((4, 3)), np.zeros(4))
    outcome = Run("", 1.0, 2.0, 3, 4, 12, 1)
    outcome.motions, outcome.findings = {"top": history}, {"energy": Finding(0.5, "J")}
    record = Record(tmp_path / "chart.h5")
    record.add(KEY, outcome)
    record.add_cost(KEY, 0.25, 0.5)
    return record


def test_a_run_comes_back(record) -> None:
    assert record.get("other") is None
    found = record.get(KEY)
    assert (found.failure, found.time_step, found.steps, found.work) == ("", 1.0, 3, 12)
    assert (found.cpu, found.wall, found.findings) == ([0.25], [0.5], {"energy": Finding(0.5, "J")})
    assert np.array_equal(found.motions["top"].displacement, np.ones((4, 3)))
    with h5py.File(record.path, "a") as file:
        replaced(f"{GAUGE}/time", np.arange(4))(file)
    assert record.get(KEY).motions["top"].time.dtype == np.float64


def replaced(place, values):
    def change(file) -> None:
        del file[place]
        file[place] = values

    return change


def test_a_run_without_a_monitor_or_a_quantity_that_is_compared_is_refused(record) -> None:
    assert record.get(KEY, ["top"], "stress").work > 0
    with h5py.File(record.path, "a") as file:
        del file[f"{GAUGE}/stress"]
    with pytest.raises(RecordError, match="stress at top"):
        record.get(KEY, ["top"], "stress")
    with h5py.File(record.path, "a") as file:
        del file[GAUGE]
    with pytest.raises(RecordError, match="velocity at top"):
        record.get(KEY, ["top"])
