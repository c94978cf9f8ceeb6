"""Lu & Wang (2016), table 2: places, times and costs of spalls, as Markdown.

    python cases/lu2016/spall_costs.py [--repeats 41] RUN...

Each case is run anew to its first spall, in this process and compiled before; the time is the median of the repeats,
without building the bar. Ratios are to the run with only peridynamics of the same spacing.
"""

import argparse
import statistics
import time
from itertools import product
from pathlib import Path

import numpy as np

from dembound.casefile.bar import BarCase
from dembound.motion.simulation import Simulation
from dembound.papers.figure import markdown
from dembound.papers.spalled import MILLI, case_of, expected_spall, first_spall, in_millimetres, name_of
from dembound.running import plan

PRINTED = {"PD3": ("0.478", "2.00 (1)"), "PD1–PD3": ("0.466", "0.95 (0.475)"), "FDM–PD3": ("0.464", "0.53 (0.265)")}
"""t_F in ms and the time of computation in s, with its ratio to the first."""

HEADS = (
    *("Δx (mm)", "method", "x_F (mm)", "t_F (ms)", "printed"),
    *("bond updates", "ratio", "time (ms)", "ratio", "printed (s)"),
)


def costs(runs: dict[Path, BarCase], repeats: int) -> dict[Path, tuple[int, float]]:
    """For each run the number of bond forces computed up to its first spall, and the time, s."""
    planned = {run: plan(case) for run, case in runs.items()}
    steps = {run: round(first_spall(run)["time"] / each.time_step) + 1 for run, each in planned.items()}
    updates, times = {}, {run: [] for run in runs}
    for _, run in product(range(repeats + 1), runs):  # in turn, so that other work meets all alike
        scene = planned[run].scene
        simulation = Simulation(scene, planned[run].time_step, np.array(list(scene.monitors.values())))
        began = time.perf_counter()
        simulation.run(steps[run])
        times[run].append(time.perf_counter() - began)
        updates[run] = simulation.system.parts[0].bond_updates
    return {run: (updates[run], statistics.median(times[run][1:])) for run in runs}  # the first loads what is compiled


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", type=Path, nargs="+", metavar="RUN")
    parser.add_argument("--repeats", type=int, default=41)
    options = parser.parse_args()
    cases = {run: case_of(run) for run in options.runs}
    measured = costs(cases, options.repeats)
    whole = {case.bar.spacing: measured[run] for run, case in cases.items() if case.method.type == "peridynamics"}
    rows = []
    for run, (updates, seconds) in measured.items():
        case, found = cases[run], first_spall(run)
        all_updates, all_seconds = whole[case.bar.spacing]
        time_printed, cost_printed = PRINTED.get(name_of(case), ("", "")) if case.bar.spacing == 0.01 else ("", "")
        place = in_millimetres(found["start"]), f"{found['time'] / MILLI:.4f}", time_printed
        bonds = f"{updates:,}", f"{updates / all_updates:.3f}"
        clock = f"{seconds / MILLI:.2f}", f"{seconds / all_seconds:.2f}", cost_printed
        rows.append((f"{case.bar.spacing / MILLI:g}", name_of(case), *place, *bonds, *clock))
    print(markdown(HEADS, rows))
    x, t = expected_spall(next(iter(cases.values())))
    print(f"\nBy the closed form {x / MILLI:.1f} mm, {t / MILLI:.4f} ms")


if __name__ == "__main__":
    main()
