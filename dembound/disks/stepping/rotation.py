"""The rigid rotation of a body, for which the law of small displacements is only a linear approximation."""

from __future__ import annotations

import numpy as np

from dembound.disks.body import DiskBody


def turns_freely(scene: DiskBody) -> bool:
    """Whether only dashpots resist the rigid rotation of a body."""
    held = scene.supports.prescribed.any() or scene.supports.stiffness.any()
    periodic = any(table.is_periodic for table in scene.case.boundary.values())
    return bool(scene.free.all()) and scene.seam is None and not held and not periodic


def turned_as_a_whole(
    scene: DiskBody, displacement: np.ndarray, velocity: np.ndarray, datum: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Displacements and velocities (3, n) of a body rotated exactly, from those of linearised rotation.

    Under the law of small displacements a body that rotates by θ moves from r to r + θ ẑ × r + w, which stretches it by
    ½θ². The exact motion is from r to R(θ)(r + w). datum : (3, n) displacements at the start.
    """
    mass = scene.mass
    displacement, velocity = displacement.copy(), velocity.copy()
    arm = scene.assembly.positions.T + datum[:2]
    arm = arm - np.average(arm, axis=1, weights=mass)[:, None]
    moved = displacement[:2] - datum[:2]
    centre = np.average(moved, axis=1, weights=mass)[:, None]
    spin = np.sum(mass * (arm[0] * moved[1] - arm[1] * moved[0])) + np.sum(scene.inertia * (displacement - datum)[2])
    angle = spin / (np.sum(mass * (arm**2).sum(axis=0)) + scene.inertia.sum())
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    stretched = moved - centre - angle * np.stack([-arm[1], arm[0]])
    displacement[:2] = datum[:2] + centre + turn @ (arm + stretched) - arm
    mean = np.average(velocity[:2], axis=1, weights=mass)[:, None]
    velocity[:2] = mean + turn @ (velocity[:2] - mean)
    return displacement, velocity
