"""The table of imports in the page on the architecture is that of the code."""

import ast
import re
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs/develop/architecture.md").read_text(encoding="utf-8")
Imports = dict[str, set[str]]


def package(module: list[str]) -> str:
    """The package of a module, given by its dotted name's parts; tables of a kind have one of their own."""
    own = module[1:3] if module[1] == "casefile" and module[2:3] in (["disks"], ["bar"]) else module[1:2]
    return ".".join(own)


@cache
def imports() -> Imports:
    """The packages that each package imports from."""
    found: Imports = {}
    for path in (ROOT / "dembound").rglob("*.py"):
        module = list(path.relative_to(ROOT).with_suffix("").parts)
        if module[1].startswith("__"):
            continue
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if not isinstance(node, ast.ImportFrom) or not (node.module or "").startswith("dembound"):
                continue
            parts = node.module.split(".")
            names = [parts] if len(parts) > 1 else [[*parts, alias.name] for alias in node.names]
            for name in names:
                if name[1].islower() and not name[1].startswith("__") and package(name) != package(module):
                    found.setdefault(package(module), set()).add(package(name))
    return found


def reached(graph: Imports, start: str) -> set[str]:
    """All packages that one imports, directly or through others."""
    found: set[str] = set()
    ahead = list(graph.get(start, ()))
    while ahead:
        if (here := ahead.pop()) not in found:
            found.add(here)
            ahead += graph.get(here, ())
    return found


def test_the_table_has_all_imports() -> None:
    rows = re.findall(r"^\| `([\w.]+)` \| .* \| (.*) \|$", PAGE, flags=re.MULTILINE)
    table = {name: set(re.findall(r"`([\w.]+)`", last)) for name, last in rows}
    found = imports()

    assert {name: ends for name, ends in table.items() if ends} == found
    assert set(table) == {*found, *(end for ends in found.values() for end in ends)}


def test_no_package_imports_itself_through_others() -> None:
    found = imports()
    assert not [name for name in found if name in reached(found, name)]
