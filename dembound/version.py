"""The version, and the moment at which the package began to be imported."""

import time

__version__ = "0.1.0"

IMPORT_BEGAN = time.perf_counter()
"""Begin of the import, for the summary's times of the parts of a run."""
