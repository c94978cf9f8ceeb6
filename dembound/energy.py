"""The energy ledger: where the energy of a run is, and where it went.

Central differences close their books exactly when kinetic energy is ½m v⁻·v⁺ (the velocities half a step before and
after), strain energy that of the step itself, and the work of every force F the sum of F·(v⁻ + v⁺)/2·Δt. What is left
open comes from contacts that open or close within a step, from normals that turn, and from rounding.
"""

from dataclasses import astuple, dataclass, fields

import numpy as np

from dembound.simulate import Simulation


@dataclass(frozen=True)
class Entry:
    """One line of the ledger: time in s, energies in J per metre of thickness.

    kinetic; contact and bond, stored since the start (of a bar: in local springs and in peridynamic bonds); load, work
    of steady forces; outside, work of boundaries and driven loads; damping, friction, crack, taken by them; handover,
    what a change of method has added; error, what is stored and taken beyond what came in. Of a bar in J.
    """

    time: float
    kinetic: float
    contact: float
    bond: float
    load: float
    outside: float
    damping: float
    friction: float
    crack: float
    handover: float
    error: float


class Ledger:
    """Keeps the books of a simulation that has not begun yet."""

    def __init__(self, simulation: Simulation) -> None:
        self.simulation = simulation
        self.entries: list[Entry] = []
        self._inertia = np.stack([simulation.scene.mass, simulation.scene.mass, simulation.scene.inertia])
        self._first = self._stored(simulation.displacement)

    def step(self) -> np.ndarray:
        """Advance the simulation by one step and enter the energies at its beginning; returns the step's record."""
        simulation = self.simulation
        time, place, before = simulation.time, simulation.displacement.copy(), simulation.velocity.copy()
        record = simulation.advance(1)
        kinetic = 0.5 * float(np.sum(self._inertia * before * simulation.velocity))
        contact, bond = (now - first for now, first in zip(self._stored(place), self._first, strict=True))
        load = float(np.sum(simulation.load * (place - simulation.datum)))
        outside, damping, friction, crack, handover = (float(work) for work in simulation.work[1])
        error = kinetic + contact + bond + damping + friction + crack - load - outside - handover
        taken = (damping, friction, crack, handover)
        self.entries.append(Entry(time, kinetic, contact, bond, load, outside, *taken, error))
        return record

    @property
    def columns(self) -> np.ndarray:
        """All entries, (k, 11), in the order of `Entry`."""
        return np.array([astuple(entry) for entry in self.entries]).reshape(-1, len(fields(Entry)))

    def _stored(self, displacement: np.ndarray) -> tuple[float, float]:
        """Energy (J) in contacts and bonds."""
        return self.simulation.engine.stored(displacement)
