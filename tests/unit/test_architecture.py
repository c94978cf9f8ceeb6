"""The page on the architecture has all imports of the code; one module opens the files that are written."""

import ast
import re
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs/develop/architecture.md").read_text(encoding="utf-8")
Imports = dict[str, set[str]]

BY_NAME = {"write_text", "write_bytes", "touch", "symlink_to", "hardlink_to", "savefig", "mkstemp", "copytree"}
"""Methods and functions that write to a file or link given by its name."""

BY_FILE = {"save", "savez", "savez_compressed", "savetxt", "print_png", "imsave"}
"""Those that write to an open file, too, which here is called ``file`` or ``content``."""


def package(module: list[str]) -> str:
    """The package of a module, given by its dotted name's parts; tables of a kind have one of their own."""
    own = module[1:3] if module[1] == "casefile" and module[2:3] in (["disks"], ["bar"]) else module[1:2]
    return ".".join(own)


@cache
def trees() -> dict[Path, list[ast.AST]]:
    """The nodes of every module, by its path in the package."""
    paths = (ROOT / "dembound").rglob("*.py")
    return {path.relative_to(ROOT): [*ast.walk(ast.parse(path.read_text(encoding="utf-8")))] for path in paths}


@cache
def imports() -> Imports:
    """The packages that each package imports from."""
    found: Imports = {}
    for path, nodes in trees().items():
        module = list(path.with_suffix("").parts)
        if module[1].startswith("__"):
            continue
        for node in nodes:
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


def writes(call: ast.Call) -> bool:
    """Whether a call writes to a file that it opens by its name."""
    name = call.func.attr if isinstance(call.func, ast.Attribute) else getattr(call.func, "id", "")
    owner = getattr(call.func, "value", None)
    texts = [each.value for each in [*call.args, *(k.value for k in call.keywords)] if isinstance(each, ast.Constant)]
    first = getattr(call.args[0], "id", "") if call.args else ""
    if name in ("open", "FileIO", "File"):
        modes = [text for text in texts if isinstance(text, str) and set(text) <= set("rwaxb+t")]
        in_memory = any(keyword.arg == "driver" for keyword in call.keywords)
        is_open = first == "store" or "_store" in ast.dump(call.args[0] if call.args else call)
        return any(set(mode) & set("wax+") for mode in modes) and not (in_memory or is_open)
    if name == "copy" and getattr(owner, "id", "") == "shutil":
        return True
    is_own = owner is None and name in ("write_text", "copy", "save")  # functions that use the module
    return not is_own and (name in BY_NAME or (name in BY_FILE and first not in ("file", "content")))


def test_one_module_opens_the_files_that_are_written() -> None:
    found = [
        f"{path}:{node.lineno}"
        for path, nodes in trees().items()
        for node in nodes
        if isinstance(node, ast.Call) and path.stem != "files" and writes(node)
    ]
    assert found == []
