"""The static stage: where it comes to rest, and its messages where it cannot."""

from types import SimpleNamespace

import numpy as np
import pytest
from disk_systems import DENSE
from settling import FIXED, MASS, STANDING, WEIGHT, WRAP, G, scene
from small_cases import SURROUNDED, around, small

from dembound.disks.rest import stage
from dembound.disks.rest.loading import LEAST, LOOK, Loading
from dembound.disks.rest.stage import require_stages, settle
from dembound.disks.rest.static_scene import StaticScene
from dembound.disks.scene import build
from dembound.disks.stepping.scene_parts import joint_ties
from dembound.disks.stepping.system import DiskSystem
from dembound.errors import CaseError, RecordError, RunError
from dembound.kernels.contacts import TENSION
from dembound.motion.kind import StalledError
from dembound.motion.simulation import Simulation

K = 2500.0 * 1000.0**2
"""Normal stiffness of a lattice contact and its bond, N/m."""


def test_bonds_may_break_on_the_way_and_stay_broken(bar) -> None:
    hanging = {"packing.size": [0.5, 4.0], "motion.held": ["x", "rotation"], "material.law": "linearpbond"}
    # the top bond of eight would carry seven weights over 0.5 m: 7 · 625 · 9.81/0.5 Pa
    limit = 7.0 * MASS * G / 0.5
    static = {"ratio": 1e-6, "boundary": {"top": FIXED, "bottom": FIXED}}
    nothing = {"name": "gap", "type": "circle", "centre": [0.25, 1.0], "radius": 0.2, "stage": "after"}
    held = settle(scene(bar, **WEIGHT, **hanging, static=static, **{"material.pb_ten": limit}))
    changes = {**hanging, "static": static, "material.pb_ten": 0.3 * limit, "hole": [nothing]}
    settled = settle(scene(bar, **WEIGHT, **changes))
    weak = settled.before

    assert len(held.cracks) == 0
    assert weak is not None
    assert len(weak.cracks) == 1
    assert weak.cracks.position[0, 1] == pytest.approx(3.5, abs=1e-3)  # below the fixed top disk
    assert not weak.cracks.shear[0]
    assert weak.start.has_history
    assert len(settled.cracks) == 0
    assert np.count_nonzero(settled.start.contacts["body"].arrays.state == TENSION) == 1


DEEP = {"ground": {"size": [12.0, 20.0]}, "packing.size": [12.0, 8.0], "monitor": []} | {
    "boundary": around("periodic", "left", "right") | around("outside", "bottom", "top"),
    "load": [{"name": "house", "force": [0.0, -1e3], "region": [2.0, 18.0, 9.0, 20.0]}],
    "static": {"boundary": {"bottom": FIXED}},
}
SAMPLE = {"boundary": {}, "static": {"stress": [-1e5, -1e5, 0.0]}} | {
    "hole": [{"name": "s", "type": "circle", "centre": [6.0, 3.0], "radius": 2.0, "keep": "inside"}]
}


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        (DEEP, "load.house: acts on the surface of the continuum, which the static stage is without"),
        (SAMPLE, "static.stress: acts on no disk at left and right and bottom and top"),
    ],
)
def test_what_a_static_stage_cannot_have_is_refused_before_any_step(changes, said) -> None:
    tables = {key: table for key, table in SURROUNDED.items() if key != "outside" or "ground" in changes}
    with pytest.raises(CaseError, match=said):
        require_stages(build(small(tables, changes=changes)))


@pytest.mark.parametrize("ratio", [None, 1e-4])
def test_contacts_that_slide_come_closer_to_rest_by_default(bar, ratio: float | None) -> None:
    """With K0 they begin under their own law; forces of the ground beside are no residual."""
    boundary = {side: {"type": "free_field"} for side in ("left", "right")}
    static = {"k0": 0.2, "boundary": {"bottom": FIXED}, **({} if ratio is None else {"ratio": ratio})}
    law = {"material.law": "linearpbond", "material.fric": 0.2, "material.elastic_start": False}
    body = {"packing.size": [3.0, 4.0], "boundary": boundary, "static": static}
    settled = settle(scene(bar, **{**STANDING, **law, **body}))

    (column,) = settled.columns
    for each in (settled, column):
        assert each.start.has_history
        assert each.ratio <= (ratio or 1e-7)
        assert each.mean_residual <= 2.0 * each.ratio * 4.0 * MASS * G * 8


PATIENCE = 10_000


def test_a_body_that_slides_without_end_stalls(bar, monkeypatch) -> None:
    # two rows of loose disks of which the upper, held at its height, has nothing to stop it
    loose = {"material.law": "linearpbond", "material.contact_share": 1.0, "material.fric": 0.1}
    push = {"name": "push", "acceleration": [G, 0.0]}
    changes = {"packing.size": [1.0, 1.0], "motion.held": ["y", "rotation"], "boundary": WRAP, "load": [push]}
    monkeypatch.setattr(stage, "PATIENCE", PATIENCE)
    looks: list[float] = []
    with pytest.raises(RunError, match=r"stalls at an unbalanced force ratio of (?s:.*)is the body held") as caught:
        settle(scene(bar, **{**changes, **loose}), lambda _, ratio, stage: looks.append(ratio))

    assert f"an unbalanced force ratio of {looks[-1]:.3g} after {len(looks) * LOOK:,} steps" in str(caught.value)
    assert PATIENCE <= len(looks) * LOOK < 2 * PATIENCE


LOOSE = {"packing.size": [2.0, 2.5], "material.law": "linearpbond", "material.contact_share": 1.0} | {
    "material.fric": 0.5,
    "material.elastic_start": False,
}
"""Four disks by five, which only touch."""

LOADED = 60 * LOOK
"""Steps after which such a body has left the elastic law and has all its loads."""

PULLS = {(1.75, 0.75): 3.0, (1.75, 1.25): 2.5, (1.75, 1.75): 4.0, (1.75, 2.25): 2.0, (0.25, 1.25): -2.5}
"""Forces (N) along x on some of them, which part from the rest; half of all is that of the largest two."""


def test_a_stalled_stage_names_who_lacks_most_and_how_many_lack_half(bar) -> None:
    loads = [
        {"name": f"pull{number}", "force": [force, 0.0], "position": list(place)}
        for number, (place, force) in enumerate(PULLS.items())
    ]
    static = {"ratio": 1e-8, "max_steps": LOADED, "boundary": {"bottom": FIXED}}
    body = scene(bar, load=loads, static=static, **LOOSE)
    with pytest.raises(StalledError) as caught:
        settle(body)
    node = {place: int(np.argmin(np.hypot(*(body.positions - place).T))) for place in PULLS}

    unbalanced = np.zeros((body.count, 2))
    for place, force in PULLS.items():
        unbalanced[node[place], 0] = force
    assert np.array_equal(caught.value.unbalanced, unbalanced)
    assert str(caught.value).splitlines()[1:3] + str(caught.value).splitlines()[4:] == [
        f"unbalanced force on particle {node[1.75, 1.75]} at (1.75, 1.75) m: (4, 0) N",
        f"unbalanced force on particle {node[1.75, 0.75]} at (1.75, 0.75) m: (3, 0) N",
        "2 of 20 particles have half of all unbalanced force, between (1.75, 0.75) and (1.75, 1.75) m",
        "allow more with static.max_steps",
    ]


def test_a_stage_in_which_a_joint_slides_names_it(bar) -> None:
    joint = {"name": "bedding", "points": [[-1.0, 1.0], [5.0, 1.0]], "kn": 1e8, "ks": 1e8, "fric": 0.1}
    loads = [{"name": "weight", "acceleration": [0.5 * G, -G]}]
    body = {"packing.size": [4.0, 2.0], "joint": [joint], "load": loads, "motion.held": ["rotation"]}
    with pytest.raises(StalledError, match=r"broken bonds: 0; joint bedding slides, so far by up to [\d.]+ m\n"):
        settle(scene(bar, static={"max_steps": LOADED, "boundary": {"bottom": FIXED}}, **body))


def test_a_body_with_joints_that_another_version_has_settled_is_refused_in_one_line(bar) -> None:
    joint = {"name": "bedding", "points": [[-1.0, 1.0], [5.0, 1.0]], "kn": 1e8, "ks": 1e8, "fric": 0.1}
    body = scene(
        bar, **WEIGHT, **{"packing.size": [4.0, 2.0], "joint": [joint]}, static={"boundary": {"bottom": FIXED}}
    )
    joints = {"joint_bedding/counts": np.zeros(4, dtype=np.int64)}
    with pytest.raises(RecordError, match=r"^the settled body is not of this version of dembound \(.*\); run the case"):
        joint_ties(body, SimpleNamespace(joints=joints), 1e-4)


def test_what_a_stage_lacks_is_what_its_contacts_and_loads_come_to_over_the_pairs_that_act(bar) -> None:
    ratios: list[float] = []
    static = {"ratio": 1e-8, "max_steps": LOOK, "boundary": {"bottom": FIXED}}
    tough = {"material.law": "linearpbond", "material.elastic_start": False, "material.fric": 0.5}
    body = scene(bar, **{**STANDING, **tough, "static": static})
    with pytest.raises(
        StalledError, match=r"in 100 steps, static\.ratio requests 1e-08; (?s:.*)static\.max_steps"
    ) as caught:
        settle(body, lambda _, ratio, stage: ratios.append(ratio))
    contacts, total = caught.value.run.system.contacts["body"], body.steady_load.copy()
    for i, j, (fx, fy, *_) in zip(*contacts.pairs, contacts.force, strict=True):
        total[:2, i] += [fx, fy]
        total[:2, j] -= [fx, fy]
    total[:, body.edges["bottom"].nodes] = 0.0

    # a few forces of the weight of eight
    np.testing.assert_allclose(caught.value.unbalanced, total[:2].T, rtol=0.0, atol=1e-14 * 8.0 * MASS * G)
    assert np.abs(total).max() > 1e-3 * MASS * G
    # pairs of the list that do not push say nothing of how strong forces are; those that are held lack nothing
    lacking = np.hypot(*caught.value.unbalanced.T)
    pair = np.hypot(*contacts.force[:, :2].T)
    assert 0 < np.count_nonzero(pair == 0.0) < len(pair)
    assert np.count_nonzero(lacking) == body.count - len(body.edges["bottom"].nodes)
    assert ratios[-1] == pytest.approx(lacking.mean() / pair[pair > 0.0].mean(), rel=1e-12)


def test_a_floating_body_is_kept_from_moving_and_turning_as_a_whole(bar) -> None:
    static = {"ratio": 1e-8, "max_steps": LOOK // 2, "stress": [-3e6, 2e6, 1e6]}
    body = scene(bar, packing=DENSE, static=static)
    with pytest.raises(StalledError) as caught:  # right after a look
        settle(body)
    state = caught.value.run.state
    x, y = body.positions.T + state.displacement[:2]
    vx, vy, spin = state.velocity
    around_middle = body.mass * ((x - x.mean()) * vy - (y - y.mean()) * vx)
    momenta = np.array([[body.mass * vx, 0.0 * x], [body.mass * vy, 0.0 * x], [around_middle, body.inertia * spin]])

    # local damping takes from each disk alone, so that without a cure something would be left; some 150 disks' parts,
    # each rounded by 1e-16, cancel
    assert np.abs(momenta[2, 1].sum()) > 1e-3 * np.abs(momenta[2, 1]).sum()
    assert (np.abs(momenta.sum(axis=(1, 2))) < 1e-13 * np.abs(momenta).sum(axis=(1, 2))).all()


def test_stress_along_a_periodic_axis_is_there_from_the_start(bar) -> None:
    stress = (-1e6, -2e6, 0.4e6)
    settled = settle(scene(bar, boundary=WRAP, static={"stress": stress}, **{"packing.size": [1.0, 1.0]}))
    np.testing.assert_allclose(settled.stress, stress, rtol=1e-12)


SHEAR = 0.4e6
STRESS = {"ratio": 1e-8, "stress": [-1e6, -1e6, SHEAR]}
LAW = {"material.law": "linearpbond", "material.fric": 2.0, "packing.size": [8.0, 8.0]}


def sheared(bar, **changes: object) -> SimpleNamespace:
    """A lattice at its start, with the displacements (3, n) at which it is at rest under the elastic law."""
    whole = scene(bar, static=STRESS, **{**LAW, **changes})
    body = StaticScene(whole, whole.case.static)
    none = np.zeros((3, whole.count))
    system = DiskSystem(body.scene, 1e-5, settling=True, load=body.load(none))
    state = Simulation(body.scene, 1e-5, system=system).state
    x, y = whole.positions.T
    # k = K for normals and shears, and two shears a half each without rotation of disks
    rest = np.stack([-1e6 / K * x + SHEAR / K * y, -1e6 / K * y + SHEAR / K * x, 0.0 * x])
    return SimpleNamespace(body=body, system=system, state=state, rest=rest, loading=Loading(body, system, none, 1e-4))


def out_of_balance(found: SimpleNamespace) -> np.ndarray:
    """Forces (3, n) of contacts and loads at the present displacements."""
    for pairs in found.system.contacts.values():
        pairs.push(found.state.displacement)
    return found.system.forces.last(found.system.contacts) + found.system.load


@pytest.mark.parametrize("share", [0.25, 0.6])
def test_the_elastic_way_ends_where_the_first_bond_is_at_its_strength(bar, share: float) -> None:
    """Bonds have half of the shear stress, as contacts are as stiff; nothing is out of balance where it ends."""
    found = sheared(bar, **{"material.pb_coh": share * 0.5 * SHEAR, "material.geometry": "reference"})
    found.state.displacement = found.rest
    assert not found.loading.is_the_answer(found.state)
    assert found.system.uses_history
    reached = np.abs(found.state.displacement).max() / np.abs(found.rest).max()
    assert share - 2.0**-11 < reached <= share
    assert len(found.system.contacts["body"].take_cracks()) == 0

    found.loading.put_on(found.state)
    assert np.abs(out_of_balance(found)).max() < 1e-9 * 1e6
    ends = LOOK * int(np.ceil((1.0 - reached) * LEAST))
    assert [found.loading.is_rising(step) for step in (0, ends - 1, ends)] == [True, True, False]
    # half-way there is half of what remains, at the end all
    left = []
    for found.state.step in (0, ends // 2, ends):
        found.loading.put_on(found.state)
        left.append(np.abs(found.system.load - found.body.load(found.state.displacement)).max())
    assert left[1] == pytest.approx(0.5 * left[0], rel=LOOK / ends)
    assert left[2] == 0.0
    assert left[0] == pytest.approx((1.0 - reached) * 0.5 * 1e6, rel=0.5)  # of a disk at a side, with its shear
