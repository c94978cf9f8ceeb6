"""Where waves enter disks: their delay relative to waves through the plane of a side.

A wave that enters at a side is to be v(t) on the plane of that side, of a body that is uniform from there on. Disks let
it in elsewhere. Depths count from the plane inwards; two of them matter for long waves: m, where the mass of the disks
begins, and s, where the extrapolated line of displacements inside meets the displacement imposed at the side.

- Prescribed disks have v(t) at s: all motion is early by s/c.
- Dashpots Z and the force 2Zv move the disks they act on as the wave at s, and their mass from m on as the body's
  impedance Z′ = ρc: 2Zv(t) = Z v′(t + s/c) + Z′ v′(t + m/c), so that the motion is early by (Z s + Z′ m)/(Z + Z′)/c. A
  square lattice has m = 0 and s = D/2 for P waves, half cells m = s = D/2.
- Through a continuum waves enter where its elements end, at their own time.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import NamedTuple

import numpy as np

from dembound.boundaries import Motion, axis_of_motion, normal_axis
from dembound.casefile.disks import DiskCase
from dembound.casefile.model import FREE
from dembound.disks.matching import factors_in, homogenised_beta
from dembound.disks.material.homogenise import Network
from dembound.disks.material.kept import Kept
from dembound.disks.reflection.bricks import end_scene
from dembound.disks.scene import DiskScene
from dembound.disks.sides import ground_at

APART = 8.0
"""Diameters, at least, of each third of the strip in which s is found: at the side, where displacements are read,
and where it is pulled. Effects of a side decay with the depth y as exp(−2πy/brick), and over a disk without
bricks."""

MOTIONS: tuple[Motion, Motion] = ("p", "s")
"""Kinds of waves, in the order of wave speeds."""

FAINT = 1e-12
"""Springs against single motions over those of the contacts: disks that hang by one contact may roll."""

WITHIN = 0.01
"""Diameters within which the delays computed here hold for waves 100 disks long: measured on columns of a lattice
and of two seeds each of patterns B and C, P and S waves, prescribed velocities, dashpots, springs, half cells,
free fields and continua (benchmarks/entries.py), relative to the delays through a continuum."""


class Entry(NamedTuple):
    """The place where a wave enters at a side.

    late : distance (m) by which its motion is behind a wave through the plane of the side, negative where it is ahead;
    speed : m/s, of long waves.
    """

    late: float
    speed: float

    @property
    def delay(self) -> float:
        """Time (s) by which waves enter later; negative where they enter earlier."""
        return self.late / self.speed


def entries_of(scene: DiskScene) -> dict[str, dict[Motion, Entry]]:
    """The entries of all waves that run in the packing, by driven side.

    An oblique wave refers to a point of the ground, and has no entry.
    """
    found: dict[str, dict[Motion, Entry]] = {}
    for side, waves in scene.case.driving.items():
        axis = normal_axis(side)
        speeds = dict(zip(("p", "s"), ground_at(scene, side).wave_speeds(axis), strict=True))
        running: list[Motion] = [motion for motion in waves if math.isfinite(speeds[motion])]
        if running:
            late = _late(scene, side, running)
            found[side] = {motion: Entry(late[motion], speeds[motion]) for motion in running}
    return found


def all_late_by(scene: DiskScene) -> float | None:
    """Time (s) by which all motion is later than waves through the planes of sides.

    None where delays of several waves differ by more than `WITHIN` diameters.
    """
    entries = [entry for waves in entries_of(scene).values() for entry in waves.values()]
    delays = [entry.delay for entry in entries]
    error = WITHIN * scene.ground.brick.mean_diameter / min((entry.speed for entry in entries), default=math.inf)
    return None if delays and max(delays) - min(delays) > error else late_by(scene)


def late_by(scene: DiskScene) -> float:
    """Time (s) by which the motion is later than waves through the planes of sides; of several waves the largest."""
    delays = [entry.delay for entries in entries_of(scene).values() for entry in entries.values()]
    return max(delays, key=abs, default=0.0)


def _late(scene: DiskScene, side: str, motions: list[Motion]) -> dict[Motion, float]:
    """Distances (m) by which waves enter late at a side."""
    table = scene.case.side(side)
    if table.is_outside:
        beneath = scene.feet[0] if scene.feet else scene.outside
        assert beneath is not None
        number = ("left", "bottom", "right", "top").index(side)
        return dict.fromkeys(motions, -_inwards(side) * (beneath.box[number] - scene.case.box[number]))
    if not table.factors and (held := depths_held(scene, side)).keys() >= set(motions):
        return {motion: -held[motion] for motion in motions}
    end = _Strip.of(scene.case, side)
    if not table.factors:  # a type of another package, that pushes: as if it held
        return {motion: -end.depth(motion, (0, 1)) for motion in motions}
    factors = factors_in(scene, side)
    found = {}
    for motion in motions:
        matched = homogenised_beta(scene, side, motion)
        share = factors[motion] / (factors[motion] + matched)
        found[motion] = -(share * end.depth(motion) + (1.0 - share) * end.mass_begins)
    return found


def side_ends(scene: DiskScene, side: str) -> dict[Motion, tuple[float, float]]:
    """Depths m and s (m) of a side with dashpots, by kind of wave that runs along its normal."""
    end, speeds = _Strip.of(scene.case, side), ground_at(scene, side).wave_speeds(normal_axis(side))
    running = [motion for motion, speed in zip(MOTIONS, speeds, strict=True) if math.isfinite(speed)]
    return {motion: (end.mass_begins, end.depth(motion)) for motion in running}


def mass_begins(scene: DiskScene, side: str) -> float:
    """Depth m (m) of a side; of one of type "outside" that of the free surface in which its ground ends."""
    case = scene.case
    if case.side(side).is_outside:
        case = replace(case, boundary={**case.boundary, side: FREE})
    return _Strip.of(case, side).mass_begins


def depths_held(scene: DiskScene, side: str) -> dict[Motion, float]:
    """The depth s (m) for those waves along a side's normal whose motion the side prescribes."""
    axis = normal_axis(side)
    held = scene.case.side(side).prescribed(axis)
    kinds: tuple[Motion, ...] = ("p", "s")
    motions = [motion for motion in kinds if {axis_of_motion(side, motion)} <= {*held} - {*scene.ground.held}]
    if not motions:
        return {}
    end = _Strip.of(scene.case, side)
    return {motion: end.depth(motion, held) for motion in motions}


def _inwards(side: str) -> float:
    """Sign, along the normal's axis, of the direction from a side into the body."""
    return -1.0 if side in ("right", "top") else 1.0


_MOVED: Kept[np.ndarray] = Kept()


@dataclass(frozen=True)
class _Strip:
    """A row of bricks, periodic sideways, with the side of a case at its end.

    side : its name. scene : the strip. zone : (n,) third in which each disk is: 0 at the side, 1, 2 at the far end.
    """

    side: str
    scene: DiskScene
    zone: np.ndarray

    @classmethod
    def of(cls, case: DiskCase, side: str) -> _Strip:
        """The strip of a case."""
        axis = normal_axis(side)
        third = math.ceil(APART * 2.0 * case.packing.radius / case.packing.brick_size[axis])
        scene = end_scene(case, side, 3 * third)
        tile = scene.assembly.tile[:, axis]
        inwards = tile if _inwards(side) > 0.0 else scene.assembly.copies[axis] - 1 - tile
        return cls(side, scene, np.clip(inwards // third, 0, 2))

    @property
    def _axis(self) -> int:
        """Axis of the side's normal."""
        return normal_axis(self.side)

    @property
    def _depths(self) -> np.ndarray:
        """Depths (n,) m of the disks' centres below the side."""
        beyond = self.scene.assembly.positions[:, self._axis] - self.scene.plane(self.side)
        return np.asarray(_inwards(self.side) * beyond)

    @cached_property
    def mass_begins(self) -> float:
        """m: depth (m) from which a uniform body would have the same mass; mass missing in half cells counts.

        From the mass moment of the middle third, for which the uniform body has the same centre.
        """
        mass = self.scene.mass
        middle = self.zone == 1
        centre = float(np.average(self._depths[middle], weights=mass[middle]))
        per_length = float(mass[middle].sum()) / self._third
        above = float(mass[self.zone == 0].sum()) / per_length
        return centre - 0.5 * self._third - above

    @property
    def _third(self) -> float:
        """Length of a third, m."""
        return float(self.scene.assembly.size[self._axis]) / 3.0

    def depth(self, motion: Motion, held: Sequence[int] = ()) -> float:
        """s: depth (m) at which the line through the displacements inside meets that of the disks at the side.

        held : components of the disks at the side that are prescribed. The far third is pulled along its whole mass;
        the disks at the side are held, or, if `held` is empty, pulled the other way in proportion to the widths of
        their dashpots, with the mean displacement taken.
        """
        component = axis_of_motion(self.side, motion)
        scene, edge = self.scene, self.scene.edges[self.side]
        count, far, middle = scene.disk_count, self.zone == 2, self.zone == 1
        across = float(scene.assembly.size[1 - self._axis])
        force = np.zeros((3, count))
        force[component, far] = across * scene.mass[far] / scene.mass[far].sum()
        free = np.ones((3, count), dtype=bool)
        free[list(scene.ground.held)] = False
        weights = edge.widths / edge.widths.sum()
        if held:
            free[np.ix_(np.array(held), edge.nodes)] = False
        else:
            force[component, edge.nodes] -= across * weights
            free[:2, np.flatnonzero(far)[0]] = False
        moved = self._moved(force, free)[component]
        at_side = 0.0 if held else float(weights @ moved[edge.nodes])
        mean = partial(np.average, weights=scene.mass[middle])
        strain = self._compliance(component)
        return float(mean(self._depths[middle]) - (mean(moved[middle]) - at_side) / strain)

    def _compliance(self, component: int) -> float:
        """Gradient along the normal of a component under unit traction along it, 1/Pa."""
        ground = self.scene.ground
        entries = {0: (0, 3), 1: (2, 1)}[self._axis]  # of x and y, see homogenise.GRADIENTS
        free = [axis for axis in (0, 1) if axis not in ground.held]
        numbers = [entries[axis] for axis in free]
        inverse = np.linalg.inv(ground.tensor[np.ix_(numbers, numbers)])
        return float(inverse[free.index(component), free.index(component)])

    def _moved(self, force: np.ndarray, free: np.ndarray) -> np.ndarray:
        """Displacements and rotations (3, n) at rest under forces (3, n), of components (3, n) bool that are free."""
        from scipy.sparse import diags
        from scipy.sparse.linalg import spsolve

        assembly, ground = self.scene.assembly, self.scene.ground
        contacts = len(ground.brick.pairs)
        halved, kind = np.divmod(assembly.contact_type % (2 * contacts), contacts)
        stiffness = ground.stiffness.of(kind).times(np.where(halved > 0, 0.5, 1.0))
        network = Network(len(assembly.radii), assembly.pairs, ground.brick.vectors[kind], stiffness)
        ways = network.motion_matrix()[:, free.ravel()]
        matrix = (ways.T @ diags(network.springs) @ ways).tocsc()
        matrix += FAINT * diags(matrix.diagonal(), format="csc")
        moved = np.zeros(force.shape)
        right = force[free]
        moved[free] = _MOVED.get(lambda: spsolve(matrix, right), matrix.indptr, matrix.indices, matrix.data, right)
        return moved
