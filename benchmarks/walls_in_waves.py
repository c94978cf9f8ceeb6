"""Errors beside round holes in lattices under waves, relative to those expected, by place.

    python benchmarks/walls_in_waves.py [--disks 10 20 40] [--long 1 2 4]

Cavities in a full space, compared with the exact series, and semicircular canyons, compared with disks three times
smaller, for which differences are multiplied by 3/2, as these errors are of first order. --disks : along the radius;
--long : waves in radii of S waves. RMS over RMS of the larger component. The defaults take ten minutes of CPU time.
"""

import argparse
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from scene_tables import ISOTROPIC, SIDES, Tables, lattice, pulse
from timing import show
from walls import DIRECTIONS, QUANTITIES, SPEED, motions

RADII, FINER, PLACES = (1.0, 1.5), 3, np.radians([182, 200, 225, 250, 270, 290, 315, 340, 358])


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
        "run": {"duration": (long * n + 2.0 * wide) / SPEED},
    }


def cavity(n: float, long: float, kind: str) -> tuple[Any, Mapping[str, Any], dict[str, dict[str, np.ndarray]]]:
    """The case, what it records, and the exact motion in its place."""
    from dembound.accuracy.of_disks.exact import problem_of
    from dembound.disks.scene import build

    wide = 2.0 * float(np.ceil((max(RADII) + 0.5) * n))
    case, own = motions(scene(n, long, wide, 0.5 * wide + np.array([0.31, 0.17]), kind, 0.0, DIRECTIONS))
    time = next(iter(own.values())).time
    exact = problem_of(build(case), "scattering").motions(time)
    return case, own, {name: {quantity: exact[name].values[quantity] for quantity in QUANTITIES} for name in exact}


def canyon(
    n: float, long: float, kind: str, angle: float
) -> tuple[Any, Mapping[str, Any], dict[str, dict[str, np.ndarray]]]:
    """The same of a canyon, with the motion of smaller disks, which has the third part of its error."""
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
    return case, own, expected


def ratios(case: Any, own: Mapping[str, Any], expected: Mapping[str, Any]) -> Iterator[float]:
    """Expected over true errors by monitor and quantity."""
    from dembound.accuracy.of_disks.near import wall_errors
    from dembound.disks.scene import build

    ground = build(case).ground
    for name, right in expected.items():
        sizes = wall_errors(case, ground, 1.0, own[name].place)
        for quantity in QUANTITIES:
            column = int(np.argmax(np.abs(right[quantity][:, :2]).max(axis=0)))
            values = right[quantity][:, column]
            yield (
                sizes[quantity]
                * np.linalg.norm(values)
                / np.linalg.norm(own[name].values[quantity][:, column] - values)
            )


def main() -> None:
    """Measure all and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--disks", nargs="+", type=float, default=[10.0, 20.0, 40.0])
    parser.add_argument("--long", nargs="+", type=float, default=[1.0, 2.0, 4.0])
    options = parser.parse_args()
    rows = []
    for n, long in ((n, long) for n in options.disks for long in options.long if n * long >= 20.0):
        made = {f"cavity, {kind}": cavity(n, long, kind) for kind in ("p", "sv")}
        if n <= 20.0:
            made |= {
                f"canyon, {kind} {angle:g}°": canyon(n, long, kind, angle)
                for kind, angle in (("p", 0.0), ("sv", 0.0), ("sv", 30.0))
            }
        for name, each in made.items():
            found = np.array(list(ratios(*each)))
            within = 100.0 * np.mean((found > 1.0 / 3.0) & (found < 3.0))
            rows.append(
                {
                    "hole": name,
                    "disks": n,
                    "long": long,
                    "least": found.min(),
                    "median": np.median(found),
                    "most": found.max(),
                    "within": within,
                }
            )
    columns = {"hole": "{hole}", "disks": "{disks:g}", "radii long": "{long:g}"}
    columns |= {f"{key}, expected/true": f"{{{key}:.2f}}" for key in ("least", "median", "most")}
    show("expected over true errors", columns | {"within 3, %": "{within:.0f}"}, rows)


if __name__ == "__main__":
    main()
