"""Runs cases: from their tables, or from a checkpoint, to folders of results."""

from dembound.running.disk_space import space_in_words, space_warnings
from dembound.running.job import SECTIONS, resume_case, run_case
from dembound.running.planning import MOST_STEPS, plan, preflight, require_ready, simulation_of, warnings_before
from dembound.running.progress import Progress, Reports
from dembound.running.replaced import replaced_in_words
from dembound.running.shared import Shared

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
