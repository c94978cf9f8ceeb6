"""How often the choice of `dembound run --error` is as accurate as asked for: small scenes beside enlarged, finer ones.

    python benchmarks/error_bound.py [NAME...]           # scenes whose names contain one of these; all by default
    python benchmarks/error_bound.py --every [NAME...]   # what choices cost beside the cheapest ones that keep a bound

The reference of a scene is a larger one, from whose sides nothing returns. It is run with its own disks and with a
third of their diameter, whose particles include the places of the first. As the errors of both are in the ratio 9 : 1,
the motion is extrapolated to (9 u_fine - u_own)/8. Where waves enter at particles of a side these are at another place
with smaller disks, and times are shifted by the way between.
"""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
import tomli_w
from error_bound_scenes import scenes

from dembound.accuracy.advise import choose
from dembound.accuracy.best import Best
from dembound.accuracy.extended import extended
from dembound.accuracy.history import History, Motions, loud
from dembound.accuracy.of_disks.options import Built, Options
from dembound.accuracy.of_disks.search import COSTLIEST
from dembound.accuracy.runner import measure
from dembound.boundaries import normal_axis
from dembound.casefile.disks import DiskCase
from dembound.disks.scene import build
from dembound.errors import DemboundError
from dembound.kinds import loads, with_changes
from dembound.running import Progress, plan

BOUNDS = (0.003, 0.01, 0.03, 0.1)
FINER = 3
QUANTITIES = ("velocity", "displacement")


def reference(case: DiskCase) -> Motions:
    """The motion in the enlarged scene, extrapolated to small disks, at the times of the finer run."""
    own, fine = (far_motion(with_changes(case, {"packing.radius": 0.5 / k})) for k in (1, FINER))
    found, lag = {}, _lag(case)
    for name, late in fine.items():
        gauge = replace(late, time=late.time - lag)
        coarse = own[name].at(gauge.time)
        values = {q: each + (each - coarse.values[q]) / (FINER**2 - 1) for q, each in gauge.values.items()}
        found[name] = replace(gauge, values=values)
    return found


def _lag(case: DiskCase) -> float:
    """Time (s) by which waves come later with smaller disks, as they enter at particles nearer the plane."""
    for side, waves in case.driving.items():
        if not case.side(side).is_outside:
            axis = normal_axis(side)
            speed = build(case).ground.wave_speeds(axis)[0 if "p" in waves else 1]
            return case.packing.radius * (1.0 - 1.0 / FINER) / speed
    return 0.0


def far_motion(case: Any) -> Motions:
    """The motion in the enlarged scene."""
    return measure(extended(case).case, Progress())[0].motions


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
    """All choices for a bound that cost at most so much (s), whatever their error, the cheapest first."""
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
        """What they are compared with."""
        return reference(self.case)

    def of(self, choice: DiskCase) -> float:
        """The largest error of a choice, RMS over RMS; infinite if it cannot run."""
        if choice.text not in self.known:
            try:
                self.known[choice.text] = true_error(measure(choice, Progress())[0].motions, self.reference)
            except DemboundError:
                self.known[choice.text] = math.inf
        return self.known[choice.text]


def every(names: list[str]) -> None:
    """Print how much the choice for each bound costs beside the cheapest one whose true error is below it."""
    ratios = []
    print("| scene | bound | choice, s | cheapest, s | ratio | choice | cheapest | its error |")
    print("|---|---|---|---|---|---|---|---|")
    for name, case in cases(names):
        truth = Truth(case)
        for bound in BOUNDS:
            choice = choose(case, bound)
            tried = every_choice(case, bound, choice.cost if choice.holds else COSTLIEST * choice.own_cost)
            best = next((each for each in tried if truth.of(each.case) <= bound), None)
            cells = [f"{choice.cost:.2g}", "", "", choice.words] if choice.holds else ["", "", "", "none"]
            if best is not None:
                cells[1] = f"{best.cost:.2g}"
                cells += [best.option.words, f"{100 * truth.of(best.case):.2g} %"]
                if choice.holds:
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
    found: dict[float, list[tuple[Best, float]]] = {bound: [] for bound in BOUNDS}
    print("| scene | bound | chosen | expected | true | true/expected | steps, s | of the case, s | search, s |")
    print("|---|---|---|---|---|---|---|---|---|")
    for name, case in cases(names):
        truth = Truth(case)
        for bound in BOUNDS:
            began = time.process_time()
            choice = choose(case, bound)
            spent = time.process_time() - began
            assert isinstance(choice.case, DiskCase)
            error = truth.of(choice.case)
            found[bound].append((choice, error))
            words = choice.words if choice.holds else f"none; {choice.words}"
            print(
                f"| {name} | {100 * bound:g} % | {words} | {100 * choice.error:.2g} % | {100 * error:.2g} % | "
                f"{error / max(choice.error, 1e-9):.2f} | {choice.cost:.2g} | {choice.own_cost:.2g} | {spent:.1f} |",
                flush=True,
            )
    by_bound(found)


def by_bound(found: Mapping[float, list[tuple[Best, float]]]) -> None:
    """Print a line for each bound: choices that were expected to keep it, those that do, and how errors scatter."""
    print("\n| bound | choices | within it | true over expected error | cost over that of the case |")
    print("|---|---|---|---|---|")
    for bound, each in found.items():
        held = [(choice, error) for choice, error in each if choice.holds]
        if not held:
            continue
        within = sum(error <= bound for _, error in held)
        ratios = [error / choice.error for choice, error in held]
        cost = np.median([choice.cost / choice.own_cost for choice, _ in held])
        scatter = f"{min(ratios):.2f}, {np.median(ratios):.2f}, {max(ratios):.2f}"
        print(f"| {100 * bound:g} % | {len(held)} of {len(each)} | {within} | {scatter} | {cost:.2g} |")


if __name__ == "__main__":
    if sys.argv[1:2] == ["--every"]:
        every(sys.argv[2:])
    else:
        main(sys.argv[1:])
