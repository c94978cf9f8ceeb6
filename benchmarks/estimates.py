"""Estimated errors compared with true ones, on 79 small scenes of disks.

    python benchmarks/estimates.py [--scenes lamb "bar A" ...] [--json FILE]

Each scene is run, its error is estimated, and measured with its reference: the same disks with sides so far away that
nothing returns, which gives only the error of the sides, disks three times smaller, or an exact solution. Errors are
RMS over RMS, of the component with the largest value. `corrected` is the remaining error when the estimated history
is subtracted, `gained` the original error over it, bracketed where the larger companion has echoes of its own, for
which no corrected history is offered.
"""

import argparse
import os
import sys
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from estimate_scenes import FINER, Scene, scenes
from timing import in_one_line, machine, show, small_option, write

os.environ["NUMBA_NUM_THREADS"] = "1"  # before numba is imported

LEAST = 1e-3
"""Largest error over the largest value from which on a monitor counts."""

COLUMNS = {
    "scene": "{scene}",
    "monitor": "{monitor}",
    "quantity": "{quantity}",
    "truth, %": "{truth}",
    "estimate, %": "{estimate}",
    "ratio": "{ratio}",
    "diameters": "{diameters}",
    "work": "{cost}",
    "corrected, %": "{corrected}",
    "gained": "{gained}",
}


def reference_of(scene: Scene, case: Any, recorded: Mapping[str, Any]) -> dict[str, dict[str, np.ndarray]]:
    """The reference's velocities and displacements (k, 2) at the monitors and at the times of the run."""
    from scipy.interpolate import CubicSpline

    if scene.reference == "layer":
        return {name: in_layer(case, own) for name, own in recorded.items()}
    gauges = _gauges(scene, case)
    times = next(iter(recorded.values())).time
    return {
        name: {
            quantity: CubicSpline(gauge.time, gauge.values[quantity][:, :2])(np.minimum(times, gauge.time[-1]))
            for quantity in ("velocity", "displacement")
        }
        for name, gauge in gauges.items()
        if name in recorded
    }


def _gauges(scene: Scene, case: Any) -> Mapping[str, Any]:
    """Records of the monitors of the reference."""
    from dembound.accuracy.judge import extended
    from dembound.accuracy.runner import measure
    from dembound.kinds import with_changes
    from dembound.running import Progress

    if scene.reference == "finer":
        case = with_changes(case, {"packing.radius": case.packing.radius / FINER})
    larger = with_changes(case, dict(scene.changes)) if scene.reference == "changed" else extended(case).case
    return measure(larger, Progress())[0].motions


def in_layer(case: Any, own: Any) -> dict[str, np.ndarray]:
    """Exact motion of a layer with a free top under the wave of its bottom, when it enters: upwards and back again."""
    from dembound.boundaries import axis_of_motion
    from dembound.disks.scene import build
    from dembound.formulas.disks.entry import late_by

    ((motion, name),) = case.driving["bottom"].items()
    wave, height = case.wave[name], case.packing.extent[1]
    speed = build(case).ground.wave_speeds(1)[0 if motion == "p" else 1]
    late = late_by(build(case))
    found = {quantity: np.zeros((len(own.time), 2)) for quantity in ("velocity", "displacement")}
    column = axis_of_motion("bottom", motion)
    for way in (own.place[1], 2.0 * height - own.place[1]):
        found["velocity"][:, column] += wave.velocity(own.time - late - way / speed)
        found["displacement"][:, column] += wave.displacement(own.time - late - way / speed)
    return found


def measured(scene: Scene) -> tuple[list[dict[str, Any]], list[str]]:
    """Rows of the table of one scene, and what its estimate says that it has not estimated."""
    import tomli_w

    from dembound.accuracy.budget import Budget
    from dembound.accuracy.estimate import causes_of
    from dembound.accuracy.runner import measure
    from dembound.formulas.history import History
    from dembound.kinds import loads
    from dembound.running import Progress

    case = loads(tomli_w.dumps(scene.tables), name="scene")
    run, stepping, _ = measure(case, Progress())
    recorded = {
        name: History(
            gauge.place,
            gauge.time,
            {"velocity": gauge.velocity[:, :2], "displacement": gauge.displacement[:, :2]},
        )
        for name, gauge in run.motions.items()
    }
    causes = causes_of(case, recorded, run.time_step, run.work)
    if scene.reference == "extended":  # which has the same grid, step, and sides through which waves enter
        alike = ("time step", "time step at kinks", *(f"{side} side" for side in case.driving))
        causes = replace(causes, found=[cause for cause in causes.found if cause.name not in alike])
    found = Budget(causes.motions or recorded, causes, "rock" if scene.reference in ("finer", "layer") else "disks")
    expected = reference_of(scene, case, recorded)
    rows = [
        _row(scene, found, recorded, name, quantity, expected[name][quantity])
        for name in expected
        for quantity in expected[name]
    ]
    return [row | {"stepping": stepping} for row in rows], [
        f"{each.name}: {each.words}" for each in causes.unknown
    ] + list(causes.limits)


def _row(scene: Scene, found: Any, recorded: Any, monitor: str, quantity: str, expected: np.ndarray) -> dict[str, Any]:
    """A row of the table for one monitor and quantity."""
    own = recorded[monitor]
    column = own.component(quantity)
    values, expected = own.values[quantity][:, column], expected[:, column]
    size = float(np.linalg.norm(expected))
    truth = float(np.linalg.norm(values - expected)) / size
    total = found.total(monitor, quantity)
    estimate = total.value
    row = {
        "scene": scene.name,
        "family": scene.family,
        "monitor": monitor,
        "quantity": quantity,
        "truth": truth,
        "peak": float(np.abs(values - expected).max() / np.abs(values).max()),
        "estimate": estimate,
        "upper": total.upper,
        "ratio": estimate / truth if truth > 0.0 else np.nan,
        "cost": found.causes.cost,
        "how": {cause.name: cause.words for cause in found.causes.found},
        "shares": found.shares(monitor, quantity),
        "echo_free": found.causes.echo_free,
    }
    sides = next((cause for cause in found.causes.found if cause.name == "sides"), None)
    part = sides.parts.get(monitor, {}).get(quantity) if sides else None
    if isinstance(part, np.ndarray):
        error = replace(found.motions[monitor], values={quantity: part}).at(own.time).values[quantity]
        row["corrected"] = float(np.linalg.norm(values - error[:, column] - expected)) / size
        row["gained"] = truth / row["corrected"]
    return row


def counts(row: Mapping[str, Any]) -> bool:
    """Whether an error is large enough to be judged."""
    return bool(row["peak"] >= LEAST)


def in_words(row: Mapping[str, Any]) -> dict[str, Any]:
    """A row as it is printed."""
    words = dict(row)
    words |= {key: f"{100.0 * row[key]:.2g}" if key in row else "–" for key in ("truth", "estimate", "corrected")}
    words |= {"ratio": f"{row['ratio']:.2f}", "cost": f"{100.0 * row['cost']:.2g} %"}
    words["diameters"] = next((text.split("×")[0].split()[-1] for text in row["how"].values() if "×" in text), "–")
    gained = f"{row['gained']:.1f}" if "gained" in row else "–"
    words["gained"] = gained if row["echo_free"] or gained == "–" else f"({gained})"
    return words


def families(rows: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """A summary of each family of scenes."""
    found = []
    for family in [*dict.fromkeys(row["family"] for row in rows), "all"]:
        own = [row for row in rows if family in (row["family"], "all") and counts(row)]
        if not own:
            continue
        ratios = np.array([row["ratio"] for row in own])
        known = ratios[np.isfinite(ratios)]
        gained = [row["gained"] for row in own if "gained" in row and row["echo_free"]]
        within = np.mean((ratios >= 1.0 / 3.0) & (ratios <= 3.0))
        found.append(
            {
                "family": family,
                "scenes": len({row["scene"] for row in own}),
                "rows": len(own),
                "least": f"{known.min():.2f}" if len(known) else "–",
                "median": f"{np.median(known):.2f}" if len(known) else "–",
                "most": f"{known.max():.2f}" if len(known) else "–",
                "within": f"{100.0 * within:.0f} %",
                "gained": f"{np.median(gained):.1f} ({min(gained):.1f} to {max(gained):.1f})" if gained else "–",
            }
        )
    return found


def main() -> None:
    """Measure all, print and write."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", nargs="+", default=[], help="those whose names begin so; by default all")
    parser.add_argument("--json", type=Path, default=Path("results/benchmarks/estimates.json"))
    small_option(parser, scenes=["bar A P β × 1.5", "continuum A bench"])
    options = parser.parse_args()
    from dembound.errors import DemboundError

    rows: list[dict[str, Any]] = []
    missing: list[str] = []
    for scene in scenes():
        if options.scenes and not scene.name.startswith(tuple(options.scenes)):
            continue
        began = time.process_time()
        try:
            own, lacking = measured(scene)
        except DemboundError as error:
            missing.append(f"{scene.name}: {error}")
            print(missing[-1], file=sys.stderr, flush=True)
            continue
        rows += own
        missing += [f"{scene.name}: {line}" for line in lacking]
        ratios = [f"{row['ratio']:.2f}" for row in own if counts(row)]
        print(f"{scene.name}: {', '.join(ratios)}; {time.process_time() - began:.0f} s", file=sys.stderr, flush=True)
    facts = machine()
    print(in_one_line(facts))
    show("all monitors whose error is at least 0.1 % of the peak", COLUMNS, map(in_words, filter(counts, rows)))
    show("families", {key: f"{{{key}}}" for key in (families(rows) or [{}])[0]}, families(rows))
    for line in missing:
        print(f"- {line}")
    write(options.json, {"machine": facts, "rows": rows, "missing": missing})


if __name__ == "__main__":
    main()
