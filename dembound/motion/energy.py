"""The energy ledger: stored, supplied and dissipated energy of a run.

For central differences the balance is exact with ½m v⁻·v⁺ (the velocities half a step before and after), the strain
energy of the step itself, and for the work of every force F the sum of F·(v⁻ + v⁺)/2·Δt. The product ½m v⁻·v⁺ is
divided into the kinetic energy of the mean velocity, ⅛m (v⁻ + v⁺)², and −⅛m (v⁺ − v⁻)², of second order in the step:
the latter exceeds the kinetic energy where velocities change their sign within a step, as at impacts. Energy that
contacts take or give as they open or close within a step has its own column. The remaining error comes from rotating
normals and from rounding.
"""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any, NamedTuple

import numpy as np

from dembound.errors import RunError
from dembound.motion.state import Arrays, State
from dembound.motion.trackers import NEVER, Run, Tracker

GAIN = 0.5
"""Energy gained over supplied energy at which a run stops."""

ROUNDING = 1e-9
"""Share of the largest energy below which energies count as zero: rounding errors of sums over contacts are smaller."""

OPPOSED = 50.0
"""Share as of `Opposed` at which a run stops: 1/(1 − r²), which no step of up to r = 0.99 of the limit can exceed.

It stops at two entries in a row: at the first one after the beginning of a wave v⁻ may be next to nothing beside v⁺,
and the share v⁺/4v⁻, whatever the step. From the next step on a wave that rises as tⁿ has v⁺/v⁻ below 2ⁿ.
"""

AT_REST = 1e-13
"""Share of the energy stored at the start below which supplied energy is rounding, as for a body at rest."""


@dataclass(frozen=True)
class Entry:
    """One line of the ledger: time in s, energies in J per metre of thickness (of a bar in J).

    kinetic; contact and bond, stored since the start (of a bar: in local springs and in peridynamic bonds); load, work
    of steady loads; balance, work of the forces that balance the stress of a settled body; outside, work of boundaries
    and driven loads; loads, the part of `outside` by loads; damping, friction, crack, dissipated by each, friction of a
    bar by impacts of its ranges; closing, taken by contacts that open and close within a step, less the energy added by
    sliding contacts and breaking bonds whose force changes its sign in one (see kernels.contacts.push); law_switch,
    added by a change of method or law; stepping, at most 0, contribution to the stored energy of velocities that change
    within a step; supplied, the kinetic energy at the start plus the largest values so far of outside, at any step, and
    of load, at any entry; error, stored and dissipated energy minus the energy that came in and the kinetic energy at
    the start.
    """

    time: float
    kinetic: float
    contact: float
    bond: float
    load: float
    balance: float
    outside: float
    loads: float
    damping: float
    friction: float
    crack: float
    closing: float
    law_switch: float
    stepping: float
    supplied: float
    error: float


class SideEntry(NamedTuple):
    """Energies that one side has supplied, absorbed and stored since the start, as of `Entry`.

    The work from outside is the sum over the sides of came_in − absorbed − stored, plus the work of the loads.

    came_in : energy of waves that enter through dashpots, ∫Σ C v_i² dt; work of prescribed motion, of the ground beyond
    a free-field side and of waves on springs, which may be negative. absorbed : energy that leaves through dashpots,
    ∫Σ C (v − v_i)² dt. stored : in springs.
    """

    came_in: float
    absorbed: float
    stored: float


class Opposed(NamedTuple):
    """The two terms of the ledger that cancel most, by name, and the size of the smaller one over all energy there was.

    At a share r of the step's limit the highest mode has the energy E = strain (1 − r²) + kinetic energy of whole
    steps, so that the strain energy may be E/(1 − r²) and `stepping` −r² of it: near r = 1 both are swings from step to
    step. Above a share of 1 they, or other terms, cannot be energies of waves.
    """

    high: str
    low: str
    share: float


def opposed(energy: Mapping[str, Any]) -> Opposed:
    """The terms that cancel most at any entry; energy : values (k,), or one, by the names of `Entry`.

    All energy there was is the largest supplied, and what is less stored than at the start.
    """
    stored = np.atleast_1d(energy["contact"] + energy["bond"])
    names = ("kinetic", "damping", "friction", "crack", "closing", "stepping")
    terms = {"contact and bond": stored} | {name: np.atleast_1d(energy[name]) for name in names}
    values = np.array(list(terms.values()))
    there = np.max(energy["supplied"]) + np.maximum(0.0, -stored)
    smaller = np.minimum(values.max(axis=0), -values.min(axis=0))
    shares = np.divide(smaller, there, out=np.zeros_like(there), where=there > 0.0)
    worst = int(shares.argmax())
    high, low = (list(terms)[index(values[:, worst])] for index in (np.argmax, np.argmin))
    return Opposed(high, low, float(shares[worst]))


class _Begun(NamedTuple):
    """The state at the beginning of an entry's step.

    u, before : (3, slots) displacements, and velocities half a step earlier; balancing : J, work of balancing forces;
    laws : number of laws used so far.
    """

    u: np.ndarray
    before: np.ndarray
    balancing: float
    laws: int


class Ledger(Tracker):
    """Writes the energy ledger of a run from its beginning; each entry also needs the step after it.

    Parameters
    ----------
    run : the run, whose strain energy at the start is subtracted; energies are those of its whole scene.
    interval : steps from one entry to the next; the first entry is at the start. last : step of another entry; by
    default none.
    """

    name = "ledger"
    evolving = ("due", "_counted", "_came")

    def __init__(self, run: Run, interval: int, last: int = NEVER) -> None:
        self.entries: list[Entry] = []
        self.sides: list[np.ndarray] = []
        self.side_names = [] if run.sides is None else run.sides.names
        self.watches = True  # raises RunError for energy from nothing
        self.due = run.state.step
        self._time_step = run.time_step
        self._interval, self._last = interval, last
        self._unit, self._weight = run.scene.energy_unit, run.scene.weight
        self._inertia = run.scene.mass, run.scene.mass, run.scene.inertia
        self._first = run.system.stored(run.state.u)
        self._counted = run.system.counted(run.state.u)
        self._came = 0.0  # energy of the motion at the start, which impacts may take part of at once
        self._most = 0.0, 0.0  # supplied by boundaries and loads, largest values so far
        self._begun: _Begun | None = None
        self._space: list[np.ndarray] = []

    def handle(self, run: Run) -> None:
        """Begin an entry, or complete the entry begun one step earlier."""
        if self._begun is not None:
            self._enter(run, self._begun)
            self._begun = None
            step = run.state.step - 1
            later = step + self._interval
            self.due = min(later, self._last) if step < self._last else later
        if self.due == run.state.step:
            state = run.state
            balancing = run.system.balancing_work(state.u)  # forces may end in the step
            self._begun = _Begun(self._kept(0, state.u), self._kept(1, state.v), balancing, len(state.laws))
            self.due = state.step + 1

    def _kept(self, number: int, values: np.ndarray) -> np.ndarray:
        """A copy of values in the buffer of the entry before, as allocating a new one takes as long as the copy."""
        if len(self._space) <= number:
            self._space.append(np.empty_like(values))
        np.copyto(self._space[number], values)
        return self._space[number]

    def _enter(self, run: Run, begun: _Begun) -> None:
        """Write the energies at the beginning of the last step."""
        state, system = run.state, run.system
        u, before, balancing, laws = begun
        if len(state.laws) > laws and state.switch_velocity.size > 0:
            # the law changed before the step, which began in the state of the change, maybe with a rigid rotation
            u = state.u - run.time_step * state.v
            before = state.layout.spread(state.switch_velocity)
            balancing = system.balancing_work(u)
        elif state.step == 1 and not before.any():
            # half a kick has moved it from rest: its velocities half a step before are the opposite ones
            before = state.layout.spread(np.where(run.scene.moves, -state.velocity, 0.0))
        kinetic, stepping = self._of_motion(before, state)
        contact, bond = (now - first for now, first in zip(system.stored(u), self._first, strict=True))
        load = system.work_before
        if system.load.any():  # u is taken by node, contiguous by row, so that sums have one order of terms
            load += float(np.sum(system.load * (np.take(u, state.layout.slot, axis=1) - state.datum)))
        outside, damping, friction, crack, law_switch, turning, closing = (float(work) for work in state.work[1])
        damping -= system.counted(u) - self._counted
        shift = system.spring_shift(u)
        outside += shift
        balance = turning + balancing - shift
        in_springs = np.zeros(0) if run.sides is None else run.sides.stored(u, state.datum)
        sides = np.column_stack([state.side_work[1], in_springs])
        loads = 0.0
        if run.sides is not None and run.sides.has_loads:
            loads = outside - system.work_of_walls - float(np.sum(sides @ (1.0, -1.0, -1.0))) / self._weight
        taken = damping, friction, crack, closing
        error = kinetic + contact + bond + stepping + sum(taken) - load - balance - outside - law_switch
        if not self.entries:
            self._came = error
        error -= self._came
        came = max(outside, float(state.supplied[0])) if system.supply_is_plain else outside
        self._most = max(self._most[0], came), max(self._most[1], load)
        supplied = self._came + sum(self._most)
        if supplied <= AT_REST * sum(self._first):
            supplied = 0.0  # rounding
        stored = kinetic, contact, bond, load, balance, outside, loads
        energies = *stored, *taken, law_switch, stepping, supplied, error
        time = (state.step - 1) * run.time_step
        self.entries.append(Entry(time, *(self._weight * energy for energy in energies)))
        self.sides.append(sides)
        if not self.watches:
            return
        self._watch(run, u)
        borne = min(load, 0.0) - max(contact + bond, 0.0)  # weight lifted, and strain in a stress at rest
        system.look(u, state.step - 1, borne, max(supplied, sum(self._first)))

    def _of_motion(self, before: np.ndarray, state: State) -> tuple[float, float]:
        """Σ ⅛m (v⁻ + v⁺)² and −Σ ⅛m (v⁺ − v⁻)²; before : (3, slots) v⁻."""
        kinetic = stepping = 0.0
        for inertia, *rows in zip(self._inertia, before, state.v, strict=True):
            earlier, later = (np.take(row, state.layout.slot) for row in rows)
            kinetic += 0.125 * float(np.sum(inertia * (earlier + later) ** 2))
            stepping -= 0.125 * float(np.sum(inertia * (later - earlier) ** 2))
        return kinetic, stepping

    def _watch(self, run: Run, u: np.ndarray) -> None:
        """Raise RunError if the run has gained energy without supply, or if two terms are large and opposite.

        Damping may give back what it has taken and, as strain energy is that of unrelaxed moduli, at most as much as is
        stored at displacements u (3, slots), which are then measured from the start.
        """
        first, last = self.entries[0], self.entries[-1]
        came, gained = last.supplied, (last.error - last.closing) - (first.error - first.closing)
        if last.damping < 0.0:
            strain = sum(run.system.stored(u - run.state.layout.spread(run.state.datum)))
            gained = max(gained, -last.damping - self._weight * strain)
        stored = self._weight * sum(self._first)
        if gained > GAIN * came + ROUNDING * (stored + last.kinetic - last.stepping + abs(last.outside)):
            raise RunError(
                f"the run has gained {gained:.3g} {self._unit} without input until t = {last.time:g} s, when loads and "
                f"boundaries had supplied {came:.3g} {self._unit} at most; take {run.scene.against_growth}"
            )
        high, low, share = opposed(vars(last))
        if share > OPPOSED < opposed(vars(self.entries[-2])).share:
            x, y = run.scene.positions[np.abs(run.state.velocity[:2]).max(axis=0).argmax()]
            raise RunError(
                f"the velocities swing from step to step without bound: at t = {last.time:g} s near ({x:g}, {y:g}) m, "
                f"{low} and {high} of the energy ledger are {share:.3g} times all the energy there was, and opposite; "
                f"take a step of {np.sqrt(1.0 - 1.0 / OPPOSED):.2g} of the stability limit at most, and waves that "
                "rise over several"
            )

    @property
    def columns(self) -> np.ndarray:
        """All entries, (k, 15), in the order of `Entry`."""
        return np.array([tuple(vars(entry).values()) for entry in self.entries]).reshape(-1, len(fields(Entry)))

    @property
    def side_columns(self) -> np.ndarray:
        """Energies of every side, (k, s, 3), in the order of `SideEntry`."""
        return np.array(self.sides).reshape(len(self.sides), len(self.side_names), 3)

    def saved_arrays(self) -> Arrays:
        """Entries, the supplied energies, and an entry that has begun."""
        begun = self._begun or _Begun(np.zeros((3, 0)), np.zeros((3, 0)), 0.0, 0)
        numbers = {"first": self._first, "most": self._most, "has_begun": self._begun is not None, **begun._asdict()}
        kept = {"entries": self.columns, "sides": self.side_columns, **super().saved_arrays()}
        return kept | {name: np.asarray(values) for name, values in numbers.items()}

    def restore(self, saved: Arrays) -> None:
        """Restore the arrays returned by `saved_arrays` in another run; raises ValueError for those of another case."""
        super().restore(saved)
        self.entries = [Entry(*row) for row in saved["entries"].tolist()]
        self.sides = list(saved["sides"])
        self._first, self._most = ((float(one), float(two)) for one, two in (saved["first"], saved["most"]))

        begun = _Begun(saved["u"].copy(), saved["before"].copy(), float(saved["balancing"]), int(saved["laws"]))
        self._begun = begun if saved["has_begun"] else None
        if self.due > (self._step_of_last() if self.entries else 0) + self._interval + 1:
            raise ValueError(f"{self.name} is not due before step {self.due}")
        self._drop_end()

    @property
    def regular_entries(self) -> int:
        """Number of entries without the entry of the last step, unless it belongs to the interval."""
        return len(self.entries) - (len(self.entries) > 0 and self._step_of_last() % self._interval > 0)

    def _step_of_last(self) -> int:
        """Step of the last entry."""
        return round(self.entries[-1].time / self._time_step)

    def _drop_end(self) -> None:
        """Drop the entry of the last step of a run that this one continues, unless it belongs to the interval."""
        entered = self._begun is None
        last = self._step_of_last() if entered and self.entries else self.due - 1
        past = last % self._interval
        if past == 0 or last >= self._last:
            return
        self._begun = None
        del self.sides[self.regular_entries :]
        del self.entries[self.regular_entries :]
        self.due = min(last - past + self._interval, self._last)
