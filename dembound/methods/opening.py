"""The opening bonds of a bar: bonds in cracks with a fracture energy."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from dembound.methods.rod import Range

if TYPE_CHECKING:
    from dembound.kernels.tables import Softening

COLUMNS = ("row", "first", "began", "whole", "limit", "apart", "furthest", "rate")
"""The columns of the list of opening bonds."""

RISE = 0.5
"""Share of the limit of a bond above which its strain rate is measured, if the strength depends on it.

A method that waits for a stretch is called at this share at the latest, as plain springs are not watched.
"""


class Opening:
    """The list of bonds whose force falls as they open, in a bar of n nodes with bonds of m lengths.

    Attributes
    ----------
    bundle : the arrays for the kernels; their unused rows are not touched. has_rates : whether strength depends on the
    strain rate somewhere.
    """

    def __init__(self, ranges: Sequence[Range], count: int, horizon: int) -> None:
        from dembound.kernels.tables import Softening

        opens = any(part.fracture.energy > 0.0 for part in ranges)
        self.has_rates = any(part.fracture.per_decade > 0.0 for part in ranges)
        most = count * (horizon + 1) if opens else 0
        part_of = np.zeros(count - 1, dtype=np.int64)
        for number, part in enumerate(ranges):
            part_of[part.planes] = number
        self.bundle: Softening = Softening(
            part=part_of,
            laws=np.array([_law(part) for part in ranges]),
            rise=RISE,
            **{name: np.zeros(most, dtype=np.int64) for name in COLUMNS[:3]},
            **{name: np.zeros(most) for name in COLUMNS[3:]},
            below=np.full((horizon + 1, count) if self.has_rates else (0, 0), -1),
            listed=np.zeros(1, dtype=np.int64),
        )

    def __len__(self) -> int:
        return int(self.bundle.listed[0])

    def __getitem__(self, name: str) -> np.ndarray:
        """A column of the list (see kernels.tables.Softening), without unused rows."""
        column: np.ndarray = getattr(self.bundle, name)[: len(self)]
        return column

    @property
    def left(self) -> np.ndarray:
        """Share of its strength, and of its fracture energy, that each bond has left: 1 − w/w_c."""
        apart = self["apart"]
        return np.maximum(0.0, apart - self["furthest"]) / np.abs(apart - self["limit"])

    def of(self, springs: np.ndarray, bonds: np.ndarray) -> np.ndarray:
        """The values of the bonds in the list, from arrays of springs (n − 1,) and bonds (m, n)."""
        row, first = self["row"], self["first"]
        values = np.empty(len(self), dtype=springs.dtype)
        values[row < 0] = springs[first[row < 0]]
        values[row >= 0] = bonds[row[row >= 0], first[row >= 0]]
        return values

    def put(self, values: np.ndarray, springs: np.ndarray, bonds: np.ndarray) -> None:
        """Write values of the bonds in the list to arrays of springs (n − 1,) and bonds (m, n)."""
        row, first = self["row"], self["first"]
        springs[first[row < 0]] = values[row < 0]
        bonds[row[row >= 0], first[row >= 0]] = values[row >= 0]

    def saved_arrays(self) -> dict[str, np.ndarray]:
        """All arrays that change during a run, by name."""
        return {f"opening_{name}": self[name] for name in COLUMNS} | {"opening_below": self.bundle.below}

    def restore(self, saved: Mapping[str, np.ndarray]) -> None:
        """Restore the arrays returned by `saved_arrays` for the same bar."""
        self.bundle.listed[0] = len(saved["opening_row"])
        for name in COLUMNS:
            self[name][:] = saved[f"opening_{name}"]
        self.bundle.below[...] = saved["opening_below"]


def _law(part: Range) -> list[float]:
    """A row of laws of tables.Softening."""
    strength, fracture = part.modulus * part.critical_stretch, part.fracture
    gain = fracture.per_decade / strength
    return [part.elongation, part.critical_stretch, fracture.opening(strength), gain, *fracture.rates]
