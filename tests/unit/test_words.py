"""Shares in per cent as text, in every message alike."""

import re
from pathlib import Path

import pytest

from dembound.words import Quantity, columns, in_one_unit, numbers, percent, sentences, with_unit

OWN = re.compile(r":[+]?\.[23]g\} %")
"""A share that is written with its own format, by which 0.998 would be "1e+02 %"."""


@pytest.mark.parametrize(
    ("share", "digits", "words"),
    [(0.01234, 2, "1.2 %"), (0.9951, 2, "100 %"), (9.996, 3, "1000 %"), (float("nan"), 2, "nan %")],
)
def test_shares_have_their_digits_and_no_exponent(share: float, digits: int, words: str) -> None:
    assert percent(share, digits) == words


@pytest.mark.parametrize(
    ("value", "unit", "words"),
    [
        (8e6, "Pa", "8 MPa"),
        (999_999.0, "Pa", "1 MPa"),  # not 1000 kPa
        (0.0025, "Pa", "0.0025 Pa"),  # mPa would be read as MPa
        (2.463e-4, "s", "246 µs"),
        (float("nan"), "Pa", "nan Pa"),
    ],
)
def test_numbers_have_three_digits_and_the_prefix_that_suits_them(value: float, unit: str, words: str) -> None:
    assert with_unit(value, unit) == words


def test_numbers_beside_each_other_have_one_unit_and_aligned_columns() -> None:
    assert in_one_unit([2.3936e9, 0.3874e9, -1e6], "Pa") == (["2.39", "0.387", "-0.001"], "GPa")
    assert columns([["monitor", "at"], ["P1", "0.5 s"]]) == ["monitor     at", "P1       0.5 s"]


def test_no_message_has_a_format_of_its_own() -> None:
    package = Path(__file__).parents[2] / "dembound"
    found = [path.name for path in package.rglob("*.py") if OWN.search(path.read_text(encoding="utf-8"))]
    assert found == []


def test_a_quantity_is_a_number_for_scripts_and_a_sentence() -> None:
    found = [
        Quantity("wave_speed", "m/s", 1234.5, "c = {}"),
        Quantity("strength", "Pa", 8e6, "{}"),
        Quantity("density", "kg/m³", 2500.0, "density {:g} kg/m³"),
        Quantity("spacing", "m", 0.1),
        Quantity("opening", "m", None, "opens by {}"),
    ]

    values = {"wave_speed": 1234.5, "strength": 8e6, "density": 2500.0, "spacing": 0.1, "opening": None}
    assert numbers(found) == values
    assert sentences(found, "strength", "spacing", "opening", "density") == "8 MPa, density 2500 kg/m³"
    assert found[0].text == "c = 1230 m/s"
