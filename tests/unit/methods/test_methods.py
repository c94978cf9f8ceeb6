"""The methods for bars: what they begin with, what they answer, and for which stages the time step must serve."""

import numpy as np
import pytest
from pydantic import TypeAdapter

from dembound.casefile.types import MethodTable
from dembound.methods.rod import Rod

ROD = Rod.uniform(61, spacing=0.25, section=0.5, modulus=2e9, critical_stretch=1e-3)
LIMIT = 0.25e-3
"""Elongation of a spring at the critical stretch, m."""

adapter = TypeAdapter(MethodTable)


def method(type: str, **keys):
    return adapter.validate_python({"type": type, **keys})


def pulled(*planes: int, elongation: float = LIMIT) -> np.ndarray:
    """Displacements (n,) m that stretch these planes alone."""
    u = np.zeros(61)
    for k in planes:
        u[k + 1 :] += elongation
    return u


@pytest.mark.parametrize(
    ("keys", "name", "largest", "carrying"),
    [
        ({"type": "finite_difference"}, "finite differences", 1, 1),
        ({"type": "peridynamics", "horizon": 4}, "peridynamics, m = 4", 4, 4),
        ({"type": "switch", "horizon": 3, "before": "peridynamics"}, "peridynamics, m = 1", 3, 1),
        ({"type": "patch", "horizon": 3}, "finite differences", 3, 1),
    ],
    ids=str,
)
def test_what_a_method_does_at_first(keys: dict, name: str, largest: int, carrying: int) -> None:
    found = method(**keys)

    assert (found.name, found.largest_horizon, len(found.begin(ROD).shares(ROD.ranges[0]))) == (name, largest, carrying)
    # the first stage is what it begins with
    assert np.array_equal(found.stages(ROD)[0].stiffness(), found.begin(ROD).stiffness())


@pytest.mark.parametrize("corrected", [False, True])
def test_peridynamics_never_asks(corrected: bool) -> None:
    found = method("peridynamics", horizon=3, corrected_ends=corrected)
    bonds = found.begin(ROD)

    assert bonds.zones == [(0, 61)]
    assert not bonds.triggers.any()
    assert np.flatnonzero(bonds.spring).tolist() == ([0, 1, 2, 57, 58, 59] if corrected else [])


@pytest.mark.parametrize(
    ("before", "corrected"), [("finite_difference", False), ("peridynamics", False), ("peridynamics", True)]
)
def test_a_switch_turns_into_peridynamics_all_over(before: str, corrected: bool) -> None:
    found = method("switch", horizon=3, before=before, trigger=0.8, corrected_ends=corrected)
    bonds = found.begin(ROD)
    soft = before == "peridynamics" and not corrected
    whole = ROD.springs[0]
    assert bonds.spring[[0, 1, -1]].tolist() == [whole * (0.5 if soft else 1.0), whole, bonds.spring[0]]
    assert bonds.triggered(pulled(30, elongation=0.81 * LIMIT)).tolist() == [30]
    name = found.on_trigger(bonds, pulled(30, elongation=0.81 * LIMIT))

    after = method("peridynamics", horizon=3, corrected_ends=corrected).begin(ROD)
    for part in ("spring", "spring_limit", "triggers", "bond", "bond_broken"):
        assert np.array_equal(getattr(bonds, part), getattr(after, part)), part
    assert name == "peridynamics, m = 3"
    assert np.array_equal(found.stages(ROD)[1].stiffness(), after.stiffness())


def test_a_patch_lays_zones_around_all_that_asks() -> None:
    found = method("patch", horizon=2, reach=3, trigger=0.8)
    bonds = found.begin(ROD)
    name = found.on_trigger(bonds, pulled(20, 50, elongation=0.8 * LIMIT))

    # three horizons of two beyond the two nodes of the spring
    assert bonds.zones == [(14, 28), (44, 58)]
    assert name == "finite differences and peridynamics, m = 2"
    assert not bonds.triggers[[20, 50]].any()


@pytest.mark.parametrize(("beyond", "zone"), [(-1, (11, 41)), (0, (10, 41)), (1, (15, 41)), (2, (14, 41))], ids=str)
def test_a_patch_grows_alike_to_the_left_and_to_the_right(beyond: int, zone: tuple[int, int]) -> None:
    found = method("patch", horizon=2, reach=2)
    zones = []
    for place, plane in (((21, 41), 20 - beyond), ((20, 40), 39 + beyond)):
        bonds = found.begin(ROD)
        bonds.add_zone(*place)
        found.on_trigger(bonds, pulled(plane))
        zones += bonds.zones

    # by half of its twenty nodes beyond the spring where this is its own or stands across its edge; two springs further
    # out it is not the zone's, and what it makes reaches two horizons beyond it. Nodes a to b − 1 seen in a mirror are
    # 61 − b to 60 − a
    assert zones == [zone, (61 - zone[1], 61 - zone[0])]


@pytest.mark.parametrize("horizon", [1, 3, 8])
@pytest.mark.parametrize("plane", [0, 30])
def test_what_a_patch_has_answered_does_not_ask_again(horizon: int, plane: int) -> None:
    found = method("patch", horizon=horizon, reach=1, trigger=1.0)
    bonds = found.begin(ROD)
    u = pulled(plane)
    found.on_trigger(bonds, u)

    # or a run would stand still
    assert bonds.triggered(u).size == 0


def test_a_patch_is_stable_wherever_it_may_stand() -> None:
    stages = method("patch", horizon=3, reach=2).stages(ROD)

    assert [stage.zones for stage in stages] == [[], [(23, 37)], [(0, 14)], [(47, 61)], [(0, 61)]]
    # a bar shorter than a patch is one
    assert method("patch", horizon=3, reach=20).stages(ROD)[1].zones == [(0, 61)]
