"""Every starting point is a case that can be run as it stands, and says what its keys default to."""

import re

import pytest

from dembound.boundaries import SIDES
from dembound.check import check
from dembound.errors import CaseError
from dembound.kinds import KINDS, kind_of, loads
from dembound.motion.simulation import Simulation
from dembound.running import plan
from dembound.starting import DEFAULT, names, starting_point, titles

SETTLES = {"excavation"}
"""Those that come to rest before they run, which takes seconds."""


def test_the_default_comes_first_and_all_have_titles() -> None:
    assert names()[0] == DEFAULT
    assert {"excavation", "lamb", "long_bar", "rock_bar", "tunnel"} <= set(names())
    assert list(titles()) == names()
    assert all(titles().values())


def test_an_unknown_one_is_refused_and_a_similar_name_is_proposed() -> None:
    with pytest.raises(CaseError, match=r'--from: is "tunel", must be one of .*\(did you mean tunnel\?\)'):
        starting_point("tunel")


def test_every_kind_of_body_has_one() -> None:
    assert {kind_of(loads(starting_point(name))).name for name in names()} == set(KINDS)


@pytest.mark.parametrize("name", names())
def test_it_is_checked_without_a_warning_and_takes_less_than_a_minute(name: str) -> None:
    text = starting_point(name)
    case = loads(text, name=name)
    facts, warnings = check(case)

    assert not warnings
    assert "SI units" in text
    # at some 20 million particle-steps per second, below what is measured on one core
    assert plan(case).steps * plan(case).scene.count < 60.0 * 20e6
    assert "time step" in facts


@pytest.mark.parametrize("name", sorted(set(names()) - SETTLES))
def test_its_first_steps_can_be_taken(name: str) -> None:
    planned = plan(loads(starting_point(name), name=name))
    simulation = Simulation(planned.scene, planned.time_step)
    simulation.run(5)

    assert simulation.state.step == 5


@pytest.mark.parametrize("name", names())
def test_keys_that_are_commented_out_exist_and_show_their_defaults(name: str) -> None:
    text = re.sub(r"^# (?=\w+ = |\[)", "", starting_point(name), flags=re.MULTILINE)
    told, plain = loads(text), loads(starting_point(name))

    assert text != starting_point(name)
    assert all(told.side(side) == plain.side(side) for side in SIDES)
    own = {"bar", "boundary"}  # a bar's section is None where it is left out
    assert all(told.tables[key] == plain.tables[key] for key in plain.tables.keys() - own)
