"""Quality of the advice for random bars, compared with runs of all choices on a grid and a fine reference.

    python benchmarks/random_bars.py [--scenes 20] [--first SEED] [--no-grid]

A bar has one rock or two, peridynamics, finite differences or a hybrid, attenuation in one of six, a strength in one of
six, ends of all kinds and one of four pulses. Its reference is a run by finite differences on nodes of equal travel
times, of at most a tenth of the given ones and of those of the choice, at Courant number 1, whose dashpots return
nothing; with attenuation the bar goes on instead. Both are compared at the places of the monitors, and at
the times of the reference, RMS over RMS.
"""

from __future__ import annotations

import argparse
import math
import sys
import time
from collections.abc import Iterator
from typing import Any

import numpy as np
from timing import ROOT, small_option

sys.path.insert(0, str(ROOT / "tests"))

from advised import advised
from estimated_bars import recorded_of
from small_cases import small

from dembound.accuracy.of_bars.options import BarOption, may_break
from dembound.bar.scene import build_bar
from dembound.bar.stability import choose_step, unit_step
from dembound.casefile.bar import BarCase
from dembound.errors import DemboundError
from dembound.formulas.history import History, loud
from dembound.kinds import with_changes
from dembound.results.compare import at_times

BOUNDS = (0.1, 0.03, 0.01, 0.003)
FINER = 10
MOST_COST = 64.0
"""Cost up to which choices are tried by hand, over that of the given one."""

CELLS = 40_000
"""Largest number of cells of a reference."""


def random_bar(seed: int) -> BarCase:
    """A bar of 60 to 160 nodes, in which a pulse of 8 to 60 spacings runs one to two and a half lengths."""
    rng = np.random.default_rng(seed)
    cells, spacing, speed = int(rng.integers(60, 160)), float(rng.choice([0.002, 0.005, 0.01])), rng.uniform(1500, 5000)
    length = round(cells * spacing, 6)
    bar: dict[str, Any] = {"spacing": spacing, "density": 2500.0, "wave_speed": round(float(speed), 1)}
    if rng.random() < 0.35:
        left = round(int(cells * rng.uniform(0.3, 0.7)) * spacing, 6)
        other = {
            "wave_speed": round(float(speed * rng.uniform(0.4, 1.6)), 1),
            "density": float(rng.integers(1500, 3000)),
        }
        bar["range"] = [
            {"name": "one", "length": left},
            {"name": "two", "length": round(length - left, 6), **other},
        ]
    else:
        bar["length"] = length
    damped = rng.random() < 1 / 6
    if damped:
        bar["attenuation"] = round(float(rng.uniform(0.05, 0.5) / length), 4)
    if rng.random() < 1 / 6:
        bar["strength"] = 1e9  # which the pulse of some MPa does not reach
    horizon = int(rng.integers(2, 6))
    method: dict[str, Any] = [
        {"type": "finite_difference"},
        {"type": "peridynamics", "horizon": horizon},
        {"type": "peridynamics", "horizon": horizon, "corrected_ends": True},
        {"type": "switch" if rng.random() < 0.5 else "patch", "horizon": horizon},
    ][int(rng.integers(4))]
    period = float(rng.uniform(8, 60)) * spacing / speed
    wave: dict[str, Any] = [
        {"type": "triangle", "amplitude": 1.0, "rise": period / 3, "fall": 2 * period / 3},
        {"type": "ricker", "amplitude": 1.0, "frequency": 1 / period},
        {"type": "cosine", "amplitude": 1.0, "period": period},
        {"type": "sine_burst", "amplitude": 1.0, "frequency": 1 / period, "cycles": 3},
    ][int(rng.integers(4))]
    ends = [
        {"type": "viscous"},
        {"type": "viscous", "beta_p": round(float(rng.uniform(0.6, 1.4)), 2)},
        {"type": "matched_layer", "nodes": int(rng.integers(10, 40))},
        {"type": "fixed", "artificial": False},
        None,
    ]
    boundary = {} if (far := ends[int(rng.integers(5))]) is None else {"right": far}
    entry, load = rng.random(), []
    if entry < 0.2 and not damped:
        boundary["left"] = {"type": "viscous_input", "wave_p": "pulse"}
    elif entry < 0.3:
        boundary["left"] = {"type": "velocity", "wave_p": "pulse"}
    else:
        load = [{"name": "hit", "pressure": 1e6, "wave": "pulse", "nodes": int(rng.choice([1, 1, horizon]))}]
    places = sorted({round(float(length * rng.uniform(0.05, 0.95)), int(rng.integers(2, 4))) for _ in range(2)})
    duration = float(rng.uniform(1.0, 2.5)) * length / speed + period
    steps = [{"courant": round(float(rng.uniform(0.4, 1.0)), 2)}, {"courant": 1.0}, {}][int(rng.integers(3))]
    tables = {
        "bar": bar,
        "method": method,
        "load": load,
        "wave": {"pulse": wave},
        "monitor": [{"name": f"m{k}", "position": place} for k, place in enumerate(places)],
        "boundary": boundary,
        "run": {"duration": duration, **steps},
        "output": {"pictures": False},
    }
    case = small(tables, name=f"bar {seed}")
    assert isinstance(case, BarCase)
    return case


def reference(case: BarCase, step: float) -> dict[str, History]:
    """The motion at the places of the monitors by finite differences in steps of at most `step` (s)."""
    parts, names = case.bar.parts, [given.name for given in case.bar.range]
    requested = max(step, case.bar.travel_time / CELLS)
    cells = [max(20, math.ceil(part.length / part.speed / requested)) for part in parts]
    if (damped := any(part.drag_rate for part in parts)) and case.side("right").is_artificial:
        grown = math.ceil(0.6 * case.run.duration * parts[-1].speed / parts[-1].length) + 1
    else:
        grown = 1
    lengths = [part.length * (grown if k == len(parts) - 1 else 1) for k, part in enumerate(parts)]
    cells[-1] *= grown
    keys = [f"bar.range.{name}" for name in names] or ["bar"]
    changes: dict[str, Any] = {}
    for key, length, count in zip(keys, lengths, cells, strict=True):
        changes |= {f"{key}.length": length, f"{key}.spacing": length / count}
    changes |= {"method": {"type": "finite_difference"}, "run": {"duration": case.run.duration, "courant": 1.0}}
    changes |= {f"load.{load.name}.nodes": 1 for load in case.load}
    ends = {side: table.given() for side, table in case.boundary.items()}
    for side, table in case.boundary.items():
        if table.is_artificial:
            waves = {f"wave_{motion}": name for motion, name in table.waves.items()}
            ends[side] = {"type": "viscous_input" if waves else "viscous", **waves}
    if damped and case.side("right").is_artificial:
        ends.pop("right")
    changes["boundary"] = ends
    fine = with_changes(case, changes | {"monitor": [{"name": "any", "position": 0.0}]})
    assert isinstance(fine, BarCase)
    rod = build_bar(fine).rod
    pairs = {m.name: np.searchsorted(rod.positions, m.position) + np.array([-1, 0]) for m in case.monitor}
    gauges = [
        {"name": f"{name}_{k}", "position": float(rod.positions[node])}
        for name, nodes in pairs.items()
        for k, node in enumerate(nodes)
    ]
    found, _ = recorded_of(with_changes(fine, {"monitor": gauges}))  # type: ignore[arg-type]
    motions = {}
    for monitor in case.monitor:
        low, high = (found[f"{monitor.name}_{k}"] for k in (0, 1))
        at = (monitor.position - low.place[0]) / (high.place[0] - low.place[0])
        values = {q: (1 - at) * v + at * high.values[q] for q, v in low.values.items()}
        motions[monitor.name] = History(low.place, low.time, values)
    return motions


def error_of(case: BarCase, truth: dict[str, History], at_steps: bool = False) -> float:
    """The largest error of all quantities at monitors that move; without the stress of end nodes.

    at_steps : only at the steps of the run, else at all times of the reference.
    """
    recorded, _ = recorded_of(case)
    scene = build_bar(case)
    worst = 0.0
    for name, own in recorded.items():
        at_end = scene.monitors[name] in (0, scene.count - 1)
        for quantity, values in own.values.items():
            if name in loud(truth, quantity) and not (at_end and quantity == "stress"):
                time = own.time if at_steps else truth[name].time
                true = np.interp(time, truth[name].time, truth[name].values[quantity][:, 0])
                rest = at_times(own.time, values[:, :1], time)[:, 0] - true
                worst = max(worst, float(np.linalg.norm(rest) / np.linalg.norm(true)))
    return worst


def cost_of(case: BarCase) -> float:
    """Predicted CPU time of the steps, s."""
    scene = build_bar(case)
    return BarOption(scene, choose_step(scene)[0], {}, "", "").cost


def grid(case: BarCase) -> Iterator[BarCase]:
    """Choices by hand: methods, spacings that divide the bar, steps and ends."""
    breaks = may_break(case)
    loads = {f"load.{load.name}.nodes": 1 for load in case.load}
    methods: list[dict[str, Any]] = [{}]
    if not breaks:
        methods += [loads | {"method": {"type": "finite_difference"}}]
        methods += [{"method.corrected_ends": True}] if case.method.soft_ends else []
    free = [side for side, table in case.boundary.items() if table.is_artificial]
    waves = {side: {f"wave_{m}": w for m, w in case.side(side).waves.items()} for side in free}
    ends: list[dict[str, Any]] = [{}]
    if free:
        kinds = {side: "viscous_input" if waves[side] else "viscous" for side in free}
        ends.append({f"boundary.{side}": {"type": kinds[side], **waves[side]} for side in free})
        ends.append({f"boundary.{side}": {"type": "matched_layer", "nodes": 40, **waves[side]} for side in free})
    parts = case.bar.parts
    keys = [f"bar.range.{given.name}.spacing" for given in case.bar.range] or ["bar.spacing"]
    unit = unit_step(build_bar(case))
    spacings: list[dict[str, Any]] = [{}]
    for factor in np.geomspace(16.0, 1 / 8, 15) if not breaks else []:
        for even in (False, True)[: len(parts)]:
            requested = [factor * (unit * p.speed if even else p.length / p.cells) for p in parts]
            counts = [max(2, round(p.length / w)) for p, w in zip(parts, requested, strict=True)]
            spacings.append({key: p.length / n for key, p, n in zip(keys, parts, counts, strict=True)})
    rest = {"duration": case.run.duration}
    steps = [{}, {"run": rest | {"courant": 1.0}}, {"run": rest | {"safety": 0.98}}]
    for method in methods:
        for spacing in spacings:
            for step in steps:
                for end in ends[:2] if spacing else ends:
                    try:
                        changed = with_changes(case, method | spacing | step | end)
                        choose_step(build_bar(changed))  # type: ignore[arg-type]
                    except DemboundError:
                        continue
                    yield changed  # type: ignore[misc]


def by_hand(case: BarCase, truth: dict[str, History]) -> list[tuple[float, float]]:
    """Cost and true error of the choices of the grid, the cheapest first, up to one within the smallest bound."""
    most, found = MOST_COST * cost_of(case), []
    choices = sorted(((cost_of(each), k, each) for k, each in enumerate(grid(case))), key=lambda each: each[:2])
    for cost, _, each in choices:
        if cost <= most:
            found.append((cost, error_of(each, truth)))
            if found[-1][1] <= min(BOUNDS):
                break
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", type=int, default=20)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--no-grid", action="store_true")
    small_option(parser, scenes=1)
    options = parser.parse_args()
    kept, at_steps, factors, missed, dearer, searched = [], [], [], 0, [], []
    print(
        "| bar | bound | chosen | expected | true at steps, between | steps, ms | by hand, ms | given: true, ms "
        "| tried | search, s |"
    )
    print("|---|---|---|---|---|---|---|---|---|---|")
    for seed in range(options.first, options.first + options.scenes):
        case = random_bar(seed)
        unit = unit_step(build_bar(case))
        truth = reference(case, unit / FINER / 2)
        own = error_of(case, truth)
        hand = [] if options.no_grid else by_hand(case, truth)
        for bound in BOUNDS:
            began = time.process_time()
            try:
                best = advised(case, bound)
            except DemboundError as error:
                print(f"| {seed} | {100 * bound:g} % | refused: {error} |", flush=True)
                continue
            spent = time.process_time() - began
            searched.append(spent)
            chosen = best.case
            assert isinstance(chosen, BarCase)
            if chosen.run.until == "silent":
                chosen = advised(case, bound, ["run.until"]).case  # type: ignore[assignment]
            error = error_of(chosen, truth)
            factors.append((own_steps := error_of(chosen, truth, at_steps=True)) / max(best.error, 1e-3))
            cheapest = next((cost for cost, size in hand if size <= bound), math.inf)
            if best.holds:
                kept.append(error <= bound)
                at_steps.append(own_steps <= bound)
                dearer.append(best.cost / cheapest)
            elif cheapest < math.inf:
                missed += 1
            words = best.words if best.holds else f"none; {best.words}"
            print(
                f"| {seed}: {case.method.name} | {100 * bound:g} % | {words} | {100 * best.error:.3g} % "
                f"| {100 * own_steps:.3g} %, {100 * error:.3g} % | {1e3 * best.cost:.2g} | {1e3 * cheapest:.2g} "
                f"| {100 * own:.2g} %, {1e3 * best.own_cost:.2g} | {best.tried} | {spent:.1f} |",
                flush=True,
            )
    print(
        f"\n{sum(kept)} of {len(kept)} choices keep their bound, {sum(at_steps)} at their steps; "
        f"by hand {missed} were found where none was chosen"
    )
    print(f"true over expected: median {np.median(factors):.3f}, 95 % below {np.quantile(factors, 0.95):.3f}")
    if finite := [each for each in dearer if math.isfinite(each) and each > 0.0]:
        print(f"cost over the cheapest by hand: median {np.median(finite):.2f}, largest {max(finite):.2f}")
    print(f"search: median {np.median(searched):.1f} s, largest {max(searched):.1f} s")


if __name__ == "__main__":
    main()
