"""Layers on a half-space beside tables that other programs, and an independent one, have computed."""

from pathlib import Path

import numpy as np
import pytest

from dembound.exact.column import Column, Layer

HERE = Path(__file__).parent
REFERENCE = 3.0**0.5


def layers(times: float = 1.0) -> list[Layer]:
    """The stack of layers3_transfer.csv, with speeds so many times as large."""
    rows = [(30.0, 1800.0, 200.0, 20.0), (40.0, 2000.0, 350.0, 40.0), (1.0, 2300.0, 700.0, np.inf)]
    return [Layer(thickness, density, times * speed, quality) for thickness, density, speed, quality in rows]


@pytest.mark.parametrize("damping", ["elastic", "hysteretic", "constant_q"])
@pytest.mark.parametrize(("kind", "times"), [("S", 1.0), ("P", 2.0)])
def test_three_layers_with_each_modulus(kind: str, times: float, damping) -> None:
    """To the nine digits of the table, of values up to 5."""
    table = np.genfromtxt(HERE / "layers3_transfer.csv", delimiter=",", names=True, skip_header=2)
    column = Column(layers(times), damping, REFERENCE)
    for place, depth in (("surface", 0.0), ("30m", 30.0), ("70m", 70.0)):
        of = f"{kind}_{damping}_{place}"
        expected = table[f"{of}_re"] + 1j * table[f"{of}_im"]
        np.testing.assert_allclose(column.transfer(table["f_Hz"], depth), expected, rtol=0.0, atol=2e-8)


def test_four_hundred_layers_of_nrattle() -> None:
    """To the five digits that NRATTLE prints."""
    stack = [Layer(*row) for row in np.loadtxt(HERE / "nrattle_layers.csv", delimiter=",")[:, [0, 2, 1]]]
    frequencies, expected = np.loadtxt(HERE / "nrattle_amplification.csv", delimiter=",").T
    found = Column([*stack, Layer(1.0, 2720.0, 3500.0)]).transfer(frequencies, over="outcrop")
    np.testing.assert_allclose(np.abs(found), expected, rtol=5e-5)


@pytest.mark.parametrize("damping", ["elastic", "constant_q"])
def test_a_history_is_causal_and_returns_from_each_motion_below(damping) -> None:
    """The surface under a pulse is at rest until the pulse arrives; and is the same under the motions of its base."""
    column, step = Column(layers(), damping, REFERENCE), 0.005
    time = step * np.arange(800)
    pulse = np.exp(-(((time - 0.5) / 0.08) ** 2))
    surface = column.history(pulse, step)
    arrival = 30.0 / 200.0 + 40.0 / 350.0
    assert np.abs(surface[time < 0.1 + 0.8 * arrival]).max() < 1e-6 < np.abs(surface).max()
    within, outcrop = column.history(pulse, step, 70.0), 2.0 * pulse
    # the undamped base nearly stands still at some frequencies: 1e-8 of what comes round is magnified
    np.testing.assert_allclose(column.history(outcrop, step, over="outcrop"), surface, atol=1e-9)
    np.testing.assert_allclose(column.history(within, step, over="within"), surface, atol=1e-5)
