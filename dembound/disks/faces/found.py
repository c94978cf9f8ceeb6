"""The faces of joints: which disks lie on which side of a joint, and which part of its line belongs to each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.joint import Joint
from dembound.disks.faces.cells import intervals
from dembound.disks.material.packed_material import PackedMaterial
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
    removed : (2,) Pa/m, normal and shear stiffness per area of the contacts that it replaces. cut : number of these.
    rock : (2,) m/Pa, compliance of the rock that the faces stand for, beside that of the joint; whole : (2,) Pa/m,
    normal and shear stiffness of the joint as measured in its packing, nan where it was not; see series.py.
    """

    joint: Joint
    split: int
    disk: np.ndarray
    ends: np.ndarray
    along: np.ndarray
    side: np.ndarray
    removed: np.ndarray
    cut: int
    rock: np.ndarray
    whole: np.ndarray

    @property
    def length(self) -> float:
        """Length (m) of the faces on the left."""
        return float(np.hypot(*(self.ends[: self.split, 1] - self.ends[: self.split, 0]).T).sum())

    @property
    def asked(self) -> np.ndarray:
        """Normal and shear stiffness (2,) Pa/m that the joint is to have."""
        return np.array([self.joint.kn, self.joint.ks])

    @property
    def stiffness(self) -> np.ndarray:
        """Normal and shear stiffness (2,) Pa/m of the faces: with that of the rock in series, those asked for."""
        found: np.ndarray = 1.0 / (1.0 / self.asked + self.rock)
        return found


def faces_of(joint: Joint, ground: PackedMaterial, assembly: Assembly, body: slice, box: Box) -> Faces:
    """The faces of a joint in a body: the range of its disks, in a box left, bottom, right, top (m).

    Ends of the line inside the box are those of whole cells: a joint has the faces of the disks beside it.
    """
    line = _Line(np.array(joint.points), box)
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
    disk, ends, along = (np.concatenate(columns) for columns in zip(*found, strict=True))
    sides, unknown = side.astype(np.int8), np.full(2, np.nan)
    faces = Faces(joint, split, disk, ends, along, sides, np.zeros(2), int(crossing.sum()), np.zeros(2), unknown)
    if 0 < split < len(disk):
        removed = _stiffness(faces, ground, assembly, crossing)
        faces = replace(faces, removed=removed, rock=1.0 / removed)
    return faces


def with_joints(
    case: DiskCase, ground: PackedMaterial, assembly: Assembly, begin: int
) -> tuple[Assembly, tuple[Faces, ...]]:
    """An assembly without the contacts that the joints of a case replace, and their faces.

    begin : number of the first disk of the body, which follows those of columns.
    """
    body = slice(begin, len(assembly.radii))
    faces = tuple(faces_of(joint, ground, assembly, body, case.packing.box) for joint in case.joint)
    if not faces:
        return assembly, ()
    crossing = np.any([each.side[assembly.pairs].prod(axis=1) < 0 for each in faces], axis=0)
    left = replace(assembly, pairs=assembly.pairs[~crossing], contact_type=assembly.contact_type[~crossing])
    return left, faces


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
    """Normal and shear stiffness (2,) Pa/m, per area of the joint, of the contacts that cross it."""
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
    normal, shear = ground.springs.normal[kind] * share, ground.springs.shear[kind] * share
    across = np.sum(normal * (1.0 - straight) + shear * straight)
    return np.array([across, np.sum(normal * straight + shear * (1.0 - straight))]) / faces.length


class _Line:
    """A polyline of points (k, 2) m in a box, of which ends outside are cut off; ``length`` (m) is what is left."""

    def __init__(self, points: np.ndarray, box: Box) -> None:
        begin, end = points[0], points[-1]
        self.open = [not _is_inside(point, box) for point in (begin, end)]
        first = _entry(points[1], begin, box) if self.open[0] else begin
        last = _entry(points[-2], end, box) if self.open[1] else end
        self.points = np.vstack([first, points[1:-1], last])
        steps = np.diff(self.points, axis=0)
        self.lengths = np.hypot(*steps.T)
        self.along = steps / self.lengths[:, None]
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
