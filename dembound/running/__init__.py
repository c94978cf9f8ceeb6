"""Runs cases: from their tables, or from a checkpoint, to folders of results."""

# ruff: noqa: F401  # what the other packages use

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
