"""Joints in the ground in words, what they did in a run, and warnings."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from dembound.casefile.messages import counted
from dembound.disks.faces.found import Faces, merged
from dembound.disks.faces.tie import JointTie
from dembound.disks.scene import DiskScene
from dembound.disks.stepping.system import DiskSystem
from dembound.kernels.tables.joints import FacePairs
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
    ties = {joint.name: (tie, number) for tie in run.system.joints for number, joint in enumerate(tie.faces.joints)}
    return {name: _describe(*ties[name], run) for name in run.system.scene.lines["joints"]}


def _describe(tie: JointTie, number: int, run: Run) -> dict[str, Any]:
    """Means over the length of overlaps of a joint at the last step, first events, the largest turn beside it."""
    pairs, disks = tie.acting, tie.faces.disk[(tie.faces.part == number) & tie.there]
    own = tie.faces.part[pairs.first] == number
    pairs = FacePairs(*(each[own] for each in pairs))
    length = float(pairs.length.sum())
    means = {"pressure": pairs.pressure, "shear": pairs.shear, "slip": tie.slip(pairs), "opening": pairs.opening}
    means |= {"closed": tie.closed(pairs), "sliding": pairs.slides}
    first = [None if step < 0 else step * run.time_step for step in tie.first[number].tolist()]
    turned = np.abs(run.state.displacement[2, disks] - run.state.datum[2, disks])
    return {
        "overlap": length,
        **{key: float(np.sum(pairs.length * each) / length) if length else None for key, each in means.items()},
        "slides_from": first[0],
        "opens_from": first[1],
        "turn": float(turned.max(initial=0.0)),
        "position": run.scene.positions[disks[turned.argmax()]].tolist() if len(disks) else None,
    }


def first_events(found: Mapping[str, Mapping[str, Any]]) -> Iterator[str]:
    """Which joints slid and opened first, and when; found : of the summary."""
    for key, words in (("slides_from", "slid"), ("opens_from", "opened")):
        times = {name: each[key] for name, each in found.items() if each[key] is not None}
        if times:
            name = min(times, key=lambda name: times[name])
            others = f", {counted(len(times) - 1, 'other')} later" if len(times) > 1 else ""
            yield f"joint {name} {words} from t = {with_unit(times[name], 's')} on{others}"


def joint_warnings(found: Mapping[str, Mapping[str, Any]]) -> Iterator[str]:
    """A warning of each joint beside which a disk has turned too far; found : of the summary."""
    for name, each in found.items():
        if each["turn"] > TURNED:
            x, y = each["position"]
            yield (
                f"joint.{name}: the disk at ({x:.4g}, {y:.4g}) m beside it has turned by {each['turn']:.3g} rad, and "
                "its face with it: the block that it is part of has turned"
            )


def joint_facts(scene: DiskScene) -> Entries:
    """Of every joint, or all of a set or of equal constants, its faces, stiffness and strength."""
    for faces in merged(scene.faces):
        first, *others = (joint.name for joint in faces.joints)
        name = f"joints {first} … {others[-1]}" if others else f"joint {first}"
        yield name, f"{_faces_fact(faces)}; {_stiffness_fact(faces)}; {_strength_fact(faces)}"


def _faces_fact(faces: Faces) -> str:
    """Length, of several joints also their number and what is left out of their set, and number of faces."""
    left, right = faces.split, len(faces.disk) - faces.split
    left_out = sum(joint.left_out for joint in faces.joints)
    parts = [f"{len(faces.joints)} lines"] if len(faces.joints) > 1 else []
    parts.append(with_unit(faces.length, "m"))
    if left_out:
        parts.append(f"{with_unit(left_out, 'm')} left out within three diameters of earlier joints")
    if faces.ended_at:
        parts.append(f"ends before {' and '.join(faces.ended_at)}")
    return f"{', '.join(parts)}, faces of {left} and {right} disks in place of {faces.cut} contacts"


def _stiffness_fact(faces: Faces) -> str:
    """The stiffness asked for, that of the faces, and that of the joint as a whole where it is not what was asked."""
    asked = " and ".join(with_unit(one, "Pa/m") for one in faces.asked.tolist())
    own = [
        [with_unit(one, "Pa/m") for one in np.unique(values[[values.argmin(), values.argmax()]])]
        for values in faces.stiffness
    ]
    of_faces = " and ".join(" to ".join(one) for one in own)
    said = f"kn and ks {asked}, of the faces, in series with the rock, {of_faces}"
    if faces.whole is None or np.abs(faces.whole / faces.asked - 1.0).max() <= MEANT:
        return said
    whole = " and ".join(with_unit(one, "Pa/m") for one in faces.whole.tolist())
    return f"{said}, which are not stiffer than the contacts: as a whole it has {whole}"


def _strength_fact(faces: Faces) -> str:
    """Friction and strengths, or that there are none."""
    joint = faces.joint
    if joint.is_linear:
        return "neither opens nor slides"
    strengths = (("ten", joint.ten), ("coh", joint.coh))
    given = [f"{name} {with_unit(value, 'Pa')}" for name, value in strengths if value > 0.0]
    if joint.dilation:
        end = "" if joint.dilation_end is None else f" up to a slip of {with_unit(joint.dilation_end, 'm')}"
        given.append(f"dilation {joint.dilation:g}°{end}")
    return ", ".join([f"friction {joint.fric:g}", *given])
