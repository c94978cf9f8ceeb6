"""Strengths of bonds with which samples have the strengths asked for: a first trial from above, and one to check."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from dembound.casefile.disks import DiskCase
from dembound.casefile.types import LAWS
from dembound.errors import CaseError, RunError
from dembound.kinds import with_changes
from dembound.results.loading_curve import TestName
from dembound.studies.laboratory.sample import LAW, Sample
from dembound.studies.laboratory.study import perform, specimens_of
from dembound.studies.sweep.statistics import Statistic
from dembound.studies.sweep.study import Options, Report
from dembound.words import percent, with_unit

COHESIONS = (0.3, 0.6, 1.0, 1.4, 2.0)
RATIOS = (2.04, 2.55, 3.75, 4.1, 4.15)
"""Compressive over tensile strength of samples 20 diameters wide for `pb_coh` over `pb_ten` as in `COHESIONS`.

Means of four seeds; above the last one the ratio is level, below 0.6 strength in tension falls, too.
"""

MOST_RATIO, MOST_SCATTERED = 5.0, 7.0
"""Largest ratios of strengths that parallel bonds reach, of one strength and with `pb_scatter`."""

BOND = {"tension": 0.4, "ucs": 1.5}
"""Strength of samples over `pb_ten`, rather low: trials begin above, as strengths scale downwards only."""

ENOUGH, MISSED = 0.02, 1.04
"""Deviation of a ratio from the one asked for that is not corrected; excess over `RATIOS` that is out of reach."""

Measure = Callable[[TestName, float, float], Statistic]
"""The strength of samples over seeds: test, `pb_ten` and `pb_coh` (Pa) -> mean and interval."""


@dataclass(frozen=True)
class Trial:
    """Strengths of bonds (Pa), and of samples with them by test."""

    pb_ten: float
    pb_coh: float
    strengths: Mapping[TestName, Statistic]

    def excess(self, targets: Mapping[TestName, float]) -> float:
        """Strengths over those asked for, the geometric mean of all tests."""
        logs = [np.log(self.strengths[test].mean / target) for test, target in targets.items()]
        return float(np.exp(np.mean(logs)))

    @property
    def ratio(self) -> float:
        """Compressive over tensile strength."""
        return self.strengths["ucs"].mean / self.strengths["tension"].mean


def trials(targets: Mapping[TestName, float], cohesion: float, measure: Measure, most: float) -> Iterator[Trial]:
    """Two trials: a guess from above, and the strengths that follow from it.

    Parameters
    ----------
    targets : strength (Pa) by test, of ``ucs`` and ``tension``.
    cohesion : `pb_coh` over `pb_ten` if only one strength is asked for.
    most : largest ratio of strengths, see `MOST_RATIO`.

    Raises CaseError for a ratio that parallel bonds do not reach.
    """
    wanted = targets["ucs"] / targets["tension"] if len(targets) > 1 else None
    if wanted is not None:
        _require_reachable(wanted, wanted, RATIOS[0], most, "")
        cohesion = float(np.interp(wanted, RATIOS, COHESIONS))
    pb_ten = max(target / BOND[test] for test, target in targets.items())
    first = _trial(targets, pb_ten, cohesion * pb_ten, measure)
    yield first
    scale = 1.0 / first.excess(targets)
    if wanted is not None:
        scale = targets["tension"] / first.strengths["tension"].mean  # bonds that break in tension decide on it
        if abs(wanted / first.ratio - 1.0) > ENOUGH:
            shift = first.ratio / float(np.interp(cohesion, COHESIONS, RATIOS))
            aimed, here = wanted / shift, f", in this packing {RATIOS[-1] * shift:.2g}"
            _require_reachable(wanted, aimed, 0.0, MISSED * RATIOS[-1] if most == MOST_RATIO else np.inf, here)
            cohesion = float(np.interp(aimed, RATIOS, COHESIONS))
    yield _trial(targets, scale * first.pb_ten, scale * cohesion * first.pb_ten, measure)


def _trial(targets: Mapping[TestName, float], pb_ten: float, pb_coh: float, measure: Measure) -> Trial:
    """The strengths of samples with these of bonds, rounded to four digits as they are written."""
    ten, coh = (float(f"{each:.4g}") for each in (pb_ten, pb_coh))
    return Trial(ten, coh, {test: measure(test, ten, coh) for test in targets})


def _require_reachable(wanted: float, ratio: float, least: float, most: float, here: str) -> None:
    """Raise CaseError for a ratio of strengths outside the reach of parallel bonds.

    wanted : the ratio asked for; ratio : the one in `RATIOS` that gives it in this packing. here : addition to the
    message on this packing.
    """
    if ratio > most:
        raise CaseError(
            [
                f"--ucs over --tension: is {wanted:.3g}, parallel bonds of one strength reach about {MOST_RATIO:g}"
                f"{here}; scatter of their strengths about {MOST_SCATTERED:g}: material.pb_scatter = "
                '{type = "normal", deviation = 0.5}'
            ]
        )
    if ratio < least:
        raise CaseError([f"--ucs over --tension: is {wanted:.3g}, must be {least:g} or more for parallel bonds"])


def measure_in(
    make: Callable[[DiskCase, TestName], Sample],
    case: DiskCase,
    seeds: int,
    options: Options,
    folder: Path,
    report: Report,
) -> Measure:
    """The strengths of samples that `make` cuts from a case; every trial has a folder of its own within a folder.

    Raises RunError when a run has failed or has no peak.
    """

    def measure(test: TestName, pb_ten: float, pb_coh: float) -> Statistic:
        keys = {"material.law": LAW} if not LAWS[case.material.law].has_history else {}
        changed = with_changes(case, keys | {"material.pb_ten": pb_ten, "material.pb_coh": pb_coh})
        assert isinstance(changed, DiskCase)
        sample = make(changed, test)
        place = folder / f"{test}_{pb_ten:.4g}_{pb_coh:.4g}"
        found = perform(sample, specimens_of(sample, seeds), options, place, report)
        if failed := [state for state in found.states if state != "done"]:
            raise RunError([f"{place}: {failed[0]}"])
        if without := [name for name, curve in found.curves.items() if not curve.has_peak]:
            raise RunError([f"{place}: no peak in {', '.join(without)}"])
        return next(each for each in found.statistics if each.quantity == "strength")

    return measure


def changes_of(trial: Trial, targets: Mapping[TestName, float]) -> dict[str, Any]:
    """The keys of the material after the last trial, scaled by what is left of its deviation from the targets."""
    scale = 1.0 / trial.excess(targets)
    return {f"material.{key}": float(f"{scale * getattr(trial, key):.4g}") for key in ("pb_ten", "pb_coh")}


def in_words(trial: Trial, targets: Mapping[TestName, float]) -> Iterator[str]:
    """A line for each test of a trial."""
    bonds = f"pb_ten {with_unit(trial.pb_ten, 'Pa')}, pb_coh {with_unit(trial.pb_coh, 'Pa')}"
    for test, target in targets.items():
        found = trial.strengths[test]
        interval = "" if np.isnan(found.interval) else f" ± {with_unit(found.interval, 'Pa')} (95 %)"
        excess = found.mean / target - 1.0
        yield (
            f"{bonds}: {test} {with_unit(found.mean, 'Pa')}{interval} over {found.count} seeds, "
            f"{percent(abs(excess))} {'above' if excess > 0.0 else 'below'} the {with_unit(target, 'Pa')} asked for"
        )
