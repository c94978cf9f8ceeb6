"""Loading of a body in a static stage whose contacts may slide and open and whose bonds may break.

Where the elastic state is within all limits it is the result, and is reached without slip: the body settles under the
elastic law, in which the path to rest has no effect. If a contact or bond is beyond its limits there, the body follows
the elastic path up to the first one that reaches them, and goes on from there under its own law, while the remaining
unbalanced forces are applied slowly and in proportion. Applied at once, they would send waves through the body, and
where these meet contacts would slide that are far from sliding at rest.
"""

from __future__ import annotations

import math

import numpy as np

from dembound.disks.material.packing_waves import slowest_speed
from dembound.disks.rest.static_scene import StaticScene
from dembound.disks.scene import DiskScene
from dembound.disks.stepping.system import DiskSystem
from dembound.errors import CaseError
from dembound.kernels.contact_measures import slack
from dembound.motion.state import Owner, State

LOOK = 100
"""Steps between two increments of slowly applied loads, and between two evaluations of the force ratio."""

CROSSINGS = 3.0
"""Time in which all loads are applied, over that in which the slowest waves cross a body along x and then along y.

Slip where all contacts slide alike (square lattice, 96 disks wide, friction 0.3): the stress in blocks of eleven
diameters differs by 2.2, 0.34, 0.20, 0.19 % for 0, 1, 3 and 8 of them."""

LEAST = 20
"""Least number of increments in which all loads are applied."""

HALVINGS = 12
"""Number of bisections by which the first limit on the elastic path is located."""


class Loading(Owner):
    """Applies the loads of a static stage.

    Parameters
    ----------
    body : the scene that settles.
    system : its parts, which have begun: under the elastic law, or, if their contacts have a history, under their own.
    start : (3, n) displacements at which they have begun.
    step : s.
    """

    evolving = ("_lacking", "_begun", "_steps")

    def __init__(self, body: StaticScene, system: DiskSystem, start: np.ndarray, step: float) -> None:
        self._body, self._system, self._start = body, system, start
        self._longest = max(LEAST, CROSSINGS * _crossing(body.scene) / step / LOOK)
        self._lacking, self._begun, self._steps = np.zeros_like(start), 0, 0
        if system.uses_history:
            lacking = self._out_of_balance()
            if body.force_ratio(system, lacking - system.load, system.contacts) > body.static.enough(slides=True):
                self._raise_from(lacking, 1.0, 0)

    def is_rising(self, step: int) -> bool:
        """Whether a part of the loads is not applied yet after this number of steps."""
        return step < self._begun + self._steps

    def put_on(self, state: State) -> None:
        """Apply the loads of the present step."""
        load = self._load(state.displacement)
        if self.is_rising(state.step):
            load = load - (1.0 - (state.step - self._begun) / self._steps) * self._lacking
        self._system.apply(load)

    def is_the_answer(self, state: State) -> bool:
        """Whether the state of rest is that of the body's own law; if not, set the body to go on under that.

        False for a state of the elastic law with contacts or bonds beyond their limits. Without `elastic_start`
        the body's own law takes over in any case.
        """
        if self._system.uses_history or not self._body.scene.has_history:
            return True
        share = self._share_within(state.displacement)
        if share == 1.0 and self._body.scene.case.material.elastic_start:
            return True
        self._go_on_from(share, state)
        return False

    def give_up_elastic_law(self, state: State) -> bool:
        """Go on from the start under the body's own law where the elastic one finds no rest; returns whether it did.

        Parts of a body may be held by contacts alone that close once they move.
        """
        if self._system.uses_history or not self._body.scene.has_history:
            return False
        self._go_on_from(0.0, state)
        return True

    def _go_on_from(self, share: float, state: State) -> None:
        """Leave the elastic law at a share of its path to rest."""
        lacking = (1.0 - share) * self._out_of_balance()
        state.displacement = self._start + share * (state.displacement - self._start)
        state.velocity = np.zeros_like(state.displacement)
        self._system.switch(state)
        self._raise_from(lacking, 1.0 - share, state.step)

    def _raise_from(self, lacking: np.ndarray, share: float, step: int) -> None:
        """Apply forces (3, n) from a step on, in a share of the time for all."""
        self._lacking, self._begun = lacking, step
        self._steps = LOOK * math.ceil(min(share, 1.0) * self._longest)

    def _out_of_balance(self) -> np.ndarray:
        """Sum (3, n) of all forces at the start, N and N·m."""
        system, start = self._system, self._start
        if system.uses_history:
            for pairs in system.contacts.values():
                pairs.push(start)
            inner, load = system.forces.last(system.contacts), self._load(start)
        else:
            inner, load = system.forces.elastic(start), system.steady if system.steady.size else system.load
        return load + inner + system.forces.of_ties(start) + system.forces.of_joints(start)

    def _load(self, displacement: np.ndarray) -> np.ndarray:
        """All loads (3, n) at displacements (3, n); they rotate with sides only under a law of updated geometry."""
        return self._body.load(displacement if self._system.uses_history else np.zeros_like(displacement))

    def _share_within(self, rest: np.ndarray) -> float:
        """The largest share, up to 1, of the path (3, n) from the start to rest within the limits of the elastic law.

        All limits are convex, so a state between two states within them is within them, too.
        """
        way, low, high = rest - self._start, 0.0, 1.0
        if self._is_within(rest):
            return 1.0
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if self._is_within(self._start + middle * way) else (low, middle)
        return low

    def _is_within(self, displacement: np.ndarray) -> bool:
        """Whether no contact has opened, closed or slid and no bond broken at displacements (3, n)."""
        for pairs in self._system.contacts.values():
            if pairs.is_old(pairs.spread(displacement)):
                pairs.search(displacement)
            if slack(pairs.spread(displacement), pairs.arrays, pairs.limits, False) < 0.0:
                return False
        return True


def _crossing(scene: DiskScene) -> float:
    """Time (s) in which the slowest waves cross a body along x and then along y; 0 if no wave runs."""
    try:
        speed = slowest_speed(scene.ground)
    except CaseError:  # disks that only touch, without friction, have no stiffness against some motion
        return 0.0
    return float(scene.size.sum()) / speed if speed > 0.0 else 0.0
