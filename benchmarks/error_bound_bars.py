"""How often the choice of `dembound advise` for bars keeps its error bound, compared with exact motions.

    python benchmarks/error_bound_bars.py [NAME...]      # of tests/estimated_bars.py; by default those of `NAMES`
    python benchmarks/error_bound_bars.py --every [NAME...]      # computes the errors of all choices

The exact motion is d'Alembert's, for attenuation and ranges that of finite differences on nodes eight times as fine as
those of the choice. Errors are those at the places of the monitors.

With `--every` it prints how many errors the search computes, whether it finds the choice that all of them give, and the
largest factor by which the rules of accuracy/of_bars/search.py are wrong, of all pairs of choices: for finer nodes and
other ends, which `MARGIN` has to cover, and for coarser ones, which only matter where no choice keeps the bound.
"""

from __future__ import annotations

import argparse
import sys

import numpy as np
from timing import ROOT, small_option

sys.path.insert(0, str(ROOT / "tests"))

from estimated_bars import SCENES, exact, recorded_of, scene

from dembound.accuracy.estimate import advise
from dembound.accuracy.of_bars.options import bar_options
from dembound.accuracy.of_bars.search import MARGIN, Floors, Motion, affordable, cheapest, given_motion
from dembound.casefile.bar import BarCase
from dembound.formulas.history import History, loud

BOUNDS = (0.003, 0.01, 0.03)

NAMES = (
    "finite differences, ν = 0.5",
    "sine burst, ν = 0.5",
    "viscous end, β = 0.7",
    "viscous soft end, m = 3",
    "matched layer",
    "m = 3, corrected ends",
    "ricker, m = 3",
    "input, β = 0.8, m = 3",
    "ranges",
    "attenuation",
)


def true_error(given: BarCase, case: BarCase) -> float:
    """The largest error of all quantities at monitors that move, RMS over RMS."""
    found, _ = recorded_of(case)
    places = {monitor.name: monitor.position for monitor in given.monitor}
    errors = []
    for name, own in found.items():
        moved = History(np.array([places[name], 0.0]), own.time, own.values)
        expected = exact(case, moved)
        for quantity, values in own.values.items():
            if name in loud(found, quantity):
                rest = np.linalg.norm(values[:, 0] - expected[quantity])
                errors.append(float(rest / np.linalg.norm(values[:, 0])))
    return max(errors)


def wrong_by(motions: list[Motion]) -> tuple[float, float]:
    """The largest factors by which what one error says of another is too large: as `MARGIN` covers, and without it."""
    worst = [0.0, 0.0]
    for known in motions:
        floors = Floors()
        known.add_to(floors)
        for other in (each for each in motions if each is not known):
            alike = (known.choice.ends, known.choice.method) == (other.choice.ends, other.choice.method)
            is_coarser = alike and other.choice.spacing > known.choice.spacing
            factor = floors.of(other.choice) / other.error * (1.0 if is_coarser else MARGIN)
            worst[is_coarser] = max(worst[is_coarser], factor)
    return worst[0], worst[1]


def every(names: list[str]) -> None:
    """Print a line for each scene: the choice of the search and the errors of all choices."""
    bounds = " | ".join(f"computed at {100 * bound:g} %" for bound in BOUNDS)
    print(f"| bar | choices | {bounds} | same choices | finer nodes, other ends | coarser nodes |")
    print("|---|---|" + "---|" * len(BOUNDS) + "---|---|---|")
    for name in names or SCENES:
        own = given_motion(scene(name))
        motions = affordable(own, bar_options(own.choice.scene.case, []))
        best = min(motions, key=lambda each: each.error)
        tried, same = [], 0
        for bound in BOUNDS:
            found, count = cheapest(motions, bound)
            same += found is next((each for each in motions if each.holds(bound)), best)
            tried.append(str(count))
        row = [
            name,
            str(len(motions)),
            *tried,
            f"{same} of {len(BOUNDS)}",
            *(f"{each:.2f}" for each in wrong_by(motions)),
        ]
        print(f"| {' | '.join(row)} |", flush=True)


def main(names: list[str]) -> None:
    """Print a line for each scene and bound, and the share of those that keep it."""
    kept = []
    print("| bar | bound | chosen | expected | true | steps, ms | of the case, ms | errors computed | search, s |")
    print("|---|---|---|---|---|---|---|---|---|")
    for name in names or NAMES:
        case = scene(name)
        for bound in BOUNDS:
            advice = advise(case, (bound,))
            best = advice.best[bound]
            assert isinstance(best.case, BarCase)
            error, expected = true_error(case, best.case), best.budget.worst().share.value
            if best.holds(bound):
                kept.append(error <= bound)
            words = best.choice.name if best.holds(bound) else f"none; {best.choice.name}"
            print(
                f"| {name} | {100 * bound:g} % | {words} | {100 * expected:.3g} % | {100 * error:.3g} % | "
                f"{1e3 * best.cost:.2g} | {1e3 * advice.given.cost:.2g} | {advice.tried} | {advice.cpu_seconds:.1f} |",
                flush=True,
            )
    print(f"\n{sum(kept)} of {len(kept)} choices that were expected to keep their bound do so")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--every", action="store_true")
    small_option(parser, names=["viscous end, β = 0.7"])
    options = parser.parse_args()
    (every if options.every else main)(options.names)
