"""The support table in the form for the kernels."""

import numpy as np

from dembound.boundaries.support import Supports
from dembound.kernels import tables
from dembound.kernels.common import add_driven
from dembound.motion.part import Tie
from dembound.motion.scene import Scene


class NodeSupports:
    """One line per supported node, with all three components.

    Parameters
    ----------
    scene : the supported scene.
    ties : ties that act on nodes of the table.
    time_step : Δt in s.
    drag : (n,) α, 1/s, by which laws slow all nodes, or (0,) if none do. Laws give −αm v⁻, and masses are larger by
    ½αΔt, which is −½αm(v⁻ + v⁺) in all.

    Attributes
    ----------
    nodes : (k,) ascending.
    slots : (k,) where kernels hold them.
    inertia, keep, mobility, stiffness, prescribed, follow : (k, 3), see kernels.tables.Supports.
    twin : (k,) slots, see kernels.tables.Supports.
    """

    def __init__(self, scene: Scene, ties: tuple[Tie, ...], time_step: float, drag: np.ndarray) -> None:
        self._rows: Supports = scene.supports
        self._half_step = 0.5 * time_step
        tied = np.concatenate([np.zeros(0, dtype=np.int64), *(tie.nodes for tie in ties)])
        self.nodes = np.union1d(self._rows.node, tied)
        self.slots = scene.layout.slot[self.nodes]
        self._at = (np.searchsorted(self.nodes, self._rows.node), self._rows.component)
        self.inertia = np.stack([scene.mass, scene.mass, scene.inertia], axis=1)[self.nodes] / time_step
        if len(drag) > 0:
            self.inertia *= 1.0 + 0.5 * time_step * drag[self.nodes, None]
        damping = self._spread(self._rows.damping)
        self.stiffness, self.prescribed = self._spread(self._rows.stiffness), self._spread(self._rows.prescribed)
        self.follow = self._spread(self._rows.follow)
        twin = self.nodes if scene.twin is None else scene.twin[self.nodes]
        self.twin = np.where(twin == self.nodes, -1, scene.layout.slot[twin])
        moves = scene.free * (1.0 - self.prescribed)
        self.mobility = moves / (self.inertia + 0.5 * damping)
        self.keep = moves * (self.inertia - 0.5 * damping) / (self.inertia + 0.5 * damping)

    def sampled(self, times: np.ndarray) -> np.ndarray:
        """Values (steps, q) of all signals for steps that begin at `times` (steps,) s."""
        return self._rows.sampled(times, self._half_step)

    def table(self, signals: np.ndarray) -> tables.Supports:
        """The table for steps with these values (steps, q) of all signals."""
        rows, drive = self._rows, np.zeros((len(signals), len(self.nodes), 3))
        column = (3 * self._at[0] + self._at[1])[rows.drive_row]
        add_driven(signals, rows.drive_signal, rows.drive, column, drive.reshape(len(signals), -1))
        return tables.Supports(
            nodes=self.slots,
            inertia=self.inertia,
            keep=self.keep,
            mobility=self.mobility,
            stiffness=self.stiffness,
            prescribed=self.prescribed,
            drive=drive,
            twin=self.twin,
            follow=self.follow,
        )

    def driven(self, velocity: np.ndarray) -> np.ndarray:
        """Prescribed velocities (3, k) among those of all slots (3, slots), 0 for other components."""
        return np.where(self.prescribed.T > 0.0, velocity[:, self.slots], 0.0)

    def after_half_a_kick(self, velocity: np.ndarray) -> np.ndarray:
        """Velocities (3, k) of nodes after half a kick from rest, from those of all slots (3, slots) after a whole one.

        With x = CΔt/2m a whole kick FΔt/m gives 1/(1 + x) of it, as dashpots C take the mean velocity, and half of it
        is without them, as this is 0: the factor ½(1 + x) is 1/(1 + keep). The pull of moving twins is none, either.
        """
        pulled = np.where(self.twin < 0, 0.0, 0.5 * (self.mobility * self.follow).T * velocity[:, self.twin])
        half = (velocity[:, self.slots] - pulled) / (1.0 + self.keep.T)
        return np.where(self.prescribed.T > 0.0, 0.0, half)

    def _spread(self, column: np.ndarray) -> np.ndarray:
        """A column of the table as (k, 3), zero where it has no row."""
        spread = np.zeros((len(self.nodes), 3))
        spread[self._at] = column
        return spread
