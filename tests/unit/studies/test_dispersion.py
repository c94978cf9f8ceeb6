"""Lattices from numbers and from cases, their table, and the frequencies that simulations have."""

from pathlib import Path

import numpy as np
import pytest

from dembound.errors import CaseError
from dembound.exact import Lattice, courant_limit
from dembound.kinds import loads, with_changes
from dembound.starting import starting_point
from dembound.studies.dispersion import lattices, lattices_of, measure

STARTER = starting_point()

BAR = """
[bar]
length = 0.5
spacing = 0.005
density = 2620.0
wave_speed = 2500.0
strength = 1e7
[method]
type = "peridynamics"
horizon = 3
[run]
duration = 1e-4
time_step = 1e-6
"""


def test_all_combinations_are_made_of_numbers_that_make_sense():
    made = lattices([1, 3], [0.01, 0.005], [1e-6], 2500.0)
    assert made == [Lattice(horizon, spacing, 1e-6, 2500.0) for horizon in (1, 3) for spacing in (0.01, 0.005)]
    with pytest.raises(CaseError) as refused:
        lattices([0, 3, 1001], [0.0, np.inf], [np.nan, 0.0], -1.0)
    assert refused.value.problems == [
        "--horizon: is 0, must be 1 to 1000",
        "--horizon: is 1001, must be 1 to 1000",
        "--spacing: is 0, must be 1e-30 to 1e+30 m",
        "--spacing: is inf, must be 1e-30 to 1e+30 m",
        "--time-step: is nan, must be 0 to 1e+30 s",
        "--wave-speed: is -1, must be 1e-15 to 1e+15 m/s",
    ]
    with pytest.raises(CaseError) as refused:
        lattices([1, 2], [0.01, 0.005], [1e-3, 2e-3], 2500.0)
    # the largest step is that of two spacings to the horizon, √2Δx/c = √2·4 µs
    assert refused.value.problems == ["--time-step: is 0.001 s, must not be above the stability limit 5.65685e-06 s"]
    assert len(lattices([1, 2], [0.01, 0.005], [1e-3, 5.6e-6], 2500.0)) == 8


@pytest.mark.parametrize(
    ("method", "horizons"),
    [
        ({"type": "peridynamics", "horizon": 3}, [3]),
        ({"type": "switch", "horizon": 4, "before": "peridynamics"}, [1, 4]),
        ({"type": "patch", "horizon": 3}, [1, 3]),
    ],
)
def test_bars_of_cases_have_the_horizons_their_method_comes_to(method, horizons):
    case = with_changes(loads(BAR, Path(), "bar"), {"method": method})
    assert lattices_of(case) == [Lattice(horizon, 0.005, 1e-6, 2500.0) for horizon in horizons]
    with pytest.raises(CaseError, match="is the case of disks, this command is for bars") as refused:
        lattices_of(loads(STARTER, Path(), "disks"))
    assert refused.value.source == "disks"


@pytest.mark.parametrize(("horizon", "share"), [(1, 0.5), (3, 1.0)])
def test_measured_frequencies_are_those_of_the_lattice(horizon, share):
    lattice = Lattice(horizon, 0.005, share * courant_limit(horizon) * 2e-6, 2500.0)
    wavenumber = np.array([0.1, 0.4, 0.9]) * lattice.shortest
    # second differences round by 4ε of displacements of 1 and are at least 4sin²(ωΔt/2) = 0.02 of them; half of that
    # goes into ω, but near the limit arcsin multiplies it by tan(ωΔt/2), up to 10 here
    np.testing.assert_allclose(measure(lattice, wavenumber), lattice.frequency(wavenumber), rtol=1e-12)
