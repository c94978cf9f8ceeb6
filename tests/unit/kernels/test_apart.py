"""A kernel that is kept apart is called, not copied, also by code that was compiled by an earlier process."""

import os
import subprocess
import sys

import numpy as np
import pytest
from numba import njit

from dembound.kernels.apart import apart, require_known
from dembound.kernels.common import EXACT


@apart
@njit(**EXACT | {"cache": False})
def _weighted(values, weights, most):
    """Sum of values (n,) times weights (n,), and whether it is above `most`."""
    total = 0.0
    for i in range(values.size):
        total += values[i] * weights[i]
    return total, total > most


@njit(**EXACT | {"cache": False})
def _doubled(values, weights, most):
    total, above = _weighted(values, weights, most)
    return 2.0 * total, above


def test_it_computes_the_same_called_by_compiled_code_and_from_python_and_is_not_in_that_of_its_caller() -> None:
    for kind in (np.float64, np.int64):
        values, weights = np.array([1, 2, 4], dtype=kind), np.array([0.5, 0.25, 2.0])
        assert _weighted(values, weights, 8.0) == (9.0, True)
        assert _doubled(values, weights, 9.0) == (18.0, False)
    for code in _doubled.inspect_llvm().values():
        defined = [line for line in code.splitlines() if line.startswith("define") and "_weighted" in line]
        declared = [line for line in code.splitlines() if line.startswith("declare") and "_weighted" in line]
        assert (len(defined), len(declared)) == (0, 1)


MODULE = """
from numba import njit
from dembound.kernels.apart import apart
from dembound.kernels.common import FAST

@apart
@njit(**FAST)
def largest(values, least):
    most = least
    for i in range(values.size):
        if values[i] > most:
            most = values[i]
    return most

@njit(**FAST)
def between(values):
    return 10.0 * largest(values, 0.5)

@njit(**FAST)
def caller(values):
    return 1.0 + between(values)
"""

CALLED = """
import numpy as np, kept
from numba.core import event
with event.install_recorder("numba:compile") as compiled:
    print(kept.caller(np.array([2.0, 7.0])), kept.caller(np.array([0.25])))
print(*sorted(e.data["dispatcher"].py_func.__name__ for _, e in compiled.buffer if e.is_start))
"""


def test_callers_that_are_loaded_find_it_wherever_it_is_then(tmp_path) -> None:
    (tmp_path / "kept.py").write_text(MODULE)

    def printed() -> list[str]:
        importable = os.pathsep.join([str(tmp_path), *sys.path])
        folders = {"NUMBA_CACHE_DIR": str(tmp_path / "cache"), "PYTHONPATH": importable}
        command = [sys.executable, "-c", CALLED]
        done = subprocess.run(command, env=os.environ | folders, capture_output=True, text=True, check=True)
        return done.stdout.splitlines()

    def forget(name: str) -> None:
        for file in (tmp_path / "cache").rglob(f"kept.{name}*"):
            file.unlink()

    assert printed() == ["71.0 6.0", "between caller largest"]
    forget("caller")
    assert printed() == ["71.0 6.0", "caller"]  # from another one that was loaded
    forget("largest")
    assert printed() == ["71.0 6.0", "largest"]  # before the callers that need it are loaded


def test_a_numba_that_loads_code_in_another_way_is_refused() -> None:
    def rebuild(target_context, libdata, fndesc, env):
        raise AssertionError("is not called")

    with pytest.raises(ImportError, match=r"does not know \(target_context, libdata, fndesc, env\); install a version"):
        require_known(rebuild)
