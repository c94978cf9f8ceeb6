"""The constants of contacts, and where contacts give way."""

import numpy as np
import pytest

from dembound.disks.material.constants import limits_of, shared_constants
from dembound.kernels.contacts import BONDED, UPDATED

LAW = {"material.law": "linearpbond"}


def test_limits_are_those_of_the_material(bar) -> None:
    strength = {"material.pb_ten": 1e6, "material.pb_coh": 2e6, "material.pb_fa": 45.0, "material.fric": 0.5}
    limits = limits_of(bar(LAW | strength).material)
    assert (limits.friction, limits.tension, limits.cohesion, limits.geometry) == (0.5, 1e6, 2e6, UPDATED)
    assert limits.tan_fa == pytest.approx(1.0, rel=1e-15)
    assert limits_of(bar(LAW | {"material.geometry": "reference"}).material).geometry == BONDED

    unbreakable = limits_of(bar(LAW).material)
    assert (unbreakable.tension, unbreakable.cohesion, unbreakable.tan_fa) == (np.inf, np.inf, 0.0)


def test_rows_that_differ_by_rounding_alone_are_shared() -> None:
    row = np.arange(1.0, 13.0)
    apart = np.array([0.0, 1e-9, 1.0, 1.0 + 1e-9, 0.0])[:, None] * np.eye(12)[2]
    constants, row_of = shared_constants(row + apart, length=0.1)

    # what lies within 1e-6 of the length is one place
    assert np.array_equal(constants[:, 2], [3.0, 4.0])
    assert row_of.tolist() == [0, 0, 1, 1, 0]
