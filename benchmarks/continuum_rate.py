"""Speed of stepping a continuum of spectral elements, elastic and absorbing.

    python benchmarks/continuum_rate.py [--sides 8 16 32 64] [--orders 4] [--repeats 9] [--json FILE]

Steps square meshes with noise in them, on one core, whole steps as in a run: without layers, with all but one row of
elements absorbing along y, and with nearly all of them absorbing along both axes; last a mesh round a box with layers
on three sides, as a scene has. Prints the CPU time of a step per unique node, medians of blocks of steps; compiled
first. Then the CPU time per tie of bodies of disks, lattices and random packings, and of their whole steps.
"""

import argparse
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numba
import numpy as np
from timing import ROOT, in_one_line, machine, median_time, show, small_option, write

sys.path.insert(0, str(ROOT / "cases" / "outside"))

from grid_scene import GridScene, step_limit

from dembound import api
from dembound.continuum.axis import Around
from dembound.continuum.medium import Medium
from dembound.continuum.mesh import Mesh
from dembound.continuum.part import GridBody
from dembound.disks.scene import build
from dembound.disks.stability import choose_step
from dembound.kernels.tables import WallTies
from dembound.kernels.wall import wall_forces
from dembound.motion.simulation import Simulation

ROCK = Medium.isotropic(2500.0, 1000.0, 600.0)
ELEMENT = 30.0, 30.0
NODE_STEPS = 4e6
"""Node-steps of a block, about."""


def meshes(order: int, side: int) -> Iterator[tuple[str, Mesh]]:
    """Meshes of side × side elements and their names."""
    half, whole = side // 2, (side, side)
    yield "elastic", Mesh.uniform(order=order, element=ELEMENT, cells=whole)
    along_one = Around(bottom=half, top=side - half - 1)
    yield "absorbing along y", Mesh.uniform(order=order, element=ELEMENT, cells=whole, layer=along_one)
    along_both = Around(half, side - half - 1, half, side - half - 1)
    yield "absorbing along x and y", Mesh.uniform(order=order, element=ELEMENT, cells=whole, layer=along_both)


def round_a_box(order: int) -> Mesh:
    """Elements round 60 × 60 m at the free surface: one elastic, and three that absorb."""
    return Mesh.around((0.0, 0.0, 60.0, 60.0), ELEMENT, order, margin=Around(1, 1, 1, 0), layer=Around(3, 3, 3, 0))


def measure(name: str, mesh: Mesh, repeats: int) -> dict[str, Any]:
    """CPU time of a step of a mesh, for each node."""
    body = GridBody(mesh=mesh, medium=ROCK)
    simulation = Simulation(GridScene(body), 0.9 * step_limit(body))
    noise = np.zeros((3, body.count))
    noise[:2] = 1e-5 * np.random.default_rng(0).standard_normal((2, body.count)) * ~mesh.held
    simulation.state.velocity = noise
    steps = max(10, int(NODE_STEPS / body.count))
    simulation.advance(10)
    taken = median_time(lambda: simulation.advance(steps), repeats)
    return {
        "mesh": name,
        "order": mesh.order,
        "elements": len(mesh.elements),
        "absorbing": float(mesh.absorbs.any(axis=1).mean()),
        "nodes": body.count,
        "nanoseconds": 1e9 * taken / steps / body.count,
    }


def tied(pattern: str, order: int) -> api.Case:
    """60 m × 60 m of disks of 1 m at the free surface of a continuum with elements of 30 m."""
    packing: dict[str, Any] = {"pattern": pattern, "size": [60.0, 60.0], "radius": 0.5}
    if pattern != "A":
        packing |= {"radius_ratio": 1.5, "brick": [20.0, 20.0], "seed": 1}
    return api.case(
        packing=packing,
        material={"density": 2500.0, "p_wave_speed": 1000.0, "fric": 0.5},
        boundary={side: {"type": "outside"} for side in ("left", "right", "bottom")},
        outside={"element": ELEMENT[0], "order": order},
        run={"duration": 1.0},
    )


@numba.njit
def repeat(times: int, ties: WallTies, u: np.ndarray, force: np.ndarray) -> None:
    for _ in range(times):
        wall_forces(ties, u, u, force)


def measure_ties(pattern: str, order: int, repeats: int) -> dict[str, Any]:
    """CPU time of the forces of each tie, and of a whole step with disks and continuum."""
    scene = build(tied(pattern, order))
    outside = scene.outside
    assert outside is not None
    kernel = outside.ties(scene.layout, outside.tied)
    u, force, many = np.zeros((3, scene.layout.count)), np.zeros((len(outside.tied), 3)), len(outside.wall.element)
    times = max(10, int(NODE_STEPS / 4 / many))
    repeat(1, kernel, u, force)
    alone = median_time(lambda: repeat(times, kernel, u, force), repeats) / times
    simulation = Simulation(scene, choose_step(scene)[0])
    noise = 1e-5 * np.random.default_rng(0).standard_normal((3, scene.count))
    simulation.state.velocity = noise * scene.moves
    steps = max(10, int(NODE_STEPS / scene.count))
    simulation.advance(10)
    whole = median_time(lambda: simulation.advance(steps), repeats) / steps
    return {
        "pattern": pattern,
        "order": order,
        "disks": scene.recorded,
        "nodes": outside.count,
        "ties": many,
        "nanoseconds": 1e9 * alone / many,
        "step": 1e6 * whole,
        "share": alone / whole,
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sides", type=int, nargs="+", default=[8, 16, 32, 64])
    parser.add_argument("--orders", type=int, nargs="+", default=[4])
    parser.add_argument("--repeats", type=int, default=9)
    parser.add_argument("--json", type=Path, default=Path("results/benchmarks/continuum.json"))
    small_option(parser, sides=[8], repeats=1)
    options = parser.parse_args()
    numba.set_num_threads(1)
    facts = machine()
    print(in_one_line(facts))
    rows = []
    for order in options.orders:
        cases = [case for side in options.sides for case in meshes(order, side)]
        for name, mesh in [*cases, ("round a box", round_a_box(order))]:
            rows.append(measure(name, mesh, options.repeats))
    columns = {
        "mesh": "{mesh}",
        "order": "{order}",
        "elements": "{elements:,}",
        "absorbing": "{absorbing:.0%}",
        "nodes": "{nodes:,}",
        "ns per node and step": "{nanoseconds:.1f}",
    }
    show("Steps of a continuum, one thread", columns, rows)
    bodies = [measure_ties(pattern, order, options.repeats) for order in options.orders for pattern in "AB"]
    of_ties = {
        "pattern": "{pattern}",
        "order": "{order}",
        "disks": "{disks:,}",
        "nodes": "{nodes:,}",
        "ties": "{ties:,}",
        "ns per tie": "{nanoseconds:.1f}",
        "µs per whole step": "{step:.1f}",
        "share of ties": "{share:.0%}",
    }
    show("Ties between disks and a continuum, one thread", of_ties, bodies)
    write(options.json, {"machine": facts, "steps": rows, "ties": bodies})


if __name__ == "__main__":
    main()
