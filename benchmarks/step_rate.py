"""How fast the solver steps, and how much of this machine that is.

    python benchmarks/step_rate.py [CASE] [--threads 1 2 ...] [--steps 200] [--repeats 7]

Builds a case (by default the full long bar of random disks) under the elastic law and under the history-dependent
law, sets every particle in motion, compiles first, and then times blocks of steps. In the same run it times a plain
array copy (STREAM's "copy": one stream read, one written, and the written one read before it is overwritten) with as
many threads, on arrays of the same total size as the solver moves per step, so the share of the machine's memory
bandwidth is a ratio measured side by side. Medians are quoted.
"""

import argparse
import resource
from pathlib import Path

import numba
import numpy as np
from timing import median_time

from dembound.disks.scene import DiskScene, build
from dembound.disks.stability import choose_step
from dembound.kinds import load, with_changes
from dembound.motion.simulation import Simulation

CASE = Path(__file__).parents[1] / "cases" / "zhou2018" / "long_bar_b.toml"


@numba.njit(parallel=True)
def copy(source, target):
    for i in numba.prange(source.size):
        target[i] = source[i]


LAWS = {
    "elastic": {},
    "linearpbond, reference geometry": {"geometry": "reference"},
    "linearpbond, updated geometry": {"geometry": "updated"},
}
"""What is timed -> keys of the material beside the law's name and its start."""


def ends(scene: DiskScene) -> int:
    """Contact ends of a scene's elastic law."""
    return sum(len(rows.contact_type) for rows in scene.rows)


def listed(simulation: Simulation) -> int:
    """Pairs with a history; none under the elastic law."""
    return sum(len(contacts.arrays.first) for contacts in simulation.system.contacts.values())


def bytes_per_step(simulation: Simulation) -> float:
    """Least memory traffic of one step in bytes: every array once, without the constants, which stay in cache.

    Per particle: u read (24), its successor written and fetched for writing (48), v read and written (48), Δt/m and
    Δt/I (16), start of row (4); per contact end: neighbour and contact type (8). With a history each pair is read
    first (particles and contact type 12, state 1, slip 8), its shear read and written (16), its force written, fetched
    for writing and read again (96), its two ends named (8), and u, v and the steady load read once more (72 per
    particle).
    """
    count, pairs = simulation.scene.count, listed(simulation)
    if pairs == 0:
        return 140.0 * count + 8.0 * ends(simulation.scene)
    return 212.0 * count + 141.0 * pairs


def flops_per_step(simulation: Simulation) -> float:
    """Additions and multiplications of one step, a root or quotient counted as one.

    Elastic: 29 per contact end, 15 per particle. With a history: 75 per pair for small displacements, 91 with updated
    geometry, its two ends included, and 20 per particle.
    """
    scene = simulation.scene
    pairs = listed(simulation)
    if pairs == 0:
        return 29.0 * ends(scene) + 15.0 * scene.count
    per_pair = 91.0 if scene.case.material.geometry == "updated" else 75.0
    return per_pair * pairs + 20.0 * scene.count


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("case", nargs="?", type=Path, default=CASE)
    parser.add_argument("--threads", type=int, nargs="+", default=sorted({1, numba.get_num_threads()}))
    parser.add_argument("--steps", type=int, default=100)
    parser.add_argument("--repeats", type=int, default=7)
    options = parser.parse_args()

    for law, keys in LAWS.items():
        measure(law, keys, options)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    print(f"memory: process peak {peak / 1e6:.0f} MB")


def measure(law: str, keys: dict, options: argparse.Namespace) -> None:
    changes = {f"material.{key}": value for key, value in keys.items()}
    if keys:
        changes |= {"material.law": "linearpbond", "material.elastic_start": False}
    scene = build(with_changes(load(options.case), changes))
    time_step, _ = choose_step(scene)
    simulation = Simulation(scene, time_step)
    simulation.state.velocity = np.random.default_rng(0).normal(0.0, 1e-3, simulation.state.velocity.shape)
    simulation.advance(2)
    traffic, flops = bytes_per_step(simulation), flops_per_step(simulation)
    source = np.ones(int(traffic / 24))
    target = np.zeros_like(source)
    copy(source, target)

    print(f"{options.case.stem}, {law}: {scene.count:,} particles, {ends(scene) / scene.count:.2f} contacts each")
    print(f"per particle-step: {traffic / scene.count:.0f} bytes, {flops / scene.count:.0f} flops")
    print(f"scene arrays: {scene.bytes / scene.count:.0f} bytes per particle")
    print("threads | million particle-steps/s | Gflop/s | GB/s moved | GB/s of a copy | share of bandwidth")
    for threads in options.threads:
        numba.set_num_threads(threads)
        step = median_time(lambda: simulation.advance(options.steps), options.repeats) / options.steps
        stream = 24 * source.size / median_time(lambda: copy(source, target), 5 * options.repeats)
        print(
            f"{threads:7d} | {scene.count / step / 1e6:24.1f} | {flops / step / 1e9:7.2f} | "
            f"{traffic / step / 1e9:10.2f} | {stream / 1e9:14.2f} | {traffic / step / stream:18.0%}"
        )


if __name__ == "__main__":
    main()
