"""The forces of joints on the disks beside them, as a tie of the scene, with their history."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from dembound.disks.faces.found import Faces
from dembound.disks.material.at_rest import StressAtRest, UnlikeStress
from dembound.disks.material.packed_material import PackedMaterial
from dembound.errors import RunError
from dembound.kernels.compiler.lanes import LANES
from dembound.kernels.joint_notes import EVENTS, LAID_OUT, NEEDED, PAIRS, STEPS
from dembound.kernels.joint_pairs import list_faces
from dembound.kernels.joints import push_faces
from dembound.kernels.tables.joints import FacePairs, JointFaces, JointLaw
from dembound.motion.part import Cracks, Tie
from dembound.motion.state import Arrays, Layout

ROOM = LANES
"""Places for pairs per face: two to three are listed where each face of one side lies opposite some of the other.

It makes their number a multiple of those that are computed at once.
"""

MARGIN = 0.25
"""By how much faces may lie apart that are listed as pairs, over the mean diameter."""

TURNED = 0.2
"""Turn (rad) of a disk at which its face ends: it is no longer part of a block that slides."""

ROWS = 1024
"""Steps of which means over each joint are kept for the record; the loop returns within a quarter of them."""

HOLDS, CLOSED, SLIDES, OPEN = range(4)
"""States of a place of a joint: with its strength, or without it pressed together, sliding, or apart."""

DELAY = 1.0
"""Way of P waves, over the mean diameter, in the time in which friction follows a change of pressure."""


class JointTie(Tie):
    """The faces of joints of the same constants with what they remember.

    Parameters
    ----------
    faces : of the joints, see `merged`. positions : (n, 2) m of the scene's disks. ground : their material. gives :
    (3, n) inverse masses and moments of inertia of the scene's nodes, 0 for what is held or prescribed. layout : slots
    of the scene. time_step : s. at_rest : the stress with which the faces begin; None: without.
    """

    def __init__(
        self,
        faces: Faces,
        positions: np.ndarray,
        ground: PackedMaterial,
        gives: np.ndarray,
        layout: Layout,
        time_step: float,
        at_rest: StressAtRest | UnlikeStress | None = None,
    ) -> None:
        joint, count = faces.joint, len(faces.disk)
        self.name = f"joint_{joint.name}"
        self.faces, self._layout, self._count = faces, layout, layout.count
        self.nodes = np.unique(faces.disk)
        self._known: np.ndarray | None = None
        beside = [ground.zone_materials[zone] for zone in np.unique(ground.zone_of(positions[faces.disk]))]
        speeds = [float(np.sqrt(each.material_tensor[0, 0] / each.density)) for each in beside]
        impedance = min(each.density * speed for each, speed in zip(beside, speeds, strict=True))
        diameter, speed = ground.brick.mean_diameter, min(speeds)
        normal = np.stack([-faces.along[:, 1], faces.along[:, 0]], axis=1)
        centre, first = positions[faces.disk], faces.ends[:, 0]
        height = np.sum((centre - first) * normal, axis=1)
        height[faces.split :] *= -1.0
        pressure, shear = self._stress(at_rest, normal)
        room = ROOM * count
        self._bundle = JointFaces(
            law=JointLaw(
                friction=float(joint.fric or 0.0),
                tension=joint.ten,
                cohesion=joint.coh,
                dilation=float(np.tan(np.radians(joint.dilation))),
                dilation_end=np.inf if joint.dilation_end is None else joint.dilation_end,
                dashpot=joint.dashpot * impedance,
                step=time_step,
                follows=1.0 - float(np.exp(-time_step * speed / (DELAY * diameter))),
                fails=not joint.is_linear,
                margin=MARGIN * diameter,
                reach=diameter,
            ),
            split=faces.split,
            part=faces.part,
            disk=layout.slot[faces.disk].astype(np.int64),
            line=np.zeros(count, dtype=np.int64),
            centre=centre,
            ends=faces.ends.reshape(-1, 4).copy(),
            along=faces.along,
            height=height,
            stiffness=faces.stiffness,
            closure=0.5 * pressure / faces.stiffness[0],
            rest=shear / faces.stiffness[1],
            pairs=empty_pairs(room),
            spare=empty_pairs(room),
            frame=np.zeros((16, room)),
            motion=np.zeros((8, LANES)),
            pushes=np.zeros((4, LANES)),
            counts=np.zeros(5, dtype=np.int64),
            listed=np.zeros((count, 2)),
            gives=np.ascontiguousarray(gives[:, faces.disk].T),
            force=np.zeros((count, 3)),
            kick=np.zeros((count, 3)),
            lost=np.zeros(3),
            events=np.zeros((room, 6)),
            record=np.zeros((ROWS, len(faces.joints), 7)),
            first=np.full((len(faces.joints), 2), -1),
        )
        self._begin(shear)

    def _begin(self, shear: np.ndarray) -> None:
        """List the first pairs, with the shear stress (m,) Pa of the faces and the strength of the joint."""
        bundle, joint = self._bundle, self.faces.joint
        rest = np.zeros((3, self._count))
        list_faces(bundle, rest)
        found, pairs = slice(0, int(bundle.counts[PAIRS])), bundle.pairs
        pairs.length[found] = np.inf  # so that slip is kept
        one, other = pairs.first[found], pairs.second[found]
        pairs.slip[found] = 0.5 * (shear[one] + shear[other]) / pairs.ks[found]
        pairs.intact[found] = joint.ten > 0.0 or joint.coh > 0.0
        pairs.bearing[found] = pairs.kn[found] * (bundle.closure[one] + bundle.closure[other])
        push_faces(bundle, rest, rest)
        bundle.counts[STEPS] = 0
        bundle.lost[:] = 0.0
        bundle.first[:] = -1

    def _stress(self, at_rest: StressAtRest | UnlikeStress | None, normal: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Pressure, and shear stress along the line on the left side, (m,) Pa each, of faces with normals (m, 2)."""
        if at_rest is None:
            return np.zeros(len(normal)), np.zeros(len(normal))
        x, y = self.faces.ends.mean(axis=1).T
        xx, yy, xy = at_rest.at(y, x)
        pull = np.stack([xx * normal[:, 0] + xy * normal[:, 1], xy * normal[:, 0] + yy * normal[:, 1]], axis=1)
        return -np.sum(pull * normal, axis=1), -np.sum(pull * self.faces.along, axis=1)

    def bundle(self, supported: np.ndarray) -> NamedTuple:
        """The arrays for the kernels; supported (s,) are all nodes of the support table, ascending.

        Raises RunError where more faces lie side by side than there is room for, as where disks are heaped up.
        """
        if self._known is not supported:
            self._known = supported
            self._bundle.line[:] = np.searchsorted(supported, self.faces.disk)
        self._require_room()
        return self._bundle

    def _require_room(self) -> None:
        """Raise RunError if pairs of faces are missing."""
        counts, room = self._bundle.counts, len(self._bundle.pairs.first)
        if counts[NEEDED] > room:
            name = self.faces.joint.name
            raise RunError(f'disks are heaped up on joint "{name}": more than {room:,} pairs of faces touch there')

    def force_at(self, displacement: np.ndarray) -> np.ndarray:
        """Forces and moments (3, n) N and N·m at displacements (3, n) of disks at rest; what it remembers stays."""
        found = _copied(self._bundle)
        push_faces(found, self._layout.spread(displacement), np.zeros((3, self._count)))
        force = np.zeros_like(displacement)
        np.add.at(force.T, self.faces.disk, found.force)
        return force

    def stored(self) -> float:
        """Energy (J) in its springs at the last step."""
        bundle = self._bundle
        return float(bundle.pairs.energy[: bundle.counts[PAIRS]].sum())

    @property
    def pressed(self) -> np.ndarray:
        """Disks (k,) of faces that press on others, or are held by the joint's strength."""
        pairs = self.acting
        there = self.closed(pairs)
        return self.faces.disk[np.concatenate([pairs.first[there], pairs.second[there]])]

    def slip(self, pairs: FacePairs) -> np.ndarray:
        """Slip (k,) m of pairs since the start, of the left side along the line."""
        rest = self._bundle.rest
        slid: np.ndarray = pairs.slip - 0.5 * (rest[pairs.first] + rest[pairs.second])
        return slid

    def closed(self, pairs: FacePairs) -> np.ndarray:
        """Whether pairs (k,) press on each other, or are held by the joint's strength."""
        there: np.ndarray = (pairs.pressure > 0.0) | pairs.intact | self.faces.joint.is_linear
        return there

    def samples(self, steps: np.ndarray) -> np.ndarray:
        """Means over each joint (k, l, 6) in some of the last steps (k,): slip and opening (m) to the shares (1).

        The columns are those of the kernels' record; 0 where no faces lie opposite each other.
        """
        found = self._bundle.record[steps % ROWS]
        means: np.ndarray = found[..., 1:] / np.where(found[..., :1] > 0.0, found[..., :1], 1.0)
        return means

    @property
    def first(self) -> np.ndarray:
        """Steps (l, 2) in which each joint first slid and opened; −1 if it has not."""
        return self._bundle.first

    def segments(self, pairs: FacePairs) -> dict[str, np.ndarray]:
        """Where pairs (k,) that overlap lie opposite each other, and what the joint does there.

        ends : (k, 4) m, x and y of both ends on the left side, at the start. joint : (k,) number among those of the
        tie. particles : (k, 2) disks left and right. state : (k,) HOLDS, CLOSED, SLIDES or OPEN. Others as in `slip`,
        and of `FacePairs`.
        """
        bundle, own, other = self._bundle, pairs.first, pairs.second
        along = bundle.along[own] + bundle.along[other]
        along /= np.hypot(*along.T)[:, None]
        start, length = bundle.ends[own, :2], bundle.ends[own, 2:] - bundle.ends[own, :2]
        whole = np.sum(length * along, axis=1)
        parts = pairs.begin / whole, (pairs.begin + pairs.length) / whole
        held = pairs.intact | self.faces.joint.is_linear
        state = np.where(held, HOLDS, np.where(pairs.slides, SLIDES, np.where(pairs.pressure > 0.0, CLOSED, OPEN)))
        return {
            "ends": np.hstack([start + part[:, None] * length for part in parts]),
            "joint": self.faces.part[own],
            "particles": self.faces.disk[np.stack([own, other], axis=1)],
            "slip": self.slip(pairs),
            "opening": pairs.opening,
            "pressure": pairs.pressure,
            "shear": pairs.shear,
            "state": state,
        }

    def forces(self, pairs: FacePairs) -> np.ndarray:
        """Forces (2, k) N of the last step on the disks of the first faces of pairs."""
        along = self.faces.along[pairs.first] + self.faces.along[pairs.second]
        along = (along / np.hypot(*along.T)[:, None]).T
        push, rub = pairs.length * pairs.pressure, pairs.length * pairs.shear
        return np.stack([rub * along[0] - push * along[1], rub * along[1] + push * along[0]])

    @property
    def acting(self) -> FacePairs:
        """The pairs that overlap."""
        pairs = self._bundle.pairs
        chosen = np.flatnonzero(pairs.length[: self._bundle.counts[PAIRS]] > 0.0)
        found = FacePairs(*(each[chosen] for each in pairs))
        return found._replace(intact=found.intact > 0, slides=found.slides > 0)

    def take_cracks(self) -> Cracks:
        """The places that lost their strength since the last call, as cracks between the disks of two faces."""
        number = int(self._bundle.counts[EVENTS])
        events = self._bundle.events[:number]
        both = events[:, 1:3].astype(np.int64)
        found = Cracks(events[:, 0].astype(np.int64), self.faces.disk[both], events[:, 3:5].copy(), events[:, 5] > 0.0)
        self._bundle.counts[EVENTS] = 0
        return found

    @property
    def there(self) -> np.ndarray:
        """Whether each face (m,) is still there, see `loose`."""
        found: np.ndarray = (self._bundle.ends[:, :2] != self._bundle.ends[:, 2:]).any(axis=1)
        return found

    def loose(self, displacement: np.ndarray, torn: np.ndarray) -> np.ndarray:
        """Disks (k,) with faces that are no longer parts of blocks along the joint.

        They have turned by `TURNED`, have lost all bonds, or have moved by a diameter to where no disk has a face on
        the other side.

        Parameters
        ----------
        displacement
            (3, n) m and rad.
        torn
            (n,) bool, whether disks have lost all bonds.
        """
        faces, reach = self.faces, self._bundle.law.reach
        there = np.flatnonzero(self.there)
        disk, is_left, part = faces.disk[there], there < faces.split, faces.part[there]
        loose = (np.abs(displacement[2, disk]) > TURNED) | torn[disk]
        place = np.sum((faces.ends[there].mean(axis=1) + displacement[:2, disk].T) * faces.along[there], axis=1)
        for line in np.unique(part):
            for way in (is_left, ~is_left):
                own, beyond = np.flatnonzero(way & (part == line)), place[~way & (part == line)]
                if len(own) and len(beyond):
                    gone = (place[own] < beyond.min() - 0.5 * reach) | (place[own] > beyond.max() + 0.5 * reach)
                    loose[own] |= gone & (np.hypot(*displacement[:2, disk[own]]) > reach)
        return disk[loose]

    def end_faces(self, disks: np.ndarray) -> None:
        """End the faces of some disks (k,): without length they overlap no more."""
        ended = np.isin(self.faces.disk, disks)
        self._bundle.ends[ended, 2:] = self._bundle.ends[ended, :2]
        self._bundle.counts[LAID_OUT] = 0

    def saved_arrays(self) -> Arrays:
        """The pairs with their history, events not yet recorded, and the faces, of which some may have ended."""
        bundle = self._bundle
        names = ("counts", "listed", "events", "ends", "first")
        kept: dict[str, np.ndarray] = {name: getattr(bundle, name) for name in names}
        return kept | {f"pair_{name}": values for name, values in bundle.pairs._asdict().items()}

    def restore(self, saved: Arrays) -> None:
        """Restore the arrays returned by `saved_arrays` in another run of the same case."""
        for name, values in self.saved_arrays().items():
            if saved[name].shape != values.shape:
                raise ValueError(f"{self.name}: {name} has the shape {saved[name].shape}, must have {values.shape}")
            values[...] = saved[name]
        bundle = self._bundle
        bundle.counts[LAID_OUT] = 0
        if not (bundle.counts >= 0).all() or bundle.counts[PAIRS] > len(bundle.pairs.first):
            raise ValueError(f"{self.name}: has no {bundle.counts[PAIRS]} pairs")
        faces = np.concatenate([bundle.pairs.first, bundle.pairs.second])
        if not ((faces >= 0) & (faces < len(self.faces.disk))).all():
            raise ValueError(f"{self.name}: a pair has faces that there are not")

    def go_on_from(self, saved: Arrays) -> None:
        """Take over the history (arrays of `saved_arrays`) of the joint of a settled body; steps are counted anew."""
        self.restore(saved)
        self._bundle.counts[[STEPS, EVENTS]] = 0
        self._bundle.first[:] = -1


def empty_pairs(room: int) -> FacePairs:
    """Places for pairs."""
    whole, flags, values = np.int64, np.uint8, np.float64
    kinds: Mapping[str, type] = {"first": whole, "second": whole, "intact": flags, "slides": flags}
    return FacePairs(*(np.zeros(room, kinds.get(name, values)) for name in FacePairs._fields))


def _copied(bundle: JointFaces) -> JointFaces:
    """A bundle whose history can change without that of another."""
    pairs = FacePairs(*(each.copy() for each in bundle.pairs))
    own = {
        name: getattr(bundle, name).copy()
        for name in ("frame", "counts", "listed", "force", "lost", "events", "record", "first")
    }
    return bundle._replace(pairs=pairs, **own)
