"""The command line. Only this package prints and exits; the commands call functions of other packages.

Each command imports what it calls when it is called, so that help and completion appear at once.
"""

# ruff: noqa: F401  # modules are imported as they add their commands to the app
from dembound.cli import (
    advise,
    boundary,
    calibration,
    cases,
    chart,
    exact,
    gauge,
    material,
    paper,
    results,
    showing,
    starting,
    sweep,
    wave,
)
from dembound.cli.app import app
from dembound.cli.entry import main

__all__ = ["app", "main"]
