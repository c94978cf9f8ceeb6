"""The error of a motion: each cause's contribution at every monitor, and the total, relative to disks or rock."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from dembound.accuracy.repeat import Repeat
from dembound.formulas.cause import QUANTITIES, SIDES, TITLES, Cause, Causes, Truth, share_of
from dembound.formulas.history import Motions, loud
from dembound.results.histories import in_words, split_in_words
from dembound.words import percent

SHOWN = 8
"""Number of monitors whose names Python displays."""


@dataclass(frozen=True)
class Share:
    """An error, RMS over RMS, see `dembound.results.compare`.

    value : expected error; upper : error with 95 % factors of causes and with causes of which only a bound is known.
    at_least : whether a cause is unknown.
    """

    value: float
    upper: float
    at_least: bool = False

    @property
    def is_known(self) -> bool:
        """Whether the expected error or an upper value is known."""
        return math.isfinite(self.upper)

    @property
    def expected(self) -> str:
        """The expected error as text, with >= where a cause is unknown, and ? where nothing but that is known."""
        if not self.at_least:
            return in_words(self.value)
        return f">= {percent(self.value)}" if self.value > 0.0 else "?"

    @property
    def most(self) -> str:
        """The largest possible error as text, ? where a cause is unknown."""
        return "?" if self.at_least else in_words(self.upper)

    def __str__(self) -> str:
        if not self.is_known:
            return "unknown"
        return f"{self.expected}, at most {self.most}"


@dataclass(frozen=True, repr=False)
class Worst:
    """The largest error over all monitors whose motion is not negligible; printed as one line of text.

    by : nonzero shares by cause.
    """

    share: Share
    monitor: str = ""
    quantity: str = ""
    by: Mapping[str, float] = field(default_factory=dict)

    def __repr__(self) -> str:
        where = f" of the {self.quantity} at {self.monitor}" if self.monitor else ""
        return f"{self.share}{where}{f' ({split_in_words(self.by)})' if self.by else ''}"


@dataclass(frozen=True, repr=False)
class Budget:
    """The error of a motion at its monitors, relative to the disks as the material or to the rock.

    Where a function is given no truth, `of` applies: "disks" where packings are random or bonds may break, else "rock".

    Attributes
    ----------
    motions : histories by monitor, cut where errors are no longer known.
    causes : contributions to the error.
    of : truth ("disks" or "rock") that applies where none is given.
    cpu_seconds : CPU time of the estimate, s. repeat : the run repeated with a smaller time step, if requested.
    """

    motions: Motions
    causes: Causes
    of: Truth = "rock"
    cpu_seconds: float = 0.0
    repeat: Repeat | None = None

    def __repr__(self) -> str:
        names = [*list(self.motions)[:SHOWN], *["…"] * (len(self.motions) > SHOWN)]
        worst = f"{self.worst()}; monitors: {', '.join(names)}" if names else "no monitor with known errors"
        return f"<Budget, errors {TITLES[self.of]}: {worst}>"

    def shares(self, monitor: str, quantity: str, of: Truth | None = None) -> dict[str, float]:
        """RMS errors over the RMS of the motion, by cause, without unknown causes."""
        own, counted = self.motions[monitor], [cause for cause in self.causes.found if cause.counts(of or self.of)]
        found = {cause.name: cause.share(monitor, quantity, own) for cause in counted}
        return {name: share for name, share in found.items() if math.isfinite(share)}

    def total(self, monitor: str, quantity: str, of: Truth | None = None) -> Share:
        """The error by all causes; nan if none is known.

        Error histories are added, as errors of grid and time step have opposite signs. Squares are added where only the
        size of an error is known or where it is a random sample. The upper value adds the root of the sum of squares of
        bounds and of the excess, factor − 1 times the error, of each group of causes found in the same way.
        """
        counted = [cause for cause in self.causes.found if cause.counts(of or self.of)]
        known = [cause for cause in counted if math.isfinite(cause.share(monitor, quantity, self.motions[monitor]))]
        if not known:
            return Share(math.nan, math.nan)
        alike: dict[str, list[Cause]] = {}
        for cause in known:
            alike.setdefault(cause.words, []).append(cause)
        value = self._size([cause for cause in known if cause.how != "bound"], monitor, quantity)
        more = [
            (group[0].factor - (0.0 if group[0].how == "bound" else 1.0)) * self._size(group, monitor, quantity)
            for group in alike.values()
        ]
        return Share(value, value + math.hypot(*more), any(cause.how == "unknown" for cause in counted))

    def _size(self, causes: Sequence[Cause], monitor: str, quantity: str) -> float:
        """RMS of the sum of known errors over that of the motion."""
        own = self.motions[monitor]
        histories, sizes = self._split(causes, monitor, quantity)
        return math.hypot(share_of(sum(histories, np.zeros_like(own.values[quantity])), quantity, own), *sizes)

    def _split(self, causes: Sequence[Cause], monitor: str, quantity: str) -> tuple[list[np.ndarray], list[float]]:
        """Known errors of some causes: histories (k, c), and sizes of causes without a history."""
        histories, sizes = [], []
        for cause in causes:
            part = cause.parts.get(monitor, {}).get(quantity, math.nan)
            if isinstance(part, float) or cause.is_sample:
                sizes.append(cause.share(monitor, quantity, self.motions[monitor]))
            else:
                histories.append(part)
        return histories, [size for size in sizes if math.isfinite(size)]

    def quantities(self, monitor: str) -> list[str]:
        """Quantities recorded at a monitor."""
        return [name for name in QUANTITIES if name in self.motions[monitor].values]

    @cached_property
    def _loud(self) -> dict[str, set[str]]:
        """By quantity, the monitors at which it is not negligible."""
        return {quantity: set(loud(self.motions, quantity)) for quantity in QUANTITIES}

    def largest(self, monitor: str, of: Truth | None = None) -> tuple[str, Share]:
        """The quantity of a monitor with the largest error, and that error; nan if none is known.

        Negligible quantities do not count, unless all are.
        """
        recorded = self.quantities(monitor)
        counted = [quantity for quantity in recorded if monitor in self._loud[quantity]] or recorded
        totals = [(quantity, self.total(monitor, quantity, of)) for quantity in counted]
        known = [each for each in totals if each[1].is_known]
        return max(known, key=lambda each: each[1].upper, default=("", Share(math.nan, math.nan)))

    def worst(self, of: Truth | None = None) -> Worst:
        """The largest error of all quantities at monitors whose motion is not negligible; 0 without such monitors."""
        found = [
            Worst(share, name, quantity)
            for name in self.motions
            for quantity in self.quantities(name)
            if name in self._loud[quantity] and (share := self.total(name, quantity, of)).is_known
        ]
        if not found:
            return Worst(Share(0.0, 0.0))
        worst = max(found, key=lambda each: each.share.upper)
        shares = self.shares(worst.monitor, worst.quantity, of)
        return Worst(worst.share, worst.monitor, worst.quantity, {c: each for c, each in shares.items() if each > 0.0})

    def correction(self, monitor: str, quantity: str) -> np.ndarray | None:
        """Error history (k, c) of the sides, to be subtracted; None if it is not known without echoes."""
        cause = next((cause for cause in self.causes.found if cause.name == SIDES), None)
        if cause is None or not self.causes.echo_free:
            return None
        part = cause.parts.get(monitor, {}).get(quantity)
        return part if isinstance(part, np.ndarray) else None

    def band(self, monitor: str, quantity: str) -> np.ndarray:
        """Half the width (k, c) of the band around the motion in which the exact motion is expected.

        The absolute sum of all error histories at every time, plus the RMS size of errors without a history.
        """
        values = self.motions[monitor].values[quantity]
        counted = [cause for cause in self.causes.found if cause.counts(self.of)]
        histories, sizes = self._split(counted, monitor, quantity)
        usual = np.sqrt(np.mean(values**2, axis=0))
        return np.asarray(np.abs(sum(histories, np.zeros_like(values))) + sum(sizes) * usual)

    def summary(self) -> dict[str, Any]:
        """Totals and shares by monitor, quantity and cause, and how they were found, as plain JSON values."""
        facts, causes = ("how", "words", "of_disks", "factor"), self.causes
        known = [cause for cause in causes.found if cause.how != "unknown"]
        return {
            "of": self.of,
            "monitors": {name: dict(self._of_monitor(name)) for name in self.motions},
            "causes": {each.name: {fact: getattr(each, fact) for fact in facts} for each in known},
            "not_estimated": [*(f"{each.name}: {each.words}" for each in causes.unknown), *causes.limits],
            "notes": list(causes.notes),
            "repeat": None if self.repeat is None else self.repeat.summary(),
            **{"cost": causes.cost, "cpu_seconds": self.cpu_seconds},
        }

    def _of_monitor(self, name: str) -> Iterator[tuple[str, dict[str, Any]]]:
        """Quantities of a monitor with their known errors."""
        for quantity in self.quantities(name):
            both = {of: self.total(name, quantity, of) for of in ("disks", "rock")}  # type: ignore[arg-type]
            if both["rock"].is_known:
                totals = {of: {"value": s.value, "upper": s.upper} for of, s in both.items() if s.is_known}
                yield quantity, {"of": totals, "by": self.shares(name, quantity, "rock")}
