"""Layers of the ground: what they take from [material], where they end, and their mistakes."""

import tomllib

import pytest
from small_cases import BODY, problems_of

from dembound.kinds import loads
from tests.small_cases import rows

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

SHARED = BODY.replace("p_wave_speed = 1000.0", 'p_wave_speed = 1000.0\nmatch = "assembly"\ncontact_share = 0.3')


def test_a_layer_takes_from_the_material_what_it_does_not_give() -> None:
    case = loads(SHARED + SOIL)
    clay, sand, rock = case.materials
    assert clay.given() == {"density": 2500.0, "s_wave_speed": 200.0, "contact_share": 0.3}
    assert sand.given() == case.material.given() | {"density": 2000.0, "kratio": 2.0}
    assert rock.given() == {"density": 2500.0, "emod": 1e9, "pb_emod": 2e9}
    assert case.joints == (3.5, 2.0)
    assert case.layer_names == ("clay", "2", "rock")


def test_a_layer_with_targets_takes_no_stiffness_from_the_material() -> None:
    """Nor ratios of stiffness, which follow from targets; targets of [material] are left out in the same way."""
    moduli, targets = "emod = 1e9\npb_emod = 1e9\n", 'young = 5e9\npoisson = 0.3\nalong = "y"\n'
    for own, others in ((targets, "p_wave_speed = 1000.0\nkratio = 2.0\n"), (moduli, targets)):
        text = BODY.replace("p_wave_speed = 1000.0", others) + SOIL.replace("s_wave_speed = 200.0", own)
        assert loads(text.replace("kratio = 2.0\n\n", "\n")).materials[0].given() == {
            "density": 2500.0,
            **tomllib.loads(own),
        }


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
    assert problems_of(bare + full.replace("p_wave_speed = 800.0", "")) == [
        "layer[2].p_wave_speed: is missing in the layer and in [material]; give it a wave speed, targets or moduli"
    ]
    assert problems_of(bare + full.replace("density = 1900.0\n", "", 1)) == [
        "layer[1, clay].density: is missing in the layer and in [material]"
    ]


def test_what_layers_do_not_go_with_is_refused() -> None:
    sides = "".join(f'[boundary.{side}]\ntype = "periodic"\n' for side in ("bottom", "top"))
    (line,) = problems_of(BODY + SOIL + sides)
    assert line.startswith('layer: boundary.bottom is "periodic"')
    around = "".join(f'[boundary.{side}]\ntype = "outside"\n' for side in ("left", "right", "bottom"))
    wave = '[wave.w]\ntype = "constant"\namplitude = 1.0\n[incident]\ntype = "sv"\nwave = "w"\nangle = '
    assert problems_of(BODY + SOIL + around + wave + "20.0\n") == []
    random = BODY.replace('pattern = "A"', 'pattern = "B"\nbrick = [10.0, 5.0]\nradius_ratio = 1.5')
    (line,) = problems_of(random + SOIL.replace("emod = 1e9", "emod = 0.0", 1))
    assert line.startswith("layer[3, rock].emod: is 0, but contacts hold pattern B under stress")
