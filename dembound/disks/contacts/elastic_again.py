"""The elastic law after a static stage in which contacts opened or slid (`reduce.settled`), and why it may not be used.

The body is elastic about its settled state if its stiffness there is that of the start, see `settled_slip`.
"""

from collections.abc import Collection

import numpy as np

from dembound.casefile.disks import DiskCase
from dembound.casefile.types import LAWS
from dembound.disks.contacts.contact_list import ContactList
from dembound.kernels import contacts as kernel
from dembound.kernels.contact_measures import slack
from dembound.kernels.contacts import INTACT, SHEAR, TENSION, UPDATED


def never_elastic_again(case: DiskCase) -> str:
    """Why no static stage of a case can be followed by the elastic law; empty if that depends on the settled state."""
    material = case.material
    if not LAWS[material.law].has_history:
        return f'material.law = "{material.law}" is used from the start'
    if case.static is None:
        return "there is no static stage"
    if material.has_dashpots:
        return "contacts have dashpots"
    if not material.elastic_start:
        return "material.elastic_start is false"
    if case.begins_stressed and case.column_sides:
        return "the stress at rest acts through the seam of the free field, which the elastic law does not include"
    if material.locked_in is not None and any(table.needs_column for table in case.boundary.values()):
        return "a locked-in stress acts through the seam of the free field, which the elastic law does not include"
    return ""


def elastic_again(parts: Collection[ContactList], datum: np.ndarray) -> str:
    """Use the elastic law again in all parts at rest at the datum (3, n); returns why not, "" if it is used."""
    found = [(pairs, settled_slip(pairs, datum)) for pairs in parts]
    if reasons := [slip for _, slip in found if isinstance(slip, str)]:
        return reasons[0]
    for pairs, slip in found:
        assert isinstance(slip, np.ndarray)
        pairs.use_elastic_law_with(slip)
    return ""


def settled_slip(pairs: ContactList, displacement: np.ndarray) -> np.ndarray | str:
    """The slip, in the places of the pairs' `arrays`, with which the elastic law holds again at displacements (3, n).

    Returns the reason in words where it does not hold: a contact that was closed at the start is open or slides, one
    that was open is closed, or a bond is broken. Where shear is counted along the path, its difference from the shear
    of small displacements becomes slip.
    """
    state, own = pairs.of("state"), pairs.of("contact_type") < pairs.own_types
    if ((state == TENSION) | (state == SHEAR)).any():
        return "a bond broke in the static stage"
    if np.count_nonzero(own) < len(pairs.assembly.pairs):
        return "disks that touched at the start are far apart"
    now, u = pairs.arrays, pairs.spread(displacement)
    small = now._replace(shear=now.shear.copy(), slip=now.slip.copy())
    kernel.start_from_displacements(u, small, True)
    along_path = (pairs.limits.geometry == UPDATED) | (now.state != INTACT)
    touch, rest = now.constants[now.contact_type][:, [3, 2]].T
    small.slip[:] += np.where(along_path & (touch >= rest), small.shear - now.shear, 0.0)
    if slack(u, small, pairs.limits, True) > 0.0:
        return small.slip
    return "after the static stage a contact has opened or closed or slides, or a bond is at its strength"


def settled_refused(reason: str) -> tuple[str, ...]:
    """The line on why a requested `reduce.settled` is not applied; empty without a reason."""
    return (f"reduce.settled: not applied: {reason}",) if reason else ()
