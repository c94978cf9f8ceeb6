"""The choices of a chart: named changes of a case, from lists of values or from the case's [chart] table."""

import hashlib
import json
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np

from dembound.casefile import Case
from dembound.casefile.toml import value_of
from dembound.errors import CaseError
from dembound.kinds import with_changes
from dembound.studies.chart.words import label
from dembound.version import __version__

WAVE_SAMPLES = 1000
"""Samples of every wave in a digest, so that it depends on the contents of files, too."""


@dataclass(frozen=True)
class Choice:
    """A choice of a chart: its name, the keys it changes, and the changed case."""

    name: str
    changes: Mapping[str, Any]
    case: Case


def choices_of(case: Case, named: Mapping[str, Mapping[str, Any]]) -> tuple[list[Choice], list[str]]:
    """The choices whose changed cases are valid, and a line for each of the others.

    named : changes of keys by the name of the choice, see `with_changes`. Two choices that make the same case count
    once. Raises CaseError with these lines if no choice is valid.
    """
    made: dict[str, Choice] = {}
    left_out: list[str] = []
    for name, changes in named.items():
        try:
            choice = Choice(name, changes, with_changes(case, changes))
        except CaseError as error:
            left_out.append(f"{name}: left out, {'; '.join(error.problems)}")
            continue
        made.setdefault(digest(choice.case), choice)
    if not made:
        raise CaseError(left_out or ["chart: has no choice"], case.name)
    return list(made.values()), left_out


def combinations(case: Case, vary: Mapping[str, Sequence[Any]]) -> dict[str, dict[str, Any]]:
    """All combinations of the keys' values, by name."""
    return {
        label(case, changes): changes
        for values in product(*vary.values())
        for changes in [dict(zip(vary, values, strict=True))]
    }


def from_table(case: Case) -> dict[str, Mapping[str, Any]]:
    """The choices of the case's [chart] table by name; none without one."""
    table = case.chart
    found: dict[str, Mapping[str, Any]] = {**combinations(case, table.vary)} if table.vary else {}
    for choice in table.choice:
        if choice.name in found:
            raise CaseError([f"chart.choice: two choices have the name {choice.name}"], case.name)
        found[choice.name] = choice.set
    return found


def digest(case: Case) -> str:
    """A text that is the same for cases that give the same results: of all tables but [chart], waves and version."""
    tables = {key: table for key, table in tomllib.loads(case.text).items() if key not in ("chart", "title")}
    found = hashlib.sha256(json.dumps([__version__, tables], sort_keys=True).encode())
    times = np.linspace(0.0, case.run.duration, WAVE_SAMPLES)
    for wave in case.wave.values():
        found.update(np.ascontiguousarray(wave.velocity(times)).tobytes())
    return found.hexdigest()


def parsed(options: Sequence[str]) -> dict[str, list[Any]]:
    """Keys and their values from options such as ``packing.radius=0.25,0.5``; values are TOML, or else plain text.

    Raises CaseError for an option that is not KEY=VALUE,… and for a key that is given twice.
    """
    found: dict[str, list[Any]] = {}
    for option in options:
        key, equals, text = option.partition("=")
        key, values = key.strip(), [value.strip() for value in _split(text)]
        if not equals or not key or not all(values):
            raise CaseError([f"--vary: is {option}, must be KEY=VALUE,VALUE,…, e.g. packing.radius=0.25,0.5"])
        if key in found:
            raise CaseError([f"--vary: has {key} twice, give all its values once"])
        found[key] = [value_of(value, f"--vary {key}") for value in values]
    return found


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
