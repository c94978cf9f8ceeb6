"""An oblique plane wave in words: its speed along the surface, its reflections, and where monitors err."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from dembound.continuum.medium import GRAZING, ElasticPlaneWave, critical_angle
from dembound.disks.scene import DiskScene
from dembound.disks.surroundings.continuum import Surroundings
from dembound.disks.surroundings.ground_waves import GroundWaves, reference_point
from dembound.disks.surroundings.layered_waves import LayeredWaves, Undisturbed, critical_in_layers
from dembound.disks.surroundings.oblique_layers import ObliqueLayers
from dembound.words import Entries

NAMES = {"sv": "SV", "p": "P"}

STRAIGHT = 1e-9
"""Degrees from the vertical up to which a wave runs straight up."""


def incident_facts(scene: DiskScene) -> Entries:
    """Facts about the oblique wave of a scene that has one."""
    waves, table, outside = scene.ground_waves, scene.case.incident, scene.outside
    assert waves is not None
    assert table is not None
    assert outside is not None
    x, y = reference_point(scene.case)
    along = ""
    if not isinstance(waves, LayeredWaves):
        along = _along((waves.layers[-1] if isinstance(waves, ObliqueLayers) else waves).waves[0], outside)
    yield (
        "incident wave",
        f"{NAMES[table.type]}, {_way(table.angle)}, with the velocity of wave {table.wave} at "
        f"({x:.10g}, {y:.10g}) m{along}; reaches the disks at {arrival(scene, waves):.4g} s",
    )
    surface = " and by the surface" * (outside.free_surface is not None)
    if isinstance(waves, LayeredWaves):
        yield "reflected waves", f"by the layers{surface}, from the column of layers at each frequency"
        return
    if isinstance(waves, ObliqueLayers):
        critical, name = critical_in_layers(scene.case, [layer.medium for layer in waves.layers])
        below = "no critical angle" if abs(critical) == GRAZING else f"critical from {abs(critical):.4g}° on, by {name}"
        yield "reflected waves", f"by the layers{surface}, from P and SV waves of each layer at each frequency; {below}"
        return
    if outside.free_surface is None:
        yield "reflected waves", "none, as the ground has no surface"
        return
    critical = critical_angle(waves.medium, table.type, math.copysign(1.0, table.angle))
    below = "no critical angle" if critical == GRAZING else f"critical from {critical:.4g}° on"
    yield "reflected waves", f"{'; '.join(_reflected(waves))}; {below}"
    if corners := _corners(scene):
        yield "less exact monitors", f"near the corners where layers begin: {', '.join(corners)} m"


def _way(angle: float) -> str:
    """The direction of a wave."""
    if abs(angle) < STRAIGHT:
        return "straight up"
    return f"{abs(angle):g}° from the vertical to the {'right' if angle > 0.0 else 'left'}"


def _along(wave: ElasticPlaneWave, outside: Surroundings) -> str:
    """The speed of the wave's trace along the surface, or along x where there is none."""
    slowness, where = abs(wave.slowness[0]), "x" if outside.free_surface is None else "the surface"
    return f", at {1.0 / slowness:.5g} m/s along {where}" if slowness > STRAIGHT * abs(wave.slowness[1]) else ""


def arrival(scene: DiskScene, waves: Undisturbed) -> float:
    """Time (s) at which the wave reaches the first of the disks."""
    assert scene.case.incident is not None
    return scene.case.wave[scene.case.incident.wave].start + waves.arrives(scene.assembly.positions)


def _reflected(waves: GroundWaves) -> Iterator[str]:
    """Kind, angle and amplitude of the waves reflected by the surface, the slower one first."""
    each: dict[tuple[float, float], np.ndarray] = {}
    for wave in waves.waves[1:]:
        each[wave.slowness] = each.get(wave.slowness, np.zeros(2)) + wave.motion
    for slowness, motion in each.items():
        is_along = abs(motion @ slowness) > np.hypot(*motion) * np.hypot(*slowness) * math.sqrt(0.5)
        angle = math.degrees(math.atan2(slowness[0], -slowness[1]))
        yield f"{'P' if is_along else 'SV'} at {abs(angle):.4g}° with {np.hypot(*motion):.3g} of the amplitude"


def _corners(scene: DiskScene) -> list[str]:
    """Corners (m) of the region within the layers, at which two layers begin."""
    assert scene.outside is not None
    mesh = scene.outside.body.mesh
    (left, bottom), (right, top) = mesh.between_layers
    each = [(x, y) for y, there in ((bottom, mesh.layer.bottom), (top, mesh.layer.top)) if there for x in (left, right)]
    return [f"({x:.4g}, {y:.4g})" for x, y in each]
