"""The tunnel of Zhou et al. (2018), section 4, in an elastic continuum: the reference for figure 18.

Finite elements in plane strain (`pip install scikit-fem`) on ground so wide that nothing scattered comes back
from its sides. The histories are written as a record like a run's, for `dembound plot` and `dembound compare`.

    python cases/zhou2018/tunnel_continuum.py                                         # the paper's own moduli
    python cases/zhou2018/tunnel_continuum.py --p-wave-speed 1000 --s-wave-speed 707.1 --name tunnel_continuum_a

With --check (a minute) and the paper's moduli, velocity in RMS over 2 s: ground without a tunnel 0.19 % from its exact
motion; halving all elements changes P1 by 0.14 %, P2 by 0.20 %.
"""

import argparse
import logging
import math
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import h5py
import numpy as np
from scipy.sparse import csr_array, diags_array
from scipy.sparse.linalg import eigsh
from skfem import Basis, ElementQuad1, ElementVector, LinearForm, MeshQuad
from skfem.models.elasticity import lame_parameters, linear_elasticity

from dembound import __version__
from dembound.files import replacing
from dembound.waves import Cosine

PULSE = Cosine(type="cosine", amplitude=0.5, period=0.5)
"""The incident velocity (Z eq. 12)."""

CENTRE, RADIUS, SURFACE = 150.0, 20.0, 300.0
"""Both coordinates of the tunnel's centre, its radius, and the height of the surface over the box's base, m."""

BLOCK, WALL_ELEMENT = 40.0, 1.25
"""Half the side of the square round the tunnel that rings of elements fill; longest element side on the wall, m."""

FAR_ELEMENTS, ROW_ELEMENTS = 12, 30
"""Elements per shortest S wavelength off the pulse's way, and along it, where a slowness of (kh)²/24 adds up."""

BESIDE, BELOW = 1000.0, 700.0
"""Least ground beside the box, and ground below it, m."""

MONITORS = {"P1": (CENTRE - RADIUS, CENTRE), "P2": (CENTRE, CENTRE + RADIUS), "surface": (CENTRE, SURFACE)}
"""Left wall and crown of the tunnel, and the surface above it."""

FREE_FIELD = {"free_field": (CENTRE, CENTRE), "free_surface": (CENTRE, SURFACE)}
"""Monitors of the ground without a tunnel."""


@dataclass(frozen=True)
class Problem:
    """Density kg/m³, wave speeds m/s, height m at which the pulse starts at time 0, duration s, element division."""

    density: float
    p_wave_speed: float
    s_wave_speed: float
    level: float
    duration: float
    refinement: int

    def element(self, per_wavelength: int) -> float:
        """Element side, m, that puts so many on the pulse's shortest wavelength, before refinement."""
        return self.s_wave_speed / PULSE.highest_frequency() / (per_wavelength * self.refinement)

    def incident(self, kind: str, height: np.ndarray | float, time: np.ndarray | float) -> np.ndarray:
        """The pulse on its way up: its "velocity" m/s or "displacement" m at heights m and times s."""
        return getattr(PULSE, kind)(time - (height - self.level) / self.s_wave_speed)


@dataclass(frozen=True)
class History:
    """Motion of one node: position (2,) m, time (k,) s, displacement (k, 2) m, velocity (k, 2) m/s."""

    position: np.ndarray
    time: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray


def tunnel_mesh(problem: Problem) -> MeshQuad:
    """The left half of the ground, up to the tunnel's axis: a grid round a block of rings.

    Under a vertical SV wave u_x is even and u_y odd about the axis, so that it moves like a far side: along x only.
    """
    divisions = _divisions(problem)
    margin = max(BESIDE, 0.5 * problem.p_wave_speed * problem.duration)  # no way there and back in time
    beside = _lines(-margin, CENTRE - BLOCK, problem.element(FAR_ELEMENTS))
    grid = MeshQuad.init_tensor(np.append(beside[:-1], np.linspace(beside[-1], CENTRE, divisions + 1)), _rows(problem))
    from_centre = np.abs(grid.p[:, grid.t].mean(axis=1) - CENTRE).max(axis=0)
    return (grid.remove_elements(np.flatnonzero(from_centre < BLOCK)) + _rings(divisions)).with_defaults()


def column_mesh(problem: Problem) -> MeshQuad:
    """Ground without a tunnel: one element wide, with the rows of `tunnel_mesh`."""
    return MeshQuad.init_tensor(np.array([CENTRE - BLOCK, CENTRE]), _rows(problem)).with_defaults()


def _lines(start: float, end: float, size: float) -> np.ndarray:
    """Evenly spaced grid lines from start to end, at most `size` apart."""
    return np.linspace(start, end, math.ceil((end - start) / size) + 1)


def _divisions(problem: Problem) -> int:
    """Elements along half a side of the block, and along an eighth of the tunnel's wall: fine enough for both."""
    along_wall = 0.25 * math.pi * RADIUS * problem.refinement / WALL_ELEMENT
    return math.ceil(max(BLOCK / problem.element(ROW_ELEMENTS), along_wall))


def _rows(problem: Problem) -> np.ndarray:
    """Heights of the grid lines, m: fine from the pulse's tail at time 0 up to the surface."""
    tail = problem.level - problem.s_wave_speed * PULSE.duration()
    fine = problem.element(ROW_ELEMENTS)
    below = [_lines(-BELOW, tail, problem.element(FAR_ELEMENTS)), _lines(tail, CENTRE - BLOCK, fine)]
    block = np.linspace(CENTRE - BLOCK, CENTRE + BLOCK, 2 * _divisions(problem) + 1)
    return np.unique(np.concatenate([*below, block, _lines(CENTRE + BLOCK, SURFACE, fine)]))


def _rings(divisions: int) -> MeshQuad:
    """The left half of the block, from the tunnel's wall to the square; radii grow geometrically, as elements do."""
    layers = round(4 * divisions / math.pi * math.log(BLOCK / RADIUS))
    outwards = (RADIUS * (BLOCK / RADIUS) ** (np.arange(layers + 1) / layers) - RADIUS) / (BLOCK - RADIUS)
    tensor = MeshQuad.init_tensor(outwards, np.linspace(-2.0, 2.0, 4 * divisions + 1))
    weight, place = tensor.p  # place: along half the square's outline, in halves of a side
    circle = RADIUS * np.array([-np.cos(0.25 * math.pi * place), np.sin(0.25 * math.pi * place)])
    square = BLOCK * np.array([-np.minimum(1.0, 2.0 - np.abs(place)), np.clip(place, -1.0, 1.0)])
    return MeshQuad(CENTRE + (1.0 - weight) * circle + weight * square, tensor.t)


def solve(
    problem: Problem, mesh: MeshQuad, places: dict[str, tuple[float, float]], steps: int = 1
) -> dict[str, History]:
    """Histories at the nodes next to named places, by central differences with lumped mass in at least `steps` steps.

    The pulse comes in as the state at time 0: it then stands in the ground below its level, everything above is at
    rest. Sides move along x only, which is exact beside a vertical SV wave; surface and wall are free.
    """
    basis = Basis(mesh, ElementVector(ElementQuad1()))
    stiffness, mass, dashpots, free = _matrices(problem, basis)
    fastest = math.sqrt(_largest_eigenvalue(stiffness, np.sqrt(free / mass)))  # rad/s
    steps = max(steps, math.ceil(problem.duration * fastest / 1.9))  # 2 is stable, but `fastest` is not exact
    times, step = np.linspace(0.0, problem.duration, steps + 1, retstep=True)
    nodes = [int(np.argmin(np.hypot(*(mesh.p.T - place).T))) for place in places.values()]
    watched = basis.nodal_dofs[:, nodes]
    displacements, velocities = np.empty((2, steps + 1, *watched.shape))
    displacement, velocity = np.zeros((2, basis.N))
    displacement[basis.nodal_dofs[0]] = problem.incident("displacement", mesh.p[1], 0.0)
    velocity[basis.nodal_dofs[0]] = problem.incident("velocity", mesh.p[1], -0.5 * step)
    kept, gain = mass / step - 0.5 * dashpots, free / (mass / step + 0.5 * dashpots)
    for k in range(steps + 1):
        later = gain * (kept * velocity - stiffness @ displacement)
        displacements[k], velocities[k] = displacement[watched], 0.5 * (velocity + later)[watched]
        displacement, velocity = displacement + step * later, later
    return {
        name: History(mesh.p[:, node], times, displacements[:, :, i], velocities[:, :, i])
        for i, (name, node) in enumerate(zip(places, nodes, strict=True))
    }


def _matrices(problem: Problem, basis: Basis) -> tuple[csr_array, np.ndarray, np.ndarray, np.ndarray]:
    """Stiffness, and per degree of freedom: lumped mass, the base's dashpots ρc_s and ρc_p, 1 if free and 0 if held."""
    density, c_p, c_s = problem.density, problem.p_wave_speed, problem.s_wave_speed
    stiffness = linear_elasticity(density * (c_p**2 - 2.0 * c_s**2), density * c_s**2).assemble(basis)
    mass = LinearForm(lambda v, _: density * (v[0] + v[1])).assemble(basis)
    dashpots = LinearForm(lambda v, _: density * (c_s * v[0] + c_p * v[1])).assemble(basis.boundary("bottom"))
    free = np.ones(basis.N)
    free[basis.get_dofs(["left", "right"]).all("u^2")] = 0.0
    return csr_array(stiffness), mass, dashpots, free


def _largest_eigenvalue(stiffness: csr_array, scale: np.ndarray) -> float:
    """Largest eigenvalue of the stiffness scaled from both sides, to 1 %, from the same start each time."""
    scaled, start = diags_array(scale) @ stiffness @ diags_array(scale), np.random.default_rng(0).random(len(scale))
    return float(eigsh(scaled, k=1, tol=0.01, v0=start, return_eigenvectors=False)[0])


def write_record(path: Path, name: str, histories: dict[str, History]) -> None:
    """Write histories as the record of a run of that name; nodes do not rotate and are no particles."""
    with replacing(path) as part, h5py.File(part, "w") as file:
        size = 2.0 * CENTRE, SURFACE
        file.attrs.update({"name": name, "case": "", "version": __version__, "size": size, "complete": True})
        for monitor, history in histories.items():
            group = file.create_group(f"histories/{monitor}")
            group.attrs.update(
                {"particle": -1, "position": history.position, "requested": history.position, "unit": "m"}
            )
            group.create_dataset("time", data=history.time).attrs["unit"] = "s"
            for kind, unit in (("displacement", "m, m, rad"), ("velocity", "m/s, m/s, rad/s")):
                group.create_dataset(kind, data=np.pad(getattr(history, kind), [(0, 0), (0, 1)])).attrs["unit"] = unit


def check(problem: Problem, histories: dict[str, History]) -> None:
    """Print the errors of the ground without a tunnel, and what halving the elements changes at the tunnel."""
    times = histories["free_field"].time
    for name, (_, height) in FREE_FIELD.items():
        exact = np.sum([problem.incident("velocity", way, times) for way in (height, 2.0 * SURFACE - height)], axis=0)
        print(f"{name:12s} beside its exact motion: RMS {_rms(histories[name].velocity[:, 0], exact):.3%}")
    fine = replace(problem, refinement=2 * problem.refinement)
    for name, reference in solve(fine, tunnel_mesh(fine), MONITORS).items():
        coarse = np.interp(reference.time, histories[name].time, histories[name].velocity[:, 0])
        print(f"{name:12s} beside halved elements: RMS {_rms(coarse, reference.velocity[:, 0]):.3%}")


def _rms(values: np.ndarray, reference: np.ndarray) -> float:
    return float(np.linalg.norm(values - reference) / np.linalg.norm(reference))


def _arguments() -> argparse.Namespace:
    """The arguments of the command line, with wave speeds from the moduli where none are given."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    number = partial(parser.add_argument, type=float, metavar="X")
    number("--density", default=2500.0, help="kg/m3 (%(default)s)")
    number("--youngs-modulus", default=1.25e9, help="Pa (%(default)s, the paper's)")
    number("--poisson-ratio", default=0.0, help="%(default)s, the paper's")
    number("--p-wave-speed", help="m/s; together with --s-wave-speed, instead of the moduli")
    number("--s-wave-speed", help="m/s")
    number("--level", default=0.0, help="height at which the pulse starts, m (%(default)s)")
    number("--duration", default=2.0, help="s (%(default)s)")
    parser.add_argument("--check", action="store_true", help="measure the errors")
    parser.add_argument("--name", default="tunnel_continuum", help="of the record and its folder (%(default)s)")
    parser.add_argument("--output", type=Path, default=Path("results/zhou2018"), help="folder (%(default)s)")
    given = parser.parse_args()
    if (given.p_wave_speed is None) != (given.s_wave_speed is None):
        parser.error("--p-wave-speed and --s-wave-speed go together")
    if given.p_wave_speed is None:
        lame, shear = lame_parameters(given.youngs_modulus, given.poisson_ratio)
        given.p_wave_speed, given.s_wave_speed = np.sqrt(np.array([lame + 2.0 * shear, shear]) / given.density)
    return given


def main() -> None:
    """Solve, write the record, print the peaks."""
    logging.getLogger("skfem").setLevel(logging.ERROR)  # it warns of the memory order of its own joined meshes
    given = _arguments()
    problem = Problem(given.density, given.p_wave_speed, given.s_wave_speed, given.level, given.duration, refinement=1)
    histories = solve(problem, tunnel_mesh(problem), MONITORS)
    histories |= solve(problem, column_mesh(problem), FREE_FIELD, steps=len(histories["P1"].time) - 1)
    folder = given.output / given.name
    folder.mkdir(parents=True, exist_ok=True)
    write_record(folder / "run.h5", given.name, histories)
    for name, history in histories.items():
        peak = int(np.argmax(np.abs(history.velocity[:, 0])))
        print(f"{name:12s} peak {history.velocity[peak, 0]:.4f} m/s at {history.time[peak]:.3f} s")
    if given.check:
        check(problem, histories)
    print(f"{given.name}: histories in {folder}")


if __name__ == "__main__":
    main()
