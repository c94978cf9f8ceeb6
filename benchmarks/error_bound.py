"""How often the choice of `dembound run --error` is as accurate as asked for: small scenes beside enlarged, finer ones.

    python benchmarks/error_bound.py [NAME...]           # scenes whose names contain one of these; all by default
    python benchmarks/error_bound.py --every NAME...     # runs every choice of a scene, and prints the cheapest ones

The reference of a scene is a larger one, from whose sides nothing returns. It is run with its own disks and with a
third of their diameter, whose particles include the places of the first. As the errors of both are in the ratio 9 : 1,
the motion is extrapolated to (9 u_fine - u_own)/8. Where waves enter at particles of a side these are at another place
with smaller disks, and times are shifted by the way between.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import tomli_w

from dembound.boundaries import normal_axis
from dembound.casefile.disks import DiskCase
from dembound.disks.scene import build
from dembound.kinds import loads, with_changes
from dembound.running import Progress, plan
from dembound.studies.accuracy import choose
from dembound.studies.accuracy.candidates import FACTORS, Candidate, candidates, cost_of, with_diameter
from dembound.studies.accuracy.companions import Companions
from dembound.studies.accuracy.of_disks import COSTLIEST
from dembound.studies.chart.errors import QUIET
from dembound.studies.chart.measure import Gauges, measure
from dembound.studies.estimate.of_run import SHORT
from dembound.studies.extended import extended

BOUNDS = (0.003, 0.01, 0.03, 0.1)
FINER = 3
QUANTITIES = ("velocity", "displacement")

Tables = dict[str, Any]
MATERIAL = {"density": 2500.0, "p_wave_speed": 1000.0}
WAVES: dict[str, Tables] = {
    "ricker": {"type": "ricker", "amplitude": 1.0, "frequency": 10.0},
    "cosine": {"type": "cosine", "amplitude": 1.0, "period": 0.08},
}
VISCOUS: Tables = {"type": "viscous"}


def lamb(sides: str, wide: float, high: float, wave: str) -> Tables:
    """A force on the surface of a half-space."""
    middle = 0.5 * wide
    tables = {"type": sides} | ({"source": [middle, high]} if sides == "viscoelastic" else {})
    return {
        "packing": {"pattern": "A", "size": [wide, high], "radius": 0.5},
        "material": MATERIAL,
        "boundary": {side: tables for side in ("left", "right", "bottom")},
        "wave": {"pulse": WAVES[wave]},
        "load": [
            {"name": "hit", "force": [0.0, -1e6], "region": _around(middle, high - 0.5, 4.0, 1.0), "wave": "pulse"}
        ],
        "monitor": [
            {"name": "surface", "position": [middle + 10.5, high - 0.5]},
            {"name": "deep", "position": [middle + 4.5, high - 8.5]},
        ],
        "run": {"duration": 0.2},
    }


def embedded(wide: float, wave: str, force: tuple[float, float]) -> Tables:
    """A force within rock that goes on beyond all sides."""
    middle = 0.5 * wide
    return {
        "packing": {"pattern": "A", "size": [wide, wide], "radius": 0.5},
        "material": MATERIAL,
        "boundary": dict.fromkeys(("left", "right", "bottom", "top"), VISCOUS),
        "wave": {"pulse": WAVES[wave]},
        "load": [{"name": "push", "force": list(force), "region": _around(middle, middle, 2.0, 2.0), "wave": "pulse"}],
        "monitor": [
            {"name": "beside", "position": [middle + 7.5, middle + 0.5]},
            {"name": "above", "position": [middle - 4.5, middle + 8.5]},
        ],
        "run": {"duration": 0.2},
    }


def two_loads(sides: str, wave: str) -> Tables:
    """Two forces on the surface, one of them along it."""
    tables = lamb(sides, 50.0, 24.0, wave)
    second = {"name": "drag", "force": [5e5, 0.0], "region": [12.0, 23.0, 14.0, 24.0], "wave": "pulse"}
    return tables | {"load": [*tables["load"], second]}


def blast(sides: str, wide: float, wave: str) -> Tables:
    """A pressure in a rectangular hole, whose walls are straight on every lattice."""
    middle = 0.5 * wide
    tables = {"type": sides} | ({"source": [middle, middle]} if sides == "viscoelastic" else {})
    return {
        "packing": {"pattern": "A", "size": [wide, wide], "radius": 0.5},
        "material": MATERIAL,
        "boundary": {side: tables for side in ("left", "right", "bottom", "top")},
        "wave": {"pulse": WAVES[wave]},
        "hole": [{"name": "cave", "type": "rectangle", "corners": _around(middle, middle, 6.0, 6.0)}],
        "load": [{"name": "blast", "pressure": 1e6, "hole": "cave", "wave": "pulse"}],
        "monitor": [
            {"name": "right", "position": [middle + 9.5, middle + 0.5]},
            {"name": "corner", "position": [middle + 7.5, middle + 7.5]},
        ],
        "run": {"duration": 0.2},
    }


def bar(motion: str, wave: str, length: float, side: str) -> Tables:
    """A bar that is driven at its left end, and ends within rock that goes on."""
    return {
        "packing": {"pattern": "A", "size": [length, 3.0], "radius": 0.5},
        "material": MATERIAL,
        "motion": {"held": ["y" if motion == "p" else "x", "rotation"]},
        "boundary": {"left": {"type": "velocity", f"wave_{motion}": "pulse"}, "right": {"type": side}},
        "wave": {"pulse": WAVES[wave]},
        "monitor": [{"name": "near", "position": [10.5, 1.5]}, {"name": "far", "position": [length - 10.5, 1.5]}],
        "run": {"duration": 0.25},
    }


def ground(wave: str, hole: bool) -> Tables:
    """Ground under an S wave from below: level with a free field, or with a rectangular tunnel in a continuum."""
    tables: Tables = {
        "packing": {"pattern": "A", "size": [60.0, 40.0], "radius": 0.5},
        "material": MATERIAL,
        "boundary": {
            "left": {"type": "free_field"},
            "right": {"type": "free_field"},
            "bottom": {"type": "viscous_input", "wave_s": "pulse", "half_mass": True},
        },
        "wave": {"pulse": WAVES[wave]},
        "monitor": [{"name": "surface", "position": [30.5, 39.5]}, {"name": "wall", "position": [40.5, 20.5]}],
        "run": {"duration": 0.3},
    }
    cave = {"name": "cave", "type": "rectangle", "corners": [22.0, 14.0, 38.0, 26.0]}
    beyond = {
        "left": {"type": "outside"},
        "right": {"type": "outside"},
        "bottom": {"type": "outside", "wave_s": "pulse"},
    }
    return tables | ({"hole": [cave], "boundary": beyond} if hole else {})


def _around(x: float, y: float, wide: float, high: float) -> list[float]:
    """A rectangle round its middle."""
    return [x - 0.5 * wide, y - 0.5 * high, x + 0.5 * wide, y + 0.5 * high]


def scenes() -> Iterator[tuple[str, Tables]]:
    """All scenes by name."""
    for wave in WAVES:
        for sides in ("viscous", "viscoelastic", "outside"):
            for wide, high in ((40.0, 20.0), (60.0, 40.0)):
                yield f"lamb {sides} {wide:g} m {wave}", lamb(sides, wide, high, wave)
        for wide in (30.0, 50.0):
            yield f"embedded {wide:g} m along x {wave}", embedded(wide, wave, (1e6, 0.0))
            yield f"embedded {wide:g} m inclined {wave}", embedded(wide, wave, (1e6, 5e5))
        for sides in ("viscous", "outside"):
            yield f"two loads {sides} {wave}", two_loads(sides, wave)
        for sides, wide in (("viscous", 30.0), ("viscoelastic", 50.0)):
            yield f"blast {sides} {wide:g} m {wave}", blast(sides, wide, wave)
        for motion in ("p", "s"):
            yield f"{motion.upper()} bar {wave}", bar(motion, wave, 60.0, "viscous")
        yield f"tunnel {wave}", ground(wave, hole=True)
        yield f"level ground {wave}", ground(wave, hole=False)


def reference(case: DiskCase) -> Gauges:
    """The motion in the enlarged scene, extrapolated to small disks, at the times of the finer run."""
    own, fine = (_far(with_changes(case, {"packing.radius": 0.5 / k})) for k in (1, FINER))
    found, lag = {}, _lag(case)
    for name, late in fine.items():
        gauge = replace(late, time=late.time - lag)
        values = {}
        for quantity in QUANTITIES:
            coarse = _at(own, name, quantity, gauge.time)
            exact = gauge.of(quantity) + (gauge.of(quantity) - coarse) / (FINER**2 - 1)  # type: ignore[arg-type]
            values[quantity] = exact
        found[name] = replace(gauge, **values)
    return found


def _lag(case: DiskCase) -> float:
    """Time (s) by which waves come later with smaller disks, as they enter at particles nearer the plane."""
    for side, waves in case.driving.items():
        if not case.side(side).is_outside:
            axis = normal_axis(side)
            speed = build(case).ground.wave_speeds(axis)[0 if "p" in waves else 1]
            return case.packing.radius * (1.0 - 1.0 / FINER) / speed
    return 0.0


def _far(case: Any) -> Gauges:
    return measure(extended(case).case, Progress())[0].gauges


def _at(gauges: Gauges, name: str, quantity: Any, times: np.ndarray) -> np.ndarray:
    """Values (k, 3) of a quantity at some times."""
    from scipy.interpolate import CubicSpline

    gauge = gauges[name]
    return np.asarray(CubicSpline(gauge.time, gauge.of(quantity))(np.clip(times, gauge.time[0], gauge.time[-1])))


def true_error(found: Gauges, expected: Gauges) -> float:
    """The largest error of velocity or displacement at monitors that move, RMS over RMS."""
    errors = []
    for quantity in QUANTITIES:
        values = {name: gauge.of(quantity)[:, :2] for name, gauge in expected.items()}  # type: ignore[arg-type]
        loudest = max(np.abs(each).max() for each in values.values())
        for name, each in values.items():
            column = int(np.argmax(np.abs(each).max(axis=0)))
            if np.abs(each).max() >= QUIET * loudest:
                difference = _at(found, name, quantity, expected[name].time)[:, column] - each[:, column]
                errors.append(float(np.linalg.norm(difference) / np.linalg.norm(each[:, column])))
    return max(errors)


def every_choice(case: DiskCase) -> Iterator[Candidate]:
    """All choices that cost less than `COSTLIEST` times the case, whatever their error."""
    planned = plan(case)
    companions = Companions(case, planned.scene, planned.time_step, SHORT)  # type: ignore[arg-type]
    for factor in FACTORS:
        plain = with_diameter(companions, factor)
        if plain is not None:
            found = candidates(companions, plain, factor, BOUNDS[1], ())
            yield from (each for each in found if each.cost < COSTLIEST * cost_of(planned))


def every(names: list[str]) -> None:
    """Print, for each bound, the cheapest choice whose true error is below it."""
    for name, tables in scenes():
        if name not in names:
            continue
        case = loads(tomli_w.dumps(tables), name=name.replace(" ", "_"))
        assert isinstance(case, DiskCase)
        expected = reference(case)
        tried = sorted(every_choice(case), key=lambda each: each.cost)
        for bound in BOUNDS:
            errors = ((each, true_error(measure(each.case, Progress())[0].gauges, expected)) for each in tried)
            best = next(((each, error) for each, error in errors if error <= bound), None)
            if best is not None:
                found = f"{best[0].words}, {100 * best[1]:.2g} %, {best[0].cost:.2g} s"
                print(f"{name}, {100 * bound:g} %: the cheapest of {len(tried)} is {found}", flush=True)


def main(names: list[str]) -> None:
    """Print a line for each scene and bound, and the share of those that keep it."""
    kept = []
    print("| scene | bound | chosen | expected | true | true/expected | steps, s | of the case, s | search, s |")
    print("|---|---|---|---|---|---|---|---|---|")
    for name, tables in scenes():
        if names and not any(each in name for each in names):
            continue
        case = loads(tomli_w.dumps(tables), name=name.replace(" ", "_"))
        assert isinstance(case, DiskCase)
        expected = reference(case)
        for bound in BOUNDS:
            began = time.process_time()
            choice = choose(case, bound)
            spent = time.process_time() - began
            error = true_error(measure(choice.case, Progress())[0].gauges, expected)
            if choice.holds:
                kept.append(error <= bound)
            words = choice.words if choice.holds else f"none; {choice.words}"
            print(
                f"| {name} | {100 * bound:g} % | {words} | {100 * choice.error:.2g} % | {100 * error:.2g} % | "
                f"{error / max(choice.error, 1e-9):.2f} | {choice.cost:.2g} | {choice.own_cost:.2g} | {spent:.1f} |",
                flush=True,
            )
    if kept:
        print(f"\n{sum(kept)} of {len(kept)} choices that were expected to keep their bound do so")


if __name__ == "__main__":
    if sys.argv[1:2] == ["--every"]:
        every(sys.argv[2:])
    else:
        main(sys.argv[1:])
