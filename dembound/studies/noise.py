"""Noise in a scene at rest: short runs show whether it grows, long runs whether its energy does.

**Steps needed.** At 1 + ε of the stability limit the highest mode grows by e^√(8ε) per step, and its energy by the
square of that. The highest mode has one part in d of the noise, with d components of motion, and with a probability of
0.99 at least 1e-4 of that. To reach `GROWN` times the whole noise it takes ln(1e4·d·GROWN)/(2√(8ε)) steps: 220 for d =
1e4 and ε = 5e-4. A damper C on the node of that mode slows the growth of its energy to 8ε/c a step, c = CΔt/2m, so
`PATIENCE` times that number of steps are run.

**Transients.** At the share r of the limit the kinetic energy T of noise that begins without strain is at most
E/(1 − r²), with the energy E that central differences conserve and dampers reduce, and at most (2n + 1)²E after n
steps. At r = 1 − 5e-4 the first is 1000E, so a stable scene does not reach `GROWN`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from dembound.errors import RunError
from dembound.motion.energy import Ledger
from dembound.motion.part import Part
from dembound.motion.simulation import Simulation
from dembound.motion.stability import Trial
from dembound.motion.trackers import Every, Run, Tracker

RESOLUTION = 1e-3
"""Width of the bracket in which the largest stable step is found, over the computed limit: ε is half of it."""

COARSE = 1e-2
"""Relative resolution of steps far from the computed limit."""

GROWN = 1e4
"""Kinetic energy over that of the noise above which a short run is unstable."""

PATIENCE = 20
"""Steps of a short run over those that an undamped scene needs."""

DECIDED = float(np.log(10.0))
"""Growth of ln T in the second half of a short run, by a fitted line, above which it is unstable."""

LOOKS, LOOKS_AT_CONTACTS = 25, 10
"""Steps between two checks of the kinetic energy in a short run, and under laws with contacts, whose search becomes
very slow in an unstable motion.
"""

SAMPLES = 500
"""Number of samples of the energy in a long run; each takes as long as some dozens of steps of a small scene."""

OPENING_ERROR = 0.01
"""Largest rise of the energy under a law in which contacts open and close within a step, see `motion.energy.GAIN`."""

ROUNDING = 100.0 * float(np.finfo(float).eps)
"""Largest relative change of the energy by rounding in a step: each component is a sum of some ten forces."""


@dataclass
class Course:
    """Energies over the energy of the noise at the start.

    steps (k,); kinetic (k,), of velocities half a step earlier; energy (k,), see `long_run`, empty in short runs.
    """

    steps: list[int] = field(default_factory=list)
    kinetic: list[float] = field(default_factory=list)
    energy: list[float] = field(default_factory=list)

    @property
    def rate(self) -> float:
        """Growth of ln T per step, of a line fitted to the second half, without the transients of the start."""
        late = len(self.steps) // 2
        kinetic = np.maximum(self.kinetic[late:], np.finfo(float).tiny)
        return float(np.polyfit(self.steps[late:], np.log(kinetic), 1)[0]) if len(kinetic) > 2 else 0.0

    @property
    def is_growing(self) -> bool:
        """Whether a short run shows an instability."""
        return not self.kinetic[-1] <= GROWN or 0.5 * self.steps[-1] * self.rate > DECIDED


@dataclass
class LongRun:
    """Noise in one part at the case's own step.

    Attributes
    ----------
    part : its name.
    course : its energies.
    allowed : rise of the energy, over that of the noise, by rounding and by contacts that open within a step.
    bound : largest kinetic energy, over that of the noise, that a stable scene can reach.
    """

    part: str
    course: Course
    allowed: float
    bound: float

    @property
    def rise(self) -> float:
        """Largest energy over the one at the start, less 1; infinite if the run ended before there was any."""
        return float(np.max(self.course.energy)) - 1.0 if self.course.energy else np.inf

    @property
    def shown(self) -> tuple[list[int], list[float]]:
        """Steps and energies for pictures; for an unstable run kinetic ones, as the other may become negative."""
        values = self.course.energy if self.is_stable else self.course.kinetic
        return self.course.steps[-len(values) :], values

    @property
    def is_stable(self) -> bool:
        """Whether the energy never grew beyond what is allowed, nor the kinetic energy beyond its bound."""
        return self.rise <= self.allowed and bool(np.max(self.course.kinetic) <= self.bound)


def short_run(trial: Trial, step: float, resolution: float = RESOLUTION) -> Course:
    """Noise in all parts at a time step (s), until it has grown or would have at half a resolution above the limit."""
    needed = np.log(1e4 * 3 * trial.scene.count * GROWN) / (2.0 * np.sqrt(8.0 * 0.5 * resolution))
    looks = LOOKS if trial.is_linear else LOOKS_AT_CONTACTS
    return _run(_noisy(trial, step), Look(looks, most=GROWN), int(np.ceil(PATIENCE * needed)))


def long_run(trial: Trial, part: str, steps: int, samples: int = SAMPLES) -> LongRun:
    """Noise in one part at the case's own step; samples : number of times at which its energy is computed.

    Under a linear law the energy is ½v⁻ᵀMv⁻ + ½uᵀKu⁻ with the displacements u⁻ of the step before, which central
    differences conserve and dampers reduce. Under other laws it is the energy of the ledger, at whole steps and of all
    parts, plus the energy taken by boundaries: friction and contacts that close reduce it. The course then begins with
    the second sample, as the law may change in the first step.
    """
    every, share = max(1, steps // samples), trial.step / trial.limit
    bound = (2.0 * steps + 1.0) ** 2
    if share < 1.0:
        bound = min(bound, 1.0 / (1.0 - share**2))
    bound *= 1.0 + ROUNDING * steps
    simulation = _noisy(trial, trial.step, part)
    if trial.is_linear:
        course = _run(simulation, Look(every, part, most=bound, energy=conserved), steps)
        return LongRun(part, course, ROUNDING * steps * max(1.0, float(np.max(course.kinetic))), bound)
    ledger = Ledger(simulation, every)
    course = _run(simulation, Look(every, part, most=bound), steps, ledger)
    course.energy = _of_ledger(ledger)
    return LongRun(part, course, OPENING_ERROR, bound)


def _of_ledger(ledger: Ledger) -> list[float]:
    """Energies, from the second entry on, as parts of the kinetic energy at the start; the first of them is 1.

    The energy is kinetic and stored energy, the potential of forces that balance a locked-in stress, and the energy
    taken by boundaries, without the energy added by a change of law.
    """
    first, *others = ledger.entries
    energy = [
        entry.kinetic + entry.contact + entry.bond + entry.stepping - entry.balance - entry.outside - entry.law_switch
        for entry in others
    ]
    return [1.0 + (each - energy[0]) / first.kinetic for each in energy]


class Look(Every):
    """Notes energies at an interval of steps, and stops a run whose kinetic energy exceeds `most` times the start.

    part : of this part only; None: of all. energy : another energy to note.
    """

    name = "look"

    def __init__(self, steps: int, part: str | None = None, *, most: float, energy: Energy | None = None) -> None:
        super().__init__(steps)
        self.course = Course()
        self._part, self._most, self._energy = part, most, energy
        self._start = 0.0

    def see(self, run: Run) -> None:
        """Note the energies of this step."""
        parts = [part for part in run.system.parts if self._part in (None, part.name)]
        kinetic = _kinetic(run, parts)
        self._start = self._start or kinetic
        self.course.steps.append(run.state.step)
        self.course.kinetic.append(kinetic / self._start)
        if self._energy is not None:
            self.course.energy.append(self._energy(run, parts) / self._start)
        if not self.course.kinetic[-1] <= self._most:
            run.stopped = True


def conserved(run: Run, parts: Sequence[Part]) -> float:
    """The energy (J) of parts under a linear law that central differences conserve: ½v⁻ᵀMv⁻ + ½uᵀKu⁻."""
    u = run.state.displacement.copy()
    before = u - run.time_step * run.state.velocity
    twice, change = (run.scene.layout.spread(values) for values in (u + before, u - before))
    strain = sum(sum(part.stored(twice)) - sum(part.stored(change)) for part in parts)
    rows = run.scene.supports
    place = rows.component, rows.node
    work = rows.stiffness * u[place] * before[place]
    own = [(part.nodes.start <= rows.node) & (rows.node < part.nodes.stop) for part in parts]
    return _kinetic(run, parts) + 0.25 * strain + 0.5 * sum(float(np.sum(work[those])) for those in own)


Energy = Callable[[Run, Sequence[Part]], float]
"""An energy (J) of some parts of a run."""


def _kinetic(run: Run, parts: Sequence[Part]) -> float:
    """Kinetic energy (J) of parts, half a step earlier."""
    scene, velocity = run.scene, run.state.velocity
    inertia = np.stack([scene.mass, scene.mass, scene.inertia])
    return sum(0.5 * float(np.sum(inertia[:, part.nodes] * velocity[:, part.nodes] ** 2)) for part in parts)


def _noisy(trial: Trial, step: float, part: str | None = None) -> Simulation:
    """A trial at rest with noise in one part, or in all."""
    simulation = Simulation(trial.scene, step, system=trial.system(step))
    simulation.state.velocity = trial.noise(part)
    simulation.trackers.clear()  # a Watch would stop what is to be measured
    return simulation


def _run(simulation: Simulation, look: Look, steps: int, *trackers: Tracker) -> Course:
    """The course of a run; a failure of the run counts as growth."""
    simulation.track(look, *trackers)
    try:
        simulation.run(steps)
    except RunError:
        look.course.steps.append(simulation.state.step)
        look.course.kinetic.append(np.inf)
    return look.course
