"""The members of a sweep: changed cases with the names of their folders, and the groups that differ only in seeds."""

import hashlib
import json
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

from dembound.accuracy.choice import choices_of, digest
from dembound.accuracy.labels import in_words, short_keys
from dembound.casefile import Case
from dembound.casefile.messages import counted
from dembound.casefile.sweep import Action, Method
from dembound.errors import CaseError
from dembound.results.folder import PARTIAL, problem_of

LONGEST = 80
"""Largest number of characters of a name."""

SEED = "seed"
"""Suffix of keys that select one of many equally likely members."""


@dataclass(frozen=True)
class Member:
    """A member of a sweep.

    Attributes
    ----------
    name : of its folder. changes : its keys that differ from the case, with their values.
    case : the changed case, of that name.
    key : hash of case and action, equal for members with the same results, whatever their names.
    """

    name: str
    changes: Mapping[str, Any]
    case: Case
    key: str

    @property
    def group(self) -> dict[str, Any]:
        """The changes without seeds; members with equal ones are averaged."""
        return {key: value for key, value in self.changes.items() if not key.endswith(SEED)}


def changes_of(vary: Mapping[str, Sequence[Any]], together: bool) -> list[dict[str, Any]]:
    """All combinations of the values of keys; together : the first values of all keys, then the second ones, and so on.

    Raises CaseError if there is no key, or keys varied together have different numbers of values.
    """
    if not vary:
        raise CaseError(["--vary: is missing; give keys and values, or a table [sweep.vary] in the case"])
    counts = {key: len(values) for key, values in vary.items()}
    if together and len(set(counts.values())) > 1:
        listed = ", ".join(f"{key} {counted(count, 'value')}" for key, count in counts.items())
        raise CaseError([f"--together: keys must have equally many values, here {listed}"])
    rows = zip(*vary.values(), strict=True) if together else product(*vary.values())
    return [dict(zip(vary, row, strict=True)) for row in rows]


def members_of(
    case: Case, changes: Sequence[Mapping[str, Any]], action: Action, method: Method
) -> tuple[list[Member], list[str]]:
    """The members whose changed cases are valid, each once, and a line for each of the others.

    Raises CaseError with these lines if no member is valid.
    """
    choices, left_out = choices_of(case, dict(zip(_names(changes), changes, strict=True)))
    done = [action, method if action == "calibrate" else ""]
    return [
        Member(choice.name, choice.changes, replace(choice.case, name=choice.name), key_of(choice.case, done))
        for choice in choices
    ], left_out


def key_of(case: Case, done: Sequence[str]) -> str:
    """The key of a member, see `Member`; done : the action, and its method."""
    return hashlib.sha256(json.dumps([digest(case), *done]).encode()).hexdigest()[:16]


def _names(changes: Sequence[Mapping[str, Any]]) -> Iterator[str]:
    """Names such as ``seed=3,size=[4, 2]``, which all systems allow; long or duplicate names end with a hash."""
    taken: set[str] = set()
    for each in changes:
        words = zip(short_keys(each), each.values(), strict=True)
        name = re.sub(r"[^\w.,=+()\[\]-]+", "-", ",".join(f"{key}={in_words(value)}" for key, value in words))
        if len(name) > LONGEST or name.lower() in taken or problem_of(name) or name.endswith(PARTIAL):
            digits = hashlib.sha256(json.dumps(each).encode()).hexdigest()[:8]
            name = f"{name[:LONGEST].rstrip('.')}-{digits}"
        taken.add(name.lower())
        yield name
