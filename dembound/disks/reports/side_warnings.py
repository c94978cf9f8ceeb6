"""Warnings about sides that represent the ground beyond them poorly."""

import math
from collections.abc import Iterator

from dembound.boundaries import Motion, normal_axis
from dembound.boundaries.words import TOO_MUCH, poor_factor, reflected
from dembound.disks.beyond.frequencies import mean_frequency
from dembound.disks.matching import Held, factors_in, homogenised_beta, sent_back
from dembound.disks.material.mirrored import continues
from dembound.disks.reports.beside_wave import taken_from_waves
from dembound.disks.scene import DiskScene


def side_warnings(scene: DiskScene) -> Iterator[str]:
    """Warnings about sides, one line each."""
    yield from _send_back(scene)
    yield from _take_from_waves(scene)
    yield from _hold_monitors(scene)
    yield from _mirror_otherwise(scene)


TAKEN = 0.1
"""Error, over a wave's velocity, by sides along it up to which there is no warning; known to within that."""


def _send_back(scene: DiskScene) -> Iterator[str]:
    """Warnings about dashpots and springs that reflect much of plane waves along the side's normal."""
    tables = {side: scene.case.side(side) for side in scene.edges}
    sides = [side for side, table in tables.items() if table.factors and not table.is_interface]
    frequency = mean_frequency(scene.case) if sides else math.nan
    for side in sides:
        for motion, beta in factors_in(scene, side).items():
            share = sent_back(scene, side, motion, frequency)
            if share > TOO_MUCH:  # nan where the motion is held
                yield f"boundary.{side}: {_reason(scene, side, motion, beta, share, frequency)}"


def _reason(scene: DiskScene, side: str, motion: Motion, beta: float, share: float, frequency: float) -> str:
    """The reflection of a side, and its cause: its factor, or else its springs or disks."""
    matched = homogenised_beta(scene, side, motion)
    if abs(reflected(beta, matched)) > TOO_MUCH:
        return poor_factor(motion, share, beta, matched, scene.case.side(side).waves.get(motion))
    springs = Held.of(scene, side).stiffness.any()
    why = (
        'as its springs hold; take springs of a larger distance, or "outside"'
        if springs
        else "as its disks are whole cells, large beside such waves; take smaller ones, or half_mass on regular sides"
    )
    return (
        f"sends back {100.0 * share:.0f} % of the amplitude of {motion.upper()} waves along its normal at their mean "
        f"frequency, {frequency:.3g} Hz, {why}"
    )


def _take_from_waves(scene: DiskScene) -> Iterator[str]:
    """Warnings about sides along the wave of a driven side that do not move as ground beyond them would."""
    for found in taken_from_waves(scene):
        place, most = max(found.shares.items(), key=lambda each: each[1])
        if most <= TAKEN:
            continue
        least = f", {100.0 * min(found.shares.values()):.0f} % where least" if len(found.shares) > 1 else ""
        sides = " and ".join(f"boundary.{side}" for side in found.sides)
        upright = normal_axis(found.driven) == 1
        cure = f'"free_field", or "outside" there and at {found.driven}' if upright else '"periodic"'
        yield (
            f"{sides}: along wave {' and '.join(found.waves)} from {found.driven} no side moves as ground beyond it "
            f"would; at {place} about {100.0 * most:.0f} % of the velocity is wrong{least} (RMS); take {cure}"
        )


def _hold_monitors(scene: DiskScene) -> Iterator[str]:
    """Warnings about sides that hold the disk of a monitor, so that it records no motion."""
    for side, edge in scene.edges.items():
        table = scene.case.side(side)
        if table.waves or not {0, 1} <= {*table.prescribed(edge.axis), *scene.ground.held}:
            continue
        for name, particle in scene.monitors.items():
            if particle in edge.nodes:
                yield f"monitor.{name}: its disk is on boundary.{side}, which holds it still: its motion is zero"


def _mirror_otherwise(scene: DiskScene) -> Iterator[str]:
    """Warnings about planes of symmetry across which a lattice does not continue as its own mirror image."""
    packing, brick = scene.case.packing, scene.ground.brick
    for side, edge in scene.edges.items():
        mirrored = scene.case.side(side).is_mirror and packing.is_lattice
        if mirrored and not continues(brick, edge.axis, edge.diameters):
            yield (
                f"boundary.{side}: the disks of pattern {packing.pattern} have no neighbours straight across this side "
                "and touch their mirror images: near there the body is not half of a larger one of this lattice"
            )
