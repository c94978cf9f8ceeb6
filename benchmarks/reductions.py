"""Savings by reductions on the shipped cases, and the difference of the results from those without them.

    python benchmarks/reductions.py [--cases zhou2018/long_bar_a ...] [--seconds 20] [--repeats 3] [--json FILE]

Every case is run with and without each reduction that applies to it, in turns, on one thread: CPU time of stepping, and
of the whole run without pictures (the smallest of the repeats; building, settling and the ledger included), and the
largest difference of any monitor's velocity over the largest velocity. Runs whose stepping would take longer than
`--seconds` are shortened, except for `silent`, which saves the end of a run. Why the other cases have no reduction is
printed below the table.
"""

import argparse
import os
import sys
import tempfile
import time
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from timing import ROOT, in_one_line, machine, show, small_option, timed, write

os.environ["NUMBA_NUM_THREADS"] = "1"  # before numba is imported

SWITCHES: dict[str, tuple[dict[str, Any], dict[str, Any]]] = {
    "rows": ({"reduce.rows": True}, {"reduce.rows": False}),
    "settled": ({"reduce.settled": True}, {"reduce.settled": False}),
    "silent": ({"run.until": "silent"}, {}),
    "no fields": ({"output.snapshots": 0}, {}),
}
"""Reductions -> changes of a case with and without it."""

VARIANTS: dict[str, tuple[str, str, dict[str, Any]]] = {
    "zhou2018/long_bar_a, for 10 s": ("silent", "zhou2018/long_bar_a", {"run.duration": 10.0}),
    "zhou2018/lamb_viscous, for 10 s": (
        "silent",
        "zhou2018/lamb_viscous",
        {"run.duration": 10.0, "run.until": "silent", "run.silent_level": 0.02},
    ),
    "gravity, a lattice under a given stress": (
        "settled",
        "gravity",
        {
            "packing": {"pattern": "A", "size": [40.0, 20.0], "radius": 0.25},
            "load": [],
            "static": {"damp": 0.3, "stress": [-1e5, -1e5, 0.2e5]},
            "material.pb_ten": 50e6,
            "material.pb_coh": 50e6,
            "wave.pulse.amplitude": 0.01,
        },
    ),
}
"""Variants of cases for reductions that no case has as it is: name -> reduction, case, changes."""

COLUMNS = {
    "reduction": "{reduction}",
    "case": "{case}",
    "disks or nodes": "{count:,} of {whole:,}",
    "steps": "{steps:,} of {all_steps:,}",
    "stepping, s": "{stepping}",
    "saved": "{saved:.0%}",
    "whole run, s": "{total:.3g} of {total_without:.3g}",
    "difference": "{difference}",
    "files, MB": "{files}",
}

TRIAL = 200
"""Steps from which the time of a run is estimated."""


@dataclass
class Ran:
    """One run: nodes and steps done, velocities (k, p, 2) m/s of all monitors, CPU s; of one with files MB written."""

    count: int
    steps: int
    velocity: np.ndarray
    total: float
    stepping: float | None = None
    files: float | None = None


def in_memory(case: Any) -> Ran:
    """Run a case without files."""
    from dembound.accuracy.runner import measure
    from dembound.running import Progress

    began = time.process_time()
    outcome, stepping, _ = measure(case, Progress())
    total = time.process_time() - began
    velocity = np.stack([gauge.velocity[:, :2] for gauge in outcome.motions.values()], axis=1)
    return Ran(outcome.count, len(velocity), velocity, total, stepping)


def with_files(case: Any) -> Ran:
    """Run a case as the command does, but without pictures."""
    import h5py

    from dembound.running import plan, run_case

    count = plan(case).stepped.count
    with tempfile.TemporaryDirectory() as folder:
        total = timed(lambda: run_case(case, Path(folder))).cpu
        files = [path for path in Path(folder).rglob("*") if path.is_file()]
        record = next(path for path in files if path.name == "run.h5")
        with h5py.File(record) as file:
            velocity = np.stack([group["velocity"][:, :2] for group in file["histories"].values()], axis=1)
        size = sum(path.stat().st_size for path in files) / 1e6
    return Ran(count, len(velocity), velocity, total, files=size)


def reason_without(case: Any, reduction: str) -> str:
    """Why a reduction does not apply to a case, as known before its run; empty if it may."""
    from dembound.disks.reduced import identical_row
    from dembound.disks.scene import DiskScene
    from dembound.disks.stepping.first_law import never_elastic_again
    from dembound.kinds import kind_of

    if reduction == "silent":
        return "" if case.monitor else "there are no monitors"
    if reduction == "no fields":
        return ""
    scene = kind_of(case).build(case)
    if not isinstance(scene, DiskScene):
        return "it is a bar of nodes"
    if reduction == "settled":
        return never_elastic_again(case)
    return "" if identical_row(scene) else "no rows of bricks move identically"


def shortened(case: Any, seconds: float) -> Any:
    """The case with a duration that takes about so many CPU seconds of stepping, its own if that is less."""
    from dembound.kinds import with_changes
    from dembound.motion.simulation import Simulation
    from dembound.running import plan

    planned = plan(case)
    simulation = Simulation(planned.stepped, planned.time_step)
    simulation.advance(2)
    taken = timed(partial(simulation.advance, TRIAL)).cpu / TRIAL * planned.steps
    share = min(1.0, seconds / taken)
    return case if share == 1.0 else with_changes(case, {"run.duration": float(f"{share * case.run.duration:.3g}")})


def not_made(case: Any, reduction: str) -> str:
    """Why a reduction was not made that only a run decides about; empty if it was."""
    from dembound.motion.trackers import Clock
    from dembound.running import Progress, plan, simulation_of

    if reduction not in ("settled", "silent"):
        return ""
    planned = plan(case)
    beginning = planned.kind.begin(planned.stepped, planned.time_step, Progress().settling)
    simulation, _ = simulation_of(planned, beginning, Clock())
    if reduction == "settled":
        return "; ".join(simulation.system.refused)
    simulation.run(planned.steps)
    return "" if simulation.stopped else "monitors are not silent before the end"


def compared(case: Any, name: str, reduction: str, options: argparse.Namespace) -> dict[str, Any] | str:
    """A row of the table: a case with and without a reduction, in turns; or why the reduction is not made."""
    from dembound.kinds import with_changes

    changes, back = SWITCHES[reduction]
    case = with_changes(case, {"output.pictures": False})
    if reduction == "silent":
        back = {"run.until": "silent", "run.silent_for": case.run.duration}  # it never ends early
    else:
        case = shortened(with_changes(case, back), options.seconds)
    cases = with_changes(case, changes), with_changes(case, back)
    if reason := not_made(cases[0], reduction):
        return reason
    run = with_files if reduction == "no fields" else in_memory
    runs: list[list[Ran]] = [[], []]
    for turn in range(options.repeats + 1):  # the first of each compiles
        for k in (0, 1) if turn % 2 == 0 else (1, 0):
            runs[k].append(run(cases[k]))
    return {"reduction": reduction, "case": name, **_row(*runs)}


def _row(small: list[Ran], whole: list[Ran]) -> dict[str, Any]:
    """The numbers of a row, from all runs with and without a reduction."""
    common = min(small[0].steps, whole[0].steps)
    largest = np.abs(whole[0].velocity).max(initial=0.0) or 1.0
    difference = np.abs(small[0].velocity[:common] - whole[0].velocity[:common]).max(initial=0.0) / largest
    total, total_without = (min(run.total for run in some[1:]) for some in (small, whole))
    saved, stepping, files = 1.0 - total / total_without, "–", "–"
    if small[0].stepping is not None:
        least, least_without = (min(run.stepping or 0.0 for run in some[1:]) for some in (small, whole))
        saved, stepping = 1.0 - least / least_without, f"{least:.3g} of {least_without:.3g}"
    if small[0].files is not None:
        files = f"{small[0].files:.3g} of {whole[0].files:.3g}"
    return {
        "count": small[0].count,
        "whole": whole[0].count,
        "steps": small[0].steps,
        "all_steps": whole[0].steps,
        "stepping": stepping,
        "saved": saved,
        "total": total,
        "total_without": total_without,
        "difference": f"{difference:.1e}" if difference else "same bits",
        "files": files,
    }


def shipped(names: list[str]) -> Iterator[tuple[str, Any, list[str]]]:
    """Names, cases and reductions of the shipped cases, without those of charts, which are the same scenes.

    names : of the requested cases; all if empty.
    """
    from dembound.kinds import load, with_changes

    folder = ROOT / "cases"
    for path in sorted(folder.rglob("*.toml")):
        name = path.relative_to(folder).with_suffix("").as_posix()
        if not name.startswith("charts/") and (not names or name in names):
            yield name, load(path), list(SWITCHES)
    for name, (reduction, case, changes) in VARIANTS.items():
        if not names or name in names:
            yield name, with_changes(load(folder / f"{case}.toml"), changes), [reduction]


def main() -> None:
    """Measure all, print and write."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cases", nargs="+", default=[], help="by default all, without those of charts")
    parser.add_argument("--reductions", nargs="+", choices=SWITCHES, default=list(SWITCHES))
    parser.add_argument("--seconds", type=float, default=20.0, help="longest stepping without the reduction, CPU s")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--json", type=Path, default=Path("results/benchmarks/reductions.json"))
    small_option(parser, cases=["gallery/p_pulse"], seconds=0.5, repeats=1)
    options = parser.parse_args()
    rows: list[dict[str, Any]] = []
    without: defaultdict[str, list[str]] = defaultdict(list)
    for name, case, possible in shipped(options.cases):
        for reduction in (each for each in possible if each in options.reductions):
            if reason := reason_without(case, reduction):
                without[f"{reduction}: {reason}"].append(name)
                continue
            row = compared(case, name, reduction, options)
            if isinstance(row, str):
                without[f"{reduction}: {row}"].append(name)
                continue
            rows.append(row)
            print(f"{name}, {reduction}: {row['saved']:.0%}", file=sys.stderr)
    facts = machine()
    print(in_one_line(facts))
    rows.sort(key=lambda row: list(SWITCHES).index(row["reduction"]))
    show("with a reduction, of without; one thread", COLUMNS, rows)
    print()
    for reason, names in sorted(without.items()):
        print(f"- {reason}: {', '.join(names)}")
    write(options.json, {"machine": facts, "rows": rows, "without": dict(without)})


if __name__ == "__main__":
    main()
