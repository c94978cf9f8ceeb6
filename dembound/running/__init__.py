"""Runs cases: from their tables, or from a checkpoint, to folders of results."""

from dembound.running.job import SECTIONS, Progress, Reports, resume_case, run_case
from dembound.running.planning import (
    MOST_STEPS,
    plan,
    preflight,
    require_ready,
    simulation_of,
    space_in_words,
    space_warnings,
    warnings_before,
)
from dembound.running.recorded import Shared
from dembound.running.unfinished import replaced_in_words

__all__ = [
    "MOST_STEPS",
    "SECTIONS",
    "Progress",
    "Reports",
    "Shared",
    "plan",
    "preflight",
    "replaced_in_words",
    "require_ready",
    "resume_case",
    "run_case",
    "simulation_of",
    "space_in_words",
    "space_warnings",
    "warnings_before",
]
