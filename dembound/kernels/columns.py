"""Columns of the constants of pairs by name, as kernels and numpy address them: `constants[k, K.kn]`.

A row of constants of a pair with first disk i and second disk j has its place, then what its law declares, see
laws/. Rows of a scene end with the strain from the start (compiler/start_strain.py) and, in layers, limits.
"""

from typing import Any, NamedTuple

import numpy as np


class Column(NamedTuple):
    """A constant of pairs: its name, unit and meaning, and by how much it is multiplied in half a pair.

    Pairs between disks on a straight side have half the stiffness, and half the area, so that stresses do not change.
    """

    name: str
    unit: str
    means: str
    in_half: float = 1.0


PLACE = (
    Column("x", "m", "from the centre of i to that of j at the start, along x"),
    Column("y", "m", "the same along y"),
    Column("rest", "m", "distance of the centres at the start"),
    Column("touch", "m", "distance at which the contact begins to act"),
    Column("offset", "m", "(R_i − R_j)/2, by which the arm of i exceeds half the distance"),
)
"""Where a pair is at the start; the first columns under all laws."""

STRAIN = 3
"""Columns of stretch and shear (m) and rotation that pairs have from the start, after those of the law."""


def index(columns: tuple[Column, ...]) -> Any:
    """Numbers of columns by name, in a named tuple that compiled code takes for constants."""
    from collections import namedtuple

    numbers: list[Any] = [np.uint64(number) for number in range(len(columns))]
    return namedtuple("K", [each.name for each in columns])(*numbers)


P = index(PLACE)
"""Numbers of the columns of a pair's place."""


def of_law(rows: np.ndarray) -> np.ndarray:
    """Place and constants of the law (p, c), in rows (p, c + 3) that end with the strain from the start."""
    return np.ascontiguousarray(rows[:, :-STRAIN])
