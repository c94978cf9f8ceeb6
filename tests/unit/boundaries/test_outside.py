"""Sides with a continuum beyond them: what cannot be beside them."""

import pytest

from dembound.boundaries import Outside
from dembound.disks.scene import build
from dembound.errors import CaseError
from dembound.kinds import loads

BODY = """
[packing]
pattern = "A"
size = [10.0, 5.0]
radius = 0.5
[material]
density = 2500.0
p_wave_speed = 1000.0
[wave.w]
type = "cosine"
amplitude = 1.0
period = 0.1
[run]
duration = 0.1
"""
CASE = BODY + '[boundary.left]\ntype = "outside"\n'
BELOW = BODY + '[boundary.bottom]\ntype = "outside"\nwave_s = "w"\n'
PERIODIC = '[boundary.left]\ntype = "periodic"\n[boundary.right]\ntype = "periodic"\n'


def problems(text: str) -> str:
    with pytest.raises(CaseError) as error:
        loads(text)
    return str(error.value)


def test_it_is_artificial_and_has_no_keys() -> None:
    side = Outside(type="outside")
    assert side.is_artificial
    assert side.is_outside
    assert not side.factors
    assert not side.waves
    assert loads(CASE).side("left").is_outside


@pytest.mark.parametrize(
    ("more", "line"),
    [
        (
            '[boundary.bottom]\ntype = "viscous_input"\nwave_s = "w"\n',
            'boundary.bottom.type: is "viscous_input"; beside',
        ),
        ('[boundary.top]\ntype = "fixed"\n', 'boundary.top.type: is "fixed"; beside boundary.left it must be "free"'),
        ('[boundary.bottom]\ntype = "roller"\n', 'boundary.bottom.type: is "roller"; beside'),
        (
            '[boundary.bottom]\ntype = "symmetry"\n[static]\n',
            'boundary.bottom.type: is "symmetry", which takes [static] and loads on all disks out',
        ),
        ('[boundary.right]\ntype = "free_field"\n', 'boundary.right.type: is "free_field", which cannot be in a case'),
        ('[motion]\nheld = ["y"]\n', 'boundary.left.type: "outside" moves freely, but motion.held holds y'),
        (
            '[boundary.bottom]\ntype = "outside"\n[static]\n',
            'boundary.right.type: is "free", but [static] and loads on all disks also act on the ground beyond '
            "boundary.bottom, which has no end there",
        ),
        (
            "[static]\nstress = [-1e6, -1e6, 0.0]\n",
            'static.stress: cannot be applied at boundary.left ("outside"); "viscous" or '
            '"viscoelastic" sides absorb and take it, or leave it out and let gravity make it (a [[load]] with an '
            "acceleration)",
        ),
        (
            '[[load]]\nname = "g"\nacceleration = [0.0, -9.81]\n[static.boundary.left]\ntype = "fixed"\n',
            "static.boundary.left: is not allowed, as the ground goes on beyond; its bottom may be held",
        ),
    ],
)
def test_what_it_cannot_be_beside_gets_one_line(more: str, line: str) -> None:
    assert line in problems(CASE + more)


@pytest.mark.parametrize(
    ("kind", "said"), [("free_field", "cannot be in a case with boundary.right"), ("viscous", "beside boundary.bottom")]
)
def test_a_wrong_side_beside_several_continua_has_one_line(kind: str, said: str) -> None:
    """Nor is the bottom blamed for waves that the wrong side keeps from entering."""
    text = f'{BELOW}[boundary.right]\ntype = "outside"\n[boundary.left]\ntype = "{kind}"\n'
    with pytest.raises(CaseError) as error:
        loads(text)
    (line,) = error.value.problems
    assert line.startswith(f'boundary.left.type: is "{kind}"')
    assert said in line


@pytest.mark.parametrize("kind", ['"fixed"', '"symmetry"', '"viscous"', '"velocity"\nwave_p = "w"', '"outside"'])
def test_the_opposite_side_may_be_anything_but_a_free_field(kind: str) -> None:
    assert loads(f"{CASE}[boundary.right]\ntype = {kind}\n").side("left").is_outside


def test_waves_enter_through_the_bottom_of_a_periodic_body() -> None:
    case = loads(BELOW + PERIODIC)
    assert case.driving == {"bottom": {"s": "w"}}
    assert not case.side("bottom").at_rest().waves
    assert build(case).outside is not None


@pytest.mark.parametrize(
    ("text", "line"),
    [
        (
            BELOW,
            'boundary.bottom.type: waves enter through it only where boundary.left and right are both "outside" or',
        ),
        (
            BELOW.replace("bottom", "top") + PERIODIC,
            'boundary.top.type: is "outside", through which waves enter at the bottom only',
        ),
        (BELOW.replace('"w"\n', '"v"\n') + PERIODIC, "boundary.bottom.wave_s"),
    ],
)
def test_other_waves_get_one_line(text: str, line: str) -> None:
    assert line in problems(text)


def test_a_hole_that_reaches_it_is_refused() -> None:
    hole = '[[hole]]\nname = "h"\ntype = "circle"\nradius = 1.0\ncentre = '
    with pytest.raises(CaseError, match=r"hole\[1, h\]: reaches boundary.left, where the continuum has no hole"):
        build(loads(CASE + hole + "[0.5, 2.5]\n"))
    assert build(loads(CASE + hole + "[5.0, 2.5]\n")).outside is not None
