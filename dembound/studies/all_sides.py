"""Calibration of all sides of a case that have dashpots, for P and S waves as far as their motion is not held."""

from collections.abc import Mapping, Sequence
from typing import Any, get_args

from dembound.boundaries import Motion, axis_of_motion
from dembound.casefile.disks import DiskCase
from dembound.errors import CaseError
from dembound.studies.asked import AS_USUAL, Calibrating
from dembound.studies.calibration import Calibration, Report, calibrate
from dembound.version import __version__


def factors_of(case: DiskCase) -> list[tuple[str, Motion]]:
    """The sides with dashpots but for those on rock, each with the waves ("p", "s") whose motion is not held there.

    Raises CaseError if there are none.
    """
    tables = {side: table for side, table in case.boundary.items() if not table.is_interface}
    each = [(side, motion) for side, table in tables.items() for motion in get_args(Motion) if motion in table.factors]
    found = [(side, motion) for side, motion in each if "xy"[axis_of_motion(side, motion)] not in case.motion.held]
    if not found:
        which = "has no side with dashpots that can move, but for those on rock"
        raise CaseError([f"boundary: {which}, so there is nothing to calibrate"])
    return found


def calibrate_all(case: DiskCase, how: Calibrating = AS_USUAL, *, report: Report | None = None) -> list[Calibration]:
    """Find all factors of a case, in the order of `factors_of`; parameters as for `calibration.calibrate`.

    Each is calibrated separately on the unchanged case, so the result does not depend on the order.

    Raises CaseError when nothing can be calibrated, RunError when a factor does not converge.
    """
    return [calibrate(case, side, how, motion=motion, report=report) for side, motion in factors_of(case)]


def changes_of(found: Sequence[Calibration]) -> dict[str, float]:
    """The factors found by their keys in the case file, such as ``boundary.left.beta_p``."""
    return {f"boundary.{each.side}.{each.factor}": each.result for each in found}


def summary_of(found: Sequence[Calibration]) -> Mapping[str, Any]:
    """All calibrations of one case as plain JSON values: the factors by key, and the summary of each calibration."""
    of = {"name": found[0].case.name, "version": __version__, "method": found[0].method}
    return of | {"result": changes_of(found), "calibrations": [each.summary() for each in found]}
