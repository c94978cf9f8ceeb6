"""Every starting point is a case that can be run as it stands, and says what its keys default to."""

import re

import pytest

from dembound.bar.fracture import spalls
from dembound.boundaries import SIDES
from dembound.casefile.bar import BarCase
from dembound.check import check
from dembound.errors import CaseError
from dembound.kinds import kind_of, loads
from dembound.motion.simulation import Simulation
from dembound.running import plan
from dembound.schemas import BODIES
from dembound.starting import DEFAULT, names, starting_point, titles

SETTLES = {"excavation"}
"""Starting points that come to rest before they run, which takes seconds."""


def test_the_default_comes_first_and_all_have_titles() -> None:
    assert names()[0] == DEFAULT
    assert {"excavation", "lamb", "long_bar", "rock_bar", "tunnel"} <= set(names())
    assert list(titles()) == names()
    assert all(titles().values())
    assert {kind_of(loads(starting_point(name))).name for name in names()} == set(BODIES)


def test_an_unknown_one_is_refused_and_a_similar_name_is_proposed() -> None:
    with pytest.raises(CaseError, match=r'--from: is "tunel", must be one of .*\(did you mean tunnel\?\)'):
        starting_point("tunel")


@pytest.mark.parametrize("name", names())
def test_it_is_checked_without_a_warning_starts_and_takes_less_than_a_minute(name: str) -> None:
    text = starting_point(name)
    case = loads(text, name=name)
    facts, warnings = check(case)
    assert not warnings
    assert "SI units" in text
    assert "time step" in facts

    planned = plan(case)
    # at some 20 million particle-steps per second, below what is measured on one core
    assert planned.steps * planned.scene.count < 60.0 * 20e6
    if name not in SETTLES:
        simulation = Simulation(planned.scene, planned.time_step)
        simulation.run(5)
        assert simulation.state.step == 5

    edited = loads(re.sub(r"^# (?=\w+ = |\[)", "", text, flags=re.MULTILINE))  # with keys that were commented out
    assert edited.text != case.text
    assert all(edited.side(side) == case.side(side) for side in SIDES)
    own = {"bar", "boundary"}  # a bar's section is None where it is left out
    assert all(edited.tables[key] == case.tables[key] for key in case.tables.keys() - own)
    if isinstance(case, BarCase):
        assert (edited.bar.area, edited.bar.attenuation) == (case.bar.area, case.bar.attenuation)


def test_the_rock_bar_first_spalls_where_and_when_a_triangle_makes_it() -> None:
    planned = plan(loads(starting_point("rock_bar")))
    simulation = Simulation(planned.scene, planned.time_step)
    simulation.run(planned.steps)
    spall, *_ = spalls(simulation.system.parts[0].bonds, planned.scene.positions[:, 0], planned.time_step)

    # d'Alembert: d = ½ c t_d σ_t/p_m from the free end, when the crest comes back there
    bar, pulse, load = planned.scene.case.bar, planned.scene.case.wave["pulse"], planned.scene.case.load[0]
    distance = 0.5 * bar.speed * pulse.fall * bar.strength / load.pressure
    time = pulse.rise + (bar.length + distance) / bar.speed
    # a crack is known within the reach of the bonds across it, and within the time that a wave takes for that
    reach = planned.scene.case.method.horizon * bar.spacing
    assert spall.start[0] - reach <= bar.length - distance <= spall.start[1] + reach
    assert spall.time == pytest.approx(time, abs=reach / bar.speed)
