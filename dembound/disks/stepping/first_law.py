"""The law with which a run of disks or a static stage begins, and the steady forces that belong to it.

A scene whose law is history-dependent begins in one of three ways:

- under the elastic law that replaces it until a contact is about to leave the elastic range: a body as built, one that
  settled under the elastic law, and one that is elastic about its settled state according to `reduce.settled`;
- under the history-dependent law from the start, with contacts as the elastic law leaves them;
- under the history-dependent law, with the history that contacts have from a static stage.
"""

from typing import NamedTuple

import numpy as np

from dembound.boundaries.platen import Holding
from dembound.disks.body import DiskBody
from dembound.disks.contacts.elastic_again import elastic_again, never_elastic_again, settled_refused
from dembound.disks.stepping.balance import Balance
from dembound.disks.stepping.disk_parts import DiskParts
from dembound.disks.stepping.rest_forces import RestForces
from dembound.disks.stepping.start import Start


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
    at_once = through or slides or not (settling or case.material.begins_elastic)
    return FirstLaw(goes_on or (scene.has_history and at_once), goes_on, is_elastic_again, refused)


def balanced(
    law: FirstLaw, scene: DiskBody, disks: DiskParts, forces: RestForces, load: np.ndarray, datum: np.ndarray
) -> tuple[Balance, np.ndarray]:
    """The forces that balance a body settled at a datum (3, n), and all steady forces (3, n) under the elastic law.

    load : (3, n) N and N·m, steady forces of loads, which are a part of the latter.
    """
    shift = forces.shift(datum)
    inner = forces.with_history(datum, fresh=not law.goes_on) if scene.has_history else forces.elastic(datum)
    force = shift - inner - load
    ended = np.where(_let_go(scene), force, 0.0)
    balance = Balance(scene, force - ended, load, datum, forces.across(disks.contacts))
    return balance, shift - forces.elastic(datum) - ended


def _let_go(scene: DiskBody) -> np.ndarray:
    """Mask (3, n) of what static sides held whose reactions end when the run begins."""
    found, static = np.zeros((3, scene.count), dtype=np.bool_), scene.case.static
    for side, table in {}.items() if static is None else static.boundary.items():
        if side in scene.edges and isinstance(table, Holding) and table.reactions == "none":
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
