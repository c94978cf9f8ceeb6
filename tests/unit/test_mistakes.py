"""Usual mistakes in numbers: each has its line before a run, and no shipped case has one of these lines."""

import json
from collections.abc import Iterator
from copy import deepcopy
from pathlib import Path
from typing import Any

import pytest
from scene_tables import ISOTROPIC, lattice
from small_cases import PUSHED, SPALLING, Tables, around, small

from dembound.casefile.unlikely import meaning_of, unlikely
from dembound.check import check
from dembound.errors import CaseError
from dembound.kinds import load, loads
from dembound.meanings import MEANINGS, OF_UNITS
from dembound.running import plan, run_case, warnings_before
from dembound.starting import names, starting_point
from dembound.table import Table

ROOT = Path(__file__).parents[2]

LATTICE: Tables = PUSHED | {
    "packing": lattice(10.0, 5.0, 0.5),
    "material": ISOTROPIC,
    "wave": {"push": {"type": "cosine", "amplitude": 0.05, "period": 0.1}},
    "boundary": {"left": {"type": "viscous_input", "wave_p": "push", "beta_p": 1.0, "beta_s": 1.0}},
    "run": {"duration": 0.2},
}
"""A lattice without unlikely numbers."""

MODULI = {"material": {"density": 2500.0, "emod": 1.25e9, "pb_emod": 1.25e9, "fric": 0.5}}
BREAKING = {"material": LATTICE["material"] | {"law": "linearpbond", "pb_ten": 5e6, "pb_coh": 10e6, "pb_fa": 30.0}}
WEIGHT = {"static": {"boundary": {"bottom": {"type": "fixed"}}}}

BAR: Tables = SPALLING | {
    "bar": {"length": 1.0, "spacing": 0.01, "density": 2500.0, "wave_speed": 4000.0, "strength": 8e6},
    "method": {"type": "finite_difference"},
    "wave": {"hit": {"type": "triangle", "amplitude": 1.0, "rise": 1.5e-4, "fall": 1.5e-4}},
    "load": [{"name": "hit", "pressure": 12e6, "wave": "hit"}],
    "run": {"duration": 1.5e-3},
}
"""A bar without unlikely numbers."""

STRIKER: Tables = {
    "bar": {"spacing": 0.01, "density": 7800.0, "wave_speed": 5000.0, "diameter": 0.02}
    | {"range": [{"name": "striker", "length": 0.2, "velocity": 10.0}, {"name": "bar", "length": 1.0}]},
    "method": {"type": "finite_difference"},
    "monitor": [{"name": "gauge", "position": 0.5}],
    "run": {"duration": 3e-4, "courant": 1.0},
}
STRIKER["bar"]["range"][1] |= {"interface": "contact", "gap": 1e-4}


def changed(tables: Tables, changes: dict[str, Any]) -> Tables:
    """A copy of tables with values at dotted keys changed; a number in a key is a place in a list."""
    copy = deepcopy(tables)
    for dotted, value in changes.items():
        *path, last = dotted.split(".")
        table: Any = copy
        for key in path:
            table = table[int(key)] if isinstance(table, list) else table.setdefault(key, {})
        table[int(last) if isinstance(table, list) else last] = value
    return copy


def said(tables: Tables) -> Iterator[str]:
    """The lines about a case before its run: what makes it impossible, or what is unlikely, then all warnings."""
    try:
        case = small(tables)
        yield from (lines := unlikely(case))
        yield from (line for line in warnings_before(plan(case)) if line not in lines)
    except CaseError as error:
        yield from error.problems


def down(*acceleration: float) -> list[dict[str, Any]]:
    return [{"name": "weight", "acceleration": list(acceleration)}]


DISKS = [
    ("material.density", 3.0,
     "is 3 kg/m³, where soils, rocks and metals have 100 to 23,000; likely in g/cm³ or t/m³: write 3000"),
    ("material.density", 26.5,
     "is 26.5 kg/m³, where soils, rocks and metals have 100 to 23,000; likely in kN/m³, a weight: write 2701"),
    ("material.p_wave_speed", 3.0,
     "is 3 m/s, where soils, rocks and metals have 10 to 19,000; likely in km/s: write 3000"),
    ("material.fric", 30.0,
     "is 30, where surfaces have 0.001 to 2; likely the friction angle in degrees: write 0.5774"),
    ("material.kratio", 0.4, "likely shear over normal stiffness: write 2.5"),
    ("material.damp", 0.7,
     "is 0.7 while waves run: of a burst 94 % are left after one wavelength at 0.1, 49 % at 0.3, 0.2 % at 0.7"),
    ("packing", {"pattern": "A", "size": [10_000.0, 5000.0], "radius": 250.0},
     "packing.radius: is 250 m, where particles have"),
    ("wave.push.start", 200.0, "wave.push: reaches 0 % of its peak, which comes at 200.05 s, within the run of 0.2 s"),
    ("run.duration", 200.0, "the run of 200 s is 2,000 times as long; are all times in s and lengths in m?"),
    ("output.history_interval", 0.05,
     "is 0.05 s, 0.5 of the period of wave.push, 0.1 s; likely in ms, or write 0.005 or less"),
    ("boundary.right", {"type": "viscoelastic", "distance": 20.0, "young_modulus": 5.0},
     "boundary.right.young_modulus: is 5 Pa, where soils, rocks and metals have 10000 to 2e+12; likely in GPa:"),
    ("boundary.right", {"type": "viscoelastic", "distance": 20.0, "alpha_n": 100.0},
     "boundary.right.alpha_n: is 100, where springs"),
    ("material.pb_ten", 5e6, 'material.pb_ten: is only allowed with law = "linearpbond" or output.load_factor'),
]  # fmt: skip

ANGLED = LATTICE | {
    "packing": lattice(10.0, 10.0, 1.0),
    "boundary": around("outside"),
    "incident": {"type": "sv", "angle": 20.0, "wave": "push"},
    "outside": {"element": 5.0, "margin": 1, "layers": 2},
}

OTHERS = [
    (LATTICE | MODULI, "material.emod", 50.0, "likely in GPa: write 5e+10 or in MPa: write 5e+07"),
    (LATTICE | BREAKING, "material.pb_ten", 5.0,
     "is 5 Pa, where soils, rocks and metals have 1000 to 2e+10; likely in MPa: write 5e+06"),
    (LATTICE | BREAKING, "material.pb_fa", 0.5236,
     "likely in radians: write 30 or the friction coefficient tan φ: write 27.64"),
    (LATTICE | BREAKING, "wave.push.amplitude", 200.0, "rock and soil break at some 0.3 %, are the units right?"),
    (LATTICE | WEIGHT, "load", down(0.0, 9.81),
     "load.weight.acceleration: is 9.81 m/s² upwards; likely gravity: write [0, -9.81]"),
    (LATTICE, "load", [{**down(0.0, -9.81)[0], "wave": "push"}],
     'load.weight.acceleration: is gravity times wave "push"; a weight that stays has no wave'),
    (LATTICE, "wave.push.amplitude", 20.0, "where the strongest earthquakes recorded reach 3 to 4 m/s; is it in m/s?"),
    (LATTICE | BREAKING, "material.pb_coh", 1e4, "times material.pb_ten, more than a factor of 100 apart"),
    (ANGLED, "incident.angle", 0.349,
     "is 0.349 degrees, where directions have 1.6 to 360; likely in radians: write 20"),
    (ANGLED, "hole", [{"name": "h", "type": "ellipse", "centre": [5.0, 5.0], "semi_axes": [2.0, 1.0], "angle": 0.785}],
     "hole.h.angle: is 0.785 degrees, where directions have 1.6 to 360; likely in radians: write 44.98"),
    (LATTICE, "static.stress", [5e6, 10e6, 0.0],
     "static.stress: is a tension, 5 MPa along x and 10 MPa along y; likely compression, which is"),
    (LATTICE, "static.stress", [-5.0, -10.0, 0.0],
     "static.stress: is -5 Pa, where soils and rocks carry 100 to 4e+11; likely in MPa: write -5e+06"),
    (BAR, "bar.strength", 8.0, "likely in MPa: write 8e+06 or in kPa: write 8000"),
    (BAR, "bar.diameter", 70.0, "is 70 m, where bars have 1e-05 to 5; likely in mm: write 0.07 or in cm: write 0.7"),
    (BAR, "bar.attenuation", 52.0, "bar.attenuation: leaves"),
    (BAR, "load.0.pressure", 12.0, "% of bar.strength, 8 MPa: Pa and MPa?"),
    (changed(BAR, {"bar.strength": 1e5, "load.0.pressure": 1e5}), "bar.fracture_energy", 0.1,
     "likely in N/mm or kJ/m²: write 100"),
    (STRIKER, "bar.range.0.velocity", 10_000.0,
     "bar.range.striker.velocity: particles move at up to 1e+04 m/s, waves run at"),
    (STRIKER, "bar.range.1.gap", 0.5, "where gaps of bars have 1e-09 to 0.1; likely in mm: write 0.0005"),
]  # fmt: skip


@pytest.mark.parametrize(
    ("tables", "key", "value", "line"),
    [*((LATTICE, *each) for each in DISKS), *OTHERS],
    ids=lambda each: str(each)[:50] if isinstance(each, str | float) else "",
)
def test_a_usual_mistake_has_its_line(tables: Tables, key: str, value: object, line: str) -> None:
    assert "\n" not in next(each for each in said(changed(tables, {key: value})) if line in each)


def test_what_is_usual_has_none() -> None:
    for tables in (
        *(LATTICE, LATTICE | MODULI, LATTICE | BREAKING, BAR, STRIKER),
        changed(LATTICE | MODULI, {"material.density": 20_000.0}),  # tungsten
        changed(LATTICE | WEIGHT, {"load": down(0.0, -9.81)}),
        changed(LATTICE | WEIGHT, {"load": down(0.0, -1.62)}),  # on the moon
        changed(ANGLED, {"incident.angle": 0.5}),
        changed(ANGLED, {"incident.angle": -35.0, "wave.push.amplitude": 0.01}),  # it is not multiplied by its wave
    ):
        assert not [line for line in said(tables) if "likely" in line or "units" in line]


def test_a_load_is_compared_with_a_strength_or_has_a_likely_pressure() -> None:
    bar = {key: value for key, value in BAR["bar"].items() if key != "strength"}
    found = unlikely(small(changed(BAR | {"bar": bar}, {"load.0.pressure": 12.0})))
    assert found == [
        "load.hit.pressure: is 12 Pa, where loads have 100 to 4e+11; likely in MPa: write 1.2e+07 or in GPa: "
        "write 1.2e+10 or in kPa: write 1.2e+04"
    ]
    # 1 Pa is that of a wave that contains the pressures
    assert unlikely(small(changed(BAR | {"bar": bar}, {"load.0.pressure": 1.0}))) == []


def test_damping_is_for_bodies_that_no_wave_runs_through() -> None:
    still = LATTICE | {"boundary": {"bottom": {"type": "fixed"}}, "load": down(0.0, -9.81)}
    assert unlikely(small(changed(still, {"material.damp": 0.7}))) == []


def test_check_and_run_say_the_same(tmp_path) -> None:
    case = small(changed(LATTICE, {"material.density": 3.0, "run.duration": 1e-3, "output.pictures": False}))
    said_by_run = json.loads((run_case(case, tmp_path) / "summary.json").read_text(encoding="utf-8"))["warnings"]

    assert [each.split(":")[0] for each in check(case, tmp_path)[1]][:1] == ["material.density"]
    assert set(check(case, tmp_path)[1]) <= set(said_by_run)  # which may also say what is known afterwards


def is_number(schema: Any, kind: str) -> bool:
    """Whether a JSON schema has a number of a kind somewhere."""
    if isinstance(schema, dict):
        return schema.get("type") == kind or any(
            is_number(inner, kind) for key, inner in schema.items() if key not in ("$ref", "additionalProperties")
        )
    return isinstance(schema, list) and any(is_number(inner, kind) for inner in schema)


def test_every_number_of_a_table_has_a_meaning_and_every_count_a_largest_value() -> None:
    waiting, seen = [Table], set()
    while waiting:
        waiting += (table := waiting.pop()).__subclasses__()
        seen.add(table)
    tables = [each for each in seen if each.__module__.startswith("dembound.") and not each.__name__.startswith("_")]
    assert len(tables) > 40
    for table, name in [(each, name) for each in tables for name in each.model_fields]:
        schema = table.model_json_schema()["properties"][table.key_of(name)]
        if is_number(schema, "number") or is_number(schema, "integer"):
            means, _ = meaning_of(table, name)
            assert means in MEANINGS, f"{table.__name__}.{name}: give it a meaning (means=…), with likely sizes or free"
        if is_number(schema, "integer"):
            assert '"maximum": ' in str(schema).replace("'", '"'), f"{table.__name__}.{name}: give it a largest number"


def test_every_meaning_has_a_reason_and_limits_that_hold_its_usual_sizes() -> None:
    for name, meaning in MEANINGS.items():
        assert meaning.why, name
        if not meaning.is_free:
            assert 0.0 < meaning.low < meaning.high
            assert meaning.whose
            low, high = max(meaning.usual[0], meaning.low), min(meaning.usual[1], meaning.high)
            assert low < high
            for size in (meaning.low, meaning.high, low, high, -high, 0.0, *meaning.spared):
                assert meaning.doubt(size, "1") is None, name
            assert meaning.doubt(0.999 * meaning.low, "1")
            assert meaning.doubt(1.001 * meaning.high, "1")
    assert set(OF_UNITS.values()) <= set(MEANINGS)


def test_no_shipped_case_is_unlikely() -> None:
    for case in [*map(load, (ROOT / "cases").rglob("*.toml")), *(loads(starting_point(name)) for name in names())]:
        assert unlikely(case) == []
