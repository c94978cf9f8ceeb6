"""Joints in the ground, in words."""

from dembound.disks.faces.found import Faces
from dembound.disks.scene import DiskScene
from dembound.words import Entries, with_unit


def joint_facts(scene: DiskScene) -> Entries:
    """Of every joint its faces, stiffness and strength."""
    for faces in scene.faces:
        yield f"joint {faces.joint.name}", f"{_faces_fact(faces)}; {_stiffness_fact(faces)}; {_strength_fact(faces)}"


def _faces_fact(faces: Faces) -> str:
    """Length, and number of faces on both sides."""
    left, right = faces.split, len(faces.disk) - faces.split
    return f"{with_unit(faces.length, 'm')}, faces of {left} and {right} disks in place of {faces.cut} contacts"


def _stiffness_fact(faces: Faces) -> str:
    """The stiffness asked for, and that of the faces."""
    asked = faces.joint.kn, faces.joint.ks
    names, own = ("kn", "ks"), faces.stiffness.tolist()
    each = [f"{name} {with_unit(one, 'Pa/m')}" for name, one in zip(names, asked, strict=True)]
    of_faces = " and ".join(with_unit(one, "Pa/m") for one in own)
    return f"{', '.join(each)}, of the faces, with the contacts in series, {of_faces}"


def _strength_fact(faces: Faces) -> str:
    """Friction and strengths, or that there are none."""
    joint = faces.joint
    if joint.is_linear:
        return "neither opens nor slides"
    strengths = (("ten", joint.ten), ("coh", joint.coh))
    given = [f"{name} {with_unit(value, 'Pa')}" for name, value in strengths if value > 0.0]
    return ", ".join([f"friction {joint.fric:g}", *given])
