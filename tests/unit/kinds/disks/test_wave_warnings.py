"""Waves and loads that are too short for the disks, too long for the run, too weak or too strong."""

import re

import pytest
from warned_cases import DENSE, SLOW, warned

from dembound.waves.wave import HANN_FADE
from dembound.words import with_unit

TWO_WAYS = {"motion.held": []}
BREAKABLE = {**SLOW, "material.law": "linearpbond", "material.pb_ten": 5e6}
STEP = {"wave.pulse": {"type": "constant", "amplitude": 1e-3, "rise": 0.0}, "run.duration": 0.01}
GRIP = {"type": "velocity", "wave_p": "pulse"}
GRIPPED = {"wave.pulse": {"type": "constant", "amplitude": 1e-6}, **BREAKABLE}
S_WAVE = {"boundary.left": {"type": "viscous_input", "wave_s": "pulse"}, **TWO_WAYS, **BREAKABLE}
TAP = {"name": "tap", "wave": "pulse"}
PUSHING = TAP | {"acceleration": [1.0, 0.0]}


def of_wave(**keys: float) -> dict:
    return {f"wave.pulse.{key}": value for key, value in keys.items()}


def strong(amplitude: float) -> dict:
    return of_wave(amplitude=amplitude)


def shortest(count: float) -> dict:
    """A wave with `count` disks in the shortest wavelength."""
    return of_wave(period=count * 0.5 * HANN_FADE / 500.0)


def lasting(duration: float) -> dict:
    return {"run.duration": duration}


def static(*stress: float) -> dict:
    return {"static": {"stress": list(stress)}}


def weight(acceleration: float) -> dict:
    return {"load": [{"name": "weight", "acceleration": [0.0, acceleration]}]}


TEN = "of material.pb_ten, 5 MPa: Pa and MPa?"
SUDDEN = STEP | {"boundary.left": GRIP} | lasting(1.01)
TAPPED = {"load": [TAP | {"position": [5.0, 0.5], "force": [1.0, 0.0]}]}
PRESSED = SLOW | TWO_WAYS | static(-1e6, -3e6, 0.5e6)
LIMITS = [
    # the mean frequency of a Hann lobe's energy, sin²πx/[πx(1 − x²)]² over x = fT, is 0.505/T
    (lasting(0.1), shortest(20.1), shortest(19.9), "has 19.9 particles in its shortest wavelength, fewer than 20"),
    # 20 disks of 0.5 m at 500 m/s, times 3.27
    (STEP, of_wave(rise=0.066), of_wave(rise=0.06), "rises within 0.06 s, which is shorter than the particles can "),
    # a slow grip may start suddenly: at 1000 m/s, 100 ways of 10 m are 1 s; a load or a wave that enters may not
    (SUDDEN, {}, lasting(0.99), "is a step"),
    (SUDDEN, {}, TAPPED, "is a step"),
    # the default locks in 10 MPa; ρcv = 2500·1000·v reaches that at 4 m/s; packings meet it within 0.05 %
    (DENSE, strong(3.99), strong(4.01), "has a stress ρcv of 10"),
    # the mean of 1 and 3 MPa at 0.8 m/s; 0.81 m/s make 2.025; a lattice has none by itself
    (PRESSED, strong(0.79), strong(0.81), "has a stress ρcv of 2.03 MPa, above the confining stress of 2 MPa"),
    # 10 m at 1000 m/s
    (lasting(1.0), of_wave(period=0.99), of_wave(period=1.01), "has a period of 1.01 s, 101 times its way through"),
    # ρc = 2.5e6 Pa·s/m
    (BREAKABLE, strong(2.02e-4), strong(1.98e-4), f"its stress ρcv is 495 Pa, 0.0099 % {TEN}"),
    (BREAKABLE, {"material.pb_ten": 1251.0}, {"material.pb_ten": 1249.0}, "its stress ρcv is 1.25 MPa, 1,001 times "),
    # 2.5e6·1e-4 Pa as a P wave, half of that as an S wave; a wave that is both counts with the larger one
    (S_WAVE, strong(4.1e-4), strong(3.9e-4), "its stress ρcv is 48"),
    # 2.5 Pa by ρcv, but 2 s of 1 µm/s strain 10 m by 2e-7, which is 500 Pa; along y 1 m
    (GRIPPED | {"boundary.left": GRIP}, lasting(2.1), lasting(1.9), f"its stress ρc²u/L is 475 Pa, 0.0095 % {TEN}"),
    # strains above 3 % of the elastic law, of velocities 1000 m/s
    (TWO_WAYS, strong(29.0), strong(50.0), "particles move at up to 50 m/s, P waves along x "),
]
"""Keys of the case, some without and some with a warning of wave.pulse, and how that begins."""


@pytest.mark.parametrize(("tables", "within", "beyond", "said"), LIMITS)
def test_a_wave_beyond_a_limit_has_one_warning(bar, tables: dict, within: dict, beyond: dict, said: str) -> None:
    start = f"wave.pulse: {re.split(r'[0-9]', said)[0]}"
    quiet, loud = ([line for line in warned(bar(tables | each)) if line.startswith(start)] for each in (within, beyond))
    assert quiet == []
    assert [line.removeprefix("wave.pulse: ")[: len(said)] for line in loud] == [said]


def test_steady_stresses_beside_strength_and_stiffness(bar) -> None:
    # 2.5 GPa, of which a body of 1 m under 1e5 g has 98 %; the law with a history is for large strains
    (line,) = (line for line in warned(bar(TWO_WAYS | weight(-9.81e5))) if "law is for small strains" in line)
    assert line.startswith("load.weight: its stress ρaL is 2.45 GPa, 98 % of the stiffness, 2.5 GPa, so strains ")
    large = TWO_WAYS | strong(50.0) | weight(-9.81e5) | {"material.law": "linearpbond"}
    assert not any("for small strains" in line for line in warned(bar(large)))
    assert not any("for small strains" in line for line in warned(bar(TWO_WAYS | weight(-9.81))))
    found = warned(bar(BREAKABLE | strong(1e-9) | static(0.0, -400.0, 0.0)))
    assert found == [f"static.stress: its largest component is 400 Pa, 0.008 % {TEN}"]


FORCE, WEIGHT = "its force over the width it acts on", "its stress ρaL"


@pytest.mark.parametrize(
    ("load", "what", "stress"),
    [
        # 2 m of the height of 1 m count no more than that; of a wave its crest of either sign, here 4
        ({"force": [100.0, 0.0], "region": [4.0, 0.0, 6.0, 1.0]}, FORCE, 400.0),
        ({"force": [100.0, 0.0], "position": [5.0, 0.5]}, FORCE, 200.0),
        ({"acceleration": [0.01, 0.0]}, WEIGHT, 250.0),
    ],
    ids=str,
)
def test_loads_beside_the_strength(bar, load: dict, what: str, stress: float) -> None:
    peak = {400.0: 4.0}.get(stress, 1.0)
    free = TWO_WAYS | {"boundary.left": {"type": "viscous"}}
    for strength, weak in ((0.99e4 * stress, False), (1.01e4 * stress, True)):
        wave = strong(peak) | {"material.pb_ten": strength}
        against = f"material.pb_ten, {with_unit(strength, 'Pa')}: Pa and MPa?"
        said = f"load.tap: {what} is {with_unit(stress, 'Pa')}, 0.0099 % of {against}"
        assert warned(bar(BREAKABLE | free | wave | {"load": [TAP | load]})) == weak * [said]


@pytest.mark.parametrize(
    ("changes", "is_doubted"),
    [
        (strong(4.9), False),  # the strongest motions recorded are slower
        (strong(5.1), True),
        (of_wave(amplitude=5.1, period=5e-3), False),  # a pulse of a laboratory
        (strong(5.1) | {"boundary.left": {"type": "free"}, "load": [PUSHING]}, False),  # of a load
    ],
    ids=str,
)
def test_waves_that_enter_are_no_faster_than_ground(bar, changes: dict, is_doubted: bool) -> None:
    found = [line for line in warned(bar(SLOW | changes)) if "shakes the ground" in line]
    assert len(found) == is_doubted
    assert is_doubted == any("wave.pulse: shakes the ground at up to 5.1 m/s, at " in line for line in found)


TURNS, S_SIDE = ["rotation"], {"type": "viscous_input", "wave_s": "pulse"}
HOLDS_Y = {"motion.held": ["y", "rotation"]}


@pytest.mark.parametrize(
    ("changes", "axis"),
    [
        ({"motion.held": ["x", "rotation"], "boundary.left": S_SIDE}, "x"),
        ({"motion.held": TURNS}, "x"),  # a free body also bends under P waves
        (HOLDS_Y, None),  # P waves along a strip
        (HOLDS_Y | {"load": [PUSHING | {"region": [4.0, 0.0, 6.0, 0.6]}]}, "y"),
        (HOLDS_Y | {"boundary.bottom": {"type": "fixed"}}, "y"),
        ({"motion.held": [], "boundary.left": S_SIDE}, None),
    ],
    ids=str,
)
def test_disks_that_do_not_turn_are_warned_of_where_the_body_shears(bar, changes: dict, axis: str | None) -> None:
    # on this lattice S waves have c_p/√2 = 707 m/s with rotations held, and 500 m/s without
    found = [line for line in warned(bar(SLOW | changes)) if line.startswith("motion.held")]
    speeds = "run at 707.1 m/s, beside P waves of 1000 m/s; where disks turn they have 500 m/s, 29 % less"
    says = f"S waves along {axis} {speeds}"
    assert [line.partition("shears: ")[2] for line in found] == [says] * (axis is not None)
