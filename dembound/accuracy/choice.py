"""Choices: named changes of a case, made of lists of values of its keys, as for charts and sweeps."""

import hashlib
import json
import math
import tomllib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice, product
from typing import Any, Generic, Self, TypeVar

import numpy as np

from dembound.accuracy.differences import differences, in_toml
from dembound.accuracy.labels import label
from dembound.casefile import Case
from dembound.casefile.toml import value_of
from dembound.casefile.vary import range_of
from dembound.errors import CaseError
from dembound.kinds import with_changes
from dembound.results.structure import MOST_MEMBERS
from dembound.version import __version__

WAVE_SAMPLES = 1000
"""Samples of every wave in a digest, so that it depends on the contents of files, too."""

NO_RESULTS = ("title", "chart", "sweep")
"""Tables and keys of a case that its results do not depend on."""


COARSER = (1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 10.0)
"""Factors tried for radii and spacings in charts; those that do not divide the scene into whole bricks or cells are
left out."""

FEW = 2
"""Number of coarser radii or spacings in charts."""

OWN = "as in the case"
"""Name of the choice without changes."""

Named = Iterator[tuple[str, dict[str, Any]]]
"""Names of choices, and the keys they change."""

AnyCase = TypeVar("AnyCase", bound=Case)


@dataclass(frozen=True)
class Choice(Generic[AnyCase]):
    """A change of a case.

    name : in words. changes : new values by dotted key, None for keys left out, as `with_changes` takes them. case :
    the changed case.
    """

    name: str
    changes: Mapping[str, Any]
    case: AnyCase

    @classmethod
    def of(cls, given: Case, case: AnyCase, name: str) -> Self:
        """The choice that makes a case of the given one."""
        return cls(name, differences(given, case), case)

    @property
    def toml(self) -> list[str]:
        """A line of TOML for each key that it changes."""
        return in_toml(self.changes)


def choices_of(case: AnyCase, named: Mapping[str, Mapping[str, Any]]) -> tuple[list[Choice[AnyCase]], list[str]]:
    """The choices whose changed cases are valid, and a line for each of the others.

    named : changes of keys by the name of the choice, see `with_changes`. Two choices that make the same case count
    once. Raises CaseError with these lines if no choice is valid.
    """
    made: dict[str, Choice[AnyCase]] = {}
    left_out: list[str] = []
    for name, changes in named.items():
        try:
            choice = Choice(name, changes, with_changes(case, changes))
        except CaseError as error:
            left_out.append(f"{name}: left out, {'; '.join(error.problems)}")
            continue
        made.setdefault(digest(choice.case), choice)
    if not made:
        raise CaseError(left_out or ["--vary: is missing; there is no choice"], case.name)
    return list(made.values()), left_out


def combinations(case: Case, vary: Mapping[str, Sequence[Any]]) -> dict[str, dict[str, Any]]:
    """All combinations of the keys' values, by name; raises CaseError if they are more than a record may have."""
    if (count := math.prod(map(len, vary.values()))) > MOST_MEMBERS:
        raise CaseError([f"vary: makes {count:,} choices, must be {MOST_MEMBERS:,} or less"], case.name)
    return {
        label(case, changes): changes
        for values in product(*vary.values())
        for changes in [dict(zip(vary, values, strict=True))]
    }


def is_valid(case: Case, changes: Mapping[str, Any], use: Callable[[Any], object] = bool) -> bool:
    """Whether a changed case has no mistake, nor one that appears only when it is used (`use`, such as `build`)."""
    try:
        use(changed(case, changes))
    except CaseError:
        return False
    return True


def valid(case: Case, changes: Iterator[dict[str, Any]]) -> Iterator[dict[str, Any]]:
    """The first `FEW` of some changes that make valid cases."""
    return islice((change for change in changes if is_valid(case, change)), FEW)


def changed(case: AnyCase, changes: Mapping[str, Any]) -> AnyCase:
    """The case with some keys changed, itself without changes; raises CaseError for changes that are not valid."""
    return with_changes(case, changes) if changes else case


def digest(case: Case) -> str:
    """A hash that is equal for cases with equal results: same tables, waves and program version."""
    tables = {key: _filled(table) for key, table in tomllib.loads(case.text).items() if key not in NO_RESULTS}
    found = hashlib.sha256(json.dumps([__version__, tables], sort_keys=True).encode())
    times = np.linspace(0.0, case.run.duration, WAVE_SAMPLES)
    for wave in case.wave.values():
        found.update(np.ascontiguousarray(wave.velocity(times)).tobytes())
    return found.hexdigest()


def _filled(table: Any) -> Any:
    """A table without empty tables inside, which are equivalent to missing ones."""
    if not isinstance(table, dict):
        return table
    return {key: _filled(value) for key, value in table.items() if value != {}}


def parsed(options: Sequence[str]) -> dict[str, list[Any]]:
    """Keys and their values from options such as ``packing.radius=0.25,0.5``; values are TOML, or else plain text.

    A range such as ``1:20`` stands for its whole numbers, both ends included. Raises CaseError for an option that is
    not KEY=VALUE,… , for a key that is given twice, and for ranges as `range_of`.
    """
    found: dict[str, list[Any]] = {}
    for option in options:
        key, equals, text = option.partition("=")
        key, values = key.strip(), [value.strip() for value in _split(text)]
        if not equals or not key or not all(values):
            raise CaseError([f"--vary: is {option}, must be KEY=VALUE,VALUE,…, e.g. packing.radius=0.25,0.5"])
        if key in found:
            raise CaseError([f"--vary: has {key} twice, give all its values once"])
        found[key] = [each for value in values for each in _expanded(value_of(value, f"--vary {key}"), key)]
    return found


def _expanded(value: Any, key: str) -> list[Any]:
    """The numbers of a range, or the value itself."""
    try:
        return range_of(value) or [value]
    except ValueError as error:
        raise CaseError([f"--vary: {key}: {error}"]) from None


def _split(text: str) -> Iterator[str]:
    """The parts of a text between commas that are not within brackets or quotes."""
    depth, quote, part = 0, "", ""
    for sign in text:
        if quote:
            quote = "" if sign == quote else quote
        elif sign in "\"'":
            quote = sign
        else:
            depth += (sign in "[{") - (sign in "]}")
        if sign == "," and depth == 0 and not quote:
            yield part
            part = ""
        else:
            part += sign
    yield part
