"""The static stage: where it comes to rest."""

import numpy as np
import pytest
from settling import FIXED, MASS, STANDING, WEIGHT, G, scene
from small_cases import SURROUNDED, small

from dembound.boundaries.edge import SIDES
from dembound.disks.rest.loading import LOOK
from dembound.disks.rest.stage import require_stages, settle
from dembound.disks.scene import build
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


TOUGH = {"material.law": "linearpbond", "material.fric": 0.5}
LAWS = {"elastic": {}, "linearpbond": TOUGH, "with a history": {**TOUGH, "material.elastic_start": False}}


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
