"""Bars of ranges: valid ``[[bar.range]]`` tables, and the message for every mistake."""

import pytest
from small_cases import problems_of, rows

from dembound.kinds import loads

GOOD = """
[bar]
spacing = 0.01
density = 8000
wave_speed = 5000
diameter = 0.02
strength = 1e9
[[bar.range]]
name = "striker"
length = 0.2
velocity = 10
[[bar.range]]
name = "specimen"
length = 0.05
spacing = 0.0025
youngs_modulus = 2e9
density = 2000.0
section = 1e-4
critical_stretch = 1e-3
interface = "contact"
gap = 0.001
[[bar.range]]
name = "bar"
length = 1
[[load]]
name = "push"
pressure = 1e6
wave = "pulse"
nodes = 2
[wave.pulse]
type = "constant"
amplitude = 1.0
[method]
type = "peridynamics"
horizon = 3
[run]
duration = 1e-3
"""


def test_a_range_has_what_it_does_not_give_from_the_bar() -> None:
    case = loads(GOOD)
    striker, specimen, bar = case.bar.parts

    assert [(part.length, part.spacing, part.speed) for part in (striker, bar)] == [
        (0.2, 0.01, 5000.0),
        (1.0, 0.01, 5000.0),
    ]
    assert (specimen.modulus, specimen.speed, specimen.area, specimen.cells) == (2e9, 1000.0, 1e-4, 20)
    assert (specimen.breaking_stretch, striker.breaking_stretch) == (1e-3, 1e9 / 2e11)
    assert case.bar.least_strength == 2e6
    assert case.bar.length == pytest.approx(1.251, rel=1e-15)
    assert case.bar.starts == pytest.approx((0.0, 0.201, 0.251), rel=1e-15)
    # 21 + 21 at the contact, 21 − 1 + 101 at the bonded interface
    assert (case.bar.nodes, case.bar.contacts) == (21 + 21 + 100, (False, True, False))
    assert case.bar.travel_time == pytest.approx(0.2 / 5000 + 0.05 / 1000 + 1.0 / 5000, rel=1e-12)
    assert "length" not in case.bar.given()


MISTAKES = r"""
length = 0.2 | lengh = 0.2 | bar.range[1, striker].length: is missing, must be a number greater than 0 (m)
length = 0.2 | length = 0.205 | bar.range[1, striker].spacing: is 0.01, must divide the length, 0.205 m, into two or mor
velocity = 10 | interface = "contact" | bar.range[1, striker].interface: is "contact", but no range is on its left
interface = "contact" |  | bar.range[2, specimen].gap: is only allowed with interface = "contact"
diameter = 0.02 | length = 2 | bar.length: is 2, must be that of all ranges and gaps, 1.251 m, or left out
nodes = 2 | nodes = 21 | load[1, push].nodes: is 21, must be at most 20, the nodes of the left range alone
horizon = 3 | horizon = 11 | method.horizon: is 11, must be at most 10, half of the shortest range's spacings
duration = 1e-3 | duration = 1e-6\ncourant = 1.0 | run.courant: makes a step of 2e-06 s, must be at most run.duration, 1
"""


@pytest.mark.parametrize(("old", "new", "line"), rows(MISTAKES))
def test_every_mistake_has_its_line(old: str, new: str, line: str) -> None:
    assert any(each.startswith(line) for each in problems_of(GOOD.replace(old, new, 1)))


def test_a_bar_without_ranges_needs_its_length() -> None:
    bare, line = GOOD[: GOOD.index("[[bar.range]]")] + GOOD[GOOD.index("[[load]]") :], "bar.length: is missing, must be"
    assert [each[: len(line)] for each in problems_of(bare)] == [line]
