"""What files of laws are written with: constants of pairs by name, and formulas for one pair or eight.

Only numpy is imported here, so that case files are read without the compiler; kernels/pair_law.py compiles the
functions of laws, and kernels/compiler/ those of this module, for numbers and for lanes.

A row of constants of a pair with first disk i and second disk j has its place, then what its law declares (`COLUMNS`).
Rows of a scene end with the strain from the start (kernels/compiler/start_strain.py) and, in layers, limits.
"""

from collections import namedtuple
from collections.abc import Callable
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
    numbers: list[Any] = [np.uint64(number) for number in range(len(columns))]
    return namedtuple("K", [each.name for each in columns])(*numbers)


P = index(PLACE)
"""Numbers of the columns of a pair's place."""


def of_law(rows: np.ndarray) -> np.ndarray:
    """Place and constants of the law (p, c), in rows (p, c + 3) that end with the strain from the start."""
    return np.ascontiguousarray(rows[:, :-STRAIN])


def choose(chosen: np.ndarray, values: np.ndarray, others: np.ndarray) -> np.ndarray:
    """Values where chosen, else the others."""
    return np.where(chosen, values, others)


def at_most(values: np.ndarray, limits: np.ndarray) -> np.ndarray:
    """Mask of values that are not above limits."""
    return values <= limits


def larger(values: np.ndarray, others: np.ndarray) -> np.ndarray:
    """The larger of two numbers in each lane."""
    return np.where(values <= others, others, values)


def magnitude(values: np.ndarray) -> np.ndarray:
    """Absolute values."""
    return np.abs(values)


def with_sign(values: np.ndarray, signs: np.ndarray) -> np.ndarray:
    """Magnitudes of values with the signs of others."""
    return np.copysign(values, signs)


def root(values: np.ndarray) -> np.ndarray:
    """Square roots."""
    return np.sqrt(values)


def limit_of(limit: Any, contact_type: Any) -> Any:
    """One of the limits for a type of contact: a number for all types, or its row of a column (p,).

    Compiled code for numbers is the number itself.
    """
    return limit if isinstance(limit, float) else limit[contact_type]


def _slips_by_overlap(limits):
    return False


def _slip_after(limits, constants, k, before, now, shear, slip):
    return slip


def _rubbed(limits, constants, k, before, now, was, shear, slip, slid, force, pushed):
    return 0.5 * (force + pushed) * (slid - slip)


def _viscosity(limits, constants, k, overlap):
    return 1.0


def _rolls(limits):
    return False


def _rolling(limits, constants, k):
    return 0.0, 0.0


def _most_moment(limits, kind, radius, push):
    return 0.0 * push


def _contact_room(limits, constants, k, kind, overlap, stuck):
    return 0.0 * overlap


def _bond(limits, constants, k, stretch, shear, turn):
    return 0.0 * stretch, 0.0 * shear, 0.0 * turn


def _breaks(limits, constants, k, kind, factor, pull, side, moment):
    return at_most(1.0, 0.0 * pull), at_most(1.0, 0.0 * side)


def _bond_energy(limits, constants, k, stretch, shear, turn):
    return 0.0


def _bond_room(limits, constants, k, kind, factor, stretch, shear, turn):
    return np.inf


DEFAULTS: dict[str, Callable[..., Any]] = {
    "slips_by_overlap": _slips_by_overlap,
    "slip_after": _slip_after,
    "rubbed": _rubbed,
    "viscosity": _viscosity,
    "rolls": _rolls,
    "rolling": _rolling,
    "most_moment": _most_moment,
    "contact_room": _contact_room,
    "bond": _bond,
    "breaks": _breaks,
    "bond_energy": _bond_energy,
    "bond_room": _bond_room,
}
"""Functions that a law may leave out.

They are those of contacts whose stiffness in shear and viscosity do not depend on the overlap, that do not resist
rolling, without bonds, and under a law that does not begin elastic.
"""


PAIR_LAWS: dict[type, dict[str, Callable[..., Any]]] = {}
"""Type of the limits of a law -> its functions, by the names in kernels/pair_law.py."""


def is_pair_law(limits: type, **functions: Callable[..., Any]) -> None:
    """Register the functions of a law, each explained at the one of its name in kernels/pair_law.py.

    limits : the type, a named tuple, of the limits of its contacts and bonds. They are written once, for numbers of one
    pair and for lanes of eight, with `choose`, `at_most`, `larger`, `magnitude`, `with_sign` and `root` in place of
    conditions.
    """
    PAIR_LAWS[limits] = DEFAULTS | functions
    for compiled in COMPILERS:
        compiled(limits, PAIR_LAWS[limits])


COMPILERS: list[Callable[[type, dict[str, Callable[..., Any]]], None]] = []
"""What compiles the functions of laws, once that has been imported."""
