"""Quantities derived from places of a case, without a run, do not change if the case is moved as a whole."""

import numpy as np
import pytest
from small_cases import Tables, small
from translated import translated

from dembound.accuracy.of_disks.coarser import coarser
from dembound.accuracy.of_disks.exact import problem_of
from dembound.accuracy.of_disks.exact.lamb import LambProblem
from dembound.casefile import Case
from dembound.disks.scene import build
from dembound.kinds import with_changes

BY = np.array([-37.5, -11.25])
"""m, not of whole diameters."""

LAMB: Tables = {
    "packing": {"pattern": "A", "size": [40.0, 30.0], "radius": 0.5},
    "material": {"density": 2500.0, "p_wave_speed": 300.0, "fric": 0.5},
    "boundary": {"left": {"type": "symmetry"}, "right": {"type": "viscous"}, "bottom": {"type": "viscous"}},
    "wave": {"pulse": {"type": "cubic_spline", "amplitude": 1.0, "period": 0.1}},
    "load": [{"name": "hammer", "force": [0.0, -2e5], "position": [0.0, 30.0], "wave": "pulse"}],
    "monitor": [{"name": "receiver", "position": [10.5, 30.0]}, {"name": "other", "position": [25.5, 30.0]}],
    "run": {"duration": 0.15},
}
SOURCE = {"type": "viscoelastic", "source": [20.0, 2.0]}
FORCE = LAMB | {
    "boundary": {"left": SOURCE, "right": {"type": "viscous"}, "bottom": {"type": "viscous"}},
    "load": [{"name": "hammer", "force": [0.0, -2e5], "position": [20.0, 30.0], "wave": "pulse"}],
}
BLAST = FORCE | {
    "hole": [{"name": "shaft", "type": "circle", "centre": [16.0, 14.0], "radius": 2.5}],
    "load": [{"name": "blast", "pressure": 1e6, "hole": "shaft", "wave": "pulse"}],
}


@pytest.fixture(params=[LAMB, FORCE, BLAST], ids=["symmetry", "force", "blast"])
def both(request) -> tuple[Case, Case]:
    case = small(request.param)
    return case, translated(case, tuple(BY))


def places_of(case) -> np.ndarray:
    """All places of a case (k, 2) m."""
    values = [each.position for each in (*case.monitor, *case.load) if each.position is not None]
    values += [load.region for load in case.load if load.region is not None]
    values += [hole.box for hole in case.hole] + [case.packing.box, case.box]
    return np.concatenate([np.reshape(value, (-1, 2)) for value in values])


def test_larger_disks_are_at_the_same_places(both) -> None:
    """In ground that is not a whole number of cells, so that places move with its sides."""
    wide = {"name": "wide", "force": [1e5, 0.0], "region": [3.0, 3.0, 9.0, 7.0], "wave": "pulse"}
    case = with_changes(both[0], {"packing.size": [41.0, 31.0], "load": [wide]})
    own, other = (coarser(each, build(each), 1e-4, 1.3).case for each in (case, translated(case, tuple(BY))))

    assert own.size[1] != pytest.approx(31.0, rel=1e-3)

    np.testing.assert_allclose(places_of(other), places_of(own) + BY, rtol=0.0, atol=1e-12)


def test_exact_solutions_are_as_far_from_loads_and_hold_as_long(both) -> None:
    own, other = (problem_of(build(case)) for case in both)

    assert type(own) is type(other)
    assert own.until == pytest.approx(other.until, rel=1e-12)
    if isinstance(own, LambProblem):
        assert isinstance(other, LambProblem)
        assert other.away == own.away
        assert own.load.force == (4e5 if both[0].side("left").is_mirror else 2e5)
    else:
        assert other.blast.surface == own.blast.surface + BY[1]
