"""The error of a run: what its sides, its grid and its time step add to the motion of its monitors."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from dembound.accuracy.cause import QUANTITIES, SIDES, Cause, Causes
from dembound.accuracy.history import Motions, loud
from dembound.accuracy.repeat import Repeat
from dembound.results.estimates import in_words, split_in_words


@dataclass(frozen=True)
class Estimate:
    """The error of a run.

    Attributes
    ----------
    recorded : monitor -> what the run has recorded, up to the time from which on nothing is estimated.
    causes : what contributes to the error.
    cpu_seconds : CPU time that it took, s. repeat : the run once more with a smaller time step, if that was asked for.
    """

    recorded: Motions
    causes: Causes
    cpu_seconds: float = 0.0
    repeat: Repeat | None = None

    def shares(self, monitor: str, quantity: str) -> dict[str, float]:
        """RMS errors over the RMS of the recorded values, by cause; only those that are known."""
        own = self.recorded[monitor]
        found = {cause.name: cause.share(monitor, quantity, own) for cause in self.causes.found}
        return {name: share for name, share in found.items() if math.isfinite(share)}

    def total(self, monitor: str, quantity: str) -> float:
        """RMS of all errors over that of the recorded values; nan if none is known.

        Histories add up, as those of the grid and of the time step have opposite signs; where only the size of an error
        is known, or it is one sample of a random error, squares do.
        """
        own = self.recorded[monitor]
        histories, sizes = self._errors(monitor, quantity)
        if not histories and not sizes:
            return math.nan
        together = Cause("", "", {monitor: {quantity: sum(histories, np.zeros_like(own.values[quantity]))}})
        return math.hypot(together.share(monitor, quantity, own), *sizes)

    def _errors(self, monitor: str, quantity: str) -> tuple[list[np.ndarray], list[float]]:
        """The errors of all causes: histories (k, c), and where only they are known sizes."""
        histories, sizes = [], []
        for cause in self.causes.found:
            error = cause.errors.get(monitor, {}).get(quantity, math.nan)
            if isinstance(error, float) or cause.is_sample:
                sizes.append(cause.share(monitor, quantity, self.recorded[monitor]))
            else:
                histories.append(error)
        return histories, [size for size in sizes if math.isfinite(size)]

    def quantities(self, monitor: str) -> list[str]:
        """Quantities of a monitor that has any."""
        return [name for name in QUANTITIES if name in self.recorded[monitor].values]

    def correction(self, monitor: str, quantity: str) -> np.ndarray | None:
        """What the sides add (k, c), to be subtracted; None if it is not known without echoes."""
        cause = next((cause for cause in self.causes.found if cause.name == SIDES), None)
        if cause is None or not self.causes.echo_free:
            return None
        error = cause.errors.get(monitor, {}).get(quantity)
        return error if isinstance(error, np.ndarray) else None

    def band(self, monitor: str, quantity: str) -> np.ndarray:
        """Half the width (k, c) of the band around the recorded values in which the exact ones are expected.

        The size of the sum of all errors at every time; of those of which only the size is known, this times the RMS.
        """
        values = self.recorded[monitor].values[quantity]
        histories, sizes = self._errors(monitor, quantity)
        usual = np.sqrt(np.mean(values**2, axis=0))
        return np.asarray(np.abs(sum(histories, np.zeros_like(values))) + sum(sizes) * usual)

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
            "repeat": None if self.repeat is None else self.repeat.summary(),
            "cost": self.causes.cost,
            "cpu_seconds": self.cpu_seconds,
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


@dataclass(frozen=True)
class Expected:
    """An expected error. worst : of all monitors that move, RMS over RMS; by : its causes at the worst monitor."""

    worst: float
    by: dict[str, float]


def expected(causes: Sequence[Cause], recorded: Motions) -> Expected:
    """The largest error of all recorded quantities at monitors that are not quiet, and its causes that are not zero."""
    estimate = Estimate(recorded, Causes(list(causes)))
    found = [
        (total, estimate.shares(name, quantity))
        for name in recorded
        for quantity in estimate.quantities(name)
        if name in loud(recorded, quantity) and np.isfinite(total := estimate.total(name, quantity))
    ]
    worst, by = max(found, key=lambda each: each[0], default=(0.0, {}))
    return Expected(worst, {name: share for name, share in by.items() if share > 0.0})
