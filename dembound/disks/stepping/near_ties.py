"""Cracks, open contacts and slip near the ties to a continuum, which stays elastic.

Beyond its sides the ground has the stiffness of the body as built, so breaks, opening and slip right beside them
differ from those of a larger body.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from dembound.boundaries.edge import SIDES
from dembound.disks.body import DiskBody
from dembound.disks.contacts.contact_list import ContactList
from dembound.kernels.compiler.start_strain import began_with
from dembound.kernels.contacts import BONDED, INTACT
from dembound.kernels.tables import Contacts
from dembound.laws.law import K
from dembound.motion.state import Arrays, Owner, State

TIE_DISTANCE = 2.0
"""Largest distance, in mean diameters, between the centres of a tied disk and of one that counts as near it."""

ROUNDING = 1e-9
"""Part of a distance by which it may be longer."""

LOST = 1e-3
"""Share of force that a contact must have lost to count as open or as having slid: of the largest force of all pairs,
or of the expected force of waves and loads.

Where nothing presses contacts together, the smallest forerunner of a wave opens them."""


OPENED = "opened_or_slid"
"""Key of a side in the summary."""


def sides_near(scene: DiskBody) -> np.ndarray:
    """Number in `SIDES` of the side of the nearest tied disk, for each disk (n,) that is near one; else −1."""
    from scipy.spatial import cKDTree

    assert scene.outside is not None
    tied = [(SIDES.index(side), disks) for side, disks in scene.outside.tied_by_side.items() if side in SIDES]
    side = np.concatenate([np.full(len(disks), number) for number, disks in tied])
    positions = scene.assembly.positions
    tree = cKDTree(positions[np.concatenate([disks for _, disks in tied])])
    reach = TIE_DISTANCE * (1.0 + ROUNDING) * scene.ground.brick.mean_diameter
    _, nearest = tree.query(positions, distance_upper_bound=reach)
    # the number of all tied disks where none is in reach
    return np.asarray(np.append(side, -1)[nearest])


def strongest_force(scene: DiskBody) -> float:
    """Force (N per metre) on a disk by waves and loads of a case at their peaks: ρ c_p D v, or the load's force."""
    case, ground = scene.case, scene.ground
    diameter = ground.brick.mean_diameter
    speed = max(ground.wave_speeds(axis)[0] for axis in (0, 1))
    peak = sum(case.wave[name].peak() for name in sorted(case.entering))
    forces = [ground.density * speed * diameter * peak]
    for load in case.load:
        times = 1.0 if load.wave is None else case.wave[load.wave].peak()
        if load.pressure is not None:
            forces.append(abs(load.pressure) * times * diameter)
        elif load.force is not None:
            width = diameter if load.region is None else max(load.region[2] - load.region[0], diameter)
            forces.append(float(np.hypot(*load.vector)) * times * diameter / width)
    return max(forces)


class NearTies(Owner):
    """Looks for contacts near ties that have opened or slid, at steps at which the loop returns.

    A contact that slides, or opens under shear, keeps its slip, so it is found then. One that opens without any shear
    is found if it is open at such a step.

    Parameters
    ----------
    scene : disks with a continuum. contacts : the pairs of the body.

    Attributes
    ----------
    step : (4,) at which it was first found near each of `SIDES`, −1 for not yet; place : (4, 2) m, the middle of the
    pair that was then the farthest from its elastic state, as built.
    """

    evolving = ("_slip", "step", "place")

    def __init__(self, scene: DiskBody, contacts: ContactList) -> None:
        assembly, constants = contacts.assembly, contacts.bonds[contacts.kind]
        near = sides_near(scene)[contacts.nodes][assembly.pairs].max(axis=1)
        closed = (constants[:, K.touch] >= constants[:, K.rest]) & (constants[:, K.kn] > 0.0)
        watched = np.flatnonzero(closed & (near >= 0))
        self._side = near[watched]
        self._pairs, self._vectors = assembly.pairs[watched].astype(np.int64), constants[watched, :2]
        self._middles = assembly.positions[self._pairs[:, 0]] + 0.5 * self._vectors
        self._slip = np.zeros(len(watched))
        self._strongest = strongest_force(scene)
        self._found: tuple[Contacts, np.ndarray, np.ndarray] | None = None
        self.step, self.place = np.full(len(SIDES), -1), np.zeros((len(SIDES), 2))

    def begin(self, contacts: ContactList) -> None:
        """Count slip from now on."""
        at, _ = self._places(contacts)
        self._slip = contacts.arrays.slip[at]

    def look(self, state: State, contacts: ContactList) -> None:
        """Note contacts that have opened or slid."""
        sides = [side for side in np.unique(self._side) if self.step[side] < 0]
        if not sides:
            return
        lost = self._lost_forces(state.u, contacts)
        enough = LOST * max(float(np.abs(contacts.arrays.force[:2]).max()), self._strongest)
        for side in sides:
            own = np.flatnonzero((self._side == side) & (lost > enough))
            if len(own) > 0:
                self.step[side], self.place[side] = state.step, self._middles[own[np.argmax(lost[own])]]

    def _lost_forces(self, u: np.ndarray, contacts: ContactList) -> np.ndarray:
        """Force (w,) N per metre by which each watched contact differs from one that neither opens nor slides."""
        arrays = contacts.arrays
        at, listed = self._places(contacts)
        rows = arrays.constants[arrays.contact_type[at]]
        x, y, rest, touch, normal, shear = (rows[:, each] for each in (K.x, K.y, K.rest, K.touch, K.kn, K.ks))
        dx, dy = u[:2, arrays.second[at]] - u[:2, arrays.first[at]]
        stretch = ((2.0 * x + dx) * dx + (2.0 * y + dy) * dy) / (np.hypot(x + dx, y + dy) + rest)
        if contacts.limits.geometry == BONDED:
            stretch = np.where(arrays.state[at] == INTACT, (x * dx + y * dy) / rest, stretch)
        gap = np.maximum(stretch + began_with(arrays.began, arrays.contact_type[at], 0) + rest - touch, 0.0)
        lost = np.maximum(normal * gap, shear * np.abs(arrays.slip[at] - self._slip))
        return np.where(listed, lost, np.inf)  # others are so far apart that they are no longer listed

    def _places(self, contacts: ContactList) -> tuple[np.ndarray, np.ndarray]:
        """Places (w,) of the watched pairs in the arrays of the pairs, and whether they are listed (w,) bool."""
        if self._found is None or self._found[0] is not contacts.arrays:
            listed, at = contacts.find(self._pairs[:, 0], self._pairs[:, 1], self._vectors)
            self._found = contacts.arrays, contacts.live[at], listed
        return self._found[1:]

    def describe(self, side: str, time_step: float) -> dict[str, Any] | None:
        """Time (s) and place (m) of the first opening or slip near the ties of a side, for a summary; None for none."""
        number = SIDES.index(side)
        if self.step[number] < 0:
            return None
        return {"time": float(self.step[number] * time_step), "position": self.place[number].tolist()}


def near_tie_warnings(scene: DiskBody, summary: Mapping[str, Any], cracks: Arrays) -> Iterator[str]:
    """A warning for each side near whose ties a bond has broken or a contact has opened or slid, whichever was first.

    summary : of the run; cracks : time (k,) s, position (k, 2) m and particles (k, 2) from its record.
    """
    if scene.outside is None or not scene.has_history:
        return
    near = sides_near(scene)[cracks["particles"]].max(axis=1, initial=-1)
    for side in scene.outside.sides:
        broken = np.flatnonzero(near == SIDES.index(side))
        events = []
        if (found := summary["boundaries"][side][OPENED]) is not None:
            events.append((found["time"], found["position"], "contacts opened or slid by"))
        if len(broken) > 0:
            first = broken[np.argmin(cracks["time"][broken])]
            count = "a bond" if len(broken) == 1 else f"the first of {len(broken):,} bonds"
            events.append((float(cracks["time"][first]), cracks["position"][first], f"{count} broke at"))
        if events:
            time, (x, y), what = min(events, key=lambda event: event[0])
            yield (
                f"boundary.{side}: {what} t = {time:.4g} s near ({x:.4g}, {y:.4g}) m, within {TIE_DISTANCE:g} "
                "diameters of the ties to the continuum, which stays elastic; take a larger packing.size"
            )
