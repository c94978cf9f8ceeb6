"""Rock beyond a side with dashpots."""

import numpy as np
import pytest

from dembound.boundaries import ViscoelasticInput, ViscousInput
from dembound.casefile.unlikely import unlikely
from dembound.disks.matching import supports_of
from dembound.disks.scene import build
from dembound.errors import CaseError
from dembound.studies.calibration import calibrate
from tests.small_cases import GRAINS, PUSHED, problems_of, small

ROCK = {"density": 2700.0, "p_wave_speed": 3000.0, "s_wave_speed": 1700.0}


def test_the_dashpots_of_a_side_have_the_impedance_of_the_rock() -> None:
    scene = build(small(GRAINS, changes={"boundary.right": {"type": "viscous", "rock": ROCK}}))
    edge, table = scene.edges["right"], supports_of(scene, "right")
    sums = [table.damping[table.component == axis].sum() / edge.length for axis in (0, 1)]
    np.testing.assert_allclose(sums, [2700.0 * 3000.0, 2700.0 * 1700.0], rtol=1e-12)


def test_it_stays_where_a_side_loses_its_wave_or_springs_and_gives_way_to_factors() -> None:
    given = {"rock": ROCK, "half_mass": True}
    both = ViscoelasticInput(type="viscoelastic_input", wave_p="w", distance=10.0, **given)
    for side in (both.dashpots_alone(), ViscousInput(type="viscous_input", wave_p="w", **given).at_rest()):
        assert (side.rock, side.half_mass) == (both.rock, True)
    assert both.with_factors({"p": 2.0}).rock is None
    assert both.is_interface
    assert not both.is_artificial


def test_springs_are_those_of_the_rock() -> None:
    scene = build(small(PUSHED, changes={"boundary.right": {"type": "viscoelastic", "distance": 5.0, "rock": ROCK}}))
    table = supports_of(scene, "right")
    along = table.stiffness[table.component == 0].sum() / scene.edges["right"].length
    assert along == pytest.approx(2700.0 * 1700.0**2 / 5.0, rel=1e-12)


def body(side: str) -> str:
    rock = ", ".join(f"{key} = {value}" for key, value in ROCK.items())
    return f"""
[packing]
pattern = "A"
size = [10.0, 5.0]
radius = 0.25
[material]
density = 2500.0
p_wave_speed = 1000.0
[run]
duration = 0.1
[boundary.left]
rock = {{{rock}}}
{side}
"""


@pytest.mark.parametrize(
    ("side", "message"),
    [
        ('type = "viscous"\nbeta_s = 1.0', "boundary.left.rock: gives the factors of both waves; leave out beta_s"),
        ('type = "free_field"', "boundary.left.rock: is not allowed on a free-field side"),
    ],
)
def test_what_it_cannot_stand_beside_is_refused(side: str, message: str) -> None:
    assert any(message in problem for problem in problems_of(body(side)))


def test_calibration_refuses_it() -> None:
    case = small(PUSHED, changes={"boundary.right": {"type": "viscous", "rock": ROCK}})
    with pytest.raises(CaseError, match=r"boundary.right.rock: .* needs no calibration"):
        calibrate(case, "right")


def test_units_of_its_numbers_are_doubted() -> None:
    case = small(PUSHED, changes={"boundary.right": {"type": "viscous", "rock": ROCK | {"density": 2.7}}})
    (doubt,) = [each for each in unlikely(case) if "rock" in each]
    assert doubt.startswith("boundary.right.rock.density: ")
