"""The disks of zones in which bonds do not break."""

from typing import Any

import numpy as np
import pytest

from dembound.disks.scene import build
from dembound.errors import CaseError
from dembound.kinds.disks.kind import Disks
from dembound.running import plan, require_ready

LATTICE: dict[str, Any] = {
    "packing": {"pattern": "A", "size": [10.0, 8.0], "radius": 0.25},
    "material.law": "linearpbond",
    "material.pb_ten": 1e6,
    "wave": {"push": {"type": "cosine", "amplitude": 1.0, "period": 0.1}},
    "monitor": [],
    "motion.held": [],
}
BOTTOM = {"type": "viscous_input", "wave_s": "push"}


def scene(bar, **boundary: dict[str, Any]):
    return build(bar({**LATTICE, "boundary": boundary}))


@pytest.mark.parametrize("depth", [1, 2, 4])
def test_a_zone_is_as_many_rows_of_a_lattice(bar, depth) -> None:
    body = scene(bar, bottom=BOTTOM | {"intact": depth}, left={"type": "viscous", "intact": 1})
    x, y = body.positions.T
    assert np.array_equal(body.intact_zones["bottom"], np.flatnonzero(y < 0.5 * depth))
    assert np.array_equal(body.intact_zones["left"], np.flatnonzero(x < 0.5))
    assert body.intact is not None
    assert np.array_equal(body.intact, (y < 0.5 * depth) | (x < 0.5))


def test_a_zone_of_more_than_half_of_the_body_is_refused(bar) -> None:
    assert scene(bar, bottom=BOTTOM | {"intact": 8}).intact is not None
    with pytest.raises(CaseError, match=r"boundary.bottom.intact: is 9: bonds of 180 of 320 disks would not break"):
        Disks().build(bar({**LATTICE, "boundary": {"bottom": BOTTOM | {"intact": 9}}}))


def test_a_zone_may_be_larger_than_the_strip_in_which_its_side_is_examined(bar) -> None:
    """What a run computes before its first step is computed by a check: here when waves enter, in a strip."""
    wide = {"packing": {"pattern": "A", "size": [40.0, 2.0], "radius": 0.25}, "monitor": LATTICE["monitor"]}
    side = {"type": "viscous_input", "wave_p": "push", "intact": 20}
    require_ready(plan(bar({**LATTICE, **wide, "boundary": {"left": side}})))
