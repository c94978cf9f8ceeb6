"""Waves in rods at single frequencies, beside closed forms; transforms of signals and back, over a damped window."""

import numpy as np
import pytest
from estimated_bars import BAR, RANGES, WALL
from small_cases import small

from dembound.bar.scene import build_bar
from dembound.formulas.bars.rods import Rods, Window

S = 40.0 + 2j * np.pi * np.array([0.0, 300.0, 2000.0, 9000.0])
SPEED, IMPEDANCE = 2740.0, 2620.0 * 2740.0


def rods(case, *places: float) -> Rods:
    return Rods(case, build_bar(case).rod, np.array(places), S)


@pytest.mark.parametrize(("end", "reflected"), [({}, 1.0), ({"boundary.right": WALL}, -1.0)])
def test_free_and_fixed_ends_return_all(end: dict[str, object], reflected: float) -> None:
    case = small(BAR, changes={"load": [], "boundary.left": {"type": "viscous_input", "wave_p": "pulse"}, **end})

    velocity, stress = rods(case, 0.25).motion({}, {"left": np.ones(len(S))})

    there, back = np.exp(-0.25 * S / SPEED), reflected * np.exp(-1.75 * S / SPEED)
    np.testing.assert_allclose(velocity[:, 0], there + back, rtol=1e-9)
    np.testing.assert_allclose(stress[:, 0], -IMPEDANCE * (there - back), rtol=1e-9)


def test_attenuation_makes_waves_fade_by_alpha() -> None:
    case = small(BAR, changes={"bar.attenuation": 0.5, "boundary.right": {"type": "viscous"}})

    velocity, _ = rods(case, 0.0, 0.8).motion({"left": np.ones(len(S))}, {})

    ratio = velocity[:, 1] / velocity[:, 0]
    np.testing.assert_allclose(ratio, np.exp(-0.8 * np.sqrt(S**2 + 2.0 * 0.5 * SPEED * S) / SPEED), rtol=1e-10)
    assert abs(ratio[-1]) / np.exp(-40.0 * 0.8 / SPEED) == pytest.approx(np.exp(-0.5 * 0.8), rel=1e-3)


def test_an_interface_transmits_by_the_impedances() -> None:
    ends = {"left": {"type": "viscous_input", "wave_p": "pulse"}, "right": {"type": "viscous"}}
    case = small(BAR, changes={"bar": BAR["bar"] | RANGES, "load": [], "boundary": ends})
    softer = 2000.0 * 1370.0

    velocity, stress = rods(case, 0.6, 0.8).motion({}, {"left": np.ones(len(S))})

    through = 2.0 * IMPEDANCE / (IMPEDANCE + softer) * np.exp(-0.6 * S / SPEED)
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


def test_a_lasting_signal_does_not_jump_at_the_end() -> None:
    # without fading out beyond the history its jump would ring there
    window = Window.up_to(1.0, 0.002)
    signal = window.transform(
        lambda time: np.clip(time / 0.2, 0.0, 1.0) ** 2 * (3.0 - 2.0 * np.clip(time / 0.2, 0.0, 1.0))
    )

    late = window.history(signal * np.exp(-0.1234 * window.s))

    shifted = np.clip((window.time - 0.1234) / 0.2, 0.0, 1.0)
    np.testing.assert_allclose(late, shifted**2 * (3.0 - 2.0 * shifted), atol=1e-4)
