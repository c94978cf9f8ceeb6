"""Errors of cases/blast.toml compared with a large lattice and the exact cavity: the tables of docs/evidence/blast.md.

    python cases/blast/errors.py      (three minutes of CPU time; it needs 1 GB)

A quarter of the rock, between two mirror planes through the tunnel's axis, is stepped. Places are 16 disks at 1.12 to
1.82 radii; errors are RMS over time and places of the vectors, relative to the exact or to the larger motion.
"""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

import dembound
from dembound.disks.scene import build, ground_of
from dembound.disks.stability import choose_step
from dembound.exact.explosion import cavity_motion
from dembound.exact.solid import Solid
from dembound.motion.simulation import Simulation

CASE = dembound.load(Path(__file__).parents[1] / "blast.toml")
RADIUS, PRESSURE = 10.0, 5e6
"""m and Pa, as in the case."""

BOX, SMALL, LARGE = 20.0, 14.0, 85.0
"""Widths (m) of the quarter as in the case, of a smaller one, and of one from whose sides nothing returns in time."""

SOLID = Solid(density=2500.0, p_wave_speed=1000.0, s_wave_speed=1000.0 / np.sqrt(2.0))
DISTANCES, ANGLES = (1.12, 1.32, 1.52, 1.82), (0.0, 22.5, 45.0, 67.5)


def quarter(diameter: float, width: float, side: str, **more: object) -> dembound.Case:
    """The case with two mirror planes, and the other two sides of one type; lengths in m."""
    beyond = {"type": side, **({"half_mass": True} if side == "viscous" else {})}
    sides = {"left": {"type": "symmetry"}, "bottom": {"type": "symmetry"}, "right": beyond, "top": beyond}
    changes = {
        "packing.radius": 0.5 * diameter,
        "packing.size": [width, width],
        "hole.tunnel.centre": [0.0, 0.0],
        "boundary": sides,
        "monitor": [],
    }
    return dembound.change(CASE, changes | more)


class Motion:
    """Motion at the places.

    Attributes
    ----------
    step : s. places : (p, 2) m from the axis, the means of some disks each. times : (k,) s. displacement, velocity :
    (k, p, 2) m and m/s.
    """

    def __init__(
        self, case: dembound.Case, step: float | None = None, angles: tuple[float, ...] = ANGLES, disks: int = 1
    ) -> None:
        scene = build(case)
        from_axis = scene.positions[: scene.recorded] - case.hole[0].centre
        points = RADIUS * np.outer(DISTANCES, np.exp(1j * np.radians(angles))).ravel()
        nodes = cKDTree(from_axis).query(np.stack([points.real, points.imag], axis=1), disks)[1].reshape(-1, disks)
        self.step = step or choose_step(scene)[0]
        self.places = from_axis[nodes].mean(axis=1)
        record = Simulation(scene, self.step, nodes.ravel().tolist()).advance(round(case.run.duration / self.step))
        record = record.reshape(len(record), *nodes.shape, -1).mean(axis=2)
        self.times = self.step * np.arange(len(record))
        self.displacement, self.velocity = record[:, :, :2], record[:, :, 3:5]

    def exact(self, radius: float = RADIUS, solid: Solid = SOLID) -> tuple[np.ndarray, np.ndarray]:
        """Displacement and velocity (k, p, 2) round the exact cavity, of another radius (m) and solid if given."""
        wave, distances = CASE.wave["burst"], np.hypot(*self.places.T)

        def pressure(times: np.ndarray) -> np.ndarray:
            return PRESSURE * wave.velocity(times)

        found = [cavity_motion(self.times, float(r), pressure, radius, solid) for r in distances]
        radial = np.array([(each.displacement, each.velocity) for each in found]).transpose(1, 2, 0)
        displacement, velocity = radial[..., None] * (self.places / distances[:, None])
        return displacement, velocity


def error(found: np.ndarray, expected: np.ndarray) -> float:
    """RMS of the difference over RMS of the expected motion, per cent."""
    return 100.0 * float(np.sqrt(np.sum((found - expected) ** 2) / np.sum(expected**2)))


def round_the_axis(motion: Motion, values: np.ndarray) -> np.ndarray:
    """Means (k, r) over the angles of the radial part of values (k, p, 2), at each distance."""
    outwards = motion.places / np.hypot(*motion.places.T)[:, None]
    radial = np.sum(values * outwards, axis=2)
    return radial.reshape(len(radial), len(DISTANCES), -1).mean(axis=2)


def beside_exact(motion: Motion, displacement: np.ndarray, velocity: np.ndarray) -> str:
    """Errors of velocities and displacements, and of their means over the angles."""
    pairs = [(motion.velocity, velocity), (motion.displacement, displacement)]
    each = [error(*pair) for pair in pairs]
    mean = [error(*(round_the_axis(motion, values) for values in pair)) for pair in pairs]
    return "v {:.2f}, u {:.2f}; means over the angles v {:.2f}, u {:.2f} %".format(*each, *mean)


def best_radius(motion: Motion, displacement: np.ndarray, diameter: float) -> float:
    """Diameters by which the exact cavity with the most similar displacement is larger than the hole."""
    wider = motion.exact(RADIUS + 0.1 * diameter)[0] - displacement
    return 0.1 * float(np.sum(wider * (motion.displacement - displacement)) / np.sum(wider**2))


def of_the_hole() -> Iterator[str]:
    """Errors relative to the exact cavity, with a continuum, dashpots, or a large lattice beyond the box."""
    for diameter in (0.5, 0.25, 0.125):
        for on in ("outline", "bonds"):
            for side, width in (("outside", BOX), ("viscous", BOX), ("free", LARGE)):
                motion = Motion(quarter(diameter, width, side, **{"load.blast.on": on}))
                exact = motion.exact()
                yield f"a = {RADIUS / diameter:g} D, on {on}, {side} at {width:g} m: {beside_exact(motion, *exact)}"
            yield f"best radius: a + {best_radius(motion, exact[0], diameter):.2f} D"


def of_the_continuum() -> Iterator[str]:
    """Errors of boxes with a continuum relative to the same hole in a large lattice, with equal steps."""
    large = Motion(quarter(0.5, LARGE, "free"), step=1.2e-4)
    for width in (BOX, SMALL):
        inside = np.hypot(*large.places.T) < (1.4 if width < BOX else 2.0) * RADIUS
        for size in (2.5, 5.0):
            motion = Motion(quarter(0.5, width, "outside", outside={"element": size}), step=large.step)
            pairs = [(motion.velocity, large.velocity), (motion.displacement, large.displacement)]
            v, u = (error(*(values[:, inside] for values in pair)) for pair in pairs)
            yield f"box of {width:g} m, elements of {size:g} m, beside the large lattice: v {v:.3f}, u {u:.3f} %"


def of_random_packings() -> Iterator[str]:
    """Errors of pattern B, all round the axis, relative to the exact cavity with its mean speed along x and y."""
    packing = {"pattern": "B", "size": [160.0, 160.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [10.0, 10.0]}
    common = {"hole.tunnel.centre": [80.0, 80.0], "monitor": [], "boundary": {}, "material.match": "assembly"}
    for seed in (1, 2, 3):
        for on in ("outline", "bonds"):
            case = dembound.change(CASE, {**common, "packing": packing | {"seed": seed}, "load.blast.on": on})
            speeds = np.mean([ground_of(case).wave_speeds(axis) for axis in (0, 1)], axis=0)
            motion = Motion(case, angles=tuple(np.arange(0.0, 360.0, 22.5)), disks=4)
            exact = motion.exact(solid=Solid(2500.0, *speeds.tolist()))
            yield f"pattern B, seed {seed}, a = 20 D, on {on}: {beside_exact(motion, *exact)}"


if __name__ == "__main__":
    for results in (of_the_continuum(), of_the_hole(), of_random_packings()):
        for line in results:
            print(line, flush=True)
