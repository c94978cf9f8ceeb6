"""Materials, layers and damping: what excludes what, what layers take from [material], where they end."""

import tomllib

import pytest
from small_cases import BODY, around, problems_in, problems_of, rows

from dembound.casefile.disks.material import Material
from dembound.casefile.disks.targets import PlaneModuli
from dembound.disks.surroundings.frequencies import BAND, band_of, mechanisms_of
from dembound.errors import CaseError
from dembound.kinds import loads

STIFFNESS = {"emod": 1e9, "pb_emod": 1e9}
SPEED = {"p_wave_speed": 1e3}
BONDED = {"law": "linearpbond", **STIFFNESS}
BOTH = ["emod: is not allowed together", "pb_emod: is not allowed together"]
ALL_AT_ONCE = [
    "young: is missing; young and poisson go together",
    "p_wave_speed: is not allowed together with young and poisson",
    *BOTH,
    "kratio: is not allowed together with young and poisson, from which it is found",
    "match: is only allowed together with p_wave_speed alone",
]
HERTZ = {"law": "hertz", "hz_shear": 1e9, "hz_poiss": 0.2}
SCATTER = {"pb_scatter": {"type": "weibull", "shape": 5.0}}


@pytest.mark.parametrize(
    ("keys", "lines"),
    [
        ({}, ["p_wave_speed: is missing; give either"]),
        ({"pb_emod": 1e9}, ["emod: is missing; emod and pb_emod go together"]),
        (SPEED | STIFFNESS, BOTH),
        (SPEED | {"s_wave_speed": 1e3}, ["s_wave_speed: is 1000, must be less than p_wave_speed"]),
        (SPEED | STIFFNESS | {"poisson": 0.2, "kratio": 1.0, "match": "lattice"}, ALL_AT_ONCE),
        ({"young": 6e10, "poisson": 0.5}, ["poisson: is 0.5, must be less than 0.5"]),
        (SPEED | {"s_wave_speed": 700.0, "contact_share": 1.0}, ["contact_share: is 1, so without friction nothing"]),
        (SPEED | {"along": "x", "plane": "stress"}, [f"{key}: is only allowed together" for key in ("plane", "along")]),
        (STIFFNESS | {"locked_in": 1.0}, ['locked_in: is only allowed with law = "linearpbond"']),
        (BONDED | {"dp_nratio": 0.2, "elastic_start": True}, ["elastic_start: is true, but dashpots (dp_nratio) act"]),
        (BONDED | {"dp_on": "all"}, ["dp_on: is of dashpots of contacts, but there are none; give dp_nratio"]),
        (BONDED | {"rr_fric": 0.4}, ["rr_fric: is of contacts with a shear stiffness, but fric = 0 leaves them none"]),
        (BONDED | {"pb_mcf": 0.5}, ["pb_mcf: is of the stress that pb_ten limits; give pb_ten"]),
        (BONDED | {"dp_sratio": 0.2}, ["dp_sratio: is of the shear of contacts, but fric = 0 leaves them none"]),
        (BONDED | SCATTER, ["pb_scatter: is of the strengths of bonds, but there are none; give pb_ten or pb_coh"]),
        (STIFFNESS | {"hz_shear": 1e9}, ['hz_shear: is only allowed with law = "hertz"']),
        ({"law": "hertz", "hz_shear": 1e9}, ['hz_poiss: is missing; law = "hertz" needs hz_shear and hz_poiss']),
        (
            HERTZ | {"emod": 1e9, "pb_ten": 1e6, "dp_sratio": 0.1},
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


SOIL = """\
[[layer]]
name = "clay"
thickness = 1.5
s_wave_speed = 200.0

[[layer]]
bottom = 2.0
density = 2000.0
kratio = 2.0

[[layer]]
name = "rock"
emod = 1e9
pb_emod = 2e9
"""
"""Three layers of `BODY`, whose surface is at 5 m and whose disks have a diameter of 0.5 m."""


def test_a_layer_takes_from_the_material_what_it_does_not_give() -> None:
    shared = BODY.replace("p_wave_speed = 1000.0", 'p_wave_speed = 1000.0\nmatch = "assembly"\ncontact_share = 0.3')
    case = loads(shared + SOIL)
    clay, sand, rock = case.materials
    assert clay.given() == {"density": 2500.0, "s_wave_speed": 200.0, "contact_share": 0.3}
    assert sand.given() == case.material.given() | {"density": 2000.0, "kratio": 2.0}
    assert rock.given() == {"density": 2500.0, "emod": 1e9, "pb_emod": 2e9}
    assert (case.layer_planes, case.layer_names) == ((3.5, 2.0), ("clay", "2", "rock"))


def test_a_layer_with_targets_takes_no_stiffness_from_the_material() -> None:
    """Nor ratios of stiffness, which follow from targets; targets of [material] are left out in the same way."""
    moduli, targets = "emod = 1e9\npb_emod = 1e9\n", 'young = 5e9\npoisson = 0.3\nalong = "y"\n'
    for own, others in ((targets, "p_wave_speed = 1000.0\nkratio = 2.0\n"), (moduli, targets)):
        text = BODY.replace("p_wave_speed = 1000.0", others) + SOIL.replace("s_wave_speed = 200.0", own)
        found = loads(text.replace("kratio = 2.0\n\n", "\n")).materials[0].given()
        assert found == {"density": 2500.0, **tomllib.loads(own)}


MISTAKES = r"""
thickness = 1.5 | thickness = 1.5\nbottom = 3.5 | layer[1, clay].bottom: is not allowed together with thickness
thickness = 1.5 | thickness = 0.99 | layer[1, clay].thickness: is 0.99, must be at least 1 (m): the layer begins at 5 m
thickness = 1.5 |  | layer[1, clay].thickness: is missing; only the last layer may go on below
bottom = 2.0 | bottom = 3.0 | layer[2].bottom: is 3, must be at most 2.5 (m): the layer begins at 3.5 m
emod = 1e9 | emod = 1e9\nbottom = 0.5 | layer[3, rock].bottom: ends at 0.5 m, above the bottom of the ground at 0 m
"rock" | "2" | layer[3].name: "2" is taken by layer[2]
emod = 1e9 | kratio = 3.0 | layer[3, rock].emod: is missing; emod and pb_emod go together
kratio = 2.0 | pb_ten = 1e6 | layer[2].pb_ten: is only allowed with law = "linearpbond" or output.load_factor
"""


@pytest.mark.parametrize(("old", "new", "line"), rows(MISTAKES))
def test_each_mistake_has_one_line_at_its_place(old: str, new: str, line: str) -> None:
    (found,) = problems_of(BODY + SOIL.replace(old, new))
    assert found.startswith(line)


def test_the_material_needs_nothing_that_every_layer_gives() -> None:
    bare = BODY.replace("density = 2500.0\n", "").replace("p_wave_speed = 1000.0\n", "")
    full = SOIL.replace("density = 2000.0\n", "").replace("kratio = 2.0", "p_wave_speed = 800.0")
    full = full.replace("[[layer]]", "[[layer]]\ndensity = 1900.0")
    assert [each.density for each in loads(bare + full).materials] == [1900.0] * 3
    said = "is missing in the layer and in [material]"
    speed = f"layer[2].p_wave_speed: {said}; give it a wave speed, targets or moduli"
    assert problems_of(bare + full.replace("p_wave_speed = 800.0", "")) == [speed]
    assert problems_of(bare + full.replace("density = 1900.0\n", "", 1)) == [f"layer[1, clay].density: {said}"]


def test_what_layers_do_not_go_with_is_refused() -> None:
    sides = "".join(f'[boundary.{side}]\ntype = "periodic"\n' for side in ("bottom", "top"))
    random = BODY.replace('pattern = "A"', 'pattern = "B"\nbrick = [10.0, 5.0]\nradius_ratio = 1.5')
    soft = SOIL.replace("emod = 1e9", "emod = 0.0", 1)
    for text, said in (
        (BODY + SOIL + sides, 'layer: boundary.bottom is "periodic"'),
        (random + soft, "layer[3, rock].emod: is 0, but contacts hold pattern B under stress"),
    ):
        (line,) = problems_of(text)
        assert line.startswith(said)
    beyond = "".join(f'[boundary.{side}]\ntype = "outside"\n' for side in ("left", "right", "bottom"))
    wave = '[wave.w]\ntype = "constant"\namplitude = 1.0\n[incident]\ntype = "sv"\nwave = "w"\nangle = 20.0\n'
    assert problems_of(BODY + SOIL + beyond + wave) == []


Q = {"material.quality_factor": 20.0}
RAYLEIGH = {"damping.type": "rayleigh"}
OUTSIDE = {"boundary.right": {"type": "outside"}, "motion.held": []}
BREAKS = {"material.law": "linearpbond", "material.fric": 0.5}


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        ({"damping.band": [1.0, 10.0]}, "damping: is of no use without material.quality_factor"),
        (Q | {"damping.band": [10.0, 1.0]}, r"damping.band: is \[10, 1\], must be two frequencies above 0"),
        (Q | RAYLEIGH | {"damping.mechanisms": 3}, 'damping.mechanisms: is only allowed with type = "quality"'),
        (Q | RAYLEIGH | OUTSIDE, 'damping.type: is "rayleigh", which ground beyond boundary.right cannot have; take'),
        (Q | {"material.damp": 0.1}, "quality_factor: is not allowed together with damp"),
        (Q | BREAKS | RAYLEIGH, 'damping.type: is "rayleigh", which ground under material.law = "linearpbond" cannot'),
        (Q | BREAKS | {"material.contact_share": 1.0}, "quality_factor: is of bonds .* contact_share = 1 leaves none"),
        (
            Q | BREAKS | {"material.elastic_start": True},
            "elastic_start: is true, but quality_factor damps bonds from the start",
        ),
    ],
)
def test_each_mistake_in_damping_names_what_works(bar, changes: dict, line: str) -> None:
    with pytest.raises(CaseError, match=line):
        bar(changes)


def test_a_layer_may_be_damped_alone_and_waves_at_an_angle_are_refused(bar) -> None:
    grains = {"pattern": "A", "radius": 0.25, "size": [8.0, 8.0]}
    layers = {"packing": grains, "layer": [{"thickness": 4.0, "quality_factor": 20.0}, {}], "damping.mechanisms": 2}
    assert bar(layers).is_damped

    def under(angle: float) -> dict:
        wave = {"type": "sv", "angle": angle, "wave": "pulse"}
        return {"boundary": around("outside", "left", "right", "bottom", "top"), "incident": wave, "motion.held": []}

    needs = "incident: needs one quality_"
    for angle, said in ((10.0, "incident.angle: is 10, must be 0 in damped ground"), (0.0, needs)):
        assert [line for line in problems_in(lambda angle=angle: bar(layers | under(angle))) if line.startswith(said)]
    bar(Q | under(0.0))


def test_the_band_is_that_of_the_waves(bar) -> None:
    low, high = band_of(bar())
    assert high / low == pytest.approx(BAND[1] / BAND[0], rel=5e-3)  # three digits
    slower = bar({"wave.pulse.period": 2.0 * bar().wave["pulse"].period})
    assert band_of(slower)[1] == pytest.approx(0.5 * high, rel=0.01)
    assert band_of(bar({"boundary": {}, "wave": {}, "monitor": []})) == BAND
    # speeds hold at its middle unless a frequency is given
    for changes, frequency in (({}, 3.16), ({"damping.frequency": 2.0}, 2.0)):
        found = mechanisms_of(bar(Q | {"damping.band": [1.0, 10.0]} | changes), 20.0)
        assert (found.frequency, found.band) == (frequency, (1.0, 10.0))
