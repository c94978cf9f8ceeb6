"""dembound: waves in bonded particles, with artificial boundaries that absorb.

From Python: `load`, `case`, `change`, `run`, `estimate`, `resume`, `calibrate`, `calibrate_all`, `laboratory_test` and
`Results`; see `dembound.api` and docs/start/python.md.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from dembound.version import __version__ as __version__

if TYPE_CHECKING:
    from dembound.api import (
        Advice,
        Arrays,
        Budget,
        Calibration,
        Case,
        CaseError,
        CaseWarning,
        DemboundError,
        NameMissingError,
        PackingError,
        Progress,
        RecordError,
        Results,
        RunError,
        advise,
        calibrate,
        calibrate_all,
        case,
        change,
        estimate,
        laboratory_test,
        load,
        loads,
        resume,
        run,
    )

__all__ = [
    "Advice",
    "Arrays",
    "Budget",
    "Calibration",
    "Case",
    "CaseError",
    "CaseWarning",
    "DemboundError",
    "NameMissingError",
    "PackingError",
    "Progress",
    "RecordError",
    "Results",
    "RunError",
    "advise",
    "calibrate",
    "calibrate_all",
    "case",
    "change",
    "estimate",
    "laboratory_test",
    "load",
    "loads",
    "resume",
    "run",
]


def __dir__() -> list[str]:
    """The names of `api` and the version, also before `api` is imported."""
    return sorted([*__all__, "__version__"])


def __getattr__(name: str) -> Any:
    """A name of `api`; `api` is imported when the first one is used, as the kernels do not need it."""
    if name in __all__:
        return getattr(import_module("dembound.api"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
