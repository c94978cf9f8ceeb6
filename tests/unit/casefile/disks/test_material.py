"""The two ways to give stiffness exclude one another."""

import pytest

from dembound.casefile.disks.material import Material


@pytest.mark.parametrize(
    "keys",
    [
        {"p_wave_speed": 1000.0},
        {"p_wave_speed": 1000.0, "s_wave_speed": 700.0, "match": "assembly", "contact_share": 1.0},
        {"emod": 1e9, "pb_emod": 0.0},
        {"emod": 0.0, "pb_emod": 1e9},
        {"p_wave_speed": 1000.0, "contact_share": 0.0},
        {"emod": 1e9, "pb_emod": 1e9, "s_wave_speed": 700.0},
    ],
)
def test_complete_stiffness_is_accepted(keys: dict[str, float]) -> None:
    material = Material(density=2500.0, **keys)
    assert {key: getattr(material, key) for key in keys} == keys


@pytest.mark.parametrize(
    ("keys", "lines"),
    [
        ({}, ["p_wave_speed: is missing; give either"]),
        ({"emod": 1e9}, ["pb_emod: is missing; emod and pb_emod go together"]),
        ({"pb_emod": 1e9}, ["emod: is missing; emod and pb_emod go together"]),
        (
            {"p_wave_speed": 1e3, "emod": 1e9, "pb_emod": 1e9},
            ["emod: is not allowed together", "pb_emod: is not allowed together"],
        ),
        (
            {"emod": 1e9, "pb_emod": 1e9, "match": "lattice", "contact_share": 0.5},
            ["match: is only allowed together", "contact_share: is only allowed together"],
        ),
        (
            {"p_wave_speed": 1e3, "s_wave_speed": 1e3},
            ["s_wave_speed: is 1000, must be less than p_wave_speed"],
        ),
    ],
)
def test_incomplete_or_doubled_stiffness_is_refused(keys: dict[str, float], lines: list[str]) -> None:
    with pytest.raises(ValueError, match="is ") as caught:
        Material(density=2500.0, **keys)
    found = str(caught.value.errors()[0]["ctx"]["error"]).splitlines()
    assert [line.startswith(start) for line, start in zip(found, lines, strict=True)] == [True] * len(lines)


STIFFNESS = {"emod": 1e9, "pb_emod": 1e9}


@pytest.mark.parametrize(
    "keys",
    [
        {},
        {"pb_ten": 1e6, "pb_coh": 2e6, "pb_fa": 30.0},
        {"locked_in": 5e6, "geometry": "reference", "elastic_start": False},
        {"pb_emod": 0.0},
    ],
)
def test_breakable_bonds_are_accepted(keys: dict[str, float]) -> None:
    material = Material(density=2500.0, law="linearpbond", **(STIFFNESS | keys))
    assert {key: getattr(material, key) for key in keys} == keys


@pytest.mark.parametrize("key", ["locked_in", "geometry", "elastic_start"])
def test_keys_of_the_law_with_history_need_it(key: str) -> None:
    value = {"geometry": "updated", "elastic_start": True}.get(key, 1.0)
    with pytest.raises(ValueError, match=f'{key}: is only allowed with law = "linearpbond"'):
        Material(density=2500.0, **STIFFNESS, **{key: value})


@pytest.mark.parametrize(
    ("keys", "line"),
    [
        ({**STIFFNESS, "pb_fa": 30.0}, "pb_fa: is only allowed together with pb_coh"),
        ({"emod": 1e9, "pb_emod": 0.0, "pb_ten": 1.0}, "pb_ten: is the strength of bonds, but pb_emod = 0 leaves none"),
        (
            {"p_wave_speed": 1e3, "contact_share": 1.0, "pb_coh": 1.0},
            "pb_coh: is the strength of bonds, but contact_share = 1 leaves none",
        ),
    ],
)
def test_strength_without_what_it_needs_is_refused(keys: dict[str, float], line: str) -> None:
    with pytest.raises(ValueError, match=line):
        Material(density=2500.0, law="linearpbond", **keys)
