"""The case of a bar: a valid one, and the message for every mistake."""

import math

import pytest
from small_cases import problems_of, rows

from dembound.kinds import loads, with_changes
from dembound.methods.rod import Fracture
from dembound.starting import starting_point

STARTER = starting_point()

GOOD = """\
title = "short bar"
[bar]
length = 1
spacing = 0.01
density = 2620.0
wave_speed = 2740.0
strength = 10e6
[method]
type = "peridynamics"
horizon = 3
[boundary.right]
type = "viscous"
[boundary.left]
type = "viscous_input"
wave_p = "pulse"
[wave.pulse]
type = "triangle"
amplitude = 1.0
rise = 4e-5
fall = 8e-5
[[load]]
name = "blow"
pressure = 12e6
nodes = 3
wave = "pulse"
[[monitor]]
name = "gauge"
position = 0.5
[run]
duration = 5e-4
[output]
snapshots = 3
"""


def changed(old: str, new: str, text: str = GOOD) -> str:
    """The good case with one place changed."""
    assert text.count(old) == 1
    return text.replace(old, new)


def test_an_end_is_loaded_by_loads_and_by_waves() -> None:
    for changes, loaded in (
        ({"load": []}, "left"),  # by the wave that its dashpot lets in
        ({}, "left"),
        ({"load": [{"name": "blow", "pressure": 12e6, "wave": "pulse", "side": "right"}]}, "both"),
        ({"load": [], "boundary.left": {"type": "free"}}, "none"),
        ({"load": [], "boundary": {"right": {"type": "velocity", "wave_p": "pulse"}}}, "right"),
    ):
        assert with_changes(loads(GOOD), changes).loaded == loaded


def test_stiffness_is_given_by_speed_or_modulus_and_area_by_section_or_diameter() -> None:
    by_speed = loads(GOOD).bar
    by_modulus = loads(changed("wave_speed = 2740.0", f"youngs_modulus = {2620.0 * 2740.0**2!r}")).bar

    # E = ρc², each taken from the other within two roundings
    assert by_speed.modulus == by_modulus.modulus == 2620.0 * 2740.0**2
    assert by_speed.speed == pytest.approx(2740.0, rel=1e-15)
    assert by_modulus.speed == pytest.approx(2740.0, rel=1e-15)
    for keys, area in (("", 1.0), ("section = 0.02\n", 0.02), ("diameter = 0.07\n", math.pi * 0.035**2)):
        assert loads(changed("strength = 10e6\n", keys)).bar.area == pytest.approx(area, rel=1e-15)
    # a spacing need not divide the length to the last bit, and a horizon may be half the bar
    for length, spacing, cells in ((0.7, 0.1, 7), (0.99, 0.01, 99), (1.0, 0.1428571, 7)):
        changes = {"bar.length": length, "bar.spacing": spacing, "method.horizon": 1}
        assert with_changes(loads(GOOD), changes).bar.cells == cells
    assert loads(changed("horizon = 3", "horizon = 50")).method.largest_horizon == 50


@pytest.mark.parametrize(
    ("keys", "stretch"),
    [("", math.inf), ("strength = 10e6\n", 10e6 / (2620.0 * 2740.0**2)), ("critical_stretch = 0.00095\n", 0.00095)],
)
def test_a_bar_breaks_at_a_stress_at_a_stretch_or_never(keys: str, stretch: float) -> None:
    assert loads(changed("strength = 10e6\n", keys)).bar.breaking_stretch == stretch


MISTAKES = r"""
spacing = 0.01 | spacing = 0.03 | bar.spacing: is 0.03, must divide the length, 1 m, into two or more equal parts
spacing = 0.01 | spacing = 4e-7 | bar.spacing: is 4e-07, must cut the length, 1 m, into 2,000,000 or less
spacing = 0.01 | spacing = 0.01\nsection = 1\ndiameter = 1 | bar.diameter: is not allowed together with
length = 1\nspacing = 0.01 | length = 1e300\nspacing = 1e28 | bar.length: is 1e+300, must be 0 or of a size between
wave_speed = 2740.0\n |  | bar.wave_speed: is missing; give either wave_speed or youngs_modulus
wave_speed = 2740.0 | wave_speed = 1e-20 | bar.wave_speed: is 1e-20, with density 2620 beyond any material
wave_speed = 2740.0 | wave_speed = 2740.0\nyoungs_modulus = 2e10 | bar.youngs_modulus: is not allowed together with wave
strength = 10e6 | strength = 10e6\ncritical_stretch = 1e-3 | bar.critical_stretch: is not allowed together with strength
# ends
type = "viscous"\n | type = "roller"\n | boundary.right.type: is "roller", must be one of "
type = "viscous"\n | type = "viscous"\nhalf_mass = true\n | boundary.right.half_mass: is for disks; end nodes of a bar
type = "viscous"\n | type = "viscous"\nbeta_s = 0.5\n | boundary.right.beta_s: is for waves across, and a bar moves only
wave_p = "pulse" | wave_s = "pulse" | boundary.left.wave_s: moves across the bar, which moves only along its axis; use
wave_p = "pulse" | wave_p = "pulze" | boundary.left.wave_p: "pulze" is not a wave of this case; defined: pulse (did you
# loads, monitors and times
nodes = 3 | nodes = 102 | load[1, blow].nodes: is 102, must be at most 101, the nodes of the bar
position = 0.5 | position = 1.5 | monitor[1, gauge].position: is 1.5, must be at most bar.length, 1 (m)
duration = 5e-4 | duration = 5e-4\ncourant = 0.5\ntime_step = 1e-7 | run.courant: is not allowed together with time_step
duration = 5e-4 | duration = 5e-4\ncourant = 0.5\nsafety = 0.8 | run.safety: is for an automatic time step, courant giv
duration = 5e-4 | duration = 5e-4\ncourant = 274 | run.courant: makes a step of 0.001 s, must be at most run.duration,
# the method
"peridynamics"\nhorizon = 3 | "finite_difference"\nhorizon = 3 | method.horizon: is for "
"peridynamics"\nhorizon = 3 | "peridynamics" | method.horizon: is missing, must be a whole number no less than 1 and no
horizon = 3 | horizon = 51 | method.horizon: is 51, must be at most 50, half of the bar's spacings
horizon = 3 | horizon = 3\ntrigger = 0.9 | method.trigger: is for "
# cracks: 0.2·19.67 GPa·200 J/m²/(10 MPa)², and 2² times less at twice the strength
[method] | fracture_energy = 200\n[method] | bar.spacing: is 0.01, must be at most 0.00786796 m, 0.2 EG_f/σ_t²
[method] | fracture_energy = 500\nstrength_rates = [1, 10]\n[method] | bar.strength_per_decade: is missing;
[method] | strength_per_decade = 1e6\nstrength_rates = [1, 10]\n[method] | bar.strength_per_decade: needs fracture_ener
strength = 10e6 | fracture_energy = 500 | bar.fracture_energy: needs strength or critical_stretch, at which a crack beg
"""


@pytest.mark.parametrize(("old", "new", "line"), rows(MISTAKES))
def test_each_mistake_gets_one_plain_line(old: str, new: str, line: str) -> None:
    (found,) = problems_of(changed(old, new))
    assert found.startswith(line)


def test_no_load_pushes_an_end_whose_motion_is_prescribed() -> None:
    for end in ('type = "fixed"', 'type = "velocity"\nwave_p = "pulse"'):
        text = changed('type = "viscous_input"\nwave_p = "pulse"', end)
        (line,) = problems_of(text)
        assert line.startswith('load[1, blow].side: is "left", whose motion boundary.left prescribes ("')
        assert loads(changed("nodes = 3", 'side = "right"', text)).load[0].side == "right"


def test_tables_of_disks_are_distinguished_from_unknown_ones() -> None:
    (line,) = problems_of(f"{GOOD}[[hole]]\n")
    assert line.startswith("hole: is not allowed here, as [bar] makes this a case of a bar; allowed: title, bar, ")
    assert problems_of(f"{GOOD}[ouptut]\n")[0].startswith("ouptut: unknown table; allowed: title, bar, method, ")
    # a method alone makes it the case of a bar
    found = problems_of(f'[method]\ntype = "finite_difference"\n{STARTER[STARTER.index("[packing]") :]}')
    assert found[0].startswith("packing: is not allowed here, as [method] makes this a case of a bar; allowed: ")
    assert any(line.startswith("bar.length: is missing") for line in found)


def with_bar(*lines: str) -> str:
    """The good case with more keys in [bar]."""
    return GOOD.replace("[method]", "\n".join([*lines, "[method]"]), 1)


def test_a_fracture_energy_makes_cracks_that_open() -> None:
    case = loads(with_bar("fracture_energy = 1000", "strength_per_decade = 5e6", "strength_rates = [2, 20]"))

    assert case.bar.largest_strength == pytest.approx(15e6, rel=1e-15)
    assert case.bar.characteristic_length == pytest.approx(2620.0 * 2740.0**2 * 1000.0 / 15e6**2, rel=1e-15)
    assert case.bar.fracture == Fracture(1000.0, 5e6, (2.0, 20.0))
    assert case.bar.fracture.opening(10e6) == pytest.approx(2e-4, rel=1e-15)


def test_rates_are_two_above_0_and_the_largest_strength_counts() -> None:
    energy, more = "fracture_energy = {}", "strength_per_decade = 10e6"
    for keys, said in (
        (
            (energy.format(600), more, "strength_rates = [1, 10]"),
            "bar.spacing: is 0.01, must be at most 0.00590097 m, 0.2 EG_f/σ_t² at the largest strength",
        ),
        (
            (energy.format(5000), more, "strength_rates = [10, 1]"),
            "bar.strength_rates: is [10.0, 1.0], must be two",
        ),
    ):
        (line,) = problems_of(with_bar(*keys))
        assert line.startswith(said)
