"""The causes of the error of a run of any kind of body."""

from __future__ import annotations

from collections.abc import Mapping

from dembound.casefile import Case
from dembound.casefile.bar import BarCase
from dembound.casefile.disks import DiskCase
from dembound.studies.estimate.causes import Causes, Recorded

BUDGET, SHORT = 0.1, 5e7
"""Share of the work of a run that its estimate may take by default, and work that it may take in any case.

That is the work of less than a second: short runs have fine companions, too.
"""


def causes_of(
    case: Case, recorded: Mapping[str, Recorded], time_step: float, work: float, budget: float | None = None
) -> Causes:
    """The causes of the error of a run.

    case : to the end of the run. recorded : by monitor, up to the time until which errors are estimated. time_step (s),
    work (in the unit of its kind) : of the run. budget : share of that work that may be spent; None: `BUDGET`, and
    `SHORT` in any case.
    """
    most = max(SHORT, BUDGET * work) if budget is None else budget * work
    if isinstance(case, BarCase):
        from dembound.studies.estimate.bars import causes_of_bar

        return causes_of_bar(case, recorded, time_step)
    from dembound.studies.estimate.disks import causes_of_disks

    assert isinstance(case, DiskCase)
    return causes_of_disks(case, recorded, time_step, work, most)
