"""Write the pages of docs/reference that follow from the code: `python docs/generate`.

Texts are those of the tables of case files (docstrings and `quantity`), the commands and the Python functions; change
them there. The
pages are committed, and a test compares them with what these functions return.
"""

from pathlib import Path

from case_file import case_file
from commands import commands
from functions import functions

DOCS = Path(__file__).parents[1]

PAGES = {
    "reference/case_file.md": case_file,
    "reference/commands.md": commands,
    "reference/python.md": functions,
}
"""Pages below docs, and what returns their text."""


if __name__ == "__main__":
    for name, page in PAGES.items():
        (DOCS / name).write_text(page(), encoding="utf-8")
