"""Speed of stepping and packing disks, and its share of what the machine can do.

    python benchmarks/rates.py [--sections steps copies ...] [--threads 1 2] [--json results/benchmarks/rates.json]

Sections:

steps     particle-steps per second of shipped cases under the elastic law and both geometries of the full law: the
          compiled loop, and all of `Simulation.advance`; share of the bandwidth of an array copy measured at the time
copies    particle-steps per second for 1 to 100 copies of a brick
sizes     particle-steps per second for 1e4 to 1e6 particles, with --large also 4e6
packing   CPU seconds of packing a brick

Everything is compiled first; blocks of a fraction of a second are timed and their medians taken. Rates of one thread
are computed from CPU time, which other programs on the machine hardly change, those of several from wall time.
"""

import argparse
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numba
import numpy as np
import pack_rate
from stepping import LAWS, bar, prepare, set_in_motion, steps_for
from timing import ROOT, Times, in_one_line, machine, quartiles, show, small_option, timed, write
from traffic import cost_of_step

from dembound.kernels import loop
from dembound.motion.memory import thread_count_for
from dembound.motion.simulation import Simulation

CASES = {
    "quickstart": "quickstart",
    "long_bar_b": "zhou2018/long_bar_b",
    "long_bar_a": "zhou2018/long_bar_a",
    "tunnel_a": "zhou2018/tunnel_a",
    "tunnel_b": "zhou2018/tunnel_b",
}
"""Cases of the section `steps` → their files."""

WITH_ALL_LAWS = ("quickstart", "long_bar_b")

COPIES = ((1, 1), (2, 1), (2, 2), (3, 3), (5, 4), (10, 10))

SIZES = (5, 46, 463)
LARGE = 1852
"""Bricks of 432 disks along a bar five bricks high."""

COLUMNS = {
    "case": "{case}",
    "law": "{law}",
    "particles": "{count:,}",
    "threads": "{threads}",
    "M particle-steps/s": "{rate:.1f}",
    "spread": "{rate_low:.0f}–{rate_high:.0f}",
    "ns, loop": "{loop_ns:.2f}",
    "ns, advance": "{advance_ns:.2f}",
    "CPU ns": "{cpu_ns:.2f}",
    "bytes": "{bytes:.0f}",
    "flops": "{flops:.0f}",
    "Gflop/s": "{gflops:.1f}",
    "GB/s": "{moved:.1f}",
    "GB/s, copy": "{copied:.1f}",
    "share": "{share:.0%}",
}


@numba.njit(parallel=True)
def copy(source, target):
    for i in numba.prange(source.size):
        target[i] = source[i]


class TimedLoop:
    """The compiled loop, whose times are added up."""

    def __init__(self) -> None:
        self._loop, self.spent = loop.advance, Times(0.0, 0.0)

    def __call__(self, *arguments: Any) -> Any:
        """Call the loop."""
        results: list[Any] = []
        times = timed(lambda: results.append(self._loop(*arguments)))
        self.spent = Times(self.spent.cpu + times.cpu, self.spent.wall + times.wall)
        return results[0]


def step_rate(simulation: Simulation, threads: int, options: argparse.Namespace) -> dict[str, Any]:
    """Rates of a simulation, whose particles are set in motion; a row of `COLUMNS` without its case and law."""
    numba.set_num_threads(threads)
    set_in_motion(simulation)
    steps, count, in_loop = steps_for(simulation, options.seconds), simulation.scene.count, loop.advance
    cost = cost_of_step(simulation)
    source = np.ones(int(cost.bytes / 24.0))
    target = np.zeros_like(source)
    copies = max(1, round(options.seconds * 5e9 / cost.bytes))
    copy(source, target)
    blocks, alone, streams = [], [], []
    for _ in range(options.repeats):
        in_loop.spent = Times(0.0, 0.0)
        blocks.append(timed(lambda: simulation.advance(steps)))
        alone.append(in_loop.spent.of(threads))
        streams.append(timed(lambda: [copy(source, target) for _ in range(copies)]).of(threads) / copies)
    each = 1e9 / (steps * count)
    low, advance, high = quartiles([block.of(threads) * each for block in blocks])
    copied = 24e-9 * source.size / float(np.median(streams))
    moved = cost.bytes / count / advance
    return {
        "count": count,
        "threads": threads,
        "steps": steps * options.repeats,
        "rate": 1e3 / advance,
        "rate_low": 1e3 / high,
        "rate_high": 1e3 / low,
        "loop_ns": float(np.median(alone)) * each,
        "advance_ns": advance,
        "cpu_ns": float(np.median([block.cpu for block in blocks])) * each,
        "wall_ns": float(np.median([block.wall for block in blocks])) * each,
        "bytes": cost.bytes / count,
        "flops": cost.flops / count,
        "gflops": cost.flops / count / advance,
        "moved": moved,
        "copied": copied,
        "share": moved / copied,
    }


def threads_used(simulation: Simulation, allowed: int) -> int:
    """How many of the allowed threads step a simulation: small ones are stepped by fewer."""
    numba.set_num_threads(allowed)
    return thread_count_for(simulation.scene.count)


def stepped(cases: Iterator[tuple[str, str, str]], options: argparse.Namespace) -> list[dict[str, Any]]:
    """Rows for cases, each a name, the case and a law, for all numbers of threads."""
    rows = []
    for name, case, law in cases:
        simulation = prepare(case, law)
        threads = sorted({threads_used(simulation, n) for n in options.threads})
        rows += [{"case": name, "law": law, **step_rate(simulation, n, options)} for n in threads]
        print(".", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    return rows


def steps(options: argparse.Namespace) -> list[dict[str, Any]]:
    chosen = [
        (name, str(ROOT / "cases" / f"{CASES[name]}.toml"), law)
        for law in LAWS
        for name in options.cases
        if law == "elastic" or name in WITH_ALL_LAWS
    ]
    rows = stepped(iter(chosen), options)
    show("Steps", COLUMNS, rows)
    return rows


def copies(options: argparse.Namespace) -> list[dict[str, Any]]:
    chosen = [
        (f"{x} × {y} bricks", bar("B", x, y), law)
        for law in list(LAWS)[:2]
        for x, y in COPIES[: 3 if options.small else None]
    ]
    rows = stepped(iter(chosen), options)
    show("Copies of a brick", COLUMNS, rows)
    return rows


def sizes(options: argparse.Namespace) -> list[dict[str, Any]]:
    across = SIZES[:1] if options.small else [*SIZES, *([LARGE] if options.large else [])]
    rows = stepped((("bar of bricks", bar("B", x, 5), "elastic") for x in across), options)
    show("Number of particles", COLUMNS, rows)
    return rows


def packing(options: argparse.Namespace) -> list[dict[str, Any]]:
    return pack_rate.measured([10.0, 50.0] if options.large else [10.0], options.repeats)


SECTIONS: dict[str, Callable[[argparse.Namespace], list[dict[str, Any]]]] = {
    "steps": steps,
    "copies": copies,
    "sizes": sizes,
    "packing": packing,
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sections", nargs="+", choices=SECTIONS, default=list(SECTIONS), metavar="SECTION")
    parser.add_argument("--cases", nargs="+", choices=CASES, default=list(CASES), metavar="CASE", help="of `steps`")
    parser.add_argument("--threads", type=int, nargs="+", default=sorted({1, min(2, numba.config.NUMBA_NUM_THREADS)}))
    parser.add_argument("--repeats", type=int, default=7, help="blocks of each measurement")
    parser.add_argument("--seconds", type=float, default=0.3, help="CPU seconds of a block")
    parser.add_argument("--large", action="store_true", help="also 4 million particles and a brick of 10,795 disks")
    parser.add_argument("--json", type=Path, default=Path("results/benchmarks/rates.json"))
    small_option(parser, cases=["tunnel_a"], repeats=1, seconds=0.05)
    options = parser.parse_args()
    facts = machine()
    print(in_one_line(facts))
    loop.advance = TimedLoop()
    write(options.json, {"machine": facts, **{name: SECTIONS[name](options) for name in options.sections}})


if __name__ == "__main__":
    main()
