"""Errors of cases/blast.toml beside a large lattice and beside the exact cavity: the tables of docs/blast.md.

    python cases/blast/errors.py      (some minutes; it needs 1 GB)

A quarter of the rock between two mirror planes through the tunnel's axis is stepped. Places are 16 disks at 1.1 to 1.8
radii; errors are RMS over time and places of the vectors, relative to the exact or to the larger motion.
"""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

import dembound
from dembound.disks.scene import build
from dembound.disks.stability import choose_step
from dembound.exact.cavity import cavity_motion
from dembound.exact.solid import Solid
from dembound.motion.simulation import Simulation

CASE = Path(__file__).parents[1] / "blast.toml"
RADIUS, PRESSURE = 10.0, 5e6
"""m and Pa, as in the case."""

BOX, LARGE = 20.0, 85.0
"""Widths (m) of the quarter as in the case, and of one from whose sides nothing returns within the run."""

SOLID = Solid(density=2500.0, p_wave_speed=1000.0, s_wave_speed=1000.0 / np.sqrt(2.0))
DISTANCES, ANGLES = (1.1, 1.3, 1.5, 1.8), (0.0, 22.5, 45.0, 67.5)


def quarter(diameter: float, width: float, side: str, **more: object) -> dembound.Case:
    """The case beside two mirror planes, with the other two sides of one type; widths in m."""
    beyond = {"type": side, **({"half_mass": True} if side == "viscous" else {})}
    changes = {
        "packing.radius": 0.5 * diameter,
        "packing.size": [width, width],
        "hole.tunnel.centre": [0.0, 0.0],
        "boundary": dict.fromkeys(("right", "top"), beyond) | dict.fromkeys(("left", "bottom"), {"type": "symmetry"}),
        "monitor": [],
    }
    return dembound.change(dembound.load(CASE), changes | more)


class Motion:
    """Velocities and displacements at the places.

    Attributes
    ----------
    places : (p, 2) m from the axis. times : (k,) s. velocity, displacement : (k, p, 2) m/s and m.
    """

    def __init__(self, case: dembound.Case, time_step: float | None = None) -> None:
        scene = build(case)
        disks = scene.positions[: scene.recorded]
        angles = np.radians(ANGLES)
        wanted = RADIUS * np.outer(DISTANCES, np.exp(1j * angles)).ravel()
        nodes = [int(np.argmin(np.hypot(x - disks[:, 0], y - disks[:, 1]))) for x, y in zip(wanted.real, wanted.imag)]
        self.step = time_step or choose_step(scene)[0]
        self.places = disks[nodes]
        record = Simulation(scene, self.step, nodes).advance(round(case.run.duration / self.step))
        self.times = self.step * np.arange(len(record))
        self.displacement, self.velocity = record[:, :, :2], record[:, :, 3:5]

    def exact(self) -> "tuple[np.ndarray, np.ndarray]":
        """Displacement and velocity (k, p, 2) of the exact cavity."""
        wave = dembound.load(CASE).wave["burst"]
        distances = np.hypot(*self.places.T)
        found = [
            cavity_motion(self.times, float(r), lambda t: PRESSURE * wave.velocity(t), RADIUS, SOLID) for r in distances
        ]
        radial = np.array([(each.displacement, each.velocity) for each in found]).transpose(1, 2, 0)
        both = radial[..., None] * (self.places / distances[:, None])
        return both[0], both[1]


def error(found: np.ndarray, expected: np.ndarray) -> float:
    """RMS of the difference over that of what is expected, per cent."""
    return 100.0 * float(np.sqrt(np.sum((found - expected) ** 2) / np.sum(expected**2)))


def round_the_wall(motion: Motion, values: np.ndarray) -> np.ndarray:
    """Means (k, r, 1) over the angles of the radial part of values (k, p, 2), at each distance."""
    outwards = motion.places / np.hypot(*motion.places.T)[:, None]
    radial = np.sum(values * outwards, axis=2)
    return radial.reshape(len(radial), len(DISTANCES), len(ANGLES)).mean(axis=2)[..., None]


def beside_exact(motion: Motion) -> str:
    """Errors of velocities and displacements, and of their means over the angles."""
    displacement, velocity = motion.exact()
    pairs = [(motion.velocity, velocity), (motion.displacement, displacement)]
    each = [error(*pair) for pair in pairs]
    mean = [error(*(round_the_wall(motion, values) for values in pair)) for pair in pairs]
    return "v {:.2f}, u {:.2f}; means over the angles v {:.2f}, u {:.2f} %".format(*each, *mean)


def lines() -> Iterator[str]:
    """All results, a line each."""
    for diameter in (0.5, 0.25, 0.125):
        for on in ("outline", "bonds"):
            pressed = {"load.blast.on": on}
            for side, width in (("outside", BOX), ("viscous", BOX), ("free", LARGE)):
                motion = Motion(quarter(diameter, width, side, **pressed))
                yield f"a = {RADIUS / diameter:g} D, on {on}, {side} at {width:g} m, exact: {beside_exact(motion)}"
    large = Motion(quarter(0.5, LARGE, "free"), time_step=1.2e-4)
    for element in (None, 5.0, 3.4, 2.5, 1.25):
        for width in (BOX, 14.0):
            keys = {} if element is None else {"outside": {"element": element}}
            motion = Motion(quarter(0.5, width, "outside", **keys), time_step=large.step)
            inside = np.hypot(*large.places.T) < 1.4 * RADIUS if width < BOX else np.full(len(large.places), True)
            found = [
                error(getattr(motion, name)[:, inside], getattr(large, name)[:, inside])
                for name in ("velocity", "displacement")
            ]
            yield f"box of {width:g} m, elements {element or 'automatic'}, beside the large lattice: v {found[0]:.3f}, u {found[1]:.3f} %"


if __name__ == "__main__":
    for line in lines():
        print(line, flush=True)
