"""Speed of stepping bars, and its share of what this machine can do.

    python benchmarks/bar_rate.py [--nodes 1000 10000 100000] [--repeats 9]

Sets bars of several lengths in motion under finite differences and peridynamics, compiled first, and takes the CPU time
of blocks of steps on one core, everything a run does at every step included: ends, one gauge, the watch for breaking
bonds. In turn with it two bare loops over two arrays are timed, v += k·Δ²u and u += Δt·v, which are no bar but show
the least possible cost; the last column is the time over theirs. A bar of a thousand nodes lives in the processor's
first caches, so the same run times the fastest plain array copy there; the share of it is the bytes read and written by
a step over the bytes that the copy moves in the same time. Medians are quoted, of the copy the best. The last lines
compare the time from the blow to just after the first spall of a bar by all methods.
"""

import argparse
from collections.abc import Callable

import numba
import numpy as np
from timing import median_time, small_option, timed

from dembound.bar.fracture import spalls
from dembound.bar.scene import build_bar
from dembound.bar.stability import choose_step
from dembound.casefile.bar import BarCase
from dembound.kinds import loads
from dembound.motion.simulation import Simulation

METHODS = {
    "finite_difference": 'type = "finite_difference"',
    "peridynamics, m = 1": 'type = "peridynamics"\nhorizon = 1',
    "peridynamics, m = 3": 'type = "peridynamics"\nhorizon = 3',
    "peridynamics, m = 10": 'type = "peridynamics"\nhorizon = 10',
}
SPALLING = {
    "peridynamics": 'type = "peridynamics"\nhorizon = 3',
    "switch": 'type = "switch"\nhorizon = 3',
    "patch": 'type = "patch"\nhorizon = 3',
    "finite_difference": 'type = "finite_difference"',
}

CASE = """
[bar]
length = 1.0
spacing = {spacing}
density = 2620.0
wave_speed = 2740.0
strength = {strength}
[method]
{method}
[[load]]
name = "impact"
pressure = 12e6
wave = "pulse"
[wave.pulse]
type = "triangle"
amplitude = 1.0
rise = 0.04e-3
fall = 0.08e-3
[[monitor]]
name = "gauge"
position = 0.5
[run]
duration = 0.45e-3
courant = {courant}
"""

STEPS = 4096


@numba.njit(fastmath={"contract"})
def copy(source, target, times):
    for number in range(times):
        for i in range(source.size):
            target[i] = source[i] + number  # differs each time, or all but one would be left out


@numba.njit(fastmath={"contract"})
def two_loops(u, v, k, step, times):
    for _ in range(times):
        for i in range(1, u.size - 1):
            v[i] += k * ((u[i + 1] - u[i]) - (u[i] - u[i - 1]))
        for i in range(u.size):
            u[i] += step * v[i]


def bare(nodes: int, steps: int) -> Callable[[], None]:
    """The two bare loops on `nodes` nodes for `steps` steps, compiled."""
    u, v = np.sin(np.linspace(0.0, 20.0, nodes)), np.zeros(nodes)
    two_loops(u, v, 0.25, 1.0, 2)
    return lambda: two_loops(u, v, 0.25, 1.0, steps)


def bytes_per_node(horizon: int) -> float:
    """Reads and writes of one node's step in bytes, each array as often as a loop passes it.

    Finite differences: u twice for the watch; u three times, v read and written, the new u written. Peridynamics: the
    force cleared; per bond u twice, stiffness, pull written and read twice, the force read and written; then mobility,
    force and u read, v read and written, the mean and the new u written.
    """
    if horizon == 0:
        return 8.0 * (2 + 3 + 2 + 1)
    return 8.0 * (1 + horizon * (2 + 1 + 1 + 2 + 2) + 3 + 2 + 2)


def case_of(method: str, nodes: int, strength: float, courant: float) -> BarCase:
    text = CASE.format(spacing=1.0 / (nodes - 1), strength=strength, method=method, courant=courant)
    case = loads(text)
    assert isinstance(case, BarCase)
    return case


def fastest_copy() -> float:
    """Bytes a second, read and written, of a copy within the first cache."""
    source, target, times = np.ones(1000), np.ones(1000), 20_000
    copy(source, target, 1)
    return 16.0 * source.size * times / min(median_time(lambda: copy(source, target, times), 1) for _ in range(20))


def stepping(name: str, nodes: int, repeats: int, stream: float) -> None:
    case = case_of(METHODS[name], nodes, strength=1e12, courant=0.9)
    scene = build_bar(case)
    simulation = Simulation(scene, choose_step(scene)[0], np.array(list(scene.monitors.values())))
    steps = max(256, STEPS * 1000 // nodes)
    simulation.advance(steps)
    loops = bare(nodes, steps)
    pairs = [(timed(lambda: simulation.advance(steps)).cpu, timed(loops).cpu) for _ in range(repeats)]  # in turn
    step, plain = (float(np.median(times)) / steps for times in zip(*pairs, strict=True))
    horizon = 0 if name == "finite_difference" else case.method.largest_horizon
    moved = bytes_per_node(horizon) * nodes / step
    bonds = f"{max(horizon, 1) * nodes / step / 1e9:.2f}"
    print(
        f"{name:22s} | {nodes:9,} | {step * 1e9:12.0f} | {nodes / step / 1e9:14.2f} | {bonds:>14s} | "
        f"{moved / 1e9:6.0f} | {moved / stream:6.0%} | {step / plain:8.2f}"
    )


def spalling(name: str, nodes: int, courant: float, repeats: int) -> None:
    scene = build_bar(case_of(SPALLING[name], nodes, strength=10e6, courant=courant))
    time_step = choose_step(scene)[0]
    steps = int(np.ceil(scene.case.run.duration / time_step))

    def run() -> Simulation:
        simulation = Simulation(scene, time_step)
        simulation.run(steps)
        return simulation

    (bar,) = run().system.parts
    first = spalls(bar.bonds, scene.positions[:, 0], time_step)[0]
    taken = median_time(run, repeats)
    low, high = first.start
    print(
        f"{name:22s} | {nodes:9,} | {courant:7g} | {taken * 1e3:8.2f} | {bar.bond_updates / 1e6:20.2f} | "
        f"{low:.4f}–{high:.4f} m, {first.time * 1e3:.4f} ms"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--nodes", type=int, nargs="+", default=[1000, 10_000, 100_000])
    parser.add_argument("--repeats", type=int, default=9)
    small_option(parser, nodes=[1000], repeats=1)
    options = parser.parse_args()
    numba.set_num_threads(1)
    stream = fastest_copy()
    print(f"a copy in the first cache moves {stream / 1e9:.0f} GB/s")
    print(
        "method                 |     nodes | ns per step  | G nodes/s      | G bonds/s      | GB/s   | share  | ratio"
    )
    for nodes in options.nodes:
        for name in METHODS:
            stepping(name, nodes, options.repeats, stream)
    print("\nmethod                 |     nodes | Courant | ms       | million bond updates | first spall")
    for nodes in (1001, 4001):
        for name in SPALLING:
            spalling(name, nodes, 0.9, options.repeats)
        spalling("peridynamics", nodes, 1.9, options.repeats)


if __name__ == "__main__":
    main()
