"""Calibration: the factor β with which a side's dashpots completely absorb, or transmit, a plane wave.

A pulse of peak M_in meets the side at normal incidence; M_out is the mean peak velocity of the side's particles. For an
absorbing side of relative impedance β/β0, M_out/M_in = 2/(1 + β/β0); for an input side it is 2/(1 + β0/β). Both are 1
at β0.

Only the part of the scene that affects M_out is modelled: a strip of the scene's bricks, just long enough that no
reflection returns to the side before the peak has left it. Each pass ends at that time. The strip is a linear medium
under one wave: no loads, no static stage, the elastic law.

Where the strip is periodic sideways and a scene of one brick is not, other disks are seen from outside. Dashpots have
the same impedance per length for the same βΣD/H, so β of the strip is β of the scene times the ratio of their matched
factors, (H/ΣD of the strip)/(H/ΣD of the scene); all factors here are those of the scene. In wider scenes other disks
at corners do not change the dashpots beside most of the wave.

Peaks are not all that returns: of short pulses disks scatter some, and a free bar disperses. So what the side returns
of the pulse with β0 is compared with what it returns with the matched factor, and the better one is the result.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

import numpy as np

from dembound.boundaries import OPPOSITE, Motion, axis_of_motion, normal_axis
from dembound.casefile.disks import DiskCase
from dembound.disks.matching import factors_in, homogenised_beta, require_dashpots_alone
from dembound.disks.reduced import reduced
from dembound.disks.scene import DiskScene, build, with_boundaries
from dembound.disks.stability import choose_step
from dembound.errors import CaseError, RunError
from dembound.motion.simulation import Simulation
from dembound.results.committed import new_file
from dembound.results.datasets import describe, write
from dembound.studies.asked import AS_USUAL, Calibrating, Method
from dembound.studies.strip import (
    AFTER,
    calibration_pulse,
    full_scene,
    in_one_layer,
    in_strip,
    linear_medium,
    returned,
    short_strip,
    with_beta,
)
from dembound.version import __version__
from dembound.waves import Cosine
from dembound.words import percent

MOST_PASSES = 40

LARGEST_RATIO = 1.99
"""Largest M_out/M_in used: dispersion may raise the ratio above 2, for which the relation has no solution."""


HOMOGENISED_DIGITS = 5
"""Number of known digits of β from the brick alone, which agrees with plane waves within 0.01 %."""

MOST_DIGITS = 6
"""Largest number of known digits of β from passes; further digits are rounding errors of the peaks."""

SIDE = 20.0
"""Length in radii of the body by which the disks of a side are found."""

PAST = 0.99
"""Largest velocity of the side at the end of a pass over its peak; AFTER its peak a cosine is at 0.905."""


@dataclass
class Calibration:
    """The results of a calibration.

    Attributes
    ----------
    case, side, motion ("p" or "s"), method : the arguments.
    kind : "absorbing" or "input".
    incident : M_in, m/s.
    beta, outgoing : per pass, the factor tried and the M_out (m/s) it gave.
    result : the calibrated factor, to the digits that are known, see `known`.
    shortened : differences between the calibrated scene and the case's, one sentence each.
    compared : what the side returns with the factor of the passes and with the matched one; empty where both are alike.
    particles, steps : size of the calibrated scene, and steps of all passes.
    """

    case: DiskCase
    side: str
    motion: Motion
    method: Method
    kind: Literal["absorbing", "input"]
    incident: float
    shortened: list[str]
    beta: list[float] = field(default_factory=list)
    outgoing: list[float] = field(default_factory=list)
    result: float = float("nan")
    compared: str = ""
    particles: int = 0
    steps: int = 0

    @property
    def ratio(self) -> list[float]:
        """M_out/M_in per pass."""
        return [outgoing / self.incident for outgoing in self.outgoing]

    @property
    def factor(self) -> str:
        """The calibrated key of the case file: beta_p or beta_s."""
        return f"beta_{self.motion}"

    def summary(self) -> dict[str, Any]:
        """The passes and the result as plain JSON values."""
        of = {"name": self.case.name, "version": __version__, "boundary": self.side, "wave": self.motion}
        own = ("kind", "method", "incident", "result", "beta", "outgoing", "ratio", "particles", "steps")
        found = {name: getattr(self, name) for name in own}
        return of | found | {"reduced": self.shortened, "compared": self.compared}

    def write(self, path: Path) -> None:
        """Record the passes in an HDF5 file: attributes, and datasets beta, outgoing (m/s) and ratio."""
        with new_file(path) as file:
            scalars = {key: value for key, value in self.summary().items() if not isinstance(value, list)}
            describe(file, {**scalars, "case": self.case.text, "reduced": "\n".join(self.shortened)})
            for name, unit in (("beta", "1"), ("outgoing", "m/s"), ("ratio", "1")):
                write(file, name, np.array(getattr(self, name)), unit)


Report = Callable[[Calibration], None]


def calibrate(
    case: DiskCase,
    side: str,
    how: Calibrating = AS_USUAL,
    *,
    motion: Motion | None = None,
    report: Report | None = None,
) -> Calibration:
    """Find β of one side for P (motion "p", along its normal) or S waves ("s", across it).

    Parameters
    ----------
    motion : by default P, or S if the motion along the normal is held or only S waves run along it.
    how.method : "impedance" solves the end's impedance relation for β0, checks it, and keeps "matched" where the side
        returns less with it; "ratio" multiplies β by M_out/M_in (Z fig. 5; M_in/M_out on an input side); "homogenised"
        takes β0 = (c_eff/c)·H/ΣD, as "matched" does, from brick and side, without a run.
    how.start : first β; by default the case's. If that is "matched", it is refined at least once.
    how.tolerance : ends when |M_out/M_in − 1| is below it.
    how.full : use the whole scene, with its own boundaries all around, instead of a strip.
    report : called after every pass.

    Beside layers β multiplies ρc of each, and is found in the slowest of those at the side.

    Raises CaseError when the side has no dashpots, keeps springs beside them, its motion is held, or its layers need
    different factors, RunError when β does not converge.
    """
    if not 0.0 < how.tolerance < np.inf:
        raise CaseError([f"--tolerance: is {how.tolerance:g}, must be above 0"])
    motion = calibrated_motion(case, side, motion)
    alone, left_out = in_one_layer(case, side, motion)
    plain, more = linear_medium(alone)
    pulse = calibration_pulse(alone, side, motion)
    kind: Literal["absorbing", "input"] = "input" if plain.side(side).waves else "absorbing"
    found = Calibration(case, side, motion, how.method, kind, pulse.peak(), [])
    if how.method == "homogenised":
        scene = build(alone)
        found.result, found.particles = _rounded(homogenised_beta(scene, side, motion)), scene.count
        return found
    passes = _Passes(plain, pulse, found, how.full, report)
    found.shortened += [*left_out, *more]
    beta = passes.own if how.start is None else how.start
    if not 0.0 < beta < np.inf:
        raise CaseError([f"boundary.{side}.{found.factor}: is {beta:g}, must be above 0 to start a calibration"])
    predicted = how.start is None and plain.side(side).factors[motion] == "matched"
    for _ in range(MOST_PASSES):
        passes.add(beta)
        if abs(found.ratio[-1] - 1.0) < how.tolerance and not (predicted and len(found.beta) == 1):
            found.result = known(beta, found.ratio[-1])
            if how.method == "impedance" and abs(found.result / passes.matched - 1.0) > how.tolerance:
                passes.keep_matched_if_better()
            return found
        beta = _next_beta(found)
    raise RunError(
        f"calibration of {side} did not converge in {MOST_PASSES} passes: M_out/M_in = {found.ratio[-1]:.5f} "
        f"at {found.factor} = {found.beta[-1]:.5f}"
    )


class _Passes:
    """The passes of a calibration, in a strip of the case or in its whole scene.

    Parameters
    ----------
    plain : the case from `linear_medium`. pulse : that meets the side. found : the calibration, to which passes are
    added. full : whether they are in the whole scene. report : called after each.

    Attributes
    ----------
    own, matched : factors of the case, its own one and that from brick and side.

    Raises CaseError when the side keeps springs beside its dashpots, or the whole scene is too short.
    """

    def __init__(self, plain: DiskCase, pulse: Cosine, found: Calibration, full: bool, report: Report | None) -> None:
        self._plain, self._pulse, self._found, self._report = plain, pulse, found, report
        side, motion = found.side, found.motion
        self._strip, shortened = (full_scene if full else short_strip)(plain, side, motion, pulse)
        self._scene = build(self._strip)
        require_dashpots_alone(self._scene, side)
        axis = normal_axis(side)
        body = self._scene if full else build(in_strip(plain, axis, SIDE * plain.packing.radius, keeps=True))
        self.matched = homogenised_beta(body, side, motion)
        is_narrow = self._strip.packing.copies[1 - axis] == plain.packing.copies[1 - axis]
        self._share = homogenised_beta(self._scene, side, motion) / self.matched if is_narrow else 1.0
        self.own = factors_in(body if is_narrow else self._scene, side)[motion]
        # it does not depend on β: centred dashpots do not reduce the stability limit
        self._time_step, _ = choose_step(self._scene)
        found.shortened += [*shortened, *reduced(self._scene).scene.reduced]
        found.particles = self._scene.count

    def add(self, beta: float) -> None:
        """Run a pass with a factor, and add it to the calibration."""
        found = self._found
        case = with_beta(self._strip, found.side, found.motion, self._share * beta)
        outgoing, steps = _pass(with_boundaries(self._scene, case), self._time_step, found, self._pulse)
        found.beta.append(beta)
        found.outgoing.append(outgoing)
        found.steps += steps
        if self._report is not None:
            self._report(found)

    def keep_matched_if_better(self) -> None:
        """Compare what the side returns of the pulse with the result and with the matched factor, and keep the better.

        Both shares are put into words.
        """
        found, usual = self._found, _rounded(self.matched)
        own, other = returned(self._plain, found.side, found.motion, self._pulse, [found.result, usual])
        with_own, with_usual = (percent(share, 3) for share in (own, other))
        found.compared = f"returned: {with_own} with {found.result:g}, {with_usual} with the matched {usual:g}"
        if other < own:
            self.add(usual)
            found.result = usual
            found.compared += ", which is kept"


def _rounded(beta: float) -> float:
    """A factor from the brick alone, to the digits that are known."""
    return float(f"{beta:.{HOMOGENISED_DIGITS}g}")


def known(beta: float, ratio: float) -> float:
    """β rounded to the change that another pass of the impedance relation would make, to at most 6 digits.

    beta, ratio : factor and M_out/M_in of the last pass.
    """
    change = beta * abs(ratio / (2.0 - ratio) - 1.0)
    largest = MOST_DIGITS - 1 - math.floor(math.log10(beta))
    return round(beta, largest if change == 0.0 else min(largest, -math.floor(math.log10(change))))


def _next_beta(found: Calibration) -> float:
    """The factor to try next, from the last pass."""
    beta, ratio = found.beta[-1], min(found.ratio[-1], LARGEST_RATIO)
    absorbing = found.kind == "absorbing"
    if found.method == "ratio":
        return beta * ratio if absorbing else beta / ratio
    return beta * ratio / (2.0 - ratio) if absorbing else beta * (2.0 - ratio) / ratio


def _pass(scene: DiskScene, time_step: float, found: Calibration, pulse: Cosine) -> tuple[float, int]:
    """M_out of one run (m/s) and its number of steps.

    Raises RunError if the pulse at an input side has not passed its peak when the pass ends.
    """
    side, axis, along = found.side, scene.edges[found.side].axis, axis_of_motion(found.side, found.motion)
    simulation, due = Simulation(reduced(scene).scene, time_step), pulse.peak_time()
    if found.kind == "absorbing":  # the way from the opposite side
        due += float(scene.assembly.size[axis]) / scene.ground.wave_speeds(axis)[0 if found.motion == "p" else 1]
    simulation.run(int(np.ceil((due + AFTER * pulse.period) / time_step)))
    peak = float(simulation.edge_peaks(side)[:, along, 1].mean())
    velocity = simulation.state.velocity[along, simulation.scene.edges[side].nodes]
    if found.kind == "input" and np.abs(velocity).mean() >= PAST * peak:
        raise RunError(
            f"calibration of {side}: the pulse is not past its peak after {simulation.time:.4g} s, when a pass "
            f'ends; "{scene.case.side(side).type}" transmits its waves late or not at all'
        )
    return peak, simulation.state.step


def calibrated_motion(case: DiskCase, side: str, motion: Motion | None = None) -> Motion:
    """The motion, or else the default one, for which a side is calibrated.

    Raises CaseError when the side has no dashpots, its factors follow from rock, or its motion is held.
    """
    table = case.side(side)
    if not table.factors:
        usable = ", ".join(name for name, other in case.boundary.items() if other.factors) or "none"
        said = f"is {table.type}, only sides with dashpots can be calibrated; here: {usable}"
        raise CaseError([f"boundary.{side}: {said}"])
    if table.is_interface:
        raise CaseError([f"boundary.{side}.rock: gives the factors of this side, which needs no calibration"])
    motion = motion or default_motion(case, side)
    name = "xy"[axis_of_motion(side, motion)]
    if name in case.motion.held:
        raise CaseError([f"motion.held: holds {name}, the motion of {motion.upper()} waves at the side {side}"])
    return motion


def default_motion(case: DiskCase, side: str) -> Motion:
    """S where the normal motion is held, or if only S waves run between this side and the opposite one."""
    driven = {motion for end in (side, OPPOSITE[side]) for motion in case.side(end).waves}
    held = "xy"[normal_axis(side)] in case.motion.held
    return "s" if held or driven == {"s"} else "p"
