"""Loss of a plane wave at sides along it that do not move as ground beyond them would, without a run.

Ground that goes on beyond a side moves with the wave; dashpots, springs and walls hold the side back instead, and a
free one lacks its traction. With u the motion of the undisturbed ground, which depends only on the coordinate along the
wave, and t(u) the traction of the ground beyond on the side, the error e by a side with dashpots C and springs K
obeys the equations of the body, into which no wave enters, under the force −C ė − K e − (C u̇ + K u + t(u)) per length
of the side. Where a wall holds a component, e = −u.

Ground and error are computed on a coarse grid (coarse_grid.py).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from dembound.boundaries import SIDES, Motion, is_far, normal_axis
from dembound.disks.scene import DiskScene
from dembound.formulas.disks.coarse_grid import ALONG, BESIDE, Grid, Ground, stiffness_of, undisturbed

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
    mass, damping, springs, moves = (
        np.zeros((grid.nodes, 1)),
        np.zeros(shape),
        np.zeros(shape),
        np.tile(grid.free, (grid.nodes, 1)),
    )
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
        if sides and (shares := _shares(scene, driven, waves, sides)):
            yield Taken(driven, list(waves.values()), sides, shares)


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
    case, grid = scene.case, Grid.of(scene, normal_axis(driven))
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
