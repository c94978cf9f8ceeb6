"""Chains of nodes at single frequencies, beside the infinite row of nodes and the matrix of the whole chain."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from estimated_bars import LAYER, scene

from dembound.bar.scene import build_bar
from dembound.exact.dispersion import Lattice
from dembound.formulas.bars.chain import Chain, Frequencies, Response
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


@pytest.mark.parametrize(
    ("name", "side"),
    [("input by a matched layer, m = 3", "left"), ("attenuation", "right")],
)
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
