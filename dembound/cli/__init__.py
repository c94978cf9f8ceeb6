"""The command line. Only this package prints and exits; the commands call functions of other packages.

Each command imports what it calls when it is called, so that help and completion appear at once.
"""

from dembound.cli import (
    advise,
    boundary,
    calibration,
    cases,
    chart,
    estimate,
    exact,
    gauge,
    hopkinson,
    laboratory,
    library,
    material,
    results,
    showing,
    stability,
    starting,
    sweep,
    wave,
)
from dembound.cli.app import app
from dembound.cli.entry import main

__all__ = [
    "advise",
    "app",
    "boundary",
    "calibration",
    "cases",
    "chart",
    "dispersion",
    "estimate",
    "exact",
    "gauge",
    "hopkinson",
    "laboratory",
    "library",
    "main",
    "material",
    "packing",
    "results",
    "showing",
    "signals",
    "stability",
    "starting",
    "sweep",
    "wave",
]
