"""The expected errors of a continuum are within a factor 3 of the true ones.

The truth is the motion of the same disks where those of the box go on so far that nothing returns
(benchmarks/continuum_errors.py, of whose rows 95 % have to be; here are scenes of which all are).
"""

import pytest
from continuum_errors import around, rows

SMALL = around("A", 24.0, 24.0, "cosine 0.05 s", run={"duration": 0.15})
"""Elements and ties count alike in velocities, layers in displacements."""

WITHIN = 3.0
"""95 % of 395 rows are within this factor of their true errors (benchmarks/continuum_errors.py)."""

OTHERS = {
    "ties": around("A", 30.0, 30.0, "ricker 20 Hz"),
    "flat": around("A", 100.0, 14.0, "ricker 20 Hz"),
    "surface": around("A", 40.0, 20.0, "cosine 0.05 s", above=True),
    "random": around("C", 30.0, 30.0, "cosine 0.1 s"),
    "hole": around("A", 30.0, 30.0, "ricker 20 Hz", radius=4.0),
    "close": around("A", 12.0, 12.0, "cosine 0.1 s", 0.003, radius=3.0),
}


def ratios(tables: dict) -> list[float]:
    """Expected over true errors, of all monitors and quantities."""
    return [row["ratio"] for row in rows("scene", tables)]


def test_errors_beside_a_force_are_as_expected() -> None:
    found = ratios(SMALL)
    assert len(found) == 8
    assert 1.0 / WITHIN < min(found) <= max(found) < WITHIN


@pytest.mark.slow
@pytest.mark.parametrize("name", OTHERS)
def test_errors_in_other_scenes_are_as_expected(name: str) -> None:
    found = ratios(OTHERS[name])
    assert 1.0 / WITHIN < min(found) <= max(found) < WITHIN
