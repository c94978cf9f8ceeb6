"""Joints in words, in the summary and in warnings."""

import json

import numpy as np
import tomli_w
from small_cases import PUSHED

from dembound.disks.scene import build
from dembound.kinds import loads
from dembound.kinds.disks.joints import describe_joints, joint_facts, joint_warnings
from dembound.motion.simulation import Simulation

JOINT = {"name": "fault", "points": [[5.0, -1.0], [5.0, 4.0]], "kn": 1e10, "ks": 5e9, "fric": 0.5, "coh": 2e5}


def test_what_a_joint_is_and_has_done():
    scene = build(loads(tomli_w.dumps(PUSHED | {"joint": [JOINT]})))
    ((name, text),) = joint_facts(scene)
    assert name == "joint fault"
    assert text.startswith(
        "2.5 m, faces of 5 and 5 disks in place of 5 contacts; kn and ks 10 GPa/m and 5 GPa/m, of the faces"
    )
    assert text.endswith("; friction 0.5, coh 200 kPa")

    simulation = Simulation(scene, 3e-4)
    simulation.run(60)
    found = json.loads(json.dumps(describe_joints(simulation), allow_nan=False))
    means = {"overlap", "pressure", "shear", "slip", "opening", "closed", "sliding"}
    assert found["fault"].keys() == means | {"slides_from", "opens_from", "turn", "position"}
    np.testing.assert_allclose(found["fault"]["overlap"], 2.5, rtol=1e-3)
    assert not [*joint_warnings(found)]
    (line,) = joint_warnings({"fault": found["fault"] | {"turn": 0.2}})
    assert line.startswith("joint.fault: the disk at (")
