"""One row of a scene: its disks, what acts on them, and their places in the whole."""

import numpy as np
import pytest

from dembound.disks.ram import run_bytes
from dembound.disks.reduced.one_row import one_row
from dembound.disks.scene import build

INPUT = {"type": "viscous_input", "wave_p": "pulse"}


@pytest.fixture
def whole(bar):
    """20 × 5 disks under a load on the left half of the third row, and a wave."""
    held = {"packing.size": [10.0, 2.5], "motion.held": ["y"], "boundary.left": INPUT}
    load = {"name": "push", "region": [0.0, 1.1, 5.0, 1.4], "force": [1e6, 0.0]}
    monitors = [{"name": name, "position": place} for name, place in (("a", [0.1, 0.1]), ("b", [9.9, 2.4]))]
    return build(bar(held | {"load": [load, load | {"name": "shake", "wave": "pulse"}], "monitor": monitors}))


def test_each_disk_stands_for_those_above_and_below(whole) -> None:
    row = one_row(whole, 1)

    assert row.count == 20
    assert np.array_equal(row.positions[:, 0][row.like], whole.positions[:, 0])
    assert set(row.positions[:, 1].round(9)) == {1.25}  # the middle row, where the scene has it
    assert row.assembly.pairs[row.assembly.contact_type == 1].tolist() == [[k, k] for k in range(20)]
    values = np.arange(40.0).reshape(20, 2)
    assert np.array_equal(row.widened("speed", values), values[row.like])


def test_loads_and_supports_are_those_of_its_disks(whole) -> None:
    row = one_row(whole, 1)
    order = np.argsort(row.positions[:, 0])

    assert np.allclose(row.steady_load[0, order], [1e5] * 10 + [0.0] * 10, rtol=1e-15)
    assert not row.steady_load[1:].any()
    table = row.supports
    assert (np.diff(3 * table.node + table.component) > 0).all()
    # the wave and the load drive the left disk, the load nine more; both ends have dashpots
    assert len(table.drive) == 11
    assert np.array_equal(np.unique(table.node[table.drive_row]), np.sort(order[:10]))
    assert np.array_equal(np.unique(table.node[table.damping > 0.0]), np.sort(order[[0, -1]]))
    # in the whole scene the wave and the second load drive the disks of this row in the same way
    times = np.linspace(0.0, 0.01, 5)
    assert np.allclose(in_order(table, row, times), in_order(whole.supports, whole, times), rtol=1e-15)


def in_order(table, scene, times):
    """Drives of the disks of the third row at some times, from left to right, by component."""
    in_row = np.flatnonzero(np.abs(scene.positions[table.node, 1] - 1.25) < 1e-9)
    order = np.lexsort((table.component[in_row], scene.positions[table.node[in_row], 0]))
    return table.sample(times, 0.0)[:, in_row[order]]


def test_sides_and_monitors_are_found_in_it(whole) -> None:
    row = one_row(whole, 1)

    assert set(row.monitors) == {"a", "b"}
    for name, node in row.monitors.items():
        assert row.positions[node, 0] == whole.positions[whole.monitors[name], 0]
    for side, edge in whole.edges.items():
        places = np.broadcast_to(row.positions[row.tracked, 0][:, None, None], (len(row.tracked), 3, 2))
        assert np.array_equal(row.side_peaks(side, places)[:, 0, 0], edge.positions[:, 0])
    assert set(row.edges) == {"left", "right"}


def test_columns_are_rows_of_an_upright_scene(whole) -> None:
    column = one_row(whole, 0)

    assert column.count == 5
    assert np.array_equal(column.widened("height", column.positions[:, 1]), whole.positions[:, 1])
    assert set(column.edges) == {"bottom", "top"}


def test_memory_counts_the_whole_scene_too(whole) -> None:
    row = one_row(whole, 1)

    assert row.largest_memory == run_bytes(whole.case, [whole.sizes, row.sizes])
    assert row.largest_memory > run_bytes(whole.case, [row.sizes])


def test_a_scene_with_a_hole_has_no_equal_rows(bar) -> None:
    hole = [{"name": "gap", "type": "circle", "centre": [5.25, 0.75], "radius": 0.1}]

    assert one_row(build(bar({"packing.size": [10.0, 1.5], "hole": hole, "monitor": []})), 1) is None
