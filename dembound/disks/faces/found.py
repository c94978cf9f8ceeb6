"""The faces of joints: which disks lie on which side of a joint, and which part of its line belongs to each."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.joint import CORNERS, Joint, joint_ends
from dembound.casefile.messages import numbered
from dembound.disks.faces.cells import intervals
from dembound.disks.material.packed_material import PackedMaterial
from dembound.errors import CaseError
from dembound.packings.tiling import Assembly
from dembound.table import Box

BESIDE = 1.5
"""Distance from a joint, over the largest diameter, within which disks keep their side of it for good."""

NEAR = 2.5
"""Distance from a joint, over the largest radius, within which disks may have a part of its line."""

LOOSE = 10
"""Disks of a piece that the joint cuts off and that counts as one of its other side, if there are fewer."""


@dataclass(frozen=True, eq=False)
class Faces:
    """The m faces of a joint, those of the disks on the left of its line before those on the right.

    Attributes
    ----------
    joint : its table. split : number of faces on the left. disk : (m,) of each, among the scene's.
    ends : (m, 2, 2) m, ends of each face at the start. along : (m, 2) unit vector along the line.
    side : (n,) 1 for disks of the scene that are on the left beside the joint for good, −1 on the right, 0 for others.
    removed : (2, m) Pa/m, normal and shear stiffness per area of the contacts that it replaces, in the ground of each
    face. cut : number of these. ended_at : sides before which it ends, as ground goes on beyond them.
    """

    joint: Joint
    split: int
    disk: np.ndarray
    ends: np.ndarray
    along: np.ndarray
    side: np.ndarray
    removed: np.ndarray
    cut: int
    ended_at: tuple[str, ...] = ()

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
            split=int(np.count_nonzero(left[: self.split])),
            disk=number[self.disk[left]],
            ends=self.ends[left],
            along=self.along[left],
            side=side,
            removed=self.removed[:, left],
        )

    def left_of(self, kept: np.ndarray) -> np.ndarray:
        """Whether each face (m,) is that of a disk among those kept (k,)."""
        return np.isin(self.disk, kept)

    @property
    def has_two_sides(self) -> bool:
        """Whether there are faces on both sides."""
        return 0 < self.split < len(self.disk)

    @property
    def stiffness(self) -> np.ndarray:
        """Normal and shear stiffness (2, m) Pa/m of the faces: with removed contacts in series, those asked for."""
        asked = np.array([[self.joint.kn], [self.joint.ks]])
        found: np.ndarray = asked * self.removed / (asked + self.removed)
        return found


def in_series(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Stiffness between faces of these stiffnesses: each gives by half of what its own says."""
    return np.where(one == other, one, 2.0 * one * other / (one + other))


def faces_of(
    joint: Joint, ground: PackedMaterial, assembly: Assembly, body: slice, box: Box, ends: Mapping[str, float]
) -> Faces:
    """The faces of a joint in a body: the range of its disks, in a box left, bottom, right, top (m).

    Ends of the line inside the box are those of whole cells: a joint has the faces of the disks beside it. ends : m,
    how far from some sides the line ends, see `joint_ends`.
    """
    line = _Line(np.array(joint.points), box, ends)
    distance, place = line.nearest(assembly.positions)
    within = np.zeros(len(distance), dtype=np.bool_)
    within[body] = (place[body] > 0.0) & (place[body] < line.length)
    side = np.where(distance >= 0.0, 1, -1)
    side = np.where(within & (np.abs(distance) <= 2.0 * BESIDE * float(assembly.radii.max())), side, 0)
    side = _by_contacts(assembly, side)
    crossing = side[assembly.pairs].prod(axis=1) < 0
    touching = np.zeros(len(side), dtype=np.bool_)
    touching[assembly.pairs.ravel()] = True
    near = np.abs(distance) <= NEAR * float(assembly.radii.max())
    near[: body.start] = near[body.stop :] = False
    found: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []
    split = 0
    for way in (1, -1):
        own = np.flatnonzero(near & touching & np.where(side != 0, side == way, way * distance >= 0.0))
        found += line.faces(own, side, assembly.positions, assembly.radii)
        split = sum(len(each[0]) for each in found) if way == 1 else split
    disk, parts, along = (np.concatenate(columns) for columns in zip(*found, strict=True))
    faces = Faces(joint, split, disk, parts, along, side.astype(np.int8), np.zeros((2, len(disk))), int(crossing.sum()))
    if not (faces.has_two_sides and crossing.any()):
        return faces
    there = [np.abs(parts - point).max(axis=2).min() < 2.0 * assembly.radii.max() for point in line.points[[0, -1]]]
    ended_at = tuple(side for side, is_there in zip(line.ended_at, there, strict=True) if side and is_there)
    return replace(faces, removed=_stiffness(faces, ground, assembly, crossing), ended_at=ended_at)


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
    faces = _found(case, ground, assembly, begin) if before is None else _left(*before, begin)
    if not faces:
        return assembly, ()
    crossing = np.any([each.side[assembly.pairs].prod(axis=1) < 0 for each in faces], axis=0)
    left = replace(assembly, pairs=assembly.pairs[~crossing], contact_type=assembly.contact_type[~crossing])
    return left, faces


def _found(case: DiskCase, ground: PackedMaterial, assembly: Assembly, begin: int) -> tuple[Faces, ...]:
    """The faces of all joints of a case, see `with_joints`; raises CaseError for joints without any."""
    body, ends = slice(begin, len(assembly.radii)), joint_ends(case.boundary, case.intact, 2.0 * case.packing.radius)
    faces = tuple(faces_of(joint, ground, assembly, body, case.packing.box, ends) for joint in case.joint)
    if nowhere := [
        place for (place, _), each in zip(numbered("joint", case.joint), faces, strict=True) if not each.cut
    ]:
        beside = "of the ground that is not beside a side beyond which ground goes on" if ends else "of the ground"
        raise CaseError(
            [f"{place}.points: has no disks on both sides, must cross a part {beside}" for place in nowhere]
        )
    return faces


def _left(before: Sequence[Faces], kept: np.ndarray, begin: int) -> tuple[Faces, ...]:
    """The faces that are left of joints, without joints of which one side is gone; see `Faces.among`."""
    return tuple(each for each in (faces.among(kept, begin) for faces in before) if each.has_two_sides)


def numbers_beside(faces: Sequence[Faces]) -> np.ndarray | None:
    """Number (n,) of the joint that each disk is beside, negative on the right of it, else 0; None without any.

    Disks of opposite numbers never touch.
    """
    if not faces:
        return None
    found = np.zeros(len(faces[0].side), dtype=np.int64)
    for number, each in enumerate(faces, start=1):
        found = np.where(found == 0, number * each.side.astype(np.int64), found)
    return found


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


class _Line:
    """A polyline of points (k, 2) m in a box, of which ends outside are cut off; ``length`` (m) is what is left.

    ends : m, how far from some sides it ends. open : whether each end is at a side; ended_at : the side before which
    each ends, or empty.
    """

    def __init__(self, points: np.ndarray, box: Box, ends: Mapping[str, float]) -> None:
        near = [ends.get(side, 0.0) for side in CORNERS]
        inner = box[0] + near[0], box[1] + near[1], box[2] - near[2], box[3] - near[3]
        outer = [not _is_inside(point, inner) for point in points[[0, -1]]]
        each = zip(outer, points[[1, -2]], points[[0, -1]], strict=True)
        first, last = (_entry(inside, end, inner) if out else end for out, inside, end in each)
        self.open = [out and not _is_inside(end, box) for out, end in zip(outer, (first, last), strict=True)]
        self.ended_at = [
            CORNERS[int(np.abs(end[[0, 1, 0, 1]] - inner).argmin())] if out and not is_open else ""
            for out, is_open, end in zip(outer, self.open, (first, last), strict=True)
        ]
        self.points = np.vstack([first, points[1:-1], last])
        steps = np.diff(self.points, axis=0)
        self.lengths = np.hypot(*steps.T)
        self.along = steps / np.maximum(self.lengths, 1e-300)[:, None]  # 0 where all of it is cut off
        self.begins = np.concatenate([[0.0], np.cumsum(self.lengths)])
        self.length = float(self.begins[-1])

    def nearest(self, positions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Distance to the left (n,) m and place along the line (n,) m of the segment nearest to positions (n, 2) m.

        Places are negative before its beginning, and go on beyond its end. Beyond an end at a
        side of the body the joint goes on.
        """
        least, found = np.full(len(positions), np.inf), np.zeros((2, len(positions)))
        for number, (start, along, length) in enumerate(zip(self.points, self.along, self.lengths, strict=False)):
            x, y = (positions - start).T
            place, left = x * along[0] + y * along[1], y * along[0] - x * along[1]
            past = np.hypot(left, place - np.clip(place, 0.0, length))
            nearer = past < least
            least = np.where(nearer, past, least)
            low = 0.0 if number > 0 else -np.inf
            high = length if number < len(self.lengths) - 1 else np.inf
            on_line = self.begins[number] + np.clip(place, low, high)
            found = np.where(nearer, np.stack([left, on_line]), found)
        left, here = found
        tiny = 1e-6 * self.length
        here = np.maximum(here, tiny) if self.open[0] else here
        here = np.minimum(here, self.length - tiny) if self.open[1] else here
        return left, here

    def faces(
        self, disks: np.ndarray, side: np.ndarray, positions: np.ndarray, radii: np.ndarray
    ) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
        """Disk (f,), ends (f, 2, 2) m and direction (f, 2) of the faces of one side's disks (k,) on each segment.

        side : (n,), see `Faces`; disks without a side limit the cells of others, and have no faces.
        """
        found = []
        for number, (start, along, length) in enumerate(zip(self.points, self.along, self.lengths, strict=False)):
            x, y = (positions[disks] - start).T
            place, left = x * along[0] + y * along[1], y * along[0] - x * along[1]
            low, high = intervals(place, left, radii[disks])
            if number > 0 or self.open[0]:
                low = np.maximum(low, 0.0)
            if number < len(self.lengths) - 1 or self.open[1]:
                high = np.minimum(high, length)
            chosen = np.flatnonzero((high > low) & (side[disks] != 0))
            chosen = chosen[np.argsort(low[chosen], kind="stable")]
            ends = start + np.stack([low, high], axis=1)[chosen, :, None] * along
            found.append((disks[chosen], ends, np.repeat(along[None], len(chosen), axis=0)))
        return found


def _is_inside(point: np.ndarray, box: Box) -> bool:
    """Whether a point (2,) m lies in a box, not on its sides."""
    left, bottom, right, top = box
    near = 1e-9 * max(right - left, top - bottom)
    return bool(left + near < point[0] < right - near and bottom + near < point[1] < top - near)


def _entry(inside: np.ndarray, outside: np.ndarray, box: Box) -> np.ndarray:
    """Where the line from a point (2,) m to one outside of the box leaves it; from outside, that where it goes in."""
    low, high, step = np.array(box[:2]), np.array(box[2:]), outside - inside
    with np.errstate(divide="ignore", invalid="ignore"):
        limits = np.where(step > 0.0, (high - inside) / step, np.where(step < 0.0, (low - inside) / step, np.inf))
    found: np.ndarray = inside + np.clip(limits.min(), 0.0, 1.0) * step
    return found
