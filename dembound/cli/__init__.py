"""The command line. Only this package prints and exits; what it does lives elsewhere."""

from dembound.cli import calibration, cases, dispersion, gauge, results  # each names its commands to the application
from dembound.cli.app import app, main

__all__ = ["app", "calibration", "cases", "dispersion", "gauge", "main", "results"]
