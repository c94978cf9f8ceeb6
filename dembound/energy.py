"""The energy ledger: where the energy of a run is, and where it went.

Central differences close their books exactly when kinetic energy is ½m v⁻·v⁺ (the velocities half a step before and
after), strain energy that of the step itself, and the work of every force F the sum of F·(v⁻ + v⁺)/2·Δt. What is left
open comes from contacts that open or close within a step, from normals that turn, and from rounding.
"""

from dataclasses import astuple, dataclass, fields

import numpy as np

from dembound.errors import RunError
from dembound.simulate import Simulation

GAIN = 0.5
"""Share of what was brought in that a run may gain before it stops; contacts that clap misjudge below 0.01 of it."""

ROUNDING = 1e-9
"""Share of the energies in a body that is nothing: differences of sums over a million contacts round to less."""


@dataclass(frozen=True)
class Entry:
    """One line of the ledger: time in s, energies in J per metre of thickness.

    kinetic; contact and bond, stored since the start (of a bar: in local springs and in peridynamic bonds); load, work
    of steady loads; balance, work of the forces that balance the stress of a settled body; outside, work of boundaries
    and driven loads; damping, friction, crack, taken by them; handover, what a change of method or law has added;
    error, what is stored and taken beyond what came in. Of a bar in J.
    """

    time: float
    kinetic: float
    contact: float
    bond: float
    load: float
    balance: float
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
        self._most = 0.0, 0.0  # that boundaries and loads have brought in at any time

    def step(self) -> np.ndarray:
        """Advance the simulation by one step and enter the energies at its beginning; returns the step's record."""
        simulation = self.simulation
        time, place, before = simulation.time, simulation.displacement.copy(), simulation.velocity.copy()
        balancing = 0.0 if simulation.balance is None else simulation.balance.work(place)  # forces may end in the step
        laws = len(simulation.laws)
        record = simulation.advance(1)
        if len(simulation.laws) > laws and simulation.switch_velocity is not None:
            # the law changed before the step: it began where the new law took over, maybe turned as a whole
            place = simulation.displacement - simulation.time_step * simulation.velocity
            before = simulation.switch_velocity
            balancing = 0.0 if simulation.balance is None else simulation.balance.work(place)
        kinetic = 0.5 * float(np.sum(self._inertia * before * simulation.velocity))
        contact, bond = (now - first for now, first in zip(self._stored(place), self._first, strict=True))
        load = float(np.sum(simulation.load * (place - simulation.datum)))
        outside, damping, friction, crack, handover, turning = (float(work) for work in simulation.work[1])
        balance = turning + balancing
        error = kinetic + contact + bond + damping + friction + crack - load - balance - outside - handover
        taken = (damping, friction, crack, handover)
        self.entries.append(Entry(time, kinetic, contact, bond, load, balance, outside, *taken, error))
        self._watch()
        return record

    def _watch(self) -> None:
        """Raise RunError where the run has gained energy from nothing, as it does with a step too large for its law."""
        first, last = self.entries[0], self.entries[-1]
        self._most = max(self._most[0], last.outside), max(self._most[1], last.load)
        came = first.kinetic + sum(self._most)
        gained = last.error - first.error
        if gained > GAIN * came + ROUNDING * (sum(self._first) + last.kinetic + abs(last.outside)):
            unit = self.simulation.scene.energy_unit
            raise RunError(
                f"the run has gained {gained:.3g} {unit} from nothing until t = {last.time:g} s, when loads and "
                f"boundaries had brought in {came:.3g} {unit} at most; take a smaller run.safety or run.time_step"
            )

    @property
    def columns(self) -> np.ndarray:
        """All entries, (k, 12), in the order of `Entry`."""
        return np.array([astuple(entry) for entry in self.entries]).reshape(-1, len(fields(Entry)))

    def _stored(self, displacement: np.ndarray) -> tuple[float, float]:
        """Energy (J) in contacts and bonds."""
        return self.simulation.engine.stored(displacement)
