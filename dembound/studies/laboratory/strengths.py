"""Strengths of bonds with which samples have the strengths asked for: trials, each of which is a test of samples."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.material import Material
from dembound.casefile.disks.targets import Scatter
from dembound.casefile.types import LAWS
from dembound.disks.material.constants import drawn
from dembound.errors import CaseError, RunError
from dembound.files import require_no_link
from dembound.kinds import with_changes
from dembound.results.recording import TestName
from dembound.studies.laboratory.sample import LAW, Sample
from dembound.studies.laboratory.study import perform, specimens_of
from dembound.studies.sweep.study import Options, Report
from dembound.studies.sweep.tables import Statistic
from dembound.words import percent, with_unit

SPREADS = (0.0, 0.3, 0.43)
COHESIONS = (0.3, 0.6, 1.0, 1.5, 2.5)
SHARES: Mapping[TestName, Sequence[Sequence[float]]] = {
    "tension": (
        (0.299, 0.403, 0.403, 0.403, 0.403),
        (0.231, 0.285, 0.290, 0.290, 0.290),
        (0.171, 0.204, 0.220, 0.220, 0.220),
    ),
    "ucs": (
        (0.573, 1.031, 1.482, 1.634, 1.634),
        (0.517, 0.909, 1.254, 1.392, 1.555),
        (0.498, 0.796, 1.078, 1.241, 1.324),
    ),
}
"""Strength of samples over `pb_ten`: a row for each of `SPREADS`, a column for each `pb_coh` over `pb_ten`.

The spread is the standard deviation of the factors of bonds, `spread_of`. Means of four seeds of samples 20 diameters
wide, packing B, damp 0.7. They choose the first trial; later ones follow from the trials before.
"""

WITHOUT_MOMENT: Mapping[str, Sequence[float]] = {
    "pb_coh": (1.0, 2.0, 4.0, 8.0, 16.0),
    "tension": (0.483, 0.487, 0.49, 0.492, 0.492),
    "ucs": (1.69, 3.02, 5.09, 8.8, 14.1),
}
"""The same with `pb_mcf` = 0, for bonds of one strength, by `pb_coh` over `pb_ten`; means of two seeds, at 8 of five.

Shares for values between 0 and 1 are interpolated in logarithms; those of other spreads have the ratio of `SHARES`.
"""

CLOSE = 0.03
"""Deviation from a strength asked for at which trials end.

It lies inside the 95 % interval of the mean of eight seeds: single samples deviate by 5 to 9 %, so their mean by
t·(5 … 9)/√8 = 4 to 8 %. More trials would fit the bonds to these seeds, not to the material.
"""

MOST_TRIALS, SAME = 4, 2e-3
"""Largest number of trials; deviation of all strengths of bonds up to which a trial would only repeat one."""

APART, FLAT = 0.1, 0.1
"""Distance of two trials in ln(`pb_coh`/`pb_ten`), and slope of ln(UCS/tension) over it, above which a secant counts.

Strengths of the same seeds with other bonds scatter by some 2 %: nearer trials tell less than the table, whose slope is
0.4 to 0.7 up to 1.
"""

MOST_RATIO, MOST_SCATTERED, MOST_WITHOUT_MOMENT = 5.0, 7.0, 25.0
"""Largest ratios of strengths that parallel bonds reach: of one strength, with `pb_scatter`, and with `pb_mcf` = 0."""

MISSED = 0.04
"""Deviation of a ratio of strengths from what is in reach that is still tried: each strength misses by half of it."""

NEAR_LIMIT = 0.1
"""Distance from the smallest or largest ratio in reach below which a trial tells what it is."""

TRIED, TRIED_WITHOUT_MOMENT = (
    np.geomspace(COHESIONS[0], most, 2000) for most in (COHESIONS[-1], WITHOUT_MOMENT["pb_coh"][-1])
)
"""All `pb_coh` over `pb_ten` that trials may have where both strengths are asked for; the second if `pb_mcf` < 1."""

Measure = Callable[[TestName, float, float], Statistic]
"""The strength of samples over seeds: test, `pb_ten` and `pb_coh` (Pa) -> mean and interval."""


@dataclass(frozen=True)
class Trial:
    """Strengths of bonds (Pa), and of samples with them by test."""

    pb_ten: float
    pb_coh: float
    strengths: Mapping[TestName, Statistic]

    @property
    def cohesion(self) -> float:
        """`pb_coh` over `pb_ten`."""
        return self.pb_coh / self.pb_ten

    @property
    def ratio(self) -> float:
        """Compressive over tensile strength."""
        return self.strengths["ucs"].mean / self.strengths["tension"].mean

    def excess(self, test: TestName, targets: Mapping[TestName, float]) -> float:
        """Strength over the one asked for, less 1."""
        return self.strengths[test].mean / targets[test] - 1.0

    def deviation(self, targets: Mapping[TestName, float]) -> float:
        """The larger deviation of both strengths from those asked for."""
        return max(abs(self.excess(test, targets)) for test in targets)


@dataclass(frozen=True)
class Search:
    """What trials so far tell about the strengths of samples.

    Attributes
    ----------
    targets : strength (Pa) by test, of ``ucs`` and ``tension``.
    cohesion : `pb_coh` over `pb_ten` if only one strength is asked for.
    spread : of the strengths of bonds, `spread_of`. moments : `pb_mcf`, the share of moments in stresses of bonds.
    """

    targets: Mapping[TestName, float]
    cohesion: float = 1.0
    spread: float = 0.0
    moments: float = 1.0

    @classmethod
    def of(cls, material: Material, targets: Mapping[TestName, float]) -> Search:
        """The search that begins with the bonds of a material."""
        ten, coh = material.pb_ten, material.pb_coh
        return cls(targets, coh / ten if ten and coh else 1.0, spread_of(material.pb_scatter), material.pb_mcf)

    @property
    def ratio(self) -> float | None:
        """The ratio of strengths asked for; None for a single one."""
        return self.targets["ucs"] / self.targets["tension"] if len(self.targets) > 1 else None

    def trials(self, measure: Measure) -> Iterator[Trial]:
        """Trials until one is `CLOSE`, the first from the table and at most `MOST_TRIALS`.

        Raises CaseError for a ratio that parallel bonds do not reach.
        """
        if self.ratio is not None:
            usual = MOST_SCATTERED if self.spread else MOST_RATIO
            most = usual**self.moments * max(MOST_WITHOUT_MOMENT, usual) ** (1.0 - self.moments)
            _require_within(self.ratio, self._ratios([])[0], (1.0 + MISSED) * most if self.moments < 1.0 else most)
        done: list[Trial] = []
        while len(done) < MOST_TRIALS:
            ten, coh = self._following(done)
            if any(np.allclose((each.pb_ten, each.pb_coh), (ten, coh), rtol=SAME) for each in done):
                return
            done.append(Trial(ten, coh, {test: measure(test, ten, coh) for test in self.targets}))
            yield done[-1]
            if done[-1].deviation(self.targets) <= CLOSE:
                return

    def best(self, trials: Sequence[Trial]) -> Trial:
        """The trial with the smallest deviation from what is asked for."""
        return min(trials, key=lambda trial: trial.deviation(self.targets))

    def _following(self, done: Sequence[Trial]) -> tuple[float, float]:
        """`pb_ten` and `pb_coh` (Pa) of the trial after others, rounded to four digits as they are written.

        Both strengths of samples are nearly proportional to `pb_ten`, so `pb_coh` over `pb_ten` follows from the ratio
        asked for, then `pb_ten` from the strengths: UCS changes by 3 % more at twice, 2 % less at half of it (20
        diameters), tension by 0.1 %. Raises CaseError for a ratio out of reach.
        """
        cohesion, near = self.cohesion, [*done[-1:], *([self.best(done[:-1])] if done[1:] else [])]
        if self.ratio is not None:
            ratios = self._ratios(near)
            if len(done) == 1:
                _require_told(self.ratio, done[0].ratio, ratios)
            cohesion = float(self.tried[np.argmin(np.abs(np.log(ratios / self.ratio)))])
        shares = {test: self._shares(test, np.array([cohesion]), near)[0] for test in self.targets}
        pb_ten = float(np.exp(np.mean([np.log(target / shares[test]) for test, target in self.targets.items()])))
        return float(f"{pb_ten:.4g}"), float(f"{cohesion * pb_ten:.4g}")

    def _ratios(self, near: Sequence[Trial]) -> np.ndarray:
        """The ratio of strengths for all `tried`."""
        return self._shares("ucs", self.tried, near) / self._shares("tension", self.tried, near)

    @property
    def tried(self) -> np.ndarray:
        """All `pb_coh` over `pb_ten` that trials may have."""
        return TRIED if self.moments == 1.0 else TRIED_WITHOUT_MOMENT

    def expected_ratio(self) -> float:
        """Compressive over tensile strength with its `pb_coh` over `pb_ten`, without a trial."""
        ucs, tension = (self._shares(test, np.array([self.cohesion]), [])[0] for test in ("ucs", "tension"))
        return float(ucs / tension)

    def _shares(self, test: TestName, cohesions: np.ndarray, near: Sequence[Trial]) -> np.ndarray:
        """Strength of samples over `pb_ten` for each `pb_coh` over `pb_ten`.

        That of the table times a factor with which it is that of the last trial; or, where they tell a slope, in
        logarithms the straight line through the last one and the best one before.
        """
        logs = np.log(cohesions)
        if not near:
            return np.exp(self._tabulated(test, logs))
        own, places = [np.log(each.strengths[test].mean / each.pb_ten) for each in near], _logs_of(near)
        if self.ratio is not None and _tell_slope(near):
            return np.exp(own[0] + (own[1] - own[0]) / (places[1] - places[0]) * (logs - places[0]))
        return np.exp(own[0] + self._tabulated(test, logs) - self._tabulated(test, places[:1]))

    def _tabulated(self, test: TestName, logs: np.ndarray) -> np.ndarray:
        """Logarithms of `SHARES` at logarithms of `pb_coh` over `pb_ten`, on curves as monotonic as the points."""
        from scipy.interpolate import PchipInterpolator

        known = np.log(COHESIONS)
        rows = [PchipInterpolator(known, np.log(row))(logs.clip(known[0], known[-1])) for row in SHARES[test]]
        found = np.array([np.interp(self.spread, SPREADS, column) for column in np.transpose(rows)])
        if self.moments == 1.0:
            return found
        known = np.log(WITHOUT_MOMENT["pb_coh"])
        without = PchipInterpolator(known, np.log(WITHOUT_MOMENT[test]))(logs.clip(known[0], known[-1]))
        below = np.minimum(logs - known[0], 0.0) if test == "ucs" else 0.0  # bonds that break in shear alone
        return self.moments * found + (1.0 - self.moments) * (without + below + found - rows[0])


def _logs_of(trials: Sequence[Trial]) -> np.ndarray:
    """Logarithms of `pb_coh` over `pb_ten`."""
    return np.log([each.cohesion for each in trials])


def _tell_slope(near: Sequence[Trial]) -> bool:
    """Whether two trials are so far apart that the slope of the ratio of strengths between them is no noise."""
    if len(near) < 2:
        return False
    apart = np.diff(_logs_of(near))[0]
    return bool(abs(apart) > APART and np.log(near[1].ratio / near[0].ratio) / apart > FLAT)


def _require_told(ratio: float, own: float, ratios: np.ndarray) -> None:
    """Raise CaseError for a ratio that the first trial tells to be out of reach.

    own : ratio of this trial; ratios : those in reach in its packing.
    """
    low, high = ratios.min(), ratios.max()
    least = (1.0 - MISSED) * low if own < (1.0 + NEAR_LIMIT) * low else 0.0
    most = (1.0 + MISSED) * high if own > (1.0 - NEAR_LIMIT) * high else np.inf
    _require_within(ratio, least, most, f", in this packing {low:.2g} to {high:.2g}")


def _require_within(ratio: float, least: float, most: float, here: str = "") -> None:
    """Raise CaseError for a ratio of strengths outside the reach of parallel bonds.

    here : addition to the message, on this packing.
    """
    if ratio > most:
        reach = f"parallel bonds of one strength reach about {MOST_RATIO:g}, scatter of their strengths about"
        recipe = f'material.pb_scatter = {{type = "normal", deviation = 0.5}}; pb_mcf = 0 {MOST_WITHOUT_MOMENT:g}'
        raise CaseError([f"--ucs over --tension: is {ratio:.3g}, {reach} {MOST_SCATTERED:g}{here}; {recipe}"])
    if ratio < least:
        what = f"must be {least:.3g} or more for parallel bonds{here}"
        raise CaseError([f"--ucs over --tension: is {ratio:.3g}, {what}"])


def spread_of(scatter: Scatter | None) -> float:
    """Standard deviation of the factors of the strengths of bonds; 0 without scatter."""
    return 0.0 if scatter is None else float(np.std(drawn(scatter, (np.arange(10_000) + 0.5) / 10_000)))


def keys_of(case: DiskCase, pb_ten: float, pb_coh: float) -> dict[str, Any]:
    """The keys that give a case bonds of these strengths (Pa), and a law under which they break."""
    law = {"material.law": LAW} if not LAWS[case.material.law].has_history else {}
    return law | {"material.pb_ten": pb_ten, "material.pb_coh": pb_coh}


def with_bonds(case: DiskCase, pb_ten: float, pb_coh: float) -> DiskCase:
    """The case with the keys of `keys_of`."""
    changed = with_changes(case, keys_of(case, pb_ten, pb_coh))
    assert isinstance(changed, DiskCase)
    return changed


Make = Callable[[DiskCase, TestName], Sample]
"""Cuts the sample of a test from a case."""


def measure_in(make: Make, case: DiskCase, seeds: int, options: Options, folder: Path, report: Report) -> Measure:
    """The strengths of samples that `make` cuts from a case; every trial has a folder of its own within a folder.

    Raises RunError when a run has failed or has no peak, RecordError for a folder that is a link.
    """
    require_no_link(folder)

    def measure(test: TestName, pb_ten: float, pb_coh: float) -> Statistic:
        sample = make(with_bonds(case, pb_ten, pb_coh), test)
        place = folder / f"{test}_{pb_ten:.4g}_{pb_coh:.4g}"
        found = perform(sample, specimens_of(sample, seeds), options, place, report)
        if failed := [state for state in found.states if state != "done"]:
            raise RunError([f"{place}: {failed[0]}"])
        if without := [name for name, curve in found.curves.items() if not curve.has_peak]:
            raise RunError([f"{place}: no peak in {', '.join(without)}"])
        return next(each for each in found.statistics if each.quantity == "strength")

    return measure


def strength_in_words(test: TestName, trial: Trial) -> str:
    """The strength that a trial has found in a test, with its interval."""
    found = trial.strengths[test]
    interval = "" if np.isnan(found.interval) else f" ± {with_unit(found.interval, 'Pa')} (95 %)"
    return f"{test} {with_unit(found.mean, 'Pa')}{interval} over {found.count} seeds"


def excess_in_words(test: TestName, trial: Trial, targets: Mapping[TestName, float]) -> str:
    """How far a strength is from the one asked for."""
    excess = trial.excess(test, targets)
    side = "above" if excess > 0.0 else "below"
    return f"{percent(abs(excess), 3)} {side} the {with_unit(targets[test], 'Pa')} asked for"


def in_words(trial: Trial, targets: Mapping[TestName, float]) -> Iterator[str]:
    """A line for each test of a trial."""
    bonds = f"pb_ten {with_unit(trial.pb_ten, 'Pa', 4)}, pb_coh {with_unit(trial.pb_coh, 'Pa', 4)}"
    for test in targets:
        yield f"{bonds}: {strength_in_words(test, trial)}, {excess_in_words(test, trial, targets)}"
