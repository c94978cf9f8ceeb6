"""Z's tunnel in random disks: ground of disks, and a box of them in a continuum, compared with endless disks.

    python cases/outside/random_tunnel.py [--pattern B] [--period 0.5] [--element 30] [--margin 1] [--seeds 1 2 3]

An SV pulse meets a tunnel of 20 m radius, 162.5 m below the surface. The reference is the same packing over 1,225 m ×
750 m, to whose sides and back no wave runs within the run. All have the same free-field column, 750 m high. Printed are
the errors of (v_x, v_y) in per cent of the total motion, RMS over time, of means of twelve disks, and of the worst one.
"""

import argparse

import numpy as np
from scipy.spatial import cKDTree

import dembound
from dembound.casefile.disks import DiskCase
from dembound.disks.scene import build
from dembound.disks.stability import choose_step
from dembound.motion.simulation import Simulation

WIDTH, HEIGHT, DEPTH, RADIUS = 1225.0, 750.0, 162.5, 20.0
"""Width and height of the ground, depth of the tunnel's centre and radius of its wall, m."""

DURATION = 1.9
"""s, in which P waves run from the tunnel, which the pulse reaches after 0.8 s, to the sides and back."""

BODIES = {"endless": (1225.0, 750.0, 0.0), "325 m × 300 m": (325.0, 300.0, 450.0), "75 m × 75 m": (75.0, 75.0, 550.0)}
"""Width, height, and height of the lower side of the bodies of disks, m; all consist of whole bricks."""

PLACES = {"P1": (-20.5, 0.0), "P2": (0.0, 20.5), "shoulder": (-15.5, 15.5), "surface": (0.0, 162.0)}
"""Places relative to the tunnel's centre, m."""

MEAN = 12
"""Disks of a place."""


def tunnel(body: str, seed: int, monitors: np.ndarray, given: argparse.Namespace) -> DiskCase:
    """The case of a body, with monitors at places (k, 2) m."""
    width, height, bottom = BODIES[body]
    sides = ["left", "right", "bottom"] + ["top"] * (bottom + height < HEIGHT)
    boundary = {side: {"type": "outside"} for side in sides}
    boundary["bottom"]["wave_s"] = "pulse"
    packing = {"pattern": given.pattern, "radius": 0.5, "radius_ratio": 1.5, "brick": (25.0, 25.0), "seed": seed}
    if given.pattern == "C":
        packing["edge_radius"] = 0.5
    return dembound.case(
        ground={"size": (WIDTH, HEIGHT)},
        packing=packing | {"size": (width, height), "origin": (0.5 * (WIDTH - width), bottom)},
        material={"density": 2500.0, "p_wave_speed": 1000.0, "fric": 0.5},
        boundary=boundary,
        outside={"element": given.element, "margin": given.margin},
        hole=[{"name": "tunnel", "type": "circle", "centre": (0.5 * WIDTH, HEIGHT - DEPTH), "radius": RADIUS}],
        wave={"pulse": {"type": "cosine", "amplitude": 0.5, "period": given.period}},
        monitor=[{"name": f"m{number}", "position": place} for number, place in enumerate(monitors)],
        run={"duration": DURATION},
    )


def disks_at_places(seed: int, given: argparse.Namespace) -> np.ndarray:
    """Positions (places·MEAN, 2) m of the disks next to the places."""
    scene = build(tunnel("325 m × 300 m", seed, np.zeros((0, 2)), given))
    disks = scene.positions[scene.seam.count : scene.disk_count]
    requested = np.array([0.5 * WIDTH, HEIGHT - DEPTH]) + list(PLACES.values())
    return disks[cKDTree(disks).query(requested, MEAN)[1].ravel()]


def motions(seed: int, given: argparse.Namespace) -> dict[str, np.ndarray]:
    """Velocities (steps, places, MEAN, 2) in each body."""
    monitors = disks_at_places(seed, given)
    scenes = {body: build(tunnel(body, seed, monitors, given)) for body in BODIES}
    step, found = min(choose_step(scene)[0] for scene in scenes.values()), {}
    for body, scene in scenes.items():
        record = scene.observed(Simulation(scene, step, scene.probes).advance(int(DURATION / step)))
        found[body] = record[:, : len(monitors), 3:5].reshape(-1, len(PLACES), MEAN, 2)
    return found


def errors(found: np.ndarray, expected: np.ndarray) -> np.ndarray:
    """RMS of differences (steps, …, 2) over RMS of the expected motion."""
    return np.sqrt(np.sum((found - expected) ** 2, axis=(0, -1)) / np.sum(expected**2, axis=(0, -1)))


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pattern", choices=("B", "C"), default="B")
    parser.add_argument("--period", type=float, default=0.5, help="of the pulse, s (%(default)s)")
    parser.add_argument("--element", type=float, default=30.0, help="largest side of elements, m (%(default)s)")
    parser.add_argument("--margin", type=int, default=1, help="elements before those that absorb (%(default)s)")
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2, 3])
    given = parser.parse_args()
    for seed in given.seeds:
        found = motions(seed, given)
        expected = found.pop("endless")
        for body, motion in found.items():
            of_means, of_disks = errors(motion.mean(axis=2), expected.mean(axis=2)), errors(motion, expected)
            words = (f"{name} {100.0 * error:.3f}" for name, error in zip(PLACES, of_means, strict=True))
            print(
                f"seed {seed}, {body}: {', '.join(words)}; single disks up to {100.0 * of_disks.max():.3f}", flush=True
            )


if __name__ == "__main__":
    main()
