"""The first pages: their cases can be read, and a translation has the commands and cases of the page it translates."""

import re
from pathlib import Path

import pytest
from small_cases import problems_of

ROOT = Path(__file__).parents[2]
START, CHINESE = ROOT / "docs" / "start", ROOT / "docs" / "zh"


def blocks(page: Path, languages: str) -> list[str]:
    """The blocks of code of a page in one of the languages, such as ``toml|sh``."""
    return re.findall(rf"^```(?:{languages})\n(.*?)^```", page.read_text(), flags=re.DOTALL | re.MULTILINE)


@pytest.mark.parametrize("page", sorted(START.glob("*.md")), ids=lambda page: page.stem)
def test_every_whole_case_of_a_page_can_be_read(page: Path) -> None:
    for text in blocks(page, "toml"):
        if "[run]" in text:
            assert problems_of(text, page.parent) == []


@pytest.mark.parametrize("page", sorted({*CHINESE.glob("*.md")} - {CHINESE / "index.md"}), ids=lambda page: page.stem)
def test_commands_and_cases_of_a_chinese_page_are_those_of_the_english_one(page: Path) -> None:
    english = blocks(START / page.name, "toml|python|sh")
    assert [text for text in blocks(page, "toml|python|sh") if text not in english] == []
