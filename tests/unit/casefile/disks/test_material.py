"""The two ways to give stiffness exclude one another."""

import pytest

from dembound.casefile.disks.material import Material

STIFFNESS = {"emod": 1e9, "pb_emod": 1e9}
SPEED = {"p_wave_speed": 1e3}


@pytest.mark.parametrize(
    "keys",
    [
        SPEED | {"s_wave_speed": 700.0, "match": "assembly", "contact_share": 1.0},
        SPEED | {"contact_share": 0.0},
        {"emod": 1e9, "pb_emod": 0.0},
        {"emod": 0.0, "pb_emod": 1e9},
        STIFFNESS | {"s_wave_speed": 700.0},
        {"s_wave_speed": 700.0, "contact_share": 0.2},
        STIFFNESS | {"law": "linearpbond"},
        STIFFNESS | {"law": "linearpbond", "pb_ten": 1e6, "pb_coh": 2e6, "pb_fa": 30.0},
        STIFFNESS | {"law": "linearpbond", "locked_in": 5e6, "geometry": "reference", "elastic_start": False},
        STIFFNESS | {"law": "linearpbond", "pb_emod": 0.0},
        STIFFNESS | {"law": "linearpbond", "fric": 0.5, "dp_nratio": 0.2, "dp_sratio": 0.2, "elastic_start": False},
    ],
)
def test_complete_stiffness_and_bonds_are_accepted(keys: dict[str, float]) -> None:
    material = Material(density=2500.0, **keys)
    assert {key: getattr(material, key) for key in keys} == keys


BONDED = {"law": "linearpbond", **STIFFNESS}


@pytest.mark.parametrize(
    ("keys", "lines"),
    [
        ({}, ["p_wave_speed: is missing; give either"]),
        ({"emod": 1e9}, ["pb_emod: is missing; emod and pb_emod go together"]),
        ({"pb_emod": 1e9}, ["emod: is missing; emod and pb_emod go together"]),
        (SPEED | STIFFNESS, ["emod: is not allowed together", "pb_emod: is not allowed together"]),
        (
            STIFFNESS | {"match": "lattice", "contact_share": 0.5},
            ["match: is only allowed together", "contact_share: is only allowed together"],
        ),
        ({"s_wave_speed": 1e3, "match": "lattice"}, ["match: is only allowed together with p_wave_speed"]),
        ({"s_wave_speed": 1e3, "emod": 1e9}, ["pb_emod: is missing; emod and pb_emod go together"]),
        (SPEED | {"s_wave_speed": 1e3}, ["s_wave_speed: is 1000, must be less than p_wave_speed"]),
        (STIFFNESS | {"locked_in": 1.0}, ['locked_in: is only allowed with law = "linearpbond"']),
        (STIFFNESS | {"geometry": "updated"}, ['geometry: is only allowed with law = "linearpbond"']),
        (STIFFNESS | {"elastic_start": True}, ['elastic_start: is only allowed with law = "linearpbond"']),
        (STIFFNESS | {"dp_nratio": 0.2}, ['dp_nratio: is only allowed with law = "linearpbond"']),
        (BONDED | {"dp_nratio": 0.2, "elastic_start": True}, ["elastic_start: is true, but dashpots (dp_nratio) act"]),
        (BONDED | {"dp_sratio": 0.2}, ["dp_sratio: is of the shear of contacts, but fric = 0 leaves them none"]),
        (
            BONDED | {"emod": 0.0, "dp_nratio": 0.2},
            ["dp_nratio: is of contacts, but emod = 0 leaves them no stiffness"],
        ),
        (
            BONDED | {"pb_scatter": {"type": "weibull", "shape": 5.0}},
            ["pb_scatter: is of the strengths of bonds, but there are none; give pb_ten or pb_coh"],
        ),
        (BONDED | {"pb_fa": 30.0}, ["pb_fa: is only allowed together with pb_coh"]),
        (BONDED | {"pb_emod": 0.0, "pb_ten": 1.0}, ["pb_ten: is the strength of bonds, but pb_emod = 0 leaves none"]),
        (
            SPEED | {"law": "linearpbond", "contact_share": 1.0, "pb_coh": 1.0},
            ["pb_coh: is the strength of bonds, but contact_share = 1 leaves none"],
        ),
    ],
)
def test_what_is_incomplete_or_doubled_is_refused(keys: dict[str, float], lines: list[str]) -> None:
    with pytest.raises(ValueError, match="is ") as caught:
        Material(density=2500.0, **keys)
    found = str(caught.value.errors()[0]["ctx"]["error"]).splitlines()
    assert [line.startswith(start) for line, start in zip(found, lines, strict=True)] == [True] * len(lines)
