"""The error of the motion beside holes whose walls are disks, times the disks along the smaller half of the hole.

    python benchmarks/walls.py

Round holes under a pressure and under an SV wave, in lattices and in bricks of random disks, in a continuum all round,
compared with the exact solutions in the homogenised medium of the packing; rectangular ones in lattices compared with
disks three times smaller, for which differences are multiplied by 3/2, as these errors are of first order. Pressures
last ten times as long as S waves take along the smaller half, waves `LASTING` times. RMS over RMS, means over 12
directions.
"""

import argparse
from collections.abc import Iterator, Mapping
from itertools import islice
from typing import Any

import numpy as np
import tomli_w
from scene_tables import ISOTROPIC, SIDES, Tables, grains, lattice, pulse
from timing import show, small_option

RADII, FINER, SPEED = (1.0, 1.5, 2.0, 2.5), 3, 700.0
DIRECTIONS = np.radians([0, 30, 45, 60, 90, 135, 180, 200, 245, 270, 300, 330])
OFFSETS = ((0.0, 0.0), (0.5, 0.5), (0.31, 0.17))
QUANTITIES = ("velocity", "displacement")
LASTING = (3.0, 10.0, 40.0)


def scene(
    packing: Tables, hole: Tables, half: float, middle: np.ndarray, is_pressed: bool, lasting: float = 10.0
) -> Tables:
    """A hole of a smaller half (m) about a place, and monitors round it.

    lasting : of the pulse, over the time that S waves take along that half.
    """
    wide = packing["size"][0]
    rays = np.stack([np.cos(DIRECTIONS), np.sin(DIRECTIONS)], axis=1)
    if hole["type"] == "rectangle":
        rays /= np.abs(rays).max(axis=1, keepdims=True)
    tables: Tables = {
        "packing": packing,
        "material": ISOTROPIC,
        "boundary": {side: {"type": "outside"} for side in SIDES},
        "hole": [{"name": "hole", **hole}],
        "wave": pulse(lasting * half / SPEED, 1.0),
        "monitor": [
            {"name": f"{r:g}_{k}", "position": (middle + (r * half + 0.7 * (r == 1.0)) * ray).tolist()}
            for r in RADII
            for k, ray in enumerate(rays)
        ],
        "run": {"duration": (lasting * half + wide) / SPEED},
    }
    if is_pressed:
        return tables | {"load": [{"name": "blast", "hole": "hole", "pressure": 1e6, "wave": "pulse"}]}
    return tables | {"incident": {"type": "sv", "angle": 0.0, "wave": "pulse"}}


def motions(tables: Tables) -> tuple[Any, Mapping[str, Any]]:
    """The case and what its monitors record."""
    from dembound.accuracy.runner import measure
    from dembound.kinds import loads
    from dembound.running import Progress

    case = loads(tomli_w.dumps(tables), name="walls")
    return case, measure(case, Progress())[0].motions


def exact(
    case: Any,
    own: Mapping[str, Any],
    radius: float,
    middle: np.ndarray,
    is_pressed: bool,
    every: int = 1,
    tolerance: float = 1e-4,
) -> dict[str, Any]:
    """The exact motion at the monitors that are in the body, by name and quantity.

    every : of how many samples one is computed. tolerance : over the largest motion; that of a wave at all monitors.
    """
    from dembound.disks.scene import build
    from dembound.disks.surroundings.ground_waves import incident_in
    from dembound.disks.surroundings.media import medium_of
    from dembound.exact.explosion import cavity_motion
    from dembound.exact.scattering import PlaneWave, scattered_motion
    from dembound.exact.solid import Solid

    ground, wave = build(case).ground, case.wave["pulse"]
    solid = Solid(ground.density, *np.mean([ground.wave_speeds(axis) for axis in (0, 1)], axis=0).tolist())
    away = {name: history.place - middle for name, history in own.items()}
    away = {name: ray for name, ray in away.items() if np.hypot(*ray) >= radius}
    time = next(iter(own.values())).time[::every]
    if not is_pressed:
        delay = float(incident_in(case, medium_of(ground)).delays(middle[None])[0])
        coming = PlaneWave(case.incident.type, 0.5 * np.pi, wave.velocity)
        found = scattered_motion(time - delay, np.array(list(away.values())), coming, radius, solid, tolerance)
        both = zip(away, found.velocity, found.displacement, strict=True)
        return {name: {"velocity": v.T, "displacement": u.T} for name, v, u in both}
    result = {}
    for name, ray in away.items():
        r = float(np.hypot(*ray))
        moved = cavity_motion(time, r, lambda t: 1e6 * wave.velocity(t), radius, solid, tolerance)
        result[name] = {quantity: getattr(moved, quantity)[:, None] * ray / r for quantity in QUANTITIES}
    return result


def key(quantity: str, radius: float) -> str:
    """The name of a column: a quantity at so many radii."""
    return f"{quantity} at {10.0 * radius:.0f} tenths"  # a point would be one of a format


def row(name: str, own: Mapping[str, Any], expected: Mapping[str, Any], along: float) -> dict[str, Any]:
    """A row of the table: errors by quantity and distance, times the disks along the smaller half."""
    found: dict[str, Any] = {"hole": name, "along": along}
    for quantity in QUANTITIES:
        for radius in RADII:
            errors = []
            for monitor in (each for each in expected if each.startswith(f"{radius:g}_")):
                right = expected[monitor][quantity][:, :2]
                column = int(np.argmax(np.abs(right).max(axis=0)))
                rest = own[monitor].values[quantity][:, column] - right[:, column]
                errors.append(np.linalg.norm(rest) / np.linalg.norm(right[:, column]))
            found[key(quantity, radius)] = along * float(np.sqrt(np.mean(np.square(errors))))
    return found


def round_holes() -> Iterator[dict[str, Any]]:
    """Circles compared with exact solutions."""
    lattices = [("A", 1, n, offset) for n in (3.5, 5.0, 7.0, 8.0, 10.0, 12.5, 16.0, 20.0) for offset in OFFSETS]
    random = [(pattern, seed, n, (0.0, 0.0)) for n in (4.0, 6.0, 10.0) for pattern in "BC" for seed in range(1, 6)]
    for pattern, seed, n, offset in [*lattices, *random]:
        half = 10.0 * np.ceil(0.3 * n) if pattern != "A" else np.ceil(3.0 * n)
        middle = half + np.array(offset)
        wide = 2.0 * float(half)
        packing = lattice(wide, wide, 1.0) if pattern == "A" else grains(wide, wide, 1.0, 10.0, seed, pattern)
        hole = {"type": "circle", "centre": middle.tolist(), "radius": n}
        for lasting in (None, *LASTING)[: 4 if n in (5.0, 6.0, 8.0) else 1]:
            is_pressed = lasting is None
            case, own = motions(scene(packing, hole, n, middle, is_pressed, lasting or 10.0))
            name = f"{pattern} {seed}, centre {offset}, {'pressure' if is_pressed else f'wave × {lasting:g}'}"
            yield row(name, own, exact(case, own, n, middle, is_pressed), n)


def rectangles() -> Iterator[dict[str, Any]]:
    """Squares in lattices, with walls between disks, compared with smaller disks."""
    for n in (3.0, 5.0, 8.0, 12.0):
        half = np.ceil(3.0 * n)
        middle, wide = np.full(2, half), 2.0 * float(half)
        hole = {"type": "rectangle", "corners": [half - n, half - n, half + n, half + n]}
        for lasting in (None, *LASTING):
            tables = scene(lattice(wide, wide, 1.0), hole, n, middle, lasting is None, lasting or 10.0)
            own = motions(tables)[1]
            same = [{"name": name, "position": history.place.tolist()} for name, history in own.items()]
            fine = motions(tables | {"packing": lattice(wide, wide, 1.0 / FINER), "monitor": same})[1]
            expected = {name: fine[name].at(history.time).values for name, history in own.items()}
            name = f"A square, {'pressure' if lasting is None else f'wave × {lasting:g}'}, × 2/3"
            yield row(name, own, expected, n)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    small_option(parser)
    most = 1 if parser.parse_args().small else None
    columns = {"hole": "{hole}", "disks": "{along:g}"}
    columns |= {f"{q[0]}, {r:g} radii": "{" + key(q, r) + ":.2f}" for q in QUANTITIES for r in RADII}
    rows = (row for holes in (rectangles, round_holes) for row in islice(holes(), most))
    show("errors times disks along the smaller half", columns, rows)
