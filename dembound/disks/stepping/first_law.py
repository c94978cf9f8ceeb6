"""The law with which a run of disks or a static stage begins, also after a stage in which contacts opened or slid."""

from collections.abc import Collection
from typing import NamedTuple

import numpy as np

from dembound.boundaries.platen import Holding
from dembound.casefile.disks.model import DiskCase
from dembound.casefile.types import LAWS
from dembound.disks.body import DiskBody
from dembound.disks.contacts.contact_list import ContactList
from dembound.disks.stepping.balance import Balance
from dembound.disks.stepping.carriers import RestForces
from dembound.disks.stepping.scene_parts import DiskParts, Start
from dembound.kernels import contacts as kernel
from dembound.kernels.contact_measures import slack
from dembound.kernels.contacts import INTACT, SHEAR, TENSION, UPDATED
from dembound.pairwise import P


def never_elastic_again(case: DiskCase) -> str:
    """Why no static stage of a case can be followed by the elastic law; empty if that depends on the settled state."""
    material, law = case.material, LAWS[case.material.law]
    locked_in = material.locked_in is not None and any(table.needs_column for table in case.boundary.values())
    through = "acts through the seam of the free field, which the elastic law does not include"
    reasons = (
        (not law.has_history, f'material.law = "{material.law}" is used from the start'),
        (case.static is None, "there is no static stage"),
        (not law.starts_elastic, f'contacts under material.law = "{material.law}" are stiffer the more they overlap'),
        (case.dashes_at_once, "contacts have dashpots"),
        (case.wall, "disks touch walls, which the elastic law does not include"),
        (case.rolls, "contacts without bonds resist rolling"),
        (case.relaxes, "bonds have relaxation arms, by which their ground is damped"),
        (not material.elastic_start, "material.elastic_start is false"),
        (case.begins_stressed and case.column_sides, f"the stress at rest {through}"),
        (locked_in, f"a locked-in stress {through}"),
    )
    return next((why for holds, why in reasons if holds), "")


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
    touch, rest = now.constants[now.contact_type][:, [P.touch, P.rest]].T
    small.slip[:] += np.where(along_path & (touch >= rest), small.shear - now.shear, 0.0)
    if slack(u, small, pairs.limits, True) > 0.0:
        return small.slip
    return "after the static stage a contact has opened or closed or slides, or a bond is at its strength"


def settled_refused(reason: str) -> tuple[str, ...]:
    """The line on why a requested `reduce.settled` is not applied; empty without a reason."""
    return (f"reduce.settled: not applied: {reason}",) if reason else ()


class FirstLaw(NamedTuple):
    """The law with which a run or a static stage begins.

    has_history : whether it is history-dependent, otherwise it is elastic. goes_on : whether contacts keep the history
    from a static stage. is_elastic_again : whether it is elastic although a static stage had left the
    elastic law; refused : a line with the reason why it is not, if the case asks for it.
    """

    has_history: bool
    goes_on: bool
    is_elastic_again: bool = False
    refused: tuple[str, ...] = ()


def first_law(scene: DiskBody, disks: DiskParts, start: Start | None, datum: np.ndarray, *, settling: bool) -> FirstLaw:
    """The first law of a scene's disks at rest at a datum (3, n).

    start : the settled body they start from, None for a body as built. settling : whether this is a static stage. If
    the elastic law is used again, contacts keep the slip with which it holds.
    """
    case, goes_on = scene.case, start is not None and start.has_history
    is_elastic_again = False
    refused: tuple[str, ...] = ()
    if goes_on and not settling and case.reduce.settled and not never_elastic_again(case):
        reason = elastic_again(disks.contacts.values(), datum)
        is_elastic_again, goes_on, refused = reason == "", reason != "", settled_refused(reason)
    # a stress of the body as built also acts through the seam of a free field, but not under the elastic law
    built_in = case.material.locked_in is not None or case.begins_stressed
    through = bool(disks.seams) and built_in and not settling
    slides = scene.at_rest is not None and scene.at_rest.slides
    never = not scene.ground.law.starts_elastic or case.rolls or bool(case.wall)
    at_once = through or slides or never or not (settling or case.begins_elastic)
    return FirstLaw(goes_on or (scene.has_history and at_once), goes_on, is_elastic_again, refused)


def balanced(
    law: FirstLaw, scene: DiskBody, disks: DiskParts, forces: RestForces, load: np.ndarray, datum: np.ndarray
) -> tuple[Balance, np.ndarray]:
    """The forces that balance a body settled at a datum (3, n), and all steady forces (3, n) under the elastic law.

    load : (3, n) N and N·m, steady forces of loads, which are a part of the latter.
    """
    shift = forces.shift(datum)
    inner = forces.with_history(datum, fresh=not law.goes_on) if scene.has_history else forces.elastic(datum)
    joints = forces.of_joints(datum)
    inner += joints
    force = shift - inner - load
    ended = np.where(let_go(scene), force, 0.0)
    balance = Balance(scene, force - ended, load, datum, forces.across(disks.contacts))
    return balance, shift - forces.elastic(datum) - joints - ended


def let_go(scene: DiskBody, time: float | None = None) -> np.ndarray:
    """Mask (3, n) of what static sides held whose reactions end at a time (s) of the run; None: as it begins."""
    found, static = np.zeros((3, scene.count), dtype=np.bool_), scene.case.static
    for side, table in {}.items() if static is None else static.boundary.items():
        if not (side in scene.edges and isinstance(table, Holding)):
            continue
        if table.reactions == "none" if time is None else table.until == time:
            edge = scene.edges[side]
            found[np.array(table.prescribed(edge.axis))[:, None], table.part_of(edge).nodes] = True
    return found


def not_balanced(law: FirstLaw, scene: DiskBody, forces: RestForces, load: np.ndarray) -> np.ndarray:
    """All steady forces (3, n) of a body as built or in a static stage; load : (3, n) forces of loads.

    The elastic law does not include the forces of the body as built, of a stress locked in or at rest, which are added.
    """
    if law.goes_on:
        return load
    if scene.case.begins_stressed:
        return load + forces.as_built()
    return load + forces.with_history(np.zeros_like(load), fresh=True) if scene.has_history else load
