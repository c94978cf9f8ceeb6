"""Scenes of which one row is stepped, since all others move as it does.

The rows of a scene move identically if two conditions hold. From rest, with identical rows, everything that acts from
outside accelerates all rows equally; and a motion that is the same in all rows leads to accelerations that are the
same in all rows. Both are linear in drives, velocities and displacements, and are checked on the assembled scene: a
random motion of one row, repeated in all of them, must cause the accelerations of the row by itself. An error of any
contact or support would change them, as no motion of random numbers is orthogonal to it.

Only components that move count. They are found in the same way: those that are driven, and those on which motions of
these exert forces. In the others there is exactly no motion. So a bar of a square lattice with free long sides has
identical rows under P waves, which exert no force across or moment, but not under S waves.
"""

from collections.abc import Iterator

import numpy as np

from dembound.disks.contacts.elastic_again import never_elastic_again, settled_refused
from dembound.disks.reduced.one_row import OneRow, one_row
from dembound.disks.scene import DiskScene
from dembound.disks.stability import fill_forces
from dembound.motion.kind import Reduction
from dembound.motion.layout import aligned_zeros

ROUNDING = 1e-12
"""Difference of two rows over the largest value in the scene that is due to rounding.

A force is a sum of some fifty products, each rounded by 1e-16, whose terms exceed it by a factor of ten or so; a single
contact or support that differs changes it by more than a hundredth.
"""

ALL = slice(None)


def reduced(scene: DiskScene) -> Reduction[DiskScene]:
    """One of the rows of a scene if all move identically, otherwise the scene itself.

    With a requested `reduce.settled`, also why the elastic law can never follow on a static stage.
    """
    case = scene.case
    refused = settled_refused(never_elastic_again(case)) if case.reduce.settled else ()
    row = identical_row(scene) if case.reduce.rows else None
    return Reduction(scene if row is None else row, refused)


def identical_row(scene: DiskScene) -> OneRow | None:
    """One of the identical rows of a scene, along the axis with fewer rows if both have some; None if it has none.

    Only under the elastic law, without a load factor (the least of all contacts), a static stage, a free-field column
    and a continuum.
    """
    case = scene.case
    apart = scene.has_history or case.output.load_factor or case.static is not None
    if apart or scene.outside is not None or scene.seam is not None:
        return None
    copies = scene.assembly.copies
    axes = (0,) if scene.ground.is_layered else np.argsort(copies, kind="stable").tolist()
    several = [axis for axis in axes if copies[axis] > 1]
    rows = (one_row(scene, axis) for axis in several)
    return next((row for row in rows if row is not None and moves_as_all(row)), None)


def moves_as_all(row: OneRow) -> bool:
    """Whether all rows of a scene move as this one, in displacements, energies and, if needed, stresses."""
    if not _same_outside(row, _driven(row.of)):  # most scenes are refused here, at little cost
        return False
    moves, (of_whole, of_row) = _motions(row)
    masses = np.bincount(row.like, row.of.mass) / row.mass
    return (
        _are_alike(row, of_whole, of_row, moves)
        and _same_outside(row, moves)
        and bool(np.ptp(masses) <= ROUNDING * masses.max())
        and (not row.case.output.stress or _are_alike(row, *_stresses(row, moves)))
    )


def _same_outside(row: OneRow, components: np.ndarray) -> bool:
    """Whether everything from outside acts equally, in components (3,) bool, on each disk and on its row's disk."""
    pairs = zip(_from_outside(row.of), _from_outside(row), strict=True)
    return all(_are_alike(row, whole, own, components) for whole, own in pairs)


def _are_alike(row: OneRow, of_whole: np.ndarray, of_row: np.ndarray, components: np.ndarray | slice = ALL) -> bool:
    """Whether values (3, n) of the scene equal those (3, m) of the row, in some components (3,) bool."""
    expected = of_row[components][:, row.like]
    largest = np.abs(of_whole[components]).max(initial=0.0)
    return bool((np.abs(of_whole[components] - expected) <= ROUNDING * largest).all())


def _motions(row: OneRow) -> tuple[np.ndarray, tuple[np.ndarray, np.ndarray]]:
    """The components that move (3,), and accelerations by a random motion of these, of the scene and of the row."""
    moves = _driven(row.of)
    while True:
        displacement = _random(row, moves)
        found = _accelerations(row.of, displacement[:, row.like]), _accelerations(row, displacement)
        pushed = moves | np.logical_or(*((acceleration != 0.0).any(axis=1) for acceleration in found))
        if (pushed == moves).all():
            return moves, found
        moves = pushed


def _random(row: OneRow, moves: np.ndarray) -> np.ndarray:
    """Random displacements (3, m), in m and, for rotations, radius × rad, in the components that move."""
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
    """Masses and moments of inertia (3, n) kg and kg·m²."""
    return np.stack([scene.mass, scene.mass, scene.inertia])


def _from_outside(scene: DiskScene) -> Iterator[np.ndarray]:
    """Everything that acts on each component (3, n) from outside, per unit mass: loads, supports, drives by signal.

    Where velocities are prescribed drives are velocities. Equal signals count as one.
    """
    table, inertia = scene.supports, _inertia(scene)
    yield scene.steady_load / inertia

    def of_all(rows: np.ndarray | slice, values: np.ndarray) -> np.ndarray:
        spread = np.zeros((3, scene.count))
        np.add.at(spread, (table.component[rows], table.node[rows]), values)
        return spread

    mass = inertia[table.component, table.node]
    yield of_all(ALL, table.prescribed)
    yield of_all(ALL, table.damping / mass)
    drive = table.drive / np.where(table.prescribed, 1.0, mass)[table.drive_row]
    number = np.array([table.signals.index(signal) for signal in table.signals], dtype=np.int64)[table.drive_signal]
    for signal in range(len(table.signals)):
        chosen = number == signal
        yield of_all(table.drive_row[chosen], drive[chosen])


def _stresses(row: OneRow, moves: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Stresses (3, n) and (3, m) by a random motion, of the scene and of the row."""
    displacement = _random(row, moves)
    return row.of.elastic_stress(displacement[:, row.like]).T, row.elastic_stress(displacement).T
