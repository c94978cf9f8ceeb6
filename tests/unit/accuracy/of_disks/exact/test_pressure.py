"""The exact curves beside cases with a pressure in a hole, deep and below a free surface."""

import math

import numpy as np
import pytest
import tomli_w

from dembound.accuracy.of_disks import exact as module
from dembound.accuracy.of_disks.exact import exact_motions
from dembound.disks.scene import build
from dembound.errors import CaseError
from dembound.exact import Solid, cavity_motion
from dembound.kinds import loads, with_changes

CASE = tomli_w.dumps(
    {
        "packing": {"pattern": "A", "size": [20.0, 20.0], "radius": 0.25},
        "material": {"density": 2500.0, "p_wave_speed": 300.0, "fric": 0.5},
        "boundary": {side: {"type": "viscous"} for side in ("left", "right", "bottom", "top")},
        "wave": {"pulse": {"type": "cosine", "amplitude": 2.0, "period": 0.05, "start": 0.01}},
        "hole": [{"name": "hole", "type": "circle", "centre": [10.0, 10.0], "radius": 2.0}],
        "load": [{"name": "blast", "hole": "hole", "pressure": 1e6, "wave": "pulse"}],
        "monitor": [{"name": "right", "position": [13.25, 10.25]}, {"name": "below", "position": [8.25, 6.25]}],
        "run": {"duration": 0.15},
    }
)

SOLID = Solid(2500.0, 300.0, 300.0 / math.sqrt(2.0))
BLAST = {"name": "blast", "hole": "hole", "pressure": 1e6, "wave": "pulse"}
OPEN = {"boundary.top": {"type": "free"}}


def test_monitors_move_away_from_the_hole_as_the_cavitys_solution() -> None:
    case = loads(CASE)
    problem, motions = exact_motions(build(case))
    assert problem.name == "cavity"
    assert set(problem.until.values()) == {math.inf}
    for name, away in (("right", np.array([3.25, 0.25])), ("below", np.array([-1.75, -3.75]))):
        motion, distance = motions[name], np.hypot(*away)
        expected = cavity_motion(
            motion.time, distance, lambda t: 1e6 * case.wave["pulse"].velocity(t), 2.0, SOLID, tolerance=1e-5
        )
        for found, radial in ((motion.displacement, expected.displacement), (motion.velocity, expected.velocity)):
            # speeds of the packing are homogenised, with rounding errors
            size = np.abs(radial).max()
            np.testing.assert_allclose(found[:, :2], np.outer(radial, away / distance), rtol=0.0, atol=1e-6 * size)
            assert not found[:, 2].any()


def test_below_a_free_surface_it_is_garvins_problem_or_the_cavitys_until_the_echo(monkeypatch) -> None:
    monkeypatch.setattr(module, "SAMPLES", 200)  # times
    scene = build(with_changes(loads(CASE), OPEN))
    garvin, below = exact_motions(scene)
    cavity, alone = exact_motions(scene, "cavity")
    assert (garvin.name, cavity.name) == ("garvin", "cavity")
    # to the surface at y = 20 m and back, from the wall of the hole, after the start at 0.01 s
    assert cavity.until["right"] == pytest.approx(0.01 + (np.hypot(3.25, 19.75) - 2.0) / 300.0)
    assert alone["right"].time[-1] <= cavity.until["right"] < below["right"].time[-1]
    for name, motion in alone.items():
        # the echo of a line source comes as early as that of the wall; the quadratures are asked for 1e-5
        for quantity, expected in motion.values.items():
            found, size = below[name].values[quantity], np.abs(expected).max()
            np.testing.assert_allclose(found[: len(expected)], expected, rtol=0.0, atol=2e-4 * size)
    monkeypatch.setattr(module, "SAMPLES", 100)
    monitor = [{"name": name, "position": [x, 15.25]} for name, x in (("left", 4.25), ("right", 15.75))]
    _, motions = exact_motions(build(with_changes(loads(CASE), {**OPEN, "monitor": monitor})))
    left, right = motions["left"].velocity, motions["right"].velocity
    np.testing.assert_allclose(left, right * [-1.0, 1.0, 1.0], rtol=0.0, atol=1e-6 * np.abs(right).max())
    assert (motions["right"].displacement[:, :2].max(axis=0) > 0.0).all()  # outwards and upwards


STEADY = {"name": "gas", "hole": "hole", "pressure": 1e5}
TOO_SHALLOW = {"hole.hole.radius": 2.9, "hole.hole.centre": [10.0, 11.0], **OPEN}
CUT = {"name": "hole", "type": "circle", "centre": [10.0, 18.5], "radius": 2.0}


@pytest.mark.parametrize(
    ("changes", "name", "message"),
    [
        (TOO_SHALLOW, "garvin", r"hole\.hole\.radius: is 2.9, must be at most 0\.25 of its depth \(9 m\)"),
        ({}, "lamb", "--problem: the case has no load of lamb"),
        ({}, "mindlin", "--problem: mindlin is none of lamb, cavity, garvin, scattering"),
        ({"boundary.left": {"type": "symmetry"}}, None, r'boundary\.left\.type: is "symmetry", must be a side beyond'),
        ({"material.fric": 0.0}, None, "anisotropic"),
        ({"material.law": "linearpbond"}, None, r'material\.law: is "linearpbond", must have no history'),
        ({"hole": [CUT]}, None, r"hole\[1, hole\]: reaches boundary\.top; the solution is that of a closed circle"),
        ({"load": [BLAST, STEADY]}, None, r"load\[2, gas\]: is steady, and begins with the run"),
        ({"boundary.left": {"type": "viscous_input", "wave_p": "pulse"}}, None, "that of one pressure on the wall of"),
    ],
)
def test_other_problems_are_refused(changes, name, message) -> None:
    with pytest.raises(CaseError, match=message):
        exact_motions(build(with_changes(loads(CASE), changes)), name)
