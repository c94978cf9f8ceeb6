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
from dembound.scene import Scene, boundary_medium, column_alone
from dembound.simulate import Simulation, Start
from dembound.stability import step_limit
from dembound.stress import stress_now
from dembound.tractions import Tractions, mean_stress

LOOK = 100
"""Steps between two looks at the force ratio."""

PATIENCE = 20_000
"""Steps without a tenth of progress after which a stage counts as stalled."""

SAFETY = 0.9
"""Share of the stability limit taken as step."""

WORST = 3
"""Particles that a stalled stage names."""


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
    stress : (3,) mean xx, yy, xy in Pa inside the body's rim, tension positive.
    cracks : the bonds that broke on the way.
    tractions : (3,) Pa, the stress that the tractions were made of in the end; None without a stress asked for.
    before : what the body had come to before it was excavated, if it was; particles are numbered as they were then.
    column : what the free-field column had come to alone, if there is one.
    """

    start: Start
    steps: int
    ratio: float
    carried: float
    left: float
    stress: np.ndarray
    cracks: Cracks
    tractions: np.ndarray | None = None
    before: "Settled | None" = None
    column: "Settled | None" = None


class StalledError(RunError):
    """A static stage that does not come to rest.

    Attributes: simulation, the state it reached; unbalanced (n, 2), N, what each particle's forces come to then;
    cracks, the bonds that broke on the way.
    """

    def __init__(self, message: str, simulation: Simulation, unbalanced: np.ndarray, cracks: Cracks) -> None:
        super().__init__(message)
        self.simulation = simulation
        self.unbalanced = unbalanced
        self.cracks = cracks


def settle(scene: Scene, on_look: Callable[[int, float], None] | None = None) -> Settled:
    """Run a scene's static stage; on_look gets the steps done and the force ratio from time to time.

    A scene that is excavated settles before, and then anew from there, under the same loads on the same supports.
    Beside a free field the column settles first, alone; the body starts from its state, and both settle together: as
    laws with friction leave more than one state of rest, the body would else come to another one.

    Raises StalledError when it makes no more progress or takes more steps than allowed, saying how far it got, and
    RunError when the motion grows without bound.
    """
    if scene.before is not None:
        before = _settle_built(scene.before, on_look, "before the excavation the static stage")
        excavated = _settle(scene, _excavate(scene, before.start), on_look, tractions=before.tractions)
        return replace(excavated, before=before)
    return _settle_built(scene, on_look, "the static stage")


def _settle_built(scene: Scene, on_look: Callable[[int, float], None] | None, name: str) -> Settled:
    """The stage of a body as built, after that of its free-field column; name : what messages call it."""
    if scene.seam is None:
        return _settle(scene, None, on_look, name)
    column = _settle(column_alone(scene), None, on_look, f"{name} of the free-field column alone")
    return replace(_settle(scene, _beside(scene, column.start), on_look, name), column=column)


def _excavate(scene: Scene, before: Start) -> Start:
    """Where an excavated scene begins to settle: as it stood before, contacts with all their history."""
    assert scene.kept is not None
    contacts = None
    if before.contacts is not None:
        contacts = scene.contact_list()
        contacts.inherit(before.contacts, scene.kept)
    return Start(before.displacement[:, scene.kept], contacts, before.remembers)


def _beside(scene: Scene, column: Start) -> Start:
    """Where a body beside its settled column begins to settle: every particle and pair in the state of its twin."""
    assert scene.seam is not None
    displacement = column.displacement[:, scene.seam.twin]
    contacts = None
    if column.contacts is not None:
        contacts = scene.contact_list()
        if column.remembers:
            contacts.copy_column(column.contacts, displacement)
    return Start(displacement, contacts, column.remembers)


def _settle(
    scene: Scene,
    start: Start | None,
    on_look: Callable[[int, float], None] | None,
    name: str = "the static stage",
    tractions: np.ndarray | None = None,
) -> Settled:
    """One stage: from a start, or from the scene as built, to rest; tractions (3,) Pa, if they have been corrected."""
    static = scene.case.static
    assert static is not None
    body = _StaticScene(scene, static, tractions)
    step = SAFETY * step_limit(body.scene, damp=static.damp)
    load = body.load(np.zeros((3, scene.count)) if start is None else start.displacement)
    simulation = Simulation(body.scene, step, np.zeros(0), start=start, damp=static.damp, settling=True, load=load)
    contacts = simulation.contacts or scene.contact_list()
    best, best_at = np.inf, 0
    while True:
        simulation.advance(LOOK)
        body.keep_from_turning(simulation)
        forces = _contact_forces(simulation, contacts)
        ratio = body.force_ratio(simulation, forces, contacts)
        if on_look is not None:
            on_look(simulation.steps, ratio)
        if ratio <= static.ratio:
            if not body.correct(simulation):
                break
            best, best_at = np.inf, simulation.steps
        elif ratio < 0.9 * best:
            best, best_at = ratio, simulation.steps
        if simulation.steps - best_at >= PATIENCE or simulation.steps >= static.max_steps:
            lacking, cracks = body.unbalanced(simulation, forces), contacts.take_cracks()
            message = f"{name} {_where_it_ended(static, simulation, ratio, lacking, cracks)}"
            raise StalledError(message, simulation, lacking.T, cracks)
        body.turn_tractions(simulation)
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
        tractions=body.applied,
    )


def _where_it_ended(
    static: Static, simulation: Simulation, ratio: float, unbalanced: np.ndarray, cracks: Cracks
) -> str:
    """How far a stage came that takes too long, in words, and what to look at; unbalanced (2, n) N as `_lacking`."""
    steps = simulation.steps
    facts = f"static.ratio asks for {static.ratio:g}; broken bonds: {len(cracks):,}; {_lacking(simulation, unbalanced)}"
    if steps >= static.max_steps:
        return f"came to a force ratio of {ratio:.3g} in {steps:,} steps, {facts}; allow more with static.max_steps"
    return (
        f"stalls at a force ratio of {ratio:.3g} after {steps:,} steps, {facts}; "
        "is the body held, and can its contacts carry the load?"
    )


def _lacking(simulation: Simulation, unbalanced: np.ndarray) -> str:
    """Which particles lack most force, where and along which direction, and how many lack half of it all.

    unbalanced (2, n) N is what the forces on each come to.
    """
    scene, size = simulation.scene, np.hypot(*unbalanced)
    order = np.argsort(-size, kind="stable")
    half = 1 + int(np.searchsorted(np.cumsum(size[order]), 0.5 * size.sum()))
    places = scene.positions + simulation.displacement[:2].T
    worst = [
        f"particle {i} at ({places[i, 0]:.2f}, {places[i, 1]:.2f}) m lacks ({0.0 - unbalanced[0, i]:.3g}, "
        f"{0.0 - unbalanced[1, i]:.3g}) N"
        for i in order[: min(WORST, len(order))]
    ]
    low, high = places[order[:half]].min(axis=0), places[order[:half]].max(axis=0)
    return (
        f"{', '.join(worst)}; {half:,} of {scene.count:,} particles lack half of all, between "
        f"({low[0]:.2f}, {low[1]:.2f}) and ({high[0]:.2f}, {high[1]:.2f}) m"
    )


class _StaticScene:
    """A scene under its static supports and tractions."""

    def __init__(self, scene: Scene, static: Static, tractions: np.ndarray | None) -> None:
        case = scene.case
        builder = SupportBuilder(held=scene.ground.held)
        free_field = {side: table for side, table in case.boundary.items() if isinstance(table, FreeField)}
        for side, table in (free_field | dict(static.boundary)).items():
            if side in scene.edges:
                edge = scene.edges[side]
                table.support(edge, boundary_medium(case, scene.ground, edge.axis), case.wave, builder)
        self._steady = scene.steady_load
        self._tractions = None if static.stress is None else Tractions(scene, static.stress, tractions)
        self.scene = replace(scene, supports=builder.table())
        self.held = np.zeros(scene.count, dtype=bool)
        for edge in scene.edges.values():
            self.held[edge.nodes] = static.stress is not None
        supports: Supports = self.scene.supports
        self.held[supports.node[supports.prescribed]] = True  # dashpots carry nothing at rest
        self._floats = len(supports) == 0
        held = bool((scene.free[:2] == 0.0).any())
        self._by_tractions_alone = self._floats and not held and not scene.steady_load.any()
        self._moves = np.repeat(scene.free[:2, None] > 0.0, scene.count, axis=1)
        across = (supports.component < 2) & supports.prescribed
        self._moves[supports.component[across], supports.node[across]] = False

    def load(self, displacement: np.ndarray) -> np.ndarray:
        """All steady forces (3, n) N and N·m at displacements (3, n)."""
        return self._steady + (0.0 if self._tractions is None else self._tractions.forces(displacement))

    @property
    def applied(self) -> np.ndarray | None:
        """The stress (3,) Pa that the tractions are made of, if one was asked for."""
        return None if self._tractions is None else self._tractions.applied

    def correct(self, simulation: Simulation) -> bool:
        """Correct the tractions of a body at rest by what the stress inside lacks; whether it lacked something.

        Beside steady loads, whose stress comes on top of the one asked for, and beside supports, which bear a part of
        it, nothing is corrected.
        """
        if self._tractions is None or not self._by_tractions_alone:
            return False
        return self._tractions.correct(mean_stress(self.scene, stress_now(simulation)))

    def turn_tractions(self, simulation: Simulation) -> None:
        """Let tractions follow the sides, or what was corrected take effect."""
        if self._tractions is not None:
            simulation.apply(self.load(simulation.displacement))

    def keep_from_turning(self, simulation: Simulation) -> None:
        """Stop the motion as a whole of a body that nothing holds, which has no force to bring it to rest."""
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

    def unbalanced(self, simulation: Simulation, forces: np.ndarray) -> np.ndarray:
        """Unbalanced forces (2, n) N along the directions particles can move in, for contact forces (3, n)."""
        return np.where(self._moves, (forces + simulation.load)[:2], 0.0)

    def force_ratio(self, simulation: Simulation, forces: np.ndarray, contacts: ContactList) -> float:
        """Mean unbalanced force over the mean contact force."""
        unbalanced = np.hypot(*self.unbalanced(simulation, forces)).mean()
        pair = np.hypot(*contacts.arrays.force[:, :2].T)
        acting = pair > 0.0
        return float(unbalanced / pair[acting].mean()) if acting.any() else (np.inf if unbalanced > 0.0 else 0.0)


def _contact_forces(simulation: Simulation, contacts: ContactList) -> np.ndarray:
    """Contact forces and moments (3, n) now, under the elastic law with what was locked in."""
    if isinstance(simulation.engine, Bonded):
        return contacts.last_forces()
    return contacts.forces(simulation.displacement, reference=True)
