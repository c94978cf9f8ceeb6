"""Watches forces at rest at the sides of a body in which bonds break: they must not become a motor.

The ledger counts the work of these constant forces as supplied, so its error says nothing about them. They do work on
ground that moves with its side, as by waves. On disks that leave their side or turn there they would do work without
end, for which there is nothing in the ground beyond.

The work is measured side by side, against the mean motion of the side, and of all together, as far as it has neither
lifted weight nor strained the body.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from dembound.casefile.disks.static import keeps_forces
from dembound.disks.body import DiskBody
from dembound.disks.columns import COLUMNS
from dembound.disks.contacts.contact_list import ContactList
from dembound.disks.stepping.balance import Balance
from dembound.errors import RunError
from dembound.motion.state import Owner
from dembound.words import percent

WARNS, STOPS = 0.05, 0.5
"""Work of forces at rest, of a side or of all, over the larger of the supplied energy and that stored at rest, above
which a run is warned of, and stopped.

Level ground, canyons and valleys whose sides held had at most 0.018; a tunnel that closed under a stress at rest, which
does real work on it, 0.23. Scenes without intact zones had 0.014 to 0.64; those below WARNS are found by `ENDED`.
"""

ENDED = 0.1
"""Share of the forces at rest that acted on disks which have broken off, above which a run is warned of.

In ten scenes without intact zones it was 0.17 to 1, in those whose sides held 0, in a sample past its peak 0.06.
"""

TURNED = 0.01
"""Rotation (rad) of a disk that bears a force at rest, above which a run is warned of.

Sides that held, also beside landslides and faults that slip, had at most 0.0043; those that crept beside ground that
had broken up to their zones 0.018 and 0.03, after half a diameter to a diameter.
"""

COLUMN = "free-field column"
"""Name of the column among the places that cracks would have reached."""


class SideWatch(Owner):
    """Measures, when the ledger is written, what forces at rest do at the sides.

    Attributes
    ----------
    work : largest work so far, over the energy that came in until now, see `WARNS`, with its side and time. ended :
    share of forces on disks that have broken off. turn : largest rotation so far (rad), with its side and time.
    reached : by side, number of bonds of its intact zone that have reached their strength, and time (s) at which the
    first was found. sides : of the carriers of its `Balance`.
    """

    evolving = ("_work", "_turn", "_reached", "ended", "_energy")

    def __init__(self, scene: DiskBody, time_step: float) -> None:
        self._scene, self._time_step = scene, time_step
        self._work, self._turn = np.zeros(3), np.zeros(3)  # J or rad, number of the carrier, step
        self._energy = 1.0
        self.ended = 0.0
        self._places = [*scene.intact_zones, COLUMN]
        self._reached = np.full((len(self._places), 2), -1)  # count, step of the first
        self._reached[:, 0] = 0
        self.sides: list[str] = []
        case = scene.case  # on walls alone a body leaves nothing at its sides but what was not yet in balance
        self._bears = not case.wall or any(keeps_forces(case.static, side, case.side(side)) for side in scene.edges)

    def look(
        self,
        balance: Balance,
        contacts: Mapping[str, ContactList],
        displacement: np.ndarray,
        step: int,
        borne: float,
        energy: float,
    ) -> None:
        """Measure at displacements (3, n) of a step; borne and energy : J, see `System.look`.

        Raises RunError if forces at rest have done more than `STOPS` of the energy.
        """
        self.sides = balance.sides
        self._note_reached(contacts, step)
        self.ended = balance.share_of_ended() if self._bears else 0.0
        turn, at = balance.largest_turn(displacement) if self._bears else (0.0, 0)
        if turn > self._turn[0]:
            self._turn[:] = turn, at, step
        work = balance.relative_work(displacement)
        if energy <= 0.0 or len(work) == 0:
            return
        most = int(np.argmax(work))
        size = max(float(work[most]), balance.free_work(displacement) + borne)
        if size > self._work[0]:
            self._work[:] = size, most, step
        self._energy = energy
        if size > STOPS * energy:
            _, number, since = self._work
            raise RunError(
                f"boundary.{self.sides[int(number)]}: until t = {since * self._time_step:.4g} s forces at rest have "
                f"done work on disks that moved away from this side, or turned there, {percent(size / energy)} of the "
                "energy that came in or was stored at rest: the ground at this side has broken, and what the static "
                f"stage left there has become a motor; {CURE}"
            )

    def _note_reached(self, contacts: Mapping[str, ContactList], step: int) -> None:
        """Count the bonds of each zone that have reached their strength."""
        for part, pairs in contacts.items():
            first, second = pairs.reached()
            if len(first) == 0:
                continue
            for row, place in enumerate(self._places):
                if part in COLUMNS or place == COLUMN:
                    count = len(first) if part in COLUMNS and place == COLUMN else 0
                else:
                    zone = self._scene.intact_zones[place] - pairs.nodes.start
                    count = int(np.count_nonzero(np.isin(first, zone) | np.isin(second, zone)))
                if count > 0:
                    before = self._reached[row, 1]
                    self._reached[row] = count, step if before < 0 else before

    def describe(self) -> dict[str, Any]:
        """The findings as plain JSON values, for a summary; times in s."""
        each = zip(self._places, self._reached.tolist(), strict=True)
        reached = {at: {"bonds": n, "time": float(step * self._time_step)} for at, (n, step) in each if n > 0}
        work, turn = self._described(self._work, self._energy), self._described(self._turn)
        return {"work": work, "turn": turn, "ended": self.ended, "reached": reached}

    def _described(self, found: np.ndarray, unit: float = 1.0) -> dict[str, Any] | None:
        """Size over a unit, side and time of a finding; None for none."""
        size, at, step = found.tolist()
        if size <= 0.0:
            return None
        return {"size": size / unit, "side": self.sides[int(at)], "time": step * self._time_step}


CURE = (
    "keep cracks away from it, by intact = 2 or more or a larger body, or end the run sooner, a test of a sample by "
    'until = "peak"'
)
"""What to change where forces at rest have become a motor."""


def lasting_force_warnings(found: Mapping[str, Any] | None) -> Iterator[str]:
    """Warnings about forces at rest that have become a motor; found : of the summary, see `SideWatch.describe`."""
    if found is None:
        return
    work, turn = found["work"], found["turn"]
    if work is not None and work["size"] > WARNS:
        yield (
            f"boundary.{work['side']}: until t = {work['time']:.4g} s forces at rest have done "
            f"{percent(work['size'])} of the energy that came in or was stored at rest, on disks that moved away from "
            f"this side or turned there, as the ground there has broken; {CURE}"
        )
    if turn is not None and turn["size"] > TURNED:
        yield (
            f"boundary.{turn['side']}: a disk on which forces at rest act has turned by {turn['size']:.2g} rad by "
            f"t = {turn['time']:.4g} s: this side gives way, as the ground beside it has broken; {CURE}"
        )
    if found["ended"] > ENDED:
        yield (
            f"static: disks that bore {percent(found['ended'])} of the forces at rest have broken off; the others of "
            f"their sides bear these while half of a side is left; {CURE}"
        )


def reach_warnings(found: Mapping[str, Any] | None) -> Iterator[str]:
    """A warning about sides that cracks would have reached without their intact zone; found : as of the summary."""
    reached = {} if found is None else found["reached"]
    if not reached:
        return
    places = []
    for place, each in reached.items():
        where = place if place == COLUMN else f"{place} side"
        bonds = "1 bond" if each["bonds"] == 1 else f"{each['bonds']:,} bonds"
        places.append(f"the {where} (at least {bonds}, from t = {each['time']:.4g} s)")
    keys = " and ".join(f"boundary.{place}" for place in reached if place != COLUMN) or "boundary"
    yield (
        f"{keys}: cracks would have reached {', '.join(places)}, whose bonds do not break, as they stand for ground "
        "that goes on unbroken; take a larger packing.size"
    )
