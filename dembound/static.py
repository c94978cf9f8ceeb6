"""The static stage: a damped run that brings a body to rest under steady loads and a given stress.

What its supports and the outside pushed with then acts on as a constant force F_0 on every particle (Z eqs 5, 6: the
unbalanced force F_eq with its sign turned), motion starts from rest, and the boundaries of the run take over.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from dembound.boundaries.support import SupportBuilder, Supports
from dembound.case.static import Static
from dembound.contacts import ContactList, Cracks
from dembound.engines import Bonded
from dembound.errors import RunError
from dembound.scene import Scene, boundary_medium
from dembound.simulate import Simulation, Start
from dembound.stability import step_limit

LOOK = 100
"""Steps between two looks at the force ratio."""

PATIENCE = 20_000
"""Steps without a tenth of progress after which a stage counts as stalled."""

RIM = 4.0
"""Width in mean diameters of the rim that is left out where a mean stress is taken."""

SAFETY = 0.9
"""Share of the stability limit taken as step."""


@dataclass(frozen=True)
class Settled:
    """A body at rest, and how it got there.

    Attributes
    ----------
    start : where the run begins.
    steps : steps it took.
    ratio : mean unbalanced over mean contact force at the end.
    carried : N, mean force with which supports and tractions held the particles they act on.
    left : N, mean unbalanced force on all other particles, which F_0 balances too.
    stress : (3,) mean xx, yy, xy in Pa over the body, tension positive.
    cracks : the bonds that broke on the way.
    """

    start: Start
    steps: int
    ratio: float
    carried: float
    left: float
    stress: np.ndarray
    cracks: Cracks


def settle(scene: Scene, on_look: Callable[[int, float], None] | None = None) -> Settled:
    """Run a scene's static stage; on_look gets the steps done and the force ratio from time to time.

    Raises RunError when it stalls, takes more steps than allowed, or the motion grows without bound, saying how far it
    got.
    """
    static = scene.case.static
    assert static is not None
    body = _StaticScene(scene, static)
    step = SAFETY * step_limit(body.scene, damp=static.damp)
    simulation = Simulation(body.scene, step, np.zeros(0), damp=static.damp, settling=True, load=body.load)
    contacts = simulation.contacts or scene.contact_list()
    best, best_at = np.inf, 0
    while True:
        simulation.advance(LOOK)
        forces = _contact_forces(simulation, contacts)
        ratio = body.force_ratio(forces, contacts)
        if on_look is not None:
            on_look(simulation.steps, ratio)
        if ratio <= static.ratio:
            break
        if ratio < 0.9 * best:
            best, best_at = ratio, simulation.steps
        _give_up(simulation.steps, simulation.steps - best_at, ratio, static)
    unbalanced = np.hypot(*(forces + scene.steady_load)[:2])
    held = body.held
    start = Start(simulation.displacement, simulation.contacts, isinstance(simulation.engine, Bonded))
    return Settled(
        start=start,
        steps=simulation.steps,
        ratio=float(ratio),
        carried=float(unbalanced[held].mean()) if held.any() else 0.0,
        left=float(unbalanced[~held].mean()) if not held.all() else 0.0,
        stress=mean_stress(scene, contacts, simulation.displacement),
        cracks=contacts.take_cracks(),
    )


def _give_up(steps: int, idle: int, ratio: float, static: Static) -> None:
    """Raise RunError if the stage has taken too long."""
    asked = f"static.ratio asks for {static.ratio:g}"
    if idle >= PATIENCE:
        raise RunError(
            f"the static stage stalls at a force ratio of {ratio:.3g} after {steps:,} steps, {asked}; "
            "is the body held, and can its contacts carry the load?"
        )
    if steps >= static.max_steps:
        raise RunError(
            f"the static stage came to a force ratio of {ratio:.3g} in {steps:,} steps, {asked}; "
            "allow more with static.max_steps"
        )


class _StaticScene:
    """A scene under its static supports and tractions."""

    def __init__(self, scene: Scene, static: Static) -> None:
        case = scene.case
        builder = SupportBuilder(held=scene.ground.held)
        for side, table in static.boundary.items():
            if side in scene.edges:
                edge = scene.edges[side]
                table.support(edge, boundary_medium(case, scene.ground, edge.axis), case.wave, builder)
        self.load = scene.steady_load + _tractions(scene, static)
        self.scene = replace(scene, supports=builder.table())
        self.held = np.zeros(scene.count, dtype=bool)
        for edge in scene.edges.values():
            self.held[edge.nodes] = static.stress is not None
        self.held[self.scene.supports.node] = True
        self._moves = np.repeat(scene.free[:2, None] > 0.0, scene.count, axis=1)
        supports: Supports = self.scene.supports
        across = supports.component < 2
        self._moves[supports.component[across], supports.node[across]] = False

    def force_ratio(self, forces: np.ndarray, contacts: ContactList) -> float:
        """Mean unbalanced force, along the directions particles can move in, over the mean contact force."""
        unbalanced = np.hypot(*np.where(self._moves, (forces + self.load)[:2], 0.0)).mean()
        pair = np.hypot(*contacts.arrays.force[:, :2].T)
        acting = pair > 0.0
        return float(unbalanced / pair[acting].mean()) if acting.any() else (np.inf if unbalanced > 0.0 else 0.0)


def _contact_forces(simulation: Simulation, contacts: ContactList) -> np.ndarray:
    """Contact forces and moments (3, n) now, under the elastic law with what was locked in."""
    if isinstance(simulation.engine, Bonded):
        return contacts.last_forces()
    return contacts.forces(simulation.displacement, reference=True)


def _tractions(scene: Scene, static: Static) -> np.ndarray:
    """Forces (3, n) with which the stress asked for pulls at the sides, by the particles' share of the diameters."""
    force = np.zeros((3, scene.count))
    if static.stress is None:
        return force
    xx, yy, xy = static.stress
    for side, edge in scene.edges.items():
        sign = 1.0 if side in ("right", "top") else -1.0
        pull = np.array([xx, xy] if edge.axis == 0 else [xy, yy]) * sign * edge.length
        force[:2, edge.nodes] += pull[:, None] * edge.diameters / edge.diameters.sum()
    loaded = np.unique(np.concatenate([edge.nodes for edge in scene.edges.values()]))
    return _without_torque(force, scene.assembly.positions, loaded)


def _without_torque(force: np.ndarray, positions: np.ndarray, loaded: np.ndarray) -> np.ndarray:
    """Forces (3, n) made free of torque by small ones on the loaded particles (k,), which uneven sides leave."""
    arm = positions - positions[loaded].mean(axis=0)
    torque = np.sum(arm[:, 0] * force[1] - arm[:, 1] * force[0])
    turn = np.stack([-arm[loaded, 1], arm[loaded, 0]])
    force[:2, loaded] -= torque / np.sum(turn**2) * turn
    return force


def mean_stress(scene: Scene, contacts: ContactList, displacement: np.ndarray) -> np.ndarray:
    """Mean stress (3,) xx, yy, xy in Pa inside a body, from its pairs' last forces; tension positive.

    A particle's stress is Σ f_a l n_b over its area with its share of the pores, f the force that pulls at it across a
    contact and l n the way from its centre to there. The mean is over particles away from the sides.
    """
    pairs, radii = contacts.arrays, scene.assembly.radii
    first, second = pairs.first.astype(np.int64), pairs.second.astype(np.int64)
    vectors = (displacement[:2, second] - displacement[:2, first]).T + pairs.palette[pairs.kind, :2]
    dyads = (pairs.force[:, :2, None] * vectors[:, None, :]).reshape(-1, 4)
    part = (0.5 + pairs.palette[pairs.kind, 4] / np.hypot(*vectors.T))[:, None]  # of the way, on the first one's side
    moments = np.zeros((scene.count, 4))
    np.add.at(moments, first, part * dyads)
    np.add.at(moments, second, (1.0 - part) * dyads)
    inside = _inside(scene)
    area = np.pi * np.sum(radii[inside] ** 2) / scene.ground.brick.solid_fraction
    xx, xy, yx, yy = moments[inside].sum(axis=0) / area
    return np.array([xx, yy, 0.5 * (xy + yx)])


def _inside(scene: Scene) -> np.ndarray:
    """Particles (n,) bool that stand a few diameters away from the sides; all of a small scene."""
    depth = RIM * scene.ground.brick.mean_diameter
    inside = np.ones(scene.count, dtype=bool)
    for axis, low in enumerate(("left", "bottom")):
        if low in scene.edges:
            place = scene.assembly.positions[:, axis]
            inside &= (place > depth) & (place < scene.assembly.size[axis] - depth)
    return inside if inside.any() else np.ones(scene.count, dtype=bool)
