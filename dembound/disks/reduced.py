"""A smaller scene stepped in place of a case: one of several identical rows of disks."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from dembound.boundaries.half_mass import mass_factor
from dembound.boundaries.support import Supports
from dembound.disks.body import with_half_contacts, with_layers
from dembound.disks.columns import parts_of
from dembound.disks.contacts.layout import lay_out
from dembound.disks.memory import run_bytes
from dembound.disks.scene import DiskScene
from dembound.disks.stability import fill_forces
from dembound.disks.stepping.first_law import never_elastic_again, settled_refused
from dembound.disks.surroundings.edges import find_edges
from dembound.motion.kind import Reduction
from dembound.motion.state import aligned_zeros
from dembound.packings.tiling import Assembly, tile


@dataclass(frozen=True, kw_only=True)
class OneRow(DiskScene):
    """A row of m of the n disks of a scene, which is periodic across the row.

    Attributes
    ----------
    of : the scene of the case.
    axis : the axis across the row.
    like : (n,) the disk of the row that moves like each disk of the case's scene.
    load : (3, m) N and N·m, steady forces and moments.
    """

    of: DiskScene
    axis: int
    like: np.ndarray
    load: np.ndarray

    @property
    def probes(self) -> np.ndarray:
        """Disks (p,) whose motion is recorded, in place of the probes of the case's scene."""
        return self.like[self.of.probes]

    def observed(self, record: np.ndarray, times: np.ndarray) -> np.ndarray:
        """The motion of the monitors."""
        return self.of.observed(record, times)

    @property
    def whole(self) -> DiskScene:
        """The scene of the case."""
        return self.of

    @property
    def uniform_axes(self) -> tuple[int, ...]:
        """The axis along which the motion of the case's scene does not vary."""
        return (self.axis,)

    @property
    def reduced(self) -> tuple[str, ...]:
        """Text with the number of rows, and of disks that need not be stepped."""
        rows = self.of.assembly.copies[self.axis]
        return (f"rows: {rows:,} identical rows are stepped as one, {self.count:,} of {self.of.count:,} disks",)

    @cached_property
    def weight(self) -> float:  # type: ignore[override]  # 1 for other scenes
        """Mass of the case's scene over the mass of the row."""
        return float(self.of.mass.sum() / self.mass.sum())

    def widened(self, name: str, values: np.ndarray) -> np.ndarray:
        """Values (m, …) of the row's disks, expanded to all disks of the case; name : of the quantity."""
        return values[self.like]

    def side_peaks(self, side: str, peaks: np.ndarray) -> np.ndarray:
        """Peaks at a side of the whole scene, see `Scene.side_peaks`."""
        return self.of.side_peaks(side, peaks[np.searchsorted(self.tracked, self.like[self.of.tracked])])

    @cached_property
    def steady_load(self) -> np.ndarray:
        """Forces and moments (3, m) N, N·m of the loads without a wave."""
        return self.load

    @cached_property
    def tracked(self) -> np.ndarray:
        """Disks (q,) that move like any disk of a side of the whole scene."""
        return np.unique(self.like[self.of.tracked])

    @property
    def largest_memory(self) -> float:
        """Largest RAM (bytes) of a run of the row, with the case's scene kept."""
        return run_bytes(self.case, [self.of.sizes, self.sizes])


def one_row(scene: DiskScene, axis: int) -> OneRow | None:
    """The middle one of the rows of bricks that a scene has along an axis; None if they differ in their disks.

    Whether the others move as it does remains to be checked.
    """
    case, copies, brick = scene.case, [*scene.assembly.copies], scene.ground.brick
    rows, copies[axis] = copies[axis], 1
    periodic = [case.side("left").is_periodic, case.side("bottom").is_periodic]
    periodic[axis] = True
    low = scene.low + np.eye(2)[axis] * (rows // 2) * brick.size
    row = tile(brick, (copies[0], copies[1]), (periodic[0], periodic[1]), (float(low[0]), float(low[1])))
    like = _counterparts(scene.assembly, row, axis)
    if like is None or (np.bincount(like, minlength=len(row.radii)) != rows).any():
        return None
    middle = np.flatnonzero(scene.assembly.tile[:, axis] == rows // 2)
    place = np.empty_like(middle)  # of each disk of the row in the scene
    place[like[middle]] = middle
    edges = find_edges(row, (periodic[0], periodic[1]), case.packing.regular_sides)
    row, _ = with_half_contacts(case, brick, row, (), edges)
    row, _ = with_layers(scene.ground, replace(row, positions=scene.positions[place]), ())
    fraction = mass_factor(len(place), edges, case.boundary)
    levels = {"body": row.tile[:, 1].astype(np.int64) if scene.ground.is_layered else None}
    slots, contacts = lay_out(row, scene.ground.stepped, parts_of(len(place), ()), fraction, levels)
    share = fraction / scene.cell_fraction[place]
    return OneRow(
        case=case,
        ground=scene.ground,
        assembly=row,
        rows=contacts,
        edges=edges,
        supports=_supports_at(place, scene.supports, share),
        monitors={name: int(like[node]) for name, node in scene.monitors.items()},
        slots=slots,
        of=scene,
        axis=axis,
        like=like,
        load=share * scene.steady_load[:, place],
    )


def _counterparts(assembly: Assembly, row: Assembly, axis: int) -> np.ndarray | None:
    """For each disk (n,) the row's disk that is a copy of the same brick disk; None if any disk has none."""
    along, kinds = 1 - axis, int(assembly.brick_particle.max()) + 1
    requested, there = (each.tile[:, along].astype(np.int64) * kinds + each.brick_particle for each in (assembly, row))
    order = np.argsort(there)
    found = order[np.searchsorted(there, requested, sorter=order).clip(max=len(order) - 1)]
    return found if (there[found] == requested).all() else None


def _supports_at(place: np.ndarray, table: Supports, share: np.ndarray) -> Supports:
    """The support table of the nodes `place` (m,), numbered in this order.

    share : (m,) factors of the forces on them, equal to those of their masses.
    """
    order = np.argsort(place)
    near = order[np.searchsorted(place, table.node, sorter=order).clip(max=len(order) - 1)]
    kept = np.flatnonzero(place[near] == table.node)
    kept = kept[np.lexsort((table.component[kept], near[kept]))]
    node, prescribed = near[kept], table.prescribed[kept]
    line = np.full(len(table), -1)
    line[kept] = np.arange(len(kept))
    drives = np.flatnonzero(line[table.drive_row] >= 0)
    drive_row = line[table.drive_row[drives]]
    return Supports(
        node=node,
        component=table.component[kept],
        damping=share[node] * table.damping[kept],
        follow=share[node] * table.follow[kept],
        stiffness=share[node] * table.stiffness[kept],
        prescribed=prescribed,
        drive_row=drive_row,
        drive=np.where(prescribed, 1.0, share[node])[drive_row] * table.drive[drives],
        drive_signal=table.drive_signal[drives],
        signals=table.signals,
    )


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

    Only under the elastic law, without a load factor (the least of all contacts), a static stage, a free-field column,
    a continuum, joints and groups.
    """
    case = scene.case
    apart = scene.has_history or case.output.load_factor or case.static is not None
    if apart or scene.outside is not None or scene.seams or scene.faces or scene.groups:
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
    moves, found = _motions(row)
    masses = np.bincount(row.like, row.of.mass) / row.mass
    alike = _are_alike(row, *found, moves) and _same_outside(row, moves)
    alike = alike and bool(np.ptp(masses) <= ROUNDING * masses.max())
    if not alike or not row.case.output.stress:
        return alike
    displacement = _random(row, moves)
    stresses = row.of.elastic_stress(displacement[:, row.like]), row.elastic_stress(displacement)
    return _are_alike(row, *(each.T for each in stresses))


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
