"""Joints in the ground in words, what they did in a run, and warnings."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from dembound.disks.faces.found import Faces
from dembound.disks.faces.tie import JointTie
from dembound.disks.scene import DiskScene
from dembound.disks.stepping.system import DiskSystem
from dembound.motion.trackers import Run
from dembound.words import Entries, with_unit

TURNED = 0.1
"""Rotation (rad) of a disk beside a joint from which on it is warned of: its face has turned out of the line."""

MEANT = 0.02
"""Relative difference of the stiffness of a joint from that asked for that `check` tells."""


def describe_joints(run: Run) -> dict[str, dict[str, Any]]:
    """What each joint of a run of disks has done, by name, see `docs/reference/results.md`; empty without joints."""
    if not isinstance(run.system, DiskSystem):
        return {}
    return {joint.faces.joint.name: _describe(joint, run) for joint in run.system.joints}


def _describe(joint: JointTie, run: Run) -> dict[str, Any]:
    """Means over the length of overlaps at the last step, and the largest turn of a disk with a face."""
    pairs, disks = joint.acting, joint.faces.disk
    length = float(pairs.length.sum())
    closed = (pairs.pressure > 0.0) | pairs.intact | joint.faces.joint.is_linear
    means = {"pressure": pairs.pressure, "shear": pairs.shear, "slip": pairs.slip, "closed": closed}
    turned = np.abs(run.state.displacement[2, disks] - run.state.datum[2, disks])
    return {
        "overlap": length,
        **{key: float(np.sum(pairs.length * each) / length) if length else None for key, each in means.items()},
        "turn": float(turned.max()),
        "position": run.scene.positions[disks[turned.argmax()]].tolist(),
    }


def joint_warnings(found: Mapping[str, Mapping[str, Any]]) -> Iterator[str]:
    """A warning of each joint beside which a disk has turned too far; found : of the summary."""
    for name, each in found.items():
        if each["turn"] > TURNED:
            x, y = each["position"]
            yield (
                f"joint.{name}: the disk at ({x:.4g}, {y:.4g}) m beside it has turned by {each['turn']:.3g} rad, and "
                "its face with it, as if it were a part of a block: it has lost its bonds, or the block has turned"
            )


def joint_facts(scene: DiskScene) -> Entries:
    """Of every joint its faces, stiffness and strength."""
    for faces in scene.faces:
        yield f"joint {faces.joint.name}", f"{_faces_fact(faces)}; {_stiffness_fact(faces)}; {_strength_fact(faces)}"


def _faces_fact(faces: Faces) -> str:
    """Length, and number of faces on both sides."""
    left, right = faces.split, len(faces.disk) - faces.split
    return f"{with_unit(faces.length, 'm')}, faces of {left} and {right} disks in place of {faces.cut} contacts"


def _stiffness_fact(faces: Faces) -> str:
    """The stiffness asked for, that of the faces, and that of the joint as a whole where it is not what was asked."""
    asked, own, whole = (
        " and ".join(with_unit(one, "Pa/m") for one in each.tolist())
        for each in (faces.asked, faces.stiffness, faces.whole)
    )
    said = f"kn and ks {asked}, of the faces, in series with the rock, {own}"
    if not np.abs(faces.whole / faces.asked - 1.0).max() > MEANT:  # nan where it is not known
        return said
    return f"{said}, which are not stiffer than the contacts: as a whole it has {whole}"


def _strength_fact(faces: Faces) -> str:
    """Friction and strengths, or that there are none."""
    joint = faces.joint
    if joint.is_linear:
        return "neither opens nor slides"
    strengths = (("ten", joint.ten), ("coh", joint.coh))
    given = [f"{name} {with_unit(value, 'Pa')}" for name, value in strengths if value > 0.0]
    return ", ".join([f"friction {joint.fric:g}", *given])
