"""How wrong a run is: what its sides, its grid and its time step add to the motion of its monitors."""

from dembound.studies.estimate.causes import Cause, Causes, Recorded
from dembound.studies.estimate.estimate import Estimate
from dembound.studies.estimate.of_results import estimate_if_asked, estimate_results, require_budget
from dembound.studies.estimate.of_run import BUDGET, causes_of

__all__ = [
    "BUDGET",
    "Cause",
    "Causes",
    "Estimate",
    "Recorded",
    "causes_of",
    "estimate_if_asked",
    "estimate_results",
    "require_budget",
]
