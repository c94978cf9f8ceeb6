"""Roots are found to the last bit."""

import math

import pytest

from dembound.roots import root


@pytest.mark.parametrize("sought", [0.0, 0.3, 1.0, 2.0])
def test_the_root_of_a_line_is_its_own(sought) -> None:
    assert root(lambda x: sought - x, -1.0, 3.0) == pytest.approx(sought, rel=1e-15, abs=1e-300)


def test_the_sign_changes_at_the_root_found() -> None:
    found = root(math.cos, 0.0, 3.0)
    assert math.cos(math.nextafter(found, 0.0)) > 0.0 >= math.cos(found)
