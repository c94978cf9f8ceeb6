"""Expected errors of a continuum compared with true ones: small boxes of disks in it, and large ones.

    python benchmarks/continuum_errors.py [NAME...]   # scenes whose names begin with one of these; by default all

Boxes round a load and round a hole with a pressure, in the ground and under a free surface, flat and deep ones, and
boxes of ground with a hole under waves from below and at an angle. The truth is the motion of the same disks where
those of the box go on so far that nothing returns, or, under waves, in the same box with finer elements and more
layers: in a larger one the disks would disperse the waves that come in over a longer way. RMS over RMS, of the
component with the largest value.
"""

import argparse
import sys
from collections.abc import Iterator
from typing import Any

import numpy as np
import tomli_w
from scene_tables import ISOTROPIC, ROCK, SIDES, Tables, grains, lattice, monitors
from timing import show, small_option

LEAST = 0.01
"""Error (%) from which on rows are judged."""

OUTSIDE: Tables = {"type": "outside"}
WAVES: dict[str, Tables] = {
    **{f"cosine {t:g} s": {"type": "cosine", "amplitude": 1.0, "period": t} for t in (0.1, 0.05, 0.03)},
    **{f"ricker {f:g} Hz": {"type": "ricker", "amplitude": 1.0, "frequency": f} for f in (10.0, 20.0)},
    **{f"spline {t:g} s": {"type": "cubic_spline", "amplitude": 1.0, "period": t} for t in (0.1, 0.05)},
    "sine 20 Hz": {"type": "sine_burst", "amplitude": 1.0, "frequency": 20.0, "cycles": 3},
    "ramp": {"type": "triangle", "amplitude": 1.0, "rise": 0.03, "fall": 0.3},
}


def common(pattern: str, wide: float, high: float, wave: str, accuracy: float, order: int) -> Tables:
    """Tables common to all scenes."""
    packing = lattice(wide, high, 1.0) if pattern == "A" else grains(wide, high, 1.0, 10.0, pattern=pattern)
    return {
        "packing": packing,
        "material": ISOTROPIC,
        "boundary": {side: dict(OUTSIDE) for side in SIDES},
        "wave": {"pulse": WAVES[wave]},
        "outside": {"accuracy": accuracy, "order": order},
        "run": {"duration": 0.3 if max(wide, high) > 60.0 else 0.25},
    }


def around(
    pattern: str, wide: float, high: float, wave: str, accuracy: float = 0.01, order: int = 4, **more: Any
) -> Tables:
    """A force in the middle of ground, on its surface (above), or a pressure in a hole there (radius)."""
    tables, x = common(pattern, wide, high, wave, accuracy, order), 0.5 * wide
    y, beside = 0.5 * high, 4.5
    if more.pop("above", False):
        tables["boundary"].pop("top")
        y = high - 0.5
    if radius := more.pop("radius", 0.0):
        tables["hole"] = [{"name": "hole", "type": "circle", "centre": [x, y], "radius": radius}]
        tables["load"] = [{"name": "blast", "hole": "hole", "pressure": 1e6, "wave": "pulse"}]
        beside = radius + 0.5
    else:
        box = [x - 1.0, y - 1.0, x + 1.0, min(y + 1.0, high)]
        tables["load"] = [{"name": "push", "force": [3e5, -1e6], "region": box, "wave": "pulse"}]
    far, low = wide - 1.5, (1.5 if y > 0.6 * high else high - 1.5)
    tables["monitor"] = monitors(near=(x + beside, y), mid=(0.5 * (x + far), 0.5 * (y + low)), far=(far, y))
    tables["monitor"] += monitors(corner=(far, low))
    return tables | more


def under(
    pattern: str, wide: float, high: float, wave: str, accuracy: float = 0.01, *, angle: float | None = None, **at: Any
) -> Tables:
    """A tunnel or, at the surface, a canyon, in ground of 80 m × 60 m under a wave."""
    tables = common(pattern, wide, high, wave, accuracy, 4)
    radius, x, left, bottom = at["radius"], 40.0, 40.0 - 0.5 * wide, 60.0 - high
    y = 60.0 if at.get("canyon") else 60.0 - 0.5 * high
    tables["boundary"].pop("top")
    tables["packing"] |= {"origin": [left, bottom]}
    if angle is None:
        tables["boundary"]["bottom"] = OUTSIDE | {f"wave_{at.get('kind', 's')}": "pulse"}
    else:
        tables["incident"] = {"type": at.get("kind", "sv"), "angle": angle, "wave": "pulse"}
    places = {"rim": (x + radius + 1.0, min(y + 0.5, 59.5)), "floor": (x + 0.5, y - radius - 0.5)}
    places |= {"surface": (left + wide - 4.5, 59.5), "low": (left + wide - 3.5, bottom + 3.5)}
    return tables | {
        "ground": {"size": [80.0, 60.0]},
        "hole": [{"name": "hole", "type": "circle", "centre": [x, y], "radius": radius}],
        "monitor": monitors(**places),
        "run": {"duration": 0.35},
    }


def scenes() -> Iterator[tuple[str, Tables]]:
    """All scenes by name."""
    for wave in WAVES:
        yield f"force A, {wave}", around("A", 30.0, 30.0, wave)
    for accuracy in (0.001, 0.03):
        for wave in ("cosine 0.05 s", "ricker 20 Hz"):
            yield f"force A, {wave}, {accuracy:g}", around("A", 30.0, 30.0, wave, accuracy)
    for order in (3, 5, 6):
        for wave in ("cosine 0.1 s", "ricker 10 Hz"):
            yield f"force A, {wave}, order {order}", around("A", 40.0, 40.0, wave, 0.003, order)
    yield "force A, no friction", around("A", 30.0, 30.0, "cosine 0.05 s", material=ROCK)
    for pattern in "BC":
        yield f"force {pattern}, cosine", around(pattern, 30.0, 30.0, "cosine 0.1 s")
        yield f"force {pattern}, spline", around(pattern, 40.0, 40.0, "spline 0.1 s", 0.001)
    for wave in ("cosine 0.1 s", "ricker 20 Hz"):
        yield f"force A, flat, {wave}", around("A", 100.0, 14.0, wave)
        yield f"force A, deep, {wave}", around("A", 14.0, 100.0, wave)
        yield f"surface A, {wave}", around("A", 40.0, 20.0, wave, above=True)
        yield f"surface A, flat, {wave}", around("A", 100.0, 12.0, wave, above=True)
        yield f"surface A, {wave}, 0.001", around("A", 40.0, 20.0, wave, 0.001, above=True)
    for pattern in "BC":
        yield f"surface {pattern}", around(pattern, 40.0, 20.0, "cosine 0.1 s", above=True)
    for wave in ("cosine 0.05 s", "ricker 20 Hz"):
        yield f"hole A, {wave}", around("A", 30.0, 30.0, wave, radius=4.0)
        yield f"hole A, {wave}, 0.001", around("A", 30.0, 30.0, wave, 0.001, radius=4.0)
    yield "hole A, flat", around("A", 80.0, 16.0, "cosine 0.05 s", radius=4.0)
    for accuracy in (0.001, 0.003, 0.03):
        yield f"hole A, close, {accuracy:g}", around("A", 12.0, 12.0, "cosine 0.1 s", accuracy, radius=3.0)
    for order in (3, 5, 6):
        yield f"hole A, close, order {order}", around("A", 12.0, 12.0, "cosine 0.1 s", 0.01, order, radius=3.0)
    yield "hole B", around("B", 30.0, 30.0, "cosine 0.05 s", radius=4.0)
    yield "hole C", around("C", 30.0, 30.0, "cosine 0.1 s", radius=4.0)
    for pattern, wave, kind in (("A", "cosine 0.1 s", "s"), ("A", "cosine 0.05 s", "p"), ("C", "cosine 0.1 s", "s")):
        yield f"below {pattern} {kind}", under(pattern, 40.0, 30.0, wave, radius=5.0, kind=kind)
    for accuracy in (0.003, 0.03):
        yield f"below A s, close, {accuracy:g}", under("A", 16.0, 16.0, "cosine 0.1 s", accuracy, radius=5.0)
    yield "below A, 0.001", under("A", 40.0, 30.0, "ricker 20 Hz", 0.001, radius=5.0)
    for accuracy in (0.003, 0.03):
        yield (
            f"canyon, {accuracy:g}",
            under("A", 40.0, 20.0, "cosine 0.1 s", accuracy, angle=30.0, radius=8.0, canyon=True),
        )
    yield "canyon, P", under("A", 40.0, 20.0, "ricker 20 Hz", angle=40.0, radius=8.0, canyon=True, kind="p")
    yield "canyon C", under("C", 40.0, 20.0, "cosine 0.1 s", angle=30.0, radius=8.0, canyon=True)
    yield "tunnel at an angle", under("A", 40.0, 30.0, "cosine 0.1 s", angle=20.0, radius=5.0)


def rows(name: str, tables: Tables) -> Iterator[dict[str, Any]]:
    """Rows of the table for one scene: monitors that move at least 1 % as much as the loudest."""
    from dembound.accuracy.judge import extended
    from dembound.accuracy.runner import at_step, measure
    from dembound.disks.scene import build
    from dembound.disks.stability import choose_step
    from dembound.formulas.disks.continuum import expected_errors
    from dembound.formulas.history import loud
    from dembound.kinds import loads, with_changes
    from dembound.running import Progress

    case: Any = loads(tomli_w.dumps(tables), name="scene")
    if "ground" in tables:
        finer = {"outside.accuracy": tables["outside"]["accuracy"] / 30.0, "outside.layers": 6, "outside.margin": 4}
        larger: Any = with_changes(case, finer)
    else:
        larger = extended(case).case
    scene = build(case)
    step = 0.999 * min(choose_step(each)[0] for each in (scene, build(larger)))
    own, true = (measure(at_step(each, step), Progress())[0].motions for each in (case, larger))
    found = expected_errors(scene, {monitor: history.place for monitor, history in own.items()})
    assert found is not None
    for number, quantity in enumerate(("velocity", "displacement")):
        for monitor in loud(own, quantity):
            column, history = own[monitor].component(quantity), own[monitor]
            values = history.values[quantity][:, column]
            rest = values - true[monitor].at(history.time).values[quantity][:, column]
            error, expected = float(np.linalg.norm(rest) / np.linalg.norm(values)), found[monitor][number]
            yield {
                "scene": name, "monitor": monitor, "quantity": quantity, "true": 100.0 * error,
                "expected": 100.0 * expected, "ratio": expected / error,
            }  # fmt: skip


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME")
    small_option(parser, names=["hole A, close, 0.03"])
    names, all_rows = tuple(parser.parse_args().names), []
    for name, tables in scenes():
        if not names or name.startswith(names):
            own_rows = list(rows(name, tables))
            print(name, *(f"{row['ratio']:.2f}" for row in own_rows), file=sys.stderr, flush=True)
            all_rows += own_rows
    columns = {key: f"{{{key}}}" for key in ("scene", "monitor", "quantity")}
    columns |= {"true, %": "{true:.2g}", "expected, %": "{expected:.2g}", "ratio": "{ratio:.2f}"}
    show("errors of a continuum", columns, all_rows)
    ratios = np.array([row["ratio"] for row in all_rows])
    known = ratios[[row["true"] >= LEAST for row in all_rows]]
    within = np.mean(np.abs(np.log(known)) <= np.log(3.0))
    found = f"{100.0 * within:.1f} % within a factor 3; median {np.median(known):.2f}"
    print(f"\n{len(known)} rows from {LEAST:g} % on, {found}")
