"""A scene of disks under the supports and tractions of its static stage."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from dembound.boundaries.boundary import Boundary
from dembound.boundaries.edge import BoundaryMedium, Edge, normal_axis
from dembound.boundaries.support import SupportBuilder, Supports
from dembound.casefile.disks.static import Static
from dembound.disks.columns import columns_stand_fast, standing_fast
from dembound.disks.contacts.contact_list import ContactList
from dembound.disks.material.constants import limits_of
from dembound.disks.scene import DiskScene
from dembound.disks.side_forces import forces_at_rest, side_forces
from dembound.disks.sides import media_of
from dembound.disks.stepping.balance import mean_rotations
from dembound.disks.stepping.system import DiskSystem
from dembound.disks.supports import forces_of
from dembound.errors import CaseError
from dembound.kernels.contacts import UPDATED
from dembound.motion.state import State
from dembound.packings.cut import BEYOND


class Tractions:
    """Forces of a target stress on the sides of a body: those of the packing beyond, see `side_forces`.

    Under them an elastic body has the stress everywhere.

    Parameters
    ----------
    scene : the body.
    stress : (3,) xx, yy, xy in Pa, tension positive.

    Attributes
    ----------
    nodes : (k,) disks on which they act, ascending.

    Raises CaseError for sides without disks.
    """

    def __init__(self, scene: DiskScene, stress: tuple[float, float, float]) -> None:
        self.scene = scene
        self._follow = limits_of(scene.case.material).geometry == UPDATED
        self._sides = {side: (each.node, each.under(np.array(stress))) for side, each in side_forces(scene).items()}
        if empty := [side for side, (node, _) in self._sides.items() if len(node) == 0]:
            said = f"acts on no disk at {' and '.join(empty)}; let packing.size end at the body"
            raise CaseError([f"static.stress: {said}"])
        self.nodes = np.unique(np.concatenate([node for node, _ in self._sides.values()]))

    def forces(self, displacement: np.ndarray) -> np.ndarray:
        """Forces and moments (3, n) N and N·m at displacements (3, n).

        With the updated geometry the forces rotate with their side, and grow with its length. Small additional
        forces cancel the remaining resultant and torque of strained sides, or of sides that a hole reaches.
        """
        moved = displacement if self._follow else np.zeros_like(displacement)
        force = np.zeros_like(displacement)
        rotations, stretch = mean_rotations(self.scene, moved), self._stretch(moved)
        for side, (node, pull) in self._sides.items():
            angle, longer = rotations.get(side, 0.0), stretch[1 - normal_axis(side)]
            turn = longer * np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
            force[:, node] += np.concatenate([turn @ pull[:2], longer * pull[2:]])
        return _balanced(force, self.scene.assembly.positions + moved[:2].T, self.nodes)

    def _stretch(self, moved: np.ndarray) -> list[float]:
        """Width and height at displacements (3, n) over those as built, from the distances of opposite sides."""
        edges, places = self.scene.edges, self.scene.assembly.positions
        stretch = [1.0, 1.0]
        for axis, (low, high) in enumerate(BEYOND):
            if low in edges:
                apart = places[edges[high].nodes].mean(axis=0) - places[edges[low].nodes].mean(axis=0)
                more = moved[:2, edges[high].nodes].mean(axis=1) - moved[:2, edges[low].nodes].mean(axis=1)
                stretch[axis] = float(np.hypot(*(apart + more)) / np.hypot(*apart))
        return stretch


def _balanced(force: np.ndarray, positions: np.ndarray, loaded: np.ndarray) -> np.ndarray:
    """Forces (3, n) without resultant and torque, by small additional forces on the loaded particles (k,).

    positions : (n, 2) m.
    """
    force[:2, loaded] -= force[:2].sum(axis=1, keepdims=True) / len(loaded)
    arm = positions - positions[loaded].mean(axis=0)
    torque = np.sum(arm[:, 0] * force[1] - arm[:, 1] * force[0]) + np.sum(force[2])
    turn = np.stack([-arm[loaded, 1], arm[loaded, 0]])
    if (size := np.sum(turn**2)) > 0.0:  # a single disk has no arm
        force[:2, loaded] -= torque / size * turn
    return force


class StaticScene:
    """A scene under its static supports and tractions.

    Raises CaseError for a target stress at sides without disks, and for steady loads on a continuum that is left out.
    """

    def __init__(self, scene: DiskScene, static: Static) -> None:
        case = scene.case
        builder = SupportBuilder(held=scene.ground.held)
        free_field = {side: table for side, table in case.boundary.items() if table.needs_column}
        for side, table in (free_field | dict(static.boundary)).items():
            if side in scene.edges:
                for part, medium in media_of(scene, side):
                    _support(scene, table, part, medium, builder)
                if scene.seams and columns_stand_fast(scene.case, scene.seams):
                    columns = scene.edges[side].only(scene.edges[side].nodes < scene.column_count, 0.0)
                    held = {*table.prescribed(columns.axis), *builder.held}
                    for component in sorted({*standing_fast(table).prescribed(columns.axis)} - held):
                        builder.add(columns.nodes, component, prescribed=True)
        self.static = static
        stressed = scene.at_rest is not None
        self._tractions = None if static.stress is None or stressed else Tractions(scene, static.stress)
        self.scene = without_own_continua(scene)
        _require_loads_within(scene, self.scene)
        self._beyond = forces_at_rest(self.scene) if stressed else None
        for each in self.scene.continua:
            each.support(builder)
        self.scene = replace(self.scene, supports=builder.table())
        self.held = np.zeros(scene.disk_count, dtype=bool)
        if self._tractions is not None:
            self.held[self._tractions.nodes] = True
        supports: Supports = self.scene.supports
        nodes = supports.node[supports.prescribed]  # dashpots have no force at rest
        self.held[nodes[nodes < scene.disk_count]] = True
        self._floats = len(supports) == 0
        self._moves = np.repeat(scene.free[:2, None] > 0.0, scene.disk_count, axis=1)
        across = (supports.component < 2) & supports.prescribed
        self._moves[supports.component[across], supports.node[across]] = False

    def load(self, displacement: np.ndarray) -> np.ndarray:
        """All steady forces (3, n) N and N·m at displacements (3, n)."""
        if self._beyond is not None:
            return self.scene.steady_load + self._beyond
        return self.scene.steady_load + (0.0 if self._tractions is None else self._tractions.forces(displacement))

    def keep_from_turning(self, state: State) -> None:
        """Stop the rigid motion of a body that is not held, as no force would bring it to rest."""
        if not self._floats:
            return
        mass, velocity = self.scene.mass, state.velocity.copy()
        arm = self.scene.assembly.positions + state.displacement[:2].T
        arm = (arm - np.average(arm, axis=0, weights=mass)).T
        velocity[:2] -= np.average(velocity[:2], axis=1, weights=mass)[:, None] * self.scene.free[:2, None]
        state.velocity = velocity
        if any(self.scene.case.periodic) or not self.scene.free.all():
            return
        spin = np.sum(mass * (arm[0] * velocity[1] - arm[1] * velocity[0])) + np.sum(self.scene.inertia * velocity[2])
        rate = spin / (np.sum(mass * (arm**2).sum(axis=0)) + self.scene.inertia.sum())
        state.velocity = velocity - rate * np.stack([-arm[1], arm[0], np.ones(self.scene.count)])

    def unbalanced(self, system: DiskSystem, forces: np.ndarray) -> np.ndarray:
        """Unbalanced forces (2, m) N on disks along the directions in which they can move, for forces (3, n)."""
        return np.where(self._moves, (forces + system.load)[:2, : self._moves.shape[1]], 0.0)

    def force_ratio(self, system: DiskSystem, forces: np.ndarray, contacts: Mapping[str, ContactList]) -> float:
        """Mean unbalanced force over the mean contact force, for contact forces (3, n) and the pairs of each part.

        Walls count as contacts.
        """
        unbalanced = np.hypot(*self.unbalanced(system, forces)).mean()
        walls = [] if system.walls is None else [system.walls.sizes]
        pair = np.concatenate([*(np.hypot(*pairs.arrays.force[:2]) for pairs in contacts.values()), *walls])
        acting = pair > 0.0
        return float(unbalanced / pair[acting].mean()) if acting.any() else (np.inf if unbalanced > 0.0 else 0.0)


def _support(scene: DiskScene, table: Boundary, edge: Edge, medium: BoundaryMedium, builder: SupportBuilder) -> None:
    """Add the rows of a side; disks without bonds are not kept from turning.

    The moment that kept them would go on acting in the run, where nothing but friction holds such a disk.
    """
    held, alone = builder.held, ~np.isin(edge.nodes, scene.bonds)
    if 2 not in table.prescribed(edge.axis) or not alone.any():
        table.support(edge, medium, scene.case.wave, builder)
        return
    for chosen, components in ((~alone, held), (alone, (*held, 2))):
        builder.held = components
        table.support(edge.only(chosen, edge.length), medium, scene.case.wave, builder)
    builder.held = held


def without_own_continua(scene: DiskScene) -> DiskScene:
    """A scene without continua tied by the absolute motion of its disks; supports hold it in their place.

    Continua tied by the motion relative to the free-field column stay, as a hole moves the ground round it.
    """
    beyond = scene.outside if scene.outside is not None and len(scene.seams) == 1 else None
    return replace(scene, outside=beyond, feet=())


def _require_loads_within(scene: DiskScene, static: DiskScene) -> None:
    """Raise CaseError for steady loads of a scene on the continuum that its static stage is without."""
    steady = [load for load in scene.case.load if load.wave is None and static.outside is None]
    nodes = {load.name: forces_of(load, scene)[0] for load in steady if scene.outside is not None}
    said = "acts on the surface of the continuum, which the static stage is without; give it a wave, or load particles"
    if problems := [f"load.{name}: {said}" for name, on in nodes.items() if (on >= scene.disk_count).any()]:
        raise CaseError(problems)
