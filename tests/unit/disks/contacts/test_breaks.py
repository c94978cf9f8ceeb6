"""The first broken bonds of a run, found without a record."""

import pytest

from dembound.disks.contacts.pairs import BREAK_TIME, BREAK_X, BREAK_Y, first_break
from dembound.kinds.disks.kind import Disks
from dembound.motion.simulation import Simulation

BONDS = {
    "material.law": "linearpbond",
    "material.contact_share": 0.0,
    "material.pb_ten": 0.4e6,  # a compressive pulse of 1.25 MPa comes back from the free end as tension
    "motion.held": ["y", "rotation"],
    "boundary.right": {"type": "free"},
}


def run_of(case, steps=150, datum=None) -> Simulation:
    kind = Disks()
    scene = kind.build(case)
    simulation = Simulation(scene, kind.choose_step(scene)[0], datum=datum)
    simulation.run(steps)
    return simulation


def test_it_is_the_first_step_and_the_mean_place_inside_a_part_of_the_scene(bar) -> None:
    run = run_of(bar(BONDS))
    cracks = run.system.take_cracks(run.state.step)
    first = cracks.step == cracks.step.min()
    assert 1 < first.sum() < len(cracks)  # a whole section at once, others later

    found = Disks().findings(run.scene, run_of(bar(BONDS)))
    assert found[BREAK_TIME] == (pytest.approx(cracks.step.min() * run.time_step), "s")
    assert found[BREAK_X] == (pytest.approx(cracks.position[first, 0].mean()), "m")
    # the section is whole, so its mean is the middle of the bar, to rounding
    assert found[BREAK_Y] == (pytest.approx(0.5 * run.scene.size[1]), "m")

    end = float(cracks.position[first, 0].max()) - 0.1
    rest = cracks.position[:, 0] < end  # what breaks later, nearer to the driven end
    found = first_break(run_of(bar(BONDS)), (0.0, 0.0, end, 1.0))
    assert found[BREAK_TIME].value == pytest.approx(cracks.step[rest].min() * run.time_step)
    assert found[BREAK_X].value < end
    assert first_break(run_of(bar(BONDS)), (0.0, 0.0, 0.3, 1.0)) == {}
