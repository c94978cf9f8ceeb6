"""The settings of a continuum that a case gives, and those chosen from its waves and loads."""

import pytest
from disk_systems import LAMB

from dembound.continuum import sizing
from dembound.continuum.medium import Medium
from dembound.disks.surroundings.elements import mesh_of
from dembound.disks.surroundings.settings import lasting_time, near_fields, settings_of

ROCK = Medium.isotropic(2500.0, 1000.0, 500.0)
BOX = (0.0, 0.0, 40.0, 20.0)
SIDES = ("left", "right", "bottom")
PULSE = {"type": "cosine", "amplitude": 1.0, "period": 0.5}
STAYS = {"type": "constant", "amplitude": 1.0, "rise": 0.5, "start": 2.0}


@pytest.fixture
def case(bar):
    """Lamb's problem, changed."""

    def changed(**changes):
        load = LAMB["load"][0] | changes.pop("load", {})
        loads = [{key: value for key, value in load.items() if value is not None}]
        return bar(LAMB | {"wave": {"pulse": PULSE}, "load": loads, "run.duration": 12.0} | changes)

    return changed


def chosen(case, diameter: float = 1.0, sides=SIDES):
    return settings_of(case, ROCK, diameter, BOX, sides)


def test_elements_are_small_beside_a_load_or_a_hole_and_never_too_small(case) -> None:
    """A load 1.5 m from the left side, a hole 2 m from the bottom; no such distance counts at a free side."""
    near = case(load={"position": [1.5, 9.5]})
    hole = {"name": "h", "type": "circle", "centre": [20.0, 5.0], "radius": 3.0}

    def gaps(case, sides=SIDES):
        return [(field.source, pytest.approx(field.gap)) for field in near_fields(case, ROCK, BOX, sides)]

    assert gaps(near) == [("force", gap) for gap in (1.5, 38.5, 9.5)]
    assert gaps(case(), ("top",)) == [("force", 0.5)]
    assert gaps(case(hole=[hole]), ("bottom", "right"))[:2] == [("waves", 2.0), ("waves", 17.0)]
    region = {"position": None, "region": [4.0, 18.0, 10.0, 20.0]}
    assert gaps(case(load=region), ("left",)) == [("force", 7.0)]
    blast = case(hole=[hole], load={"position": None, "force": None, "hole": "h", "pressure": 1e6})
    assert gaps(blast, ("bottom",)) == [("pressure", 2.0)]
    assert chosen(blast, 0.1).element == pytest.approx(2.0 * 5.0 * (1e-3 / 2e-2) ** 0.2)
    assert chosen(near).element == pytest.approx(5.0)  # 1.25 diameters between nodes
    random = {"pattern": "B", "size": [40.0, 20.0], "radius": 0.5, "radius_ratio": 1.5, "brick": [10.0, 10.0]}
    assert chosen(case(packing=random, load={"position": [1.5, 9.5]})).element == pytest.approx(11.2)


def test_a_load_that_stays_needs_a_margin(case) -> None:
    stays = case(wave={"pulse": STAYS})

    assert lasting_time(case()) == 0.0
    assert lasting_time(stays) == 10.0
    assert lasting_time(case(load={"wave": None})) == 12.0
    inner = sizing.inner_length(10.0, 1000.0, 0.3, 1e-3)
    for sides in (SIDES, ("right",)):
        found = chosen(stays, sides=sides)
        less, enough = (mesh_of(found._replace(margin=found.margin - each), BOX, sides).inner for each in (1, 0))
        assert less < inner <= enough
        assert found.layers == sizing.layer_count(4, 5e-4)


def test_elements_of_flat_ground_are_about_as_wide_as_high(case) -> None:
    """With those of at most 6 m, 8 m of height are two rows of 4 m; other ground keeps what divides its sides."""
    found = chosen(case())._replace(element=6.0, least=0.0)
    assert found.sides(240.0, 8.0) == (4.0, 4.0)
    assert found.sides(8.0, 240.0) == (4.0, 4.0)
    assert found.sides(39.0, 8.0) == (39.0 / 7.0, 4.0)  # 4.9 times as wide as high
    assert found._replace(least=5.0).sides(240.0, 8.0) == (240.0 / 40.0, 8.0)
    mesh = mesh_of(found, (0.0, 0.0, 240.0, 8.0), SIDES)
    assert {(width, height) for width, height in mesh.shapes.tolist()} == {(4.0, 4.0)}
