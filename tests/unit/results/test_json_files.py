"""JSON files that any strict reader takes."""

import ast
import json
import math
from pathlib import Path

import pytest

from dembound.results.text_files import write_json

PACKAGE = Path(__file__).parents[3] / "dembound"


def refused(constant: str) -> float:
    raise AssertionError(constant)


def test_numbers_that_are_not_finite_are_null(tmp_path: Path) -> None:
    values = {"a": math.nan, "b": [1.0, math.inf, {"c": (-math.inf, "NaN", True, None)}], "d": 1e308}
    write_json(tmp_path / "found.json", values)
    found = json.loads((tmp_path / "found.json").read_text(encoding="utf-8"), parse_constant=refused)

    assert found == {"a": None, "b": [1.0, None, {"c": [None, "NaN", True, None]}], "d": 1e308}
    assert [path.name for path in tmp_path.iterdir()] == ["found.json"]


def test_what_is_no_plain_value_leaves_no_file(tmp_path: Path) -> None:
    with pytest.raises(TypeError):
        write_json(tmp_path / "found.json", {"a": object()})
    assert list(tmp_path.iterdir()) == []


def test_all_files_of_json_are_written_by_it() -> None:
    """No other text that json has made goes straight to a file."""
    writing = [
        f"{path.name}:{node.lineno}"
        for path in sorted(PACKAGE.rglob("*.py"))
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Call)
        and isinstance(node.func, ast.Attribute)
        and node.func.attr in ("write_text", "write", "dump")
        and any(isinstance(each, ast.Attribute) and each.attr == "dumps" for each in ast.walk(node))
        and path.name != "json_files.py"
        and "tomli_w" not in ast.unparse(node)
    ]
    assert writing == []
