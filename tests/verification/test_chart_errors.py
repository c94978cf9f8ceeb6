"""The errors of a chart are those of the method: nothing for an exact one, second order for central differences.

A wrong clock, by half a step between velocities and displacements, or a monitor taken for another place would add an
error of first order in the spacing.
"""

from contextlib import contextmanager

import numpy as np
import pytest
import tomli_w

from dembound.accuracy.chart.study import Options, chart
from dembound.accuracy.choice import combinations
from dembound.accuracy.reference import Requested
from dembound.kinds import loads, with_changes
from dembound.running import Progress


@contextmanager
def quiet(name: str):
    yield Progress()


def errors_of(case, vary, folder, quantity="velocity", reference="exact") -> list[float]:
    """RMS errors of all choices."""
    options = Options(combinations(case, vary), 1, reference, Requested(quantity))
    found = chart(case, options, folder, False, quiet)
    assert found.reference.name == reference
    return [line.errors[0].rms for line in found.lines]


@pytest.fixture
def rod():
    """A bar under a smooth pulse of 0.25 of its length, which returns from the free end and leaves again."""
    tables = {
        "bar": {"length": 1.0, "spacing": 0.01, "density": 2500.0, "wave_speed": 1000.0},
        "method": {"type": "finite_difference"},
        "load": [{"name": "hit", "pressure": 1e6, "wave": "hit"}],
        "wave": {"hit": {"type": "cubic_spline", "amplitude": 1.0, "period": 4e-4}},
        "monitor": [{"name": "third", "position": 0.3}, {"name": "end", "position": 1.0}],
        "run": {"duration": 1.9e-3},
    }
    return loads(tomli_w.dumps(tables))


@pytest.mark.slow
def test_the_finer_reference_of_a_bar_is_its_exact_solution(rod, tmp_path) -> None:
    """At ν = 1 it has no error but rounding, also where no exact solution is known: between a loaded and a held end.

    So errors against it are those against the exact solution, and with Courant number 1 they vanish.
    """
    vary = {"bar.spacing": [0.01, 0.005], "run.courant": [0.5, 1.0]}
    clocks = {"run.courant": [0.5, 0.9, 1.0]}
    half, most, one = errors_of(rod, clocks, tmp_path / "exact")
    # the error of central differences is proportional to 1 − ν²: at ν = 1 nothing is left but rounding
    assert most / half == pytest.approx((1.0 - 0.81) / (1.0 - 0.25), rel=0.15)
    assert one < 1e-10
    (finer,) = errors_of(rod, {"run.courant": [0.5]}, tmp_path / "finer", reference="finer")
    assert finer == pytest.approx(half, rel=1e-9)
    held = with_changes(rod, {"load.1.side": "right", "boundary": {"left": {"type": "fixed"}}})
    found = errors_of(held, vary, tmp_path / "held", reference="finer")
    assert found[0] / found[2] == pytest.approx(4.0, rel=0.15)
    assert max(found[1::2]) < 1e-10


@pytest.mark.parametrize("quantity", ["displacement", pytest.param("stress", marks=pytest.mark.slow)])
def test_finite_differences_are_of_second_order(rod, tmp_path, quantity: str) -> None:
    # the leading error is Δx² times a constant; the next, of fourth order, is (2π/25)² = 6 % of it at the coarse one
    coarse, fine = errors_of(rod, {"bar.spacing": [0.01, 0.005], "run.courant": [0.5]}, tmp_path, quantity)
    assert coarse / fine == pytest.approx(4.0, rel=0.15)


def test_a_plane_wave_in_a_lattice_is_of_second_order(lab, tmp_path) -> None:
    """Disks of 0.5 m and 1 m; the wave enters through the grip of the left side, and leaves on the right.

    Of first order is only the reflection of the end, tan(qD/4)/… ≈ πD/(4cT) = 0.8 % here, half cells have none.
    """
    case = lab.case(
        "A",
        (40.0, 2.0),
        boundary={"left": {"type": "velocity", "wave_p": "pulse"}, "right": {"type": "viscous", "half_mass": True}},
        wave={"type": "cubic_spline", "amplitude": 0.5, "period": 0.05},
        duration=0.08,
    )
    tables = {"name": "middle", "position": [20.25, 0.25]}
    case = with_changes(case, {"monitor": [tables]})
    coarse, fine = errors_of(case, {"packing.radius": [0.5, 0.25]}, tmp_path)
    assert np.log2(coarse / fine) == pytest.approx(2.0, abs=0.2)
