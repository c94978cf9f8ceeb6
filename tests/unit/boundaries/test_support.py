"""The support table: how rows of several sides become one row per degree of freedom."""

import numpy as np
import pytest

from dembound.boundaries.support import SupportBuilder, Supports

NODES = np.array([4, 2])


def ramp(times: np.ndarray) -> np.ndarray:
    return times


def square(times: np.ndarray) -> np.ndarray:
    return times**2


def row(table: Supports, node: int, component: int) -> int:
    """The number of the one row on a degree of freedom."""
    (found,) = np.flatnonzero((table.node == node) & (table.component == component))
    return int(found)


def test_one_row_per_node_sorted_by_node_with_numbers_or_arrays() -> None:
    builder = SupportBuilder(held=(0, 2))  # which leave no rows, as sides without particles
    for component in range(3):
        builder.add(NODES, component, damping=np.array([40.0, 20.0]), stiffness=3.0)
    builder.add(np.zeros(0, dtype=np.int64), 1, damping=1.0)
    table = builder.table()

    assert len(table) == 2
    assert (table.node.tolist(), table.component.tolist()) == ([2, 4], [1, 1])
    assert (table.damping.tolist(), table.stiffness.tolist()) == ([20.0, 40.0], [3.0, 3.0])
    assert len(table.drive) == 0
    assert not table.prescribed.any()
    empty = SupportBuilder().table()
    assert len(empty) == 0
    assert empty.sample(np.zeros(3), 0.5).shape == (3, 0)


def test_forces_and_drives_of_sides_add_up_at_a_corner() -> None:
    builder = SupportBuilder()
    builder.add(NODES, 0, damping=10.0, stiffness=100.0, drive=np.array([4.0, 2.0]), signal=ramp)
    builder.add(np.array([2, 3]), 0, damping=20.0, stiffness=200.0, drive=10.0, signal=square)
    builder.add(np.array([2, 3]), 1, damping=5.0)
    builder.add(np.array([2]), 0, drive=100.0, signal=ramp)
    table = builder.table()
    values = table.sample(np.array([0.0, 3.0]), half_step=0.5)

    assert len(table) == 5
    corner = row(table, 2, 0)
    assert (table.damping[corner], table.stiffness[corner]) == (30.0, 300.0)
    assert table.damping[row(table, 4, 0)] == 10.0
    assert table.damping[row(table, 2, 1)] == 5.0
    # at t = 3: 2·3 + 10·9 + 100·3 where all three meet, 4·3 elsewhere
    assert values[:, corner].tolist() == [0.0, 396.0]
    assert values[:, row(table, 4, 0)].tolist() == [0.0, 12.0]


def test_forces_are_sampled_at_whole_steps_and_prescribed_velocities_half_a_step_later() -> None:
    builder = SupportBuilder()
    builder.add(np.array([1]), 0, drive=2.0, signal=ramp)
    builder.add(np.array([2]), 0, drive=2.0, signal=ramp, prescribed=True)
    values = builder.table().sample(np.array([1.0, 2.0]), half_step=0.25)

    assert values.tolist() == [[2.0, 2.5], [4.0, 4.5]]


@pytest.mark.parametrize("prescribed_first", [True, False])
def test_a_prescribed_row_outranks_forces(prescribed_first: bool) -> None:
    builder = SupportBuilder()
    rows = [
        {"drive": 1.0, "signal": ramp, "prescribed": True},
        {"damping": 2.0, "stiffness": 3.0, "drive": 4.0, "signal": square},
    ]
    for each in rows if prescribed_first else rows[::-1]:
        builder.add(np.array([7]), 1, **each)
    table = builder.table()

    assert table.prescribed.tolist() == [True]
    assert (table.damping[0], table.stiffness[0]) == (0.0, 0.0)
    assert table.sample(np.array([3.0]), half_step=0.0).tolist() == [[3.0]]


def test_of_two_prescribed_rows_the_moving_one_wins_and_of_two_moving_ones_the_first() -> None:
    moving, still, other = {"drive": 5.0, "signal": ramp}, {}, {"drive": 1.0, "signal": square}
    for rows, expected in (((moving, still), 10.0), ((still, moving), 10.0), ((other, moving), 4.0)):
        builder = SupportBuilder()
        for each in rows:
            builder.add(np.array([7]), 0, prescribed=True, **each)
        assert builder.table().sample(np.array([2.0]), half_step=0.0).tolist() == [[expected]]


class Powers:
    """Three signals t, t² and t³."""

    count = 3

    def __call__(self, times: np.ndarray, half_step: float) -> np.ndarray:
        return times[:, None] ** [1.0, 2.0, 3.0] + 100.0 * half_step


def test_forces_that_are_computed_together_act_on_their_own_rows_and_sides() -> None:
    builder = SupportBuilder(held=(2,))
    builder.side = "bottom"
    builder.add_forces(np.array([4, 2, 7]), np.array([1, 0, 2]), Powers())
    builder.add(np.array([2]), 0, drive=10.0, signal=ramp)
    builder.add_power("bottom", ramp)
    table = builder.table()
    times = np.array([2.0, 3.0])
    values = table.sample(times, 0.5)

    assert len(table) == 2
    assert values[:, row(table, 4, 1)].tolist() == [52.0, 53.0]
    np.testing.assert_allclose(values[:, row(table, 2, 0)], times**2 + 50.0 + 10.0 * ramp(times))
    assert table.shares.power == {"bottom": 4}
    # they may be of several sides
    builder = SupportBuilder()
    sides = {"left": np.array([4]), "top": np.array([2, 7])}
    builder.add_forces(np.array([4, 2, 7]), np.array([1, 0, 0]), Powers(), sides)
    shares = builder.table().shares

    assert {(shares.sides[side], node) for side, node in zip(shares.side, shares.node, strict=True)} == {
        ("left", 4),
        ("top", 2),
        ("top", 7),
    }
    assert dict(zip(shares.node.tolist(), shares.signal.tolist(), strict=True)) == {4: 0, 2: 1, 7: 2}


def test_an_incident_wave_enters_by_twice_its_velocity_through_the_dashpot() -> None:
    builder = SupportBuilder()
    builder.add(NODES, 0, damping=np.array([3.0, 5.0]), incident=ramp)

    assert sorted(builder.table().drive) == [6.0, 10.0]  # 2Cv_i, Z eq. 6
