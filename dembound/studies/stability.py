"""The largest stable time step of a scene with its dampers, springs and columns, measured by noise in it at rest.

The limit from the largest eigenvalue (disks/stability.py, bar/stability.py) assumes that centred dampers, held
components and one-sided seams do not lower it. Here noise is stepped in the scene without loads and waves
(`Kind.trials`): short runs around the limit show whether it grows, long ones at its own step whether its energy does.

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

from dembound.casefile import Case
from dembound.errors import CaseError, RunError
from dembound.kinds import kind_of
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
    energy = [e.kinetic + e.contact + e.bond + e.stepping - e.balance - e.outside - e.law_switch for e in others]
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


FACTORS = 1.0 + 0.5 * RESOLUTION, 1.0 + COARSE, 2.0
"""Ratios of trial steps to the computed limit, or of the limit to trial steps, to bracket the largest stable one."""

LONG = 0.8
"""Computed seconds of one core for the steps of all long runs, so that all machines do equally many."""

LEAST, MOST = 5_000, 100_000
"""Least and largest number of steps of a long run by default."""

Report = Callable[[str], None]
"""Called with a line about each run that is done."""


@dataclass
class Stability:
    """The measured stability of one trial.

    Attributes
    ----------
    trial : the scene and its computed limit.
    below, above : steps (s) between which the largest stable one lies; above is infinite if noise grew at none.
    calm, growing : the short runs at these steps.
    long_runs : at the case's own step, one for each part.
    """

    trial: Trial
    below: float = 0.0
    above: float = np.inf
    calm: Course = field(default_factory=Course)
    growing: Course = field(default_factory=Course)
    long_runs: list[LongRun] = field(default_factory=list)

    @property
    def measured(self) -> float:
        """The largest stable step (s): the middle of its bracket, infinite if noise grew at no step."""
        return 0.5 * (self.below + self.above)

    @property
    def width(self) -> float:
        """Width of the bracket over the computed limit."""
        return (self.above - self.below) / self.trial.limit

    @property
    def is_stable(self) -> bool:
        """Whether the case's own step is stable: below the steps at which noise grew, with stable long runs."""
        return self.trial.step < self.above and all(run.is_stable for run in self.long_runs)


def measure(
    case: Case, *, steps: int | None = None, full: bool = False, report: Report | None = None
) -> tuple[list[Stability], list[str]]:
    """Largest stable steps of a case under all its laws or stages, and long runs of noise at its own step.

    steps : of a long run, None: as many as `LONG` allows; full : the whole scene instead of fewer copies of its brick.
    Returns the measurements, and how the scenes differ from that of the case, one sentence each.

    Raises the errors of building a scene, and CaseError if nothing in it can vibrate.
    """
    if steps is not None and steps < 1:
        raise CaseError([f"--steps: is {steps}, must be at least 1"])
    chosen, words = kind_of(case).trials(case, full=full)
    say = report or (lambda line: None)
    runs = [trial for trial in chosen for _ in trial.parts]
    if steps is None:
        cost = 1e-9 * sum(trial.step_cost for trial in runs)
        steps = int(np.clip(LONG / cost // 1000 * 1000, LEAST, MOST))
    # samples of each long run, about `SAMPLES` in all, at which thousands of steps end
    samples = next((each for each in (500, 250, 125, 100) if each * len(runs) <= SAMPLES), 50)
    return [_measured(trial, steps, samples, say) for trial in chosen], words


def _measured(trial: Trial, steps: int, samples: int, say: Report) -> Stability:
    """The measurements of one trial; steps, samples : numbers for each long run."""
    if not np.isfinite(trial.limit):
        raise CaseError(["run.time_step: any step is stable, as nothing in the scene can vibrate"])
    found = _bracketed(trial, say)
    for part in trial.parts:
        run = long_run(trial, part, steps, samples)
        found.long_runs.append(run)
        said = f"energy of noise in the {part} {'does not grow' if run.is_stable else 'grows'}"
        say(f"{trial.name}: {said} in {run.course.steps[-1]:,} steps of {trial.step:.4g} s")
    return found


def _bracketed(trial: Trial, say: Report) -> Stability:
    """The largest stable step: a bracket around the computed limit, then bisection."""
    found = Stability(trial)

    def resolution(step: float) -> float:
        return RESOLUTION if abs(step / trial.limit - 1.0) < COARSE - 1e-9 else COARSE

    def grows_at(step: float) -> bool:
        course = short_run(trial, step, resolution(step))
        if course.is_growing:
            found.above, found.growing = step, course
        else:
            found.below, found.calm = step, course
        seen = "grows" if course.is_growing else "does not grow"
        say(f"{trial.name}: noise {seen} at {step / trial.limit:.5f} of the computed limit")
        return course.is_growing

    for factor in FACTORS:
        if grows_at(trial.limit * factor):
            break
    if found.below == 0.0:
        for factor in FACTORS:
            if not grows_at(trial.limit / factor):
                break
    most = trial.limit * (1.0 + 1e-9)
    while np.isfinite(found.above) and found.above - found.below > resolution(found.measured) * most:
        grows_at(found.measured)
    return found
