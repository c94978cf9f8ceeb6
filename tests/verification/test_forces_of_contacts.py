"""Claim: the contact forces of the record are in equilibrium with the weight of every disk of a body at rest.

Whatever the law, and with contacts that have slid or bonds that have broken. Forces are those of the snapshot alone:
normal and shear force along and across the vector of each contact.
"""

import h5py
import numpy as np
import pytest

from dembound.kinds import with_changes
from dembound.running import run_case

GRAVITY = 9.81
RATIO = 1e-7
LOCKED = {"law": "linearpbond", "fric": 0.5, "locked_in": 5e6}
WEAK = {"law": "linearpbond", "fric": 0.5, "pb_ten": 2e4, "pb_coh": 2e4}
ROLLER = {"type": "roller"}


@pytest.mark.parametrize(
    ("material", "law"),
    [({}, "elastic"), (LOCKED, "linearpbond"), (WEAK, "linearpbond")],
    ids=["elastic", "locked in", "broken"],
)
def test_contacts_carry_the_weight_of_every_disk(lab, tmp_path, material: dict, law: str) -> None:
    case = lab.case(
        "B",
        (6.0, 6.0),
        held=(),
        material=material,
        brick=(6.0, 6.0),
        boundary=dict.fromkeys(("left", "right"), "roller"),
        load=[{"acceleration": (0.0, -GRAVITY)}],
        static={"ratio": RATIO, "boundary": dict.fromkeys(("left", "right", "bottom"), ROLLER)},
        duration=1e-3,
    )
    case = with_changes(case, {"output.contacts": True, "output.pictures": False})
    with h5py.File(run_case(case, tmp_path) / "run.h5") as file:
        last = list(file["snapshots"].values())[-1]
        pairs, vector, normal, shear, bonded = (
            last["contacts"][name][:] for name in ("particles", "vector", "normal_force", "shear_force", "bonded")
        )
        positions, radii = file["particles/position"][:], file["particles/radius"][:]
        broken = len(file["cracks/time"])
        assert file["laws/name"].asstr()[:].tolist() == [law]
    along = vector / np.hypot(*vector.T)[:, None]
    force = normal[:, None] * along + shear[:, None] * np.column_stack([-along[:, 1], along[:, 0]])
    total = np.zeros((len(radii), 2))
    np.add.at(total, pairs[:, 0], force)
    np.add.at(total, pairs[:, 1], -force)

    assert (broken > 0) == (material is WEAK) == (not bonded.all())
    assert (normal < 0.0).any()
    scene = lab.scene("B", (6.0, 6.0), held=(), brick=(6.0, 6.0))
    weight = GRAVITY * scene.mass
    np.testing.assert_allclose(positions, scene.positions, atol=1e-12)
    # the stage ends when the mean unbalanced force is RATIO of the mean contact force; on one disk it may be all of it
    left = len(radii) * RATIO * np.hypot(normal, shear).mean()
    assert left < 1e-2 * weight.min()
    # smooth sides carry what is across them
    for axis, sides, expected in ((0, ("left", "right"), 0.0 * weight), (1, ("bottom",), weight)):
        inner = np.setdiff1d(np.arange(len(radii)), np.concatenate([scene.edges[side].nodes for side in sides]))
        np.testing.assert_allclose(total[inner, axis], expected[inner], rtol=0.0, atol=left)
