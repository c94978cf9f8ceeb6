"""Checks that tests catch single edits in the physics: a sign, a factor of two, an axis, an index.

    python benchmarks/single_edits.py [NAME...] [--all-tests] [--without-compiling]

The package is copied; for each edit of `single_edits.toml` the copy is edited, and its test run: the one that is known
to fail, or with --all-tests the whole files of unit tests named like the module. Prints a line for each, and ends with
1 if an edit with a known test is not caught. Edits in kernels compile them anew, 10 to 30 s each; --without-compiling
runs them as Python, which the tests of kernels allow.
"""

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

from timing import ROOT, small_option


def place_of(edit: dict[str, str], package: Path) -> Path:
    """The one file with the text of an edit; raises ValueError if there is none, or if it stands there twice."""
    found = [
        path
        for path in package.rglob("*.py")
        if path.as_posix().endswith(edit.get("file", "")) and edit["old"] in path.read_text(encoding="utf-8")
    ]
    if len(found) != 1 or found[0].read_text(encoding="utf-8").count(edit["old"]) != 1:
        raise ValueError(f"{edit['name']}: its text does not stand once in the package")
    return found[0]


def tests_of(edit: dict[str, str], module: Path, *, all_tests: bool) -> list[str]:
    """Arguments of pytest for an edit of a module."""
    known = edit.get("test", "")
    if known and not all_tests:
        name, _, function = known.partition(".")
        files = [path for path in (ROOT / "tests").rglob(f"{name}.py") if f"def {function}(" in path.read_text("utf-8")]
        return [f"{path}::{function}" for path in files]
    return [str(path) for path in (ROOT / "tests").rglob(f"test_{module.stem}.py")]


def is_caught(edit: dict[str, str], folder: Path, *, all_tests: bool, compiled: bool) -> bool | None:
    """Whether a test fails with an edit of the copy of the package in a folder; None if there is no test to run."""
    place = place_of(edit, folder / "dembound")
    text, known = place.read_text(encoding="utf-8"), place.stat()
    chosen = tests_of(edit, place, all_tests=all_tests)
    if not chosen:
        return None
    environment = os.environ | {"PYTHONPATH": str(folder), "PYTHONSAFEPATH": "1", "MPLBACKEND": "Agg"}
    if not compiled and "kernels" in place.parts:
        environment["NUMBA_DISABLE_JIT"] = "1"
    words = [sys.executable, "-m", "pytest", "-q", "-x", "-n", "0", "-p", "no:cacheprovider", *chosen]
    try:
        place.write_text(text.replace(edit["old"], edit["new"]), encoding="utf-8")
        return subprocess.run(words, cwd=ROOT, env=environment, capture_output=True, check=False).returncode == 1
    finally:
        place.write_text(text, encoding="utf-8")
        os.utime(place, ns=(known.st_atime_ns, known.st_mtime_ns))  # by which compiled kernels are known


def main() -> int:
    """Try edits; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--all-tests", action="store_true", help="all tests named like the module")
    parser.add_argument("--without-compiling", action="store_true", help="kernels as Python")
    small_option(parser, names=["matched_s_ratio"])
    given = parser.parse_args()
    edits = tomllib.loads((Path(__file__).parent / "single_edits.toml").read_text(encoding="utf-8"))["edit"]
    lost = 0
    with tempfile.TemporaryDirectory() as folder:
        copy = shutil.copytree(
            ROOT / "dembound", Path(folder) / "dembound", ignore=shutil.ignore_patterns("__pycache__")
        )
        for edit in edits:
            if given.names and edit["name"] not in given.names:
                continue
            ways = {"all_tests": given.all_tests, "compiled": not given.without_compiling}
            caught = is_caught(edit, copy.parent, **ways)
            print(
                f"{'caught' if caught else 'no test' if caught is None else 'NOT caught'}: {edit['name']}", flush=True
            )
            lost += not caught and "test" in edit
    return int(lost > 0)


if __name__ == "__main__":
    raise SystemExit(main())
