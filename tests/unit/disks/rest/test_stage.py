"""The static stage: where it comes to rest."""

import numpy as np
import pytest
from disk_systems import DENSE
from settling import FIXED, MASS, STANDING, WEIGHT, G, scene
from small_cases import SURROUNDED, small

from dembound.boundaries.edge import SIDES
from dembound.disks.rest.loading import LOOK
from dembound.disks.rest.stage import require_stages, settle
from dembound.disks.rest.static_scene import StaticScene
from dembound.disks.scene import DiskScene, build, column_alone
from dembound.errors import CaseError
from dembound.kernels.contacts import TENSION

K = 2500.0 * 1000.0**2
"""Normal stiffness of a lattice contact and its bond, N/m."""


@pytest.mark.parametrize("law", ["elastic", "linearpbond"])
def test_a_lattice_sinks_under_its_weight_as_its_columns_say(bar, law: str) -> None:
    looks: list[tuple[int, float]] = []
    body = scene(bar, **{**STANDING, "material.law": law})
    settled = settle(body, lambda steps, ratio, _: looks.append((steps, ratio)))
    # disk by disk from below: the contacts carry the weight of three, two and one disks
    sunk = np.cumsum([0.0, 3.0, 2.0, 1.0]) * MASS * G / K
    found = np.sort(settled.start.displacement[1])[::-1].reshape(4, 2)

    # the ratio of 1e-8 leaves 1e-8 of the mean contact force; four springs in a row; half of that for moved normals
    np.testing.assert_allclose(found, np.repeat(-sunk[:, None], 2, axis=1), atol=1e-6 * sunk[-1])
    assert [steps for steps, _ in looks] == list(range(LOOK, settled.steps + 1, LOOK))
    assert looks[-1] == (settled.steps, settled.ratio)
    assert settled.ratio <= 1e-8 < min(ratio for _, ratio in looks[:-1])
    # two disks carry all eight: three each besides their own weight
    assert settled.mean_reaction == pytest.approx(4.0 * MASS * G, rel=1e-6)
    assert settled.mean_residual < 1e-7 * settled.mean_reaction
    assert len(settled.cracks) == 0
    assert (not settled.start.contacts) == (law == "elastic")
    assert (settled.column, settled.before, len(body.supports)) == (None, None, 0)


SHAFT = {"name": "shaft", "type": "rectangle", "corners": [1.0, 1.0, 2.0, 3.0], "stage": "after"}
TOWER = {**WEIGHT, "packing.size": [3.0, 4.0], "motion.held": ["x", "rotation"]}
TOUGH = {"material.law": "linearpbond", "material.fric": 0.5}
LAWS = {"elastic": {}, "linearpbond": TOUGH, "with a history": {**TOUGH, "material.elastic_start": False}}


@pytest.mark.parametrize("law", [LAWS["elastic"], LAWS["with a history"]], ids=["elastic", "with a history"])
def test_an_excavated_body_settles_before_and_after(bar, law: dict) -> None:
    body = scene(bar, **{**TOWER, **law, "hole": [SHAFT]})
    looks: list[tuple[int, float]] = []
    settled = settle(body, lambda steps, ratio, _: looks.append((steps, ratio)))
    whole = settle(scene(bar, **{**TOWER, **law}))

    assert settled.before is not None
    assert settled.before.before is None
    assert np.array_equal(settled.before.start.displacement, whole.start.displacement)
    assert (settled.before.steps, settled.before.ratio) == (whole.steps, whole.ratio)
    assert [looks.count(stage) for stage in ((whole.steps, whole.ratio), (settled.steps, settled.ratio))] == [1, 1]
    assert settled.ratio <= 1e-8
    # 8 of 48 disks are gone: six at the base carry 40 weights in place of 48
    assert settled.before.mean_reaction == pytest.approx(8.0 * MASS * G, rel=1e-6)
    assert settled.mean_reaction == pytest.approx(40.0 / 6.0 * MASS * G, rel=1e-6)
    assert bool(settled.start.contacts) == body.has_history
    for contacts in settled.start.contacts.values():
        assert np.array_equal(contacts.assembly.positions, body.positions)
        assert np.array_equal(contacts.assembly.pairs, body.assembly.pairs)


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


NICHE = {"hole": [{"name": "niche", "type": "circle", "centre": [2.0, 4.0], "radius": 0.7}]}
"""A hole in the top, beside which the ground comes to rest otherwise than the column."""

LOCKED_IN = {"material.law": "linearpbond", "material.locked_in": 10e6}


def packed_ground(bar, sides: str | None, **changes: object) -> DiskScene:
    """A packed brick between free-field sides, whose cut top relaxes; `sides` is the static table of left and right."""
    supports = {"bottom": FIXED} | ({} if sides is None else {side: {"type": sides} for side in ("left", "right")})
    boundary = {side: {"type": "free_field"} for side in ("left", "right")}
    static = {"ratio": 1e-7, "boundary": supports}
    return scene(bar, packing=DENSE, boundary=boundary, static=static, **LOCKED_IN, **changes)


def damping(ground: DiskScene, nodes: np.ndarray) -> np.ndarray:
    """Dashpot constants (2, k) N·s/m along x and y on nodes (k,)."""
    found = np.zeros((3, ground.count))
    found[ground.supports.component, ground.supports.node] = ground.supports.damping
    return found[:2, nodes]


def test_beside_a_free_field_the_column_settles_first_and_alone(bar) -> None:
    ground = packed_ground(bar, None, **NICHE)
    looks: list[tuple[int, float]] = []
    settled = settle(ground, lambda steps, ratio, _: looks.append((steps, ratio)))
    alone = settle(column_alone(ground))

    assert settled.column is not None
    assert np.array_equal(settled.column.start.displacement, alone.start.displacement)
    assert (settled.column.steps, settled.column.ratio) == (alone.steps, alone.ratio)
    assert looks.index((alone.steps, alone.ratio)) == alone.steps // LOOK - 1
    assert len(looks) == (alone.steps + settled.steps) // LOOK
    # with dashpots, which outdo local damping, the body creeps into place, unless the stage has its own side
    free = packed_ground(bar, "free", **NICHE)
    beside = np.setdiff1d(ground.edges["right"].nodes, ground.edges["bottom"].nodes)
    own, given = (damping(StaticScene(each, each.case.static).scene, beside) for each in (ground, free))
    assert np.all(own > 0.0)
    assert np.array_equal(own, damping(ground, beside))
    assert not given.any()
    assert settled.steps > settle(free).steps


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        (
            {
                "ground": {"size": [12.0, 20.0]},
                "packing.size": [12.0, 8.0],
                "boundary": {side: {"type": "periodic" if side in ("left", "right") else "outside"} for side in SIDES},
                "load": [{"name": "house", "force": [0.0, -1e3], "region": [2.0, 18.0, 9.0, 20.0]}],
                "static": {"boundary": {"bottom": {"type": "fixed"}}},
                "monitor": [],
            },
            "load.house: acts on the surface of the continuum, which the static stage is without",
        ),
        (
            {
                "boundary": {},
                "hole": [{"name": "s", "type": "circle", "centre": [6.0, 3.0], "radius": 2.0, "keep": "inside"}],
                "static": {"stress": [-1e5, -1e5, 0.0]},
            },
            "static.stress: acts on no disk at left and right and bottom and top",
        ),
    ],
    ids=["a load on a continuum that is left out", "a sample within its box"],
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
    law = {**LAWS["with a history"], "material.fric": 0.2}
    settled = settle(
        scene(bar, **{**STANDING, "packing.size": [3.0, 4.0], "boundary": boundary, **law, "static": static})
    )

    assert settled.column is not None
    for stage in (settled, settled.column):
        assert stage.start.has_history
        assert stage.ratio <= (ratio or 1e-7)
        assert stage.mean_residual <= 2.0 * stage.ratio * 4.0 * MASS * G * 8
