"""Names of other codes get advice on the key to use, and only similar spellings a guess."""

import re
from pathlib import Path

import pytest
import tomli_w
from small_cases import PUSHED, SPALLING, problems_of, rows

from dembound.casefile.foreign import BY_NAME, NAMES, TYPE_OF
from dembound.casefile.json_schema import json_schema
from dembound.kinds import SCHEMAS

DOCS = Path(__file__).parents[3] / "docs"
DISKS = PUSHED | {"static": {"stress": [-1e6, -1e6, 0.0]}}


def about(tables: dict, path: str, key: str) -> str:
    """The line about a foreign key in one of the tables."""
    changed = {name: dict(table) if isinstance(table, dict) else table for name, table in tables.items()}
    table = changed if not path else changed.setdefault(path, {})
    table[key] = 1.0
    (line,) = problems_of(tomli_w.dumps(changed))
    assert line.startswith(f"{path}.{key}: " if path else f"{key}: ")
    return line.partition(": ")[2]


SAID = """
material | kn | write emod, Pa: the normal stiffness of a contact is k_n = emod
material | pb_ks | write pb_kratio = pb_kn/pb_ks
material | pb_mcf | there is none: bonds break as with pb_mcf = 1
material | E | write young and poisson, of the body, or emod and pb_emod
static | damping | write damp
packing | radius_max | write radius: disks of pattern "A" are equal, those of "B" and "C" also have radius_ratio
bar | young | write youngs_modulus, Pa
run | mass_scaling | there is none: it would change the speed of waves
static | in_situ | write stress = [sxx, syy, sxy]
 | gravity | give [[load]] an acceleration
 | walls | [boundary.bottom] and other sides have a type
bar | dx | write spacing, m
"""


@pytest.mark.parametrize(("path", "key", "said"), rows(SAID))
def test_a_name_of_another_code_is_answered_by_what_to_write(path: str, key: str, said: str) -> None:
    line = about(SPALLING if path == "bar" else DISKS, path, key)
    assert line.startswith(f"unknown {'key' if path else 'table'}; {said}")
    assert "did you mean" not in line


def test_a_name_that_other_codes_have_in_several_tables_is_answered_by_the_keys_of_each() -> None:
    side = PUSHED | {"boundary": {"right": {"type": "viscous", "stress": 1.0}}}
    hole = PUSHED | {"hole": [{"name": "h", "type": "circle", "centre": [5.0, 1.0], "radius": 1.0, "diameter": 2.0}]}
    wave = {"type": "ricker", "amplitude": 1.0, "frequency": 5.0, "stress": 1.0}
    for tables, said in (
        (side, "give wave_p or wave_s a wave of the incident velocity"),
        (hole, "write radius, m"),
        (PUSHED | {"wave": PUSHED["wave"] | {"w": wave}}, "write amplitude, m/s"),
        (SPALLING | {"quiet": {}}, "each end has a type"),
        (SPALLING | {"walls": {}}, "allowed: title, bar"),
    ):
        assert any(f"; {said}" in line for line in problems_of(tomli_w.dumps(tables))), said


def test_only_a_near_key_is_guessed() -> None:
    for key in ("stiffnes_of_all", "colour", "kz", "dampened", "pbx"):
        line = about(DISKS, "material", key)
        assert line.startswith("unknown key; allowed: density, ")
        assert "did you mean" not in line
    near = {"densty": "density", "p_wavespeed": "p_wave_speed", "pb_tenn": "pb_ten", "kratoi": "kratio"}
    for key, meant in near.items():
        assert about(DISKS, "material", key).endswith(f"(did you mean {meant}?)")


def _keys() -> set[str]:
    """All keys of all tables, and all names of types."""
    found: set[str] = set()
    waiting = [json_schema(SCHEMAS)]
    while waiting:
        each = waiting.pop()
        if isinstance(each, dict):
            found |= set(each.get("properties", {}))
            found |= {str(each["const"])} if "const" in each else set()
            found |= {str(name) for name in each.get("enum", ())}
            waiting += each.values()
        elif isinstance(each, list):
            waiting += each
    return found


def test_every_advice_names_keys_and_types_that_there_are() -> None:
    known = _keys()
    for advice in NAMES.values():
        for key, text in advice:
            assert key == "" or key in known
            assert text
            for named in re.findall(r"\bwrite (\w+)", text):
                assert named in known, text
            for page in re.findall(r"see docs: (\S+)", text):
                assert (DOCS / f"{page}.md").is_file()
    assert set(TYPE_OF.values()) <= known
    assert len(BY_NAME) == sum(map(len, NAMES))  # no name has two answers


def test_a_type_of_another_code_is_answered_by_the_type_here() -> None:
    for side, said in (
        ("quiet", '(here "viscous")'),
        ("PML", '(here "outside")'),
        ("viscos", "(did you mean viscous?)"),
        ("soft", '"'),
    ):
        (line,) = problems_of(tomli_w.dumps(PUSHED | {"boundary": {"right": {"type": side}}}))
        assert line.startswith(f'boundary.right.type: is "{side}", must be one of ')
        assert line.endswith(said)
