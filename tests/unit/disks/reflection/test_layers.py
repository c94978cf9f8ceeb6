"""Reflection of sides that meet several layers."""

import numpy as np
import pytest
from small_cases import OPEN, SOIL, small

from dembound.disks.reflection import layers_beside, measure_side
from dembound.errors import CaseError


def test_a_side_reflects_by_layer() -> None:
    case = small(SOIL | OPEN)
    assert layers_beside(case, "left") == ["clay", "sand", "rock"]
    assert layers_beside(case, "bottom") == layers_beside(case.uniform_at(1.0), "left") == []
    with pytest.raises(CaseError, match="name one of clay, sand, rock"):
        measure_side(case, "left")

    def returned(side: str, layer: str | None, height: float | None = None) -> np.ndarray:
        one = case if height is None else case.uniform_at(height)
        return measure_side(one, side, [0.0], [10.0, 20.0], layer=layer).found.total("s")[:, 0]

    # the mass beyond whole cells reflects in proportion to the frequency over the speed
    clay = returned("left", "clay")
    for layer, slower in (("sand", 200.0 / 350.0), ("rock", 200.0 / 700.0)):
        np.testing.assert_allclose(returned("left", layer), clay * slower**2, rtol=0.02)
    np.testing.assert_allclose(returned("left", "rock"), returned("left", None, 1.0), rtol=1e-6)
    np.testing.assert_allclose(returned("bottom", None), returned("bottom", None, 1.0), rtol=1e-6)
