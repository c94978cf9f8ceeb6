"""The history of all joints: saved, of what an excavation leaves, and its cracks."""

from collections.abc import Sequence

import numpy as np

from dembound.disks.faces.found import Faces, merged
from dembound.disks.faces.tie import ROOM, JointTie, empty_pairs
from dembound.kernels.joint_notes import PAIRS
from dembound.motion.part import Cracks, joined
from dembound.motion.state import Arrays, arrays_of_owner
from dembound.words import with_unit


def states_of(ties: Sequence[JointTie]) -> dict[str, np.ndarray]:
    """The arrays of all joints, copied, by the names of joint and array."""
    return {f"{tie.name}/{name}": values.copy() for tie in ties for name, values in tie.saved_arrays().items()}


def states_among(
    states: Arrays, before: Sequence[Faces], after: Sequence[Faces], kept: np.ndarray
) -> dict[str, np.ndarray]:
    """The arrays of joints (`states_of`) of which only the faces of disks kept (k,) are left after an excavation."""
    of_constants = {each.joint.constants: each for each in merged(before)}
    found: dict[str, np.ndarray] = {}
    for faces in merged(after):
        whole, names = of_constants[faces.joint.constants], [joint.name for joint in faces.joints]
        stays = np.array([joint.name in names for joint in whole.joints])
        saved, left = arrays_of_owner(states, f"joint_{whole.joint.name}"), whole.left_of(kept) & stays[whole.part]
        number, room = np.cumsum(left) - 1, ROOM * len(faces.disk)
        first, second = (saved[f"pair_{name}"][: saved["counts"][PAIRS]] for name in ("first", "second"))
        chosen = np.flatnonzero(left[first] & left[second])
        own = {"listed": saved["listed"][left], "ends": saved["ends"][left], "first": saved["first"][stays]}
        own |= {"events": np.zeros((room, 6)), "counts": np.array([len(chosen), 0, 0, len(chosen), 0])}
        for name, empty in empty_pairs(room)._asdict().items():
            values = saved[f"pair_{name}"][chosen]
            empty[: len(chosen)] = number[values] if name in ("first", "second") else values
            own[f"pair_{name}"] = empty
        found |= {f"joint_{faces.joint.name}/{name}": values for name, values in own.items()}
    return found


def most_slipped(ties: Sequence[JointTie]) -> str:
    """The joint with the largest slip of pairs that slide, as words after others; empty if none slides."""
    most, name = 0.0, ""
    for tie in ties:
        pairs = tie.acting
        slip = np.where(pairs.slides, np.abs(tie.slip(pairs)), 0.0)
        if slip.max(initial=0.0) > most:
            most, name = float(slip.max()), tie.faces.joints[tie.faces.part[pairs.first[np.argmax(slip)]]].name
    return f"; joint {name} slides, so far by up to {with_unit(most, 'm')}" if name else ""


def cracks_of(ties: Sequence[JointTie]) -> Cracks:
    """The places of all joints that lost their strength since the last call."""
    return joined([tie.take_cracks() for tie in ties])
