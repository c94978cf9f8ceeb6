"""Shares in per cent as text, in every message alike."""

import re
from pathlib import Path

import pytest

from dembound.words import percent

OWN = re.compile(r":[+]?\.[23]g\} %")
"""A share that is written with its own format, by which 0.998 would be "1e+02 %"."""


@pytest.mark.parametrize(
    ("share", "digits", "words"),
    [
        (0.0, 2, "0 %"),
        (1e-3, 2, "0.1 %"),
        (0.01234, 2, "1.2 %"),
        (-0.01234, 3, "-1.23 %"),
        (0.9949, 2, "99 %"),
        (0.9951, 2, "100 %"),
        (1.274, 2, "127 %"),
        (-7.0, 2, "-700 %"),
        (9.994, 3, "999 %"),
        (9.996, 3, "1000 %"),
        (float("inf"), 2, "inf %"),
        (float("nan"), 2, "nan %"),
    ],
)
def test_shares_have_their_digits_and_no_exponent(share: float, digits: int, words: str) -> None:
    assert percent(share, digits) == words


def test_no_message_has_a_format_of_its_own() -> None:
    package = Path(__file__).parents[2] / "dembound"
    found = [path.name for path in package.rglob("*.py") if OWN.search(path.read_text(encoding="utf-8"))]
    assert found == []
