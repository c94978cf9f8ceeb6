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

from collections.abc import Iterable, Iterator

import numpy as np

from dembound.boundaries import SIDES
from dembound.disks.contacts.elastic_again import never_elastic_again, settled_refused
from dembound.disks.reduced.halves import halves
from dembound.disks.reduced.one_row import one_row
from dembound.disks.reduced.smaller import (
    COMPARED,
    CONTACTS,
    DASHPOTS,
    DRIVES,
    LOADS,
    MASSES,
    PRESCRIBED,
    STRESSES,
    SmallerScene,
)
from dembound.disks.scene import DiskScene
from dembound.disks.stability import fill_forces
from dembound.motion.kind import Reduction
from dembound.motion.layout import aligned_zeros

ROUNDING = 1e-12
"""Difference of two rows over the largest value in the scene that is due to rounding.

A force is a sum of some fifty products, each rounded by 1e-16, whose terms exceed it by a factor of ten or so; a single
contact or support that differs changes it by more than a hundredth.
"""


MOTION, SUPPORT = "displacement", "support"
"""Names of quantities: those with the signs of a motion, and those without."""

ALL = slice(None)


def reduced(scene: DiskScene) -> Reduction[DiskScene]:
    """The smallest scene from whose motion that of a scene follows, itself if there is no smaller one.

    One of its rows if all move identically, one half of a symmetric one, a quarter of one with two mirror lines. Only
    under the elastic law, without a static stage, and without a free-field column. Why a scene has no half, and why the
    elastic law can never follow on a static stage, is returned where the case asks for it.
    """
    case = scene.case
    refused = settled_refused(never_elastic_again(case)) if case.reduce.settled else ()
    if case.reduce.rows:
        scene, _ = one_of_rows(scene)
    if case.reduce.symmetry:
        scene, reason = one_half(scene)
        refused = (f"reduce.symmetry: not applied: {reason}", *refused) if reason else refused
    return Reduction(scene, refused)


def one_of_rows(scene: DiskScene) -> tuple[DiskScene, str]:
    """One of the identical rows of a scene; the scene itself, and why, if it has none."""
    if reason := _never_smaller(scene):
        return scene, reason
    return _first_of(_rows_of(scene), scene)


def one_half(scene: DiskScene) -> tuple[DiskScene, str]:
    """One half of a scene or a quarter; the scene itself, and why neither mirror line is one, if there is no half."""
    if reason := _never_smaller(scene):
        return scene, reason
    reasons = []
    for axis in range(2):
        scene, reason = _first_of(halves(scene, axis), scene)
        reasons.append(reason)
    return scene, "; ".join(reasons) if all(reasons) else ""


def _never_smaller(scene: DiskScene) -> str:
    """Why a scene has to be stepped as a whole whatever its symmetry; empty if it may be reduced."""
    if scene.has_history:
        return f'under material.law = "{scene.case.material.law}" contacts may open, slide and break anywhere'
    if scene.case.output.load_factor:
        return "the load factor is the least of all contacts"
    if scene.case.static is not None:
        return "a static stage is computed for the whole scene"
    if scene.outside is not None:
        return "the body is stepped with the continuum round it"
    if scene.seam is not None:
        sides = " and ".join(side for side in SIDES if scene.case.side(side).needs_column)
        return f"the body is stepped with the free-field column of {sides}"
    return ""


def _rows_of(scene: DiskScene) -> Iterator[SmallerScene | str]:
    """The middle rows of bricks of a scene along each axis, first the axis with fewer rows; or why there is none."""
    copies = scene.assembly.copies
    for axis in np.argsort(copies, kind="stable").tolist():
        if copies[axis] > 1:
            row = one_row(scene, axis)
            yield f"rows along {'yx'[axis]} differ in their disks" if row is None else row
        else:
            yield f"there is a single row of bricks along {'yx'[axis]}"


def _first_of(candidates: Iterable[SmallerScene | str], scene: DiskScene) -> tuple[DiskScene, str]:
    """The first of some smaller scenes from whose motion that of a scene follows, otherwise the scene itself and why.

    Instead of a smaller scene there may be the reason why there is none. Of several reasons the one is returned that
    was found last in the order of `difference`, as that scene came closest.
    """
    reasons = []
    for small in candidates:
        if isinstance(small, str):
            reasons.append((0, small))
            continue
        if (what := difference(small)) is None:
            return small, ""
        reasons.append((COMPARED.index(what), small.differs(what)))
    return scene, max(reasons, default=(0, ""))[1]


def difference(small: SmallerScene) -> str | None:
    """What of `COMPARED` is different in the larger scene, so that it does not move as this one; None if nothing is.

    It moves as this one in displacements, energies and, if needed, stresses.
    """
    if what := _difference_outside(small, _driven(small.of)):  # most scenes are refused here, at little cost
        return what
    moves, (of_whole, of_small) = _motions(small)
    masses = np.bincount(small.like, small.of.mass) / small.mass
    if not _are_alike(small, MOTION, of_whole, of_small, moves):
        return CONTACTS
    if what := _difference_outside(small, moves):
        return what
    if np.ptp(masses) > ROUNDING * masses.max():
        return MASSES
    if small.case.output.stress and not _are_alike(small, "stress", *_stresses(small, moves)):
        return STRESSES
    return None


def _difference_outside(small: SmallerScene, components: np.ndarray) -> str | None:
    """What from outside acts on components (3,) bool of a disk in another way than on the one that represents it."""
    pairs = zip(_from_outside(small.of), _from_outside(small), strict=True)
    for (what, name, whole), (_, _, own) in pairs:
        if not _are_alike(small, name, whole, own, components):
            return what
    return None


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


def _from_outside(scene: DiskScene) -> Iterator[tuple[str, str, np.ndarray]]:
    """Everything that acts on each component: what it is, name of the quantity, (3, n) per unit of mass.

    Loads, dashpots, drives by signal; where velocities are prescribed, and drives that are velocities. Equal signals
    count as one.
    """
    table, inertia = scene.supports, _inertia(scene)
    yield LOADS, MOTION, scene.steady_load / inertia

    def of_all(rows: np.ndarray | slice, values: np.ndarray) -> np.ndarray:
        spread = np.zeros((3, scene.count))
        np.add.at(spread, (table.component[rows], table.node[rows]), values)
        return spread

    every, mass = slice(None), inertia[table.component, table.node]
    yield PRESCRIBED, SUPPORT, of_all(every, table.prescribed)
    yield DASHPOTS, SUPPORT, of_all(every, table.damping / mass)
    drive = table.drive / np.where(table.prescribed, 1.0, mass)[table.drive_row]
    number = np.array([table.signals.index(signal) for signal in table.signals], dtype=np.int64)[table.drive_signal]
    for signal in range(len(table.signals)):
        chosen = number == signal
        yield DRIVES, MOTION, of_all(table.drive_row[chosen], drive[chosen])


def _stresses(small: SmallerScene, moves: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Stresses (3, n) and (3, m) by a random motion, of the larger scene and of the small one."""
    displacement = _random(small, moves)
    of_whole = small.of.elastic_stress(small.of_all(MOTION, displacement.T).T)
    return of_whole.T, small.elastic_stress(displacement).T
