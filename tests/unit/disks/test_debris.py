"""The moved mass, its run-out, and fragments of lattices in given positions; when a run has come to rest."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from small_cases import problems_in, small

from dembound.disks.debris import AT_REST, LEAST, STEPS, Debris, Rest
from dembound.disks.scene import DiskScene, build
from dembound.motion.endings import RestRule, rest_rule
from dembound.motion.paths import Source
from dembound.table import EVERYWHERE

LOOSE: dict[str, Any] = {
    "packing": {"pattern": "A", "size": [15.0, 10.0], "radius": 0.25},
    "material": {"law": "linearpbond", "density": 2500.0, "emod": 1e7, "pb_emod": 1e7, "pb_ten": 1.0, "pb_coh": 1.0},
    "load": [{"name": "weight", "acceleration": [0.0, -10.0]}],
    "run": {"duration": 1.0},
}
"""30 × 20 disks of 0.5 m; with `STOOD` they stand on a side."""

STOOD = LOOSE | {"boundary": {"bottom": {"type": "fixed"}}}


@pytest.fixture(scope="module")
def scene() -> DiskScene:
    return build(small(STOOD))


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_run_out_is_of_the_mass_that_moved_by_more_than_a_diameter(scene: DiskScene, sign: float) -> None:
    """The upper ten of 20 rows move by 20 m and 3 m down, the lower ones by 0.4 m.

    Of 30 columns of the moved mass the 29th from behind has its 95 %, the last one its 99 %. The crest is at 14.75 m
    (0.25 m) and the uppermost row, 9.75 m high, the front the mean height of rows 5.25 to 9.75 m less 3 m. A disk that
    fell far below is of no mass.
    """
    y = scene.positions[:, 1]
    upper = y > 5.0
    moved = np.where(upper[:, None], [sign * 20.0, -3.0], [0.4, 0.0])
    lost = np.flatnonzero(~upper)[7]
    moved[lost] = 0.0, -50.0
    found = Debris(scene).run_out(moved)
    assert found["mass"] == pytest.approx(scene.mass[upper].sum(), rel=1e-12)
    assert found["share"] == pytest.approx(0.5, rel=1e-12)
    np.testing.assert_allclose(found["centre"], [7.5 + sign * 20.0, 4.5], rtol=1e-12)
    ahead, behind = ("right", "left") if sign > 0.0 else ("left", "right")
    crest = 0.25 if sign > 0.0 else 14.75
    x95, x99 = (crest + sign * (20.0 + 0.5 * columns) for columns in (28, 29))
    angle = np.degrees(np.arctan2(9.75 - 4.5, 20.0 + 0.5 * 29))
    assert found[ahead] == pytest.approx({"x95": x95, "x99": x99, "angle": angle}, rel=1e-12)
    assert np.isnan(list(found[behind].values())).all()


def test_few_disks_have_no_run_out_and_nothing_no_centre(scene: DiskScene) -> None:
    debris = Debris(scene)
    moved = np.zeros((600, 2))
    assert np.isnan(debris.run_out(moved)["centre"]).all()
    assert debris.run_out(moved)["mass"] == 0.0
    moved[: LEAST - 1] = 3.0, 0.0
    assert np.isnan(debris.run_out(moved)["right"]["x99"])
    moved[LEAST - 1] = 3.0, 0.0
    assert np.isfinite(debris.run_out(moved)["right"]["x99"])


def test_fragments_are_pieces_of_intact_bonds_that_no_side_holds(scene: DiskScene) -> None:
    """A block of 2 × 2 disks at a corner and a single disk come off: five cells of D² of 600 in 1 and 4.

    d = √(4A/π) with the area A of four cells.
    """
    x, y = scene.positions.T
    block, single = (x > 14.0) & (y > 9.0), (x < 0.5) & (y > 9.5)
    pairs = scene.assembly.pairs
    cut = (block[pairs].sum(axis=1) == 1) | (single[pairs].sum(axis=1) == 1)
    debris = Debris(scene)
    assert debris.fragments(pairs[:0]).describe() == dict.fromkeys(
        ("count", "largest", "share", "singles", "d50", "d80"), 0.0
    )
    found = debris.fragments(pairs[cut][:, ::-1])  # in either order
    assert sorted(found.disks) == [1, 4]
    largest = np.sqrt(4.0 * 4.0 * 0.25 / np.pi)
    expected = {"count": 1, "largest": largest, "share": 5.0 / 600.0, "singles": 0.2, "d50": largest, "d80": largest}
    assert found.describe() == pytest.approx(expected, rel=1e-12)
    # the number of a fragment is one more than that of its first disk
    assert found.number.tolist() == sorted([1 + np.flatnonzero(block)[0], 1 + np.flatnonzero(single)[0]])
    assert (found.of_disk[block] == 1 + np.flatnonzero(block)[0]).all()
    assert not found.of_disk[~block & ~single].any()
    free = Debris(build(small(LOOSE))).fragments(pairs[:0])
    assert free.disks.tolist() == [600]  # which no side holds
    sand = {"law": "linearpbond", "density": 2500.0, "emod": 1e7, "pb_emod": 0.0, "fric": 0.5, "kratio": 2.0}
    assert Debris(build(small(STOOD | {"material": sand}))).fragments(pairs) is None


def ended_at(scene: DiskScene, motions: list[tuple[float, float]], rule: RestRule) -> int | None:
    """Look at which a run ends in which all disks have fallen by and move with these (m, m/s) at each look, if any."""
    tracker = Rest(scene, rule, 1.0, ends=True)
    datum = np.ones((3, 600))
    for number, (fallen, speed) in enumerate(motions):
        tracker.restore(tracker.saved_arrays())  # as a run that is continued
        down, velocity = np.zeros((2, 3, 600))
        down[1], velocity[0] = -fallen, speed
        state = SimpleNamespace(step=number * STEPS, displacement=datum + down, datum=datum, velocity=velocity)
        run = SimpleNamespace(state=state, stopped=False, time_step=1.0)
        tracker.handle(run)
        assert tracker.due == (number + 1) * STEPS
        if run.stopped:
            return number
    return None


def test_a_run_ends_when_what_fell_has_been_at_rest_for_long_enough(scene: DiskScene) -> None:
    """½mv² beside mgh of 2 m, g = 10 m/s²: below v = √(2 · 20 · AT_REST) it is at rest; less than 0.5 m is no fall."""
    slow = 0.99 * np.sqrt(40.0 * AT_REST)
    falling = [(0.0, 0.0)] * 5 + [(0.4, slow), (2.0, 1.01 * slow / 0.99)]
    lying = [(2.0, slow)] * 8
    assert ended_at(scene, falling + lying, RestRule(3 * STEPS, 0.0)) == 9  # from the sixth look on, in motion, three
    assert ended_at(scene, falling + lying, RestRule(3 * STEPS, 10 * STEPS)) == 13  # counted from the end of the waves
    assert ended_at(scene, [(0.4, 0.0)] * 15, RestRule(3 * STEPS, 0.0)) is None
    # energy of the fall is the largest so far: what is thrown up again is at rest no sooner
    assert ended_at(scene, [*falling[:-1], (4.0, 1.0), *[(2.0, 1.3 * slow)] * 4], RestRule(3 * STEPS, 0.0)) == 9


def test_the_rule_waits_for_waves_and_walls_and_for_a_free_fall() -> None:
    wall = {"name": "gate", "points": [[20.0, 0.0], [20.0, 5.0]], "velocity": [0.0, 1.0], "until": 0.7}
    case = small(STOOD | {"wall": [wall], "run": {"duration": 3.0, "until": "rest"}})
    scene = build(case)
    sources = [Source(EVERYWHERE, 0.1, 0.4, 100.0), Source(EVERYWHERE, 0.2, np.inf, 100.0)]
    assert rest_rule(scene, sources) == RestRule(pytest.approx(np.sqrt(2.0)), 0.7)
    assert rest_rule(build(small(STOOD)), sources).earliest == 0.4
    held = {"static": {"boundary": {"bottom": {"type": "fixed", "until": 0.5}}}}
    group = {"name": "weak", "region": [0.0, 0.0, 9.0, 9.0], "pb_ten": 0.5, "time": 0.6}
    hole = {"name": "cut", "type": "circle", "centre": [7.5, 5.0], "radius": 2.0, "stage": "run", "time": 0.8}
    for change, time in ((held, 0.5), (held | {"group": [group]}, 0.6), (held | {"hole": [hole]}, 0.8)):
        assert rest_rule(build(small(STOOD | change)), sources).earliest == time


def test_what_cannot_come_to_rest_is_refused() -> None:
    until = STOOD | {"run": {"duration": 3.0, "until": "rest"}}
    assert problems_in(lambda: small(until | {"load": []})) == [
        'run.until: is "rest", but no [[load]] without a wave has an acceleration by which disks fall; give one'
    ]
    (found,) = problems_in(lambda: small(until | {"material": {"density": 2500.0, "p_wave_speed": 1000.0}}))
    assert found.startswith('run.until: is "rest", but under law = "elastic" nothing falls')
    wall = {"name": "gate", "points": [[20.0, 0.0], [20.0, 5.0]], "velocity": [0.0, 1.0]}
    (found,) = problems_in(lambda: small(until | {"wall": [wall]}))
    assert found == 'wall[1, gate].until: is missing; with run.until = "rest" walls must come to a stop'
    (found,) = problems_in(lambda: small(until | {"run": until["run"] | {"rest_for": 4.0}}))
    assert found == "run.rest_for: is 4, must be at most run.duration, 3 (s)"
