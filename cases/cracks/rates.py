"""Apparent strength of a concrete bar by strain rate, with the law of rates and without, as Markdown and a picture.

    python cases/cracks/rates.py [PICTURE]

Pulses of several lengths spall concrete.toml, each in a bar long enough for it. Of every run the pull-back strength is
taken as in a test, from the velocity of the free end. The strain rate is that of the crack itself, in the bar with the
law; the bar without has the strength at the slowest rate. Which of the planes open that a crest brings to the strength
depends on the spacing, so every pulse is run at several. A minute.
"""

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from dembound.bar.fracture import spalls
from dembound.casefile.bar import BarCase
from dembound.gauge.estimates import pull_back_strength
from dembound.kinds import load, with_changes
from dembound.motion.simulation import Simulation
from dembound.running import plan

PERIODS = np.array([60e-6, 80e-6, 120e-6, 160e-6, 240e-6, 320e-6, 480e-6])
"""Lengths of the pulses, s."""

PRESSURE = 20e6
"""Crest of the pulses, Pa."""

ENERGIES = (100.0, 20.0)
"""Fracture energies, J/m²."""

CELLS = (2400, 3000, 3600, 4200)
"""Numbers of spacings in the bar."""

MEGA, MICRO = 1e6, 1e-6


@dataclass(frozen=True)
class Spalled:
    """Runs at all spacings: pull-back strengths (Pa); mean strain rate (1/s) and strength (Pa) of the first crack."""

    pull_backs: np.ndarray
    rate: float
    strength: float

    @property
    def mean(self) -> float:
        """Mean pull-back strength, MPa."""
        return float(self.pull_backs.mean()) / MEGA

    @property
    def to_both_sides(self) -> tuple[float, float]:
        """Distances from the mean to the smallest and to the largest, MPa."""
        return self.mean - self.pull_backs.min() / MEGA, self.pull_backs.max() / MEGA - self.mean

    def __str__(self) -> str:
        return f"{self.pull_backs.min() / MEGA:.1f}–{self.pull_backs.max() / MEGA:.1f}"


def bar_under(base: BarCase, period: float, energy: float, cells: int, *, law: bool) -> BarCase:
    """The case under a pulse of a period (s), with a fracture energy (J/m²), with or without the law of rates."""
    length = max(1.0, round(1.2 * base.bar.speed * period, 2))
    bar = base.bar.model_dump(exclude_none=True) | {"length": length, "spacing": length / cells}
    bar["fracture_energy"] = energy
    if not law:
        del bar["strength_per_decade"], bar["strength_rates"]
    (hit,) = base.load
    changes = {
        "bar": bar,
        "load": [hit.model_dump() | {"pressure": PRESSURE}],
        "wave.pulse.period": period,
        "monitor": [{"name": "end", "position": length}],
        "run.duration": 2.2 * length / base.bar.speed + period,
    }
    return with_changes(base, changes)


def first_crack(case: BarCase) -> tuple[float, float, float]:
    """Run a case: pull-back strength (Pa), strain rate (1/s) and strength (Pa) of its first crack."""
    planned = plan(case)
    simulation = Simulation(planned.scene, planned.time_step, planned.scene.probes)
    velocity = simulation.advance(round(case.run.duration / planned.time_step))[:, 0, 3]
    bar, bonds = case.bar, simulation.system.parts[0].bonds
    time = planned.time_step * np.arange(len(velocity))
    pull_back = pull_back_strength(time, velocity, bar.density, bar.speed, bar.length)
    first = spalls(bonds, planned.scene.positions[:, 0], planned.time_step)[0]
    (row,) = np.flatnonzero(bonds.opening["first"] == round(first.start[0] / bar.length * bar.cells))
    strength = bonds.opening["limit"][row] / (bar.length / bar.cells) * bar.modulus
    return pull_back, bonds.opening["rate"][row], strength


def spalled(base: BarCase, period: float, energy: float, *, law: bool) -> Spalled:
    """Runs of the case under a pulse of a period (s), with a fracture energy (J/m²), at all spacings."""
    runs = [first_crack(bar_under(base, period, energy, cells, law=law)) for cells in CELLS]
    pull_backs, rates, strengths = np.array(runs).T
    return Spalled(pull_backs, float(rates.mean()), float(strengths.mean()))


def drawn(found: dict[tuple[float, bool], list[Spalled]], base: BarCase) -> Figure:
    """Pull-back strengths and the law over the strain rate."""
    figure = Figure(figsize=(7.0, 4.2), layout="constrained")
    axes = figure.subplots()
    slowest, fastest = base.bar.strength_rates
    axes.plot(
        [slowest, fastest],
        np.array([base.bar.strength, base.bar.largest_strength]) / MEGA,
        "k-",
        label="law of the material",
    )
    for colour, energy in zip(("C0", "C1"), ENERGIES, strict=True):
        rates = [run.rate for run in found[energy, True]]
        for law, mark, words in ((True, "o-", "with the law"), (False, "s--", "one strength, 6.34 MPa")):
            strengths = [run.mean for run in found[energy, law]]
            spread = np.transpose([run.to_both_sides for run in found[energy, law]])
            label = f"pull-back, G_f = {energy:g} J/m², {words}"
            axes.errorbar(rates, strengths, spread, fmt=mark, color=colour, capsize=3, label=label)
    axes.set(xscale="log", xlabel="strain rate of the crack (1/s)", ylabel="strength (MPa)")
    axes.set_ylim(bottom=0.0)
    axes.set_xticks([3, 5, 10, 20, 30, 50], ["3", "5", "10", "20", "30", "50"])
    axes.minorticks_off()
    axes.legend(fontsize="small")
    axes.grid(alpha=0.3, which="both")
    return figure


def main() -> None:
    """Print the table and draw the picture."""
    base = load(Path(__file__).with_name("concrete.toml"))
    found = {
        (energy, law): [spalled(base, period, energy, law=law) for period in PERIODS]
        for energy in ENERGIES
        for law in (True, False)
    }
    print("| G_f (J/m²) | pulse (µs) | rate (1/s) | law (MPa) | pull-back with the law | without |")
    print("|---|---|---|---|---|---|")
    for energy in ENERGIES:
        for period, run, plain in zip(PERIODS, found[energy, True], found[energy, False], strict=True):
            given = f"{energy:g} | {period / MICRO:.0f} | {run.rate:.1f} | {run.strength / MEGA:.1f}"
            print(f"| {given} | {run} | {plain} |")
    if len(sys.argv) > 1:
        drawn(found, base).savefig(sys.argv[1], dpi=110)


if __name__ == "__main__":
    main()
