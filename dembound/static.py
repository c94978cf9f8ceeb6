"""The static stage: a damped run that brings a body to rest under steady loads and a given stress.

What its supports and the outside pushed with then acts on as a constant force F_0 on every particle (Z eqs 5, 6: the
unbalanced force F_eq with its sign turned), motion starts from rest, and the boundaries of the run take over.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from dembound.boundaries import FreeField
from dembound.boundaries.support import SupportBuilder, Supports
from dembound.case.static import Static
from dembound.contacts import ContactList, Cracks
from dembound.engines import Bonded
from dembound.errors import RunError
from dembound.scene import Scene, boundary_medium
from dembound.simulate import Simulation, Start
from dembound.stability import step_limit
from dembound.stress import stress_now

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
    before : what the body had come to before it was excavated, if it was; particles are numbered as they were then.
    """

    start: Start
    steps: int
    ratio: float
    carried: float
    left: float
    stress: np.ndarray
    cracks: Cracks
    before: "Settled | None" = None


def settle(scene: Scene, on_look: Callable[[int, float], None] | None = None) -> Settled:
    """Run a scene's static stage; on_look gets the steps done and the force ratio from time to time.

    A scene that is excavated settles before, and then anew from there, under the same loads on the same supports.

    Raises RunError when it stalls, takes more steps than allowed, or the motion grows without bound, saying how far it
    got.
    """
    if scene.before is None:
        return _settle(scene, None, on_look)
    before = settle(scene.before, on_look)
    return replace(_settle(scene, _excavate(scene, before.start), on_look), before=before)


def _excavate(scene: Scene, before: Start) -> Start:
    """Where an excavated scene begins to settle: as it stood before, contacts with all they remember."""
    assert scene.kept is not None
    contacts = None
    if before.contacts is not None:
        contacts = scene.contact_list()
        contacts.inherit(before.contacts, scene.kept)
    return Start(before.displacement[:, scene.kept], contacts, before.remembers)


def _settle(scene: Scene, start: Start | None, on_look: Callable[[int, float], None] | None) -> Settled:
    """One stage: from a start, or from the scene as built, to rest."""
    static = scene.case.static
    assert static is not None
    body = _StaticScene(scene, static)
    step = SAFETY * step_limit(body.scene, damp=static.damp)
    simulation = Simulation(body.scene, step, np.zeros(0), start=start, damp=static.damp, settling=True, load=body.load)
    contacts = simulation.contacts or scene.contact_list()
    best, best_at = np.inf, 0
    while True:
        simulation.advance(LOOK)
        body.keep_from_turning(simulation)
        forces = _contact_forces(simulation, contacts)
        ratio = body.force_ratio(forces, contacts)
        if on_look is not None:
            on_look(simulation.steps, ratio)
        if ratio <= static.ratio:
            break
        if ratio < 0.9 * best:
            best, best_at = ratio, simulation.steps
        if simulation.steps - best_at >= PATIENCE or simulation.steps >= static.max_steps:
            raise RunError(_where_it_ended(body, static, simulation, contacts, forces))
    unbalanced = np.hypot(*(forces + scene.steady_load)[:2])
    held = body.held
    return Settled(
        start=Start(simulation.displacement, simulation.contacts, isinstance(simulation.engine, Bonded)),
        steps=simulation.steps,
        ratio=float(ratio),
        carried=float(unbalanced[held].mean()) if held.any() else 0.0,
        left=float(unbalanced[~held].mean()) if not held.all() else 0.0,
        stress=mean_stress(scene, stress_now(simulation)),
        cracks=contacts.take_cracks(),
    )


def _where_it_ended(
    body: "_StaticScene", static: Static, simulation: Simulation, contacts: ContactList, forces: np.ndarray
) -> str:
    """How far a stage came that takes too long, in words, and what to look at; forces (3, n) are those of contacts."""
    steps, ratio = simulation.steps, body.force_ratio(forces, contacts)
    lacking = body.unbalanced(forces)
    worst = int(np.argmax(lacking))
    x, y = body.scene.assembly.positions[worst] + simulation.displacement[:2, worst]
    facts = (
        f"static.ratio asks for {static.ratio:g}; broken bonds: {len(contacts.take_cracks()):,}; "
        f"particle {worst} at ({x:.2f}, {y:.2f}) m lacks most, {lacking[worst]:.3g} N"
    )
    if steps >= static.max_steps:
        return (
            f"the static stage came to a force ratio of {ratio:.3g} in {steps:,} steps, {facts}; "
            "allow more with static.max_steps"
        )
    return (
        f"the static stage stalls at a force ratio of {ratio:.3g} after {steps:,} steps, {facts}; "
        "is the body held, and can its contacts carry the load?"
    )


class _StaticScene:
    """A scene under its static supports and tractions."""

    def __init__(self, scene: Scene, static: Static) -> None:
        case = scene.case
        builder = SupportBuilder(held=scene.ground.held)
        free_field = {side: table for side, table in case.boundary.items() if isinstance(table, FreeField)}
        for side, table in (free_field | dict(static.boundary)).items():
            if side in scene.edges:
                edge = scene.edges[side]
                table.support(edge, boundary_medium(case, scene.ground, edge.axis), case.wave, builder)
        self.load = scene.steady_load + _tractions(scene, static)
        self.scene = replace(scene, supports=builder.table())
        self.held = np.zeros(scene.count, dtype=bool)
        for edge in scene.edges.values():
            self.held[edge.nodes] = static.stress is not None
        supports: Supports = self.scene.supports
        self.held[supports.node[supports.prescribed]] = True  # dashpots carry nothing at rest
        self._floats = len(supports) == 0
        self._moves = np.repeat(scene.free[:2, None] > 0.0, scene.count, axis=1)
        across = (supports.component < 2) & supports.prescribed
        self._moves[supports.component[across], supports.node[across]] = False

    def keep_from_turning(self, simulation: Simulation) -> None:
        """Stop the motion as a whole of a body that nothing holds: under forces that keep their direction it tips."""
        if not self._floats:
            return
        mass, velocity = self.scene.mass, simulation.velocity
        arm = self.scene.assembly.positions + simulation.displacement[:2].T
        arm = (arm - np.average(arm, axis=0, weights=mass)).T
        velocity[:2] -= np.average(velocity[:2], axis=1, weights=mass)[:, None] * self.scene.free[:2, None]
        if not self.scene.free.all():
            return
        spin = np.sum(mass * (arm[0] * velocity[1] - arm[1] * velocity[0])) + np.sum(self.scene.inertia * velocity[2])
        rate = spin / (np.sum(mass * (arm**2).sum(axis=0)) + self.scene.inertia.sum())
        velocity -= rate * np.stack([-arm[1], arm[0], np.ones(self.scene.count)])

    def unbalanced(self, forces: np.ndarray) -> np.ndarray:
        """Unbalanced force (n,) N along the directions particles can move in, for contact forces (3, n)."""
        return np.hypot(*np.where(self._moves, (forces + self.load)[:2], 0.0))

    def force_ratio(self, forces: np.ndarray, contacts: ContactList) -> float:
        """Mean unbalanced force over the mean contact force."""
        unbalanced = self.unbalanced(forces).mean()
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


def mean_stress(scene: Scene, stress: np.ndarray) -> np.ndarray:
    """Mean stress (3,) inside a body, over the area of its particles away from the sides; stress (n, 3) of each."""
    inside = _inside(scene)
    return np.average(stress[inside], axis=0, weights=(scene.assembly.radii**2 * scene.share)[inside])


def _inside(scene: Scene) -> np.ndarray:
    """Particles (n,) bool that stand a few diameters away from the sides; all of a small scene."""
    depth = RIM * scene.ground.brick.mean_diameter
    inside = np.ones(scene.count, dtype=bool)
    for axis, low in enumerate(("left", "bottom")):
        if low in scene.edges:
            place = scene.assembly.positions[:, axis]
            inside &= (place > depth) & (place < scene.assembly.size[axis] - depth)
    return inside if inside.any() else np.ones(scene.count, dtype=bool)
