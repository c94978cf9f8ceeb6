"""A disk on a rigid wall slides, rolls, rebounds and rests as in closed form, whatever segments the wall is made of."""

from typing import Any

import numpy as np
import pytest

from dembound.disks.rest.stage import settle
from dembound.disks.scene import DiskScene
from dembound.disks.stability import choose_step

LOOSE = {"law": "linearpbond", "emod": 1e9, "pb_emod": 0.0, "fric": 0.5}
R, G = 0.25, 9.81
WEIGHT = [{"acceleration": [0.0, -G]}]


def above(lab, at: Any, *walls: dict[str, Any], **words: Any) -> DiskScene:
    """A disk of radius R centred at a place, m, with its weight, and walls."""
    return lab.disks([at], [R], material=LOOSE, wall=walls, **{"held": (), "load": WEIGHT} | words)


@pytest.mark.parametrize(
    ("friction", "held", "expected"),
    [
        (0.2, ("rotation",), np.sin(np.pi / 6) - 0.2 * np.cos(np.pi / 6)),
        (0.1, (), np.sin(np.pi / 6) - 0.1 * np.cos(np.pi / 6)),  # less than tan(30°)/3 = 0.192: it slips and spins
        (0.5, (), 2.0 / 3.0 * np.sin(np.pi / 6)),
    ],
)
def test_it_slides_or_rolls_down_a_slope(lab, friction, held, expected):
    """By g(sin α − μ cos α), or by ⅔ g sin α with ½mR² of inertia."""
    along, normal = np.array([np.cos(np.pi / 6), 0.5]), np.array([-0.5, np.cos(np.pi / 6)])
    wall = {"points": [(-20.0 * along).tolist(), along.tolist()], "fric": friction, "dp_nratio": 0.5}
    run = lab.simulation(above(lab, R * normal, wall, held=held))
    speeds = []
    for time in (0.2, 0.8):
        run.run(round(time / run.time_step))
        speeds.append(-along @ run.state.velocity[:2, 0])
    steps = round(0.8 / run.time_step) - round(0.2 / run.time_step)
    # the overlap is at rest by its dashpot after some 40 steps of 2e-4 s; what is left is an elastic swing of the shear
    # spring of a rolling disk, of the amplitude gΔ(3k_s/m)^-½ = 4e-3 m/s at most, over 0.6·⅓·9.81 m/s
    slack = 4e-3 if friction == 0.5 else 1e-9
    assert np.diff(speeds)[0] / (steps * run.time_step) == pytest.approx(G * expected, rel=slack)


@pytest.mark.parametrize("share", [0.95, 1.2])
def test_it_rests_up_to_the_slope_of_its_rolling_resistance_and_rolls_above(lab, share):
    """At tan α = rr_fric, as R̄ = R; above by ⅔ g(sin α − rr_fric cos α), and friction takes rr_fric R N a radian."""
    slope, rolling = 0.3, 0.3 / share
    cosine = 1.0 / np.hypot(1.0, slope)
    along = cosine * np.array([1.0, slope])
    wall = {"points": [(-20.0 * along).tolist(), along.tolist()], "fric": 0.8, "rr_fric": rolling, "dp_nratio": 0.5}
    run = lab.simulation(above(lab, R * np.array([-along[1], along[0]]), wall))
    ledger, speeds = lab.ledger(run, 50), []
    for time in (0.3, 0.8):
        run.run(round(time / run.time_step))
        speeds.append(-along @ run.state.velocity[:2, 0])
    steps = round(0.8 / run.time_step) - round(0.3 / run.time_step)
    last = ledger.entries[-1]
    if share < 1.0:
        assert np.abs(speeds).max() < 4e-3  # the elastic swing of its springs, as above
        assert last.friction == ledger.entries[round(0.3 / run.time_step) // 50 + 1].friction
    else:
        expected = G * cosine * (slope - rolling) / 1.5
        assert np.diff(speeds)[0] / (steps * run.time_step) == pytest.approx(expected, rel=0.02)  # the swing, 4e-3 m/s
        turned, normal = abs(run.state.displacement[2, 0]), run.scene.mass[0] * G * cosine
        assert last.friction == pytest.approx(rolling * R * normal * turned, rel=0.02)
    assert abs(last.error) < 1e-9 * last.supplied


@pytest.mark.parametrize("sideways", [0.2, 0.5, 0.8])
def test_it_rebounds_from_a_corner_as_from_a_mirror(lab, sideways):
    """Whose normal is the line from the corner to its centre as they touch; within 1°, as the overlap turns it on."""
    corner = {"points": [[-2.0, -2.0], [0.0, 0.0], [0.1, -2.0]]}
    run = lab.simulation(above(lab, [sideways * R, 1.05 * R], corner, load=()))
    run.state.velocity = np.array([[0.0], [-1.0], [0.0]])
    ledger = lab.ledger(run, 20)
    run.run(round(0.3 / run.time_step))
    x, y, _ = run.state.velocity[:, 0]
    assert np.degrees(np.arctan2(x, y)) == pytest.approx(np.degrees(2.0 * np.arcsin(sideways)), abs=1.0)
    assert np.hypot(x, y) == pytest.approx(1.0, abs=0.01)
    assert abs(ledger.entries[-1].error) < 2e-4 * ledger.entries[-1].supplied


@pytest.mark.parametrize("ratio", [0.1, 0.5])
def test_it_rebounds_by_its_dashpot_as_in_closed_form(lab, ratio):
    """With the critical dashpot of the disk's own mass; at small steps, in the mean over places of the touch in one."""
    root = np.sqrt(1.0 - ratio**2)
    expected = np.exp(-ratio / root * (np.pi - np.arctan2(2.0 * ratio * root, 1.0 - 2.0 * ratio**2)))
    found = []
    for part in np.arange(4) / 4.0:
        scene = above(lab, [0.0, R], {"points": [[-1.0, 0.0], [1.0, 0.0]], "dp_nratio": ratio}, load=())
        step = 0.05 * choose_step(scene)[0]
        run = lab.simulation(scene, step=step)
        run.state.velocity = np.array([[0.0], [-1.0], [0.0]])
        run.state.u[1] += (1.0 + part) * step
        run.run(round(0.02 / step))
        found.append(run.state.velocity[1, 0])
    # errors of first order in the share 0.05 of the step: 0.002 in the mean of pairs of disks at a share of 0.09
    assert np.mean(found) == pytest.approx(expected, abs=0.003)


@pytest.mark.parametrize("way", ["over a hill", "through a valley"])
def test_it_rolls_over_a_kink_of_3_degrees_without_loss(lab, way):
    """Of energy, 1 %: pushed by both segments at once it would lose 17 % of its speed."""
    turn = np.tan(np.radians(1.5)) * (1.0 if way == "over a hill" else -1.0)
    along = np.array([1.0, turn]) / np.hypot(1.0, turn)
    start = -0.5 * along + R * np.array([-along[1], along[0]])
    wall = {"points": [[-2.0, -2.0 * turn], [0.0, 0.0], [2.0, -2.0 * turn]], "fric": 1.0}
    scene = above(lab, start, wall)
    run, speed = lab.simulation(scene), 2.0
    run.state.velocity = np.array([*(speed * along), -speed / R])[:, None]
    run.run(round(0.5 / run.time_step))
    inertia = np.array([scene.mass[0], scene.mass[0], scene.inertia[0]])
    (_, rise, _), velocity = run.state.displacement[:, 0], run.state.velocity[:, 0]
    energy = 0.5 * float(inertia @ velocity**2) + scene.mass[0] * G * rise
    assert run.state.displacement[0, 0] > 0.9
    assert energy == pytest.approx(0.75 * scene.mass[0] * speed**2, rel=0.01)


def test_a_line_cut_into_pieces_is_the_same_line(lab):
    """To rounding, also if the pieces are shorter than the part of the disk that is in the wall."""
    states = []
    for pieces in (1, 3000):
        points = np.stack([np.linspace(-1.0, 2.0, pieces + 1), np.zeros(pieces + 1)], axis=1).tolist()
        run = lab.simulation(above(lab, [0.0, 1.02 * R], {"points": points, "fric": 0.3}))
        run.state.velocity = np.array([[2.0], [-1.0], [3.0]])
        run.run(round(0.2 / run.time_step))
        states.append(run.state.velocity[:, 0])
    assert abs(states[0][2] - 3.0) > 0.1  # friction has turned it
    np.testing.assert_allclose(states[1], states[0], rtol=1e-9)


@pytest.mark.parametrize("shape", ["floor", "notch"])
def test_at_rest_it_stays_at_rest(lab, shape):
    """On a rough floor, and between the two smooth faces of a notch, which carry W/√2 each."""
    points = {"floor": [[-1.0, 0.0], [1.0, 0.0]], "notch": [[-1.0, 1.0], [0.0, 0.0], [1.0, 1.0]]}[shape]
    wall = {"points": points, "fric": 0.5 if shape == "floor" else 0.0}
    scene = above(lab, [0.0, R * (1.0 if shape == "floor" else np.sqrt(2.0))], wall, static={"ratio": 1e-9})
    start = settle(scene).start
    weight = scene.mass[0] * G
    kept = start.touching.kept[0]
    assert kept[:2, 3] == pytest.approx([weight, 0.0] if shape == "floor" else [weight / np.sqrt(2.0)] * 2, rel=1e-6)
    run = lab.simulation(scene, start)
    ledger = lab.ledger(run, 50)
    run.run(500)
    assert np.abs(run.state.displacement - start.displacement).max() < 1e-12
    assert abs(ledger.entries[-1].kinetic) < 1e-18


def test_the_step_limit_counts_a_stiff_wall(lab):
    """As a spring between the wall and the disk's mass: the usual one counts as a neighbour."""
    plain = {"points": [[-1.0, 0.0], [1.0, 0.0]], "fric": 0.5}
    free, usual, stiff = (
        choose_step(above(lab, [0.0, R], *walls))[1] for walls in ((), (plain,), (plain | {"kn": 1e12},))
    )
    assert usual == free
    mass = above(lab, [0.0, R]).mass[0]
    # 2·3k_s/m of the two walls that may hold a disk, next to which other contacts are nothing; 1.4 for those that open
    assert stiff == pytest.approx(2.0 / np.sqrt(1.4 * 6.0 * 1e12 / mass), rel=0.01)
    rolls = choose_step(above(lab, [0.0, R], plain | {"kn": 1e12, "rr_fric": 0.3}))[1]
    both = np.array([[1.0, 1.0], [1.0, 2.0]]) * [[1.0, np.sqrt(2.0)], [np.sqrt(2.0), 2.0]]  # k_s/m, I = ½mR²
    assert rolls == pytest.approx(2.0 / np.sqrt(1.4 * 2.0 * np.linalg.eigvalsh(both)[-1] * 1e12 / mass), rel=0.01)
