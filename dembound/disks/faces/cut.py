"""Cuts the ground along the joints of a case: all their faces, and the contacts that are left."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.joint import joint_ends
from dembound.casefile.messages import numbered
from dembound.disks.faces.found import Faces, alike, faces_of
from dembound.disks.faces.series import with_rock
from dembound.disks.material.packed_material import PackedMaterial
from dembound.errors import CaseError
from dembound.packings.tiling import Assembly


def with_joints(
    case: DiskCase,
    ground: PackedMaterial,
    assembly: Assembly,
    begin: int,
    before: tuple[Sequence[Faces], np.ndarray] | None = None,
) -> tuple[Assembly, tuple[Faces, ...]]:
    """An assembly without the contacts that the joints of a case replace, and their faces.

    begin : number of the first disk of the body, which follows those of columns. before : the faces before an
    excavation, and the disks (k,) left of the body then; those that are left stay as they were.
    """
    if before is not None:
        faces = _left(*before, begin)
    else:
        faces = tuple(with_rock(each, ground, assembly) for each in _found(case, ground, assembly, begin))
    for each in faces:
        assembly = _cut(assembly, each)
    return assembly, faces


def _cut(assembly: Assembly, faces: Faces) -> Assembly:
    """An assembly without the contacts across a joint."""
    kept = faces.side[assembly.pairs].prod(axis=1) >= 0
    return replace(assembly, pairs=assembly.pairs[kept], contact_type=assembly.contact_type[kept])


def _found(case: DiskCase, ground: PackedMaterial, assembly: Assembly, begin: int) -> tuple[Faces, ...]:
    """The faces of all joints of a case, see `with_joints`; raises CaseError for joints without any."""
    body, ends = slice(begin, len(assembly.radii)), joint_ends(case.boundary, case.intact, 2.0 * case.packing.radius)
    found = list[Faces]()
    for joint in case.joint:
        found.append(faces_of(joint, ground, assembly, body, case.packing.box, ends, found))
        assembly = _cut(assembly, found[-1])
    faces = tuple(each for each in found if (each.has_two_sides and each.cut) or not each.joint.is_of_set)
    if nowhere := [
        place
        for (place, _), each in zip(numbered("joint", case.joint), found, strict=True)
        if not each.cut and not each.joint.is_of_set
    ]:
        beside = "of the ground that is not beside a side beyond which ground goes on" if ends else "of the ground"
        raise CaseError(
            [f"{place}.points: has no disks on both sides, must cross a part {beside}" for place in nowhere]
        )
    return faces if len(faces) == 1 else _with_means(faces, ground, assembly)


def _with_means(faces: tuple[Faces, ...], ground: PackedMaterial, assembly: Assembly) -> tuple[Faces, ...]:
    """Faces with the mean stiffness of the contacts that all joints of the same constants replace, by layer.

    The contacts of one line are too few for a mean.
    """
    zones = {each.joint.name: ground.zone_of(assembly.positions[each.disk]) for each in faces}
    found = {each.joint.name: each.removed.copy() for each in faces}
    for group in alike(faces):
        for zone in np.unique(np.concatenate([zones[each.joint.name] for each in group])):
            there = [each for each in group if zone in zones[each.joint.name]]
            own = [each.removed[:, zones[each.joint.name] == zone][:, 0] for each in there]
            mean = np.average(own, axis=0, weights=[each.length for each in there])
            for each in there:
                found[each.joint.name][:, zones[each.joint.name] == zone] = mean[:, None]
    return tuple(replace(each, removed=found[each.joint.name]) for each in faces)


def _left(before: Sequence[Faces], kept: np.ndarray, begin: int) -> tuple[Faces, ...]:
    """The faces that are left of joints, without joints of which one side is gone; see `Faces.among`."""
    return tuple(each for each in (faces.among(kept, begin) for faces in before) if each.has_two_sides)
