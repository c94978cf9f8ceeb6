"""Errors of histories beside those of a reference."""

import numpy as np
import pytest

from dembound.accuracy.choice import Choice
from dembound.accuracy.reference import Reference, Requested, errors
from dembound.accuracy.runner import Run
from dembound.errors import CaseError
from dembound.formulas.history import History


def gauge(samples: int, x: float = 1.0, y: float = 0.0, place: float = 0.0, after: float = 0.0) -> History:
    """A motion of a second along both axes with these factors; y is added to by `after` from 0.5 s on."""
    time = np.linspace(0.0, 1.0, samples)
    shape = np.sin(np.pi * time)
    motion = np.column_stack([x * shape, y * shape + after * (time > 0.5), 0.0 * time])
    return History.of(np.array([place, 0.0]), time, 2.0 * motion, motion, 3.0 * motion[:, 0])


@pytest.fixture
def compared(bar):
    """Compares gauges with those of a reference."""

    def compare(found, expected, until: float = np.inf, **requested):
        choice = Choice("it", {}, bar())
        reference = Reference("finest", "the finest", lambda choice, outcome: expected, until=until)
        return errors(choice, Run(motions=found), reference, Requested(**requested))

    return compare


def test_the_worst_monitor_comes_first(compared) -> None:
    found = compared(
        {"a": gauge(101, 1.1, place=3.0), "b": gauge(101, 1.2)}, {"a": gauge(101, place=2.5), "b": gauge(101)}
    )
    assert [(each.monitor, each.component) for each in found] == [("b", "x"), ("a", "x")]
    assert [each.rms for each in found] == pytest.approx([0.2, 0.1])
    assert [each.peak for each in found] == pytest.approx([0.2, 0.1])
    assert [each.apart for each in found] == [0.0, 0.5]
    assert compared({"a": gauge(101, place=0.1 + 0.2)}, {"a": gauge(101, place=0.3)})[0].apart == 0.0  # rounding


def test_the_finer_history_is_interpolated(compared) -> None:
    # between 11 samples a sine that is interpolated is up to (π/10)²/8 = 1.2 % too small; at the samples it is exact
    assert compared({"a": gauge(11)}, {"a": gauge(1001)})[0].rms < 1e-12
    assert compared({"a": gauge(1001)}, {"a": gauge(11)})[0].rms < 1e-12


def test_the_component_is_that_of_the_reference_or_the_one_asked_for(compared) -> None:
    mine, theirs = {"a": gauge(101, 9.0, 1.5)}, {"a": gauge(101, 0.9, 1.0)}
    assert compared(mine, theirs)[0].rms == pytest.approx(0.5)
    assert compared(mine, theirs, component="x")[0].rms == pytest.approx(9.0)
    for quantity, component in (("displacement", "x"), ("stress", "stress")):
        (found,) = compared({"a": gauge(101, 1.1)}, {"a": gauge(101)}, quantity=quantity)
        assert (found.component, found.rms) == (component, pytest.approx(0.1))


def test_quiet_monitors_are_left_out_but_not_if_asked_for(compared) -> None:
    mine, theirs = {"a": gauge(101, 1.1), "far": gauge(101, 0.005)}, {"a": gauge(101), "far": gauge(101, 0.001)}
    assert [each.monitor for each in compared(mine, theirs)] == ["a"]
    assert compared(mine, theirs, monitor="far")[0].rms == pytest.approx(4.0)


def test_histories_are_compared_up_to_the_first_spall(compared) -> None:
    mine, theirs = {"a": gauge(101, 0.0, 1.1, after=5.0)}, {"a": gauge(101, 0.0, 1.0)}
    assert compared(mine, theirs)[0].rms > 1.0
    assert compared(mine, theirs, until=0.5)[0].rms == pytest.approx(0.1)
    # what moves later does not choose monitors and components either
    late = gauge(101, 1.0, after=50.0)  # along y from 0.5 s on
    found = compared({"a": gauge(101, 1.1), "b": gauge(101, 1.2)}, {"a": late, "b": gauge(101)}, until=0.5)
    assert [(each.monitor, each.component) for each in found] == [("b", "x"), ("a", "x")]
    for still, until in ((gauge(101), 0.0), (gauge(101, 0.0), np.inf)):
        with pytest.raises(CaseError, match="zero in the reference"):
            compared({"a": gauge(101)}, {"a": still}, until=until)
