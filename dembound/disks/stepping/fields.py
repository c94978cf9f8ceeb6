"""Recorded fields of a system of disks besides its motion: stresses, contacts, cracks; the rotation of a body."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import cached_property
from itertools import chain
from typing import NamedTuple

import numpy as np

from dembound.continuum.part import GridPart
from dembound.disks.body import DiskBody
from dembound.disks.contacts.pairs import Piece, contact_columns, pieces, plain_contacts
from dembound.disks.faces.states import cracks_of
from dembound.disks.faces.tie import JointTie
from dembound.disks.stepping.damped_ground import unrelaxed
from dembound.disks.stepping.part import DiskPart
from dembound.disks.stepping.scene_parts import DiskParts
from dembound.disks.stepping.walls import WallPart
from dembound.kernels.contacts import REFERENCE
from dembound.kernels.tables.contacts import Contacts
from dembound.motion.part import Cracks, Part, System, Tie, joined


def particle_stress(
    scene: DiskBody, contacts: Contacts, displacement: np.ndarray, geometry: int, more: Iterable[Piece] = ()
) -> np.ndarray:
    """Stress (n, 3) xx, yy, xy in Pa of all particles, tension positive; xy is the mean of both shear stresses.

    A particle's stress is Σ f_a l n_b over its area, πR² plus its share of the pores, half of that for half cells, with
    f the force on it at a contact and l n the vector from its centre to the contact (Love's and Weber's mean). Forces
    from outside on a side are no contact forces and are not included.

    Parameters
    ----------
    scene : the scene of the particles.
    contacts : its pairs.
    displacement : (3, n) m and rad.
    geometry : of the forces and vectors of the pairs, see `forces.pieces`.
    more : other pairs with forces.
    """
    moments = np.zeros((3, scene.disk_count))
    for piece in chain(pieces(scene.layout, contacts, displacement, geometry), more):
        (x, y), (pull_x, pull_y) = piece.vector, piece.force
        for total, dyad in zip(moments, (pull_x * x, pull_y * y, 0.5 * (pull_x * y + pull_y * x)), strict=True):
            np.add.at(total, piece.first, piece.near * dyad)
            np.add.at(total, piece.second, (1.0 - piece.near) * dyad)
    area = np.pi * scene.assembly.radii**2 * scene.cell_fraction / scene.ground.brick.solid_fraction
    return (moments / area).T


def joint_pieces(joints: Sequence[JointTie], scene: DiskBody, displacement: np.ndarray) -> Iterator[Piece]:
    """The forces of joints of the last step as those of pairs of disks, at displacements (3, n)."""
    for joint in joints:
        pairs, faces = joint.acting, joint.faces
        first, second = faces.disk[pairs.first], faces.disk[pairs.second]
        vector = (scene.positions[second] - scene.positions[first]).T
        vector = vector + displacement[:2, second] - displacement[:2, first]
        closed, half = (pairs.pressure != 0.0) | (pairs.shear != 0.0), np.full(len(first), 0.5)
        yield Piece(first, second, pairs.intact | faces.joint.is_linear, closed, vector, half, joint.forces(pairs))


def turns_freely(scene: DiskBody) -> bool:
    """Whether only dashpots resist the rigid rotation of a body."""
    held = scene.supports.prescribed.any() or scene.supports.stiffness.any()
    periodic = any(table.is_periodic for table in scene.case.boundary.values())
    return bool(scene.free.all()) and not scene.seams and not held and not periodic


def turned_as_a_whole(
    scene: DiskBody, displacement: np.ndarray, velocity: np.ndarray, datum: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Displacements and velocities (3, n) of a body rotated exactly, from those of linearised rotation.

    Under the law of small displacements a body that rotates by θ moves from r to r + θ ẑ × r + w, which stretches it by
    ½θ². The exact motion is from r to R(θ)(r + w). datum : (3, n) displacements at the start.
    """
    mass = scene.mass
    displacement, velocity = displacement.copy(), velocity.copy()
    arm = scene.assembly.positions.T + datum[:2]
    arm = arm - np.average(arm, axis=1, weights=mass)[:, None]
    moved = displacement[:2] - datum[:2]
    centre = np.average(moved, axis=1, weights=mass)[:, None]
    spin = np.sum(mass * (arm[0] * moved[1] - arm[1] * moved[0])) + np.sum(scene.inertia * (displacement - datum)[2])
    angle = spin / (np.sum(mass * (arm**2).sum(axis=0)) + scene.inertia.sum())
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    stretched = moved - centre - angle * np.stack([-arm[1], arm[0]])
    displacement[:2] = datum[:2] + centre + turn @ (arm + stretched) - arm
    mean = np.average(velocity[:2], axis=1, weights=mass)[:, None]
    velocity[:2] = mean + turn @ (velocity[:2] - mean)
    return displacement, velocity


class RecordedDisks(System):
    """A system of disks with its recorded fields.

    Parameters
    ----------
    scene : the scene. disks : its parts of disks. joints : its joints. beyond : its continua. ties : all of the scene.
    load : (3, n) N and N·m, steady forces and moments. walls : that its disks touch; None: there are none.
    """

    def __init__(
        self,
        scene: DiskBody,
        disks: DiskParts,
        joints: Sequence[JointTie],
        beyond: Sequence[Part],
        ties: Sequence[Tie],
        load: np.ndarray,
        walls: WallPart | None = None,
    ) -> None:
        super().__init__([*filter(None, [walls]), *disks.parts, *beyond], ties, load)
        self.scene, self.disks, self.joints, self.walls = scene, disks, tuple(joints), walls
        self._stress_at_rest: np.ndarray | None = None

    def laws(self) -> tuple[NamedTuple, ...]:
        """The bundles of all parts; walls come first, and their forces leave the steady loads at the end."""
        laws = super().laws()
        return laws if self.walls is None else (*laws, self.walls.unloading)

    @property
    def work_of_walls(self) -> float:
        """Work (J) of the walls that move, up to the last whole step."""
        return 0.0 if self.walls is None else self.walls.supplied

    def wall_samples(self, steps: np.ndarray) -> np.ndarray:
        """Displacement (m) and force (N) of walls (k, w, 4), see `WallPart.samples`."""
        return super().wall_samples(steps) if self.walls is None else self.walls.samples(steps)

    @property
    def recorded_parts(self) -> tuple[DiskPart, ...]:
        """The parts whose nodes are recorded as particles, those of disks."""
        return self.disks.parts

    @cached_property
    def _joint_numbers(self) -> list[np.ndarray]:
        """Numbers of the joints of each tie among those that have faces, in the order of the case."""
        numbers = {name: number for number, name in enumerate(self.scene.lines["joints"])}
        return [np.array([numbers[joint.name] for joint in tie.faces.joints]) for tie in self.joints]

    def joint_samples(self, steps: np.ndarray) -> np.ndarray:
        """Means over joints (k, j, 6), see `JointTie.samples`."""
        found = np.zeros((len(steps), len(self.scene.lines["joints"]), 6))
        for tie, numbers in zip(self.joints, self._joint_numbers, strict=True):
            found[:, numbers] = tie.samples(steps)
        return found

    def joint_segments(self) -> dict[str, tuple[np.ndarray, str]]:
        """Columns of the segments of joints with units, see `JointTie.segments`; numbers are those of the case."""
        each = [tie.segments(tie.acting) for tie in self.joints]
        for columns, numbers in zip(each, self._joint_numbers, strict=True):
            columns["joint"] = numbers[columns["joint"]]
        units = {"ends": "m", "slip": "m", "opening": "m", "pressure": "Pa", "shear": "Pa"}
        names = each[0] if each else ()
        return {name: (np.concatenate([one[name] for one in each]), units.get(name, "1")) for name in names}

    def stored(self, u: np.ndarray) -> tuple[float, float]:
        """Strain energy (J) in contacts, with that of joints, and in bonds at displacements (3, slots)."""
        in_contacts, in_bonds = super().stored(u)
        return in_contacts + sum(joint.stored() for joint in self.joints), in_bonds

    def take_cracks(self, steps: int) -> Cracks:
        """The bonds that broke since this was last called, and the places where joints lost their strength."""
        return joined([super().take_cracks(steps), cracks_of(self.joints)])

    def stress(self, displacement: np.ndarray) -> np.ndarray:
        """Stress (m, 3) xx, yy, xy in Pa of all particles at displacements (3, n), tension positive.

        In damped ground differences from the stress at rest are those of the moduli of the given wave speeds, which are
        right at their frequency.
        """
        stress = self._unrelaxed_stress(displacement)
        if not self.disks.are_damped:
            return stress
        rest = 0.0 if self._stress_at_rest is None else self._stress_at_rest
        return rest + (stress - rest) / unrelaxed(self.scene)[: len(stress), None]

    def _unrelaxed_stress(self, displacement: np.ndarray) -> np.ndarray:
        """Stress (m, 3) at displacements (3, n) that have just been reached, including that of a static stage.

        Under the history-dependent law its forces, and those of joints, are those at the beginning of the last step.
        """
        scene, found = self.scene, []
        for part in self.disks.parts:
            more = joint_pieces(self.joints if part is self.disks.parts[-1] else (), scene, displacement)  # in the body
            found.append(particle_stress(scene, part.stressed_pairs, displacement, part.geometry, more)[part.nodes])
        return np.concatenate(found)

    def snapshot(self, displacement: np.ndarray) -> dict[str, tuple[np.ndarray, str]]:
        """Fields of every disk at displacements (3, n) other than its motion; stress only with output.stress."""
        known = super().snapshot(displacement)
        if self.scene.case.output.stress:
            known["stress"] = self.stress(displacement), "Pa"
        return known

    def snapshot_beside(self, displacement: np.ndarray) -> dict[str, tuple[np.ndarray, str]]:
        """Stress of the nodes of the continuum, if there is one, at displacements (3, n)."""
        return next((part.snapshot(displacement) for part in self.parts if isinstance(part, GridPart)), {})

    def contact_forces(self, displacement: np.ndarray) -> dict[str, tuple[np.ndarray, str]]:
        """The contacts and bonds of the whole scene at displacements (3, n) of this one, see `contact_columns`.

        Only with output.contacts. If this scene is stepped in place of a larger one, which is under the elastic law,
        the contacts are those of the larger one.
        """
        scene, whole = self.scene, self.scene.whole
        if not scene.case.output.contacts:
            return {}
        lists = [(part.stressed_pairs, part.geometry) for part in self.disks.parts]
        if whole is not scene:
            assert isinstance(whole, DiskBody)
            displacement = scene.widened("displacement", displacement.T).T
            lists = [(plain_contacts(whole.inside, whole.assembly, whole.layout.slot), REFERENCE)]
        each = (pieces(whole.layout, pairs, displacement, geometry) for pairs, geometry in lists)
        return contact_columns(chain(*each, joint_pieces(self.joints, scene, displacement)))
