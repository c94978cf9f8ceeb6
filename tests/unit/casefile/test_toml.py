"""TOML is read to plain tables; contents that no case has cause one line."""

import pytest

from dembound.casefile.reader import DEEPEST, parsed, value_of
from dembound.errors import CaseError


def refusal(text: str) -> list[str]:
    with pytest.raises(CaseError) as caught:
        parsed(text, "bar.toml")
    assert caught.value.source == "bar.toml"
    return caught.value.problems


def test_tables_and_values_are_read() -> None:
    assert parsed("a = 1\n[b]\nc = [1.5, 'x']") == {"a": 1, "b": {"c": [1.5, "x"]}}
    assert [value_of(text, "--set a") for text in ("1", "1e3", "true", "[1, 2]", '"x"', " plain text ", "a b")] == [
        *(1, 1e3, True, [1, 2], "x", "plain text", "a b")
    ]


def test_nesting_has_an_end() -> None:
    for depth in (DEEPEST + 1, 2000):
        for text in (f"a = {'[' * depth}{']' * depth}", f"a{'.a' * depth} = 1"):
            (line,) = refusal(text)
            assert f"is nested more than {DEEPEST} deep" in line
        with pytest.raises(CaseError, match="is nested more than"):
            value_of(f"{'[' * depth}{']' * depth}", "--set a")
    assert parsed(f"a = {'[' * (DEEPEST - 1)}{']' * (DEEPEST - 1)}")


def test_numbers_have_a_length() -> None:
    assert refusal(f"a = {'9' * 5000}") == ["has a number of more than 4000 digits"]
    with pytest.raises(CaseError, match="has a number of more than 4000 digits") as caught:
        value_of("9" * 5000, "--set a")
    assert caught.value.source == "--set a"


def test_a_mistake_in_the_syntax_comes_with_its_line_and_a_date_with_its_place() -> None:
    assert refusal("a = 1\nb = \x00\n") == ["line 2: Invalid value, in: b = \\x00"]
    assert len(refusal(f"a = {'x' * 1000}")[0]) < 200
    assert refusal("a = '\udcff'") == ["has characters that are not text in UTF-8"]
    said = "is a date or time, must be a number, a text, true or false, a list or a table"
    assert refusal("[a]\nb = [1, 2020-01-01]\nc = 10:00:00") == [f"a.c: {said}", f"a.b[2]: {said}"]
