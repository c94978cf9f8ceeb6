"""A damaged record is refused in one line, or read as it was written; nothing else is ever read from it.

This needs checksums of all data (``fletcher32``), of all metadata (a file format from HDF5 1.10 on), and texts of fixed
length: those of variable length are in heaps without a checksum, in which HDF5 may search for ever.
"""

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from small_cases import PUSHED, SPALLING, small

from dembound.errors import RecordError
from dembound.gauge.gauge_io import read_gauge
from dembound.kinds import kind_of_record
from dembound.motion.energy import Ledger
from dembound.motion.simulation import Simulation
from dembound.plot.energy import plot_energy
from dembound.plot.histories import plot_histories
from dembound.plot.side import plot_boundary
from dembound.results.compare import compare
from dembound.results.recorder import Recorder
from dembound.results.recording import Histories, Snapshots
from dembound.results.results import Results
from dembound.results.vtk import write_paraview
from dembound.running import plan

GAUGED = {"packing.size": [4.0, 1.0], "monitor": [{"name": "gauge", "position": [2.4, 0.5]}], "run.duration": 0.005}
"""Changes of a lattice, with a monitor of the name that the bar has."""


@pytest.fixture(params=[(SPALLING, {}), (PUSHED, GAUGED)], ids=["bar", "disks"])
def record(request, tmp_path) -> Path:
    """The record of a run with histories, two snapshots, a ledger, and of the bar cracks."""
    tables, changes = request.param
    planned = plan(small(tables, changes=changes))
    half = planned.steps // 2
    simulation = Simulation(planned.scene, planned.time_step, planned.scene.probes)
    ledger = Ledger(simulation, half)
    path = tmp_path / "sound" / "run.h5"
    path.parent.mkdir()
    with Recorder(path, simulation, planned.step_limit, ledger=ledger) as recorder:
        simulation.track(Histories(recorder), Snapshots(recorder, 2, 2 * half), ledger)
        simulation.run(2 * half)
    return path


def contents(path: Path) -> Iterator[tuple[str, Any]]:
    """All contents of a record that readers use, by name."""
    results = Results(path)
    yield "attributes", results.attributes
    yield "laws", results.laws
    yield from results.energy.items()
    groups = {"particles": results.particles, "cracks": results.cracks, **results.histories, **results.boundaries}
    for name, arrays in (groups | {str(number): each for number, each in enumerate(results.snapshots)}).items():
        yield f"{name} attributes", arrays.attributes
        yield from ((f"{name}/{key}", values) for key, values in arrays.items())


def drawn(path: Path, sound: Path) -> None:
    """All outputs of the commands from a record that Python results do not have."""
    kind = kind_of_record(path)
    plot_histories([path])
    plot_energy(path)
    compare(sound, [path], "velocity")
    write_paraview(path, path.parent / "paraview", kind)
    list(kind.pictures(path))
    kind.moving_picture(path, None, 1.0)
    if kind.name == "bar":
        read_gauge(path)
    else:
        plot_boundary([path], "right")


def outcome(read: Callable[[], Any]) -> Any:
    """The result of `read`, or None for a record that is refused, in one line and with exit code 5."""
    try:
        return read()
    except RecordError as error:
        refusal = error
    assert refusal.exit_code == 5
    assert len(str(refusal).splitlines()) == 1
    return None


@pytest.mark.parametrize("count", [30, pytest.param(500, marks=pytest.mark.slow)])  # of each kind
def test_a_damaged_record_is_refused_or_read_as_it_was(
    count: int, sweep, damaged, record: Path, tmp_path: Path
) -> None:
    expected = list(contents(record))
    drawn(record, record)
    path = tmp_path / "run.h5"
    found: list[bool] = []

    @sweep(count)
    @given(damaged(record.read_bytes()))
    def each(new: bytes) -> None:
        path.write_bytes(new)
        seen = outcome(lambda: list(contents(path)))
        found.append(seen is not None)
        if seen is not None:
            assert_equal(seen, expected)
        if len(found) % 15 == 1:
            outcome(lambda: drawn(path, record))

    each()
    assert sum(found) < 0.5 * len(found)


def assert_equal(seen: Sequence[tuple[str, Any]], expected: Sequence[tuple[str, Any]]) -> None:
    """The same names, numbers and texts."""
    assert [name for name, _ in seen] == [name for name, _ in expected]
    for (_, one), (_, other) in zip(seen, expected, strict=True):
        np.testing.assert_equal(one, other)
