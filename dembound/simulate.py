"""The loop: advance a scene in time, watch that it stays sound."""

from collections.abc import Callable

import numpy as np

from dembound.boundaries.support import Supports
from dembound.errors import RunError
from dembound.kernels.elastic import advance
from dembound.scene import Scene
from dembound.threads import threads_for

BLOCK = 256
"""Steps between two looks at a run: compiled code does not return to Python in between."""

RUNAWAY = 1e4
"""A particle this many times as fast as all waves together has left physics: resonance gives factors of ten."""


class Simulation:
    """A scene in motion, from rest at time zero.

    Parameters
    ----------
    scene : what moves.
    time_step : Δt in s; the caller has compared it with the stability limit.
    probes : (p,) particles whose motion `advance` returns at every step.

    Attributes
    ----------
    displacement, velocity : (3, n) m and rad, m/s and rad/s; velocities are half a time step behind.
    steps : steps done.
    tracked : (q,) the particles of all edges, in the order of `scene.edges`.
    peaks : (q, 3, 2) smallest and largest velocity of each so far.
    """

    def __init__(self, scene: Scene, time_step: float, probes: np.ndarray) -> None:
        self.scene = scene
        self.time_step = time_step
        self.probes = np.asarray(probes, dtype=np.int64)
        self.steps = 0
        self.displacement = np.zeros((3, scene.count))
        self.velocity = np.zeros((3, scene.count))
        self._spare = np.zeros((3, scene.count))
        edges = [edge.nodes for edge in scene.edges.values()]
        self.tracked = np.concatenate(edges) if edges else np.zeros(0, dtype=np.int64)
        self.peaks = np.zeros((len(self.tracked), 3, 2))
        waves = sum(wave.peak() for wave in scene.case.wave.values())
        self._fastest = RUNAWAY * waves if waves else np.finfo(float).max
        self._mobility = time_step / scene.mass
        self._inverse_inertia = time_step / scene.inertia
        self._supports = NodeSupports(scene, time_step)

    @property
    def time(self) -> float:
        """Time of the current displacements (s)."""
        return self.steps * self.time_step

    def advance(self, steps: int) -> np.ndarray:
        """Go on by `steps` steps; returns (steps, p, 6): displacement and velocity of the probes before each.

        Raises RunError when the motion grows without bound, saying when and where.
        """
        times = (self.steps + np.arange(steps)) * self.time_step
        record = np.empty((steps, len(self.probes), 6))
        supports = self._supports
        with threads_for(self.scene.count):
            advance(
                self.displacement, self._spare, self.velocity,
                *self.scene.contacts.arrays,
                self._mobility, self._inverse_inertia, self.scene.free, self.scene.case.material.damp,
                self.time_step,
                supports.nodes, supports.keep, supports.mobility, supports.stiffness, supports.preload,
                supports.prescribed, supports.drive(times),
                self.probes, record, self.tracked, self.peaks,
            )  # fmt: skip
        self.steps += steps
        self._watch()
        return record

    def run(self, steps: int, on_block: Callable[["Simulation", np.ndarray], None] | None = None) -> None:
        """Advance to `steps` steps in all, block by block.

        on_block gets the simulation and the block's record (k, p, 6).
        """
        while self.steps < steps:
            record = self.advance(min(BLOCK, steps - self.steps))
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

    def _watch(self) -> None:
        """Raise RunError when a particle is faster than any wave could make it."""
        speed = np.abs(self.velocity[:2]).max(axis=0)
        sound = speed <= self._fastest  # false for what is not a number, too
        if sound.all():
            return
        place = self.scene.assembly.positions[int(np.argmin(sound))]
        raise RunError(
            f"the motion grew without bound: at t = {self.time:g} s near ({place[0]:g}, {place[1]:g}) m; "
            "take a smaller run.time_step or safety"
        )


class NodeSupports:
    """The support table as the kernel applies it, one line per supported particle and all three components.

    v⁺ = keep·v + mobility·(F + F_0 − K u + drive) + prescribed·drive. With the centred damper
    keep = (m/Δt − C/2)/(m/Δt + C/2) and mobility = 1/(m/Δt + C/2); both are zero for a prescribed component.

    Attributes: nodes (k,); keep, mobility, stiffness, preload, prescribed (k, 3).
    """

    def __init__(self, scene: Scene, time_step: float) -> None:
        table = scene.supports
        self.table: Supports = table
        self.half_step = 0.5 * time_step
        self.nodes, line = np.unique(table.node, return_inverse=True)
        self._at = (line, table.component)
        shape = (len(self.nodes), 3)
        inertia = np.stack([scene.mass, scene.mass, scene.inertia], axis=1)[self.nodes] / time_step
        damping, self.prescribed = np.zeros(shape), np.zeros(shape)
        self.stiffness, self.preload = np.zeros(shape), np.zeros(shape)
        damping[self._at] = table.damping
        self.prescribed[self._at] = table.prescribed
        self.stiffness[self._at] = table.stiffness
        self.preload[self._at] = table.preload
        moves = scene.free * (1.0 - self.prescribed)
        self.mobility = moves / (inertia + 0.5 * damping)
        self.keep = moves * (inertia - 0.5 * damping) / (inertia + 0.5 * damping)

    def drive(self, times: np.ndarray) -> np.ndarray:
        """Driving forces at each time, (steps, k, 3) N; velocities in m/s where prescribed."""
        drive = np.zeros((len(times), len(self.nodes), 3))
        drive[:, self._at[0], self._at[1]] = self.table.sample(times, self.half_step)
        return drive
