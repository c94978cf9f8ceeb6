"""The picture of the house is that of the code."""

import ast
import re
from functools import cache
from itertools import product
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs/develop/architecture.md").read_text(encoding="utf-8")
Arrows = dict[str, set[str]]


def room(module: list[str]) -> str:
    """The room of a module, given by its dotted name's parts; tables of a kind have one of their own."""
    own = module[1:3] if module[1] == "casefile" and module[2:3] in (["disks"], ["bar"]) else module[1:2]
    return ".".join(own)


@cache
def imports() -> Arrows:
    """The rooms that each room imports from."""
    found: Arrows = {}
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
                if name[1].islower() and not name[1].startswith("__") and room(name) != room(module):
                    found.setdefault(room(module), set()).add(room(name))
    return found


def reached(arrows: Arrows, start: str) -> set[str]:
    """All rooms that can be come to from one."""
    found: set[str] = set()
    ahead = list(arrows.get(start, ()))
    while ahead:
        if (here := ahead.pop()) not in found:
            found.add(here)
            ahead += arrows.get(here, ())
    return found


def without_longer_ways(arrows: Arrows) -> Arrows:
    """The arrows that no way over another room stands for."""
    return {
        start: {end for end in ends if not any(end in reached(arrows, over) for over in ends - {end})}
        for start, ends in arrows.items()
    }


def test_the_table_has_all_imports() -> None:
    rows = re.findall(r"^\| `([\w.]+)` \| .* \| (.*) \|$", PAGE, flags=re.MULTILINE)
    table = {name: set(re.findall(r"`([\w.]+)`", last)) for name, last in rows}
    found = imports()

    assert {name: ends for name, ends in table.items() if ends} == found
    assert set(table) == {*found, *(end for ends in found.values() for end in ends)}


def test_the_picture_has_its_arrows() -> None:
    picture = PAGE.split("```mermaid")[1].split("```")[0]
    drawn: Arrows = {}
    for starts, ends in re.findall(r"^ +(.*) --> (.*)$", picture, flags=re.MULTILINE):
        for start, end in product(starts.split(" & "), ends.split(" & ")):
            drawn.setdefault(start, set()).add(end)

    assert drawn == without_longer_ways(imports())


def test_no_arrow_runs_in_a_circle() -> None:
    found = imports()
    assert not [name for name in found if name in reached(found, name)]
