"""The dispersion of bars of nodes against L eq. 12 as printed, its series and its brute-force extremes."""

import numpy as np
import pytest
from scipy.integrate import quad

from dembound.exact import Lattice, cells_per_wavelength, courant_limit
from dembound.exact.bar import usual_shares

HORIZONS = [1, 2, 3, 8]


def lattice(horizon: int, courant: float) -> Lattice:
    """A lattice with Δx = 1 m and c = 1 m/s, so that Δt = ν and k = θ."""
    return Lattice(horizon, spacing=1.0, time_step=courant, wave_speed=1.0)


def printed_sum(horizon: int, phase: np.ndarray) -> np.ndarray:
    """(2/m²) Σ (w_p/p)(cos pkΔx − 1), L eq. 12 with the outermost neighbour's half weight once."""
    weights = np.array((horizon - 1) * [1.0] + [0.5]) / np.arange(1, horizon + 1)
    return 2.0 / horizon**2 * sum(w * (np.cos(p * phase) - 1.0) for p, w in enumerate(weights, start=1))


@pytest.mark.parametrize("horizon", HORIZONS)
@pytest.mark.parametrize("share", [0.1, 0.99])
def test_frequency_solves_the_printed_equation(horizon: int, share: float) -> None:
    courant = share * courant_limit(horizon)
    phase = np.linspace(0.01, np.pi, 200)
    # each side is a sum of up to m terms that come to at most 2: (m + 10) roundings of 2
    found = np.cos(lattice(horizon, courant).frequency(phase) * courant) - 1.0
    np.testing.assert_allclose(
        found, courant**2 * printed_sum(horizon, phase), rtol=0, atol=(horizon + 10) * 2.0 * np.finfo(float).eps
    )


@pytest.mark.parametrize("horizon", HORIZONS)
def test_group_velocity_is_the_slope_of_the_frequency(horizon: int) -> None:
    speeds = lattice(horizon, 0.9 * courant_limit(horizon))
    for low, high in ((0.1, 0.5), (0.5, 1.3), (1.3, 3.1)):
        rise = quad(speeds.group_velocity, low, high, epsabs=0.0, epsrel=1e-12)[0]
        # frequencies of up to π/ν are subtracted, each good to a few roundings
        assert rise == pytest.approx(float(speeds.frequency(high) - speeds.frequency(low)), rel=1e-11, abs=1e-14)


@pytest.mark.parametrize("horizon", [1, 2, 3, 6, 12])
def test_shortest_wave_is_the_first_to_grow(horizon: int) -> None:
    phase = np.linspace(0.0, np.pi, 20001)
    largest = -0.5 * printed_sum(horizon, phase)
    # at a maximum with roundings of a sum of m terms; its place is flat to the fourth order for even m
    assert largest[-1] >= largest.max() - horizon * np.finfo(float).eps
    assert courant_limit(horizon) == pytest.approx(1.0 / np.sqrt(largest.max()), rel=1e-14)
    assert np.all(np.diff(lattice(horizon, 0.0).frequency(phase)) > -1e-14)


@pytest.mark.parametrize("horizon", HORIZONS)
@pytest.mark.parametrize(("of", "share"), [("phase", 0.0), ("phase", 0.9), ("group", 0.5)])
def test_wavelengths_of_so_many_cells_and_all_longer_ones_keep_to_the_error(horizon: int, share: float, of) -> None:
    courant = share * courant_limit(horizon)
    cells = cells_per_wavelength(horizon, courant, of=of)
    speeds = lattice(horizon, courant)
    speed = speeds.phase_velocity if of == "phase" else speeds.group_velocity
    phase = 2.0 * np.pi / cells
    assert abs(float(speed(phase)) - 1.0) == pytest.approx(0.01, rel=1e-9)  # brentq's 1e-12 of a phase, twice over
    assert np.all(np.abs(speed(np.linspace(0.0, 0.999 * phase, 1000)) - 1.0) < 0.01)
    assert abs(float(speed(1.001 * phase)) - 1.0) > 0.01
    assert cells_per_wavelength(1, 1.0, of=of) == 2.0  # there is no error at all


def test_what_makes_no_sense_is_refused() -> None:
    for numbers in ((0, 1.0, 1.0, 1.0), (1, 0.0, 1.0, 1.0), (1, 1.0, -1.0, 1.0), (1, 1.0, 1.0, np.inf)):
        with pytest.raises(ValueError, match="must"):
            Lattice(*numbers)
    for shares in ((1.0,), (0.4, 0.5)):
        with pytest.raises(ValueError, match="shares"):
            Lattice(2, 1.0, 1.0, 1.0, shares)
    with pytest.raises(ValueError, match=r"Courant number \(1.01\) must not be above 1"):
        cells_per_wavelength(1, 1.01)
    with pytest.raises(ValueError, match="error"):
        cells_per_wavelength(1, 0.5, error=1.0)


@pytest.mark.parametrize("horizon", HORIZONS)
def test_shares_of_the_usual_bonds_make_no_difference(horizon: int) -> None:
    shares = usual_shares(horizon)
    courant = 0.9 * courant_limit(horizon)
    usual, given = lattice(horizon, courant), Lattice(horizon, 1.0, courant, 1.0, shares)
    phase = np.linspace(0.0, 3.1, 200)

    # sums of m terms of order 1; of the group velocity the closed form vanishes where the sum has its rounding
    np.testing.assert_allclose(given.frequency(phase), usual.frequency(phase), rtol=1e-13 * horizon)
    np.testing.assert_allclose(given.group_velocity(phase), usual.group_velocity(phase), atol=1e-13 * horizon)
    assert given.courant_limit == pytest.approx(courant_limit(horizon), rel=1e-12)
    assert cells_per_wavelength(horizon, courant, shares=shares) == pytest.approx(
        cells_per_wavelength(horizon, courant), rel=1e-10
    )
