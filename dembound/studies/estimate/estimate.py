"""The error of a run: what its sides, its grid and its time step add to the motion of its monitors."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from dembound.results.estimates import in_words, split_in_words
from dembound.studies.estimate.causes import GRID, QUANTITIES, SIDES, STEP, Cause, Causes, Recorded


@dataclass(frozen=True)
class Estimate:
    """The error of a run.

    Attributes
    ----------
    recorded : monitor -> what the run has recorded, up to the time from which on nothing is estimated.
    causes : what contributes to the error.
    """

    recorded: Mapping[str, Recorded]
    causes: Causes

    def shares(self, monitor: str, quantity: str) -> dict[str, float]:
        """RMS errors over the RMS of the recorded values, by cause; only those that are known."""
        own = self.recorded[monitor]
        found = {cause.name: cause.share(monitor, quantity, own) for cause in self.causes.found}
        return {name: share for name, share in found.items() if math.isfinite(share)}

    def total(self, monitor: str, quantity: str) -> float:
        """The root of the sum of their squares, grid and time step as one; nan if none is known.

        Larger steps make waves faster, and a coarser grid makes most of them slower: these errors cancel in part.
        """
        own, shares = self.recorded[monitor], self.shares(monitor, quantity)
        delays = [
            cause.errors[monitor][quantity] for cause in self.causes.found if cause.name in {GRID, STEP} & {*shares}
        ]
        if len(delays) == 2 and not any(isinstance(delay, float) for delay in delays):
            both = Cause(GRID, "", {monitor: {quantity: np.asarray(delays[0]) + np.asarray(delays[1])}})
            shares |= {GRID: both.share(monitor, quantity, own), STEP: 0.0}
        return math.sqrt(sum(share**2 for share in shares.values())) if shares else math.nan

    def quantities(self, monitor: str) -> list[str]:
        """Quantities of a monitor that has any."""
        return [name for name in QUANTITIES if name in self.recorded[monitor].values]

    @property
    def worst(self) -> float:
        """Largest total of velocities and displacements at all monitors; nan if nothing is known."""
        found = [self.total(name, quantity) for name in self.recorded for quantity in self.quantities(name)]
        known = [share for share in found if math.isfinite(share)]
        return max(known, default=math.nan)

    def correction(self, monitor: str, quantity: str) -> np.ndarray | None:
        """What the sides add (k, c), to be subtracted; None if it is not known without echoes."""
        cause = next((cause for cause in self.causes.found if cause.name == SIDES), None)
        if cause is None or not self.causes.echo_free:
            return None
        error = cause.errors.get(monitor, {}).get(quantity)
        return error if isinstance(error, np.ndarray) else None

    def band(self, monitor: str, quantity: str) -> np.ndarray:
        """Half the width (k, c) of the band around the recorded values in which the exact ones are expected.

        The sum of the sizes of all errors at every time; of those of which only the size is known, this times the RMS.
        """
        values = self.recorded[monitor].values[quantity]
        wide = np.zeros_like(values)
        for cause in self.causes.found:
            error = cause.errors.get(monitor, {}).get(quantity, 0.0)
            if isinstance(error, float):
                error = np.full_like(values, error) * np.sqrt(np.mean(values**2, axis=0))
            wide += np.abs(error)
        return wide

    def summary(self) -> dict[str, Any]:
        """Plain JSON values: shares by monitor, quantity and cause, and how they were found."""
        monitors = {
            name: {
                quantity: {"total": self.total(name, quantity), **self.shares(name, quantity)}
                for quantity in self.quantities(name)
                if math.isfinite(self.total(name, quantity))
            }
            for name in self.recorded
        }
        how = {cause.name: cause.words for cause in self.causes.found}
        return {
            "monitors": monitors,
            "found": how,
            "not_estimated": list(self.causes.missing),
            "notes": list(self.causes.notes),
            "cost": self.causes.cost,
        }

    def lines(self) -> list[str]:
        """A line for each monitor, then how the errors were found."""
        found = []
        without = ", in part" if self.causes.missing else ""
        for name in self.recorded:
            parts = [
                f"{quantity} {in_words(self.total(name, quantity))} ({split_in_words(self.shares(name, quantity))})"
                for quantity in self.quantities(name)
                if math.isfinite(self.total(name, quantity))
            ]
            if parts:
                found.append(f"error at {name}{without}: {'; '.join(parts)}")
        return [*found, *self._how(), *self.causes.notes, *(f"not estimated: {line}" for line in self.causes.missing)]

    def _how(self) -> list[str]:
        """How the errors were found, causes found alike together."""
        ways: dict[str, list[str]] = {}
        for cause in self.causes.found:
            ways.setdefault(cause.words, []).append(cause.name)
        return [f"{' and '.join(names)} {words}" for words, names in ways.items()]
