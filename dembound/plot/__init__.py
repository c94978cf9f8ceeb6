"""Pictures, made only from result files and without a display; one kind of figure per module."""

import os

from dembound.machine import private_folder, user_cache

if "MPLCONFIGDIR" not in os.environ and user_cache() is None:
    # else each process prints that it has no folder, and lists all fonts anew
    os.environ["MPLCONFIGDIR"] = str(private_folder() / "matplotlib")
