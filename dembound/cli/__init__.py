"""The command line. Only this package prints and exits; what it does lives elsewhere."""

from dembound.cli import (  # each names its commands to the application
    calibration,
    cases,
    dispersion,
    gauge,
    results,
    starting,
)
from dembound.cli.app import app, main

__all__ = ["app", "calibration", "cases", "dispersion", "gauge", "main", "results", "starting"]
