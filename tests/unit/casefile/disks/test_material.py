"""The two ways to give stiffness exclude one another."""

import pytest

from dembound.casefile.disks.material import Material
from dembound.casefile.disks.targets import PlaneModuli

STIFFNESS = {"emod": 1e9, "pb_emod": 1e9}
SPEED = {"p_wave_speed": 1e3}


BONDED = {"law": "linearpbond", **STIFFNESS}


@pytest.mark.parametrize(
    ("keys", "lines"),
    [
        ({}, ["p_wave_speed: is missing; give either"]),
        ({"pb_emod": 1e9}, ["emod: is missing; emod and pb_emod go together"]),
        (SPEED | STIFFNESS, ["emod: is not allowed together", "pb_emod: is not allowed together"]),
        (SPEED | {"s_wave_speed": 1e3}, ["s_wave_speed: is 1000, must be less than p_wave_speed"]),
        (
            SPEED | STIFFNESS | {"poisson": 0.2, "kratio": 1.0, "match": "lattice"},
            [
                "young: is missing; young and poisson go together",
                "p_wave_speed: is not allowed together with young and poisson",
                "emod: is not allowed together",
                "pb_emod: is not allowed together",
                "kratio: is not allowed together with young and poisson, from which it is found",
                "match: is only allowed together with p_wave_speed alone",
            ],
        ),
        ({"young": 6e10, "poisson": 0.5}, ["poisson: is 0.5, must be less than 0.5"]),
        (SPEED | {"s_wave_speed": 700.0, "contact_share": 1.0}, ["contact_share: is 1, so without friction nothing"]),
        (
            SPEED | {"along": "x", "plane": "stress"},
            ["plane: is only allowed together", "along: is only allowed together"],
        ),
        (STIFFNESS | {"locked_in": 1.0}, ['locked_in: is only allowed with law = "linearpbond"']),
        (BONDED | {"dp_nratio": 0.2, "elastic_start": True}, ["elastic_start: is true, but dashpots (dp_nratio) act"]),
        (BONDED | {"dp_sratio": 0.2}, ["dp_sratio: is of the shear of contacts, but fric = 0 leaves them none"]),
        (
            BONDED | {"pb_scatter": {"type": "weibull", "shape": 5.0}},
            ["pb_scatter: is of the strengths of bonds, but there are none; give pb_ten or pb_coh"],
        ),
        (STIFFNESS | {"hz_shear": 1e9}, ['hz_shear: is only allowed with law = "hertz"']),
        ({"law": "hertz", "hz_shear": 1e9}, ['hz_poiss: is missing; law = "hertz" needs hz_shear and hz_poiss']),
        (
            {"law": "hertz", "hz_shear": 1e9, "hz_poiss": 0.2, "emod": 1e9, "pb_ten": 1e6, "dp_sratio": 0.1},
            [
                'emod: is not allowed with law = "hertz", whose stiffness follows from hz_shear and hz_poiss',
                'pb_ten: is not allowed with law = "hertz", which does not use it',
                "dp_sratio: is of the shear of contacts, but fric = 0 leaves them none",
            ],
        ),
        (BONDED | {"pb_fa": 30.0}, ["pb_fa: is only allowed together with pb_coh"]),
    ],
)
def test_what_is_incomplete_or_doubled_is_refused(keys: dict[str, float], lines: list[str]) -> None:
    with pytest.raises(ValueError, match="is ") as caught:
        Material(density=2500.0, **keys)
    found = str(caught.value.errors()[0]["ctx"]["error"]).splitlines()
    assert [line.startswith(start) for line, start in zip(found, lines, strict=True)] == [True] * len(lines)


@pytest.mark.parametrize("plane", ["strain", "stress"])
def test_targets_are_the_moduli_of_the_body(plane: str) -> None:
    # a solid of λ = 1, μ = 2: in plane strain C11 = 5 and C12 = 1, and as a sheet C12 = 2λμ/(λ + 2μ) = 0.8
    c12 = {"strain": 1.0, "stress": 0.8}[plane]
    body = PlaneModuli(2.0 + c12, 2.0)
    young, poisson, bulk = 2.0 * 7.0 / 3.0, 1.0 / 6.0, {"strain": 1.0 + 4.0 / 3.0, "stress": 2.8}[plane]
    assert (body.young(plane), body.poisson(plane), body.compression(plane)) == pytest.approx((young, poisson, bulk))
    for keys in ({"young": young, "poisson": poisson, "plane": plane}, {"bulk": bulk, "shear": 2.0, "plane": plane}):
        assert Material(density=2.0, **keys).target.moduli == pytest.approx(body)
    speeds = {"p_wave_speed": ((4.0 + c12) / 2.0) ** 0.5, "s_wave_speed": 1.0}
    assert Material(density=2.0, **speeds).target.moduli == pytest.approx(body)
