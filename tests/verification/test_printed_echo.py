"""The reflection of an end printed by `check` is an upper bound of its true reflection, and no larger than needed.

Measured is the largest difference of the velocity, at any node and step of a run, from that of a bar that goes on: its
end has a layer so long, in which nothing decays, that nothing comes back. The bound is this number by another way, the
answer to one step of the wave convolved with it: equal to rounding, of two digits rounded up, thus up to 10 % above.
"""

import math
import re
from dataclasses import replace

import numpy as np
import pytest

from dembound.api import case
from dembound.bar.scene import build_bar
from dembound.formulas.bars import ends as echoes
from dembound.formulas.bars.ends import returned_of_waves
from dembound.kinds.bar.summary import bar_facts
from dembound.motion.simulation import Simulation

CELLS, SPACING, SPEED = 120, 5e-3, 3000.0
LAYER = {"type": "matched_layer"}


def tables(horizon: int, *, cells: int = CELLS, nodes: int = 1, side: str = "left", ways: float = 5.0, **more) -> dict:
    """A bar with layers of 40 nodes under a cosine pulse of 20 spacings; horizon 1: finite differences."""
    corrected = {"type": "peridynamics", "horizon": horizon, "corrected_ends": True}
    return {
        "bar": {"length": cells * SPACING, "spacing": SPACING, "density": 2500.0, "wave_speed": SPEED},
        "method": corrected if horizon > 1 else {"type": "finite_difference"},
        "boundary": {"right": LAYER},
        "load": [{"name": "hit", "pressure": 1e6, "wave": "p", "nodes": nodes, "side": side}],
        "wave": {"p": {"type": "cosine", "amplitude": 1.0, "period": 20 * SPACING / SPEED}},
        "run": {"duration": ways * cells * SPACING / SPEED},
    } | more


def going_on(scene, side: str):
    """The bar with a layer at an end, in which nothing decays and which is so long that nothing comes back."""
    return replace(scene, layers=scene.layers | {side: scene.layers[side].endless(scene.case.run.duration)})


def measured(scene, endless, step: float) -> float:
    """Largest difference from the bar that goes on, over its largest velocity."""
    steps, nodes = math.ceil(scene.case.run.duration / step) + 1, np.arange(scene.count)
    got, expected = (Simulation(each, step, nodes).advance(steps)[:, :, 3] for each in (scene, endless))
    return float(np.abs(got - expected).max() / np.abs(expected).max())


def printed(scene, side: str, step: float) -> float:
    """The number in the facts."""
    found = re.search(r"returns at most (\S+) of wave p$", dict(bar_facts(scene, step))[f"{side} end"])
    return float(found[1])


def hold(scene, side: str, courant: float) -> None:
    """The bound is one, and within rounding to two digits of what is measured."""
    step = courant * SPACING / SPEED
    most, found = measured(scene, going_on(scene, side), step), printed(scene, side, step)
    assert most <= found <= 1.1 * most + 1e-9 * found


SLOW = [(m, nodes, nu, "left") for m in (1, 3, 8) for nodes in sorted({1, m}) for nu in (0.5, 1.0)]
FEW = [(1, 1, 1.0, "left"), (8, 1, 0.8, "left"), (3, 3, 0.5, "right")]


@pytest.mark.parametrize(
    ("horizon", "nodes", "courant", "side"), FEW + [pytest.param(*each, marks=pytest.mark.slow) for each in SLOW]
)
def test_a_load(horizon, nodes, courant, side):
    """At FD, ν = 1, the shortest waves count, at m = 8 those that a push on one node makes.

    On the layered end half of it goes into the layer; a node pushed there is no wave of a frequency.
    """
    hold(build_bar(case(**tables(horizon, nodes=nodes, side=side))), "right", courant)


def test_waves_that_enter_attenuation_ranges_and_a_wave_that_starts_late():
    more = {"name": "b", "length": 0.3, "density": 4000.0, "wave_speed": SPEED, "section": 2.0}
    bar = {"spacing": SPACING, "density": 2500.0, "wave_speed": SPEED, "attenuation": 0.3}
    bar["range"] = [{"name": "a", "length": 0.3}, more]
    wave = {"p": {"type": "triangle", "amplitude": 1.0, "rise": 2e-5, "fall": 4e-5, "start": 3.3e-5}}
    given = tables(3, bar=bar, wave=wave, load=[], boundary={"left": LAYER | {"wave_p": "p"}, "right": LAYER})
    for side in ("left", "right"):
        hold(build_bar(case(**given)), side, 0.9)


def test_of_slow_waves_more_returns_in_a_longer_run():
    """Near the shortest waves energy runs at a fraction of c, and the layer is too short for them."""
    short, long = (build_bar(case(**tables(1, ways=ways))) for ways in (5.0, 20.0))
    step = 0.5 * SPACING / SPEED
    assert printed(long, "right", step) > 50.0 * printed(short, "right", step)
    hold(long, "right", 0.5)


@pytest.mark.slow
def test_a_bar_too_long_to_be_stepped_is_represented_by_a_shorter_one(monkeypatch):
    """As many ways along it: short waves disperse on a longer one, so the bound remains one, and within five times."""
    scene = build_bar(case(**tables(3, cells=600, nodes=3)))
    step = 0.8 * SPACING / SPEED
    most = measured(scene, going_on(scene, "right"), step)
    assert returned_of_waves(scene, "right", step).shares["p"] == pytest.approx(most, rel=1e-3)
    monkeypatch.setattr(echoes, "KEPT", 4e5)
    found = returned_of_waves(scene, "right", step)
    assert 1.1 * most <= found.shares["p"] <= 5.0 * most
    assert found.within == np.inf
    monkeypatch.setattr(echoes, "KEPT", 4e4)
    assert returned_of_waves(scene, "right", step).within < scene.case.run.duration


def test_a_dashpot_returns_what_it_does():
    """Compared with the same bar with a layer in which nothing decays.

    At ν = 1 nothing returns, as a step is a spacing.
    """
    given = tables(1, boundary={"right": {"type": "viscous"}})
    scene, endless = (build_bar(case(**given | more)) for more in ({}, {"boundary": {"right": LAYER}}))
    for courant in (0.5, 0.9):
        step = courant * SPACING / SPEED
        most = measured(scene, going_on(endless, "right"), step)
        assert most <= printed(scene, "right", step) <= 1.1 * most
    said = dict(bar_facts(scene, SPACING / SPEED))["right end"]
    assert said == "viscous, β_P = 1; returns nothing of wave p but rounding errors"
