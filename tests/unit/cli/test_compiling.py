"""Compiling is reported when a kernel is compiled, and only then."""

import os
import subprocess
import sys
from types import SimpleNamespace

from numba.core import event

from dembound.cli import compiling
from dembound.cli.compiling import MESSAGE, Compilation

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


def compiled(module: str, status: event.EventStatus, name: str = "advance") -> event.Event:
    """What numba sends when it begins or ends to compile a function of a module."""
    dispatcher = SimpleNamespace(py_func=SimpleNamespace(__module__=module, __name__=name))
    return event.Event("numba:compile", status, {"dispatcher": dispatcher})


def test_on_a_terminal_what_is_compiled_is_shown_and_for_how_long(monkeypatch) -> None:
    shown = []
    status = SimpleNamespace(start=lambda: shown.append("begins"), stop=lambda: shown.append("ends"))
    monkeypatch.setattr(compiling.err, "_force_terminal", True)
    monkeypatch.setattr(compiling.err, "status", lambda note: shown.append(note) or status)
    clock = iter([10.0, 12.0, 13.0, 14.0, 20.0, 21.5])
    listener = Compilation(lambda: next(clock))
    begins, ends = event.EventStatus.START, event.EventStatus.END
    listener.notify(compiled("dembound.kernels.loop", begins))
    listener.notify(compiled("dembound.kernels.loop", begins, "_move_blocks"))  # a function within another
    assert str(shown[0].__rich__()) == "compiling for 2 s: move blocks"
    listener.notify(compiled("dembound.kernels.loop", ends, "_move_blocks"))
    assert (shown[1:], listener.note()) == (["begins"], "compiling for 3 s: advance")
    listener.notify(compiled("dembound.kernels.loop", ends))
    assert (shown[2:], listener.note()) == (["ends"], "")
    listener.notify(compiled("dembound.kernels.loop", begins))
    assert listener.note() == "compiling for 6 s: advance"  # 4 s before, 1.5 s now


def test_functions_of_other_packages_are_not_reported(capsys) -> None:
    listener = Compilation()
    for module, said in (("scipy.special", ""), ("dembound.kernels.loop", f"{MESSAGE}\n"), ("dembound.machine", "")):
        listener.notify(compiled(module, event.EventStatus.START))
        assert capsys.readouterr().err == said
