"""Errors of a tunnel's wall under P and SV waves beside the exact series: the table of docs/evidence/exact.md.

    python cases/exact/scattering.py      (two minutes of CPU time)

Places are the disks nearest to 72 points of the wall; the exact motion is that at their own centres.
"""

from pathlib import Path

import numpy as np

import dembound
from dembound.accuracy.of_disks.exact import problem_of
from dembound.disks.scene import build
from dembound.disks.stability import choose_step
from dembound.motion.simulation import Simulation

BLAST = dembound.load(Path(__file__).parents[1] / "blast.toml")
RADIUS, PLACES = 10.0, 72
"""Radius, m, and number of points of the wall; rock, tunnel and box are those of the blast."""


def case_of(kind: str, angle: float, diameter: float, places: int) -> dembound.Case:
    """The tunnel under a wave of a kind at an angle (degrees), in disks of a diameter (m), and points of its wall."""
    centre = BLAST.hole[0].centre
    around = np.linspace(0.0, 2.0 * np.pi, places, endpoint=False)
    points = centre + (RADIUS + 0.25 * diameter) * np.column_stack([np.cos(around), np.sin(around)])
    changes = {
        "packing.radius": 0.5 * diameter,
        "load": [],
        "wave.burst.period": 0.1,
        "incident": {"type": kind, "angle": angle, "wave": "burst"},
        "monitor": [{"name": f"{k}", "position": point} for k, point in enumerate(points)],
        "run.duration": 0.25,
    }
    return dembound.change(BLAST, changes)


def errors(kind: str, angle: float, diameter: float, places: int = PLACES) -> np.ndarray:
    """RMS (3,) over time and places of the difference over that of the exact motion, per cent.

    Of the displacement along the wall, the velocity along it, and of the vector of velocity.
    """
    scene = build(case_of(kind, angle, diameter, places))
    step = choose_step(scene)[0]
    nodes = np.array([scene.monitors[f"{k}"] for k in range(places)])
    record = Simulation(scene, step, nodes).advance(round(scene.case.run.duration / step))
    every = max(len(record) // 500, 1)
    record, times = record[::every], step * every * np.arange(len(record[::every]))
    motions = problem_of(scene, "scattering").motions(times)
    exact = [motions[f"{k}"] for k in range(places)]
    outwards = scene.positions[nodes] - scene.case.hole[0].centre
    along = outwards[:, ::-1] * (-1.0, 1.0) / np.hypot(*outwards.T)[:, None]
    moved = record[..., :2], np.stack([each.displacement[:, :2] for each in exact], axis=1)
    moving = record[..., 3:5], np.stack([each.velocity[:, :2] for each in exact], axis=1)
    hoop = [[np.sum(values * along, axis=2) for values in pair] for pair in (moved, moving)]
    return np.array([error(*pair) for pair in (*hoop, moving)])


def error(found: np.ndarray, expected: np.ndarray) -> float:
    """RMS of the difference over RMS of the expected motion, per cent."""
    return 100.0 * float(np.sqrt(np.sum((found - expected) ** 2) / np.sum(expected**2)))


if __name__ == "__main__":
    for kind in ("p", "sv"):
        for angle in (0.0, 30.0):
            for diameter in (0.5, 0.25, 0.125):
                u, v, whole = errors(kind, angle, diameter)
                name = f"{kind.upper()} {angle:g}°, a = {RADIUS / diameter:g} D"
                print(f"{name}: hoop u {u:.2f}, v {v:.2f}; velocity {whole:.2f} %", flush=True)
