"""The loop: advance a scene in time, watch that it stays sound."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from dembound.any_scene import AnyScene
from dembound.balance import Balance
from dembound.bar.engine import BarEngine
from dembound.bar.scene import BarScene
from dembound.boundaries.support import Supports
from dembound.contacts import ContactList, Cracks
from dembound.engine import Engine
from dembound.engines import NO_FOLLOWERS, Bonded, Elastic
from dembound.errors import RunError
from dembound.kernels import tables
from dembound.kernels.contacts import UPDATED
from dembound.kernels.follower import turn_forces
from dembound.rotation import turn_as_a_whole, turns_freely
from dembound.scene import Scene
from dembound.threads import threads_for

DRIVEN_BYTES = 64e6
"""Most memory for the drives of a block; many driven particles make blocks shorter."""

RUNAWAY = 1e4
"""A particle this many times as fast as all waves together has left physics: resonance gives factors of ten."""

FASTEST = 1e100
"""Speed (m/s) beyond which energies come near the end of what numbers can say, 1e308 J."""


@dataclass(frozen=True)
class Start:
    """A body at rest to start from: displacement (3, n) since it was built, its contacts, whether they have a history.

    The simulation that starts from it goes on with its contacts, so it is good for one. contacts is None, and remembers
    false, where the scene's law has no history.
    """

    displacement: np.ndarray
    contacts: ContactList | None
    remembers: bool


class Simulation:
    """A scene in motion, from rest at time zero.

    Parameters
    ----------
    scene : what moves, disks or a bar; start, damp, settling and load are for disks.
    time_step : Δt in s; the caller has compared it with the stability limit.
    probes : (p,) particles whose motion `advance` returns at every step.
    start : a body that has settled; whatever pushes its particles is balanced from then on, unless it is `settling`
        anew. None: as built, with nothing balanced.
    damp : local damping coefficient; None: the material's.
    settling : whether the body is on its way to rest, so that its forces are not balanced.
    load : (3, n) steady forces and moments (N, N·m); None: the scene's own.

    Attributes
    ----------
    displacement, velocity : (3, n) m and rad, m/s and rad/s; velocities are half a time step behind.
    datum : (3, n) displacement at the start.
    load : (3, n) steady forces and moments on all particles (N, N·m) beside those of contacts and what balances them.
    balance : what balances the forces in a body that has settled; None for one as built or settling.
    switch_velocity : (3, n) velocity with which the history-dependent law began, half a step before it did; None under
        the elastic one.
    steps : steps done.
    laws : name of each law used and the step it began with.
    work : (2, 6) J, see kernels.tables.Log.
    tracked : (q,) the particles of all edges, in the order of `scene.edges`.
    peaks : (q, 3, 2) smallest and largest velocity of each so far.
    top_speed : (n,) m/s, largest speed of every particle so far; (0,) unless the case asks for it.
    """

    def __init__(
        self,
        scene: AnyScene,
        time_step: float,
        probes: np.ndarray,
        *,
        start: Start | None = None,
        damp: float | None = None,
        settling: bool = False,
        load: np.ndarray | None = None,
    ) -> None:
        self.scene = scene
        self.time_step = time_step
        self.probes = np.asarray(probes, dtype=np.int64)
        self.steps = 0
        self.datum = np.zeros((3, scene.count)) if start is None else start.displacement
        self.displacement = self.datum.copy()
        self.velocity = np.zeros((3, scene.count))
        self._spare = np.zeros((3, scene.count))
        edges = [edge.nodes for edge in scene.edges.values()]
        self.tracked = np.concatenate(edges) if edges else np.zeros(0, dtype=np.int64)
        self.peaks = np.zeros((len(self.tracked), 3, 2))
        self.top_speed = np.zeros(scene.count if scene.case.output.peaks else 0)
        self.work = np.zeros((2, 6))
        self._damp = scene.damp if damp is None else damp
        self._fastest = _runaway_speed(scene)
        self._supports = NodeSupports(scene, time_step)
        self._mobility = self._where_unsupported(time_step / scene.mass)
        self._inverse_inertia = self._where_unsupported(time_step / scene.inertia)
        self.contacts: ContactList | None = None
        self.balance: Balance | None = None
        self.switch_velocity: np.ndarray | None = None
        self.engine: Engine
        self.load = scene.steady_load if load is None else load
        self._steady = np.zeros((3, 0))  # what the kernels add to the forces of contacts or bonds
        if isinstance(scene, BarScene):
            self.engine = BarEngine(scene, time_step)
            self.laws = [(self.engine.name, 0)]
            return
        if scene.remembers:
            self.contacts = scene.contact_list() if start is None else start.contacts
        self._begin(scene, start, settling=settling)

    def apply(self, load: np.ndarray) -> None:
        """Take other steady forces and moments (3, n) from here on, of a body that is settling."""
        if self._steady.shape[1] == 0:
            self._steady = np.zeros_like(load)
        self._steady += load - self.load
        self.load = load

    def _begin(self, scene: Scene, start: Start | None, *, settling: bool) -> None:
        """Choose the law disks begin with, and the steady forces that go with it."""
        elastic = Elastic(scene, self.contacts)
        remembers = start is not None and start.remembers
        steady = self.load
        if start is not None and not settling:
            resting = self._resting_force(elastic, remembers)
            springs = self._supports.springs_at(self.datum)
            self.balance = Balance(scene, springs - resting - self.load, self.load, self.datum, self._across(scene))
            steady = springs - elastic.force(self.datum)
        elif self.contacts is not None and not remembers:
            # the elastic law does not know the forces of the body as built, as of a locked-in stress
            self.contacts.adopt(np.zeros_like(self.load))
            steady = self.load + self.contacts.forces(np.zeros_like(self.load))
        self.engine = elastic
        self.laws = [(elastic.name, 0)]
        if steady.any():
            self._steady = steady.copy()
        # a locked-in stress also comes through the seam of a free field, of which the elastic law would not know
        through = scene.seam is not None and scene.case.material.locked_in is not None and not settling
        if remembers or (self.contacts is not None and (through or not scene.case.material.elastic_start)):
            self.laws = []
            self._hand_over(fresh=not remembers)

    def _resting_force(self, elastic: Elastic, remembers: bool) -> np.ndarray:
        """Contact forces (3, n) of the body at rest at the datum."""
        if self.contacts is None:
            return elastic.force(self.datum)
        if not remembers:
            self.contacts.adopt(self.datum)
        return self.contacts.forces(self.datum)

    def _across(self, scene: Scene) -> np.ndarray:
        """Forces and moments (3, n) that come through the seam of a free field, from the pairs' last forces."""
        force = np.zeros((3, scene.count))
        if scene.seam is not None and self.contacts is not None:
            force[:, scene.seam.node] = self.contacts.across_the_seam()
        return force

    def _hand_over(self, fresh: bool = True) -> None:
        """From here on the history-dependent law; fresh: without any history yet."""
        assert self.contacts is not None
        assert isinstance(self.scene, Scene)
        before = self._potential() if self.laws else None
        if fresh and self.contacts.limits.geometry == UPDATED and turns_freely(self.scene):
            turn_as_a_whole(self.scene, self.displacement, self.velocity, self.datum)
        if fresh:
            self.contacts.adopt(self.displacement)
        self.engine = Bonded(self.contacts, self.balance)
        if self.balance is not None:
            self.balance.count_breaks_from(self.contacts)
        if before is not None:
            self.work[:, 4] += self._potential() - before
        if fresh:
            self.contacts.adopt(self.displacement - self.time_step * self.velocity)  # its first push adds this step
        self._steady = self.load + (0.0 if self.balance is None else self.balance.force)
        if before is not None and self.engine.followers is not NO_FOLLOWERS:
            # the step to come counts the work of turning from half a step ago, when forces did not turn yet
            steady, step = self._steady.copy(), self.time_step
            self.work[:, 4] -= turn_forces(self.displacement, self.velocity, self.engine.followers, steady, step)
        self.switch_velocity = self.velocity.copy()
        self.laws.append((self.engine.name, self.steps))

    def _potential(self) -> float:
        """Energy (J) stored in contacts and bonds less the work of steady and balancing forces since the start."""
        balancing = 0.0 if self.balance is None else self.balance.work(self.displacement)
        steady = float(np.sum(self.load * (self.displacement - self.datum)))
        return sum(self.engine.stored(self.displacement)) - steady - balancing

    @property
    def time(self) -> float:
        """Time of the current displacements (s)."""
        return self.steps * self.time_step

    def advance(self, steps: int) -> np.ndarray:
        """Go on by `steps` steps; returns (steps, p, 6): displacement and velocity of the probes before each.

        Displacements count from the start. In a bar stress (Pa) is a seventh. Raises RunError when the motion grows
        without bound, saying when and where.
        """
        record = np.empty((steps, len(self.probes), self.scene.record_width))
        at_once = max(1, int(DRIVEN_BYTES / (24 * max(1, len(self._supports.nodes)))))
        with threads_for(self.scene.count):
            for first in range(0, steps, at_once):
                self._advance(record[first : first + at_once])
        record[..., :3] -= self.datum[:, self.probes].T
        if self.contacts is not None:
            self.contacts.note_cracks(self.displacement)
        self._watch()
        return record

    def _advance(self, record: np.ndarray) -> None:
        """As many steps as the record (k, p, 6 or 7) has room for, under one law after the other if need be."""
        supports = self._supports.table((self.steps + np.arange(len(record))) * self.time_step)
        done = 0
        while done < len(record):
            remaining = supports._replace(drive=supports.drive[done:])
            done += self._advance_under_one_law(record[done:], remaining)

    def _advance_under_one_law(self, record: np.ndarray, supports: tables.Supports) -> int:
        """As many of these steps as one law, or one list of pairs or bonds, is good for; returns those done."""
        body = tables.Body(
            self._mobility,
            self._inverse_inertia,
            self.scene.free,
            self._steady,
            self._damp,
            self.time_step,
        )
        log = tables.Log(self.probes, record, self.tracked, self.peaks, self.top_speed, self.work)
        done = self.engine.advance(self.displacement, self._spare, self.velocity, self.steps, body, supports, log)
        self.steps += done
        if self.engine.ended:
            self._hand_over()
        if self.engine.name != self.laws[-1][0]:
            self.laws.append((self.engine.name, self.steps))
        return done

    def take_cracks(self) -> Cracks:
        """The bonds that broke since this was last called."""
        return self.engine.take_cracks(self.steps)

    def run(self, steps: int, on_block: Callable[["Simulation", np.ndarray], None] | None = None) -> None:
        """Advance to `steps` steps in all, block by block.

        on_block gets the simulation and the block's record, see `advance`.
        """
        while self.steps < steps:
            record = self.advance(min(self.scene.block, steps - self.steps))
            if on_block is not None:
                on_block(self, record)

    def edge_peaks(self, side: str) -> np.ndarray:
        """Smallest and largest velocity so far of the particles of one edge, (k, 3, 2)."""
        return self.peaks[self._of_edge(side)]

    def _of_edge(self, side: str) -> slice:
        """Where a side's particles stand among the tracked ones."""
        sides = list(self.scene.edges)
        counts = [len(self.scene.edges[s].nodes) for s in sides[: sides.index(side)]]
        return slice(sum(counts), sum(counts) + len(self.scene.edges[side].nodes))

    def _where_unsupported(self, mobility: np.ndarray) -> np.ndarray:
        """Mobility (n,) of the particles the support table does not move."""
        mobility[self._supports.nodes] = 0.0
        return mobility

    def _watch(self) -> None:
        """Raise RunError when a particle is faster than any wave could make it."""
        speed = np.abs(self.velocity[:2]).max(axis=0)
        sound = speed <= self._fastest  # false for what is not a number, too
        where = self.engine.blown_up(self.velocity) if sound.all() else int(np.argmin(sound))
        if where is not None:
            place = self.scene.positions[where]
            raise RunError(
                f"the motion grew without bound: at t = {self.time:g} s near ({place[0]:g}, {place[1]:g}) m; "
                "take a smaller run.time_step, run.safety or, of a bar, run.courant, or smaller waves and loads"
            )


def _runaway_speed(scene: AnyScene) -> float:
    """Speed (m/s) that no particle can have; where more than waves moves them, that of the largest numbers."""
    waves = sum(wave.peak() for wave in scene.case.wave.values())
    free = scene.case.load or scene.remembers
    return min(RUNAWAY * waves, FASTEST) if waves and not free else FASTEST


class NodeSupports:
    """The support table as the kernels apply it, one line per supported particle and all three components.

    Attributes: nodes (k,); inertia, keep, mobility, stiffness, prescribed (k, 3), see kernels.tables.Supports.
    """

    def __init__(self, scene: AnyScene, time_step: float) -> None:
        self._rows: Supports = scene.supports
        self._half_step = 0.5 * time_step
        across = scene.seam.node if scene.seam is not None else np.zeros(0, dtype=np.int64)
        self.nodes = np.union1d(self._rows.node, across)
        self._at = (np.searchsorted(self.nodes, self._rows.node), self._rows.component)
        self.inertia = np.stack([scene.mass, scene.mass, scene.inertia], axis=1)[self.nodes] / time_step
        damping = self._spread(self._rows.damping)
        self.stiffness, self.prescribed = self._spread(self._rows.stiffness), self._spread(self._rows.prescribed)
        moves = scene.free * (1.0 - self.prescribed)
        self._seam = scene.seam_table(self.nodes)._replace(follow=self._spread(self._rows.follow))
        self.mobility = moves / (self.inertia + 0.5 * damping)
        self.keep = moves * (self.inertia - 0.5 * damping) / (self.inertia + 0.5 * damping)

    def table(self, times: np.ndarray) -> tables.Supports:
        """All of it for steps that begin at `times` (steps,) s."""
        drive = np.zeros((len(times), len(self.nodes), 3))
        drive[:, self._at[0], self._at[1]] = self._rows.sample(times, self._half_step)
        return tables.Supports(
            self.nodes, self.inertia, self.keep, self.mobility, self.stiffness, self.prescribed, drive, self._seam
        )

    def springs_at(self, displacement: np.ndarray) -> np.ndarray:
        """Forces (3, n) that take the springs' zero to displacements (3, n)."""
        force = np.zeros_like(displacement)
        force[:, self.nodes] = self.stiffness.T * displacement[:, self.nodes]
        return force

    def _spread(self, column: np.ndarray) -> np.ndarray:
        """A column of the table as (k, 3), zero where it has no row."""
        spread = np.zeros((len(self.nodes), 3))
        spread[self._at] = column
        return spread
