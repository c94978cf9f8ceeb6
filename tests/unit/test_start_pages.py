"""The first pages: their cases can be read, and a translation has the code of the page it translates."""

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
def test_the_code_of_a_chinese_page_is_that_of_the_english_one_or_of_a_shipped_case(page: Path) -> None:
    originals = [START / page.name, *(ROOT / "cases").glob("*.toml")]
    texts = [path.read_text() for path in originals if path.is_file()]
    assert [code for code in blocks(page, "toml|python") if not any(code in text for text in texts)] == []
