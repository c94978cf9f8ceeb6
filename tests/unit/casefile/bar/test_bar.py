"""The case of a bar: what a good one becomes, and the line every mistake gets."""

import math
from collections.abc import Iterable

import pytest

from dembound.casefile.bar import BarCase
from dembound.casefile.disks import DiskCase
from dembound.casefile.types import BOUNDARIES, METHODS
from dembound.errors import CaseError
from dembound.kinds import loads, with_changes
from dembound.methods.fracture import Fracture
from dembound.starting import starting_point
from dembound.table import name_of

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

NO_PLACE = (
    "is not allowed here, as [bar] makes this a case of a bar; allowed: title, bar, method, boundary, wave, load, "
    "monitor, run, output, chart, sweep"
)


def problems(text: str) -> list[str]:
    """All lines the text is refused with."""
    with pytest.raises(CaseError) as caught:
        loads(text)
    return caught.value.problems


def changed(old: str, new: str, text: str = GOOD) -> str:
    """The good case with one place changed."""
    assert text.count(old) == 1
    return text.replace(old, new)


def test_a_good_case_is_read_as_it_stands() -> None:
    case = loads(GOOD)

    assert isinstance(case, BarCase)
    assert (case.bar.length, case.bar.cells, case.bar.attenuation) == (1.0, 100, 0.0)
    assert (case.method.type, case.method.horizon, case.method.corrected_ends) == ("peridynamics", 3, False)
    assert list(case.boundary) == ["left", "right"]
    (load,) = case.load
    assert (load.pressure, load.side, load.nodes, load.wave) == (12e6, "left", 3, "pulse")
    assert case.monitor[0].position == 0.5
    assert (case.run.time_step, case.run.courant, case.run.safety) == ("auto", None, 0.9)


def test_a_case_without_a_bar_is_one_of_disks() -> None:
    assert isinstance(loads(STARTER), DiskCase)


def test_optional_tables_may_be_absent() -> None:
    case = loads(
        "[bar]\nlength = 1\nspacing = 0.5\ndensity = 1\nyoungs_modulus = 4\n"
        '[method]\ntype = "finite_difference"\n[run]\nduration = 1'
    )

    assert (case.title, case.boundary, case.wave, case.load, case.monitor) == ("", {}, {}, (), ())


@pytest.mark.parametrize(
    ("changes", "loaded"),
    [
        ({"boundary": {}}, "left"),
        ({"load": []}, "left"),  # by the wave that its dashpot lets in
        ({}, "left"),
        ({"load": [{"name": "blow", "pressure": 12e6, "wave": "pulse", "side": "right"}]}, "both"),
        ({"load": [], "boundary.left": {"type": "free"}}, "none"),
        ({"load": [], "boundary": {"right": {"type": "velocity", "wave_p": "pulse"}}}, "right"),
    ],
)
def test_an_end_is_loaded_by_loads_and_by_waves(changes: dict, loaded: str) -> None:
    case = with_changes(loads(GOOD), changes)
    assert isinstance(case, BarCase)
    assert case.loaded == loaded


def test_stiffness_is_given_by_speed_or_modulus() -> None:
    by_speed = loads(GOOD).bar
    by_modulus = loads(changed("wave_speed = 2740.0", f"youngs_modulus = {2620.0 * 2740.0**2!r}")).bar

    # E = ρc², each taken from the other within two roundings
    assert by_speed.modulus == by_modulus.modulus == 2620.0 * 2740.0**2
    assert by_speed.speed == pytest.approx(2740.0, rel=1e-15)
    assert by_modulus.speed == pytest.approx(2740.0, rel=1e-15)


@pytest.mark.parametrize(
    ("keys", "area"),
    [("", 1.0), ("section = 0.02\n", 0.02), ("diameter = 0.07\n", math.pi * 0.035**2)],
)
def test_section_is_an_area_or_that_of_a_round_bar(keys: str, area: float) -> None:
    bar = loads(changed("strength = 10e6\n", keys)).bar

    assert bar.area == pytest.approx(area, rel=1e-15)


@pytest.mark.parametrize(
    ("keys", "stretch"),
    [("", math.inf), ("strength = 10e6\n", 10e6 / (2620.0 * 2740.0**2)), ("critical_stretch = 0.00095\n", 0.00095)],
)
def test_a_bar_breaks_at_a_stress_at_a_stretch_or_never(keys: str, stretch: float) -> None:
    assert loads(changed("strength = 10e6\n", keys)).bar.breaking_stretch == stretch


@pytest.mark.parametrize(("length", "spacing", "cells"), [(0.7, 0.1, 7), (0.99, 0.01, 99), (1.0, 0.1428571, 7)])
def test_a_spacing_need_not_divide_the_length_to_the_last_bit(length: float, spacing: float, cells: int) -> None:
    bar = with_changes(loads(GOOD), {"bar.length": length, "bar.spacing": spacing, "method.horizon": 1}).bar

    assert bar.cells == cells


@pytest.mark.parametrize(
    ("old", "new", "line"),
    [
        ("length = 1\n", "length = 0\n", "length: is 0, must be greater than 0"),
        (
            "spacing = 0.01",
            "spacing = 0.03",
            "spacing: is 0.03, must divide the length, 1 m, into two or more equal parts",
        ),
        ("spacing = 0.01", "spacing = 1", "spacing: is 1, must divide the length, 1 m, into two or more equal parts"),
        ("spacing = 0.01", "spacing = 3", "spacing: is 3, must divide the length, 1 m, into two or more equal parts"),
        ("spacing = 0.01", "spacing = 4e-7", "spacing: is 4e-07, must cut the length, 1 m, into 2,000,000 or less"),
        ("spacing = 0.01", "spacing = 1e-320", "spacing: is 9.99989e-321, must be 0 or of a size "),
        ("spacing = 0.01", "spacing = 0.01\nsection = 1\ndiameter = 1", "diameter: is not allowed together with "),
        (
            "length = 1\nspacing = 0.01",
            "length = 1e300\nspacing = 1e28",
            "length: is 1e+300, must be 0 or of a size between ",
        ),
        (
            "spacing = 0.01",
            "spacing = 0.01\nsection = 1e-310",
            "section: is 1e-310, must be 0 or of a size between ",
        ),
        (
            "spacing = 0.01",
            "spacing = 0.01\ndiameter = 1e200",
            "diameter: is 1e+200, must be 0 or of a size between ",
        ),
        ("wave_speed = 2740.0\n", "", "wave_speed: is missing; give either wave_speed or youngs_modulus"),
        (
            "wave_speed = 2740.0",
            "wave_speed = 1e-20",
            "wave_speed: is 1e-20, with density 2620 beyond any material",
        ),
        ("wave_speed = 2740.0", "wave_speed = 1e20", "wave_speed: is 1e+20, with density "),
        (
            "wave_speed = 2740.0",
            "youngs_modulus = 1e30",
            "youngs_modulus: is 1e+30, with density 2620 beyond any material",
        ),
        ("density = 2620.0", "density = 1e-300", "density: is 1e-300, must be 0 or of a size between "),
        (
            "wave_speed = 2740.0",
            "wave_speed = 2740.0\nyoungs_modulus = 2e10",
            "youngs_modulus: is not allowed together with wave_speed",
        ),
        (
            "strength = 10e6",
            "strength = 10e6\ncritical_stretch = 1e-3",
            "critical_stretch: is not allowed together with strength",
        ),
        ("strength = 10e6", "strength = 0", "strength: is 0, must be greater than 0"),
        ("strength = 10e6", "attenuation = -1", "attenuation: is -1, must be at least 0"),
        ("density = 2620.0\n", "", "density: is missing, must be a number greater than 0 (kg/m³)"),
        ("strength = 10e6", "radius = 1", "radius: unknown key; allowed: length, spacing, section, diameter, "),
    ],
)
def test_mistakes_in_the_bar(old: str, new: str, line: str) -> None:
    (found,) = problems(changed(old, new))
    assert found.startswith(f"bar.{line}")


def names(types: Iterable[type], key: str = "type") -> str:
    """What messages list: the names of the registered types that have a key."""
    return ", ".join(sorted(f'"{name_of(table)}"' for table in types if key in table.model_fields))


@pytest.mark.parametrize(
    ("method", "line"),
    [
        ('type = "fem"', f'type: is "fem", must be one of {names(METHODS)}'),
        ("horizon = 3", f"type: is missing, must be one of {names(METHODS)}"),
        (
            'type = "finite_difference"\nhorizon = 3',
            f"horizon: is for {names(METHODS, 'horizon')}; allowed here: type",
        ),
        ('type = "peridynamics"', "horizon: is missing, must be a whole number no less than 1 and no more than 1000"),
        ('type = "peridynamics"\nhorizon = 0', "horizon: is 0, must be at least 1"),
        (
            'type = "peridynamics"\nhorizon = 2.5',
            "horizon: is 2.5, must be a whole number no less than 1 and no more than 1000",
        ),
        ('type = "peridynamics"\nhorizon = 51', "horizon: is 51, must be at most 50, half of the bar's spacings"),
        ('type = "switch"\nhorizon = 51', "horizon: is 51, must be at most 50, half of the bar's spacings"),
        (
            'type = "peridynamics"\nhorizon = 3\ntrigger = 0.9',
            f"trigger: is for {names(METHODS, 'trigger')}; allowed here: type, horizon, corrected_ends",
        ),
        (
            'type = "peridynamics"\nhorizon = 3\nhorizons = 3',
            "horizons: unknown key; allowed: type, horizon, corrected_ends (did you mean horizon?)",
        ),
        (
            'type = "switch"\nhorizon = 3\nbefore = "patch"',
            'before: is "patch", must be one of "finite_difference", "peridynamics"',
        ),
        ('type = "switch"\nhorizon = 3\ntrigger = 0', "trigger: is 0, must be greater than 0"),
        ('type = "patch"\nhorizon = 3\ntrigger = 1.1', "trigger: is 1.1, must be at most 1"),
        ('type = "patch"\nhorizon = 3\nreach = 0', "reach: is 0, must be at least 1"),
    ],
)
def test_mistakes_in_the_method(method: str, line: str) -> None:
    assert problems(changed('type = "peridynamics"\nhorizon = 3', method)) == [f"method.{line}"]


def test_a_horizon_may_be_half_the_bar() -> None:
    assert loads(changed("horizon = 3", "horizon = 50")).method.largest_horizon == 50


@pytest.mark.parametrize(
    ("old", "new", "line"),
    [
        ("[boundary.right]", "[boundary.top]", "boundary.top: unknown side; allowed: left, right"),
        (
            'type = "viscous"\n',
            'type = "roller"\n',
            f'boundary.right.type: is "roller", must be one of {names(end for end in BOUNDARIES if end.for_bars)}',
        ),
        (
            'type = "viscous"\n',
            'type = "viscous"\nhalf_mass = true\n',
            "boundary.right.half_mass: is for disks; end nodes of a bar have half a mass in any case",
        ),
        (
            'type = "viscous"\n',
            'type = "viscous"\nbeta_s = 0.5\n',
            "boundary.right.beta_s: is for waves across, and a bar moves only along its axis; use beta_p",
        ),
        (
            'type = "viscous"\n',
            'type = "viscous"\nbeta_p = -1\n',
            'boundary.right.beta_p: is -1, must be a number no less than 0 or "matched"',
        ),
        (
            'wave_p = "pulse"',
            'wave_s = "pulse"',
            "boundary.left.wave_s: moves across the bar, which moves only along its axis; use wave_p",
        ),
        (
            'wave_p = "pulse"',
            'wave_p = "pulze"',
            'boundary.left.wave_p: "pulze" is not a wave of this case; defined: pulse (did you mean pulse?)',
        ),
    ],
)
def test_mistakes_at_the_ends(old: str, new: str, line: str) -> None:
    assert problems(changed(old, new)) == [line]


@pytest.mark.parametrize("end", ['type = "fixed"', 'type = "velocity"\nwave_p = "pulse"'])
def test_no_load_pushes_an_end_whose_motion_is_prescribed(end: str) -> None:
    text = changed('type = "viscous_input"\nwave_p = "pulse"', end)

    (line,) = problems(text)
    assert line.startswith('load[1, blow].side: is "left", whose motion boundary.left prescribes ("')
    assert loads(changed("nodes = 3", 'side = "right"', text)).load[0].side == "right"


@pytest.mark.parametrize(
    ("old", "new", "line"),
    [
        ("nodes = 3", "nodes = 102", "load[1, blow].nodes: is 102, must be at most 101, the nodes of the bar"),
        ("nodes = 3", "nodes = 0", "load[1, blow].nodes: is 0, must be at least 1"),
        ("nodes = 3", 'side = "top"', 'load[1, blow].side: is "top", must be one of "left", "right"'),
        ('nodes = 3\nwave = "pulse"', "nodes = 3", "load[1, blow].wave: is missing, must be a text"),
        (
            'nodes = 3\nwave = "pulse"',
            'nodes = 3\nwave = "push"',
            'load[1, blow].wave: "push" is not a wave of this case; defined: pulse',
        ),
        ("pressure = 12e6\n", "", "load[1, blow].pressure: is missing, must be a number (Pa)"),
        (
            "nodes = 3",
            "force = [1.0, 0.0]",
            "load[1, blow].force: unknown key; allowed: name, pressure, side, nodes, wave",
        ),
        (
            "position = 0.5",
            "position = 1.5",
            "monitor[1, gauge].position: is 1.5, must be at most bar.length, 1 (m)",
        ),
        ("position = 0.5", "position = -0.5", "monitor[1, gauge].position: is -0.5, must be at least 0"),
        (
            "position = 0.5",
            "position = [0.5, 0.0]",
            "monitor[1, gauge].position: is [0.5, 0.0], must be a number no less than 0 (m)",
        ),
        (
            "[run]",
            '[[monitor]]\nname = "gauge"\nposition = 1.0\n[run]',
            'monitor[2].name: "gauge" is taken by monitor[1]',
        ),
        (
            "duration = 5e-4",
            "duration = 5e-4\ncourant = 0.5\ntime_step = 1e-7",
            "run.courant: is not allowed together with time_step",
        ),
        ("duration = 5e-4", "duration = 5e-4\ncourant = 0", "run.courant: is 0, must be greater than 0"),
        (
            "duration = 5e-4",
            "duration = 5e-4\ncourant = 0.5\nsafety = 0.8",
            "run.safety: is for an automatic time step, courant gives it",
        ),
        (
            "duration = 5e-4",
            "duration = 5e-4\ncourant = 274",
            "run.courant: makes a step of 0.001 s, must be at most run.duration, 0.0005 (s)",
        ),
        (
            "duration = 5e-4",
            "duration = 5e-4\ntime_step = 1",
            "run.time_step: is 1, must be at most run.duration, 0.0005 (s)",
        ),
        (
            "snapshots = 3",
            "history_interval = 1.0",
            "output.history_interval: is 1, must be at most run.duration, 0.0005 (s)",
        ),
    ],
)
def test_mistakes_in_loads_monitors_and_times(old: str, new: str, line: str) -> None:
    found = problems(changed(old, new))
    assert len(found) == 1
    assert found[0].startswith(line)


@pytest.mark.parametrize("table", ["[packing]", "[material]", "[motion]", "[static]", "[[hole]]"])
def test_tables_of_disks_are_told_apart_from_unknown_ones(table: str) -> None:
    name = table.strip("[]")

    assert problems(f"{GOOD}{table}\n") == [f"{name}: {NO_PLACE}"]
    assert problems(f"{GOOD}[ouptut]\n")[0].startswith("ouptut: unknown table; allowed: title, bar, method, ")


def test_a_method_alone_makes_it_the_case_of_a_bar() -> None:
    found = problems(f'[method]\ntype = "finite_difference"\n{STARTER[STARTER.index("[packing]") :]}')

    assert found[0].startswith("packing: is not allowed here, as [method] makes this a case of a bar; allowed: ")
    assert any(line.startswith("bar.length: is missing") for line in found)


@pytest.mark.parametrize(
    ("old", "new", "line"),
    [
        (
            "[run]",
            '[[load]]\nname = "blow"\nforce = [1.0, 0.0]\nposition = [1.0, 1.0]\nnodes = 1\n[run]',
            "load[1, blow].nodes: unknown key; allowed: name, force, acceleration, position, region, pressure, hole",
        ),
        ("[run]", "[run]\ncourant = 0.5", "run.courant: unknown key; allowed: duration, time_step, safety"),
        ("position = [50.0, 2.5]", "position = 50.0", "monitor[1, middle].position: is 50.0, must be a list of 2 "),
    ],
)
def test_keys_of_bars_are_refused_in_cases_of_disks(old: str, new: str, line: str) -> None:
    (found,) = problems(changed(old, new, STARTER))
    assert found.startswith(line)


def test_all_mistakes_of_all_tables_are_listed_at_once() -> None:
    text = (
        GOOD.replace("density = 2620.0", "density = -1")
        .replace("horizon = 3", "horizon = -3")
        .replace("nodes = 3", "nodes = 200")  # cannot be judged beside a bar that is invalid itself
        .replace('wave_p = "pulse"', 'wave_p = "pulze"')
        .replace("duration = 5e-4", "duration = 5e-4\ncourant = -1")
    )

    assert [line.split(":")[0] for line in problems(text)] == [
        "bar.density",
        "method.horizon",
        "run.courant",
        "boundary.left.wave_p",
    ]


def test_two_spacings_are_too_few_with_soft_ends() -> None:
    two = changed("spacing = 0.01", "spacing = 0.5")
    assert problems(changed("horizon = 3", "horizon = 1", two)) == [
        "bar.spacing: makes 2 of them in the bar, with soft ends it must be 3 or more"
    ]


def with_bar(*lines: str) -> str:
    """The good case with more keys in [bar]."""
    return GOOD.replace("[method]", "\n".join([*lines, "[method]"]), 1)


def test_a_fracture_energy_makes_cracks_that_open() -> None:
    case = loads(with_bar("fracture_energy = 1000", "strength_per_decade = 5e6", "strength_rates = [2, 20]"))

    assert isinstance(case, BarCase)
    assert case.bar.largest_strength == pytest.approx(15e6, rel=1e-15)
    assert case.bar.characteristic_length == pytest.approx(2620.0 * 2740.0**2 * 1000.0 / 15e6**2, rel=1e-15)
    assert case.bar.fracture == Fracture(1000.0, 5e6, (2.0, 20.0))
    assert case.bar.fracture.opening(10e6) == pytest.approx(2e-4, rel=1e-15)


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        (("fracture_energy = 0",), "bar.fracture_energy: "),
        # 0.2·19.67 GPa·200 J/m²/(10 MPa)², and 2² times less at twice the strength
        (("fracture_energy = 200",), "bar.spacing: is 0.01, must be at most 0.00786796 m, 0.2 EG_f/σ_t² "),
        (
            ("fracture_energy = 600", "strength_per_decade = 10e6", "strength_rates = [1, 10]"),
            "bar.spacing: is 0.01, must be at most 0.00590097 m, 0.2 EG_f/σ_t² at the largest strength",
        ),
        (("fracture_energy = 500", "strength_rates = [1, 10]"), "bar.strength_per_decade: is missing; "),
        (("fracture_energy = 500", "strength_per_decade = 1e6"), "bar.strength_rates: is missing; "),
        (
            ("fracture_energy = 500", "strength_per_decade = 1e6", "strength_rates = [10, 1]"),
            "bar.strength_rates: is [10.0, 1.0], must be two rates above 0, the slower one first",
        ),
        (
            ("fracture_energy = 500", "strength_per_decade = 1e6", "strength_rates = [0, 1]"),
            "bar.strength_rates: is [0.0, 1.0], must be two rates above 0, the slower one first",
        ),
        (("strength_per_decade = 1e6", "strength_rates = [1, 10]"), "bar.strength_per_decade: needs fracture_energy"),
    ],
)
def test_mistakes_with_cracks(lines: tuple[str, ...], said: str) -> None:
    (line,) = problems(with_bar(*lines))
    assert line.startswith(said)


def test_cracks_need_a_strength() -> None:
    (line,) = problems(with_bar("fracture_energy = 500").replace("strength = 10e6\n", ""))
    assert line == "bar.fracture_energy: needs strength or critical_stretch, at which a crack begins"
