"""Causes of errors of disks: driven sides, delays, a continuum, and what is not estimated."""

import numpy as np
import pytest
import tomli_w
from plane_motion import recorded as measured
from small_cases import Tables, around, small

from dembound.accuracy.of_disks.causes import Formulas, causes_of_run
from dembound.disks.scene import build
from dembound.disks.stability import choose_step
from dembound.exact.column import Column, Layer
from dembound.formulas.cause import GRID, STEP
from dembound.formulas.disks.dispersion import SLOW, Dispersion, causes_of_kinks
from dembound.formulas.disks.entry import late_by
from dembound.formulas.history import History, part_above
from dembound.kinds import loads
from dembound.motion.simulation import Simulation

HEIGHT, SPEED, PERIOD = 20.0, 1000.0, 0.02
TIME = np.linspace(0.0, 0.08, 401)
PLACE = np.array([2.25, 8.25])

ROUND = around("periodic", "left", "right")
LAYER: Tables = {
    "packing": {"pattern": "A", "size": [5.0, HEIGHT], "radius": 0.25},
    "material": {"density": 2500.0, "p_wave_speed": SPEED},
    "boundary": ROUND | {"bottom": {"type": "viscous_input", "wave_p": "pulse", "beta_p": 0.6, "half_mass": True}},
    "wave": {"pulse": {"type": "cosine", "amplitude": 1.0, "period": PERIOD}},
    "monitor": [{"name": "middle", "position": PLACE.tolist()}],
    "run": {"duration": 0.08},
}
"""A layer that a P wave enters from below, through dashpots that are too soft; its top is free."""


def pulse(t):
    return np.where((t > 0.0) & (t < PERIOD), 0.5 * (1.0 - np.cos(2.0 * np.pi * t / PERIOD)), 0.0)


def recorded(velocity, time=TIME, place=PLACE):
    """A record along y."""
    motion = np.stack([np.zeros_like(time), velocity], axis=1)
    displacement = time[1] * (np.cumsum(motion, axis=0) - 0.5 * motion)
    return {"middle": History(place, time, {"velocity": motion, "displacement": displacement})}


def cause(tables, name, record, step=1e-4):
    found = Formulas(build(small(tables)), step).causes(record)
    return next(each for each in found if each.name == name).parts["middle"]


def test_a_driven_side_keeps_a_part_of_its_wave_and_sends_back_what_returns():
    # R = (1 − 0.6)/(1 + 0.6) = 0.25 of a wave is reflected, so that 0.75 of it comes in, of which the error is a
    # third; what comes down again is reflected after 2H/c = 40 ms. Half cells reflect tan²(qD/4), below 1e-3, more.
    up = pulse(TIME - 0.01)
    error = cause(LAYER, "bottom side", recorded(up))
    np.testing.assert_allclose(error["velocity"][:, 1], (pulse(TIME - 0.05) - up) / 3.0, atol=5e-3)
    np.testing.assert_array_equal(error["velocity"][:, 0], 0.0)


def test_waves_are_late_by_the_mean_of_their_ways_and_larger_steps_make_them_earlier():
    # c(q) = c(1 − (qD)²/24) on the way H, so that ω comes late by τ = (H/c)(ωD/c)²/24: the error −τ dv/dt is
    # (H/c)(D/c)²/24 d³v/dt³. Next terms are smaller by (qD)², 2 % of the third derivative of this pulse.
    bell = np.exp(-(((TIME - 0.04) / 0.006) ** 2))
    third = np.gradient(np.gradient(np.gradient(bell, TIME), TIME), TIME)
    error = cause(LAYER, GRID, recorded(bell))["velocity"][:, 1]
    expected = HEIGHT / SPEED * (0.5 / SPEED) ** 2 / 24.0 * third
    np.testing.assert_allclose(error, expected, atol=0.03 * np.abs(expected).max())
    # cΔt/D = 0.8, so that steps take back 0.64 of what the grid adds; velocities are smaller by (ωΔt)²/8
    grid, step = (cause(LAYER, name, recorded(bell), 4e-4)["velocity"][:, 1] for name in (GRID, STEP))
    second = np.gradient(np.gradient(bell, TIME), TIME)
    np.testing.assert_allclose(step, -0.64 * grid + 4e-4**2 / 8.0 * second, atol=0.03 * np.abs(grid).max())


@pytest.mark.parametrize(
    ("bottom", "top", "kind", "end"),
    [
        ("velocity", {"type": "free"}, "s", 0.6),  # τ = 5 · 2 · 0.63 D/c = 22 ms
        ("velocity", {"type": "fixed", "artificial": False}, "s", 0.2),  # 2 · 2(0.63 + 0.77)D/c
        ("viscous_input", {"type": "roller", "artificial": False}, "p", 0.6),  # D/c
    ],
)
def test_waves_that_come_back_to_disks_held_at_their_centres_are_early(bottom, top, kind, end) -> None:
    # The column of a finer lattice errs by the same, D'/D times as much, so that the difference of both is 1 - D'/D of
    # the error. What the first order leaves is ωτ/2 of it, at most 0.24, with the shift τ of all round trips to the end
    tables = {
        "packing": {"pattern": "A", "size": [2.0, 12.0], "radius": 0.5},
        "material": {"density": 1800.0, "p_wave_speed": 400.0},
        "boundary": ROUND | {"bottom": {"type": bottom, f"wave_{kind}": "q"}, "top": top},
        "wave": {"q": {"type": "cubic_spline", "amplitude": 0.1, "period": 0.28}},
        "monitor": [{"name": "top", "position": [1.5, 8.5]}],
        "run": {"duration": end},
    }
    column = 0 if kind == "s" else 1
    coarse, fine = (small(tables, changes={"packing.radius": radius}) for radius in (0.5, 0.5 / 3))
    own, finer = (measured(case)["top"] for case in (coarse, fine))
    late = [late_by(build(case)) for case in (coarse, fine)]
    causes = causes_of_run(coarse, {"top": own}, 1e-4, 1e6, 1e6).found
    found = [each for each in causes if each.of_disks and each.name.endswith("side")]
    for quantity in ("velocity", "displacement"):
        other = finer.at(own.time - late[0] + late[1]).values[quantity][:, column]
        inside = (own.time > 0.02) & (own.time < end - 0.02)
        difference = (own.values[quantity][:, column] - other)[inside]
        expected = sum(2.0 / 3.0 * np.asarray(each.parts["top"][quantity])[:, column][inside] for each in found)
        assert np.linalg.norm(difference - expected) < 0.24 * np.linalg.norm(difference)


@pytest.mark.parametrize(("alpha", "half_mass"), [(4.0, False), (0.5, True)])
def test_it_is_that_of_a_layer_on_the_plane_of_the_side(alpha: float, half_mass: bool) -> None:
    """Its RMS within a fifth, and its shape: the second order, and dispersion, are a tenth of these errors."""
    rock = {"density": 1900.0, "p_wave_speed": 300.0 * alpha, "s_wave_speed": 212.132 * alpha}
    bottom = {"type": "viscous_input", "wave_s": "w", "half_mass": half_mass, "rock": rock}
    tables = {
        "packing": {"pattern": "A", "size": [0.5, 20.0], "radius": 0.25},
        "material": {"density": 1900.0, "p_wave_speed": 300.0, "fric": 0.5},
        "boundary": ROUND | {"bottom": bottom},
        "wave": {"w": {"type": "ricker", "amplitude": 1.0, "frequency": 3.0}},
        "run": {"duration": 1.5},
    }
    scene = build(loads(tomli_w.dumps(tables)))
    step, top = choose_step(scene)[0], int(np.argmax(scene.positions[:, 1]))
    record = Simulation(scene, step, [top]).advance(int(1.5 / step))[:, 0]
    time = step * np.arange(len(record))
    own = History(scene.positions[top], time, {"velocity": record[:, 3:5], "displacement": record[:, :2]})
    (cause,) = [each for each in Formulas(scene, step).causes({"top": own}) if each.name == "bottom side"]

    column = Column([Layer(20.0, 1900.0, 212.132), Layer(1.0, 1900.0, 212.132 * alpha)])
    exact = column.history(scene.case.wave["w"].velocity(time - late_by(scene)), step, 0.25)
    found, error = cause.parts["top"]["velocity"][:, 0], own.values["velocity"][:, 0] - exact
    assert np.linalg.norm(found) == pytest.approx(np.linalg.norm(error), rel=0.2)
    assert np.linalg.norm(found - error) < 0.3 * np.linalg.norm(error)
    assert not cause.parts["top"]["velocity"][:, 1].any()


LARGER = 2.0
COLUMN: Tables = LAYER | {
    "boundary": ROUND | {"bottom": {"type": "velocity", "wave_p": "pulse"}, "top": {"type": "viscous"}},
    "wave": {"pulse": {"type": "triangle", "amplitude": 1.0, "rise": 0.01, "fall": 0.02}},
    "run": {"duration": 0.06},
}
TIMES = np.arange(0.0, 0.06, 2e-4)
HIGHER = np.array([2.25, 12.25])
SWINGING = recorded(np.sin(100.0 * TIMES), TIMES, HIGHER)


@pytest.mark.parametrize("name", [GRID, STEP])
def test_what_companions_lack_and_have_make_up_the_error_of_all_frequencies(name: str) -> None:
    """Squares of errors add up, as frequencies are separate: for the triangle, and for its part below the frequency."""
    scene = build(small(COLUMN))
    formulas = Formulas(scene, 2e-4)
    own = recorded(scene.case.wave["pulse"].velocity(TIMES - HIGHER[1] / SPEED), TIMES, HIGHER)
    there = own["middle"]
    above = part_above(TIMES, there.velocity[:, 1], SLOW * 2.0 * SPEED / LARGER)[1]
    whole, below = (
        next(cause for cause in formulas.causes(each) if cause.name == name).share("middle", "velocity", there)
        for each in (own, recorded(there.velocity[:, 1] - above, TIMES, HIGHER))
    )
    (kinks,) = [each for each in causes_of_kinks(formulas.dispersion, own, LARGER) if each.name == f"{name} at kinks"]
    assert kinks.of_disks == (name == GRID)
    assert whole > 2.0 * below
    # the error of the whole is that within the record; the filter is not causal, by less than 5 % of the error
    assert np.hypot(below, kinks.share("middle", "velocity", there)) == pytest.approx(whole, rel=0.05)


def test_waves_of_a_force_in_a_place_have_more_high_frequencies_than_plane_ones() -> None:
    """By a factor √ω, so that kinks have more than twice the share above frequencies far above those of the wave."""
    sides = {"boundary": {"top": {"type": "viscous"}}}
    load = {"name": "f", "force": [0.0, 1.0], "wave": "pulse"}
    sizes = []
    for region in ([0.0, 0.0, 5.0, 0.5], [2.0, 0.0, 3.0, 0.5]):
        scene = build(small(COLUMN | sides | {"load": [load | {"region": region}]}))
        found = causes_of_kinks(Dispersion(scene, 2e-4), SWINGING, LARGER)
        (step,) = [each for each in found if each.name.startswith(STEP)]
        sizes.append(step.parts["middle"]["velocity"])
    assert 2.0 * sizes[0] < sizes[1] < 10.0 * sizes[0]  # by a factor ω they would have 26 times the share
