"""Arrays of the sides of a body, whose forces and work are recorded."""

from typing import NamedTuple

import numpy as np


class Sides(NamedTuple):
    """Forces on s sides of a body in b batches of e elements, and their m members; see kernels/sides.py.

    A batch has elements of one kind on one component, of one side. kind, side, component, signal : (b,), signal the
    column of signals (steps, q) of its incident wave or power, −1 for none. leaves : (b,) bool, whether energy that
    does not come in by its forces counts as absorbed.
    start : (b + 1,) elements of each batch in line (e,), the line of each in the support table; constant (e,), by kind:
    N of forces needed over those of the nodes stepped; N·s/m of dashpots, twice; N/m of springs, from rest 0; N per
    unit of signal; N of ties over those on the nodes stepped; follow (e,) N·s/m; column (e,) of the signals of drives.
    member_start : (s + 1,) members of each side in member (m,), nodes; weight (m,) of their displacements in the mean.
    offset : (s, 2) N, added to the force on each side. bearer_start : (s + 1,) nodes of each side in bearer (q,) whose
    steady forces are added too, times share (2, q); none if these do not change.
    borne : (k, 3) N on the lines of the support table by springs on relative motion, see `Bearings`.
    record : (rows, s, 5) mean displacement, m and rad, and force, N, at the start of each `every`-th step, of which
    `first` came before; every is 0 where nothing is recorded. work : (2, s, 2) J that came in and were absorbed,
    without springs; row 0 up to the half step reached, row 1 up to the last whole step, after the last step of a call.
    """

    kind: np.ndarray
    side: np.ndarray
    component: np.ndarray
    signal: np.ndarray
    leaves: np.ndarray
    signals: np.ndarray
    start: np.ndarray
    line: np.ndarray
    constant: np.ndarray
    follow: np.ndarray
    column: np.ndarray
    member_start: np.ndarray
    member: np.ndarray
    weight: np.ndarray
    offset: np.ndarray
    bearer_start: np.ndarray
    bearer: np.ndarray
    share: np.ndarray
    borne: np.ndarray
    every: int
    first: int
    record: np.ndarray
    work: np.ndarray

    @classmethod
    def none(cls) -> "Sides":
        """A table without sides."""
        number, value = np.zeros(0, dtype=np.int64), np.zeros(0)
        return cls(
            kind=number,
            side=number,
            component=number,
            signal=number,
            leaves=np.zeros(0, dtype=np.bool_),
            signals=np.zeros((0, 0)),
            start=np.zeros(1, dtype=np.int64),
            line=number,
            constant=value,
            follow=value,
            column=number,
            member_start=np.zeros(1, dtype=np.int64),
            member=number,
            weight=value,
            offset=np.zeros((0, 2)),
            bearer_start=np.zeros(1, dtype=np.int64),
            bearer=number,
            share=np.zeros((2, 0)),
            borne=np.zeros((0, 3)),
            every=0,
            first=0,
            record=np.zeros((0, 0, 5)),
            work=np.zeros((2, 0, 2)),
        )


NO_SIDES = Sides.none()
"""Table for runs in which sides are not recorded."""
