"""Samples of a case's material, and the cases of their tests."""

import pytest
from small_cases import PUSHED, small

from dembound.errors import CaseError
from dembound.kinds import loads
from dembound.studies.asked import Loading
from dembound.studies.laboratory.sample import RISE, Sample, ignored, sample_of
from dembound.studies.laboratory.study import fitted

TABLES = {name: table for name, table in PUSHED.items() if name != "monitor"}
BROKEN = {"material.law": "linearpbond", "material.pb_ten": 5e5, "material.pb_coh": 8e5}
BRICK = {"size": [6.0, 6.0], "brick": [6.0, 6.0], "radius": 0.25, "radius_ratio": 1.5, "seed": 3}
RANDOM = BROKEN | {"packing": BRICK | {"pattern": "B"}}


def sample(test="ucs", changes=RANDOM, **options) -> Sample:
    return sample_of(small(TABLES, changes=changes), test, Loading(**options))


@pytest.mark.parametrize("test", ["ucs", "tension", "brazilian", "biaxial"])
def test_the_case_of_a_test_can_be_run_alone(test: str) -> None:
    own = sample(test, width=5.0)
    case = loads(own.text(2, 1e4 if test == "biaxial" else 0.0))

    assert case.packing.seed == 5
    assert case.packing.brick == case.packing.size == (5.0, 5.0 if test == "brazilian" else 10.0)
    assert case.material.damp == 0.7
    assert case.run.until == "peak"
    closing = case.wave["bottom"].amplitude - case.wave["top"].amplitude
    assert closing == pytest.approx(own.rate * own.height * (-1.0 if test == "tension" else 1.0), rel=1e-5)
    assert all(side.hold == ("normal",) for side in case.boundary.values())
    assert [hole.is_shape for hole in case.hole] == [True] * (test == "brazilian")
    assert (case.static is not None) == (test == "biaxial")
    # the peak is not reached within 15 travel times, so that inertia adds nothing
    assert own.peak_strain / own.rate > 15.0 * own.travel_time
    assert case.wave["top"].rise == pytest.approx(RISE * own.travel_time, rel=1e-5)


def test_grips_hold_both_components_and_other_tables_do_not_count() -> None:
    case = small(TABLES, changes=RANDOM)
    grips = loads(sample_of(case, "ucs", Loading(ends="grips", damp=0.1, rate=2.0)).text())

    assert grips.boundary["top"].hold == ("normal", "shear")
    assert grips.material.damp == 0.1
    assert grips.wave["bottom"].amplitude == pytest.approx(6.0)
    assert ignored(case) == ["boundary", "wave"]


def test_lattices_have_whole_cells_and_one_sample() -> None:
    lattice = sample(changes=BROKEN, width=3.2)

    assert (lattice.width, lattice.height) == (3.0, 6.5)
    with pytest.raises(CaseError, match="--seeds: all samples of this pattern are the same"):
        lattice.text(1)


def test_mohr_coulomb() -> None:
    pressures = [0.0, 1e6, 4e6]  # N = 3 at 30°, 2c√N = 12 MPa
    line = fitted(pressures, [12e6 + 3.0 * each for each in pressures])

    assert line.friction_angle == pytest.approx(30.0)
    assert line.cohesion == pytest.approx(12e6 / (2.0 * 3.0**0.5))
