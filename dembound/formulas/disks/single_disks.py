"""Errors of single disks that move otherwise than the ground: at edges, and near a free surface under oblique waves."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from dembound.boundaries import normal_axis
from dembound.disks.scene import DiskScene
from dembound.formulas.cause import Cause
from dembound.formulas.history import Motions

SINGLE, SINGLE_FACTOR = 1.0, 3.0
"""How far single disks at the free surface of a random packing move otherwise than the ground, over the diameter and
the strain along the surface.

Measured 0.5 to 2.3, RMS over the disks of each of 9 packings (B, bricks of 10 and 20 diameters; SV and P waves at 20 to
40°, 40 to 160 diameters long), 0.4 to 1.4 at a depth of 1.5 diameters; in layers up to 3.1. Of 144 disks 5 % are
beyond three times the size.
"""

NEAR_SURFACE = 2.0
"""Depth in diameters down to which they do so."""


def causes_at_edges(scene: DiskScene, motions: Motions) -> Iterator[Cause]:
    """Unknown errors of monitors at absorbing sides of random packings, or at uneven sides."""
    case = scene.case
    packing, box = case.packing, case.packing.box
    reach = 2.0 * scene.ground.brick.mean_diameter
    edges = {side: box[k] for k, side in enumerate(("left", "bottom", "right", "top"))}
    at = [
        name
        for name, own in motions.items()
        for side, table in case.boundary.items()
        if not (packing.is_lattice and side in packing.regular_sides)
        and table.factors
        and abs(own.place[normal_axis(side)] - edges[side]) < reach
    ]
    if at:
        names = " and ".join(dict.fromkeys(at))
        edge = "an uneven edge" if packing.is_lattice else "the edge of a random packing"
        yield Cause.unknown("edge", f"how single disks at {edge} move otherwise than those around, at {names}", True)


def causes_at_surface(scene: DiskScene, motions: Motions) -> Iterator[Cause]:
    """Single disks near the free surface of a random packing, which a wave at an angle strains along it."""
    case, ground = scene.case, scene.ground
    if not (case.incident and case.incident.angle) or case.packing.is_lattice or not case.side("top").is_free:
        return
    angle, below = math.radians(abs(case.incident.angle)), ground.at(case.box[1])
    slowness = math.sin(angle) / below.wave_speeds(1)[0 if case.incident.type == "p" else 1]
    size = SINGLE * slowness * ground.brick.mean_diameter
    near = case.box[3] - NEAR_SURFACE * ground.brick.mean_diameter
    parts = {
        name: {
            "velocity": size * np.gradient(own.velocity, own.time, axis=0),
            "displacement": size * own.velocity,
        }
        for name, own in motions.items()
        if own.place[1] > near
    }
    if parts:
        words = "by the strain along it and the diameter, the size for single disks of several packings"
        yield Cause("surface", words, parts, of_disks=True, factor=SINGLE_FACTOR, is_sample=True)
