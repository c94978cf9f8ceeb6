"""Delay of plane waves on the disks of a packing, and of waves from below in level layers."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache, partial

import numpy as np

from dembound.boundaries.edge import Motion
from dembound.disks.material.layered import LayeredGround
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.material.packing_waves import plane_wave_frequencies
from dembound.disks.scene import DiskScene
from dembound.exact.column import Column, Layer
from dembound.exact.transform import DECAY, PADDED
from dembound.formulas.disks.entry import mass_begins
from dembound.formulas.history import Delay, going_on
from dembound.packings.square import Square

LONG, SHORT, PHASES = 1e-3, 0.3, 1000
"""Wave numbers, in radians per disk, of long waves and of those by which directions are compared; number of them."""

_LENGTHS = np.concatenate([[LONG, SHORT], np.linspace(LONG, math.pi, PHASES)[1:]])

Direction = tuple[float, float]

Frequencies = Callable[[Direction], np.ndarray]
"""Angular frequencies (k, m) rad/s of plane waves in a direction, see `frequencies_of`."""

AXES: Sequence[Direction] = ((1.0, 0.0), (0.0, 1.0))
"""Directions along the axes x and y."""

DIAGONAL: Direction = (math.sqrt(0.5), math.sqrt(0.5))


EQUAL = 1e-9
"""Relative difference of contacts that count as equal."""


def square_lattice(ground: PackedMaterial) -> PackedMaterial:
    """The square lattice of the same material and mean diameter."""
    return replace(ground, brick=Square(bricks=(1, 1), radius=0.5 * ground.brick.mean_diameter).pack(1.0))


def is_square_lattice(ground: PackedMaterial) -> bool:
    """Whether a packing is a square lattice itself: then larger disks of its material make the same ground."""
    own, square = (np.sort(np.abs(each.brick.vectors), axis=0) for each in (ground, square_lattice(ground)))
    return len(ground.brick.radii) == 1 and own.shape == square.shape and np.allclose(own, square, EQUAL, 0.0)


def layers_between(ground: PackedMaterial, heights: Sequence[float]) -> list[tuple[PackedMaterial, float]]:
    """The materials on a way between two heights (m), from the bottom up, each with its share of the way."""
    low, high = min(heights), max(heights)
    if not isinstance(ground, LayeredGround) or ground.at(low) is ground.at(high):
        return [(ground.at(low), 1.0)]
    lengths = [(zone.material, min(high, zone.high) - max(low, zone.low)) for zone in ground.layers]
    return [(material, length / (high - low)) for material, length in lengths if length > 0.0]


def crossing_time(scene: DiskScene, axis: int, motion: Motion) -> float:
    """Time (s) of P or S waves across the ground of a scene along an axis; along x in the slowest layer."""
    low, high = scene.case.box[axis::2]
    parts = layers_between(scene.ground, (low, high)) if axis == 1 else [(scene.ground, 1.0)]
    number = 0 if motion == "p" else 1
    return sum(share * scene.case.size[axis] / material.wave_speeds(axis)[number] for material, share in parts)


def frequencies_of(ground: PackedMaterial) -> Frequencies:
    """Frequencies on the square lattice of a packing's material, found once for each direction."""
    lattice = square_lattice(ground)

    @cache
    def along(direction: Direction) -> np.ndarray:
        return plane_wave_frequencies(lattice, np.array(direction), _LENGTHS)

    return along


def delay_of(
    ground: PackedMaterial,
    motion: Motion,
    directions: Sequence[Direction],
    path: float,
    speed: float,
    step: float,
    frequencies: Frequencies | None = None,
) -> Delay:
    """Delay (s) of waves of given angular frequencies (rad/s) over a path (m), nan above that of the shortest wave.

    directions : unit vectors; the one with the largest delay counts. speed : of long waves, m/s. step : of the
    run, s; 0 for waves that are not stepped in time. frequencies : of this ground, if available.
    """
    along = frequencies or frequencies_of(ground)
    each = [_slowness(along(direction), ground.held, motion, step) for direction in directions]
    frequency, slowness = max(each, key=lambda found: abs(found[1][1] - 1.0))
    frequency, slowness = np.delete(frequency, 1), np.delete(slowness, 1)
    rising = np.concatenate([[True], np.diff(np.maximum.accumulate(frequency)) > 0.0])
    # the packing's own long waves have another speed than the lattice's, and as many disks in a wave
    scale = speed / (frequency[0] / LONG * ground.brick.mean_diameter)

    def delay(omega: np.ndarray) -> np.ndarray:
        found = np.interp(omega, scale * frequency[rising], slowness[rising], right=np.nan)
        return np.asarray(path / speed * (found - 1.0))

    return delay


def _slowness(found: np.ndarray, held: Sequence[int], motion: Motion, step: float) -> tuple[np.ndarray, np.ndarray]:
    """Angular frequencies (k,) rad/s of P or S waves among those found (k, m), and slowness over that of long waves."""
    moving = sum(axis not in held for axis in (0, 1))
    frequency = found[:, 1 if motion == "p" and moving == 2 else 0]
    if step > 0.0:
        sine = 0.5 * step * frequency
        frequency = np.where(sine < 1.0, 2.0 / step * np.arcsin(np.minimum(sine, 1.0)), np.nan)
    slowness = _LENGTHS / frequency
    return frequency, slowness / slowness[0]


Relative = Callable[[np.ndarray], np.ndarray]
"""M/ρc² (k,) at frequencies (k,) Hz."""


def layers_of(
    scene: DiskScene, motion: Motion, relative: Callable[[PackedMaterial], Relative | None] | None = None
) -> list[Layer]:
    """The layers of a layered scene, from the surface down, the last one the half-space below its bottom.

    relative : of a material, its modulus over that of long undamped waves; by default that of the damped ground.
    """
    plane, surface = scene.plane("bottom"), scene.plane("top")
    assert isinstance(scene.ground, LayeredGround)
    zones = [(low, high, ground) for low, high, _, ground in scene.ground.layers if high > plane]
    found = []
    for low, high, ground in reversed(zones):
        thickness, speed = min(high, surface) - low, ground.wave_speeds(1)[0 if motion == "p" else 1]
        modulus, dragged = (relative or _damped)(ground), _dragged(ground)
        found.append(Layer(thickness, ground.density, speed, relative=modulus, heavier=dragged))
    return found


def mass_above(scene: DiskScene) -> float | None:
    """Mass (kg/m²) on the free surface of a scene, negative where disks lack some; None if waves leave there."""
    if scene.case.side("top").factors:
        return None
    return -scene.ground.at(scene.case.box[3]).density * mass_begins(scene, "top")


def errors_in_layers(
    scene: DiskScene, motion: Motion, height: float, delay: Callable[[PackedMaterial], Delay], time: np.ndarray
) -> Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]:
    """Errors that disks add to P or S waves at a height (m) and even times (k,) s, given the velocity (k, c).

    delay : of waves in a material over a way that takes them 1 s. Returns errors of velocity and displacement (k, c);
    frequencies at which no wave runs count as an error of 100 %.
    """
    count, step = len(time), float(time[1] - time[0]) if len(time) > 1 else 1.0
    window = 2 ** math.ceil(math.log2(PADDED * max(count, 2)))
    rate = DECAY / (window * step)
    frequencies = np.fft.rfftfreq(window, step) - 1j * rate / (2.0 * math.pi)
    depth, bottom = (scene.plane("top") - each for each in (height, scene.plane("bottom")))

    def moved(column: Column) -> np.ndarray:
        return np.asarray(column.motion(frequencies, [depth])[0, 0] / column.rising(frequencies, bottom))

    def relative(ground: PackedMaterial) -> Relative:
        return partial(_relative, delay(ground), _damped(ground))

    exact = moved(Column(layers_of(scene, motion), mass=0.0 if mass_above(scene) is not None else None))
    with np.errstate(invalid="ignore"):
        part = 1.0 - exact / moved(Column(layers_of(scene, motion, relative), mass=mass_above(scene)))
    part[~np.isfinite(part)] = 1.0

    def errors(velocity: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        padded = np.concatenate([velocity, going_on(velocity)])
        decay = np.exp(-rate * step * np.arange(len(padded)))[:, None]
        found = np.fft.irfft(np.fft.rfft(padded * decay, window, axis=0) * part[:, None], window, axis=0)
        error = found[:count] / decay[:count]
        return error, step * (np.cumsum(error, axis=0) - 0.5 * (error + error[0]))

    return errors


def _damped(ground: PackedMaterial) -> Relative | None:
    """M/M₀ of damped ground; None for others."""
    return None if ground.mechanisms is None else ground.mechanisms.relative_modulus


def _dragged(ground: PackedMaterial) -> Relative | None:
    """ρ(ω)/ρ of ground with a drag; None for others."""
    return None if ground.mechanisms is None or ground.mechanisms.drag == 0.0 else ground.mechanisms.relative_density


def _relative(delay: Delay, damped: Relative | None, frequencies: np.ndarray) -> np.ndarray:
    """Modulus over that of long undamped waves of a medium whose waves come late by `delay` per second of their way."""
    slowness = 1.0 + delay(2.0 * math.pi * frequencies.real)
    return np.asarray((1.0 if damped is None else damped(frequencies)) * (slowness**-2.0 + 0.0j))
