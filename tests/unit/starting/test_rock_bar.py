"""The starting point of a rock bar says what is true, runs, and spalls."""

import re

import pytest

from dembound.bar.fracture import spalls
from dembound.kinds import loads
from dembound.motion.simulation import Simulation
from dembound.running import plan
from dembound.starting import starting_point

ROCK_BAR = starting_point("rock_bar")


def test_keys_that_are_commented_out_exist_and_show_their_defaults() -> None:
    text, count = re.subn(r"^# (?=\w+ = |\[)", "", ROCK_BAR, flags=re.MULTILINE)
    told, plain = loads(text), loads(ROCK_BAR)

    assert count == 14
    assert told.boundary["right"].type == "free"
    assert (told.bar.area, told.bar.attenuation) == (plain.bar.area, plain.bar.attenuation)
    assert (told.method, told.load, told.run, told.output) == (plain.method, plain.load, plain.run, plain.output)


def test_it_first_spalls_where_and_when_a_triangle_makes_it() -> None:
    planned = plan(loads(ROCK_BAR))
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
