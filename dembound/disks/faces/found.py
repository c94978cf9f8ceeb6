"""The faces of joints: which disks lie on which side of a joint, and which part of its line belongs to each."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from dembound.casefile.disks.joint import Joint, ends_on
from dembound.disks.faces.line import Line
from dembound.disks.material.packed_material import PackedMaterial
from dembound.packings.tiling import Assembly
from dembound.table import Box

BESIDE = 1.5
"""Distance from a joint, over the largest diameter, within which disks keep their side of it for good."""

NEAR = 2.5
"""Distance from a joint, over the largest radius, within which disks may have a part of its line."""

LOOSE = 6
"""Disks of a piece that the joint cuts off and that counts as one of its other side, if there are fewer.

The smallest blocks between joints, of three diameters each way, have some nine."""

AT_END = 4.0
"""Distance from an end on another joint, over the largest diameter, within which disks beyond that are left out."""


@dataclass(frozen=True, eq=False)
class Faces:
    """The m faces of a joint, those of the disks on the left of its line before those on the right.

    Also those of several joints of the same constants, see `merged`, whose sides are not in one array.

    Attributes
    ----------
    joints : their tables; part : (m,) number of that of each face. split : number of faces on the left. disk : (m,) of
    each, among the scene's. ends : (m, 2, 2) m, of each face at the start. along : (m, 2) unit vector along the line.
    side : (n,) 1 for disks of the scene that are on the left beside the joint for good, −1 on the right, 0 for others.
    removed : (2, m) Pa/m, normal and shear stiffness per area of the contacts that it replaces, in the ground of each
    face. cut : number of these. ended_at : sides before which it ends, as ground goes on beyond them.
    rock : (2, m) m/Pa, compliance of the rock that the faces stand for, beside that of the joint, and whole : (2,)
    Pa/m, normal and shear stiffness of the joint, as measured in its packing, see series.py; None where they were not.
    """

    joints: tuple[Joint, ...]
    part: np.ndarray
    split: int
    disk: np.ndarray
    ends: np.ndarray
    along: np.ndarray
    side: np.ndarray
    removed: np.ndarray
    cut: int
    ended_at: tuple[str, ...] = ()
    rock: np.ndarray | None = None
    whole: np.ndarray | None = None

    @property
    def joint(self) -> Joint:
        """The table of the only joint, or the first of the same constants."""
        return self.joints[0]

    @property
    def length(self) -> float:
        """Length (m) of the faces on the left."""
        return float(np.hypot(*(self.ends[: self.split, 1] - self.ends[: self.split, 0]).T).sum())

    def among(self, kept: np.ndarray, begin: int) -> Faces:
        """The faces of disks that are left of a body: kept (k,) before, numbered from `begin` on, after others."""
        number = np.full(len(self.side), -1)
        number[kept] = begin + np.arange(len(kept))
        left = self.left_of(kept)
        side = np.concatenate([np.zeros(begin, np.int8), self.side[kept]])
        return replace(
            self,
            part=self.part[left],
            split=int(np.count_nonzero(left[: self.split])),
            disk=number[self.disk[left]],
            ends=self.ends[left],
            along=self.along[left],
            side=side,
            removed=self.removed[:, left],
            rock=None if self.rock is None else self.rock[:, left],
        )

    def left_of(self, kept: np.ndarray) -> np.ndarray:
        """Whether each face (m,) is that of a disk among those kept (k,)."""
        return np.isin(self.disk, kept)

    @property
    def has_two_sides(self) -> bool:
        """Whether there are faces on both sides."""
        return 0 < self.split < len(self.disk)

    @property
    def asked(self) -> np.ndarray:
        """Normal and shear stiffness (2,) Pa/m that the joint is to have."""
        return np.array([self.joint.kn, self.joint.ks])

    @property
    def stiffness(self) -> np.ndarray:
        """Normal and shear stiffness (2, m) Pa/m of the faces: with that of the rock in series, those asked for.

        That of the rock is as measured, else that of the removed contacts.
        """
        asked = self.asked[:, None]
        if self.rock is not None:
            return np.asarray(1.0 / (1.0 / asked + self.rock))
        found: np.ndarray = asked * self.removed / (asked + self.removed)
        return found

    @property
    def compliance(self) -> np.ndarray:
        """Compliance (2, m) m/Pa of the rock that the faces stand for."""
        return np.asarray(1.0 / self.removed) if self.rock is None else self.rock


def in_series(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Stiffness between faces of these stiffnesses: each gives by half of what its own says."""
    return np.where(one == other, one, 2.0 * one * other / (one + other))


def faces_of(
    joint: Joint,
    ground: PackedMaterial,
    assembly: Assembly,
    body: slice,
    box: Box,
    ends: Mapping[str, float],
    earlier: Sequence[Faces] = (),
) -> Faces:
    """The faces of a joint in a body: the range of its disks, in a box left, bottom, right, top (m).

    Ends of the line inside the box are those of whole cells: a joint has the faces of the disks beside it. Where it
    ends on the line of an earlier joint, it ends there, and has no faces of disks beyond. ends : m, how far from some
    sides the line ends, see `joint_ends`.
    """
    line, largest = Line(np.array(joint.points), box, ends), 2.0 * float(assembly.radii.max())
    distance, place = line.nearest(assembly.positions)
    beyond = np.zeros(len(distance), dtype=np.bool_)
    for other in earlier:
        for end in np.flatnonzero(ends_on(np.array(joint.points), np.array(other.joint.points), 0.5 * largest)):
            near_end = (place if end == 0 else line.length - place) < AT_END * largest
            beyond |= near_end & _is_across(other, line.points[[0, 1] if end == 0 else [-1, -2]], assembly, box)
            line.open[end] = line.held[end] = True
    distance, place = line.nearest(assembly.positions)
    within = np.zeros(len(distance), dtype=np.bool_)
    within[body] = (place[body] > 0.0) & (place[body] < line.length)
    side = np.where(distance >= 0.0, 1, -1)
    side = np.where(within & ~beyond & (np.abs(distance) <= BESIDE * largest), side, 0)
    side = _by_contacts(assembly, side)
    crossing = side[assembly.pairs].prod(axis=1) < 0
    touching = np.zeros(len(side), dtype=np.bool_)
    touching[assembly.pairs.ravel()] = True
    near = np.abs(distance) <= NEAR * float(assembly.radii.max())
    near[: body.start] = near[body.stop :] = False
    near &= ~beyond
    found: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []
    split = 0
    for way in (1, -1):
        own = np.flatnonzero(near & touching & np.where(side != 0, side == way, way * distance >= 0.0))
        found += line.faces(own, side, assembly.positions, assembly.radii)
        split = sum(len(each[0]) for each in found) if way == 1 else split
    disk, parts, along = (np.concatenate(columns) for columns in zip(*found, strict=True))
    part, removed, sides = np.zeros(len(disk), dtype=np.int64), np.zeros((2, len(disk))), side.astype(np.int8)
    faces = Faces((joint,), part, split, disk, parts, along, sides, removed, int(crossing.sum()))
    if not (faces.has_two_sides and crossing.any()):
        return faces
    there = [np.abs(parts - point).max(axis=2).min() < 2.0 * assembly.radii.max() for point in line.points[[0, -1]]]
    ended_at = tuple(side for side, is_there in zip(line.ended_at, there, strict=True) if side and is_there)
    return replace(faces, removed=_stiffness(faces, ground, assembly, crossing), ended_at=ended_at)


def _is_across(other: Faces, way: np.ndarray, assembly: Assembly, box: Box) -> np.ndarray:
    """Disks (n,) on the other side of a joint than the second of two points (2, 2) m, of which the first is on it."""
    line = Line(np.array(other.joint.points), box, {})
    distance, _ = line.nearest(np.vstack([0.5 * (way[0] + way[1]), assembly.positions]))
    side = np.where(other.side != 0, other.side, np.sign(distance[1:]))
    across: np.ndarray = side * np.sign(distance[0]) < 0.0
    return across


def alike(faces: Sequence[Faces]) -> list[list[Faces]]:
    """The joints of the same constants together, as those of a set, in the order of the first of each."""
    groups: dict[tuple[object, ...], list[Faces]] = {}
    for each in faces:
        groups.setdefault(each.joint.constants, []).append(each)
    return list(groups.values())


def merged(faces: Sequence[Faces]) -> tuple[Faces, ...]:
    """The faces of all joints, those of the same constants as one."""
    return tuple(_as_one(group) for group in alike(faces))


def _as_one(faces: Sequence[Faces]) -> Faces:
    """The faces of several joints of the same constants as those of one."""
    if len(faces) == 1:
        return faces[0]
    order = [(each, slice(0, each.split)) for each in faces] + [(each, slice(each.split, None)) for each in faces]
    number, known = {id(each): k for k, each in enumerate(faces)}, [each for each in faces if each.whole is not None]
    weights = [each.length for each in known]
    return Faces(
        joints=tuple(each.joint for each in faces),
        part=np.concatenate([np.full(len(each.disk[own]), number[id(each)]) for each, own in order]),
        split=sum(each.split for each in faces),
        disk=np.concatenate([each.disk[own] for each, own in order]),
        ends=np.concatenate([each.ends[own] for each, own in order]),
        along=np.concatenate([each.along[own] for each, own in order]),
        side=np.zeros(0, dtype=np.int8),
        removed=np.concatenate([each.removed[:, own] for each, own in order], axis=1),
        cut=sum(each.cut for each in faces),
        ended_at=tuple(dict.fromkeys(side for each in faces for side in each.ended_at)),
        rock=np.concatenate([each.compliance[:, own] for each, own in order], axis=1),
        whole=np.average([each.whole for each in known], axis=0, weights=weights) if known else None,
    )


def numbers_beside(faces: Sequence[Faces]) -> np.ndarray | None:
    """Numbers (n, k) of the joints that each disk is beside, negative on the right of them, else 0; None without any.

    faces : of each joint. Disks of opposite numbers never touch.
    """
    if not faces:
        return None
    count = np.zeros(len(faces[0].side), dtype=np.int64)
    columns = [np.zeros_like(count)]
    for number, each in enumerate(faces, start=1):
        beside = np.flatnonzero(each.side)
        while len(columns) <= count[beside].max(initial=0):
            columns.append(np.zeros_like(count))
        for place in np.unique(count[beside]):
            own = beside[count[beside] == place]
            columns[place][own] = number * each.side[own].astype(np.int64)
        count[beside] += 1
    return np.stack(columns, axis=1)


def _by_contacts(assembly: Assembly, side: np.ndarray) -> np.ndarray:
    """Sides (n,) with small pieces that touch only disks of the other side given to that side."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    first, second = assembly.pairs.T
    for _ in range(LOOSE):
        crossing = side[first] * side[second] < 0
        kept = (np.ones(np.count_nonzero(~crossing), np.int8), (first[~crossing], second[~crossing]))
        _, piece = connected_components(coo_matrix(kept, shape=(len(side), len(side))), directed=False)
        sizes = np.bincount(piece)
        across = np.zeros(len(sizes), dtype=np.bool_)
        across[piece[np.concatenate([first[crossing], second[crossing]])]] = True
        few = across & (sizes < min(LOOSE, sizes.max() / 4))
        if not few.any():
            break
        side = np.where(few[piece], -side, side)
    return side


def _stiffness(faces: Faces, ground: PackedMaterial, assembly: Assembly, crossing: np.ndarray) -> np.ndarray:
    """Normal and shear stiffness (2, m) Pa/m, per area, of the contacts that cross a joint in the ground of each face.

    All of them count, with the springs of that ground: those of a part of the joint are too few for a mean. In damped
    ground these are the springs at the frequency of its wave speeds.
    """
    types = len(ground.brick.pairs)
    kind = assembly.contact_type[crossing] % types
    share = np.where(assembly.contact_type[crossing] // types % 2 == 1, 0.5, 1.0)
    vectors = ground.brick.vectors[kind]
    along = faces.along[0]
    if len(np.unique(faces.along, axis=0)) > 1:  # a polyline: that of the face of the contact's first disk, if any
        order = np.argsort(faces.disk, kind="stable")
        at = np.searchsorted(faces.disk[order], assembly.pairs[crossing, 0]).clip(max=len(order) - 1)
        along = faces.along[order[at]]
    straight = np.sum(vectors * along, axis=1) ** 2 / np.sum(vectors**2, axis=1)
    zone, found = ground.zone_of(assembly.positions[faces.disk]), np.empty((2, len(faces.disk)))
    for number in np.unique(zone):
        springs = ground.zone_materials[number].stiffness
        normal, shear = springs.normal[kind] * share, springs.shear[kind] * share
        across = np.sum(normal * (1.0 - straight) + shear * straight)
        along_it = np.sum(normal * straight + shear * (1.0 - straight))
        found[:, zone == number] = np.array([[across], [along_it]]) / faces.length
    return found
