"""The motion in time of a column of layers under an incident wave, at any depths and times (exact/histories.py)."""

from collections.abc import Callable
from typing import Literal

import numpy as np

from dembound.exact.column import Column
from dembound.exact.histories import Histories

Quantity = Literal["displacement", "velocity", "gradient", "rate", "traction", "impulse", "relaxed", "relaxed_rate"]
"""u m, v m/s, ∂u/∂y, ∂v/∂y 1/s, with y upwards, and on planes facing up the traction, Pa, and its integral, Pa·s.

relaxed, relaxed_rate : u and v under which the unrelaxed springs of a layer have the forces of the damped ones."""

QUANTITIES: dict[Quantity, tuple[int, int]] = {
    "displacement": (0, 0),
    "velocity": (0, 1),
    "gradient": (1, 0),
    "rate": (1, 1),
    "traction": (2, 0),
    "impulse": (2, -1),
    "relaxed": (0, 0),
    "relaxed_rate": (0, 1),
}
"""Row of `Column.motion`, and number of derivatives in time."""


class ColumnMotion:
    """The motion of a column.

    Parameters
    ----------
    column : its layers. velocity : m/s at times in s, of the incident wave alone at a depth, m, in its half-space or
    continued from there; or if `within` of the column at this depth. begin : time (s) before which it is zero. until :
    last time (s); later ones double the window.
    """

    def __init__(
        self,
        column: Column,
        velocity: Callable[[np.ndarray], np.ndarray],
        depth: float,
        begin: float,
        until: float,
        within: bool = False,
    ) -> None:
        self._column, self._depth, self._within = column, depth, within
        self._histories = Histories(velocity, begin, until)

    def at(self, of: Quantity, times: np.ndarray, depths: tuple[float, ...], number: int | None = None) -> np.ndarray:
        """A quantity (k, d) at times (k,) s and depths (d,) m; number : of the layer, see `Column.motion`."""
        self._histories.reach(times)
        samples = self._histories.kept((of, depths, number), lambda: self._sampled(of, depths, number))
        return self._histories.between(samples, times)

    def _sampled(self, of: Quantity, depths: tuple[float, ...], number: int | None) -> np.ndarray:
        """A quantity (n, d) at all samples."""
        window, (row, derivatives) = self._histories.window, QUANTITIES[of]
        incident = window.derived(derivatives)
        if self._within:
            incident = incident / self._column.motion(window.frequencies, [self._depth])[0, 0]
        else:
            incident = incident / self._column.rising(window.frequencies, self._depth)
        found = []
        for depth in depths:
            own = self._column.motion(window.frequencies, [depth], number)[row, 0]
            if of in ("relaxed", "relaxed_rate") and number is not None:
                own = own * self._column.layers[number].relaxation(window.frequencies)
            found.append(window.sampled(incident * own))
        return np.stack(found, axis=1)
