"""Ends of a run before its duration: past the peaks of forces on driven sides, all monitors silent, debris at rest."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from dembound.boundaries.edge import normal_axis
from dembound.boundaries.platen import driven_components
from dembound.motion.paths import Source
from dembound.motion.scene import Scene
from dembound.motion.trackers import Run, Tracker

ACROSS = 2.0
"""Times that the slowest driven wave crosses the longer side of the body, until the fall of a force is not a wave."""


@dataclass(frozen=True)
class PeakRule:
    """The rule for the end of a run: the forces on all driven sides have fallen, for a time.

    share : of the largest force so far, counted from that at the start, below which a force has fallen.
    hold : s, for which all forces must be below. earliest : s, before which the run does not end.
    """

    share: float
    hold: float
    earliest: float


def peak_rule(scene: Scene, sources: Sequence[Source]) -> PeakRule:
    """The rule for a case with ``until = "peak"``; scene : the whole one, with its sources.

    By default forces must be below for the time in which the slowest driven wave crosses the longer side of the body
    and comes back, so that reflections at the beginning of a test do not end it.
    """
    run = scene.case.run
    slowest = min((source.slowest for source in sources), default=np.inf)
    hold = run.peak_for or ACROSS * float(np.max(scene.size)) / slowest
    begin = max((source.start for source in sources), default=0.0)
    return PeakRule(run.peak_share, hold, begin + hold)


class Ending(Tracker):
    """Ends a run when what it watches has been quiet for longer than `hold`, counted from `earliest` on (s).

    It looks after every return of the loop without changing these returns, so histories have the same bits.
    """

    evolving: ClassVar[tuple[str, ...]] = ("due", "_peaks", "_last")

    def __init__(self, hold: float, earliest: float, time_step: float) -> None:
        self._hold, self._earliest = (int(np.ceil(time / time_step)) for time in (hold, earliest))
        self._peaks = np.zeros(0)  # so far
        self._last = -1  # step at which it was not quiet

    def _end(self, run: Run) -> None:
        """End the run if the last step at which it was not quiet is long ago."""
        if run.state.step - max(self._last, self._earliest) > self._hold:
            run.stopped = True


class Peak(Ending):
    """Ends a run when the forces on all driven sides have been below a share of their peaks for long enough."""

    name = "peak"
    evolving = (*Ending.evolving, "_first")

    def __init__(self, rule: PeakRule, scene: Scene, time_step: float) -> None:
        super().__init__(rule.hold, rule.earliest, time_step)
        self._share = rule.share
        names = list(scene.sides)
        each = [(names.index(side), axis) for side, axis in driven_components(scene.case.boundary) if side in names]
        self._side, self._axis = np.array(each, dtype=np.int64).reshape(-1, 2).T
        self._first = np.zeros(0)
        self._peaks = np.zeros(len(self._side))

    def observe(self, run: Run, record: np.ndarray) -> None:
        """Find the last sample at which any force was high, and end the run if that is long ago."""
        samples = run.side_samples
        force = samples.record[:, self._side, 3 + self._axis]
        if len(force) == 0:
            return
        if self._first.size == 0:
            self._first = force[0].copy()
        force = np.abs(force - self._first)
        so_far = np.maximum(np.maximum.accumulate(force, axis=0), self._peaks)
        high = np.flatnonzero((force >= self._share * so_far).any(axis=1))
        if len(high) > 0:
            self._last = int(samples.steps[high[-1]])
        self._peaks = so_far[-1]
        self._end(run)


@dataclass(frozen=True)
class RestRule:
    """The rule for the end of a run: what fell has been at rest for a time.

    hold : s, for which it must be. earliest : s, from which this counts.
    """

    hold: float
    earliest: float


def rest_rule(scene: Scene, sources: Sequence[Source]) -> RestRule:
    """The rule for a case with ``until = "rest"``; scene : the whole one, with its sources and a steady acceleration.

    Rest counts from when all waves have entered, all walls stand and the ground has changed for the last time.
    By default it must last as long as a free fall from the height of the body, in which whatever hangs loose would
    have fallen.
    """
    over = [source.over if np.isfinite(source.over) else source.start for source in sources]
    hold = scene.case.run.rest_for or float(np.sqrt(2.0 * scene.size[1] / scene.case.pull))
    return RestRule(hold, max([scene.case.last_change, *over]))


@dataclass(frozen=True)
class Silent:
    """The rule for the end of a run: all monitors silent for a time, after the waves of all sources have passed them.

    level : share of its own largest velocity so far below which a monitor is silent.
    hold : s, for which all must be silent.
    earliest : s, before which the run does not end.
    """

    level: float
    hold: float
    earliest: float


def silent_rule(scene: Scene, sources: Sequence[Source]) -> Silent:
    """The rule for a case with ``until = "silent"``; scene : the whole one, with its sources.

    The run goes on until the waves of every source have ended and reached every monitor, at the speed of the slowest;
    for a source that never ends, until they have begun. By default all monitors must be silent for the length of the
    longest wave, and long enough for a slow wave to travel from any monitor to any side and back, so that no echo is
    still on its way.
    """
    run, places = scene.case.run, monitored(scene)
    waves = [source.over - source.start for source in sources if np.isfinite(source.over)]
    slowest = min((source.slowest for source in sources), default=np.inf)
    ways = [np.abs(scene.plane(side) - places[:, normal_axis(side)]) for side in scene.edges]
    hold = run.silent_for or max(*waves, 0.0, 2.0 * float(np.max(ways, initial=0.0)) / slowest)
    return Silent(run.silent_level, hold, max((_passed(source, places) for source in sources), default=0.0))


def monitored(scene: Scene) -> np.ndarray:
    """Places (k, 2) m whose motion the case's monitors record, without those of a free-field column."""
    places = scene.monitored
    return np.array([places[monitor.name] for monitor in scene.case.monitor]).reshape(-1, 2)


def _passed(source: Source, places: np.ndarray) -> float:
    """Time (s) at which the waves of a source have come to all places (k, 2) m."""
    ends = source.over if np.isfinite(source.over) else source.start
    return ends + float(source.distance(places).max(initial=0.0)) / source.slowest


def last_loud(speeds: np.ndarray, level: float, peaks: np.ndarray) -> int:
    """The last sample at which any monitor is above `level` times its largest speed so far; -1 for none.

    speeds : (k, monitors) m/s. peaks : (monitors,), the largest before them.
    """
    so_far = np.maximum(np.maximum.accumulate(speeds, axis=0), peaks)
    loud = np.flatnonzero((speeds > level * so_far).any(axis=1))
    return int(loud[-1]) if len(loud) > 0 else -1


class Silence(Ending):
    """Ends a run when all monitors have been silent for long enough; a monitor that has not moved yet is silent, too.

    Parameters
    ----------
    rule : when it ends.
    time_step : s.
    """

    name = "silence"

    def __init__(self, rule: Silent, time_step: float) -> None:
        super().__init__(rule.hold, rule.earliest, time_step)
        self._level = rule.level

    def observe(self, run: Run, record: np.ndarray) -> None:
        """Find the last step at which any monitor was loud, and end the run if that is long ago."""
        times = (run.state.step - len(record) + np.arange(len(record))) * run.time_step
        speeds = np.abs(run.scene.observed(record, times)[:, :, 3:5]).max(axis=2)
        peaks = self._peaks if self._peaks.size else np.zeros(speeds.shape[1])
        loud = last_loud(speeds, self._level, peaks)
        if loud >= 0:
            self._last = run.state.step - len(record) + loud
        self._peaks = np.maximum(peaks, speeds.max(axis=0, initial=0.0))
        self._end(run)
