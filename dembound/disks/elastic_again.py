"""The elastic law after a static stage in which contacts opened or slid (`reduce.settled`), and why it may not be used.

The body is elastic about its settled state if its stiffness there is that of the start, see `ContactList.settled_slip`.
"""

from collections.abc import Collection

import numpy as np

from dembound.casefile.disks import DiskCase
from dembound.casefile.types import LAWS
from dembound.disks.contacts import ContactList


def never_elastic_again(case: DiskCase) -> str:
    """Why no static stage of a case can be followed by the elastic law again; empty if its end decides."""
    material = case.material
    if not LAWS[material.law].has_history:
        return f'material.law = "{material.law}" is used from the start'
    if case.static is None:
        return "there is no static stage"
    if not material.elastic_start:
        return "material.elastic_start is false"
    if material.locked_in is not None and any(table.needs_column for table in case.boundary.values()):
        return "a locked-in stress acts through the seam of the free field, which the elastic law does not include"
    return ""


def elastic_again(parts: Collection[ContactList], datum: np.ndarray) -> str:
    """Use the elastic law again, in all parts at rest at the datum (3, n); returns why not, empty if it is used."""
    found = [(pairs, pairs.settled_slip(datum)) for pairs in parts]
    if reasons := [slip for _, slip in found if isinstance(slip, str)]:
        return reasons[0]
    for pairs, slip in found:
        assert isinstance(slip, np.ndarray)
        pairs.use_elastic_law_with(slip)
    return ""


def settled_refused(reason: str) -> tuple[str, ...]:
    """The line of a run that asks for `reduce.settled` in vain, for a reason; none without a reason."""
    return (f"reduce.settled: not applied: {reason}",) if reason else ()
