"""Compiled loops: arrays and floats in, arrays and floats out. None of them raises, prints or reads files."""

import hashlib
import os
from pathlib import Path

import numba

# Threads wait for each other at every step. Where other programs use the cores too, waiting by spinning makes a run
# many times slower; the variable is read when the first parallel loop starts.
os.environ.setdefault("OMP_WAIT_POLICY", "passive")


def sources_digest(folder: Path) -> str:
    """A short name for what the Python files of a folder hold."""
    return hashlib.sha256(b"".join(path.read_bytes() for path in sorted(folder.glob("*.py")))).hexdigest()[:16]


# Numba keeps compiled code until the file of the function itself changes. Kernels are built of functions from other
# files, too, so the code that was compiled from one state of all of them has a folder of its own.
_HERE = Path(__file__).parent
_KEPT = Path(numba.config.CACHE_DIR or _HERE / "__pycache__")  # type: ignore[attr-defined]  # from the environment
numba.config.CACHE_DIR = str(_KEPT / sources_digest(_HERE))  # type: ignore[attr-defined]
