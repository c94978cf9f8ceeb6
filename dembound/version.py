"""The version, and the moment at which the package began to be imported."""

import time

__version__ = "0.1.0"

IMPORT_BEGAN = time.perf_counter()
"""Used for the summary's list of the time each part of a run took."""
