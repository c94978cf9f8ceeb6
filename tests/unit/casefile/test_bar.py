"""Cases of bars, uniform and of ranges: valid ones, and the message for every mistake."""

import math

import pytest
from small_cases import problems_of, rows

from dembound.kinds import loads, with_changes
from dembound.methods.rod import Fracture
from dembound.starting import starting_point

GOOD = """\
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
[[load]]
name = "blow"
pressure = 12e6
nodes = 3
wave = "pulse"
[run]
duration = 5e-4
[wave]
pulse = {type = "triangle", amplitude = 1.0, rise = 4e-5, fall = 8e-5}
[[monitor]]
name = "gauge"
position = 0.5
"""
MODULUS = 2620.0 * 2740.0**2


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
    by_speed, by_modulus = (
        loads(changed("wave_speed = 2740.0", key)).bar
        for key in ("wave_speed = 2740.0", f"youngs_modulus = {MODULUS!r}")
    )
    # E = ρc², each taken from the other within two roundings
    assert by_speed.modulus == by_modulus.modulus == MODULUS
    assert (by_speed.speed, by_modulus.speed) == pytest.approx((2740.0, 2740.0), rel=1e-15)
    for keys, area in (("", 1.0), ("section = 0.02\n", 0.02), ("diameter = 0.07\n", math.pi * 0.035**2)):
        assert loads(changed("strength = 10e6\n", keys)).bar.area == pytest.approx(area, rel=1e-15)
    # a spacing need not divide the length to the last bit, and a horizon may be half the bar
    for length, spacing, cells in ((0.7, 0.1, 7), (0.99, 0.01, 99), (1.0, 0.1428571, 7)):
        changes = {"bar.length": length, "bar.spacing": spacing, "method.horizon": 1}
        assert with_changes(loads(GOOD), changes).bar.cells == cells
    assert loads(changed("horizon = 3", "horizon = 50")).method.largest_horizon == 50
    # it breaks at a stress, at a stretch or never
    for keys, stretch in (("", math.inf), ("strength = 10e6\n", 10e6 / MODULUS), ("critical_stretch = 1e-3\n", 1e-3)):
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
RATES = r"""
600 | [1, 10] | bar.spacing: is 0.01, must be at most 0.00590097 m, 0.2 EG_f/σ_t² at the largest strength
5000 | [10, 1] | bar.strength_rates: is [10.0, 1.0], must be two
"""


def cracking(energy: str, rates: str, per_decade: str = "10e6") -> str:
    """The good case with a fracture energy and strengths that follow the rate."""
    keys = f"fracture_energy = {energy}\nstrength_per_decade = {per_decade}\nstrength_rates = {rates}\n"
    return changed("[method]", f"{keys}[method]")


@pytest.mark.parametrize(
    ("text", "line"),
    [
        *((changed(old, new), line) for old, new, line in rows(MISTAKES)),
        *((cracking(energy, rates), line) for energy, rates, line in rows(RATES)),
    ],
    ids=lambda each: each[:40] if ":" in each else "",
)
def test_each_mistake_gets_one_plain_line(text: str, line: str) -> None:
    (found,) = problems_of(text)
    assert found.startswith(line)


def test_no_load_pushes_an_end_whose_motion_is_prescribed() -> None:
    for end in ('type = "fixed"', 'type = "velocity"\nwave_p = "pulse"'):
        text = changed('type = "viscous_input"\nwave_p = "pulse"', end)
        (line,) = problems_of(text)
        assert line.startswith('load[1, blow].side: is "left", whose motion boundary.left prescribes ("')
        assert loads(changed("nodes = 3", 'side = "right"', text)).load[0].side == "right"


def test_tables_of_disks_are_distinguished_from_unknown_ones() -> None:
    starter = starting_point()
    of_disks = starter[starter.index("[packing]") :]
    # a method alone makes it the case of a bar
    found = problems_of(f'[method]\ntype = "finite_difference"\n{of_disks}')
    assert any(line.startswith("bar.length: is missing") for line in found)
    for line, said in (
        (problems_of(f"{GOOD}[[hole]]\n")[0], "hole: is not allowed here, as [bar] makes this a case of a bar; "),
        (problems_of(f"{GOOD}[ouptut]\n")[0], "ouptut: unknown table; allowed: title, bar, method, "),
        (found[0], "packing: is not allowed here, as [method] makes this a case of a bar; allowed: "),
    ):
        assert line.startswith(said)


def test_a_fracture_energy_makes_cracks_that_open() -> None:
    bar = loads(cracking("1000", "[2, 20]", "5e6")).bar
    assert bar.largest_strength == pytest.approx(15e6, rel=1e-15)
    assert bar.characteristic_length == pytest.approx(MODULUS * 1000.0 / 15e6**2, rel=1e-15)
    assert bar.fracture == Fracture(1000.0, 5e6, (2.0, 20.0))
    assert bar.fracture.opening(10e6) == pytest.approx(2e-4, rel=1e-15)


RANGES = """
wave.pulse = {type = "constant", amplitude = 1.0}
method = {type = "peridynamics", horizon = 3}
load = [{name = "push", pressure = 1e6, wave = "pulse", nodes = 2}]
[run]
duration = 1e-3
[bar]
spacing = 0.01
density = 8000
wave_speed = 5000
diameter = 0.02
strength = 1e9
[[bar.range]]
name = "striker"
length = 0.2
velocity = 10
[[bar.range]]
name = "specimen"
length = 0.05
spacing = 0.0025
youngs_modulus = 2e9
density = 2000.0
section = 1e-4
critical_stretch = 1e-3
interface = "contact"
gap = 0.001
[[bar.range]]
name = "bar"
length = 1
"""


def test_a_range_has_what_it_does_not_give_from_the_bar() -> None:
    bar = loads(RANGES).bar
    striker, specimen, rest = bar.parts
    assert (striker.length, striker.spacing, striker.speed) == (0.2, 0.01, 5000.0)
    assert (rest.length, rest.spacing, rest.speed) == (1.0, 0.01, 5000.0)
    assert (specimen.modulus, specimen.speed, specimen.area, specimen.cells) == (2e9, 1000.0, 1e-4, 20)
    assert (specimen.breaking_stretch, striker.breaking_stretch) == (1e-3, 1e9 / 2e11)
    assert bar.least_strength == 2e6
    assert bar.length == pytest.approx(1.251, rel=1e-15)
    assert bar.starts == pytest.approx((0.0, 0.201, 0.251), rel=1e-15)
    # 21 + 21 at the contact, 21 − 1 + 101 at the bonded interface
    assert (bar.nodes, bar.contacts) == (21 + 21 + 100, (False, True, False))
    assert bar.travel_time == pytest.approx(0.2 / 5000 + 0.05 / 1000 + 1.0 / 5000, rel=1e-12)
    assert "length" not in bar.given()


MISTAKES_OF_RANGES = r"""
length = 0.2 | lengh = 0.2 | bar.range[1, striker].length: is missing, must be a number greater than 0 (m)
length = 0.2 | length = 0.205 | bar.range[1, striker].spacing: is 0.01, must divide the length, 0.205 m, into two or mor
velocity = 10 | interface = "contact" | bar.range[1, striker].interface: is "contact", but no range is on its left
interface = "contact" |  | bar.range[2, specimen].gap: is only allowed with interface = "contact"
diameter = 0.02 | length = 2 | bar.length: is 2, must be that of all ranges and gaps, 1.251 m, or left out
nodes = 2 | nodes = 21 | load[1, push].nodes: is 21, must be at most 20, the nodes of the left range alone
horizon = 3 | horizon = 11 | method.horizon: is 11, must be at most 10, half of the shortest range's spacings
duration = 1e-3 | duration = 1e-6\ncourant = 1.0 | run.courant: makes a step of 2e-06 s, must be at most run.duration, 1
"""


@pytest.mark.parametrize(("old", "new", "line"), rows(MISTAKES_OF_RANGES))
def test_every_mistake_has_its_line(old: str, new: str, line: str) -> None:
    assert any(each.startswith(line) for each in problems_of(RANGES.replace(old, new, 1)))


def test_a_bar_without_ranges_needs_its_length() -> None:
    (found,) = problems_of(RANGES[: RANGES.index("[[bar.range]]")])
    assert found.startswith("bar.length: is missing, must be")
