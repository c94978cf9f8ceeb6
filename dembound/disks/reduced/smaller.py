"""A scene that is stepped in place of a larger one, each of whose disks moves like one of its own."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dembound.boundaries.support import Supports
from dembound.disks.scene import DiskScene

LOADS, PRESCRIBED, DASHPOTS, DRIVES = "steady loads", "held and driven disks", "dashpots", "waves and loads with a wave"
CONTACTS, MASSES, STRESSES = "contacts and springs", "masses", "stresses"

COMPARED = (LOADS, PRESCRIBED, DASHPOTS, DRIVES, CONTACTS, MASSES, STRESSES)
"""What must be the same in a smaller scene, in the order in which it is compared."""


@dataclass(frozen=True, kw_only=True)
class SmallerScene(DiskScene):
    """A scene of m disks in place of one of n.

    Attributes
    ----------
    of : the larger scene, which may itself be smaller than the one of the case.
    like : (n,) the disk that moves like each disk of the larger scene.
    place : (m,) a disk of the larger scene that each disk moves as, in place and direction.
    load : (3, m) N and N·m, steady forces and moments.
    still : (3, m) bool, components in which the symmetry of the larger scene allows no motion.
    """

    of: DiskScene
    like: np.ndarray
    place: np.ndarray
    load: np.ndarray
    still: np.ndarray

    def of_all(self, name: str, values: np.ndarray) -> np.ndarray:
        """Values (m, …) of its disks as those of the disks (n, …) of the larger scene; name : of the quantity."""
        return values[self.like]

    @property
    def probes(self) -> np.ndarray:
        """(p,) disks whose motion is recorded, in place of those of the larger scene."""
        return self.like[self.of.probes]

    def observed(self, record: np.ndarray, times: np.ndarray) -> np.ndarray:
        """The motion of the monitors."""
        return self.of.observed(record, times)

    def tracked_peaks(self, peaks: np.ndarray) -> np.ndarray:
        """Smallest and largest velocities (p, 3, 2) of its `tracked` disks as those of the larger scene's."""
        return peaks[np.searchsorted(self.tracked, self.like[self.of.tracked])]

    @property
    def whole(self) -> DiskScene:
        """The scene of the case."""
        whole = self.of.whole
        assert isinstance(whole, DiskScene)
        return whole

    @property
    def uniform_axes(self) -> tuple[int, ...]:
        """Axes along which all of the scene of the case moves alike."""
        return self.of.uniform_axes

    @property
    def places_in_whole(self) -> np.ndarray:
        """(m,) a disk of the scene of the case that each disk moves as, in place and direction."""
        return self.of.places_in_whole[self.place]

    @property
    def reduced(self) -> tuple[str, ...]:
        """In words, how it is smaller than the scene of the case, a line each."""
        return (*self.of.reduced, self.saved)

    @property
    def saved(self) -> str:
        """In words, how it is smaller than the larger scene."""
        raise NotImplementedError

    @cached_property
    def weight(self) -> float:  # type: ignore[override]  # 1 for other scenes
        """Mass of the scene of the case over its own."""
        return self.of.weight * float(self.of.mass.sum() / self.mass.sum())

    def differs(self, what: str) -> str:
        """In words, that something of the larger scene, in the plural, is not as in this one."""
        raise NotImplementedError

    @property
    def still_in_whole(self) -> np.ndarray:
        """Components (N, 3) of the disks of the case in which its symmetry allows no motion and no force."""
        return self.of.widened("still", self.still.T[self.like]) | self.of.still_in_whole

    def widened(self, name: str, values: np.ndarray) -> np.ndarray:
        """Values (m, …) of its disks as those of all disks of the case; name : of the quantity."""
        return self.of.widened(name, self.of_all(name, values))

    def side_peaks(self, side: str, peaks: np.ndarray) -> np.ndarray:
        """Of a side of the whole scene, see `Scene.side_peaks`."""
        return self.of.side_peaks(side, self.tracked_peaks(peaks))

    @cached_property
    def steady_load(self) -> np.ndarray:
        """(3, m) forces and moments (N, N·m) of the loads without a wave."""
        return self.load

    @cached_property
    def tracked(self) -> np.ndarray:
        """(q,) those that move like any disk of a side of the whole scene."""
        return np.unique(self.like[self.of.tracked])

    @property
    def chain(self) -> tuple[DiskScene, ...]:
        """The scene of the case, and the smaller ones in its place, down to this one."""
        return (*self.of.chain, self)


def supports_at(place: np.ndarray, table: Supports, share: np.ndarray) -> Supports:
    """The support table of some nodes, place (m,), numbered in this order.

    share : (m,) factors of the forces on them, those of their masses.
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
