"""A joint in ground at rest bears the stress of the ground, and nothing moves once the run begins."""

import numpy as np
import pytest
import tomli_w

from dembound.disks.rest.stage import settle
from dembound.disks.scene import build
from dembound.kinds import loads, with_changes

ROLLERS = {"left": {"type": "roller"}, "right": {"type": "roller"}, "bottom": {"type": "fixed"}}
SIDES = {"left": "viscous", "right": "viscous", "bottom": {"type": "viscous_input", "wave_s": "pulse"}}
LINE = [[2.0, 3.0], [8.0, 6.0]]


def test_an_inclined_joint_bears_the_stress_at_rest(lab):
    wave = {"type": "cosine", "amplitude": 0.5, "period": 0.05, "start": 100.0}
    case = lab.case(
        "A", (10.0, 10.0), held=(), boundary=SIDES, wave=wave, load=[{"acceleration": [0.0, -9.81]}],
        static={"k0": 0.5, "boundary": ROLLERS},
    )  # fmt: skip
    joint = {"name": "joint", "points": LINE, "kn": 1e10, "ks": 1e10, "fric": 0.6}
    scene = build(with_changes(case, {"joint": [joint]}))
    settled = settle(scene)
    simulation = lab.simulation(scene, settled.start)
    tie = simulation.system.joints[0]
    pairs, faces = tie.acting, tie.faces
    place = faces.ends[pairs.first].mean(axis=1)
    xx, yy, _ = scene.at_rest.at(*place.T[::-1])
    t = faces.along[0]
    pressure, shear = -(xx * t[1] ** 2 + yy * t[0] ** 2), -(yy - xx) * t[0] * t[1]
    # stresses at the ends of the line grow where it yields more than the ground: over all of it by some percent
    length = pairs.length
    np.testing.assert_allclose(np.sum(length * pairs.pressure), np.sum(length * pressure), rtol=0.03)
    np.testing.assert_allclose(np.sum(length * pairs.shear), np.sum(length * shear), rtol=0.15)

    simulation.run(1000)
    assert np.abs(simulation.state.velocity).max() < 1e-12
    # what it remembers is part of the state of a run
    arrays = simulation.state.arrays()
    other = lab.simulation(scene, settle(scene).start)
    other.state.take(arrays)
    for run in (simulation, other):
        run.state.velocity = 1e-3 * np.cos(np.arange(3 * scene.count)).reshape(3, -1)
        run.run(1200)
    assert np.array_equal(simulation.state.u, other.state.u)
    assert np.array_equal(simulation.state.work, other.state.work)
    steps = np.array([simulation.state.step - 1])
    assert np.array_equal(simulation.system.joint_samples(steps), other.system.joint_samples(steps))
    assert np.array_equal(tie.first, other.system.joints[0].first)


SLOPE = {
    "ground": {"surface": [[0.0, 12.0], [9.0, 12.0], [15.0, 6.0], [24.0, 6.0]]},
    "packing": {"pattern": "B", "size": [24.0, 12.0], "brick": [6.0, 6.0], "radius": 0.5, "radius_ratio": 1.5},
    "material": {"law": "linearpbond", "density": 2500.0, "p_wave_speed": 1000.0, "fric": 0.5}
    | {"pb_ten": 5e6, "pb_coh": 5e6, "quality_factor": 20.0},
    "layer": [{"bottom": 9.0, "p_wave_speed": 700.0}, {}],
    "joint": [{"name": "bedding", "points": [[-1.0, 12.0], [17.0, 6.0]], "kn": 1e9, "ks": 1e9, "fric": 0.6}],
    "load": [{"name": "weight", "acceleration": [0.0, -9.81]}],
    "static": {"k0": 0.5, "boundary": {side: {"type": "roller"} for side in ("left", "right", "bottom")}},
    "boundary": {"left": {"type": "free_field"}, "right": {"type": "free_field"}, "bottom": {"type": "viscous"}},
    "run": {"duration": 0.1},
}


@pytest.mark.slow
def test_a_slope_stands_on_a_joint_that_dips_out_of_it(lab):
    scene = build(loads(tomli_w.dumps(SLOPE)))
    simulation = lab.simulation(scene, settle(scene).start)
    pairs = simulation.system.joints[0].acting
    # the dip, atan(1/3), is below the angle of friction: no part of the joint slides further
    assert np.sum(pairs.length * pairs.pressure) > 2.0 * np.abs(np.sum(pairs.length * pairs.shear)) > 0.0
    simulation.run(500)
    # beside waves of millimetres per second; what has slid while it settled creeps to its limit
    assert np.abs(simulation.state.velocity).max() < 1e-8


@pytest.mark.slow
@pytest.mark.parametrize("law", ["elastic", "linearpbond"])
def test_what_an_excavation_leaves_rests_on_the_faces_that_are_left(lab, law):
    level = 3.0
    strength = {} if law == "elastic" else {"law": law, "fric": 0.5}
    case = lab.case(
        "A", (10.0, 6.0), held=(), material=strength, boundary={"bottom": {"type": "fixed", "artificial": False}},
        load=[{"acceleration": [0.0, -9.81]}], static={"boundary": {"bottom": {"type": "fixed"}}},
    )  # fmt: skip
    joint = {"name": "joint", "points": [[-1.0, level], [11.0, level]], "kn": 1e9, "ks": 1e9, "fric": 0.3}
    pit = {"name": "pit", "type": "rectangle", "corners": [4.0, 2.0, 7.0, 7.0], "stage": "after"}
    scene = build(with_changes(case, {"joint": [joint], "hole": [pit]}))
    settled = settle(scene)
    simulation = lab.simulation(scene, settled.start)
    pairs, faces = simulation.system.joints[0].acting, scene.faces[0]
    # two blocks, each on its own faces: nothing else bears them
    push, x = pairs.length * pairs.pressure, faces.ends[pairs.first, 0, 0]
    assert (scene.before.faces[0].split, faces.split, len(faces.disk)) == (20, 14, 28)
    for inside in (x < 5.0, x > 5.0):
        place = scene.positions[:, 0]
        block = (scene.positions[:, 1] > level) & ((place < 5.0) == (x[inside][0] < 5.0))
        np.testing.assert_allclose(
            push[inside].sum(), 9.81 * scene.mass[block].sum(), rtol=1e-4
        )  # static.ratio is 1e-5
    simulation.run(500)
    assert np.abs(simulation.state.velocity).max() < 1e-12
