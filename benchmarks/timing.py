"""Timing, description of the machine, and printing and writing of measurements for benchmarks."""

import json
import os
import platform
import subprocess
import sys
import time
from argparse import ArgumentParser
from collections.abc import Callable, Iterable, Mapping, Sequence
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

ROOT = Path(__file__).parents[1]

INSTRUCTION_SETS = ("sse4.2", "avx", "avx2", "fma", "avx512f", "neon", "sve")
"""Names of LLVM for the instruction sets that decide how many numbers are computed at once."""


class Times(NamedTuple):
    """Seconds of the CPU, of all threads of the process together, and on the clock."""

    cpu: float
    wall: float

    def of(self, threads: int) -> float:
        """The time to compute rates from: of the CPU for one thread, which other programs do not change, else wall."""
        return self.cpu if threads == 1 else self.wall


def timed(work: Callable[[], object]) -> Times:
    """Times of some work."""
    cpu, wall = time.process_time(), time.perf_counter()
    work()
    return Times(time.process_time() - cpu, time.perf_counter() - wall)


def median_time(work: Callable[[], object], repeats: int) -> float:
    """Median of the CPU seconds that some work of one thread takes; compile it before."""
    return float(np.median([timed(work).cpu for _ in range(repeats)]))


def quartiles(values: Sequence[float]) -> tuple[float, float, float]:
    """First quartile, median and third quartile."""
    low, middle, high = np.percentile(values, [25.0, 50.0, 75.0])
    return float(low), float(middle), float(high)


def _git(*arguments: str) -> str:
    ended = subprocess.run(["git", "-C", str(ROOT), *arguments], capture_output=True, text=True)
    return ended.stdout.strip() if ended.returncode == 0 else ""


def _cpu_model() -> str:
    info = Path("/proc/cpuinfo")
    lines = info.read_text().splitlines() if info.is_file() else []
    return next(
        (line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), platform.processor()
    )


def _caches() -> dict[str, str]:
    """Sizes of the caches that the first core uses, by level and type; empty where the system does not list them."""
    folders = sorted(Path("/sys/devices/system/cpu/cpu0/cache").glob("index*"))
    read = [[(folder / name).read_text().strip() for name in ("level", "type", "size")] for folder in folders]
    return {f"L{level} {kind.lower()}": size for level, kind, size in read}


def _version(package: str) -> str | None:
    try:
        return version(package)
    except PackageNotFoundError:
        return None


def instruction_sets() -> list[str]:
    """The instruction sets that decide how many numbers are computed at once, of those that numba compiles for."""
    from llvmlite import binding

    chosen = os.environ.get("NUMBA_CPU_FEATURES")
    if chosen is not None:
        return [name for name in INSTRUCTION_SETS if f"+{name}" in chosen.split(",")]
    features = binding.get_host_cpu_features()
    return [name for name in INSTRUCTION_SETS if features.get(name)]


def machine() -> dict[str, Any]:
    """Processor, versions and revision that were measured, and the load of the machine by others before."""
    from llvmlite import binding

    return {
        "cpu": _cpu_model(),
        "architecture": binding.get_host_cpu_name(),
        "instruction_sets": instruction_sets(),
        "cores": len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count(),
        "caches": _caches(),
        "load_before": os.getloadavg()[0] if hasattr(os, "getloadavg") else None,
        "python": platform.python_version(),
        **{package: _version(package) for package in ("numpy", "numba")},
        "revision": _git("describe", "--always", "--dirty", "--abbrev=12"),
    }


def in_one_line(facts: Mapping[str, Any]) -> str:
    """The machine in one line."""
    return (
        f"{facts['cpu']}, {facts['cores']} cores ({', '.join(facts['instruction_sets'])}); Python {facts['python']}, "
        f"numpy {facts['numpy']}, numba {facts['numba']}; revision {facts['revision'] or 'unknown'}"
    )


def small_option(parser: ArgumentParser, **small: Any) -> None:
    """Add --small to a command: its smallest measurement, by these values of options that are not given."""
    parser.add_argument("--small", action="store_true", help="the smallest measurement, to see that the command runs")
    if "--small" in sys.argv:
        parser.set_defaults(json=Path("results/benchmarks/small.json"), **small)


def show(title: str, columns: Mapping[str, str], rows: Iterable[Mapping[str, Any]]) -> None:
    """Print rows as a table in Markdown; columns: heading → key and format of `str.format`, as "{count:,}"."""
    cells = [list(columns), *([form.format(**row) for form in columns.values()] for row in rows)]
    widths = [max(len(cell) for cell in column) for column in zip(*cells, strict=True)]
    cells.insert(1, ["-" * width for width in widths])
    print(f"\n{title}\n")
    for row in cells:
        print("| " + " | ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)) + " |", flush=True)


def write(path: Path, facts: Mapping[str, Any]) -> None:
    """Write what was measured as JSON."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(facts, indent=1) + "\n", encoding="utf-8")
    print(f"\nwritten: {path}")
