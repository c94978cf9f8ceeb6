"""Scenes of which only a part has to be stepped, since the rest moves in the same way or as its mirror image.

The rows of a scene move identically if two conditions hold. From rest, with identical rows, everything that acts from
outside accelerates all rows equally; and a motion that is the same in all rows leads to accelerations that are the
same in all rows. Both are linear in drives, velocities and displacements, and are checked on the assembled scene: a
random motion of one row, repeated in all of them, must cause the accelerations that the row alone has. An error of any
contact or support would change them, as no motion of random numbers is orthogonal to it. The two halves of a scene move
as mirror images on the same conditions, with mirrored in place of repeated.

Only components that move count. They are found in the same way: those that are driven, and those on which motions of
these exert forces. In the others there is exactly no motion. So a bar of a square lattice with free long sides has
identical rows under P waves, which exert no force across or moment, but not under S waves.
"""

from collections.abc import Iterator

import numpy as np

from dembound.disks.half import halves
from dembound.disks.one_row import one_row
from dembound.disks.scene import DiskScene
from dembound.disks.smaller import SmallerScene
from dembound.disks.stability import fill_forces
from dembound.motion.layout import aligned_zeros

ROUNDING = 1e-12
"""Difference of two rows over the largest value in the scene that is due to rounding.

A force is a sum of some fifty products, each rounded by 1e-16, whose terms exceed it by a factor of ten or so; a single
contact or support that differs changes it by more than a hundredth.
"""


MOTION, SUPPORT = "displacement", "support"
"""Names of quantities: those with the signs of a motion, and those without."""

ALL = slice(None)


def reduced(scene: DiskScene) -> DiskScene:
    """The smallest scene from whose motion that of a scene follows, itself if there is no smaller one.

    One of its rows if all move identically, one half of a symmetric one, a quarter of one with two mirror lines. Only
    under the elastic law, without a static stage, and without a free-field column.
    """
    if scene.has_history or scene.case.static is not None or scene.seam is not None:
        return scene
    if scene.case.reduce.rows:
        scene = _first_of(rows_of(scene), scene)
    if scene.case.reduce.symmetry:
        for axis in range(2):
            scene = _first_of(halves(scene, axis), scene)
    return scene


def rows_of(scene: DiskScene) -> Iterator[SmallerScene]:
    """The middle rows of bricks of a scene along each axis, first the axis with fewer rows."""
    copies = scene.assembly.copies
    for axis in np.argsort(copies, kind="stable").tolist():
        if copies[axis] > 1 and (row := one_row(scene, axis)) is not None:
            yield row


def _first_of(smaller: Iterator[SmallerScene], scene: DiskScene) -> DiskScene:
    """The first of some smaller scenes from whose motion that of a scene follows, otherwise the scene itself."""
    return next((small for small in smaller if represents_all(small)), scene)


def represents_all(small: SmallerScene) -> bool:
    """Whether the larger scene moves as this one, in displacements, energies and, if needed, stresses."""
    if not _are_driven_alike(small, _driven(small.of)):  # most scenes are refused here, at little cost
        return False
    moves, (of_whole, of_small) = _motions(small)
    masses = np.bincount(small.like, small.of.mass) / small.mass
    return (
        _are_alike(small, MOTION, of_whole, of_small, moves)
        and _are_driven_alike(small, moves)
        and np.ptp(masses) <= ROUNDING * masses.max()
        and (not small.case.output.stress or _are_alike(small, "stress", *_stresses(small, moves)))
    )


def _are_driven_alike(small: SmallerScene, components: np.ndarray) -> bool:
    """Whether everything from outside acts on components (3,) bool of all disks as on those that represent them."""
    pairs = zip(_from_outside(small.of), _from_outside(small), strict=True)
    return all(_are_alike(small, name, whole, own, components) for (name, whole), (_, own) in pairs)


def _are_alike(
    small: SmallerScene, name: str, of_whole: np.ndarray, of_small: np.ndarray, components: np.ndarray | slice = ALL
) -> bool:
    """Whether values (3, n) of the larger scene are those (3, m) of the small one, in some components (3,) bool.

    name : of the quantity, see `SmallerScene.of_all`. Supports of components without motion do not count.
    """
    still = small.still
    if name == SUPPORT:
        of_whole = np.where(small.of_all(SUPPORT, still.T).T, 0.0, of_whole)
        of_small = np.where(still, 0.0, of_small)
    expected = small.of_all(name, of_small.T).T[components]
    largest = np.abs(of_whole[components]).max(initial=0.0)
    return bool((np.abs(of_whole[components] - expected) <= ROUNDING * largest).all())


def _motions(small: SmallerScene) -> tuple[np.ndarray, tuple[np.ndarray, np.ndarray]]:
    """The components that move (3,), and accelerations by a random motion of these, of the larger scene and of both."""
    moves = _driven(small.of)
    while True:
        displacement = _random(small, moves)
        found = _accelerations(small.of, small.of_all(MOTION, displacement.T).T), _accelerations(small, displacement)
        pushed = moves | np.logical_or(*((acceleration != 0.0).any(axis=1) for acceleration in found))
        if (pushed == moves).all():
            return moves, found
        moves = pushed


def _random(small: SmallerScene, moves: np.ndarray) -> np.ndarray:
    """Random displacements (3, m) in the components that move, of surfaces for rotations: m and rad."""
    displacement = np.random.default_rng(0).standard_normal((3, small.count)) * moves[:, None]
    displacement[2] /= small.assembly.radii
    return np.where(small.still, 0.0, displacement)


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


def _from_outside(scene: DiskScene) -> Iterator[tuple[str, np.ndarray]]:
    """Everything that acts on each component, name and (3, n), per unit of mass: loads, dashpots, drives by signal.

    Also where velocities are prescribed, and drives that are velocities. Equal signals count as one.
    """
    table, inertia = scene.supports, _inertia(scene)
    yield MOTION, scene.steady_load / inertia

    def of_all(rows: np.ndarray | slice, values: np.ndarray) -> np.ndarray:
        spread = np.zeros((3, scene.count))
        np.add.at(spread, (table.component[rows], table.node[rows]), values)
        return spread

    every, mass = slice(None), inertia[table.component, table.node]
    yield SUPPORT, of_all(every, table.prescribed)
    yield SUPPORT, of_all(every, table.damping / mass)
    drive = table.drive / np.where(table.prescribed, 1.0, mass)[table.drive_row]
    number = np.array([table.signals.index(signal) for signal in table.signals], dtype=np.int64)[table.drive_signal]
    for signal in range(len(table.signals)):
        chosen = number == signal
        yield MOTION, of_all(table.drive_row[chosen], drive[chosen])


def _stresses(small: SmallerScene, moves: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Stresses (3, n) and (3, m) by a random motion, of the larger scene and of the small one."""
    displacement = _random(small, moves)
    of_whole = small.of.elastic_stress(small.of_all(MOTION, displacement.T).T)
    return of_whole.T, small.elastic_stress(displacement).T
