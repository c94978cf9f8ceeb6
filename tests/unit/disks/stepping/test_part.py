"""Parts of bonded disks: when their law ends, and what they do then."""

import numpy as np
from disk_systems import STEP, WITH_HISTORY, shaken

from dembound.disks.contacts.contact_list import ContactList
from dembound.disks.scene import DiskScene
from dembound.disks.stepping.part import DiskPart
from dembound.disks.stepping.system import DiskSystem
from dembound.kernels import loop
from dembound.kernels.common import DONE, LAW_ENDS
from dembound.kernels.contact_measures import slack
from dembound.kernels.tables import Body, Log, Supports
from dembound.motion.state import State


def part_of(body: DiskScene) -> DiskPart:
    """The only part of a scene without a column, as built, under the elastic law."""
    (part,) = DiskSystem(body, STEP).parts
    part.uses_history = False
    return part


def listed(part: DiskPart) -> ContactList:
    """The pairs of a part with a history."""
    assert part.contacts is not None
    return part.contacts


def advance(part: DiskPart, body: DiskScene, steps: int, u: np.ndarray, v: np.ndarray) -> tuple[int, int]:
    """Advance u and v (3, n) of a part in place without supports, loads and damping; steps done, and why no more.

    The part has reacted to what happened.
    """
    arrays = Body(STEP / body.mass, STEP / body.inertia, np.ones(3), np.zeros((3, 0)), 0.0, STEP)
    nobody, nothing = np.zeros(0, dtype=np.int64), np.zeros((0, 3))
    drive = np.zeros((steps, 0, 3))
    supports = Supports(nobody, *[nothing] * 5, drive=drive, twin=nobody, follow=nothing)
    log = Log(nobody, np.empty((steps, 0, 6)), nobody, np.zeros((0, 3, 2)), np.zeros(0), np.zeros((2, 7)), np.zeros(1))
    done, why = loop.advance(u, np.zeros_like(u), v, 0, (part.law(),), (), None, arrays, supports, log)
    part.react(int(why), int(done), State(body.layout, u, v, np.zeros_like(u), np.zeros((0, 3, 2)), np.zeros(0)))
    return int(done), int(why)


def test_the_elastic_law_ends_before_the_step_that_leaves_it(loose) -> None:
    body = loose(**WITH_HISTORY)
    part, u, v = part_of(body), shaken(body, 0.0), shaken(body, 1.0)
    contacts, origin = listed(part), listed(part).origin
    done, why = advance(part, body, 200, u, v)

    assert why == LAW_ENDS
    assert 0 < done < 200
    assert slack(u, contacts.arrays, contacts.limits, False) < 0.0
    assert contacts.origin is origin
    # one step back it was still inside: run again, to just there
    again, u, v = part_of(body), shaken(body, 0.0), shaken(body, 1.0)
    assert advance(again, body, done, u, v) == (done, DONE)
    assert slack(u - STEP * v, contacts.arrays, contacts.limits, False) >= 0.0
