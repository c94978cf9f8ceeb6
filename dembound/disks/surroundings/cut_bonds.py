"""Halves of the bonds that the sides of a body cut, and the motion of their middles per unit gradient: see wall.py."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from dembound.disks.material.layered import LayeredGround
from dembound.disks.material.packed_material import PackedMaterial
from dembound.packings.cut import CutContacts

ROUNDING = 1e-9
"""Part of a stiffness below which a bending moment is rounding."""

GRADIENT = ((0, 2), (3, 1))
"""The gradient ∂u_a/∂b of components a and axes b, by its number in `homogenise.GRADIENTS`."""


@dataclass(frozen=True, eq=False)
class CutBonds:
    """The halves of cut bonds next to a body.

    Attributes
    ----------
    particle : (t,) disk of the body. normal : (2, t) from its centre to that of the disk beyond. arm : (t,) m, to the
    contact. height : (t,) m, of its centre. point : (t, 2) m, of the contact; in a `Wall` the nearest point of its
    element. stiffness : (3, t) N/m, N/m and N·m, of half the bond: twice the bond's.
    corrector : (3, 4, t) m and rad, c of wall.py per unit gradient xx, yy, xy, yx; own : (3, 4, t), χ of the body's
    disk.
    force : (3, 4, t) N and N·m per unit gradient, of the bond at the contact: along x and y, and its bending moment.
    side : (t,) int64, index in `boundaries.SIDES` of the side that cuts the bond, of two the first.
    """

    particle: np.ndarray
    normal: np.ndarray
    arm: np.ndarray
    height: np.ndarray
    point: np.ndarray
    stiffness: np.ndarray
    corrector: np.ndarray
    own: np.ndarray
    force: np.ndarray
    side: np.ndarray

    @classmethod
    def of(cls, ground: PackedMaterial, cut: CutContacts, positions: np.ndarray) -> CutBonds:
        """Bonds of the cut contacts of a body with disks at these positions (n, 2) m."""
        if isinstance(ground, LayeredGround):
            return cls._of_layers(ground, cut, positions)
        law, kind, second = ground.springs, cut.contact_type, cut.is_second
        arms = np.where(second, [law.arm_j[kind], law.arm_i[kind]], [law.arm_i[kind], law.arm_j[kind]])
        vectors = cut.vectors(ground.brick).T
        normal = vectors / np.hypot(*vectors)
        own, other = (
            np.moveaxis(ground.continuum.corrector[:, disk], 1, 2)
            for disk in (np.where(second, *ground.brick.pairs[kind].T[::-1]), cut.other)
        )
        # from the contact to the bond's middle
        corrector = _middle(own, other, arms, normal) + _uniform(0.5 * vectors - arms[0] * normal)
        stiffness = 2.0 * np.stack([law.normal[kind], law.shear[kind], law.bending[kind]])
        strained = _uniform(arms[0] * normal) + corrector - own
        force = _forces(stiffness, normal, arms[0], strained, own[2])
        if np.all(np.abs(force[2]) <= ROUNDING * stiffness[2]):
            stiffness[2] = 0.0
        height, point = positions[cut.node, 1], positions[cut.node] + (arms[0] * normal).T
        return cls(cut.node, normal, arms[0], height, point, stiffness, corrector, own, force, cut.side)

    @classmethod
    def _of_layers(cls, ground: LayeredGround, cut: CutContacts, positions: np.ndarray) -> CutBonds:
        """The bonds of a layered ground: half a bond has the springs of the zone of its disk."""
        zone, order, parts = ground.zone_of(positions[cut.node]), [], []
        for number in np.unique(zone).tolist():
            order.append(np.flatnonzero(zone == number))
            parts.append(vars(cls.of(ground.zones[number].material, cut.only(zone == number), positions)))
        place = np.argsort(np.concatenate(order))
        along = {name: 0 if name == "point" else -1 for name in parts[0]}
        joined = {name: np.concatenate([part[name] for part in parts], axis=axis) for name, axis in along.items()}
        return cls(**{name: np.take(values, place, axis=along[name]) for name, values in joined.items()})

    @property
    def on_disks(self) -> np.ndarray:
        """Forces (3, 4, t) N and N·m per unit gradient of the bonds on the disks, moments about the disks' centres."""
        nx, ny = self.normal
        fx, fy, bending = self.force
        return np.stack([fx, fy, bending + self.arm * (nx * fy - ny * fx)])

    def between(self, sides: Sequence[float]) -> CutBonds:
        """The bonds with the motion half-way between their contacts and the sides of the continuum.

        sides : left and right (x), lower and upper (y), m. A component along the normal is moved by the strain along
        it, one across by the shear strain, so that no rotation strains a tie.
        """
        corrector = self.corrector.copy()
        for number, edge in enumerate(sides):
            axis, chosen = number // 2, self.side == number
            for component in range(2) if chosen.any() else ():
                gradient = GRADIENT[component][axis]
                force = self.force[:, gradient, chosen]
                moved = np.sum(force * self.corrector[:, gradient, chosen])
                place = (np.sum(force[component] * self.point[chosen, axis]) + moved) / np.sum(force[component])
                for each in {gradient, GRADIENT[axis][component]}:
                    corrector[component, each, chosen] += 0.5 * (edge - place)
        return replace(self, corrector=corrector)

    def read_at(self, point: np.ndarray) -> CutBonds:
        """The bonds with the continuum's motion taken at other points (t, 2) m; c then includes the way from there."""
        corrector = self.corrector + _uniform((self.point - point).T)
        return replace(self, point=point, corrector=corrector)


def _middle(own: np.ndarray, other: np.ndarray, arms: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Motion (3, 4, t) of the middles of bonds, from the motions (3, 4, t) of their two disks with arms (2, t)."""
    along = np.stack([-normal[1], normal[0]])
    middle = 0.5 * (own + other)
    middle[:2] += 0.5 * along[:, None] * (arms[0] * own[2] - arms[1] * other[2])
    return middle


def _uniform(vector: np.ndarray) -> np.ndarray:
    """Displacements (3, 4, t) over vectors (2, t) m under unit gradients; no rotation."""
    moved = np.zeros((3, 4, vector.shape[1]))
    for component, gradients in enumerate(GRADIENT):
        for axis, gradient in enumerate(gradients):
            moved[component, gradient] = vector[axis]
    return moved


def _forces(
    stiffness: np.ndarray, normal: np.ndarray, arm: np.ndarray, moved: np.ndarray, angle: np.ndarray
) -> np.ndarray:
    """Forces along x and y and bending moments (3, 4, t) of ties at motions (3, 4, t) relative to their disks.

    angle : (4, t) rotation of the disks.
    """
    nx, ny = normal
    pull = stiffness[0] * (nx * moved[0] + ny * moved[1])
    shear = stiffness[1] * (nx * moved[1] - ny * moved[0] - arm * angle)
    return np.stack([pull * nx - shear * ny, pull * ny + shear * nx, stiffness[2] * moved[2]])
