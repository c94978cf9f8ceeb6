"""The support table: how the outside pushes on the body, one row per supported degree of freedom.

Every boundary type is a recipe that fills rows of this one table, and one kernel applies it::

    F = preload − damping · v − stiffness · u + drive · signal(t)          (Z eqs 4-6, 13-18)

or, for a prescribed row, v = drive · signal(t) whatever the forces. A side may meet another at a corner:
rows on the same degree of freedom then add up, and a prescribed one outranks the rest.
"""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from dembound.boundaries.sides import normal_axis

Signal = Callable[[np.ndarray], np.ndarray]
"""A time function: times (k,) in s -> values (k,)."""


@dataclass(frozen=True)
class Medium:
    """What the dashpots absorb into: bulk density (kg/m³) and nominal wave speeds (m/s)."""

    density: float
    p_wave_speed: float
    s_wave_speed: float

    def impedances(self, beta_p: float, beta_s: float, normal_axis: int) -> np.ndarray:
        """Dashpot constants per metre of boundary, (2,) in Pa·s/m: βρc, P along the normal, S across it."""
        along_normal = beta_p * self.density * self.p_wave_speed
        across = beta_s * self.density * self.s_wave_speed
        return np.array([along_normal, across] if normal_axis == 0 else [across, along_normal])


@dataclass(frozen=True)
class Edge:
    """One side of the scene: the exposed particles and the length they stand for.

    side left, right, bottom or top; nodes (k,) particle indices; diameters (k,) m; length m.
    """

    side: str
    nodes: np.ndarray
    diameters: np.ndarray
    length: float

    @property
    def axis(self) -> int:
        """Axis of the normal: 0 for left and right, 1 for bottom and top."""
        return normal_axis(self.side)

    @property
    def cover(self) -> float:
        """ΣD/H: the summed diameters over the length of the side; 1 for a row of touching equal disks."""
        return float(self.diameters.sum() / self.length)


@dataclass(frozen=True)
class Supports:
    """The table. All columns have length r.

    node, component (0 x, 1 y, 2 rotation); preload N; damping N·s/m; stiffness N/m; drive N (or m/s where
    prescribed) per unit of signal; signal index into `signals`, -1 for none; prescribed bool.
    """

    node: np.ndarray
    component: np.ndarray
    preload: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    drive: np.ndarray
    signal: np.ndarray
    prescribed: np.ndarray
    signals: tuple[Signal, ...] = ()

    def __len__(self) -> int:
        return len(self.node)

    def sample(self, times: np.ndarray, half_step: float) -> np.ndarray:
        """Drive of every row at each time, (steps, r): forces at `times`, prescribed velocities half a step on.

        Forces act at whole steps; velocities live at half steps, so a prescribed one is sampled there.
        """
        values = np.zeros((len(times), len(self)))
        for index, signal in enumerate(self.signals):
            for prescribed, shift in ((False, 0.0), (True, half_step)):
                rows = np.flatnonzero((self.signal == index) & (self.prescribed == prescribed))
                if len(rows):
                    values[:, rows] = signal(times + shift)[:, None] * self.drive[rows]
        return values


@dataclass
class SupportBuilder:
    """Collects the rows of all sides and merges them into one table."""

    held: tuple[int, ...] = ()
    _rows: list[dict[str, np.ndarray]] = field(default_factory=list)
    _signals: list[Signal] = field(default_factory=list)

    def add(
        self,
        nodes: np.ndarray,
        component: int,
        *,
        preload: float | np.ndarray = 0.0,
        damping: float | np.ndarray = 0.0,
        stiffness: float | np.ndarray = 0.0,
        drive: float | np.ndarray = 0.0,
        signal: Signal | None = None,
        prescribed: bool = False,
    ) -> None:
        """Add one row per node for one component; numbers or arrays (k,). Held components are left out."""
        if component in self.held or len(nodes) == 0:
            return
        index = -1
        if signal is not None:
            index = len(self._signals)
            self._signals.append(signal)
        columns: dict[str, float | np.ndarray] = {
            "node": nodes,
            "component": component,
            "preload": preload,
            "damping": damping,
            "stiffness": stiffness,
            "drive": drive,
            "signal": index,
            "prescribed": prescribed,
        }
        self._rows.append({name: np.broadcast_to(value, np.shape(nodes)) for name, value in columns.items()})

    def table(self) -> Supports:
        """Merge rows on the same degree of freedom and sort them by node.

        Dampings, stiffnesses and preloads add; drives of different signals become one signal of their own; a
        prescribed row replaces all others, and of two prescribed rows the moving one wins.
        """
        columns = {
            name: np.concatenate([rows[name] for rows in self._rows]) if self._rows else np.zeros(0)
            for name in (
                "node",
                "component",
                "preload",
                "damping",
                "stiffness",
                "drive",
                "signal",
                "prescribed",
            )
        }
        columns["prescribed"] = columns["prescribed"].astype(bool)
        for name in ("node", "component", "signal"):
            columns[name] = columns[name].astype(np.int64)
        key = columns["node"] * 3 + columns["component"]
        unique, row_of = np.unique(key, return_inverse=True)
        outranked = self._outranked(columns, row_of, len(unique))
        merged = {name: np.zeros(len(unique)) for name in ("preload", "damping", "stiffness", "drive")}
        for name in ("preload", "damping", "stiffness"):
            np.add.at(merged[name], row_of[~outranked], columns[name][~outranked])
        signal = np.full(len(unique), -1)
        signals = list(self._signals)
        prescribed = np.zeros(len(unique), dtype=bool)
        np.logical_or.at(prescribed, row_of, columns["prescribed"])
        for i in np.flatnonzero((columns["signal"] >= 0) & ~outranked):
            row = row_of[i]
            if signal[row] < 0:
                signal[row], merged["drive"][row] = columns["signal"][i], columns["drive"][i]
                continue
            first, second = signals[signal[row]], signals[columns["signal"][i]]
            signals.append(_sum_of(first, merged["drive"][row], second, columns["drive"][i]))
            signal[row], merged["drive"][row] = len(signals) - 1, 1.0
        return Supports(
            node=unique // 3,
            component=unique % 3,
            signal=signal,
            prescribed=prescribed,
            signals=tuple(signals),
            **merged,
        )

    @staticmethod
    def _outranked(columns: dict[str, np.ndarray], row_of: np.ndarray, count: int) -> np.ndarray:
        """Rows (r,) bool that another row on the same degree of freedom replaces."""
        rank = columns["prescribed"].astype(int) * (1 + (columns["signal"] >= 0))
        best = np.zeros(count, dtype=int)
        np.maximum.at(best, row_of, rank)
        outranked = rank < best[row_of]
        # of several equally ranked prescriptions keep the first
        prescribed = np.flatnonzero((rank > 0) & ~outranked)
        _, first = np.unique(row_of[prescribed], return_index=True)
        outranked[np.delete(prescribed, first)] = True
        return outranked


def _sum_of(first: Signal, factor: float, second: Signal, other: float) -> Signal:
    """The signal factor · first + other · second."""
    return lambda times: factor * first(times) + other * second(times)
