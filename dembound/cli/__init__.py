"""The command line. Only this package prints and exits; the commands call functions of other packages."""

import sys
import warnings
from typing import Any


def _in_one_line(message: Warning | str, category: type[Warning], *where: Any, **more: Any) -> None:
    """Print a Python warning without the place in the source that it comes from."""
    print(f"warning: {' '.join(str(message).split())}", file=sys.stderr)


with warnings.catch_warnings():  # about types of other packages, which are loaded during these imports
    warnings.showwarning = _in_one_line
    from dembound.cli import (  # each registers its commands with the application
        calibration,
        cases,
        dispersion,
        gauge,
        results,
        starting,
    )
    from dembound.cli.app import app, main

__all__ = ["app", "calibration", "cases", "dispersion", "gauge", "main", "results", "starting"]
