"""dembound: waves in bonded particles, with artificial boundaries that really absorb."""

import time

__version__ = "0.1.0"

IMPORT_BEGAN = time.perf_counter()
"""When the package began to be imported, for the summary of what a run spent its time on."""
