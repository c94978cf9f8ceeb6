"""The exact curves beside cases of Lamb's problem, of a pressure in a hole, and of a hole under a wave at an angle."""

import math

import h5py
import numpy as np
import pytest
from scene_tables import ISOTROPIC, lattice, monitors, pulse
from small_cases import SURROUNDED, Tables, around, small

from dembound.accuracy.of_disks import exact
from dembound.accuracy.of_disks.exact import exact_motions, write_exact
from dembound.casefile import Case
from dembound.disks.scene import build
from dembound.errors import CaseError
from dembound.exact import PlaneWave, Solid, buried_displacement, cavity_motion, scattered_motion

ALL = ("left", "right", "bottom", "top")
SLOW = ISOTROPIC | {"p_wave_speed": 300.0}
ROCK, STIFF = (Solid(2500.0, speed, speed / math.sqrt(2.0)) for speed in (300.0, 1000.0))
HAMMER = {"name": "hammer", "force": [0.0, -1000.0], "position": [4.75, 4.75], "wave": "pulse"}
LAMB: Tables = {
    "packing": lattice(10.0, 5.0, 0.5),
    "material": SLOW,
    "wave": pulse(0.1, 1.0, "cubic_spline"),
    "load": [HAMMER],
    "monitor": monitors(before=(2.75, 4.75), behind=(6.75, 4.75)),
    "run": {"duration": 0.2},
}


def histories(path, case: Case) -> tuple[np.ndarray, ...]:
    """Times, and displacements (k, 3) of the two monitors."""
    write_exact(case, path)
    with h5py.File(path) as file:
        groups = [file[f"histories/{name}"] for name in ("before", "behind")]
        return groups[0]["time"][:], *(group["displacement"][:] for group in groups)


def test_a_load_on_the_open_surface_moves_both_sides_alike(tmp_path) -> None:
    case = small(LAMB)
    time, before, behind = histories(tmp_path / "run.h5", case)
    force = case.wave["pulse"].velocity
    out, down = buried_displacement(time, 2.0, 0.25, lambda t: 1000.0 * force(t), ROCK)  # half a disk deep
    # both from the same quadrature
    np.testing.assert_allclose(behind, np.column_stack([out, -down, 0.0 * time]), atol=1e-12 * down.max())
    np.testing.assert_allclose(before, behind * [-1.0, 1.0, 1.0], atol=1e-12 * down.max())


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"load": [{**HAMMER, "force": [10.0, -1000.0]}]}, "one vertical force"),
        ({"monitor": monitors(deep=(2.0, 1.0))}, "monitor.deep.position: must be on the top"),
        ({"boundary.top": {"type": "viscous"}}, 'boundary.top.type: is "viscous", must be "free"'),
        ({"load": [{**HAMMER, "position": [0.75, 4.75]}]}, "load: is 0.75 m from the left side and 6 m from a monitor"),
        ({"monitor": monitors(under=(4.75, 4.75))}, "monitor.under.position: lies under the load"),
        ({"wave.pulse": {"type": "constant", "amplitude": 1.0, "start": 0.05}}, "has a jump at 0.05 s"),
    ],
)
def test_other_problems_are_refused_and_leave_nothing(tmp_path, changes, message) -> None:
    with pytest.raises(CaseError, match=message):
        write_exact(small(LAMB, changes=changes), tmp_path / "new" / "run.h5")
    assert not list(tmp_path.iterdir())


BLAST = {"name": "blast", "hole": "hole", "pressure": 1e6, "wave": "pulse"}
BORE = {"name": "hole", "type": "circle", "centre": [10.0, 10.0], "radius": 2.0}
PRESSED: Tables = {
    "packing": lattice(20.0, 20.0, 0.5),
    "material": SLOW,
    "boundary": around("viscous", *ALL),
    "wave": {"pulse": {"type": "cosine", "amplitude": 2.0, "period": 0.05, "start": 0.01}},
    "hole": [BORE],
    "load": [BLAST],
    "monitor": monitors(right=(13.25, 10.25), below=(8.25, 6.25)),
    "run": {"duration": 0.15},
}
OPEN = {"boundary.top": {"type": "free"}}


def test_monitors_move_away_from_the_hole_as_the_cavitys_solution() -> None:
    case = small(PRESSED)
    problem, motions = exact_motions(build(case))
    assert problem.name == "cavity"
    assert set(problem.until.values()) == {math.inf}
    for name, away in (("right", np.array([3.25, 0.25])), ("below", np.array([-1.75, -3.75]))):
        motion, distance, force = motions[name], np.hypot(*away), case.wave["pulse"].velocity
        expected = cavity_motion(motion.time, distance, lambda t, f=force: 1e6 * f(t), 2.0, ROCK, tolerance=1e-5)
        for found, radial in ((motion.displacement, expected.displacement), (motion.velocity, expected.velocity)):
            # speeds of the packing are homogenised, with rounding errors
            size = np.abs(radial).max()
            np.testing.assert_allclose(found[:, :2], np.outer(radial, away / distance), rtol=0.0, atol=1e-6 * size)
            assert not found[:, 2].any()


def test_below_a_free_surface_it_is_garvins_problem_or_the_cavitys_until_the_echo(monkeypatch) -> None:
    monkeypatch.setattr(exact, "SAMPLES", 200)  # times
    scene = build(small(PRESSED, changes=OPEN))
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
    monkeypatch.setattr(exact, "SAMPLES", 100)
    both = {"monitor": monitors(left=(4.25, 15.25), right=(15.75, 15.25))}
    _, motions = exact_motions(build(small(PRESSED, changes=OPEN | both)))
    left, right = motions["left"].velocity, motions["right"].velocity
    np.testing.assert_allclose(left, right * [-1.0, 1.0, 1.0], rtol=0.0, atol=1e-6 * np.abs(right).max())
    assert (motions["right"].displacement[:, :2].max(axis=0) > 0.0).all()  # outwards and upwards


TUNNEL: Tables = SURROUNDED | {
    "ground": {"size": [100.0, 120.0]},
    "packing": lattice(20.0, 20.0, 1.0) | {"origin": [40.0, 40.0]},
    "material": ISOTROPIC,
    "outside": {"element": 10.0},
    "boundary": around("outside", *ALL),
    "incident": {"type": "sv", "angle": 30.0, "wave": "pulse", "point": [50.0, 20.0]},
    "wave": pulse(0.1, 0.5, "cubic_spline"),
    "hole": [{"name": "tunnel", "type": "circle", "centre": [50.0, 50.0], "radius": 5.0}],
    "monitor": monitors(left=(44.5, 50.5), above=(50.5, 56.5)),
    "run": {"duration": 0.3},
}


def test_before_the_surface_reflects_it_is_the_incident_wave_scattered(monkeypatch) -> None:
    """Direction, polarisation, and the delay from the point to the hole."""
    monkeypatch.setattr(exact, "SAMPLES", 300)  # times
    angle, case = math.radians(30.0), small(TUNNEL, changes={"run.duration": 0.16})
    problem, motions = exact_motions(build(case))
    assert problem.name == "scattering"
    delay = 30.0 * math.cos(angle) / STIFF.s_wave_speed
    wave = PlaneWave("sv", 0.5 * math.pi - angle, case.wave["pulse"].velocity)
    for name, place in (("left", [-5.5, 0.5]), ("above", [0.5, 6.5])):
        motion = motions[name]
        # what the surface sends back needs 120 m − 20 m up and 120 m − 57 m down, at 1000 m/s or less
        early = motion.time < (100.0 + 60.0) * math.cos(angle) / 1000.0
        expected = scattered_motion(motion.time[early] - delay, np.array([place]), wave, 5.0, STIFF)
        assert np.abs(expected.velocity).max() > 0.3
        for found, moved in ((motion.displacement, expected.displacement), (motion.velocity, expected.velocity)):
            size = np.abs(moved).max()
            np.testing.assert_allclose(found[early, :2], moved[0].T, rtol=0.0, atol=1e-4 * size)


def test_what_the_surface_sends_back_is_part_of_it_until_the_holes_echo(monkeypatch) -> None:
    """A vertical P wave of 0.1 s is doubled at the surface, far beside the hole."""
    monkeypatch.setattr(exact, "SAMPLES", 300)  # times
    changes = {
        "incident.type": "p",
        "incident.angle": 0.0,
        "outside.margin": 20,
        "monitor": monitors(far=(250.5, 119.5)),
    }
    case = small(TUNNEL, changes=changes)
    problem, motions = exact_motions(build(case))
    # the wave meets the wall 25 m above the point, and what the hole scatters returns from its image above the surface
    echo = (25.0 + math.hypot(200.5, 240.0 - 50.0 - 119.5) - 5.0) / 1000.0
    assert problem.until["far"] == pytest.approx(echo, rel=1e-9)
    motion = motions["far"]
    assert 0.2 < motion.time[-1] <= echo
    velocity, early = case.wave["pulse"].velocity, motion.time < 0.2
    twice = velocity(motion.time - 0.0995) + velocity(motion.time - 0.1005)
    expected = np.stack([0.0 * twice, twice], axis=1)[early]
    np.testing.assert_allclose(motion.velocity[early, :2], expected, rtol=0.0, atol=1e-4)


STEADY = {"name": "gas", "hole": "hole", "pressure": 1e5}
SHALLOW = {"hole.hole.radius": 2.9, "hole.hole.centre": [10.0, 11.0], **OPEN}
CUT = BORE | {"centre": [10.0, 18.5]}
SQUARE = {"name": "h", "type": "rectangle", "corners": [48.0, 48.0, 52.0, 52.0]}
BLOW = {"name": "blow", "force": [1.0, 0.0], "position": [45.5, 45.5], "wave": "pulse"}


@pytest.mark.parametrize(
    ("tables", "changes", "name", "message"),
    [
        (PRESSED, SHALLOW, "garvin", r"hole\.hole\.radius: is 2.9, must be at most 0\.25 of its depth \(9 m\)"),
        (PRESSED, {}, "lamb", "--problem: the case has no load of lamb"),
        (PRESSED, {}, "mindlin", "--problem: mindlin is none of lamb, cavity, garvin, scattering"),
        (PRESSED, {"boundary.left": {"type": "symmetry"}}, None, r'left\.type: is "symmetry", must be a side beyond'),
        (PRESSED, {"material.fric": 0.0}, None, "anisotropic"),
        (PRESSED, {"material.law": "linearpbond"}, None, r'material\.law: is "linearpbond", must have no history'),
        (PRESSED, {"hole": [CUT]}, None, r"hole\[1, hole\]: reaches boundary\.top; the solution is that of a closed c"),
        (PRESSED, {"load": [BLAST, STEADY]}, None, r"load\[2, gas\]: is steady, and begins with the run"),
        (PRESSED, {"boundary.left": {"type": "viscous_input", "wave_p": "pulse"}}, None, "that of one pressure on the"),
        (TUNNEL, {"hole": [SQUARE]}, None, "that of one circle"),
        (TUNNEL, {"load": [BLOW]}, None, "alone"),
    ],
)
def test_other_problems_are_refused(tables, changes, name, message) -> None:
    with pytest.raises(CaseError, match=message):
        exact_motions(build(small(tables, changes=changes)), name)
