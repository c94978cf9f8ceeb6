"""How often the choice of `dembound advise` keeps its error bound: small scenes compared with enlarged, finer ones.

    python benchmarks/error_bound.py [NAME...]           # scenes whose names contain one of these; all by default
    python benchmarks/error_bound.py --every [NAME...]   # costs of choices over those of the cheapest that keep a bound

The reference of a scene is a larger one, from whose sides nothing returns. It is run with its own disks and with a
third of their diameter, whose particles include the places of the first. As the errors of both are in the ratio 9 : 1,
the motion is extrapolated to (9 u_fine - u_own)/8; beside holes, whose walls err in the first order, to (3 u_fine -
u_own)/2. Times count from when waves enter: with other disks, or beside a continuum, all motion is earlier or later.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
import tomli_w
from error_bound_scenes import scenes
from timing import small_option

from dembound.accuracy.estimate import advise
from dembound.accuracy.judge import extended
from dembound.accuracy.of_disks.candidates import COSTLIEST
from dembound.accuracy.of_disks.options import Built, Options
from dembound.accuracy.runner import measure
from dembound.casefile.disks import DiskCase
from dembound.disks.scene import build
from dembound.errors import DemboundError
from dembound.formulas.disks.entry import late_by
from dembound.formulas.history import History, Motions, loud
from dembound.kinds import loads, with_changes
from dembound.running import Progress, plan

BOUNDS = (0.003, 0.01, 0.03, 0.1)
FINER = 3
QUANTITIES = ("velocity", "displacement")


def reference(case: DiskCase) -> Motions:
    """The motion in the enlarged scene, extrapolated to small disks, at the times of the finer run."""
    own, fine = (far_motion(with_changes(case, {"packing.radius": case.packing.radius / k})) for k in (1, FINER))
    found = {}
    for name, gauge in fine.items():
        coarse = own[name].at(gauge.time)
        values = {
            q: each + (each - coarse.values[q]) / (FINER ** (1 if case.hole else 2) - 1)
            for q, each in gauge.values.items()
        }
        found[name] = replace(gauge, values=values)
    return found


def far_motion(case: Any) -> Motions:
    """The motion in the enlarged scene."""
    return timed(extended(case).case)


def timed(case: Any) -> Motions:
    """The motion of a run, at times from when its waves enter as through the planes of its sides."""
    late = late_by(build(case))
    return {name: replace(own, time=own.time - late) for name, own in measure(case, Progress())[0].motions.items()}


def true_error(found: Motions, expected: Motions) -> float:
    """The largest error of velocity or displacement at monitors that move, RMS over RMS."""
    errors = []
    for quantity in QUANTITIES:
        for name in loud({key: _plane(each) for key, each in expected.items()}, quantity):
            own = _plane(expected[name])
            column, values = own.component(quantity), own.values[quantity]
            rest = found[name].at(own.time).values[quantity][:, column] - values[:, column]
            errors.append(float(np.linalg.norm(rest) / np.linalg.norm(values[:, column])))
    return max(errors)


def _plane(history: History) -> History:
    """The motion along x and y, without rotation."""
    return replace(history, values={quantity: each[:, :2] for quantity, each in history.values.items()})


def every_choice(case: DiskCase, bound: float, most: float) -> list[Built]:
    """All choices for a bound that cost at most `most` s, whatever their error, the cheapest first."""
    options = Options(plan(case), bound, ())  # type: ignore[arg-type]
    counted = [each for factor in options.factors for each in options.of(factor) if each.cost <= most]
    found = [built for each in counted if (built := options.build(each)) is not None]
    return sorted((each for each in found if each.cost <= most), key=lambda each: each.cost)


@dataclass
class Truth:
    """True errors of choices for a case, each of which is run once."""

    case: DiskCase
    known: dict[str, float] = field(default_factory=dict)

    @cached_property
    def reference(self) -> Motions:
        """The reference motion of the choices."""
        return reference(self.case)

    def of(self, choice: DiskCase) -> float:
        """The largest error of a choice, RMS over RMS; infinite if it cannot run."""
        if choice.text not in self.known:
            try:
                self.known[choice.text] = true_error(timed(choice), self.reference)
            except DemboundError:
                self.known[choice.text] = math.inf
        return self.known[choice.text]


def every(names: list[str]) -> None:
    """Print the cost of the choice for each bound over the cost of the cheapest one whose true error is below it."""
    ratios = []
    print("| scene | bound | choice, s | cheapest, s | ratio | choice | cheapest | its error |")
    print("|---|---|---|---|---|---|---|---|")
    for name, case in cases(names):
        truth, found = Truth(case), advise(case, BOUNDS, "rock")
        for bound, choice in found.best.items():
            holds = choice.holds(bound)
            tried = every_choice(case, bound, choice.cost if holds else COSTLIEST * found.given.cost)
            best = next((each for each in tried if truth.of(each.case) <= bound), None)
            cells = [f"{choice.cost:.2g}", "", "", choice.choice.name] if holds else ["", "", "", "none"]
            if best is not None:
                cells[1] = f"{best.cost:.2g}"
                cells += [best.option.words, f"{100 * truth.of(best.case):.2g} %"]
                if holds:
                    ratios.append(choice.cost / best.cost)
                    cells[2] = f"{ratios[-1]:.2g}"
            print(f"| {name} | {100 * bound:g} % | {' | '.join(cells)} |", flush=True)
    if ratios:
        print(f"\n{len(ratios)} choices over the cheapest: {np.median(ratios):.2g} (median), {max(ratios):.2g} at most")


def cases(names: list[str]) -> Iterator[tuple[str, DiskCase]]:
    """The scenes whose names contain one of these, all without any."""
    for name, tables in scenes():
        if not names or any(each in name for each in names):
            case = loads(tomli_w.dumps(tables), name=name.replace(" ", "_"))
            assert isinstance(case, DiskCase)
            yield name, case


def main(names: list[str]) -> None:
    """Print a line for each scene and bound, the spread of errors by bound, and the share of those that keep it."""
    found: dict[float, list[Line]] = {bound: [] for bound in BOUNDS}
    print(
        "| scene | bound | chosen | expected | at most | true | true/expected | steps, s | of the case, s | search, s |"
    )
    print("|---|---|---|---|---|---|---|---|---|---|")
    for name, case in cases(names):
        truth, advice = Truth(case), advise(case, BOUNDS, "rock")
        for bound, best in advice.best.items():
            assert isinstance(best.case, DiskCase)
            share, true = best.budget.worst().share, truth.of(best.case)
            found[bound].append(Line(best.holds(bound), share.value, share.upper, true, best.cost / advice.given.cost))
            words = best.choice.name if best.holds(bound) else f"none; {best.choice.name}"
            print(
                f"| {name} | {100 * bound:g} % | {words} | {100 * share.value:.2g} % | {100 * share.upper:.2g} % | "
                f"{100 * true:.2g} % | {true / max(share.value, 1e-9):.2f} | {best.cost:.2g} | "
                f"{advice.given.cost:.2g} | {advice.cpu_seconds:.1f} |",
                flush=True,
            )
    by_bound(found)


@dataclass(frozen=True)
class Line:
    """A choice for one bound: its expected, largest and true error, and its cost over that of the case."""

    holds: bool
    expected: float
    upper: float
    true: float
    cost: float


def by_bound(found: Mapping[float, list[Line]]) -> None:
    """Print a line for each bound: choices that were expected to keep it, those that do, and how errors scatter."""
    print("\n| bound | choices | within it | true over expected error | cost over that of the case |")
    print("|---|---|---|---|---|")
    for bound, each in found.items():
        held = [line for line in each if line.holds]
        if not held:
            continue
        within = sum(line.true <= bound for line in held)
        ratios = [line.true / line.expected for line in held]
        cost = np.median([line.cost for line in held])
        scatter = f"{min(ratios):.2f}, {np.median(ratios):.2f}, {max(ratios):.2f}"
        print(f"| {100 * bound:g} % | {len(held)} of {len(each)} | {within} | {scatter} | {cost:.2g} |")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--every", action="store_true")
    small_option(parser, names=["embedded 30 m along x cosine"])
    options = parser.parse_args()
    (every if options.every else main)(options.names)
