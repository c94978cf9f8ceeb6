"""Warnings of a case of disks, and changes of a bar without warnings, for tests."""

from dembound.casefile import Case
from dembound.kinds.disks.warnings import disk_warnings
from dembound.running import plan

SLOW = {"wave.pulse.period": 0.5, "run.duration": 0.5}
"""A wave far longer than the bar, without warnings."""

DENSE = {
    "packing": {"pattern": "B", "size": [6.0, 5.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [6.0, 5.0]},
    "monitor": [],
    **SLOW,
}
"""A packing with its default of 10 MPa locked in."""

GROUND = {
    "packing": {"pattern": "A", "size": [20.0, 10.0], "radius": 0.5},
    "material": {"density": 2500.0, "p_wave_speed": 1000.0},
    "wave": {"blow": {"type": "cosine", "amplitude": 1.0, "period": 0.05}},
    "run": {"duration": 0.01},
}
"""Ground for a blow."""


def warned(case: Case) -> list[str]:
    """The warnings about a case before its run."""
    planned = plan(case)
    return disk_warnings(planned.scene, planned.time_step)
