"""Prints measurements line by line as they are done, then draws pictures; for this folder and cases/outside."""

import sys
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path

from matplotlib.figure import Figure

from dembound.plot.style import save


def report(measurements: Iterable[Iterable[str]], pictures: Mapping[str, Callable[[], Figure]], folder: str) -> None:
    """Print the lines of all measurements, and draw pictures, by the names of their files.

    folder : where the pictures are saved, unless the command line names another one.
    """
    results = Path(sys.argv[1] if len(sys.argv) > 1 else folder)
    for lines in measurements:
        for line in lines:
            print(line, flush=True)
    results.mkdir(parents=True, exist_ok=True)
    for name, draw in pictures.items():
        save(draw(), results / f"{name}.png")
        print(f"wrote {results / name}.png")
