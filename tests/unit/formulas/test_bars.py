"""Chains of nodes at single frequencies, beside the infinite row of nodes and the matrix of the whole chain."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from estimated_bars import BAR, LAYER, RANGES, WALL, scene
from small_cases import small

from dembound.bar.layers import EndLayer
from dembound.bar.scene import build_bar
from dembound.boundaries.boundary import Layer
from dembound.exact import Lattice
from dembound.formulas.bars.chain import Chain, Frequencies, Response
from dembound.formulas.bars.ends import returned
from dembound.formulas.bars.rods import Rods, Window
from dembound.kinds import with_changes

STEP = 1e-6


def test_a_clock_has_the_angles_of_central_differences() -> None:
    clock = Frequencies.of(1j * np.array([1e5, 4e5]), STEP)

    np.testing.assert_allclose(clock.change, 2j / STEP * np.sin([0.05, 0.2]), rtol=1e-12)
    np.testing.assert_allclose(clock.mean, np.cos([0.05, 0.2]), rtol=1e-12)
    exact = Frequencies.of(clock.s, 0.0)
    np.testing.assert_array_equal(exact.change, clock.s)
    np.testing.assert_array_equal(exact.mean, 1.0)


@pytest.mark.parametrize(
    ("name", "horizon", "step"),
    [("matched layer", 1, 0.0), ("matched layer, m = 3", 3, STEP), ("matched layer, m = 8", 8, STEP)],
)
def test_waves_run_as_on_the_infinite_row(name: str, horizon: int, step: float) -> None:
    # the layer returns up to 1e-3 of them, see docs/evidence/bar_ends.md, 16 nodes are few for m = 8
    wavenumber = np.array([10.0, 30.0])
    omega = Lattice(horizon, 0.01, step, 2740.0).frequency(wavenumber)
    case, clock = scene(name), Frequencies.of(1j * omega, step)
    chain = Chain(build_bar(case), build_bar(case).layers, STEP)
    response = Response(chain, [0, 40, 50, 60])

    moved = response.velocities(clock, {0: np.ones(2, dtype=complex)})

    here = [response.at(moved, chain.first + node) for node in (40, 50, 60)]
    for near, far in pairwise(here):
        np.testing.assert_allclose(far / near, np.exp(-0.1j * wavenumber), atol=0.02 if horizon == 8 else 3e-3)


@pytest.mark.parametrize(("name", "side"), [("input by a matched layer, m = 3", "left"), ("attenuation", "right")])
def test_mobility_is_that_of_two_endless_halves(name: str, side: str) -> None:
    # Two impedances ρcA √(1 + γ/s) of long waves, with kΔx = 0.02 within (m² + 2)(kΔx)²/24 of it for m = 3, 2e-4;
    # beside that the bonds at the push give way like a spring, by some kΔx of the motion, a quarter of a period late.
    case = with_changes(scene(name), {f"boundary.{side}": LAYER} if name == "attenuation" else {})
    built, s = build_bar(case), np.array([30.0 + 5e3j])
    layer = built.layers[side]
    endless = replace(layer, layer=replace(layer.layer, nodes=200_000, reflection=1.0))
    chain = Chain(built, {side: endless}, STEP)

    found = chain.mobility(side, Frequencies.of(s, STEP))

    impedance = 2620.0 * 2740.0 * np.sqrt(1.0 + 2.0 * case.bar.attenuation * 2740.0 / s)
    np.testing.assert_allclose(found.real, (0.5 / impedance).real, rtol=5e-4)
    np.testing.assert_allclose(found.imag, (0.5 / impedance).imag, atol=0.02 * abs(0.5 / impedance)[0])


SPACING, SPEED, MASS = 0.01, 1000.0, 3.0


def layer_of(profile: Layer, drag_rate: float = 0.0, horizon: int = 1) -> EndLayer:
    inner = np.arange(horizon)
    stiffness = np.full(horizon, MASS * (SPEED / SPACING) ** 2)
    if horizon > 1:  # as that of peridynamics
        stiffness *= 2.0 / horizon**2 / np.arange(1, horizon + 1) * np.where(inner == horizon - 1, 0.5, 1.0)
    return EndLayer("right", profile, inner, stiffness, MASS, SPACING, SPEED, drag_rate)


@pytest.mark.parametrize(("reflection", "drag_rate"), [(0.1, 0.0), (1e-2, 50.0), (1e-3, 0.0)])
def test_a_long_layer_returns_r0(reflection, drag_rate):
    """It is the echo of its outer end, reduced by dashpots on the way.

    A free end of a whole node is half a spacing farther away, where the rate is the largest. The rest is of the order
    (kΔx)² = 0.004 and (dΔx/c)² = 0.002, and of the numerical dispersion on the way.
    """
    frequency, profile = SPEED / (100 * SPACING), Layer(300, 3.0, reflection)
    layer = layer_of(profile, drag_rate)
    farther = np.exp(-layer.node_rates[-1] * SPACING / SPEED)
    expected = reflection * farther * np.exp(-0.5 * drag_rate * 2.0 * 300.5 * SPACING / SPEED)
    assert returned(layer, frequency, 0.5 * SPACING / SPEED) == pytest.approx(expected, rel=0.01)


S = 40.0 + 2j * np.pi * np.array([0.0, 300.0, 2000.0, 9000.0])
ROD_SPEED, IMPEDANCE = 2740.0, 2620.0 * 2740.0


def rods(case, *places: float) -> Rods:
    return Rods(case, build_bar(case).rod, np.array(places), S)


@pytest.mark.parametrize(("end", "reflected"), [({}, 1.0), ({"boundary.right": WALL}, -1.0)])
def test_free_and_fixed_ends_return_all(end: dict[str, object], reflected: float) -> None:
    case = small(BAR, changes={"load": [], "boundary.left": {"type": "viscous_input", "wave_p": "pulse"}, **end})

    velocity, stress = rods(case, 0.25).motion({}, {"left": np.ones(len(S))})

    there, back = np.exp(-0.25 * S / ROD_SPEED), reflected * np.exp(-1.75 * S / ROD_SPEED)
    np.testing.assert_allclose(velocity[:, 0], there + back, rtol=1e-9)
    np.testing.assert_allclose(stress[:, 0], -IMPEDANCE * (there - back), rtol=1e-9)


def test_attenuation_makes_waves_fade_by_alpha() -> None:
    case = small(BAR, changes={"bar.attenuation": 0.5, "boundary.right": {"type": "viscous"}})

    velocity, _ = rods(case, 0.0, 0.8).motion({"left": np.ones(len(S))}, {})

    ratio = velocity[:, 1] / velocity[:, 0]
    np.testing.assert_allclose(ratio, np.exp(-0.8 * np.sqrt(S**2 + 2.0 * 0.5 * ROD_SPEED * S) / ROD_SPEED), rtol=1e-10)
    assert abs(ratio[-1]) / np.exp(-40.0 * 0.8 / ROD_SPEED) == pytest.approx(np.exp(-0.5 * 0.8), rel=1e-3)


def test_an_interface_transmits_by_the_impedances() -> None:
    ends = {"left": {"type": "viscous_input", "wave_p": "pulse"}, "right": {"type": "viscous"}}
    case = small(BAR, changes={"bar": BAR["bar"] | RANGES, "load": [], "boundary": ends})
    softer = 2000.0 * 1370.0

    velocity, stress = rods(case, 0.6, 0.8).motion({}, {"left": np.ones(len(S))})

    through = 2.0 * IMPEDANCE / (IMPEDANCE + softer) * np.exp(-0.6 * S / ROD_SPEED)
    np.testing.assert_allclose(velocity[:, 0], through, rtol=1e-10)
    np.testing.assert_allclose(velocity[:, 1], through * np.exp(-0.2 * S / 1370.0), rtol=1e-10)
    np.testing.assert_allclose(stress[:, 0], -softer * through, rtol=1e-10)


def hump(time: np.ndarray) -> np.ndarray:
    return np.where((time > 0.1) & (time < 0.4), np.sin(np.pi * (time - 0.1) / 0.3) ** 4, 0.0)


def test_a_history_comes_back_late_by_a_delay_and_hardly_at_the_beginning_if_after_the_end() -> None:
    window = Window.up_to(1.0, 0.002)

    late = window.history(window.transform(hump) * np.exp(-0.25 * window.s))

    np.testing.assert_allclose(window.time[[0, -1]], [0.0, 1.0])
    np.testing.assert_allclose(late, hump(window.time - 0.25), atol=1e-6)
    # prescribed velocities are sampled later
    np.testing.assert_allclose(window.history(window.transform(hump, 0.1)), hump(window.time + 0.1), atol=1e-12)
    other = Window.up_to(0.99, 0.01)
    finer = other.finer(8)
    assert finer.samples * finer.step == other.samples * other.step
    assert finer.time[-1] == other.time[-1]
    np.testing.assert_allclose(finer.s[:5], other.s[:5])
    # it is damped by 1e-6 once it has passed the whole window, of twice the length of the history
    window = Window.up_to(1.0, 0.002)
    length = window.samples * window.step

    late = window.history(window.transform(hump) * np.exp(-length * window.s))

    np.testing.assert_allclose(late, 1e-6 * hump(window.time), atol=1e-10)


def test_a_layer_beyond_an_attenuated_bar_takes_its_waves() -> None:
    # they run as e^(−s√(1 + γ/s) x/c), within (kΔx)²/24 = 6e-5 of their phase; an unmatched layer would return 6 %
    case = with_changes(scene("attenuation"), {"boundary.right": LAYER | {"nodes": 40}, "bar.attenuation": 2.0})
    built, s = build_bar(case), np.array([1e4j])
    chain = Chain(built, built.layers, STEP)
    response = Response(chain, [0, 60, 80, 100])

    moved = response.velocities(Frequencies.of(s, STEP), {0: np.ones(1, dtype=complex)})

    near, far, end = (response.at(moved, chain.first + node) for node in (60, 80, 100))
    passed = np.exp(-s * np.sqrt(1.0 + 2.0 * 2.0 * 2740.0 / s) * 0.2 / 2740.0)
    np.testing.assert_allclose([far / near, end / far], [passed, passed], rtol=2e-4)
