"""How far bonds turn whose law keeps their directions of the start: the elastic law, or the geometry of the start.

Such a bond between disks i and j at x_j − x_i = d has its forces along d and across it, from u_j − u_i and the
rotations, to first order. A body that turns freely by θ moves by u = θ ẑ × x without any force, and so grows from x to
|x + θ ẑ × x| = √(1 + θ²) |x|. The turn of a bond is this θ, (d × (u_j − u_i))/|d|², which is the tangent of the angle
between its directions now and at the start where nothing stretches it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from dembound.casefile.disks.material import with_history
from dembound.disks.contacts.forces import PIECE, acting
from dembound.disks.stepping.system import DiskSystem
from dembound.kernels.contacts import BONDED, INTACT
from dembound.motion.state import Arrays
from dembound.motion.trackers import Every, Run
from dembound.words import percent

STEPS = 1024
"""Steps between two looks, which take less time than one step: a multiple of those at which the loop returns anyway."""

WARNS = 0.1
"""Turn (rad) of a bond above which a run is warned of: a body then grows by 0.5 %, and held from that bears a stress of
0.005 ρc².
"""


class Turns(Every):
    """Finds the largest turn of a bond.

    Attributes
    ----------
    found : largest turn (rad), its step and its place x, y (m).
    """

    name = "turns"

    def __init__(self) -> None:
        super().__init__(STEPS)
        self.found = np.zeros(4)

    def see(self, run: Run) -> None:
        """Measure all bonds and contacts that act and keep their directions."""
        system, u = run.system, run.state.u
        assert isinstance(system, DiskSystem)
        for part in system.disks.parts:
            pairs, geometry = part.pairs, part.geometry
            kept = np.flatnonzero(pairs.state == INTACT if geometry == BONDED else acting(pairs, geometry))
            for begin in range(0, len(kept), PIECE):
                some = kept[begin : begin + PIECE]
                first, second = pairs.first[some], pairs.second[some]
                x, y = pairs.constants[pairs.contact_type[some], :2].T
                turn = np.abs(x * (u[1, second] - u[1, first]) - y * (u[0, second] - u[0, first])) / (x * x + y * y)
                if turn[most := int(np.argmax(turn))] > self.found[0]:
                    place = run.scene.positions[run.scene.layout.node[first[most]]] + 0.5 * np.array([x[most], y[most]])
                    self.found[:] = turn[most], run.state.step, *place

    def describe(self, run: Run) -> dict[str, Any]:
        """Largest turn (rad) until now, its time (s) and its place (m), as plain JSON values for a summary."""
        self.see(run)
        turn, step, *place = self.found.tolist()
        return {"turn": turn, "time": step * run.time_step, "position": place}

    def saved_arrays(self) -> Arrays:
        """The largest turn found so far, and the next step."""
        return {**super().saved_arrays(), "found": self.found}

    def restore(self, saved: Arrays) -> None:
        """Restore the arrays returned by `saved_arrays` in another run of the same case."""
        super().restore(saved)
        self.found = saved["found"].copy()


def turn_warnings(found: Mapping[str, Any] | None, law: str, *, has_history: bool) -> Iterator[str]:
    """A warning about bonds that have turned too far; found : of the summary, law : of the material."""
    if found is None or found["turn"] <= WARNS:
        return
    where, cure = f'law: is "{law}"', f'law = {with_history()}, whose geometry = "updated" turns'
    if has_history:
        where, cure = 'geometry: is "reference"', '"updated", which turns'
    x, y = found["position"]
    grown = percent(math.hypot(1.0, found["turn"]) - 1.0)
    yield (
        f"material.{where}, so bonds keep their directions of the start, but by t = {found['time']:.4g} s one near "
        f"({x:.4g}, {y:.4g}) m has turned by {found['turn']:.3g} rad: a body that turns so grows by {grown}; take "
        f"{cure} with the motion"
    )
