"""The lines printed after a run: its results in words, the peaks at its monitors, its files, and the next command."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from dembound.words import columns, in_one_unit

MOST_MONITORS = 10
"""Largest number of monitors whose peaks are printed."""

FILES = ("run.h5", "summary.json", "histories.png", "histories_stress.png", "scene.png", "paraview")
"""Results in the folder of a run in the order of the list, without files for continuing it."""


def ending(folder: Path, summary: Mapping[str, Any], *, estimated: bool = False) -> Iterator[str]:
    """The lines after a run with results in a folder; scripts may read the lines that begin with its name.

    estimated : whether its errors will be estimated, so that the command for it is not printed.
    """
    from dembound.kinds import kind_of_record
    from dembound.results.summary import end_in_words

    name = summary["name"]
    for fact in (*end_in_words(summary), *kind_of_record(folder / "run.h5").outcome(summary)):
        yield f"{name}: {fact}"
    yield from (f"  {line}" for line in peaks(summary["monitors"]))
    yield f"{name}: results in {folder}"
    there = [f"{file}/" if (folder / file).is_dir() else file for file in FILES if (folder / file).exists()]
    yield f"  {', '.join(there)}"
    path = shlex.quote(str(folder))
    yield f"  next: dembound report {path}"
    if summary["monitors"] and not estimated:
        yield f"        dembound estimate {path}"


def peaks(monitors: Mapping[str, Mapping[str, Any]]) -> list[str]:
    """A table of the largest component of velocity at each monitor but twins in a free field: its size and its time."""
    from dembound.casefile.disks.monitor import FREE_FIELD

    own = [name for name in monitors if not name.endswith(FREE_FIELD)]
    shown = {name: monitors[name] for name in own[:MOST_MONITORS]}
    if not shown:
        return []
    sizes, speed = in_one_unit([abs(each["peak_velocity"]) for each in shown.values()], "m/s")
    times, second = in_one_unit([each["peak_time"] or 0.0 for each in shown.values()], "s")
    rows: list[Sequence[str]] = [("monitor", "component", f"peak ({speed})", f"at ({second})")]
    for (name, each), size, time in zip(shown.items(), sizes, times, strict=True):
        moves = each["peak_time"] is not None
        rows.append((name, f"v_{each['component']}" if moves else "-", size, time if moves else "-"))
    more = len(own) - len(shown)
    return [*columns(rows), *([f"… and {more} more in summary.json"] if more else [])]
