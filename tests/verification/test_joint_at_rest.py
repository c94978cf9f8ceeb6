"""A joint in ground at rest bears the stress of the ground, and nothing moves once the run begins."""

import numpy as np

from dembound.disks.rest.stage import settle
from dembound.disks.scene import build
from dembound.kinds import with_changes

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
