"""Scenes of which only a part has to be stepped, since the rest moves in the same way.

The rows of a scene move identically if two conditions hold. From rest, with identical rows, everything that acts from
outside accelerates all rows equally; and a motion that is the same in all rows leads to accelerations that are the
same in all rows. Both are linear in drives, velocities and displacements, and are checked on the assembled scene: a
random motion of one row, repeated in all of them, must cause the accelerations that the row alone has. An error of any
contact or support would change them, as no motion of random numbers is orthogonal to it.

Only components that move count. They are found in the same way: those that are driven, and those on which motions of
these exert forces. In the others there is exactly no motion. So a bar of a square lattice with free long sides has
identical rows under P waves, which exert no force across or moment, but not under S waves.
"""

from collections.abc import Iterator

import numpy as np

from dembound.disks.contacts import plain_contacts
from dembound.disks.one_row import OneRow, one_row
from dembound.disks.scene import DiskScene
from dembound.disks.stability import fill_forces
from dembound.disks.stress import particle_stress
from dembound.motion.layout import aligned_zeros

ROUNDING = 1e-12
"""Difference of two rows over the largest value in the scene that is due to rounding.

A force is a sum of some fifty products, each rounded by 1e-16, whose terms exceed it by a factor of ten or so; a single
contact or support that differs changes it by more than a hundredth.
"""


def reduced(scene: DiskScene) -> DiskScene:
    """One of the rows of a scene if all move identically, otherwise the scene itself.

    Only under the elastic law, without a static stage, and without a free-field column.
    """
    if not scene.case.reduce.rows or scene.has_history or scene.case.static is not None or scene.seam is not None:
        return scene
    copies = scene.assembly.copies
    for axis in np.argsort(copies, kind="stable").tolist():
        if copies[axis] > 1 and (row := one_row(scene, axis)) is not None and represents_all(row):
            return row
    return scene


def represents_all(row: OneRow) -> bool:
    """Whether all rows of the whole scene move as this one, in displacements, energies and, if needed, stresses."""
    if not _are_driven_alike(row, _driven(row.of)):  # most scenes are refused here, at little cost
        return False
    moves, (of_whole, of_row) = _motions(row)
    return (
        _are_alike(row, of_whole[moves], of_row[moves])
        and _are_driven_alike(row, moves)
        and np.ptp(np.bincount(row.like, row.of.mass) / row.mass) <= ROUNDING * row.weight
        and (not row.case.output.stress or _are_alike(row, *_stresses(row, moves)))
    )


def _are_driven_alike(row: OneRow, components: np.ndarray) -> bool:
    """Whether everything from outside acts on components (3,) bool of all rows as on those of this one."""
    pairs = zip(_from_outside(row.of), _from_outside(row), strict=True)
    return all(_are_alike(row, of_whole[components], of_row[components]) for of_whole, of_row in pairs)


def _are_alike(row: OneRow, of_whole: np.ndarray, of_row: np.ndarray) -> bool:
    """Whether values (c, n) of the whole scene are those (c, m) of the row in all of its rows."""
    largest = np.abs(of_whole).max(initial=0.0)
    return bool((np.abs(of_whole - of_row[:, row.like]) <= ROUNDING * largest).all())


def _motions(row: OneRow) -> tuple[np.ndarray, tuple[np.ndarray, np.ndarray]]:
    """The components that move (3,), and the accelerations by a random motion of these, of the whole and of the row."""
    moves = _driven(row.of)
    while True:
        displacement = _random(row, moves)
        found = _accelerations(row.of, displacement[:, row.like]), _accelerations(row, displacement)
        pushed = moves | np.logical_or(*((acceleration != 0.0).any(axis=1) for acceleration in found))
        if (pushed == moves).all():
            return moves, found
        moves = pushed


def _random(row: OneRow, moves: np.ndarray) -> np.ndarray:
    """Random displacements (3, m) in the components that move, of surfaces for rotations: m and rad."""
    displacement = np.random.default_rng(0).standard_normal((3, row.count)) * moves[:, None]
    displacement[2] /= row.assembly.radii
    return displacement


def _driven(scene: DiskScene) -> np.ndarray:
    """The components (3,) that sides or loads drive."""
    supports = scene.supports
    by_sides = supports.component[supports.drive_row[supports.drive != 0.0]]
    return (scene.steady_load.any(axis=1) | np.isin(np.arange(3), by_sides)) & (scene.free > 0.0)


def _accelerations(scene: DiskScene, displacement: np.ndarray) -> np.ndarray:
    """Accelerations (3, n), of surfaces for rotations, by contacts and springs at displacements (3, n)."""
    u = scene.layout.spread(displacement)
    force = aligned_zeros(*u.shape)
    fill_forces(scene, u, force)
    acceleration = scene.free[:, None] * scene.layout.gather(force) / _inertia(scene)
    acceleration[2] *= scene.assembly.radii
    return acceleration


def _inertia(scene: DiskScene) -> np.ndarray:
    """(3, n) kg and kg·m²."""
    return np.stack([scene.mass, scene.mass, scene.inertia])


def _from_outside(scene: DiskScene) -> Iterator[np.ndarray]:
    """Everything that acts on each component, (3, n) each, per unit of mass: loads, dashpots, drives of each signal.

    Also where velocities are prescribed, and drives that are velocities.
    """
    table, inertia = scene.supports, _inertia(scene)
    yield scene.steady_load / inertia

    def of_all(rows: np.ndarray | slice, values: np.ndarray) -> np.ndarray:
        spread = np.zeros((3, scene.count))
        spread[table.component[rows], table.node[rows]] = values
        return spread

    every, mass = slice(None), inertia[table.component, table.node]
    yield of_all(every, table.prescribed)
    yield of_all(every, table.damping / mass)
    drive = table.drive / np.where(table.prescribed, 1.0, mass)[table.drive_row]
    for signal in range(len(table.signals)):
        chosen = table.drive_signal == signal
        yield of_all(table.drive_row[chosen], drive[chosen])


def _stresses(row: OneRow, moves: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Stresses (3, n) and (3, m) by a random motion, of the whole and of the row."""
    displacement = _random(row, moves)
    both = (row.of, displacement[:, row.like]), (row, displacement)
    of_whole, of_row = (
        particle_stress(scene, plain_contacts(scene.ground, scene.assembly, scene.layout.slot), u, elastic=True).T
        for scene, u in both
    )
    return of_whole, of_row
