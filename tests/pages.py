"""Contents of a page, read from its text."""

import base64
import gzip
import json
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

VOID = {"meta", "img", "link", "input", "br"}


class Page(HTMLParser):
    """The elements of a page: tags with attributes, texts by tag, and rows of its tables.

    Every element that is opened must be closed.
    """

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.source = path.read_text(encoding="utf-8")
        self.open: list[str] = []
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.texts: list[tuple[str, str]] = []
        self.rows: list[list[str]] = []
        self.feed(self.source)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)
        if tag == "tr":
            self.rows.append([])
        if tag in ("td", "th"):
            self.rows[-1].append("")

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if self.open and data.strip():
            self.texts.append((self.open[-1], data.strip()))
            if self.open[-1] in ("td", "th"):
                self.rows[-1][-1] += data.strip()

    def all(self, tag: str) -> list[dict[str, str | None]]:
        """The attributes of all elements of a tag."""
        return [attributes for name, attributes in self.tags if name == tag]

    def said(self, tag: str) -> list[str]:
        """The texts in all elements of a tag."""
        return [text for name, text in self.texts if name == tag]

    def row(self, head: str) -> list[str]:
        """The cells of the first row with a head."""
        return next(row[1:] for row in self.rows if row and row[0] == head)

    def live(self) -> dict[str, Any]:
        """The values that its scripts read."""
        (packed,) = (
            text for (tag, text) in self.texts if tag == "script" and not text.startswith("//") and len(text) > 100
        )
        return json.loads(gzip.decompress(base64.b64decode(packed)))
