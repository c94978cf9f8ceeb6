"""Compiling is reported when a kernel is compiled, and only then."""

import os
import subprocess
import sys

from dembound.cli.compiling import MESSAGE

COMPUTE = """
import numpy as np
from dembound.cli.app import prepare_computing
prepare_computing(None)
prepare_computing(None)
from dembound.kernels.common import column_sum, largest
column_sum(np.ones((2, 2)), 0)
largest(np.ones(2))
"""


def test_only_the_first_kernel_compiled_is_reported(tmp_path) -> None:
    def printed() -> str:
        kept = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)}
        return subprocess.run(
            [sys.executable, "-c", COMPUTE], capture_output=True, text=True, check=True, env=kept
        ).stderr

    assert printed() == f"{MESSAGE}\n"
    assert printed() == ""  # loaded
