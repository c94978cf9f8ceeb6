"""Trackers that write a run to its record, and the curve of a laboratory test."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from dembound.motion.state import Arrays
from dembound.motion.trackers import NEVER, Run, Tracker
from dembound.results.reader import finite, open_record, snapshots_of
from dembound.results.recorder import Recorder

if TYPE_CHECKING:
    import h5py


class Histories(Tracker):
    """Writes the motion of the monitors, and broken bonds, after every block of steps."""

    name = "histories"

    def __init__(self, recorder: Recorder) -> None:
        self.recorder = recorder

    def handle(self, run: Run) -> None:
        """Do nothing: histories are never due at a step."""

    def observe(self, run: Run, record: np.ndarray) -> None:
        """Append the record."""
        self.recorder.append(record)


class Snapshots(Tracker):
    """Writes the whole scene at some steps.

    Parameters
    ----------
    recorder : writes the file.
    number : of snapshots in `steps`, evenly spaced, the last one at the end; a longer run continues at this spacing.
    steps : of the run as it was begun. at_rest : whether a static stage precedes it, whose state is written first, at
    step 0, besides these.
    """

    name = "snapshots"

    def __init__(self, recorder: Recorder, number: int, steps: int, *, at_rest: bool = False) -> None:
        self.recorder = recorder
        self._number, self._steps = min(number, steps), steps
        self._last, self._next, self._is_open = -1, NEVER, False
        self._after(-1)
        if at_rest and number > 0:
            self._next = 0
        self.due = self._next

    def _after(self, step: int) -> None:
        """Set the first snapshot after this step: at the first k·steps/number, rounded down, above it."""
        later = -(-(step + 1) * self._number // self._steps)
        self._next = self._steps * max(1, later) // self._number if self._number > 0 else NEVER

    def handle(self, run: Run) -> None:
        """Give the snapshot of the step before, if any, the velocities of its time, and write that of this step."""
        self.complete()
        if self._next <= run.state.step:
            self.recorder.snapshot()
            self._last, self._is_open = run.state.step, True
            self._after(run.state.step)
        self.due = run.state.step + 1 if self._is_open else self._next

    def complete(self) -> None:
        """Give the snapshot of the step before, if any, the velocities of its time."""
        if self._is_open:
            self.recorder.centre()
            self._is_open = False

    def take_last(self, run: Run) -> None:
        """Write the scene at the end of a run that ended early, unless just written or the run has no snapshots."""
        if self._number > 0 and self._last < run.state.step:
            self._next = run.state.step
            self.handle(run)

    def saved_arrays(self) -> Arrays:
        """The next snapshot, and whether one lacks the velocities of its time."""
        return {**super().saved_arrays(), "next": np.array(self._next), "is_open": np.array(self._is_open)}

    def restore(self, saved: Arrays) -> None:
        """Restore the arrays returned by `saved_arrays` in another run of the same case."""
        super().restore(saved)
        self._next, self._is_open = int(saved["next"]), bool(saved["is_open"])


TestName = Literal["ucs", "tension", "brazilian", "biaxial"]
"""Tests: uniaxial compression, direct tension, a disk between jaws, compression under a pressure at the sides."""

GAUGE = 0.5
"""Height and width of the part of the sample in which strains are measured, over its own: its middle."""


class Elastic(NamedTuple):
    """Young's modulus (Pa) and Poisson's ratio of the sample, as a two-dimensional body whose sides are free."""

    young: float
    poisson: float


@dataclass(frozen=True, eq=False)
class LoadingCurve:
    """A test: histories at k times of the platens, at g snapshots in the sample, and c broken bonds.

    Attributes
    ----------
    kind : of the test. time : (k,) s.
    stress : (k,) Pa, positive in the sense of the test: on the platens, of a Brazilian test the tension 2P/(πD) in the
    middle. pressure : Pa at the sides of a biaxial test, else 0.
    strain : (k,) by which the platens approach each other, in tension part, over the height between them.
    gauge_time : (g,) s. axial, lateral : (g,) mean strains of the middle of the sample, axial positive in the sense of
    the test, lateral positive if it widens in compression, or narrows in tension.
    crack_time : (c,) s, ascending, in the run. crack_shear : (c,) whether the bond broke in shear.
    before : bonds that broke before the run, under the pressure alone.
    """

    kind: TestName
    time: np.ndarray
    stress: np.ndarray
    pressure: float
    strain: np.ndarray
    gauge_time: np.ndarray
    axial: np.ndarray
    lateral: np.ndarray
    crack_time: np.ndarray
    crack_shear: np.ndarray
    before: int = 0

    @cached_property
    def at_peak(self) -> int:
        """Number of the time with the largest stress."""
        return int(np.argmax(self.stress))

    @property
    def strength(self) -> float:
        """The largest stress, Pa."""
        return float(self.stress[self.at_peak])

    @property
    def has_peak(self) -> bool:
        """Whether the stress beyond that at rest has fallen by a tenth after its peak."""
        last, peak = self.stress[-1] - self.pressure, self.strength - self.pressure
        return bool(last < 0.9 * peak)

    @property
    def first_crack(self) -> float:
        """Stress (Pa) at which the first bond breaks; nan if none does."""
        return self.stress_at(self.crack_time[0]) if len(self.crack_time) else np.nan

    @property
    def rate(self) -> float:
        """Strain rate of the platens at the peak, 1/s."""
        before = max(self.at_peak // 2, 0)
        span = self.time[self.at_peak] - self.time[before]
        return float((self.strain[self.at_peak] - self.strain[before]) / span) if span > 0.0 else np.nan

    def stress_at(self, time: float) -> float:
        """Stress (Pa) at a time (s)."""
        return float(np.interp(time, self.time, self.stress))

    def cracks(self, *, shear: bool, until: float = np.inf) -> int:
        """Number of bonds broken in shear, or in tension, up to a time (s)."""
        return int(np.count_nonzero((self.crack_shear == shear) & (self.crack_time <= until)))

    def elastic(self, low: float, high: float) -> Elastic:
        """Moduli from the slopes of the curve between two shares of its peak, before the peak.

        Axial strains are those of the middle of the sample, without the ends that platens stiffen. nan with fewer than
        two snapshots there.
        """
        stress = np.interp(self.gauge_time, self.time, self.stress) - self.pressure
        peak = self.strength - self.pressure
        inside = (stress >= low * peak) & (stress <= high * peak) & (self.gauge_time < self.time[self.at_peak])
        if np.count_nonzero(inside) < 2 or np.ptp(self.axial[inside]) == 0.0:
            return Elastic(np.nan, np.nan)
        young, _ = np.polyfit(self.axial[inside], stress[inside], 1)
        poisson, _ = np.polyfit(self.axial[inside], self.lateral[inside], 1)
        return Elastic(float(young), float(poisson))


def read_test(record: Path, kind: TestName, width: float, pressure: float = 0.0) -> LoadingCurve:
    """The curve of a test in the ``run.h5`` of its run; width : of the sample, m. pressure : Pa at its sides.

    Raises CaseError when the file cannot be read, RecordError for one that is damaged.
    """
    sense = 1.0 if kind == "tension" else -1.0
    with open_record(record) as file:
        top, bottom = (file[f"boundaries/{side}"] for side in ("top", "bottom"))
        force = 0.5 * sense * (finite(top["force"])[:, 1] - finite(bottom["force"])[:, 1])
        closed = sense * (finite(top["displacement"])[:, 1] - finite(bottom["displacement"])[:, 1])
        height = float(top["position"][:, 1].mean() - bottom["position"][:, 1].mean())
        times, axial, lateral = _strains(file, sense)
        cracks = file["cracks"]
        during = cracks["time"][:] > 0.0  # others broke before the test
        return LoadingCurve(
            kind=kind,
            time=finite(top["time"]),
            stress=force / width * (2.0 / np.pi if kind == "brazilian" else 1.0),
            pressure=pressure,
            strain=closed / height,
            gauge_time=times,
            axial=axial,
            lateral=lateral,
            crack_time=cracks["time"][:][during],
            crack_shear=cracks["shear"][:][during].astype(bool),
            before=int(np.count_nonzero(~during)),
        )


def _strains(file: h5py.File, sense: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times (g,) of the snapshots, and mean strains along y and x of the disks in the middle, least squares."""
    positions = file["particles/position"][:]
    low, high = positions.min(axis=0), positions.max(axis=0)
    from_middle = positions - 0.5 * (low + high)
    inside = (np.abs(from_middle) < 0.5 * GAUGE * (high - low)).all(axis=1)
    places = np.column_stack([np.ones(np.count_nonzero(inside)), from_middle[inside]])
    groups = list(snapshots_of(file))
    motion = [group["displacement"][:][inside, :2] for group in groups]
    slopes = np.array([np.linalg.lstsq(places, each, rcond=None)[0][1:] for each in motion]).reshape(-1, 2, 2)
    times = np.array([float(group.attrs["time"]) for group in groups])
    return times, sense * slopes[:, 1, 1], -sense * slopes[:, 0, 0]
