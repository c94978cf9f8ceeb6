"""Waves at the interface of two ranges of a bar are reflected and transmitted as their impedances Z = ρcA say.

For stress R = (Z₂ − Z₁)/(Z₂ + Z₁) and for velocity −R. Finite differences with a node that both ranges share, half of
either mass in it, have a closed form: with θ = kΔx, of a harmonic wave the force Z√S cos(θ/2) per displacement on
either side, √S = 2 sin(ωΔt/2)/Δt. So R is that of the impedances Z cos(θ/2), to second order

    R + (1 − R²)(θ₁² − θ₂²)/16,

and exact for all waves where Δx/c is the same on both sides.
"""

import numpy as np
import pytest

from dembound.api import case
from dembound.bar.scene import build_bar
from dembound.bar.stability import choose_step
from dembound.motion.simulation import Simulation

DENSITY, SPEED, SPACING = 2500.0, 4000.0, 0.01
CYCLES = 6

CENTRAL, PATCH = {"type": "finite_difference"}, {"type": "patch", "horizon": 3}
SOFT = {"type": "peridynamics", "horizon": 3}
CORRECTED = SOFT | {"corrected_ends": True}


def shares(theta: float, keys: dict[str, float], method: dict, courant: float = 0.5) -> tuple[float, float]:
    """Size of the velocity reflected into the first range, and of that sent into the second one, over the incident one.

    theta : kΔx of a burst in the first range, with k = ω/c; keys : of the second range. The parts of the burst that
    pass a gauge one after the other are compared at its frequency; of linear waves this is exact although they disperse
    on the way, but for what the window cuts off.
    """
    frequency = theta * SPEED / SPACING / (2.0 * np.pi)
    cells = int(2.5 * CYCLES * 2.0 * np.pi / theta)
    ranges = [
        {"name": "first", "length": 2 * cells * SPACING},
        {"name": "second", "length": 8 * cells * SPACING} | keys,
    ]
    nodes = 3 if method["type"] == "peridynamics" else 1
    scene = build_bar(
        case(
            bar={"spacing": SPACING, "density": DENSITY, "wave_speed": SPEED, "range": ranges},
            method=method,
            load=[{"name": "burst", "pressure": 1.0, "wave": "burst", "nodes": nodes}],
            wave={"burst": {"type": "sine_burst", "amplitude": 1.0, "frequency": frequency, "cycles": CYCLES}},
            run={"duration": 1.0, "courant": courant},
        )
    )
    step = choose_step(scene)[0]
    interface, beyond = scene.rod.ranges[0].last, scene.rod.nearest((2 + 0.5) * cells * SPACING)
    fast = SPEED * step / SPACING  # spacings of the first range in a step
    record = Simulation(scene, step, [interface - cells, beyond]).advance(int(4.9 * cells / fast))[:, :, 3]
    split = int(2.0 * cells / fast) + int(0.9 * cells / fast)
    turn = np.exp(-2j * np.pi * frequency * step * np.arange(len(record)))
    came, back = (turn[part] @ record[part, 0] for part in (slice(0, split), slice(split, None)))
    return abs(back / came), abs(turn @ record[:, 1] / came)


def of_lattice(theta: float, keys: dict[str, float], courant: float) -> tuple[float, float]:
    """Reflection and transmission of finite differences: from the impedances Z cos(θ/2), sin(θ/2) = sin(ωΔt/2)/ν."""
    material = {"density": DENSITY, "wave_speed": SPEED, "spacing": SPACING, "section": 1.0}
    step = courant * min(SPACING / SPEED, keys.get("spacing", SPACING) / keys.get("wave_speed", SPEED))
    impedances = []
    for each in (material, material | keys):
        half = np.arcsin(np.sin(0.5 * theta * SPEED / SPACING * step) * each["spacing"] / (each["wave_speed"] * step))
        impedances.append(each["density"] * each["wave_speed"] * each["section"] * np.cos(half))
    first, second = impedances
    return abs(second - first) / (second + first), 2.0 * first / (second + first)


@pytest.mark.parametrize(
    ("keys", "method", "courant"),
    [
        ({"section": 0.2}, CENTRAL, 1.0),
        ({"section": 4.0, "wave_speed": 2000.0}, PATCH, 0.5),
        ({"density": 500.0, "spacing": 0.005}, CENTRAL, 0.5),
    ],
    ids=str,
)
def test_finite_differences_reflect_as_their_lattice(keys: dict[str, float], method: dict, courant: float) -> None:
    found = shares(0.4, keys, method, courant)

    # what is left of the burst outside the window is some 1e-6 of it
    assert found == pytest.approx(of_lattice(0.4, keys, courant), abs=1e-5)
    # its error is that of the impedances' cosines
    ratio = keys.get("section", 1.0) * keys.get("wave_speed", SPEED) / SPEED * keys.get("density", DENSITY) / DENSITY
    exact = (ratio - 1.0) / (ratio + 1.0)
    other = 0.4 * keys.get("spacing", SPACING) / SPACING * SPEED / keys.get("wave_speed", SPEED)
    expected = np.sign(exact) * (1.0 - exact**2) * (0.4**2 - other**2) / 16.0
    # the next order of the cosines, θ⁴/200 of each
    assert found[0] - abs(exact) == pytest.approx(expected, abs=max(0.4, other) ** 4 / 100.0 + 1e-5)


@pytest.mark.parametrize(
    ("keys", "method"),
    [({"section": 5.0}, CORRECTED), pytest.param({"section": 2.0, "spacing": 0.005}, SOFT, marks=pytest.mark.slow)],
    ids=str,
)
def test_peridynamics_reflect_to_second_order_or_better(keys: dict[str, float], method: dict) -> None:
    ratio = keys["section"]
    exact = np.array([(ratio - 1.0) / (ratio + 1.0), 2.0 / (1.0 + ratio)])
    coarse, fine = (np.abs(shares(theta, keys, method) - exact) for theta in (0.2, 0.1))

    # springs that complete the stress keep all but second order; θ² = 0.04, of which 1/12 or less is left, the share
    # 0.0835 of the seam of a patch in `test_patch_seam.py`, on either side
    most = 2.0 * 0.0835 * 0.2**2
    assert np.all(coarse < most)
    assert coarse[1] > 3.6 * fine[1]
    # the same bar cut into two ranges of one material reflects nothing, however the bonds are arranged
    back, through = shares(0.2, {}, method)
    assert back < most
    assert through == pytest.approx(1.0, abs=most)
