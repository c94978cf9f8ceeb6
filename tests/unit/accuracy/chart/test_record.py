"""The runs of a chart in its record: written runs are read back, and other groups are not taken for runs."""

import h5py
import numpy as np
import pytest

from dembound.accuracy.chart.record import Record
from dembound.accuracy.runner import Run
from dembound.errors import RecordError
from dembound.formulas.history import History
from dembound.motion.kind import Finding

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


def described(place, name, value):
    return lambda file: file[place].attrs.__setitem__(name, value)


def replaced(place, values):
    def change(file) -> None:
        del file[place]
        file[place] = values

    return change


@pytest.mark.parametrize(
    "change",
    [
        *(described(f"runs/{KEY}", "steps", value) for value in ("x", np.ones(2))),
        *(described(f"runs/{KEY}", "threads", value) for value in (np.nan, -1, h5py.Empty("f8"))),
        described(f"runs/{KEY}", "failure", 3.0),
        described(GAUGE, "position", [1.0, np.nan]),
        *(replaced(f"{GAUGE}/time", np.array(times)) for times in ([0, 2, 1, 3.0], [0, 1, 2, 1e300], [0, 1, 2.0])),
        replaced(f"{GAUGE}/velocity", np.zeros((4, 2))),
        *(replaced(f"{GAUGE}/stress", values) for values in (np.full(4, np.nan), ["a"] * 4)),
        *(replaced(f"runs/{KEY}/cpu", np.array(costs)) for costs in ([-1.0], [[1.0]])),
        lambda file: file[f"runs/{KEY}"].__delitem__("wall"),
        lambda file: file[GAUGE].__delitem__("velocity"),
        lambda file: file[f"runs/{KEY}"].__setitem__("more", h5py.SoftLink("/")),
    ],
)
def test_what_no_chart_has_written_is_refused_in_a_line(record, change) -> None:
    with h5py.File(record.path, "a") as file:
        change(file)
    with pytest.raises(RecordError) as refused:
        record.get(KEY)
    assert len(str(refused.value).splitlines()) == 1


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
