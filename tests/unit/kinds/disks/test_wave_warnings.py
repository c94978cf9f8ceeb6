"""Waves and loads that are too short for the disks, too long for the run, too weak or too strong."""

import re

import pytest
from scene_tables import monitors
from small_cases import around, small
from warned_cases import DENSE, GROUND, SLOW, warned

from dembound.casefile import Case
from dembound.disks.scene import build
from dembound.kinds.disks.side_warnings import spring_warnings
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


def shortest(count: float) -> dict:
    """A wave with `count` disks in the shortest wavelength."""
    return of_wave(period=count * 0.5 * HANN_FADE / 500.0)


def strong(amplitude: float) -> dict:
    return of_wave(amplitude=amplitude)


def lasting(duration: float) -> dict:
    return {"run.duration": duration}


def weight(acceleration: float) -> dict:
    return {"load": [{"name": "weight", "acceleration": [0.0, acceleration]}]}


TEN = "of material.pb_ten, 5 MPa: Pa and MPa?"
SUDDEN = STEP | {"boundary.left": GRIP} | lasting(1.01)
TAPPED = {"load": [TAP | {"position": [5.0, 0.5], "force": [1.0, 0.0]}]}
PRESSED = SLOW | TWO_WAYS | {"static.stress": [-1e6, -3e6, 0.5e6]}
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
    heavy, linear = TWO_WAYS | strong(50.0) | weight(-9.81e5), {"material.law": "linearpbond"}
    # 2.5 GPa, of which a body of 1 m under 1e5 g has 98 %; the law with a history is for large strains
    (line,) = (line for line in warned(bar(TWO_WAYS | weight(-9.81e5))) if "law is for small strains" in line)
    assert line.startswith("load.weight: its stress ρaL is 2.45 GPa, 98 % of the stiffness, 2.5 GPa, so strains ")
    for changes in (heavy | linear, TWO_WAYS | weight(-9.81)):
        assert not any("for small strains" in line for line in warned(bar(changes)))
    found = warned(bar(BREAKABLE | strong(1e-9) | {"static.stress": [0.0, -400.0, 0.0]}))
    assert found == [f"static.stress: its largest component is 400 Pa, 0.008 % {TEN}"]


FORCE, WEIGHT = "its force over the width it acts on", "its stress ρaL"


@pytest.mark.parametrize(
    ("load", "what", "stress", "peak"),
    [
        # 2 m of the height of 1 m count no more than that; of a wave its crest of either sign, here 4
        ({"force": [100.0, 0.0], "region": [4.0, 0.0, 6.0, 1.0]}, FORCE, 400.0, 4.0),
        ({"force": [100.0, 0.0], "position": [5.0, 0.5]}, FORCE, 200.0, 1.0),
        ({"acceleration": [0.01, 0.0]}, WEIGHT, 250.0, 1.0),
    ],
)
def test_loads_beside_the_strength(bar, load: dict, what: str, stress: float, peak: float) -> None:
    free = BREAKABLE | TWO_WAYS | {"boundary.left": {"type": "viscous"}, "load": [TAP | load]} | strong(peak)
    for strength, weak in ((0.99e4 * stress, False), (1.01e4 * stress, True)):
        against = f"material.pb_ten, {with_unit(strength, 'Pa')}: Pa and MPa?"
        said = f"load.tap: {what} is {with_unit(stress, 'Pa')}, 0.0099 % of {against}"
        assert warned(bar(free | {"material.pb_ten": strength})) == weak * [said]


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


def about(case: Case, side: str) -> list[str]:
    """The warnings that a side sends back too much, without its name."""
    start = f"boundary.{side}: "
    return [line.removeprefix(start) for line in warned(case) if line.startswith(f"{start}sends back")]


@pytest.mark.parametrize("beta", [0.66, "matched", 1.49])
def test_a_factor_is_judged_by_its_value(bar, beta) -> None:
    """The matched factor of the lattice is 1, and (1 − β)/(1 + β) is 0.2 at β = 2/3 and 3/2."""
    said = (
        "sends back 20 % of the amplitude of P waves along its normal: beta_p is 0.66, matched would be 1; leave it "
        'out or give "matched"'
    )
    assert about(bar({**SLOW, "boundary.right.beta_p": beta}), "right") == [said] * (beta == 0.66)


def test_a_factor_is_judged_by_the_packing(bar) -> None:
    """β0 of the lattice is its own S speed of 500 m/s over the one given."""
    changes = {**SLOW, **TWO_WAYS, "boundary.right.beta_s": 1.0}
    moduli = {"density": 2500.0, "emod": 1.25e9, "pb_emod": 1.25e9}
    assert about(bar({**changes, "material": moduli | {"s_wave_speed": 500.0}}), "right") == []
    (line,) = about(bar({**changes, "material": moduli | {"s_wave_speed": 250.0}}), "right")
    start = "sends back 33 % of the amplitude of S waves along its normal: beta_s is 1, matched would be 2;"
    assert line.startswith(start)
    # a wave enters with 2β/(β0 + β) of its amplitude: 1.5 at β = 3
    (line,) = about(bar({**SLOW, "boundary.left.beta_p": 3.0}), "left")
    assert line.startswith("sends back 50 % of the amplitude of P waves along its normal and lets in 1.5 times wave p")


def test_springs_hold_long_waves_back(bar) -> None:
    """|R| = (1 + (2ωLρc/(αG))²)^(−½): at ω = 2π/s, and c_p = 2 c_s with G = ρc_s², a fifth at L = 4.9 αG/(2ωρc)."""
    wave = {"wave.pulse": {"type": "ricker", "amplitude": 0.5, "frequency": 1.0}, "run.duration": 5.0}
    near, far = (
        about(bar({**wave, "boundary.right": {"type": "viscoelastic", "distance": distance}}), "right")
        for distance in (20.0, 200.0)
    )
    assert far == []
    assert "% of the amplitude of P waves along its normal at their mean frequency, 1" in near[0]
    assert "as its springs hold" in near[0]


def test_sides_that_send_back_for_one_reason_share_a_line(bar) -> None:
    dead, stiff = ({"type": "viscous", "beta_p": beta, "beta_s": beta} for beta in (0.0, 1e6))
    sides = {"boundary.right": dead, "boundary.top": dead, "boundary.bottom": stiff}
    found = warned(bar({**SLOW, **TWO_WAYS, "packing.size": [20.0, 10.0], **sides}))
    assert [line.split(", matched")[0] for line in found if "back" in line] == [
        "boundary.right and boundary.top: send back 100 % of the amplitude of P and S waves along their normals, as a "
        "free surface does: beta_p and beta_s are 0",
        "boundary.bottom: sends back 100 % of the amplitude of P and S waves along its normal, as a rigid wall does: "
        "beta_p and beta_s are 1e+06",
    ]


def test_sides_along_a_wave_are_warned_of(bar) -> None:
    """Those that a case does not give are taken as forgotten: beside a wave from below the ground goes on there."""

    def found(**sides: dict) -> list[str]:
        enters = {"bottom": {"type": "viscous_input", "wave_s": "pulse"}}
        places = {"monitor": monitors(middle=(10.0, 5.0), surface=(10.0, 9.5))}
        plate = {"packing.size": [20.0, 10.0], "run.duration": 0.1, **TWO_WAYS, **places, "boundary": enters | sides}
        return [line for line in warned(bar(plate)) if "along wave" in line]

    (line,) = found(left={"type": "viscous"})
    said = "boundary.left and boundary.right: along wave pulse from bottom no side moves as ground beyond it would; at "
    assert line.startswith(f"{said}monitor ")
    assert line.endswith('% where least (RMS); take "free_field", or "outside" there and at bottom')
    assert len(found()) == 1
    assert found(**around("free", "left", "right")) == []


BLOW = {"name": "blow", "force": [0.0, -1e5], "position": [9.5, 9.5], "wave": "blow"}
PRESS = {"name": "press", "pressure": 1e5, "hole": "cavity", "wave": "blow"}
CAVITY = {"name": "cavity", "type": "circle", "centre": [10.0, 5.0], "radius": 2.0}
DRIVEN = {"boundary.top": {"type": "viscous_input", "wave_p": "blow"}}
IN_CAVITY = {"load": [PRESS], "hole": [CAVITY]}
FROM_LOAD = "but waves come from load.blow, at (9.5, 9.5) m"
MODULUS = "young_modulus: gives springs of G = 1"


@pytest.mark.parametrize(
    ("side", "tables", "words"),
    [
        # the load is 9 m above the row of the side; from −2 m springs are twice as stiff in the mean of 1/L
        ({"source": [10.0, 10.0]}, {"load": [BLOW]}, None),
        ({"source": [36e3, 10.0]}, {"load": [BLOW]}, FROM_LOAD),
        ({"source": [10.0, -2.0]}, {"load": [BLOW]}, FROM_LOAD),
        # a cavity is a centre of waves; without a centre a source may be anywhere near
        ({"source": [10.0, 5.0]}, IN_CAVITY, None),
        ({"source": [10.0, 500.0]}, IN_CAVITY, "waves come from"),
        ({"source": [10.0, -36e3]}, DRIVEN, "times its diagonal"),
        # the disks have G = ρc_s² = 1.25 GPa, with c_s = c_p/√2 or c_p/2 of 625 MPa
        ({"distance": 10.0, "young_modulus": 2.0e9}, {"load": [BLOW]}, None),
        ({"distance": 10.0, "young_modulus": 2.0e6}, {"load": [BLOW]}, MODULUS),
        # ten diagonals of 20 × 10 m are 223.6 m
        ({"distance": 220.0}, {"load": [BLOW]}, None),
        ({"distance": 230.0}, {"load": [BLOW]}, "boundary.bottom.distance: is 230 m, 10.3 times"),
        ({"distance": 10.0, "alpha_n": 0.0, "alpha_s": 0.0}, {}, "alpha_n and alpha_s are 0, so it has no springs"),
    ],
)
def test_springs_that_are_not_those_of_the_ground_are_warned_of(side: dict, tables: dict, words: str | None) -> None:
    springs = {"boundary.bottom": {"type": "viscoelastic", **side}}
    found = list(spring_warnings(build(small(GROUND, changes={**springs, **tables}))))
    assert len(found) == (words is not None)
    assert words is None or words in found[0]
