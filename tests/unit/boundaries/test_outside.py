"""Neighbours that are impossible beside sides with a continuum."""

import pytest
from small_cases import BODY

from dembound.disks.scene import build
from dembound.errors import CaseError
from dembound.kinds import loads

WAVES = BODY + '[wave.w]\ntype = "cosine"\namplitude = 1.0\nperiod = 0.1\n'
CASE = WAVES + '[boundary.left]\ntype = "outside"\n'
BELOW = WAVES + '[boundary.bottom]\ntype = "outside"\nwave_s = "w"\n'
PERIODIC = '[boundary.left]\ntype = "periodic"\n[boundary.right]\ntype = "periodic"\n'


def problems(text: str) -> str:
    with pytest.raises(CaseError) as error:
        loads(text)
    return str(error.value)


@pytest.mark.parametrize(
    ("more", "line"),
    [
        ('[boundary.bottom]\ntype = "viscous_input"\nwave_s = "w"\n', 'bottom.type: is "viscous_input"; beside'),
        ('[boundary.top]\ntype = "fixed"\n', 'boundary.top.type: is "fixed"; beside boundary.left it must be "free"'),
        ('[boundary.bottom]\ntype = "symmetry"\n[static]\n', 'is "symmetry", which takes [static] and loads on all'),
        ('[boundary.right]\ntype = "free_field"\n', 'right.type: is "free_field", which cannot be in a case'),
        ('[motion]\nheld = ["y"]\n', 'boundary.left.type: "outside" moves freely, but motion.held holds y'),
    ],
)
def test_what_it_cannot_be_beside_gets_one_line(more: str, line: str) -> None:
    assert line in problems(CASE + more)


def test_waves_enter_through_the_bottom_of_a_periodic_body() -> None:
    case = loads(BELOW + PERIODIC)
    assert case.driving == {"bottom": {"s": "w"}}
    assert not case.side("bottom").at_rest().waves
    assert build(case).outside is not None
    assert 'waves enter through it only where boundary.left and right are both "outside" or' in problems(BELOW)
    assert "through which waves enter at the bottom only" in problems(BELOW.replace("bottom", "top") + PERIODIC)
    assert "boundary.bottom.wave_s" in problems(BELOW.replace('"w"\n', '"v"\n') + PERIODIC)


def test_no_surface_is_where_waves_of_the_bottom_would_come_back_from_it() -> None:
    """The column of the ground that waves enter by has a free surface."""
    top = '[boundary.top]\ntype = "outside"\n'
    assert "boundary.top.type" in problems(BELOW + PERIODIC + top)
    loads(WAVES + PERIODIC + top)
