"""Errors beside round holes in lattices under waves, relative to those expected, by place.

    python benchmarks/walls_in_waves.py [--cavities 10,2 40,0.5] [--canyons 10,2]

Cavities in a full space, compared with the exact series, and semicircular canyons, compared with disks three times
smaller, for which differences are multiplied by 3/2, as these errors are of first order. Each pair is the number of
disks along the radius, and how many radii S waves run in the pulse. RMS over RMS of the larger component, of which
the estimate is; the error of the smaller one is judged by that expected of the larger one. The cavities `HELD_OUT` had
no part in the fit. All take some ten minutes of CPU time.
"""

import argparse
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np
from scene_tables import ISOTROPIC, SIDES, Tables, lattice, pulse
from timing import show, small_option
from walls import DIRECTIONS, QUANTITIES, SPEED, exact, motions

RADII, FINER, PLACES = (1.0, 1.5), 3, np.radians([182, 200, 225, 250, 270, 290, 315, 340, 358])

Pair = tuple[float, float]

CAVITIES: tuple[Pair, ...] = (
    *((10.0, long) for long in (2.0, 4.0)),
    *((20.0, long) for long in (1.0, 2.0, 4.0, 10.0)),
    *((40.0, long) for long in (0.5, 1.0, 2.0, 4.0)),
    *((80.0, long) for long in (0.5, 1.0, 2.0)),
)
HELD_OUT: tuple[Pair, ...] = ((160.0, 1.0),)
CANYONS: tuple[Pair, ...] = ((10.0, 2.0), (10.0, 4.0), (20.0, 1.0), (20.0, 2.0))

SAMPLES = 1500
"""Times at which an exact motion is computed: at least a hundred in a pulse."""

ACCURACY = 1e-3
"""Of exact motions, over the largest; what doubling the samples still changes, so that they are better than that."""


class Measured(NamedTuple):
    """A case, what it records, and the right motion at every so many of its times."""

    case: Any
    own: Mapping[str, Any]
    right: Mapping[str, Mapping[str, np.ndarray]]
    every: int = 1


def scene(n: float, long: float, wide: float, middle: np.ndarray, kind: str, angle: float, of: np.ndarray) -> Tables:
    """A hole of n disks along its radius, and monitors in directions `of` (rad) round it."""
    rays = [(r * n + 0.7 * (r == 1.0)) * np.array([np.cos(a), np.sin(a)]) for r in RADII for a in of]
    return {
        "packing": lattice(wide, wide, 1.0),
        "material": ISOTROPIC,
        "boundary": {side: {"type": "outside"} for side in SIDES},
        "hole": [{"name": "hole", "type": "circle", "centre": middle.tolist(), "radius": n}],
        "incident": {"type": kind, "angle": angle, "wave": "pulse"},
        "wave": pulse(long * n / SPEED, 1.0),
        "monitor": [{"name": f"{k}", "position": (middle + ray).tolist()} for k, ray in enumerate(rays)],
        "run": {"duration": (long * n + 1.5 * wide) / SPEED},
    }


def cavity(n: float, long: float, kind: str) -> Measured:
    """A cavity between the disks of a lattice, and the exact motion beside it."""
    wide = 2.0 * float(np.ceil((max(RADII) + 0.5) * n))
    middle = 0.5 * wide + np.array([0.31, 0.17])
    case, own = motions(scene(n, long, wide, middle, kind, 0.0, DIRECTIONS))
    every = max(1, len(next(iter(own.values())).time) // SAMPLES)
    return Measured(case, own, exact(case, own, n, middle, False, every, ACCURACY), every)


def canyon(n: float, long: float, kind: str, angle: float) -> Measured:
    """A canyon, with the motion of smaller disks, which has the third part of its error."""
    wide = 2.0 * float(np.ceil(2.2 * n))
    high = 0.5 * wide
    tables = scene(n, long, wide, np.array([wide, high + n]), kind, angle, PLACES)
    for each in tables["monitor"]:
        each["position"][1] = min(each["position"][1], high + n - 0.5)
    del tables["boundary"]["top"]
    body = {"origin": [0.5 * wide, n]}
    tables |= {"ground": {"size": [2.0 * wide, high + n]}, "packing": lattice(wide, high, 1.0) | body}
    case, own = motions(tables)
    same = [{"name": name, "position": history.place.tolist()} for name, history in own.items()]
    fine = motions(tables | {"packing": lattice(wide, high, 1.0 / FINER) | body, "monitor": same})[1]
    expected = {}
    for name, history in own.items():
        right = fine[name].at(history.time).values
        expected[name] = {q: history.values[q] - 1.5 * (history.values[q] - right[q]) for q in QUANTITIES}
    return Measured(case, own, expected)


def ratios(measured: Measured) -> Iterator[tuple[float, float]]:
    """Expected over true errors by monitor and quantity: of the larger component, and that over the smaller one's."""
    from dembound.disks.scene import build
    from dembound.formulas.disks.near_disks import wall_errors

    case, own, expected, every = measured
    ground = build(case).ground
    for name, right in expected.items():
        sizes = wall_errors(case, ground, 1.0, own[name].place)
        for quantity in QUANTITIES:
            values = right[quantity][:, :2]
            column = int(np.argmax(np.abs(values).max(axis=0)))
            errors = np.linalg.norm(own[name].values[quantity][::every, :2] - values, axis=0)
            size = sizes[quantity] * np.linalg.norm(values[:, column])
            yield size / errors[column], size / max(errors[1 - column], np.finfo(float).tiny)


def row(name: str, n: float, long: float, found: np.ndarray) -> dict[str, Any]:
    """A row of the table; found : the ratios (k, 2) of one scene, or of several."""
    larger, smaller = found.T
    return {
        "hole": name,
        "disks": f"{n:g}" if n else "–",
        "long": f"{long:g}" if n else "–",
        "rows": len(found),
        "least": larger.min(),
        "median": np.median(larger),
        "most": larger.max(),
        "within": 100.0 * np.mean((larger > 1.0 / 3.0) & (larger < 3.0)),
        "factor": np.quantile(1.0 / larger, 0.95),
        "other": smaller.min(),
        "below": 100.0 * np.mean(smaller > 1.0 / 3.0),
    }


def pairs(words: str) -> Pair:
    """Disks along the radius, and radii that S waves run in the pulse, with a comma between."""
    n, long = words.split(",")
    return float(n), float(long)


def main() -> None:
    """Measure all and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cavities", nargs="*", type=pairs, default=[*CAVITIES, *HELD_OUT], metavar="N,LONG")
    parser.add_argument("--canyons", nargs="*", type=pairs, default=[*CANYONS], metavar="N,LONG")
    small_option(parser, cavities=[(10.0, 2.0)], canyons=[(10.0, 2.0)])
    options = parser.parse_args()
    rows, groups = [], {"cavities": [], "cavities held out": [], "canyons": []}  # type: ignore[var-annotated]

    def add(group: str, name: str, pair: Pair, measured: Measured) -> None:
        found = np.array(list(ratios(measured)))
        groups[group].append(found)
        rows.append(row(name, *pair, found))
        print(".", end="", flush=True)

    for pair in options.cavities:
        for kind in ("p", "sv"):
            group = "cavities held out" if pair in HELD_OUT else "cavities"
            add(group, f"cavity, {kind}", pair, cavity(*pair, kind))
    for pair in options.canyons:
        for kind, angle in (("p", 0.0), ("sv", 0.0), ("sv", 30.0)):
            add("canyons", f"canyon, {kind} {angle:g}°", pair, canyon(*pair, kind, angle))
    rows += [row(f"all {name}", 0.0, 0.0, np.concatenate(found)) for name, found in groups.items() if found]
    columns = {"hole": "{hole}", "disks": "{disks}", "radii long": "{long}", "rows": "{rows}"}
    columns |= {f"{key}, expected/true": f"{{{key}:.2f}}" for key in ("least", "median", "most")}
    columns |= {"within 3, %": "{within:.1f}", "95 % of true/expected below": "{factor:.2f}"}
    columns |= {"smaller component, least": "{other:.2f}", "above 1/3, %": "{below:.1f}"}
    print()
    show("expected over true errors", columns, rows)


if __name__ == "__main__":
    main()
