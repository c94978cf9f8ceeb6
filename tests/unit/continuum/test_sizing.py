"""The settings that waves need."""

import math

import numpy as np
import pytest
from meshes import buried, one_across, uneven

from dembound.continuum import sizing
from dembound.continuum.interpolation import (
    FORCES,
    HOLES,
    PASSED,
    TIES,
    WIDER,
    NearField,
    interpolation,
    located,
    slopes,
)
from dembound.continuum.medium import Medium
from dembound.continuum.mesh import Mesh
from dembound.continuum.sizing import Signal
from dembound.waves import Constant, Cosine, Wave

ROCK = Medium.isotropic(2500.0, 1000.0, 500.0)


def pulse(period: float = 0.5, amplitude: float = 1.0) -> Cosine:
    return Cosine(type="cosine", period=period, amplitude=amplitude)


def moved(wave: Wave) -> Signal:
    return Signal(wave, is_force=False)


def pushed(wave: Wave) -> Signal:
    return Signal(wave, is_force=True)


def exact_share(x: float, power: int) -> float:
    """Share of the energy of ½(1 − cos 2πt/T) times ω^power above x/T; the spectrum is sin(πy)/(πy(1 − y²)), y = fT."""
    y = np.linspace(1e-6, 400.0, 4_000_001)
    energy = y**power * (np.sinc(y) / (1.0 - y**2)) ** 2
    energy[np.abs(y - 1.0) < 1e-9] = 0.25
    return float(energy[y > x].sum() / energy.sum())


@pytest.mark.parametrize(
    ("signal", "power", "share"),
    [pytest.param(moved, 0, 1e-2, marks=pytest.mark.slow), (moved, 0, 1e-6), (pushed, 1, 1e-3)],
)
def test_the_cut_off_of_the_cosine_pulse_is_that_of_its_spectrum(signal, power: int, share: float) -> None:
    found = sizing.cutoff(signal(pulse(0.5)), share)

    # in multiples of 1/8T, of which one more or less is passed; 99.9 % of a velocity's energy lie below 1.734/T
    assert exact_share(0.5 * found + 0.125, power) < share < exact_share(0.5 * found - 0.25, power)
    assert sizing.cutoff(signal(pulse(0.5, amplitude=-7.0)), share) == found
    assert sizing.cutoff(signal(pulse(0.05)), share) == pytest.approx(10.0 * found)


def test_of_a_force_that_stays_the_rise_counts() -> None:
    """Its rate is a Hann lobe, so body waves have a thousandth of their energy above 1.5/rise; a step has no limit."""
    y = np.linspace(0.125, 100.0, 800_000)
    energy = (np.sinc(y) / (1.0 - y**2)) ** 2 / y
    rise = Constant(type="constant", amplitude=2.0, rise=0.2)
    found = 0.2 * sizing.cutoff(pushed(rise))

    assert energy[y > found + 0.125].sum() / energy.sum() < 1e-3 < energy[y > found - 0.25].sum() / energy.sum()
    assert sizing.cutoff(pushed(Constant(type="constant", amplitude=2.0))) == math.inf


def test_mean_frequencies_are_those_of_the_motion() -> None:
    """½(1 − cos 2πt/T), whose rate is sin(2πt/T) π/T; its displacement is ½(t − sin(2πt/T) T/2π), then ½T."""
    square = 0.25 * (1.0 / 3.0 + 2.5 / (2.0 * math.pi) ** 2)
    for times, stays in ((1.0, 0.0), (3.0, 0.5)):
        found = sizing.mean_frequency(moved(pulse(0.5)), 1.0 / (times * 0.5))
        assert found == pytest.approx(math.sqrt(0.375 / (square + stays)) / (2.0 * math.pi * 0.5), rel=2e-3)
    assert sizing.mean_frequency(moved(pulse(0.5))) == pytest.approx(1.0 / (0.5 * math.sqrt(3.0)), rel=1e-2)
    assert sizing.wave_number([moved(pulse(0.5)), moved(pulse(0.1))], ROCK) == pytest.approx(
        2.0 * math.pi / (0.1 * math.sqrt(3.0)) / 500.0, rel=1e-2
    )
    assert sizing.mean_frequency(moved(Constant(type="constant", amplitude=2.0)), 1.0) == math.inf
    assert sizing.wave_number([], ROCK) == 0.0


@pytest.mark.parametrize("order", [3, 6])
def test_elements_return_a_share_of_the_energy_that_is_the_accuracys_square(order: int) -> None:
    signals = [pushed(pulse(0.2))]
    size = sizing.element_size(signals, ROCK, order, 1e-3)

    assert sizing.element_size([pushed(pulse(0.1))], ROCK, order, 1e-3) == pytest.approx(0.5 * size)
    assert sizing.element_error(signals, ROCK, order, size) == pytest.approx(1e-3, rel=0.05)  # of steps of 1/8T
    # the spectrum of velocities falls with the fifth power, energies beyond a frequency with the fourth
    assert sizing.element_error(signals, ROCK, order, 2.0 * size) == pytest.approx(4e-3, rel=0.1)
    assert sizing.element_size(signals, ROCK, order, 1e-2) == pytest.approx(3.1 * size, rel=0.1)
    assert sizing.element_error([pushed(Constant(type="constant", amplitude=1.0))], ROCK, order, size) == 1.0


def test_a_lasting_force_needs_room_in_proportion_to_its_time() -> None:
    inner = sizing.inner_length(10.0, 1000.0, 0.3, 1e-3)

    # α0 t = 5, at which half of a thousandth is missing: 0.3·1000·10/2L
    assert inner == pytest.approx(300.0)
    assert sizing.inner_length(20.0, 2000.0, 0.3, 1e-3) == pytest.approx(4.0 * inner)
    assert sizing.inner_length(10.0, 1000.0, 0.1, 1e-3) == pytest.approx(inner / 3.0)
    assert sizing.missing(10.0, 1000.0, 0.3, inner) == pytest.approx(5e-4)
    assert sizing.missing(10.0, 1000.0, 0.3, 0.5 * inner) == pytest.approx(2e-3)


def test_what_the_surface_sends_back_along_layers() -> None:
    """S waves keep R0^(cos θ c_p/c_s): with a depth of 3 and an offset of 4, cos θ = 0.8."""
    assert sizing.grazing_error(3.0, 0.5, 1e-4, 4.0) == pytest.approx(1e-4**1.6)
    assert sizing.grazing_error(3.0, 1.0, 1e-4, 0.0) == 1.0
    for depth, ratio, accuracy in ((100.0, 0.7, 1e-3), (20.0, 0.5, 1e-2)):
        offset = sizing.offset(depth, ratio, 1e-4, accuracy)
        assert sizing.grazing_error(depth, ratio, 1e-4, offset) == pytest.approx(accuracy)
    assert sizing.offset(10.0, 1.0, 1e-3, 1e-3) == pytest.approx(10.0 * 0.9 / 0.19**0.5)  # not infinite
    assert sizing.offset(0.0, 0.7, 1e-4, 1e-3) == 0.0


def test_a_polynomial_and_its_slopes_are_interpolated_and_extrapolated() -> None:
    """Also within the box, from the nearest element."""
    mesh = buried()
    points = np.array([[2.2, 17.3], [23.9, 25.9], [10.1, 20.05], [15.9, 21.8], [13.0, 20.4], [0.9, 16.0]])
    (x, y), (px, py) = mesh.positions.T, points.T
    field = x**2 - 3.0 * y * x + y**4
    node, weight = interpolation(mesh, points)
    along, up = (slopes(mesh, points) * field[node]).sum(axis=2)

    np.testing.assert_allclose((weight * field[node]).sum(axis=1), px**2 - 3.0 * py * px + py**4, rtol=1e-12)
    np.testing.assert_allclose(along, 2.0 * px - 3.0 * py, rtol=1e-9)
    np.testing.assert_allclose(up, 4.0 * py**3 - 3.0 * px, rtol=1e-9)
    np.testing.assert_allclose(weight.sum(axis=1), 1.0, rtol=1e-13)
    nearest = mesh.positions[node].mean(axis=1) - points
    assert (np.abs(nearest) <= np.array([3.0, 2.0])).all()


def test_points_are_located_in_unequal_elements() -> None:
    mesh = uneven()
    rng = np.random.default_rng(0)
    for number, nodes in enumerate(mesh.nodes):
        local = rng.uniform(-1.0, 1.0, (5, 2))
        low, high = mesh.positions[nodes[0, 0]], mesh.positions[nodes[-1, -1]]
        element, found = located(mesh, low + 0.5 * (1.0 + local) * (high - low))
        assert (element == number).all()
        np.testing.assert_allclose(found, local, rtol=0.0, atol=1e-13)


def test_points_in_the_box_and_beyond_the_mesh_belong_to_the_nearest_element() -> None:
    """As found by comparing all of them; those on an edge to the first of both elements."""
    mesh = uneven()
    points = np.random.default_rng(1).uniform((-3.0, -3.0), (12.0, 14.0), (400, 2))
    points[:200] = np.random.default_rng(2).uniform((4.0, 5.0), (7.0, 7.0), (200, 2))
    low, high = (mesh.positions[mesh.nodes[:, i, i]] for i in (0, -1))
    beyond = np.maximum(np.maximum(low - points[:, None], points[:, None] - high), 0.0)
    nearest = np.argmin(np.sum(beyond**2, axis=2), axis=1)

    np.testing.assert_array_equal(located(mesh, points)[0], nearest)
    on_edges = located(mesh, np.array([[1.5, 1.0], [3.0, 5.0], [7.0, 6.0], [5.0, 7.0]]))[0]
    np.testing.assert_array_equal(mesh.elements[on_edges], [[0, 0], [1, 1], [4, 2], [2, 3]])


HOLE = (-2.0, -1.0, 4.0, 1.0)
"""6 m × 2 m, 3 m from elements: its field varies within 4 m."""


def blast(gap: float = 3.0) -> NearField:
    return NearField(HOLE, gap, "pressure")


@pytest.mark.parametrize("order", [3, 6])
def test_elements_beside_a_force_are_in_proportion_to_its_distance(order: int) -> None:
    near, far = (NearField((5.0, 5.0, 5.0, 5.0), gap, "force") for gap in (8.0, 16.0))
    side = near.largest_side(order, 1e-3)

    assert side == FORCES[order] * 8.0
    assert far.largest_side(order, 1e-3) == pytest.approx(2.0 * side)
    assert near.error(order, side) == pytest.approx(1e-3)
    assert near.error(order, 2.0 * side) == pytest.approx(8e-3)
    assert near._replace(gap=0.0).error(order, side) == near._replace(gap=0.0).largest_side(order, 1e-3) == 0.0


@pytest.mark.parametrize("order", [3, 4, 5, 6])
def test_elements_as_wide_as_the_box_round_a_blast_have_the_measured_error_and_narrower_ones_less(order: int) -> None:
    assert blast().distance == 4.0
    assert blast().error(order, 8.0) == HOLES[order]
    assert blast().error(order, 4.0) == pytest.approx(HOLES[order] * 0.5 ** (order + 1))
    assert blast().error(order, 16.0) == pytest.approx(HOLES[order] * 2.0**WIDER)
    assert blast(7.0).error(order, 16.0) == HOLES[order]
    for accuracy in (1e-3, 0.1):
        assert blast().error(order, blast().largest_side(order, accuracy)) == pytest.approx(accuracy)


def test_beside_a_hole_that_waves_pass_it_is_the_part_of_the_motion_that_the_hole_makes() -> None:
    passed = blast()._replace(source="waves", wave_number=0.1)
    assert passed.error(4, 8.0) == pytest.approx(PASSED * 0.1 * 3.0 * (3.0 / 6.0) * HOLES[4])
    assert passed.error(4, 4.0) == pytest.approx(passed.error(4, 8.0) / 8.0)
    assert passed.error(4, passed.largest_side(4, 1e-3)) == pytest.approx(1e-3)
    assert passed._replace(wave_number=math.inf).error(4, 8.0) == HOLES[4]
    assert passed._replace(wave_number=0.0).largest_side(4, 1e-3) == math.inf
    assert passed.of_ties(1.0) == 0.0 == passed._replace(source="force").of_ties(1.0)
    assert blast().of_ties(0.5) == pytest.approx(TIES / 64.0)


def test_slopes_in_the_element_that_closes_a_period() -> None:
    mesh = Mesh.uniform(order=3, element=(1.5, 1.0), cells=(4, 2), periodic=(True, False))
    point = np.array([[5.7, 0.3]])  # of the last column, whose right nodes are those of the first one
    local = mesh.rule.slope(np.array([0.6]))[0] / 0.75

    np.testing.assert_allclose(slopes(mesh, point)[0].reshape(4, 4).sum(axis=0), local, rtol=1e-12)


def test_points_beyond_a_periodic_side_have_places_within_it() -> None:
    mesh = one_across()
    element, place = located(mesh, np.array([[-1.0, -1.0], [7.0, 0.5]]))
    assert mesh.elements[element].tolist() == [[0, 2], [0, 2]]
    np.testing.assert_allclose(place, [[2.0 * 5.0 / 6.0 - 1.0, 0.0], [2.0 / 6.0 - 1.0, 1.5]])


def test_errors_of_a_blast_are_largest_at_the_elements() -> None:
    """With the square of the distance inside, and less beyond; other fields are alike at all places."""
    places = [np.array([4.0, y]) for y in (0.0, 3.0, 4.0, 7.0)]  # 1, 3, 4 and 7 m from what is in the hole
    assert [blast().part_at(place) for place in places] == pytest.approx([1 / 16, 9 / 16, 1.0, (4 / 7) ** 4])
    assert blast().part_at(np.array([-5.0, 2.5])) == 1.0
    assert [blast()._replace(source=each).part_at(places[0]) for each in ("force", "waves")] == [1.0, 1.0]
    assert math.isfinite(NearField((0.0, 0.0, 0.0, 0.0), 1.0, "pressure").part_at(np.zeros(2)))
