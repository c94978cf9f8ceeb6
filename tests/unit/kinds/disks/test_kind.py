"""Bonded disks as a kind of body, for runs, checks and reports."""

import numpy as np
import pytest

from dembound.disks.rest.stage import settle
from dembound.errors import CaseError
from dembound.kinds.disks.kind import Disks
from dembound.running import preflight

HANGING = {
    "wave.pulse.start": 1.0,
    "boundary.left": {"type": "fixed"},
    "boundary.right": {"type": "free"},
    "load": [{"name": "weight", "acceleration": [9.81, 0.0]}],
    "static": {"ratio": 1e-6, "boundary": {"left": {"type": "fixed"}}},
}
"""The bar hangs from its left end."""

NICHE = {"name": "niche", "type": "rectangle", "corners": [1.0, 0.5, 2.0, 1.1], "stage": "after"}
"""Two disks of the upper row."""


def test_the_stage_before_an_excavation_is_reported_for_the_disks_that_are_left(bar) -> None:
    weak = {"material.law": "linearpbond", "material.pb_ten": 0.3 * 19 * 625.0 * 9.81 / 0.5}
    held = {"boundary.right": {"type": "fixed"}, "static.boundary.right": {"type": "fixed"}}
    case = bar({**HANGING, **held, **weak, "hole": [NICHE]})
    scene = Disks().build(case)
    beginning = Disks().begin(scene, 1e-4, lambda *look: None)
    settled = settle(Disks().build(case))

    before, last = beginning.stages
    assert (before.name, last.name) == ("static/before", "static")
    assert len(scene.kept) == scene.count == 38
    assert before.displacement.shape == last.displacement.shape == (3, 38)
    assert np.array_equal(before.displacement, settled.before.start.displacement[:, scene.kept])
    assert before.facts["steps"] == settled.before.steps == beginning.summary["before"]["steps"]
    # all that broke is counted, and that between disks which are left is kept
    assert before.facts["cracks"] == len(settled.before.cracks) > 0
    left = np.isin(settled.before.cracks.pair, scene.kept).all(axis=1)
    assert np.array_equal(scene.kept[before.cracks.pair], settled.before.cracks.pair[left])
    assert np.array_equal(before.cracks.position, settled.before.cracks.position[left])


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"run.time_step": 5e-3}, "run.time_step"),
        ({"material": {"density": 2500.0, "emod": 1e9, "pb_emod": 0.0}}, "material"),
        ({"load": [{"name": "a", "force": [1.0, 0.0], "region": [3.01, 0.3, 3.02, 0.31]}]}, "no particle is centred"),
    ],
)
def test_what_would_stop_a_run_is_found_before_it(bar, changes: dict, said: str) -> None:
    with pytest.raises(CaseError, match=said):
        preflight(bar(changes))
    preflight(bar())
