"""Effect of each part of the continuum beside random packings: Lamb's problem, compared with an endless packing.

    python cases/outside/random_surface.py [--period 0.3] [--seeds 1 2 3] [--picture surface.png]

A vertical force in the middle of the surface of 50 m × 25 m of disks (pattern B, 1 m, two bricks) with a continuum on
three sides. Displacement and velocity at the surface and below are compared with those of the same packing over
850 m × 425 m, from whose sides nothing returns; places are means of twelve disks. Printed are the errors in per cent of
the motion, RMS over time, places and seeds: with everything, with one part left out, and with none.
"""

import argparse
from contextlib import ExitStack
from dataclasses import dataclass, replace
from pathlib import Path
from unittest.mock import patch

import matplotlib.pyplot as plt
import numpy as np
from scipy.spatial import cKDTree

from dembound.casefile import Case
from dembound.continuum.interpolation import interpolation
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.scene import DiskScene, build
from dembound.disks.stability import choose_step
from dembound.disks.surroundings import continuum, wall
from dembound.kinds import loads
from dembound.motion.simulation import Simulation
from dembound.plot.style import COLOURS

BRICK, BODY, ALONE = 25.0, (2, 1), (34, 17)
"""Side of a brick, m; numbers of bricks of the body, and of the packing without a continuum."""

DISTANCES = (10.0, 20.0, 40.0, 80.0)
"""Distances of the places on the surface to both sides of the force, m."""

BELOW = ((0.0, 60.0), (40.0, 40.0), (-40.0, 40.0))
"""Places in the continuum: distance and depth, m."""

ALL = "all three"
PARTS = ("nothing", "C16, C26", "correctors", "skin", ALL)
"""Parts of the continuum that are left out in turn."""

MEAN = 12
"""Disks of a place."""

CASE = """
[packing]
pattern = "B"
size = [{width}, {height}]
radius = 0.5
radius_ratio = 1.5
brick = [25.0, 25.0]
seed = {seed}
[material]
density = 2500.0
p_wave_speed = 1000.0
fric = 0.5
[outside]
element = {element}
margin = {margin}
layers = 5
[[load]]
name = "force"
position = [{middle}, {top}]
force = [0.0, -1e6]
wave = "pulse"
[wave.pulse]
type = "cosine"
amplitude = 1.0
period = {period}
[run]
duration = 1.0
"""

OUTSIDE = "".join(f'[boundary.{side}]\ntype = "outside"\n' for side in ("left", "right", "bottom"))


def case(bricks: tuple[int, int], seed: int, period: float, extra: str = "") -> Case:
    """A force on so many bricks; elements suit the period, and the layers lie beyond all places."""
    width, height = BRICK * bricks[0], BRICK * bricks[1]
    element = BRICK / (2 if period > 0.2 else 3)
    words = {"seed": seed, "period": period, "element": element, "margin": round(75.0 / element)}
    return loads(CASE.format(width=width, height=height, middle=0.5 * width, top=height - 0.5, **words) + extra)


@dataclass(frozen=True)
class Reference:
    """Motion (steps, p, 4) at p places of the endless packing, and the positions (p, MEAN, 2) m of their disks."""

    motion: np.ndarray
    disks: np.ndarray


def means(scene: DiskScene, step: float, steps: int, nodes: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Displacement and velocity (steps, p, 4) at p places, weighted means of nodes (p, k)."""
    every, place = np.unique(nodes, return_inverse=True)
    motion = Simulation(scene, step, every).advance(steps)[:, :, [0, 1, 3, 4]]
    pairs = zip(place.reshape(nodes.shape), weights, strict=True)
    return np.stack([np.einsum("skc,k->sc", motion[:, of], weight) for of, weight in pairs], axis=1)


def alone(seed: int, period: float, step: float, steps: int) -> Reference:
    """The motion of the packing without a continuum, its disks as seen from the lower left corner of the body."""
    scene = build(case(ALONE, seed, period))
    surface = [(sign * distance, 0.0) for distance in DISTANCES for sign in (-1, 1)]
    offsets = np.array([*surface, *BELOW]) * [1.0, -1.0]
    places = offsets + np.array(ALONE) * [0.5 * BRICK, BRICK] - [0.0, 0.5]
    disks = cKDTree(scene.positions).query(places, MEAN)[1]
    motion = means(scene, step, steps, disks, np.full(disks.shape, 1.0 / MEAN))
    corner = 0.5 * BRICK * (ALONE[0] - BODY[0]), BRICK * (ALONE[1] - BODY[1])
    return Reference(motion, scene.positions[disks] - corner)


def beside(scene: DiskScene, reference: Reference, step: float) -> np.ndarray:
    """Means at the reference's places in the body and, where it has no disks, of the continuum."""
    points = reference.disks.reshape(-1, 2)
    far, disk = cKDTree(scene.positions[: scene.recorded]).query(points)
    at = interpolation(scene.outside.body.mesh, points)
    nodes, weights = scene.recorded + at.node, at.weight / MEAN
    inside = far < 1e-6
    nodes[inside], weights[inside] = disk[inside, None], 1.0 / (MEAN * nodes.shape[1])
    shape = len(reference.disks), -1
    return means(scene, step, len(reference.motion), nodes.reshape(shape), weights.reshape(shape))


def without(part: str) -> ExitStack:
    """A context in which scenes are built without a part."""
    medium, middle = continuum.medium_of, wall._middle
    replaced = {
        "C16, C26": (continuum, "medium_of", lambda ground: replace(medium(ground), c16=0.0, c26=0.0)),
        "correctors": (wall, "_middle", lambda *given: 0.0 * middle(*given)),
        "skin": (PackedMaterial, "skin", lambda ground, side: 0.0),
    }
    context = ExitStack()
    for name, what in replaced.items():
        if part in (name, ALL):
            context.enter_context(patch.object(*what))
    return context


def measured(seed: int, period: float) -> tuple[float, np.ndarray, dict[str, np.ndarray]]:
    """Time step (s), motion of the endless packing (steps, p, 4), and motion beside the continuum by part left out."""
    scenes = {}
    for part in PARTS:
        with without(part):
            scenes[part] = build(case(BODY, seed, period, OUTSIDE))
    step = min(choose_step(scene)[0] for scene in scenes.values())
    reference = alone(seed, period, step, int((0.4 + 1.3 * period) / step))
    return step, reference.motion, {part: beside(scene, reference, step) for part, scene in scenes.items()}


def errors(motion: np.ndarray, alone: np.ndarray) -> np.ndarray:
    """RMS (p, 2) over time of the errors of displacement and velocity over those of the motion, per cent."""
    off, whole = (np.sum(each**2, axis=0).reshape(-1, 2, 2).sum(axis=2) for each in (motion - alone, alone))
    return 100.0 * np.sqrt(off / whole)


def row(part: str, found: np.ndarray) -> str:
    """A row of the table: errors (seeds, p, 2) over both sides at each distance, and below."""
    groups = [found[:, 2 * k : 2 * k + 2] for k in range(len(DISTANCES))] + [found[:, 2 * len(DISTANCES) :]]
    words = [[f"{np.sqrt(np.mean(group[:, :, k] ** 2)):.2f}" for group in groups] for k in (0, 1)]
    return f"| {part} | " + " | ".join(words[0] + words[1]) + " |"


def draw(path: Path, step: float, alone: np.ndarray, beside: dict[str, np.ndarray]) -> None:
    """Vertical velocity at the farthest place right of the force, and what the continuum changes in it."""
    figure, (above, below) = plt.subplots(2, 1, figsize=(7.0, 4.6), layout="constrained", sharex=True)
    time, velocity = step * np.arange(len(alone)), (slice(None), 2 * len(DISTANCES) - 1, 3)
    above.plot(time, 1e3 * alone[velocity], color=COLOURS[-1])
    above.set_ylabel(f"vertical velocity\n{DISTANCES[-1]:g} m from the force (mm/s)")
    for label, part, colour in (("without the skin", "skin", COLOURS[1]), ("with the skin", "nothing", COLOURS[0])):
        below.plot(time, 1e3 * (beside[part] - alone)[velocity], label=label, color=colour)
    below.set(xlabel="time (s)", ylabel="beside the continuum\nless packing alone (mm/s)")
    below.legend(frameon=False)
    figure.savefig(path, dpi=150)


def main() -> None:
    """Measure, print a table, draw a picture of the last seed."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--period", type=float, default=0.3, help="of the pulse, s (%(default)s)")
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2, 3])
    parser.add_argument("--picture", type=Path, help="file for histories at the farthest place")
    given = parser.parse_args()
    found = {part: [] for part in PARTS}
    for seed in given.seeds:
        step, reference, motions = measured(seed, given.period)
        for part, motion in motions.items():
            found[part].append(errors(motion, reference))
        print(f"seed {seed}: {row('nothing', np.stack(found['nothing'][-1:]))}")
    for part, each in found.items():
        print(row(part, np.stack(each)))
    if given.picture:
        draw(given.picture, step, reference, motions)


if __name__ == "__main__":
    main()
