"""TOML text to plain tables: numbers, texts, truth values, lists and tables, nested no deeper than any case."""

import re
import tomllib
from collections.abc import Iterator, Mapping
from datetime import date, time
from typing import Any

from dembound.errors import CaseError

DEEPEST = 30
"""Largest number of keys and list positions on the way to a value. The deepest of a case are below ten."""

SHOWN = 80
"""Characters of a line with a mistake that are shown."""


class NotTomlError(CaseError):
    """A text that is not TOML."""


def parsed(text: str, source: str = "") -> dict[str, Any]:
    """The tables of a TOML text; source : its name in errors.

    Raises CaseError for a text that is not TOML, is nested too deeply, or contains a date or time, which no key has.
    """
    return allowed(_parsed(text, source), source)


def allowed(data: dict[str, Any], source: str = "") -> dict[str, Any]:
    """The tables of parsed TOML; raises CaseError for values that `parsed` refuses."""
    if problems := list(_problems(data)):
        raise CaseError(problems, source)
    return data


def value_of(text: str, key: str) -> Any:
    """A text as a TOML value, or if it is none the text itself, without blanks around it.

    key : its name in errors. Raises CaseError for values that `parsed` refuses.
    """
    try:
        value = _parsed(f"value = {text}", key)["value"]
    except NotTomlError:
        return text.strip()
    if problems := list(_problems({key: value})):
        raise CaseError(problems)
    return value


def _parsed(text: str, source: str) -> dict[str, Any]:
    """The tables of a text with any values; raises the errors of `parsed`."""
    try:
        text.encode()
        return tomllib.loads(text)
    except UnicodeEncodeError:
        raise CaseError(["has characters that are not text in UTF-8"], source) from None
    except tomllib.TOMLDecodeError as error:
        raise NotTomlError([_syntax_problem(str(error), text)], source) from None
    except RecursionError:
        raise CaseError([f"is nested more than {DEEPEST} deep, deeper than any case"], source) from None
    except ValueError:  # of Python, which converts no more digits
        raise CaseError(["has a number of more than 4000 digits"], source) from None


def _problems(data: Mapping[str, Any]) -> Iterator[str]:
    """Values that no key of a case has, each with its place; found without recursion, however deep."""
    waiting: list[tuple[str, Any, int]] = [(key, value, 1) for key, value in data.items()]
    while waiting:
        place, value, depth = waiting.pop()
        if depth > DEEPEST:
            yield f"{re.split(r'[.[]', place)[0]}: is nested more than {DEEPEST} deep, deeper than any key of a case"
            return
        if isinstance(value, Mapping):
            waiting += [(f"{place}.{key}", inner, depth + 1) for key, inner in value.items()]
        elif isinstance(value, list):
            waiting += [(f"{place}[{number}]", inner, depth + 1) for number, inner in enumerate(value, start=1)]
        elif isinstance(value, date | time):
            yield f"{place}: is a date or time, must be a number, a text, true or false, a list or a table"


def _syntax_problem(message: str, text: str) -> str:
    """Tomllib's message with the line first: ``line 7: … in: period = fast``."""
    place = re.search(r" \(at (?:line (\d+), column \d+|end of document)\)$", message)
    if not place:
        return message
    what = message[: place.start()]
    if not place[1]:
        return f"at the end: {what}"
    return f"line {place[1]}: {what}, in: {text.split(chr(10))[int(place[1]) - 1].strip()[:SHOWN]}"
