"""Errors of an explosion below a free surface beside Garvin's exact solution: the tables of docs/evidence/exact.md.

    python cases/exact/explosion.py [lattice] [random]      (five minutes of CPU time)

Half of the ground, right of a mirror plane through the source, is stepped; random packings as a whole. The source has
no hole: each bond pushes its disks as under a pressure M g in the whole packing, where g is a Gaussian of unit integral
and width s. In the continuum that is the body force −M ∇g. P waves of frequency ω leave it as they leave a line source,
but with the factor exp(−½(ωs/c_p)²): that is a moment smoothed in time by a Gaussian of width s/c_p.
"""

import sys
from collections.abc import Iterator
from itertools import product

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.ndimage import gaussian_filter1d
from scipy.spatial import cKDTree

import dembound
from dembound.casefile.disks import DiskCase
from dembound.disks.scene import DiskScene, build
from dembound.disks.stability import choose_step
from dembound.disks.surroundings.cut_bonds import CutBonds
from dembound.exact import Solid, buried_explosion
from dembound.motion.simulation import Simulation
from dembound.packings.cut import CutContacts, cut_contacts

MOMENT, FREQUENCY = 1e8, 12.0
"""N, and Hz, of the crest of its Ricker wavelet; the shortest S wave, with 1 % of its amplitude, is 21 m long."""

DEPTH, AWAY, DURATION = 20.0, (10.0, 30.0, 60.0), 0.4
"""m, depth of the source and distances of receivers along the surface from above it; s."""

SIZE = (70.0, 30.0)
"""m, of the half that is stepped."""

SMALL = 1e-4
"""Forces are left out that are smaller than this part of the largest one."""

SAMPLES = 600
"""Number of times at which motion is compared."""


def lattice(diameter: float) -> DiskCase:
    """Disks of a diameter (m) right of a mirror plane, a free surface, and ground beyond."""
    return case_of({"pattern": "A", "size": SIZE, "radius": 0.5 * diameter}, left="symmetry")


def random(diameter: float, seed: int) -> DiskCase:
    """Random disks of a mean diameter (m), of both halves."""
    packing = {"pattern": "B", "size": (2.0 * SIZE[0], SIZE[1]), "radius": 0.5 * diameter, "radius_ratio": 1.5}
    return case_of({**packing, "brick": (20.0 * diameter, 20.0 * diameter), "seed": seed}, left="outside")


def case_of(packing: dict[str, object], left: str) -> DiskCase:
    """The ground without its source."""
    sides = {"left": left, "right": "outside", "bottom": "outside"}
    case = dembound.case(
        packing=packing,
        material={"density": 2500.0, "p_wave_speed": 1000.0, "fric": 0.5, "match": "assembly"},
        boundary={side: {"type": kind} for side, kind in sides.items()},
        wave={"burst": {"type": "ricker", "amplitude": 1.0, "frequency": FREQUENCY}},
        run={"duration": DURATION},
    )
    assert isinstance(case, DiskCase)
    return case


def source_of(case: DiskCase) -> np.ndarray:
    """Place (2,) m of the source, on the mirror plane or in the middle."""
    width, height = case.size
    return np.array([0.0 if case.side("left").is_mirror else 0.5 * width, height - DEPTH])


def exploding(case: DiskCase, width: float) -> DiskScene:
    """The scene with the source, of this standard deviation (m)."""
    scene = build(case)
    forces = MOMENT * pressed(scene, source_of(case), width)[:, :2]
    size = np.hypot(*forces.T)
    loads = [
        {"name": f"{node}", "force": forces[node], "position": scene.positions[node], "wave": "burst"}
        for node in np.flatnonzero(size > SMALL * size.max())
    ]
    return build(dembound.change(case, {"load": loads}))


def pressed(scene: DiskScene, centre: np.ndarray, width: float) -> np.ndarray:
    """Forces and moments (n, 3) of all bonds on disks under a Gaussian pressure (Pa) of unit integral."""
    bonds = CutBonds.of(scene.ground, both_ends(scene), scene.assembly.positions)
    pressure = np.array([-1.0, -1.0, 0.0, 0.0])
    strain = np.linalg.lstsq(scene.ground.material_tensor, pressure, rcond=None)[0]
    away = np.sum((bonds.point - centre) ** 2, axis=1)
    share = np.exp(-0.5 * away / width**2) / (2.0 * np.pi * width**2)
    forces = np.zeros((scene.disk_count, 3))
    np.add.at(forces, bonds.particle, np.einsum("cgt,g,t->tc", bonds.on_disks, strain, share))
    return forces


def both_ends(scene: DiskScene) -> CutContacts:
    """The contacts of a scene at each of their disks, also those across a mirror plane at the left."""
    body, ends = scene.assembly, scene.assembly.pairs.T.astype(np.int64)
    count = len(body.pairs)
    none = np.zeros((2 * count, 2), dtype=np.int64)
    inside = CutContacts(
        node=ends.ravel(),
        contact_type=np.tile(body.contact_type.astype(np.int64), 2),
        is_second=np.repeat([False, True], count),
        other=body.brick_particle[ends[::-1].ravel()],
        tile=none,
        image=none,
        side=np.full(2 * count, -1),
    )
    if not scene.case.side("left").is_mirror:
        return inside
    across = vars(cut_contacts(scene.ground.brick, body, ("left",)))
    return CutContacts(**{name: np.concatenate([values, across[name]]) for name, values in vars(inside).items()})


def solid_of(scene: DiskScene) -> Solid:
    """The isotropic part of the homogenised packing: its moduli averaged over all directions."""
    moduli = scene.ground.material_tensor
    mean, shear = 0.5 * (moduli[0, 0] + moduli[1, 1]), 0.5 * (moduli[2, 2] + moduli[3, 3])
    lateral = moduli[0, 1]
    uniaxial = 0.75 * mean + 0.25 * lateral + 0.5 * shear
    speeds = np.sqrt(np.array([uniaxial, 0.25 * (mean - lateral) + 0.5 * shear]) / scene.ground.density)
    return Solid(scene.ground.density, *speeds.tolist())


class Motion:
    """Motion of the surface, computed and exact.

    Attributes
    ----------
    found, exact : (p, 2, k, 2) displacement (m) and velocity (m/s), along x and y, of p places at k times.
    """

    def __init__(self, scene: DiskScene, width: float, places: np.ndarray, disks: int = 1) -> None:
        """Of a scene with a source of this width (m), at the disks nearest to places (p, 2) m, means of some each."""
        case, step = scene.case, choose_step(scene)[0]
        disk_positions = scene.positions[: scene.disk_count]
        nodes = cKDTree(disk_positions).query(places, disks)[1].reshape(-1, disks)
        record = Simulation(scene, step, nodes.ravel()).advance(round(case.run.duration / step))
        every = max(len(record) // SAMPLES, 1)
        record = record[::every].reshape(-1, *nodes.shape, 6).mean(axis=2)
        times = step * every * np.arange(len(record))
        self.found = np.moveaxis(np.stack([record[..., :2], record[..., 3:5]]), 2, 0)
        at = disk_positions[nodes].mean(axis=1)
        self.exact = exact(times, at - source_of(case), width, case, solid_of(scene))

    def errors(self) -> np.ndarray:
        """RMS (2, p) over time of the difference over that of the exact vector, of displacement and velocity, %."""
        return errors(self.found, self.exact)

    def errors_of_means(self) -> np.ndarray:
        """RMS errors (2, p/2), %, of the means of both sides; the second half of the places are the left ones."""
        return errors(*(0.5 * sum(np.split(values * self._outwards, 2)) for values in (self.found, self.exact)))

    @property
    def _outwards(self) -> np.ndarray:
        """Signs (p, 1, 1, 2) that mirror the motion of places left of the source."""
        signs = np.ones((len(self.found), 1, 1, 2))
        signs[len(signs) // 2 :, ..., 0] = -1.0
        return signs


def errors(found: np.ndarray, expected: np.ndarray) -> np.ndarray:
    """RMS (2, p) over time of the difference of vectors (p, 2, k, 2) over that of the expected ones, %."""
    square = [np.sum(values**2, axis=(2, 3)).T for values in (found - expected, expected)]
    return 100.0 * np.sqrt(square[0] / square[1])


def exact(times: np.ndarray, places: np.ndarray, width: float, case: DiskCase, solid: Solid) -> np.ndarray:
    """Displacement and velocity (p, 2, k, 2) at times (k,) s and places (p, 2) m from a source of this width (m)."""
    delay = width / solid.p_wave_speed
    begin, step = 8.0 * delay, delay / 50.0
    grid = np.arange(0.0, times[-1] + begin + 10.0 * step, step)
    moment = MOMENT * case.wave["burst"].velocity(grid - begin)
    rates = [gaussian_filter1d(moment, delay / step, order=order, truncate=8.0) / step**order for order in (1, 2)]
    found = [
        [
            buried_explosion(times + begin, x, max(DEPTH - y, 0.0), DEPTH, CubicSpline(grid, rate), solid, 1e-5)
            for rate in rates
        ]
        for x, y in places.tolist()
    ]
    return np.moveaxis(np.array(found), 2, 3) * (1.0, -1.0)


def of_lattices() -> Iterator[str]:
    """Errors for several diameters, and with a finer continuum."""
    for diameter, accuracy in product((1.0, 0.5, 0.25), (1e-3, 1e-4)):
        case = dembound.change(lattice(diameter), {"outside": {"accuracy": accuracy}})
        yield f"A, D = {diameter:g} m, continuum for {accuracy:g}: {line(beside_exact(case, 1.5 * diameter).errors())}"


def of_random_packings() -> Iterator[str]:
    """Errors of pattern B right and left of the source, and of their means; sources of two widths, in diameters."""
    for (diameter, widths), seed in product(((0.5, 8.0), (0.25, 8.0), (0.5, 3.0)), (1, 2, 3)):
        motion = beside_exact(random(diameter, seed), widths * diameter, ways=(1.0, -1.0), disks=12)
        name = f"B, seed {seed}, D = {diameter:g} m, width {widths:g} D"
        yield f"{name}: {line(motion.errors())}; means of both sides {line(motion.errors_of_means())}"


def beside_exact(case: DiskCase, width: float, ways: tuple[float, ...] = (1.0,), disks: int = 1) -> Motion:
    """Motion of the surface above a source of this width (m), to the right (1) and left (−1) of it."""
    middle, top = source_of(case)[0], case.size[1]
    places = np.array([(middle + way * x, top) for way in ways for x in AWAY])
    return Motion(exploding(case, width), width, places, disks)


def line(found: np.ndarray) -> str:
    """Errors (2, p) at all places."""
    u, v = (", ".join(f"{value:.2f}" for value in row) for row in found)
    return f"u {u}; v {v} %"


if __name__ == "__main__":
    asked = sys.argv[1:] or ["lattice", "random"]
    for name, results in {"lattice": of_lattices, "random": of_random_packings}.items():
        for text in results() if name in asked else ():
            print(text, flush=True)
