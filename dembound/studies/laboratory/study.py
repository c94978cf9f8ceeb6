"""A laboratory test over seeds: its runs, what is measured in each, the Mohr-Coulomb line of strengths."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import inf
from pathlib import Path
from typing import NamedTuple

import numpy as np

from dembound.errors import CaseError
from dembound.files import remove
from dembound.results.checkpoint import FILE as CHECKPOINT
from dembound.results.histories import missing
from dembound.results.recording import LoadingCurve, read_test
from dembound.schemas import loads
from dembound.studies.laboratory.sample import Sample
from dembound.studies.sweep.members import Member, key_of
from dembound.studies.sweep.perform import MEMBERS, Outcome
from dembound.studies.sweep.study import Options, Report, sweep
from dembound.studies.sweep.tables import Statistic, distinct, statistic


class Envelope(NamedTuple):
    """Friction angle in degrees, cohesion (Pa), and the uniaxial strength (Pa) of the line σ1 = uniaxial + Nσ3."""

    friction_angle: float
    cohesion: float
    uniaxial: float

    @property
    def slope(self) -> float:
        """N = (1 + sin φ)/(1 − sin φ)."""
        sine = np.sin(np.radians(self.friction_angle))
        return float((1.0 + sine) / (1.0 - sine))


def fitted(pressures: Sequence[float], strengths: Sequence[float]) -> Envelope:
    """The line by least squares through largest stresses (Pa) at two or more different pressures (Pa)."""
    slope, uniaxial = np.polyfit(pressures, strengths, 1)
    root = np.sqrt(max(slope, 1e-12))
    angle = 2.0 * np.degrees(np.arctan(root)) - 90.0
    return Envelope(float(angle), float(uniaxial / (2.0 * root)), float(uniaxial))


SHARES = (0.1, 0.5)
"""Shares of the peak between which moduli are the slopes of the curve."""

MOST_NAMED = 3
"""Largest number of samples that a warning names."""

UNITS = {
    **dict.fromkeys(("strength", "first_crack", "young", "young_plane_strain", "cohesion", "uniaxial"), "Pa"),
    "friction_angle": "degrees",
    "rate": "1/s",
}
"""Units of quantities; others are pure numbers."""


@dataclass(frozen=True)
class Specimen:
    """One run of a test: its seed, the pressure at its sides (Pa), and the member of the sweep."""

    seed: int
    pressure: float
    member: Member


@dataclass(frozen=True)
class Tested:
    """A test over seeds.

    Attributes
    ----------
    sample : of the test. specimens : its runs. outcomes : of the sweep, in the same order. shares : of the peak, for
    moduli. folder : of the results.
    """

    sample: Sample
    specimens: Sequence[Specimen]
    outcomes: Sequence[Outcome | None]
    folder: Path
    shares: tuple[float, float] = SHARES

    @property
    def states(self) -> list[str]:
        """State of every run: done, or the reason why it is not."""
        return ["not done" if each is None else each.failure or "done" for each in self.outcomes]

    @property
    def done(self) -> list[Specimen]:
        """The runs that are complete."""
        return [each for each, state in zip(self.specimens, self.states, strict=True) if state == "done"]

    def record(self, specimen: Specimen) -> Path:
        """The record of a run."""
        return self.folder / MEMBERS / specimen.member.name / "run.h5"

    @property
    def warnings_of_runs(self) -> dict[str, int]:
        """Distinct warnings of the runs and their numbers; those on the end of a run are in `warnings`, if any."""
        return {line: count for line, count in distinct(self.outcomes).items() if not line.startswith("run.until:")}

    @cached_property
    def curves(self) -> dict[str, LoadingCurve]:
        """The curve of every complete run by name."""
        sample = self.sample
        return {
            each.member.name: read_test(self.record(each), sample.test, sample.width, each.pressure)
            for each in self.done
        }

    def values(self, specimen: Specimen) -> dict[str, float]:
        """The quantities measured in a run, by name."""
        return measured(self.curves[specimen.member.name], self.shares)

    @cached_property
    def statistics(self) -> list[Statistic]:
        """Means over seeds of all quantities, for each pressure, and of friction angle and cohesion over all."""
        found = []
        for pressure in dict.fromkeys(each.pressure for each in self.done):
            rows = [self.values(each) for each in self.done if each.pressure == pressure]
            group = {"pressure": pressure} if self.sample.test == "biaxial" else {}
            for name in rows[0]:
                values = [row[name] for row in rows if np.isfinite(row[name])]
                found += [statistic(group, name, values)] if values else []
        fits = list(self.envelopes.values())
        for name in fits[0]._fields if fits else ():
            found.append(statistic({}, name, [getattr(fit, name) for fit in fits]))
        return found

    def statistic(self, quantity: str, pressure: float | None = None) -> Statistic:
        """Mean, spread and interval of a quantity; pressure : Pa, of the runs of a biaxial test, None: over all.

        Raises NameMissingError for one that there is not.
        """
        group = {} if pressure is None else {"pressure": pressure}
        own = {each.quantity: each for each in self.statistics if each.group == group}
        if quantity not in own:
            raise missing("quantity", quantity, own)
        return own[quantity]

    @cached_property
    def envelopes(self) -> dict[int, Envelope]:
        """The Mohr-Coulomb line of every seed with two or more pressures."""
        if self.sample.test != "biaxial":
            return {}
        found = {}
        for seed in dict.fromkeys(each.seed for each in self.done):
            own = [each for each in self.done if each.seed == seed]
            if len(own) > 1:
                strengths = [self.curves[each.member.name].strength for each in own]
                found[seed] = fitted([each.pressure for each in own], strengths)
        return found

    @property
    def warnings(self) -> Iterator[str]:
        """What makes its numbers doubtful: see `Sample.warnings`; no peak or cracks, a rate at which inertia counts."""
        yield from self.sample.warnings
        curves = list(self.curves.values())
        if without := [name for name, curve in self.curves.items() if not curve.has_peak]:
            intact = all(len(self.curves[name].crack_time) == 0 for name in without)
            why = "no bond broke" if intact else "the stress was still rising or level at the end"
            yield f"no peak in {_listed(without)}: {why}"
        if early := [name for name, curve in self.curves.items() if curve.before]:
            yield f"bonds broke under the pressure alone, before the test, in {_listed(early)}"
        if self.sample.test == "biaxial" and curves and not self.envelopes:
            yield "friction angle and cohesion need two or more pressures"
        fast = [(c.rate, limit) for c in curves if c.rate > (limit := self.sample.rate_limit(c.strain[c.at_peak]))]
        if fast:
            rate, limit = max(fast, key=lambda pair: pair[0] / pair[1])
            above = f"strain rate {rate:.3g} 1/s is above {limit:.3g} 1/s, ε_peak·c/(15 H)"
            raises = f"inertia raises the peak ({len(fast)} of {len(curves)} samples)"
            yield f"{above}, so {raises}; give a lower --rate"


def measured(curve: LoadingCurve, shares: tuple[float, float] = SHARES) -> dict[str, float]:
    """The quantities of a curve by name; strains, and cracks by kind up to the peak and the end, are pure numbers.

    ``young`` and ``poisson`` are those of the two-dimensional sample, whose third direction does not count;
    ``…_plane_strain`` those of the isotropic solid whose section under plane strain has them.
    """
    values = {"strength": curve.strength, "first_crack": curve.first_crack}
    if curve.kind != "brazilian":
        young, poisson = curve.elastic(*shares)
        plane = poisson / (1.0 + poisson)
        values |= {"young": young, "poisson": poisson}
        values |= {"young_plane_strain": young * (1.0 - plane**2), "poisson_plane_strain": plane}
        values["strain_at_peak"] = float(curve.strain[curve.at_peak])
    peak = curve.time[curve.at_peak]
    for name, shear in (("tension", False), ("shear", True)):
        values[f"{name}_cracks_at_peak"] = float(curve.cracks(shear=shear, until=peak))
        values[f"{name}_cracks"] = float(curve.cracks(shear=shear))
    return values | {"rate": curve.rate}


def specimens_of(sample: Sample, seeds: int, pressures: Sequence[float] | None = None) -> list[Specimen]:
    """The runs of a test for a number of seeds and each pressure (Pa), by default `default_pressures`.

    Raises CaseError for invalid numbers, and cases that are not valid.
    """
    if pressures and sample.test != "biaxial":
        raise CaseError(["--pressures: is for biaxial; other tests have free sides"])
    if pressures and not (all(0.0 <= each < inf for each in pressures) and len(set(pressures)) == len(pressures)):
        given = ",".join(f"{each:g}" for each in pressures)
        raise CaseError([f"--pressures: is {given}, must be different finite numbers, none negative"])
    if seeds < 1:
        raise CaseError([f"--seeds: is {seeds}, must be 1 or more"])
    found = []
    for pressure in pressures or default_pressures(sample):
        for by in range(seeds):
            case = loads(sample.text(by, pressure), sample.case.folder, sample.case.name)
            seed = int(sample.seeded(by).get("seed", 0))
            name = f"seed={seed}" + (f",pressure={pressure:.6g}" if sample.test == "biaxial" else "")
            changes = {"packing.seed": seed, "pressure": pressure}
            member = Member(name, changes, replace(case, name=name), key_of(case, ["run"]))
            found.append(Specimen(seed, pressure, member))
    return found


def perform(
    sample: Sample,
    specimens: Sequence[Specimen],
    options: Options,
    folder: Path,
    report: Report,
    shares: Sequence[float] = SHARES,
) -> Tested:
    """Run a test; complete runs are not repeated, see `sweep`. shares : as of `Tested`.

    Raises CaseError for invalid shares, and as `sweep`.
    """
    if len(shares) != 2 or not 0.0 <= shares[0] < shares[1] <= 1.0:
        given = ",".join(f"{each:g}" for each in shares)
        raise CaseError([f"--shares: is {given}, must be two shares of the peak, as 0.1,0.5"])
    outcomes = sweep([each.member for each in specimens], options, folder, report)
    found = Tested(sample, specimens, outcomes, folder, (shares[0], shares[1]))
    for each in found.done:  # past its peak, so there is nothing to continue
        remove(found.record(each).with_name(CHECKPOINT))
    return found


def default_pressures(sample: Sample) -> list[float]:
    """Pressures (Pa): none, and of a biaxial test a tenth, a quarter and a half of a low guess of the strength."""
    if sample.test != "biaxial":
        return [0.0]
    guess = sample.peak_strain * sample.elastic[0]
    return [0.0, *(float(f"{share * guess:.2g}") for share in (0.1, 0.25, 0.5))]


def _listed(names: Sequence[str]) -> str:
    """The first few names, and how many more there are."""
    more = len(names) - MOST_NAMED
    return ", ".join(names[:MOST_NAMED]) + (f" and {more} more" if more > 0 else "")
