"""The support table: forces from outside on the body, one row per supported degree of freedom, and their signals.

Signals are time functions of the drives of the table, and of waves that enter through a side.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from dembound.boundaries.edge import BoundaryMedium, Edge, normal_axis

Signal = Callable[[np.ndarray], np.ndarray]
"""A time function: times (k,) in s -> values (k,)."""


class Signals(Protocol):
    """Signals whose values are computed together."""

    @property
    def count(self) -> int:
        """Number q of the signals."""

    def __call__(self, times: np.ndarray, half_step: float) -> np.ndarray:
        """Values (k, q) at times (k,) s of steps; velocities for ties are taken half a step (s) earlier."""


@dataclass(frozen=True)
class OneOf:
    """One of several signals."""

    signals: Signals
    number: int

    def __call__(self, times: np.ndarray, half_step: float = 0.0) -> np.ndarray:
        """Values (k,) of the signal at times (k,) s of steps, with half their length, s."""
        return self.signals(times, half_step)[:, self.number]


class Incident(Protocol):
    """A wave that may enter through a side."""

    def velocity(self, t: np.ndarray) -> np.ndarray:
        """Particle velocity, m/s, at the times t, s; same shape as t."""

    def displacement(self, t: np.ndarray) -> np.ndarray:
        """Particle displacement, m, at the times t, s; same shape as t."""


Waves = Mapping[str, Incident]
"""The waves of a case by name."""


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


__all__ = ["BoundaryMedium", "Edge", "Incident", "Shares", "Signal", "Signals", "SupportBuilder", "Supports", "Waves"]


KINDS: Mapping[str, type[np.generic]] = {
    **dict.fromkeys(("side", "call", "node", "component", "signal"), np.int64),
    **dict.fromkeys(("damping", "follow", "stiffness", "drive"), np.float64),
    **dict.fromkeys(("prescribed", "incident"), np.bool_),
}
"""Columns of rows as they are added, and their types."""


@dataclass
class SupportBuilder:
    """Collects the rows of all sides and merges them into one table.

    Attributes
    ----------
    held : components without motion, whose rows are left out.
    side : the side whose rows are added next; empty for rows of loads.
    """

    held: tuple[int, ...] = ()
    side: str = ""
    _rows: list[dict[str, np.ndarray]] = field(default_factory=list)
    _signals: list[Signal] = field(default_factory=list)
    _sides: list[str] = field(default_factory=list)
    _power: dict[str, int] = field(default_factory=dict)

    def add(
        self,
        nodes: np.ndarray,
        component: int,
        *,
        damping: float | np.ndarray = 0.0,
        follow: float | np.ndarray = 0.0,
        stiffness: float | np.ndarray = 0.0,
        drive: float | np.ndarray = 0.0,
        signal: Signal | None = None,
        incident: Signal | None = None,
        prescribed: bool = False,
    ) -> None:
        """Add one row per node, each node once, for one component; numbers or arrays (k,).

        incident : velocity of a wave that enters through the dashpot, by a force 2·damping·incident (Z eq. 6); it
        replaces drive and signal. Rows added to the same degree of freedom become one, with all their drives. Held
        components are left out.
        """
        if component in self.held or len(nodes) == 0:
            return
        if incident is not None:
            signal, drive = incident, 2.0 * damping
        self._append(
            nodes,
            component,
            -1 if signal is None else self._number_of_signal(signal),
            drive,
            damping=damping,
            follow=follow,
            stiffness=stiffness,
            prescribed=prescribed,
            incident=incident is not None,
        )

    def add_forces(
        self, nodes: np.ndarray, component: np.ndarray, forces: Signals, sides: Mapping[str, np.ndarray] | None = None
    ) -> None:
        """Add forces (N, or N·m) with a signal each on components (k,) of nodes (k,), each degree of freedom once.

        sides : side -> nodes (m,) on which forces count as those of this side; by default all count for the present
        side.
        """
        first = len(self._signals)
        self._signals += [OneOf(forces, number) for number in range(forces.count)]
        present = self.side
        for self.side, own in (sides or {present: nodes}).items():
            for each in sorted(set(component.tolist()) - set(self.held)):
                chosen = np.flatnonzero((component == each) & np.isin(nodes, own))
                if len(chosen):
                    self._append(nodes[chosen], each, first + chosen, 1.0)
        self.side = present

    def add_motion(self, nodes: np.ndarray, component: int, velocities: Signals) -> None:
        """Prescribe velocities with a signal each of one component of nodes (k,)."""
        first = len(self._signals)
        self._signals += [OneOf(velocities, number) for number in range(velocities.count)]
        if component not in self.held:
            self._append(nodes, component, first + np.arange(len(nodes)), 1.0, prescribed=True)

    def add_power(self, side: str, power: Signal) -> None:
        """Add the power (W) of waves that enter through a side by forces only, for the side's energies."""
        self._power[side] = self._number_of_signal(power)

    def _number_of_signal(self, signal: Signal) -> int:
        """The index of a new signal."""
        self._signals.append(signal)
        return len(self._signals) - 1

    def _append(
        self,
        nodes: np.ndarray,
        component: int,
        signal: int | np.ndarray,
        drive: float | np.ndarray,
        **others: float | np.ndarray,
    ) -> None:
        """Append one row per node (k,), zero in columns that are not given; together they are one call."""
        given = {"node": nodes, "component": component, "signal": signal, "drive": drive, **others}
        columns = dict.fromkeys(KINDS, 0.0) | given | {"side": self._number_of_side(), "call": len(self._rows)}
        self._rows.append({name: np.broadcast_to(value, np.shape(nodes)) for name, value in columns.items()})

    @property
    def nodes(self) -> np.ndarray:
        """The nodes (k,) of all rows added so far, ascending."""
        return np.unique(self._column("node"))

    def _number_of_side(self) -> int:
        """The present side's index, −1 for loads."""
        if self.side and self.side not in self._sides:
            self._sides.append(self.side)
        return self._sides.index(self.side) if self.side else -1

    def table(self) -> Supports:
        """Merge rows on the same degree of freedom and sort them by node.

        Dampings, stiffnesses and drives add. A prescribed row replaces all others. Of two prescribed rows the moving
        one is kept, of two moving ones the first, and of two at rest the row along the normal of its side.
        """
        columns = {name: self._column(name) for name in KINDS}
        component, signal, prescribed = (columns[name] for name in ("component", "signal", "prescribed"))
        unique, row_of = np.unique(3 * columns["node"] + component, return_inverse=True)
        along_normal = self._is_along_normal(columns["side"], component)
        kept = ~_outranked(row_of, len(unique), prescribed, signal >= 0, along_normal)
        driven, of_sides = kept & (signal >= 0), kept & (columns["side"] >= 0)
        added = {
            name: np.bincount(row_of, weights=kept * columns[name], minlength=len(unique))
            for name in ("damping", "follow", "stiffness")
        }
        shares = {name: values[of_sides] for name, values in columns.items()}
        return Supports(
            node=unique // 3,
            component=unique % 3,
            **added,
            prescribed=np.bincount(row_of, weights=prescribed, minlength=len(unique)) > 0,
            drive_row=row_of[driven],
            drive=columns["drive"][driven],
            drive_signal=signal[driven],
            signals=tuple(self._signals),
            shares=Shares(**shares, sides=tuple(self._sides), power=dict(self._power)),
        )

    def _is_along_normal(self, side: np.ndarray, component: np.ndarray) -> np.ndarray:
        """Whether the component of each row is along its side's normal; all (a,)."""
        axes = np.array([normal_axis(name) for name in self._sides] + [-1])  # the last one is that of index −1
        return axes[side] == component

    def _column(self, name: str) -> np.ndarray:
        """One column of all rows added so far."""
        kind = KINDS[name]
        return np.concatenate([np.zeros(0, kind), *(rows[name] for rows in self._rows)]).astype(kind)


def _outranked(
    row_of: np.ndarray, count: int, prescribed: np.ndarray, moving: np.ndarray, along_normal: np.ndarray
) -> np.ndarray:
    """Mask (a,) of added rows that are replaced by another row on the same degree of freedom.

    row_of : (a,) int, the merged row of each; prescribed, moving, along_normal : (a,) bool.
    """
    rank = prescribed * (1 + moving.astype(int))
    best = np.zeros(count, dtype=int)
    np.maximum.at(best, row_of, rank)
    outranked = rank < best[row_of]
    # of several equally ranked prescriptions keep the first, of those at rest the first along a normal
    leading = np.flatnonzero((rank > 0) & ~outranked)
    leading = leading[np.argsort((~along_normal & ~moving)[leading], kind="stable")]
    _, first = np.unique(row_of[leading], return_index=True)
    outranked[np.delete(leading, first)] = True
    return outranked
