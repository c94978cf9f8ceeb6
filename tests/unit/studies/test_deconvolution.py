"""The incident wave below level ground whose surface is given."""

import numpy as np
import pytest

from dembound.disks.within import Level
from dembound.errors import CaseError
from dembound.exact.column import Column, Layer
from dembound.studies.deconvolution import deconvolve, incident_below
from tests.small_cases import PUSHED, small

STEP = 0.005
SURFACE = np.exp(-(((STEP * np.arange(400) - 1.0) / 0.06) ** 2))
"""A pulse of 1 m/s up to 10 Hz."""


@pytest.mark.parametrize("alpha", [3.0, 0.4])
def test_it_moves_the_surface_as_given(alpha: float) -> None:
    """Of stiffer rock at most half of the surface's amplitude comes in, of softer one up to half over α."""
    found = incident_below(Level((Layer(29.0, 1900.0, 210.0),), alpha), SURFACE, STEP)
    column = Column([Layer(29.0, 1900.0, 210.0), Layer(1.0, 1900.0, alpha * 210.0)])
    delayed = np.concatenate([np.zeros(round(found.early / STEP)), SURFACE])
    assert np.abs(column.history(found.velocity, STEP) - delayed).max() < 1e-6
    assert found.magnification == pytest.approx(0.5 * max(1.0, 1.0 / alpha), rel=1e-2)
    assert f"up to {found.magnification:.3g} times" in found.sentence


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({}, "boundary.bottom: must absorb and name a wave_p or wave_s"),
        ({"boundary.bottom": {"type": "velocity", "wave_s": "push"}}, "boundary.bottom: must absorb"),
        ({"boundary.top": {"type": "viscous"}}, "needs a free surface at the top"),
    ],
)
def test_ground_without_an_answer_is_refused(changes: dict, message: str) -> None:
    case = small(PUSHED, changes={"boundary.right": {"type": "free"}} | changes)
    with pytest.raises(CaseError, match=message):
        deconvolve(case, SURFACE, STEP)
