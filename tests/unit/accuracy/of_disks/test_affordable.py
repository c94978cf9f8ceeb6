"""The time of companions: said before they run, as long as what is run takes, and refused in one line above a limit."""

import pytest
from small_cases import Tables, around, small

from dembound.accuracy.of_disks import affordable
from dembound.accuracy.of_disks.affordable import require_short, seconds_of_all
from dembound.accuracy.of_disks.causes import ground_causes, sides_cause
from dembound.accuracy.of_disks.companions import Companions
from dembound.accuracy.proposal import Watch
from dembound.casefile.disks import DiskCase
from dembound.disks.step_cost import time_per_disk
from dembound.errors import CaseError
from dembound.running import plan

HELD: Tables = {
    "packing": {"pattern": "A", "size": [21.0, 15.0], "radius": 0.25},
    "material": {"density": 1800.0, "p_wave_speed": 400.0},
    "boundary": around("viscous", "left", "right") | {"bottom": {"type": "fixed", "artificial": False}},
    "wave": {"q": {"type": "cubic_spline", "amplitude": 1.0, "period": 0.07}},
    "load": [{"name": "f", "force": [0.0, -1e5], "position": [10.3, 10.4], "wave": "q"}],
    "monitor": [{"name": "m", "position": [10.5, 4.5]}],
    "run": {"duration": 0.1},
}
"""A force on one disk beside the place it is asked for, above disks that are held: companions of all kinds but one."""

SLIDING: Tables = HELD | {"material": HELD["material"] | {"law": "linearpbond", "fric": 0.3}}
"""Companions of the last kind: contacts may slide."""


class Told(Watch):
    """Keeps what is said."""

    def __init__(self) -> None:
        self.said: list[str] = []

    def says(self, words: str) -> None:
        """Keep it."""
        self.said.append(words)


def companions_of(case: DiskCase) -> Companions:
    """The companions of a case, with as few particle-steps as there can be."""
    planned = plan(case)
    return Companions(case, planned.scene, planned.time_step, 1.0)


@pytest.mark.parametrize("tables", [HELD, SLIDING], ids=["elastic", "contacts"])
def test_the_time_counted_is_that_of_all_companions_that_are_run(tables: Tables) -> None:
    """As long as the work of the runs, at the time of a step of a disk, but for the rounding of steps and whole rows.

    The row added at sides is one of 12; a run with half the step rounds to whole steps of 60.
    """
    companions = companions_of(small(tables))
    counted = seconds_of_all(companions)
    ground_causes(companions, companions.scene, companions.time_step)
    sides_cause(companions, companions.scene, companions.time_step, 0.0)
    spent = 1e-9 * time_per_disk(companions.lattice) * companions.runner.work
    assert companions.runner.count > 3
    assert counted == pytest.approx(spent, rel=0.12)


def test_their_sizes_are_said_before_and_too_long_ones_are_refused_unless_an_option_allows_them(monkeypatch) -> None:
    companions, told = companions_of(small(HELD)), Told()
    require_short(companions, 0.0, None, told, ", and more")
    disks, larger = (scene.disk_count for scene, _ in companions.first[:2])
    steps = companions.first[0][1]
    assert told.said == [
        f"runs companions of {disks:,} disks × {steps:,} steps and {larger:,} disks × {steps:,} steps "
        "and others of these sizes, and more"
    ]
    monkeypatch.setattr(affordable, "seconds_of_all", lambda _: 34.4)
    with pytest.raises(CaseError, match=r"take about 34 s, more than 20 s: --longest 35 allows it"):
        require_short(companions, 0.1, 10.0, told)
    for own, longest in ((40.0, None), (0.1, 35.0)):  # as long as the case, and as allowed
        require_short(companions, own, longest, told)
    assert companions.runner.count == 0
