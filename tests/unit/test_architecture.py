"""The page on the architecture has all packages; one module opens the files that are written."""

import ast
import re
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs/develop/architecture.md").read_text(encoding="utf-8")

BY_NAME = {"write_text", "write_bytes", "touch", "symlink_to", "hardlink_to", "savefig", "mkstemp", "copytree"}
"""Methods and functions that write to a file or link given by its name."""

BY_FILE = {"save", "savez", "savez_compressed", "savetxt", "print_png", "imsave"}
"""Those that write to an open file, too, which here is called ``file`` or ``content``."""


@cache
def trees() -> dict[Path, list[ast.AST]]:
    """The nodes of every module, by its path in the package."""
    paths = (ROOT / "dembound").rglob("*.py")
    return {path.relative_to(ROOT): [*ast.walk(ast.parse(path.read_text(encoding="utf-8")))] for path in paths}


def test_the_table_has_all_packages() -> None:
    cells = re.findall(r"^\| (`.*?) \| ", PAGE, flags=re.MULTILINE)
    table = re.findall(r"`([\w.]+)`", " ".join(cells))
    names = {path.parts[1].removesuffix(".py") for path in trees()}
    assert {name.split(".")[0] for name in table} == {name for name in names if not name.startswith("__")}


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
