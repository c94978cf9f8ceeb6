"""Loss of a plane wave at sides along it that do not move as ground beyond them would, without a run.

Ground that goes on beyond a side moves with the wave; dashpots, springs and walls hold the side back instead, and a
free one lacks its traction. With u the motion of the undisturbed ground, which depends only on the coordinate along the
wave, and t(u) the traction of the ground beyond on the side, the error e by a side with dashpots C and springs K
obeys the equations of the body, into which no wave enters, under the force −C ė − K e − (C u̇ + K u + t(u)) per length
of the side. Where a wall holds a component, e = −u.

Ground and error are computed on a coarse grid of linear and bilinear elements of the homogenised packing, with central
differences. Holes are left out. Components and axes are 0 across the wave and 1 along it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from dembound.boundaries import SIDES, Motion, is_far, normal_axis
from dembound.disks.matching import Held
from dembound.disks.scene import DiskScene
from dembound.disks.sides import ground_at, ground_beside, layers_beside
from dembound.disks.surroundings.frequencies import mean_frequency

if TYPE_CHECKING:
    from scipy.sparse import csr_matrix

PER_WAVELENGTH = 30.0
"""Elements in a wave of the mean frequency at the slowest speed."""

FEWEST, MOST = 12, 100
"""Smallest and largest number of elements along an axis."""

SAFETY = 0.9
"""Time step over the largest stable one."""

ALONG, BESIDE = [2, 1], [0, 3]
"""The gradients of both components along the wave, and those whose stresses act on planes along it; see GRADIENTS."""


class End(NamedTuple):
    """Supports of a side: dashpots (2,) N·s/m² and springs (2,) N/m² per length, and which components (2,) move."""

    damping: np.ndarray
    stiffness: np.ndarray
    moves: np.ndarray


@dataclass(frozen=True)
class Grid:
    """The body of a scene as a grid of elements.

    Attributes
    ----------
    axis : of the wave in the scene. origin, size : (2,) m. cells : (2,) numbers of elements. density : (r,) kg/m³ and
    tensor : (r, 4, 4) Pa, see `homogenise.GRADIENTS`, of rows of elements along the wave. free : (2,) components that
    are not held. ends : supports of each side.
    """

    axis: int
    origin: np.ndarray
    size: np.ndarray
    cells: np.ndarray
    density: np.ndarray
    tensor: np.ndarray
    free: np.ndarray
    ends: Mapping[str, End]

    @classmethod
    def of(cls, scene: DiskScene, axis: int, beside: str = "left") -> Grid:
        """The coarse grid of a scene for a wave along an axis; beside : the side whose layers it has if unlike."""
        order, gradients = ([0, 1], [0, 1, 2, 3]) if axis == 1 else ([1, 0], [1, 0, 3, 2])
        ground, box = ground_beside(scene, beside), np.array(scene.case.packing.box)
        size = (box[2:] - box[:2])[order]
        frequency, speeds = mean_frequency(scene.case), np.array(ground.wave_speeds(axis))
        known = math.isfinite(frequency) and (speeds > 0.0).any()
        requested = size * PER_WAVELENGTH * frequency / speeds[speeds > 0.0].min() if known else np.full(2, MOST / 2)
        cells = np.clip(np.ceil(requested), FEWEST, MOST).astype(int)
        free = np.array([component not in ground.held for component in order])
        nodes = box[1] + (box[3] - box[1]) * np.arange(cells[1] + 1) / cells[1]
        ends = {side: _end(scene, side, order, free, nodes) for side in SIDES}
        height = box[axis] + size[1] / cells[1] * (np.arange(cells[1]) + 0.5)
        rows = [ground.at(y) if axis == 1 else ground for y in height.tolist()]
        tensor = np.stack([row.material_tensor[np.ix_(gradients, gradients)] for row in rows])
        return cls(axis, box[:2][order], size, cells, np.array([row.density for row in rows]), tensor, free, ends)

    @property
    def spacing(self) -> np.ndarray:
        """Sides (2,) m of the elements."""
        return self.size / self.cells

    @property
    def nodes(self) -> int:
        """Number of nodes, row after row across the wave."""
        return int(np.prod(self.cells + 1))

    def row(self, side: str) -> np.ndarray:
        """The nodes of a side."""
        numbers = np.arange(self.nodes).reshape(self.cells[1] + 1, self.cells[0] + 1)
        last = -1 if is_far(side) else 0
        return numbers[last] if normal_axis(side) == self.axis else numbers[:, last]

    def weights(self, side: str) -> np.ndarray:
        """Length (m) of a side that belongs to each of its nodes, (k, 1)."""
        spacing = self.spacing[0 if normal_axis(side) == self.axis else 1]
        weights = np.full((len(self.row(side)), 1), spacing)
        weights[[0, -1]] *= 0.5
        return weights

    def around(self, positions: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Nodes (m, 4) round places (m, 2) m of the scene, their weights (m, 4), and heights (m,) in elements."""
        places = (positions[:, [0, 1] if self.axis == 1 else [1, 0]] - self.origin) / self.spacing
        places = np.clip(places, 0.0, self.cells)
        first = np.minimum(places.astype(int), self.cells - 1)
        (x, y), row = (places - first).T, self.cells[0] + 1
        nodes = (first @ [1, row])[:, None] + np.array([0, 1, row, row + 1])
        weights = np.stack([(1.0 - x) * (1.0 - y), x * (1.0 - y), (1.0 - x) * y, x * y], axis=1)
        return nodes, weights, places[:, 1]

    @property
    def time_step(self) -> float:
        """A stable step (s): the eigenvalue of one element bounds those of all; springs at sides are added."""
        largest = np.array([np.linalg.eigvalsh(element)[-1] for element in _elements(self)])
        mass = 0.25 * self.density * float(np.prod(self.spacing))
        springs = max(float(end.stiffness.max()) for end in self.ends.values())
        squares = largest / mass + 4.0 * springs / (self.density * float(self.spacing.min()))
        return SAFETY * 2.0 / math.sqrt(squares.max())


def _end(scene: DiskScene, side: str, order: list[int], free: np.ndarray, heights: np.ndarray) -> End:
    """The supports of a side, or the dashpots of the ground beyond; order : of the scene's axes.

    heights : (k,) m, of the nodes along upright sides in layers, in which dashpots and springs are (k, 2).
    """
    table, axis, none = scene.case.side(side), normal_axis(side), np.zeros(2)
    if table.is_outside:
        p, s = np.nan_to_num(ground_at(scene, side).wave_speeds(axis)) * ground_at(scene, side).density
        return End(np.array([p, s] if axis == order[0] else [s, p]), none, free)
    if table.is_mirror:
        return End(none, none, free & (np.array(order) != axis))
    if side not in scene.edges:
        return End(none, none, free)
    moves = free & ~np.isin(order, table.prescribed(axis))
    layers = layers_beside(scene, side)
    if len(layers) == 1:
        held = Held.of(scene, side)
        return End(held.damping[order], held.stiffness[order], moves)
    by_layer = [Held.of(scene, side, part) for part in range(len(layers))]
    layer = ground_beside(scene, side).layer_of(np.column_stack([np.zeros_like(heights), heights]))
    beside = np.searchsorted(-np.array(layers), -layer).clip(max=len(layers) - 1)
    damping, stiffness = (np.stack(values)[beside][:, order] for values in zip(*by_layer, strict=True))
    return End(damping, stiffness, moves)


def _elements(grid: Grid) -> np.ndarray:
    """Stiffness matrices (r, 8, 8) N/m of the elements of each row."""
    return np.stack([_element(tensor, grid.spacing) for tensor in grid.tensor])


def _element(tensor: np.ndarray, spacing: np.ndarray) -> np.ndarray:
    """Stiffness matrix (8, 8) N/m of a bilinear element; nodes in the order (0, 0), (1, 0), (0, 1), (1, 1)."""
    found, points = np.zeros((8, 8)), 0.5 + np.array([-0.5, 0.5]) / math.sqrt(3.0)
    for x in points:
        for y in points:
            slopes = np.array([[y - 1.0, 1.0 - y, -y, y], [x - 1.0, -x, 1.0 - x, x]]) / spacing[:, None]
            gradients = np.zeros((4, 8))
            gradients[0, 0::2], gradients[1, 1::2], gradients[2, 0::2], gradients[3, 1::2] = slopes[[0, 1, 1, 0]]
            found += 0.25 * float(np.prod(spacing)) * gradients.T @ tensor @ gradients
    return found


def stiffness_of(grid: Grid) -> csr_matrix:
    """Stiffness matrix of all elements, of both components of every node beside each other."""
    from scipy.sparse import coo_matrix

    elements, (across, along) = _elements(grid), grid.cells
    first = (np.arange(along)[:, None] * (across + 1) + np.arange(across)).reshape(-1, 1)
    nodes = first + np.array([0, 1, across + 1, across + 2])
    dofs = (2 * nodes[:, :, None] + np.arange(2)).reshape(-1, 8)
    rows, columns = np.repeat(dofs, 8, axis=1).ravel(), np.tile(dofs, 8).ravel()
    values = np.repeat(elements, across, axis=0).ravel()
    return coo_matrix((values, (rows, columns)), shape=(2 * grid.nodes, 2 * grid.nodes)).tocsr()


class Ground(NamedTuple):
    """The undisturbed ground: displacements (n, k, 2) m of rows at steps, velocities (n, k, 2) half a step later."""

    u: np.ndarray
    v: np.ndarray


def undisturbed(grid: Grid, driven: str, incoming: np.ndarray, shifts: np.ndarray, step: float) -> Ground:
    """The ground under a wave that enters through a side; incoming, shifts : its motion (n, 2) m/s and m at steps.

    A side that prescribes a component moves with the wave in this component.
    """
    low, high = ("left", "right") if grid.axis == 0 else ("bottom", "top")
    count, height = grid.cells[1] + 1, grid.spacing[1]
    mass, damping, springs = np.zeros((count, 1)), np.zeros((count, 2)), np.zeros((count, 2))
    mass[:-1, 0] += 0.5 * height * grid.density
    mass[1:, 0] += 0.5 * height * grid.density
    moves = np.tile(grid.free, (count, 1))
    for side, row in ((low, 0), (high, -1)):
        damping[row], springs[row], moves[row] = grid.ends[side]
    at, moduli = (0 if driven == low else -1), grid.tensor[:, ALONG][:, :, ALONG] / height
    enters = 2.0 * damping[at] * incoming + springs[at] * shifts
    taken, kept = mass / step + 0.5 * damping, mass / step - 0.5 * damping
    u, v = np.zeros((len(incoming), count, 2)), np.zeros((len(incoming), count, 2))
    now, speed = np.zeros((count, 2)), np.zeros((count, 2))
    for n in range(len(incoming)):
        stress = (moduli @ np.diff(now, axis=0)[:, :, None])[:, :, 0]
        force = -springs * now
        force[:-1] += stress
        force[1:] -= stress
        force[at] += enters[n]
        speed = np.where(moves, (kept * speed + force) / taken, 0.0)
        speed[at] = np.where(moves[at], speed[at], grid.free * incoming[n])
        u[n], v[n] = now, speed
        now = now + step * speed
    return Ground(u, v)


WORK = 2e7
"""Largest number of nodes times steps; of longer runs only the beginning is computed, from the wave's start on."""

REACHED = 1e-3
"""Motion of a place over the incoming wave's, both RMS, from which on the wave has reached it."""


def error_beside(
    grid: Grid, sides: Sequence[str], ground: Ground, nodes: np.ndarray, weights: np.ndarray, step: float
) -> np.ndarray:
    """Velocities (n, m, 2) that sides along the wave add to those of the undisturbed ground.

    nodes, weights : (m, 4) of the places, see `Grid.around`.
    """
    matrix, shape = stiffness_of(grid), (grid.nodes, 2)
    mass, damping, springs = np.zeros((grid.nodes, 1)), np.zeros(shape), np.zeros(shape)
    moves = np.tile(grid.free, (grid.nodes, 1))
    numbers = np.arange(grid.nodes).reshape(grid.cells[1] + 1, -1)
    for corner in (numbers[:-1, :-1], numbers[:-1, 1:], numbers[1:, :-1], numbers[1:, 1:]):
        mass[corner] += 0.25 * grid.density[:, None, None] * float(np.prod(grid.spacing))
    for side, end in grid.ends.items():
        row = grid.row(side)
        damping[row] += end.damping * grid.weights(side)
        springs[row] += end.stiffness * grid.weights(side)
        moves[row] &= end.moves
    walls = [(grid.row(side), grid.free & ~grid.ends[side].moves) for side in sides]
    taken, kept = mass / step + 0.5 * damping, mass / step - 0.5 * damping
    loads, weights = _loads(grid, sides, ground), weights[:, :, None]
    found = np.zeros((len(ground.u), len(nodes), 2))
    now, speed = np.zeros(shape), np.zeros(shape)
    for n in range(len(found)):
        force = -(matrix @ now.ravel()).reshape(shape) - springs * now
        for side, load in loads.items():
            force[grid.row(side)] += load[n]
        speed = np.where(moves, (kept * speed + force) / taken, 0.0)
        for row, held in walls:
            speed[row] = np.where(held, -ground.v[n], speed[row])
        now += step * speed
        found[n] = np.sum(weights * speed[nodes], axis=1)
    return found


def _loads(grid: Grid, sides: Sequence[str], ground: Ground) -> dict[str, np.ndarray]:
    """The forces −(C u̇ + K u + t(u)) on the nodes of sides along the wave at steps, (n, k, 2) N."""
    half = 0.5 * np.einsum("rij,nrj->nri", grid.tensor[:, BESIDE][:, :, ALONG], np.diff(ground.u, axis=1))
    traction, speed = np.zeros_like(ground.u), ground.v.copy()
    traction[:, :-1] += half
    traction[:, 1:] += half
    speed[1:] += ground.v[:-1]
    found = {}
    for side in sides:
        end, outward = grid.ends[side], 1.0 if is_far(side) else -1.0
        motion = end.damping * 0.5 * speed + end.stiffness * ground.u
        found[side] = -(grid.weights(side) * motion + outward * traction)
    return found


class Taken(NamedTuple):
    """Errors by sides along a wave.

    driven : the side through which it enters. waves : their names. sides : those along it. shares : RMS of the error
    over that of the undisturbed ground's velocity, in the component that moves most, by place in words.
    """

    driven: str
    waves: list[str]
    sides: list[str]
    shares: dict[str, float]


def taken_from_waves(scene: DiskScene) -> Iterator[Taken]:
    """Errors by sides along the waves of driven sides; not by free-field sides, which move with the ground.

    A test to failure has none, as its sides are those of a sample.
    """
    case = scene.case
    if case.run.is_test:
        return
    for driven, waves in case.driving.items():
        if scene.ground.is_layered and normal_axis(driven) == 0:  # along layers no plane wave runs
            continue
        sides = [side for side in SIDES if normal_axis(side) != normal_axis(driven) and _takes(scene, side)]
        for alike in [[side] for side in sides] if case.is_unlike else [sides]:
            if alike and (shares := _shares(scene, driven, waves, alike)):
                yield Taken(driven, list(waves.values()), alike, shares)


def _takes(scene: DiskScene, side: str) -> bool:
    """Whether a side stands in for ground that would move with a wave along it, and does not move with it.

    True also for mirror planes, as the image moves the other way. Sides are free where a case does not give them: for
    upright ones this is regarded as forgotten.
    """
    table = scene.case.side(side)
    if side not in scene.edges or table.needs_column or table.is_outside or table.waves:
        return False
    forgotten = side not in scene.case.boundary and normal_axis(side) == 0
    return table.is_artificial or table.is_mirror or forgotten


def _shares(scene: DiskScene, driven: str, waves: Mapping[Motion, str], sides: Sequence[str]) -> dict[str, float]:
    """The shares at the monitors that the wave reaches, without monitors in the middle of the body."""
    case, grid = scene.case, Grid.of(scene, normal_axis(driven), sides[0])
    left, bottom, right, top = case.packing.box
    places = {f"monitor {monitor.name}": np.array(scene.monitored[monitor.name]) for monitor in case.monitor}
    places = places or {"the middle": 0.5 * np.array([left + right, bottom + top])}
    chosen = {motion: case.wave[name] for motion, name in waves.items()}
    start, step = min(wave.start for wave in chosen.values()), grid.time_step
    steps = math.ceil(min((case.run.duration - start) / step, WORK / grid.nodes))
    times, incoming, shifts = start + step * np.arange(max(steps, 0)), *np.zeros((2, max(steps, 0), 2))
    for motion, wave in chosen.items():
        component = 1 if motion == "p" else 0
        incoming[:, component], shifts[:, component] = wave.velocity(times), wave.displacement(times)
    ground = undisturbed(grid, driven, incoming, shifts, step)
    nodes, weights, heights = grid.around(np.array(list(places.values())))
    error, found = error_beside(grid, sides, ground, nodes, weights, step), {}
    for number, (name, height) in enumerate(zip(places, heights, strict=True)):
        low = min(int(height), int(grid.cells[1]) - 1)
        moved = ground.v[:, low] + (height - low) * (ground.v[:, low + 1] - ground.v[:, low])
        whole = np.sum(moved**2, axis=0)
        if whole.max() > REACHED**2 * np.sum(incoming**2):
            most = int(np.argmax(whole))
            found[name] = math.sqrt(float(np.sum(error[:, number, most] ** 2)) / float(whole[most]))
    return found
