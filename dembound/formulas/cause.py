"""Causes of the error of a run, each with its contribution to the motion at the monitors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from dembound.formulas.history import History, Motions
from dembound.results.compare import relative_error

SIDES, GRID, STEP, CONTINUUM, ENTRY, WALLS, NEAR = (
    *("sides", "grid", "time step", "continuum", "entry of the wave", "walls of holes", "near loads"),
)
"""Names of causes."""

USUAL = 1.4
"""Factor of formulas whose errors were at most 1.39 times as large in 100 scenes."""

MOTIONS = ("velocity", "displacement")
"""Quantities of disks."""

QUANTITIES = (*MOTIONS, "stress")
"""Quantities whose errors are estimated; stress of bars only."""

How = Literal["measured", "companion", "formula", "bound", "unknown"]
"""How an error is known: from the run itself, from companion runs, by a formula, its largest size only, or not at all.
"""

Truth = Literal["disks", "rock"]
"""Reference of an error: "disks", which are the material, so that only sides, steps and loads err; or "rock", which
the disks discretise."""

TITLES: dict[Truth, str] = {"disks": "of these disks", "rock": "of the rock"}
"""Truths in words."""

Parts = Mapping[str, Mapping[str, np.ndarray | float]]
"""Monitor -> quantity -> the part (k, c) of its motion that is due to a cause, or only its RMS over that of the motion.
"""


@dataclass(frozen=True)
class Cause:
    """One cause of errors.

    words : how its errors were found, or why they are not known. parts : contributions, see `Parts`; largest possible
    ones for a bound. of_disks : whether the cause is an error only relative to the rock, not where the disks are the
    material. factor : 95 % of true errors are at most this factor larger. is_sample : whether errors are one sample of
    a random error, of which only the RMS counts.
    """

    name: str
    words: str
    parts: Parts
    how: How = "formula"
    of_disks: bool = False
    factor: float = 1.0
    is_sample: bool = False

    @classmethod
    def unknown(cls, name: str, words: str, of_disks: bool = False) -> Cause:
        """A cause of which nothing is known."""
        return cls(name, words, {}, "unknown", of_disks)

    def counts(self, of: Truth) -> bool:
        """Whether the cause is an error relative to a truth, "disks" or "rock"."""
        return of == "rock" or not self.of_disks

    @property
    def largest(self) -> float:
        """The largest size over all monitors and quantities, for a cause without histories."""
        sizes = [size for each in self.parts.values() for size in each.values()]
        return max((size for size in sizes if isinstance(size, float)), default=0.0)

    def share(self, monitor: str, quantity: str, motion: History) -> float:
        """The relative error of the motion by the contribution, see `relative_error`; nan if unknown."""
        part = self.parts.get(monitor, {}).get(quantity, np.nan)
        return part if isinstance(part, float) else share_of(part, quantity, motion)


def share_of(part: np.ndarray, quantity: str, motion: History) -> float:
    """The relative error of the motion by a contribution (k, c), see `relative_error`; nan at rest."""
    column = motion.component(quantity)
    return relative_error(part[:, column], motion.values[quantity][:, column])


@dataclass(frozen=True)
class Causes:
    """Causes of errors with their notes.

    limits : a line for each part of the motion that is not covered, with the reason. notes : other lines. cost : work
    spent over the work of the run. echo_free : whether the cause `SIDES` is known without echoes of the larger run.
    motions : the motion without errors of sides, to which errors are relative; None: the recorded motion.
    """

    found: Sequence[Cause]
    limits: Sequence[str] = ()
    notes: Sequence[str] = ()
    cost: float = 0.0
    echo_free: bool = False
    motions: Motions | None = None

    def __add__(self, other: Causes) -> Causes:
        """The causes, limits and notes of both."""
        found, limits, notes = [*self.found, *other.found], [*self.limits, *other.limits], [*self.notes, *other.notes]
        motions = self.motions if other.motions is None else other.motions
        return Causes(found, limits, notes, self.cost + other.cost, self.echo_free or other.echo_free, motions)

    @property
    def unknown(self) -> list[Cause]:
        """The causes of which nothing is known."""
        return [cause for cause in self.found if cause.how == "unknown"]
