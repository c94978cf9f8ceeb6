"""Waves from below in level layers, on disks beside the continuum: delays add up with every echo between joints.

Disks delay waves of a layer as plane waves on their lattice, and the mass of a free surface ends beside its plane
(disks/entry.py). Both columns have a motion at any height by reflection coefficients (exact/column.py); the error of a
recorded motion is that motion times one less the ratio of both.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

import numpy as np

from dembound.accuracy.delays import Delay, going_on
from dembound.boundaries import Motion
from dembound.disks.entry import mass_begins
from dembound.disks.material.layered import LayeredGround
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.scene import DiskScene
from dembound.exact.column import Column, Layer
from dembound.exact.histories import DECAY, PADDED

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
    return [
        Layer(
            min(high, surface) - low,
            ground.density,
            speed,
            relative=(relative or _damped)(ground),
            heavier=_dragged(ground),
        )
        for low, high, ground in reversed(zones)
        for speed in [ground.wave_speeds(1)[0 if motion == "p" else 1]]
    ]


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
