"""The ends of a run: by silence, and by the fall of the forces on its driven sides."""

from types import SimpleNamespace

import numpy as np
import pytest
from scene_tables import monitors

from dembound.boundaries import Velocity
from dembound.kinds import kind_of
from dembound.motion.endings import Peak, PeakRule, Silence, Silent, silent_rule
from dembound.motion.paths import Front, Source, first_arrivals, plane_needed
from dembound.motion.sides import Samples
from dembound.table import EVERYWHERE

STEP = 0.5
"""Time step (s) of synthetic runs; exact in binary."""


def ended_at(speeds: np.ndarray, rule: Silent, block: int, observed=lambda record, times: record) -> int | None:
    """Step after which a run with these speeds (k, p) of its probes ends, looked at after blocks of steps."""
    tracker, scene = Silence(rule, STEP), SimpleNamespace(observed=observed)
    run = SimpleNamespace(state=SimpleNamespace(step=0), stopped=False, scene=scene, time_step=STEP)
    record = np.zeros((*speeds.shape, 6))
    record[:, :, 4] = -speeds  # of either sign and component
    for first in range(0, len(speeds), block):
        piece = record[first : first + block]
        run.state.step += len(piece)
        tracker.observe(run, piece)
        tracker_copy = Silence(rule, STEP)
        tracker_copy.restore(tracker.saved_arrays())
        tracker = tracker_copy  # a run continued from its state ends at the same step
        if run.stopped:
            return run.state.step
    return None


def pulse(length: int, first: int, last: int, height: float = 1.0) -> np.ndarray:
    """Zero but for steps first … last."""
    speed = np.zeros(length)
    speed[first : last + 1] = height
    return speed


@pytest.mark.parametrize("block", [1, 7, 100])
def test_a_run_ends_once_all_have_been_silent_for_long_enough(block: int) -> None:
    speeds = np.column_stack([pulse(100, 5, 20), pulse(100, 10, 30)])
    # the last loud step is 30; four seconds are eight steps, and 31 … 38 are the eight silent ones: 39 steps done
    assert ended_at(speeds, Silent(1e-3, 4.0, 0.0), block) == -(-39 // block) * block


def test_the_level_is_that_of_the_peak_so_far() -> None:
    # loud when it came, however small beside what came later
    speeds = (pulse(100, 3, 6, 1e-4) + pulse(100, 12, 15))[:, None]

    assert ended_at(speeds, Silent(1e-2, 4.0, 0.0), 1) == 15 + 9
    assert ended_at(speeds, Silent(1e-2, 2.0, 0.0), 1) == 6 + 5


def test_a_monitor_that_has_not_moved_waits_for_its_waves() -> None:
    speeds = np.column_stack([pulse(100, 5, 10), pulse(100, 40, 45)])

    assert ended_at(speeds, Silent(1e-3, 4.0, 0.0), 1) == 10 + 9  # without waiting the second is missed
    assert ended_at(speeds, Silent(1e-3, 4.0, 18.0), 1) == 45 + 9  # 36 steps, eight before it would end
    assert ended_at(np.zeros((100, 2)), Silent(1e-3, 4.0, 18.0), 1) == 36 + 9


def test_monitors_have_to_be_silent_not_their_nodes() -> None:
    """The place between two nodes that move against each other rests."""
    speeds = np.column_stack([np.full(100, 1.0) + pulse(100, 5, 10), np.full(100, -1.0)])

    assert ended_at(speeds, Silent(1e-3, 4.0, 0.0), 1) is None
    assert ended_at(speeds, Silent(1e-3, 4.0, 0.0), 1, lambda record, _: record.sum(axis=1, keepdims=True)) == 10 + 9


def rule_of(case):
    kind = kind_of(case)
    scene = kind.build(case)
    return silent_rule(scene, kind.sources(scene)), scene


LATER = {"type": "cosine", "amplitude": 1.0, "period": 0.02, "start": 0.5}


def test_a_run_waits_for_the_last_wave_at_the_farthest_monitor(bar) -> None:
    changes = {"monitor": monitors(near=(2.0, 0.5), far=(8.0, 0.5)), "run.until": "silent", "run.duration": 1.0}
    rule, scene = rule_of(bar(changes))
    near, far = scene.positions[[scene.monitors["near"], scene.monitors["far"]], 0]
    assert rule.level == 1e-3
    # P waves from the left at 1000 m/s; from the far one to the left and back, or from the near one to the right
    assert rule.earliest == pytest.approx(0.01 + far / 1000.0, rel=1e-12)
    assert rule.hold == pytest.approx(2.0 * max(far, 10.0 - near) / 1000.0, rel=1e-12)

    load = {"name": "blow", "force": [1.0, 0.0], "position": [9.75, 0.75], "wave": "late"}
    later, scene = rule_of(bar({**changes, "load": [load], "wave.late": LATER}))
    # y is held: P waves only along x, and S waves of 500 m/s across, half of the stiffness being without shear
    near = scene.positions[scene.monitors["near"]]
    assert later.earliest == pytest.approx(0.52 + np.hypot(9.75 - near[0], 0.75 - near[1]) / 500.0, rel=1e-12)
    constant = {"type": "constant", "amplitude": 0.1, "start": 0.2}  # waited for until it comes
    assert rule_of(bar({**changes, "wave.pulse": constant}))[0].earliest == pytest.approx(0.2 + far / 1000.0, rel=1e-12)
    assert rule_of(bar({**changes, "wave.pulse.period": 0.9}))[0].hold == pytest.approx(0.9, rel=1e-12)
    assert rule_of(bar({**changes, "run.silent_for": 0.07, "run.silent_level": 0.2}))[0].hold == 0.07


EVERY = 2
"""Steps between two samples."""


def fallen_at(forces: dict[str, np.ndarray], rule: PeakRule, block: int = 1) -> int | None:
    """Step after which a run with these normal forces (k,) on its driven sides ends, looked at after blocks."""
    sides = ["bottom", "left", *forces]
    boundary = {side: Velocity(type="velocity", wave_p="press") for side in forces}
    scene = SimpleNamespace(sides=dict.fromkeys(sides), case=SimpleNamespace(boundary=boundary))
    steps = EVERY * len(next(iter(forces.values())))
    tracker = Peak(rule, scene, 1.0)
    run = SimpleNamespace(state=SimpleNamespace(step=0), stopped=False)
    while run.state.step < steps:
        later = run.state.step + block
        run.side_samples = Samples.between(run.state.step, later, EVERY, len(sides))
        run.side_samples.record[:] = 1e9  # of sides and components that are not driven
        for side, force in forces.items():
            axis = 0 if side == "right" else 1
            rows = run.side_samples.steps // EVERY
            run.side_samples.record[:, sides.index(side), 3 + axis] = force[rows.clip(max=len(force) - 1)]
        run.state.step = later
        tracker.observe(run, np.zeros((0, 0, 0)))
        continued = Peak(rule, scene, 1.0)
        continued.restore(tracker.saved_arrays())
        tracker = continued  # a run continued from its state ends at the same step
        if run.stopped:
            return run.state.step
    return None


RISING = np.linspace(0.0, 10.0, 101)
PAST = np.concatenate([RISING, np.full(100, 6.9)])
"""Its peak is in sample 100, step 200; from step 202 on it is below 0.7 of it."""


@pytest.mark.parametrize("block", [1, 7, 64])
def test_a_run_ends_once_the_force_has_been_below_for_long_enough(block: int) -> None:
    # the last high step is 200; ten steps are 201 … 210, and the run ends after the next one
    assert fallen_at({"top": -PAST}, PeakRule(0.7, 10.0, 0.0), block) == -(-211 // block) * block
    assert fallen_at({"top": PAST}, PeakRule(0.6, 10.0, 0.0), block) is None
    assert fallen_at({"top": RISING}, PeakRule(0.7, 10.0, 0.0), block) is None


def test_forces_count_from_the_start_and_all_sides_must_have_fallen() -> None:
    later = np.concatenate([np.linspace(0.0, 5.0, 151), np.zeros(50)])

    assert fallen_at({"top": PAST + 1e6}, PeakRule(0.7, 10.0, 0.0)) == 211  # under a confining force
    assert fallen_at({"top": PAST, "right": later}, PeakRule(0.7, 10.0, 0.0)) == 311


def test_waves_at_the_beginning_do_not_end_a_run() -> None:
    ringing = RISING * (1.0 + np.cos(np.arange(101)))  # comes back to zero every six samples

    assert fallen_at({"top": ringing}, PeakRule(0.7, 14.0, 0.0)) is None
    noise = np.concatenate([[0.0, 1e-9], np.zeros(60), PAST])  # a body at rest before its wave begins
    assert fallen_at({"top": noise}, PeakRule(0.7, 10.0, 0.0)) == 2 + 10 + 1
    assert fallen_at({"top": noise}, PeakRule(0.7, 10.0, 130.0)) == 2 * 62 + 211


LEVEL = {"left": (-np.inf, 0.0, np.inf, 0.0), "bottom": (0.0, -np.inf, 0.0, np.inf)}
"""Sources that span the scene: all of the bottom beside a left or right side, all of the left beside bottom or top."""


def source(box, start=0.0):
    return Source(box, start, np.inf, 1.0)


def test_a_front_has_come_its_way_and_the_length_of_its_precursor() -> None:
    # s = 1000 m: (1000 · 0.4² / 8)^(1/3) = 20^(1/3)
    assert Front(500.0, 0.4).reach(2.0) == pytest.approx(1000.0 + 10.0 * 20.0 ** (1.0 / 3.0), rel=1e-14)
    assert Front(500.0, 0.4).reach(-1.0) == 0.0


@pytest.mark.parametrize(
    ("side", "plane", "place", "way"),
    [
        ("right", 10.0, (7.0, 6.0), np.hypot(7.0 + 3.0, 4.0)),  # from (3, 2): 7 m there, 3 m back, 4 m up
        ("left", -1.0, (7.0, 6.0), np.hypot(4.0 + 8.0, 4.0)),
        ("top", 9.0, (7.0, 6.0), np.hypot(4.0, 7.0 + 3.0)),
        ("bottom", -2.0, (7.0, 6.0), np.hypot(4.0, 4.0 + 8.0)),
    ],
)
def test_a_way_over_a_side_is_that_to_the_mirror_image(side: str, plane: float, place, way: float) -> None:
    at = np.array([place])
    found = source((3.0, 2.0, 3.0, 2.0)).distance_over(side, plane, at)

    assert found == pytest.approx([way], rel=1e-15)
    assert source((3.0, 2.0, 3.0, 2.0)).distance(at) == pytest.approx([np.hypot(4.0, 4.0)], rel=1e-15)
    np.testing.assert_array_equal(at, [place])


@pytest.mark.parametrize(
    ("side", "box"),
    [
        ("left", (3.0, 2.0, 3.0, 2.0)),
        ("right", (2.0, 1.0, 30.0, 30.0)),
        ("bottom", LEVEL["left"]),
        ("top", LEVEL["bottom"]),
        ("top", EVERYWHERE),
    ],
)
def test_at_the_plane_needed_the_last_way_is_as_long_as_waves_get(side: str, box) -> None:
    rng = np.random.default_rng(3)
    places, front = rng.uniform(0.0, 10.0, (5, 2)), Front(100.0, 0.1)
    sources = [source(box, 0.01), source((4.0, 4.0, 4.0, 4.0), 0.02)]
    plane = plane_needed(side, sources, places, front, 0.3)
    spare = [(each.distance_over(side, plane, places) - front.reach(0.3 - each.start)).min() for each in sources]

    assert min(spare) == pytest.approx(0.0, abs=1e-12)


def test_the_first_arrival_is_that_of_the_nearest_way_and_the_earliest_source() -> None:
    left = Source((0.0, -np.inf, 0.0, np.inf), 2.0, 3.0, 1.0)
    point = Source((8.0, 0.0, 8.0, 0.0), 5.0, 6.0, 1.0)
    places = np.array([[4.0, 9.0], [8.0, 3.0], [12.0, 0.0]])
    assert first_arrivals([left, point], Front(2.0, 0.1), places) == pytest.approx([4.0, 6.0, 7.0])
    assert np.isinf(first_arrivals([], Front(2.0, 0.1), places)).all()
