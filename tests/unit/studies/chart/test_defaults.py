"""The choices of a chart where none are given."""

import pytest

from dembound.kinds import load, with_changes
from dembound.shipped import folder, names
from dembound.studies.chart.choices import choices_of
from dembound.studies.chart.defaults import defaults


@pytest.mark.parametrize("name", names())
def test_every_shipped_case_has_some(name: str) -> None:
    case = load(folder() / f"{name}.toml")
    choices, _ = choices_of(case, defaults(case))
    assert len(choices) >= 4


def test_of_disks_one_thing_changes_at_a_time(bar) -> None:
    found = defaults(bar({"boundary.right.beta_p": 0.8}))
    assert found == {
        "as in the case": {},
        "radius 0.5 m": {"packing.radius": 0.5},  # ×1.25 and ×1.5 do not divide 10 m × 1 m
        "safety 0.45": {"run.safety": 0.45},
        "right viscoelastic": {"boundary.right": {"type": "viscoelastic", "distance": 5.0, "beta_p": 0.8}},
        "right free": {"boundary.right": {"type": "free"}},
    }


def test_rows_of_frames_are_coarsened_with_the_disks() -> None:
    case = load(folder() / "zhou2018" / "long_bar_c.toml")
    (changes,) = (changes for changes in defaults(case).values() if changes.get("packing.radius") == 0.3125)
    assert changes["packing.edge_radius"] == 1.25 * case.packing.edge_radius


def test_of_bars_all_methods_with_all_spacings(spalling) -> None:
    case = spalling({"run": {"duration": 1.5e-3, "time_step": 1e-6}})
    found = defaults(case)
    assert {changes["bar.spacing"] for changes in found.values()} == {0.025, 0.03125, 0.05}
    types = [changes["method"]["type"] for changes in found.values() if changes["bar.spacing"] == 0.05]
    assert types == ["finite_difference", "finite_difference", "peridynamics", "switch", "patch"]
    assert {changes["run.time_step"] for changes in found.values()} == {"auto"}


def test_methods_that_wait_for_a_break_are_for_bars_that_can_break(spalling) -> None:
    case = with_changes(spalling(), {"bar": {"length": 1.0, "spacing": 0.025, "density": 2500.0, "wave_speed": 1e3}})
    assert {changes["method"]["type"] for changes in defaults(case).values()} == {"finite_difference", "peridynamics"}
