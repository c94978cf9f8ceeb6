"""The merged support table: one row per supported degree of freedom, see support.py."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from dembound.boundaries.signals import OneOf, Signal


@dataclass(frozen=True)
class Shares:
    """Contributions of the sides to a support table: a rows as added by sides, see `SupportBuilder.add`.

    Attributes
    ----------
    side : (a,) the side's index in `sides`; call : (a,) number of the call that added it; all rows of a call have the
    same
    component.
    node, component, damping, follow, stiffness, prescribed, drive : (a,) as given; damping, follow, stiffness and drive
    are zero where a prescribed row has replaced them, and of several prescribed rows only one is listed.
    signal : (a,) index of the signal of the drive, −1 for none; incident : (a,) bool, whether it is the velocity of a
    wave that enters through the dashpot.
    sides : their names. power : side -> index of the signal that is the power (W) of the waves that enter through it
    other than through dashpots.
    """

    side: np.ndarray
    call: np.ndarray
    node: np.ndarray
    component: np.ndarray
    damping: np.ndarray
    follow: np.ndarray
    stiffness: np.ndarray
    prescribed: np.ndarray
    drive: np.ndarray
    signal: np.ndarray
    incident: np.ndarray
    sides: tuple[str, ...]
    power: Mapping[str, int] = field(default_factory=dict)


@dataclass(frozen=True)
class Supports:
    """The table: r rows, one per supported degree of freedom, and the d drives that act on them.

    Of rows: node; component (0 x, 1 y, 2 rotation); damping, follow N·s/m; stiffness N/m (N·m/rad of a rotation);
    prescribed bool. Of drives, any number to a row: drive_row; drive N (m/s where prescribed) per unit of signal;
    drive_signal, the signal's index. shares : what each side adds to the rows; None in a table made from another one.
    """

    node: np.ndarray
    component: np.ndarray
    damping: np.ndarray
    follow: np.ndarray
    stiffness: np.ndarray
    prescribed: np.ndarray
    drive_row: np.ndarray
    drive: np.ndarray
    drive_signal: np.ndarray
    signals: tuple[Signal, ...] = ()
    shares: Shares | None = None

    def __len__(self) -> int:
        return len(self.node)

    def springs_at(self, displacement: np.ndarray) -> np.ndarray:
        """Forces (3, n) N that shift the zero of the springs to displacements (3, n)."""
        force = np.zeros_like(displacement)
        force[self.component, self.node] = self.stiffness * displacement[self.component, self.node]
        return force

    def sampled(self, times: np.ndarray, half_step: float) -> np.ndarray:
        """Values (steps, q) of all signals at each time: of forces at `times`, of prescribed velocities later.

        Forces act at whole steps; velocities are defined at half steps, so prescribed velocities are sampled half a
        step later.
        """
        ahead = set(self.drive_signal[self.prescribed[self.drive_row]].tolist())
        values = np.empty((len(times), len(self.signals)))
        first = 0
        while first < len(self.signals):
            signal = self.signals[first]
            if isinstance(signal, OneOf):  # those of one group follow each other
                count = signal.signals.count
                values[:, first : first + count] = signal.signals(times, half_step)
            else:
                count = 1
                values[:, first] = signal(times + half_step * (first in ahead))
            first += count
        return values

    def sample(self, times: np.ndarray, half_step: float) -> np.ndarray:
        """Sum of the drives of every row at each time, (steps, r), see `sampled`."""
        values = np.zeros((len(times), len(self)))
        driven = self.sampled(times, half_step)[:, self.drive_signal] * self.drive
        np.add.at(values.T, self.drive_row, driven.T)
        return values
