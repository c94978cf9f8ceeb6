"""Parts of bonded disks: when their law ends, what they do then, and what ties the column to the body."""

import numpy as np
import pytest
from disk_systems import BONDED, ELASTIC, FREE_FIELD, STEP, TOUGH, WITH_HISTORY, shaken

from dembound.disks.contacts.contact_list import ContactList
from dembound.disks.scene import DiskScene
from dembound.disks.stepping.part import DiskPart
from dembound.disks.stepping.system import DiskSystem
from dembound.kernels import elastic, loop
from dembound.kernels.bonded import seam_ends_forces
from dembound.kernels.common import BROKE, DONE, LAW_ENDS, LIST_ENDS
from dembound.kernels.contact_measures import slack
from dembound.kernels.tables import Body, Log, Supports
from dembound.motion.state import State


def part_of(body: DiskScene, law: str = ELASTIC) -> DiskPart:
    """The only part of a scene without a column, as built, under a law."""
    (part,) = DiskSystem(body, STEP).parts
    part.uses_history = law == BONDED
    return part


def listed(part: DiskPart) -> ContactList:
    """The pairs of a part with a history."""
    assert part.contacts is not None
    return part.contacts


def forces_of(part: DiskPart, displacement: np.ndarray) -> np.ndarray:
    """Forces and moments (3, n) of the history-dependent law at displacements (3, n) reached at rest."""
    total = np.zeros_like(displacement)
    listed(part).push(displacement)
    listed(part).add_forces(total)
    return total


def advance(
    part: DiskPart, body: DiskScene, steps: int, u: np.ndarray, v: np.ndarray, load: np.ndarray | None = None
) -> tuple[int, int]:
    """Advance u and v (3, n) of a part in place without supports and damping; steps done, and why no more.

    load (3, n) : steady forces and moments. The part has reacted to what happened.
    """
    load = np.zeros((3, body.count)) if load is None else load
    arrays = Body(STEP / body.mass, STEP / body.inertia, np.ones(3), load, 0.0, STEP)
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


def test_a_list_that_is_not_old_stays(loose) -> None:
    body = loose(**WITH_HISTORY)
    part, moved = part_of(body), np.zeros((3, body.count))
    arrays, still = listed(part).arrays, np.zeros((3, body.count))

    def react(why: int) -> bool:
        """Whether the part lists its pairs anew."""
        part.react(why, 0, State(body.layout, moved, still, still, np.zeros((0, 3, 2)), np.zeros(0)))
        return listed(part).arrays is not arrays

    # that of another part may be
    moved[0, ::2] = 0.99 * listed(part).skin
    assert not react(LIST_ENDS)
    moved[0, 1::2] = 100.0  # all are carried along
    moved[0, ::2] = 100.0 + 0.99 * listed(part).skin
    assert not react(LIST_ENDS)
    moved[0, ::2] = 100.0 + 1.01 * listed(part).skin
    assert not any(react(why) for why in (DONE, LAW_ENDS, BROKE))
    assert react(LIST_ENDS)


@pytest.mark.parametrize("stops", [False, True])
def test_a_part_may_stop_after_a_step_that_breaks_bonds(loose, stops: bool) -> None:
    body = loose(**TOUGH, **{"material.pb_ten": 1e6, "material.pb_coh": 1e6})
    part = part_of(body, BONDED)
    part.stops_at_breaks = stops
    u, v = np.zeros((3, body.count)), shaken(body, 1.0)
    done, why = advance(part, body, 40, u, v)
    cracks = part.take_cracks(done)

    assert len(cracks) > 0
    assert (why, done < 40) == ((BROKE, True) if stops else (DONE, False))
    assert set(cracks.step) == {done - 1} if stops else len(set(cracks.step)) > 1
    assert len(part.take_cracks(done)) == 0


@pytest.mark.parametrize("law", [ELASTIC, BONDED])
def test_rows_of_the_seam_stand_at_its_nodes_among_all_that_are_supported(loose, law: str) -> None:
    system = DiskSystem(loose(**TOUGH, boundary=FREE_FIELD), STEP)
    (tie,), contacts, u = system.ties, system.contacts["column"], shaken(system.scene, 1e-6)
    system.parts[0].uses_history = law == BONDED
    contacts.push(u)
    supported = np.union1d(tie.nodes, np.arange(0, system.scene.count, 3))
    bundle = tie.bundle(supported)
    before = np.random.default_rng(4).uniform(-1.0, 1.0, (len(supported), 3))
    force = before.copy()
    (elastic.seam_forces if law == ELASTIC else seam_ends_forces)(bundle, u, u, force)
    expected = tie.elastic_forces(u) if law == ELASTIC else tie.last_forces(contacts)
    at = np.isin(supported, tie.nodes)

    assert 0 < np.count_nonzero(at) < len(at)
    assert np.array_equal(force[at], before[at] + expected.T)
    assert np.array_equal(force[~at], before[~at])


def test_the_energy_of_the_elastic_law_is_that_of_its_own_contacts(loose) -> None:
    plain, watched = loose(), loose(**{"material.law": "linearpbond"})
    u = shaken(plain, 1e-6)

    # the same contacts, in another order
    assert part_of(watched).stored(u) == pytest.approx(part_of(plain).stored(u), rel=1e-13)


def test_both_laws_move_a_body_alike_as_long_as_nothing_gives_way(loose) -> None:
    # with the normals and arms of the start, for bonds and the contacts beside them
    body = loose(**WITH_HISTORY, **{"material.geometry": "reference"})
    moves, v = [], shaken(body, 1e-4)
    for law in (ELASTIC, BONDED):
        part = part_of(body, law)
        u, locked_in = np.zeros((3, body.count)), np.zeros((3, body.count))
        if law == BONDED:
            locked_in = forces_of(part, u)
            listed(part).start_from_displacements(-STEP * v)  # its first push adds this step
        assert advance(part, body, 50, u, v.copy(), -locked_in) == (50, DONE)
        moves.append(u)

    # locked-in forces of 5 MN are rounded in every step; beside them those of the motion are 1e9 N/m · 1e-4 m/s · Δt
    rounding = 50 * 10.0 * np.finfo(float).eps * 5e6 / (1e9 * 1e-4 * STEP)
    assert np.abs(moves[0] - moves[1]).max() < rounding * np.abs(moves[0]).max()
