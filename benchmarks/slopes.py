"""Errors beside slopes between two levels: by near sides, and by disks, compared with the formulas.

    python benchmarks/slopes.py [sides] [disks]

`sides`: free-field and continuum sides at several distances from the crest and the toe, compared with sides so far away
that nothing returns. `disks`: slopes of several angles and heights, compared with disks five times smaller, and with
`wall_errors`. RMS over RMS of velocities, of the worst place or of each.
"""

from __future__ import annotations

import argparse
import math

import numpy as np
import tomli_w

from dembound.disks.scene import DiskScene, build
from dembound.disks.stability import choose_step
from dembound.formulas.disks.near_disks import wall_errors
from dembound.kinds import loads
from dembound.kinds.disks.slopes import APART, sent_back_beside_slope
from dembound.motion.simulation import Simulation

SPEEDS = {"s": 1000.0 / math.sqrt(2.0), "p": 1000.0}
"""Of waves in the lattice, m/s."""

DEEP = 20.0
"""Height of the toe above the foot, m."""

FAR = 13.0
"""Distance of sides from which nothing returns during a run, in heights of the slope."""


def slope(
    high: float, angle: float, apart: float, kind: str, long: float, sides: str, radius: float = 0.5
) -> DiskScene:
    """A slope of a height (m) and angle (degrees), sides so far (m) from it, under waves of a kind and length (m)."""
    run = high / math.tan(math.radians(angle))
    wide, top, x = math.ceil(2.0 * apart + run), DEEP + high, (0.0, apart, apart + run)
    places = {
        "crest": (apart - 0.5, top - 0.5),
        "back": (apart - 0.4 * high - 0.5, top - 0.5),
        "face": (apart + 0.5 * run, top - 0.5 * high - 1.0),
        "toe": (apart + run + 1.5, DEEP - 0.5),
        "floor": (apart + run + 0.4 * high + 0.5, DEEP - 0.5),
        "deep": (apart + 0.5 * run, 4.5),
    }
    below = {"outside": {"type": "outside"}, "free_field": {"type": "viscous_input", "half_mass": True}}[sides]
    tables = {
        "ground": {"surface": [[x[0], top], [x[1], top], [x[2], DEEP], [float(wide), DEEP]]},
        "packing": {"pattern": "A", "size": [float(wide), top], "radius": radius},
        "material": {"density": 2500.0, "p_wave_speed": SPEEDS["p"], "fric": 0.5},
        "boundary": {"left": {"type": sides}, "right": {"type": sides}, "bottom": below | {f"wave_{kind}": "w"}},
        "wave": {"w": {"type": "cosine", "amplitude": 0.5, "period": long / SPEEDS[kind]}},
        "monitor": [{"name": name, "position": list(place)} for name, place in places.items()],
        "run": {"duration": 0.15 + 2.5 * long / SPEEDS[kind]},
    }
    return build(loads(tomli_w.dumps(tables), name="slope"))


def motion(scene: DiskScene, times: np.ndarray) -> np.ndarray:
    """Velocities (s, 6, 2) at the monitors, at times (s,) s."""
    step = choose_step(scene)[0]
    record = Simulation(scene, step, scene.probes).advance(int(scene.case.run.duration / step))
    known = scene.observed(record, step * np.arange(len(record)))[:, :6, 3:5]
    at = step * np.arange(len(record))
    return np.stack([[np.interp(times, at, known[:, p, c]) for p in range(6)] for c in (0, 1)]).transpose(2, 1, 0)


def errors(own: DiskScene, exact: DiskScene) -> np.ndarray:
    """Errors (6,) of the velocity at the monitors of a scene."""
    times = np.linspace(0.0, 0.99 * own.case.run.duration, 2000)
    one, other = motion(own, times), motion(exact, times)
    found: np.ndarray = np.sqrt(((one - other) ** 2).sum(axis=(0, 2)) / (other**2).sum(axis=(0, 2)))
    return found


def by_sides() -> None:
    """Errors by the distance of sides and the length of waves."""
    high = 20.0
    for sides in ("free_field", "outside"):
        for kind in SPEEDS:
            for long in (10.0, 20.0, 40.0, 80.0):
                exact = slope(high, 45.0, FAR * high, kind, long, sides)
                row, formula = [], []
                for apart in APART[:3]:
                    scene = slope(high, 45.0, apart * high, kind, long, sides)
                    row.append(f"{100.0 * errors(scene, exact).max():5.2f}")
                    if sides == "free_field":
                        formula.append(f"{100.0 * sent_back_beside_slope(scene.case, SPEEDS['s']):5.1f}")
                said = f"  ({' '.join(formula)} by the formula)" if formula else ""
                print(f"{sides:10} {kind}, waves of {long / high:3.1f} H: {' '.join(row)} %{said}", flush=True)


def by_disks() -> None:
    """Errors of slopes of disks, and by the formula."""
    ratios = []
    for high in (20.0, 40.0):
        for angle in (30.0, 45.0, 60.0, 75.0):
            for long in (40.0, 80.0):
                scenes = [slope(high, angle, high, "s", long, "outside", radius) for radius in (0.5, 0.1)]
                found = errors(*scenes)
                formula = wall_errors(scenes[0].case, scenes[0].ground, 1.0)["velocity"]
                ratios += (found / formula).tolist()
                each = " ".join(f"{100.0 * error:5.2f}" for error in found)
                print(f"H {high:g} m, {angle:g}°, {long:g} D: {each} %  ({100.0 * formula:.2f})", flush=True)
    inside = np.mean([1.0 / 3.0 <= ratio <= 3.0 for ratio in ratios])
    print(f"{100.0 * inside:.0f} % of {len(ratios)} within a third and three times; median {np.median(ratios):.2f}")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sections", nargs="*", help="sides, disks; by default both")
    for section in parser.parse_args().sections or ("sides", "disks"):
        {"sides": by_sides, "disks": by_disks}[section]()
