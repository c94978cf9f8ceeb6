"""The two ways of stepping a scene: when they stop, and what they hand back."""

import numpy as np
import pytest

from dembound.engines import UNWATCHED, Bonded, Elastic
from dembound.kernels.contacts import slack
from dembound.kernels.tables import Body, Log, Supports
from dembound.scene import Scene, build

STEP = 1e-4
FREE_FIELD = {side: {"type": "free_field"} for side in ("left", "right")}
DENSE = {"pattern": "B", "size": [4.0, 4.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [4.0, 4.0]}
REMEMBERS = {"material.law": "linearpbond", "material.fric": 0.5, "material.locked_in": 10e6, "static": {}}
"""Contacts that the locked-in stress keeps closed."""


@pytest.fixture
def scene(bar):
    """Makes random packings that nothing holds or drives."""

    def make(**changes: object) -> Scene:
        bare = {"packing": DENSE, "boundary": {}, "wave": {}, "monitor": [], "motion.held": []}
        return build(bar({**bare, **changes}))

    return make


def advance(
    engine: Elastic | Bonded, body: Scene, steps: int, u: np.ndarray, v: np.ndarray, load: np.ndarray | None = None
) -> int:
    """Advance u and v (3, n) in place without supports and damping, under steady loads (3, n); steps done."""
    load = np.zeros((3, body.count)) if load is None else load
    arrays = Body(STEP / body.mass, STEP / body.inertia, np.ones(3), load, 0.0, STEP)
    nobody, nothing = np.zeros(0, dtype=np.int64), np.zeros((0, 3))
    supports = Supports(nobody, *[nothing] * 5, drive=np.zeros((steps, 0, 3)), seam=body.seam_table(nobody))
    log = Log(nobody, np.empty((steps, 0, 6)), nobody, np.zeros((0, 3, 2)), np.zeros(0), np.zeros((2, 6)))
    return engine.advance(u, np.empty_like(u), v, 0, arrays, supports, log)


def shaken(body: Scene, size: float) -> np.ndarray:
    """Random motions (3, n)."""
    return size * np.random.default_rng(3).uniform(-1.0, 1.0, (3, body.count))


def test_a_scene_without_memory_is_not_watched(scene) -> None:
    body = scene()
    engine, u, v = Elastic(body, None), shaken(body, 0.0), shaken(body, 1e3)

    assert UNWATCHED.arms.size == 0
    assert advance(engine, body, 5, u, v) == 5  # though surfaces have moved by half a metre
    assert not engine.ended
    assert np.abs(u).max() > 0.1


@pytest.mark.parametrize("boundary", [{}, FREE_FIELD], ids=["free", "free field"])
def test_elastic_forces_are_those_of_the_pairs_without_what_was_locked_in(scene, boundary: dict) -> None:
    body = scene(**REMEMBERS, boundary=boundary)
    contacts, u = body.contact_list(), shaken(body, 1e-6)
    locked_in = contacts.forces(np.zeros_like(u), reference=True)
    contacts.adopt(u)
    total = contacts.forces(u, reference=True)

    # sums of some five locked-in forces, of which the difference is taken
    scale = np.abs(contacts.arrays.force[:, :2]).max()
    difference = total - locked_in
    found = Elastic(body, contacts).force(u)
    np.testing.assert_allclose(found, difference, rtol=0.0, atol=20.0 * np.finfo(float).eps * scale)
    assert np.abs(found).max() > 1e6 * 20.0 * np.finfo(float).eps * scale
    assert (body.seam is not None) == bool(boundary)


def test_the_elastic_law_ends_before_the_step_that_leaves_it(scene) -> None:
    body = scene(**REMEMBERS)
    contacts = body.contact_list()
    engine, u, v = Elastic(body, contacts), shaken(body, 0.0), shaken(body, 1.0)
    done = advance(engine, body, 200, u, v)

    assert engine.ended
    assert 0 < done < 200
    assert slack(u, contacts.arrays, contacts.limits) < 0.0
    # one step back it was still inside: run again, to just there
    again, u, v = Elastic(body, contacts), shaken(body, 0.0), shaken(body, 1.0)
    assert advance(again, body, done, u, v) == done
    assert not again.ended
    assert slack(u - STEP * v, contacts.arrays, contacts.limits) >= 0.0


@pytest.mark.parametrize("law", [Elastic, Bonded])
def test_an_old_list_is_made_anew_and_time_goes_on(scene, law: type) -> None:
    body = scene(**REMEMBERS)
    contacts = body.contact_list()
    engine = Elastic(body, contacts) if law is Elastic else Bonded(contacts)
    u, v = np.zeros((3, body.count)), np.zeros((3, body.count))
    v[0] = 10.0  # all together, so that nothing happens between them: 1 mm a step, the skin is 5 cm
    contacts.forces(u)
    rest = -contacts.last_forces() if law is Bonded else np.zeros_like(u)
    half = 0.5 * contacts.skin / (10.0 * STEP)
    done = advance(engine, body, 60, u, v, rest)

    assert done == int(half) + 1
    assert not engine.ended
    assert np.array_equal(contacts.origin, u[:2])
    assert advance(engine, body, 10, u, v, rest) == 10
    np.testing.assert_allclose(u[0], (done + 10) * 10.0 * STEP, rtol=1e-9)


def test_both_laws_move_a_body_alike_as_long_as_nothing_gives_way(scene) -> None:
    # with the normals and arms of the start, for bonds and the contacts beside them
    body = scene(**REMEMBERS, **{"material.geometry": "reference"})
    moves, v = [], shaken(body, 1e-4)
    for engine in (Elastic(body, body.contact_list()), Bonded(body.contact_list())):
        u, locked_in = np.zeros((3, body.count)), np.zeros((3, body.count))
        if isinstance(engine, Bonded):
            locked_in = engine.contacts.forces(u)
            engine.contacts.adopt(-STEP * v)  # its first push adds this step
        assert advance(engine, body, 50, u, v.copy(), -locked_in) == 50
        moves.append(u)

    # locked-in forces of 5 MN are rounded in every step; beside them those of the motion are 1e9 N/m · 1e-4 m/s · Δt
    rounding = 50 * 10.0 * np.finfo(float).eps * 5e6 / (1e9 * 1e-4 * STEP)
    assert np.abs(moves[0] - moves[1]).max() < rounding * np.abs(moves[0]).max()
