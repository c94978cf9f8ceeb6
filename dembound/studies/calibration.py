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
from dataclasses import dataclass, field, replace
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
        return {
            "name": self.case.name,
            "version": __version__,
            "boundary": self.side,
            "wave": self.motion,
            "kind": self.kind,
            "method": self.method,
            "incident": self.incident,
            "result": self.result,
            "beta": self.beta,
            "outgoing": self.outgoing,
            "ratio": self.ratio,
            "particles": self.particles,
            "steps": self.steps,
            "reduced": self.shortened,
            "compared": self.compared,
        }

    def write(self, path: Path) -> None:
        """Record the passes in an HDF5 file: attributes, and datasets beta, outgoing (m/s) and ratio."""
        with new_file(path) as file:
            scalars = {key: value for key, value in self.summary().items() if not isinstance(value, list)}
            describe(file, {**scalars, "case": self.case.text, "reduced": "\n".join(self.shortened)})
            for name, values, unit in (
                ("beta", self.beta, "1"),
                ("outgoing", self.outgoing, "m/s"),
                ("ratio", self.ratio, "1"),
            ):
                write(file, name, np.array(values), unit)


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
    method, start, tolerance, full = how.method, how.start, how.tolerance, how.full
    if not 0.0 < tolerance < np.inf:
        raise CaseError([f"--tolerance: is {tolerance:g}, must be above 0"])
    motion = calibrated_motion(case, side, motion)
    alone, left_out = in_one_layer(case, side, motion)
    plain, more = linear_medium(alone)
    left_out += more
    table = plain.side(side)
    pulse = calibration_pulse(alone, side, motion)
    kind: Literal["absorbing", "input"] = "input" if table.waves else "absorbing"
    if method == "homogenised":
        scene = build(alone)
        beta = float(f"{homogenised_beta(scene, side, motion):.{HOMOGENISED_DIGITS}g}")
        return Calibration(case, side, motion, method, kind, pulse.peak(), [], result=beta, particles=scene.count)
    strip, shortened = full_scene(plain, side, motion, pulse) if full else short_strip(plain, side, motion, pulse)
    scene = build(strip)
    require_dashpots_alone(scene, side)
    body = scene if full else build(in_strip(plain, normal_axis(side), SIDE * plain.packing.radius, keeps=True))
    matched = homogenised_beta(body, side, motion)
    across = 1 - normal_axis(side)
    is_narrow = strip.packing.copies[across] == plain.packing.copies[across]
    share = homogenised_beta(scene, side, motion) / matched if is_narrow else 1.0
    found = Calibration(
        case=case,
        side=side,
        motion=motion,
        method=method,
        kind=kind,
        incident=pulse.peak(),
        shortened=[*shortened, *reduced(scene).scene.reduced, *left_out],
        particles=scene.count,
    )
    predicted = start is None and table.factors[motion] == "matched"
    beta = factors_in(body if is_narrow else scene, side)[motion] if start is None else start
    if not 0.0 < beta < np.inf:
        raise CaseError([f"boundary.{side}.{found.factor}: is {beta:g}, must be above 0 to start a calibration"])
    time_step, _ = choose_step(scene)  # it does not depend on β: centred dashpots do not reduce the stability limit

    def add_pass(beta: float) -> None:
        trial = with_boundaries(scene, _with_beta(strip, side, motion, share * beta))
        outgoing, steps = _pass(trial, time_step, found, pulse)
        found.beta.append(beta)
        found.outgoing.append(outgoing)
        found.steps += steps
        if report is not None:
            report(found)

    for _ in range(MOST_PASSES):
        add_pass(beta)
        if abs(found.ratio[-1] - 1.0) < tolerance and not (predicted and len(found.beta) == 1):
            found.result = known(beta, found.ratio[-1])
            if method == "impedance" and abs(found.result / matched - 1.0) > tolerance:
                usual = float(f"{matched:.{HOMOGENISED_DIGITS}g}")
                if _returns_less(found, plain, pulse, usual):
                    add_pass(usual)
                    found.result = usual
                    found.compared += ", which is kept"
            return found
        beta = _next_beta(found)
    raise RunError(
        f"calibration of {side} did not converge in {MOST_PASSES} passes: M_out/M_in = {found.ratio[-1]:.5f} "
        f"at {found.factor} = {found.beta[-1]:.5f}"
    )


def known(beta: float, ratio: float) -> float:
    """β rounded to the change that another pass of the impedance relation would make, to at most 6 digits.

    beta, ratio : factor and M_out/M_in of the last pass.
    """
    change = beta * abs(ratio / (2.0 - ratio) - 1.0)
    largest = MOST_DIGITS - 1 - math.floor(math.log10(beta))
    return round(beta, largest if change == 0.0 else min(largest, -math.floor(math.log10(change))))


def _returns_less(found: Calibration, plain: DiskCase, pulse: Cosine, usual: float) -> bool:
    """Whether the side returns less of the pulse with the matched factor than with the result, both put into words.

    plain : the case from `linear_medium`. usual : the matched factor.
    """
    own, other = returned(plain, found.side, found.motion, pulse, [found.result, usual])
    with_own, with_usual = (percent(share, 3) for share in (own, other))
    found.compared = f"returned: {with_own} with {found.result:g}, {with_usual} with the matched {usual:g}"
    return other < own


def _next_beta(found: Calibration) -> float:
    """The factor to try next, from the last pass."""
    beta, ratio = found.beta[-1], min(found.ratio[-1], LARGEST_RATIO)
    absorbing = found.kind == "absorbing"
    if found.method == "ratio":
        return beta * ratio if absorbing else beta / ratio
    return beta * ratio / (2.0 - ratio) if absorbing else beta * (2.0 - ratio) / ratio


def _pass(scene: DiskScene, time_step: float, found: Calibration, pulse: Cosine) -> tuple[float, int]:
    """M_out of one run (m/s) and its number of steps."""
    simulation = Simulation(reduced(scene).scene, time_step)
    due = pulse.peak_time() + (0.0 if found.kind == "input" else _travel(scene, found.side, found.motion))
    simulation.run(int(np.ceil((due + AFTER * pulse.period) / time_step)))
    peaks = simulation.edge_peaks(found.side)[:, axis_of_motion(found.side, found.motion), 1]
    _must_be_past(simulation, found, float(peaks.mean()))
    return float(peaks.mean()), simulation.state.step


def _must_be_past(simulation: Simulation, found: Calibration, peak: float) -> None:
    """Raise RunError if the pulse at an input side has not passed its peak (m/s) when a pass ends."""
    scene = simulation.scene
    velocity = simulation.state.velocity[axis_of_motion(found.side, found.motion), scene.edges[found.side].nodes]
    if found.kind == "input" and np.abs(velocity).mean() >= PAST * peak:
        raise RunError(
            f"calibration of {found.side}: the pulse is not past its peak after {simulation.time:.4g} s, when a pass "
            f'ends; "{scene.case.side(found.side).type}" transmits its waves late or not at all'
        )


def _travel(scene: DiskScene, side: str, motion: Motion) -> float:
    """Time (s) a wave takes from the opposite side."""
    axis = scene.edges[side].axis
    return float(scene.assembly.size[axis]) / scene.ground.wave_speeds(axis)[0 if motion == "p" else 1]


def calibrated_motion(case: DiskCase, side: str, motion: Motion | None = None) -> Motion:
    """The motion, or else the default one, for which a side is calibrated.

    Raises CaseError when the side has no dashpots, its factors follow from rock, or its motion is held.
    """
    table = case.side(side)
    if not table.factors:
        usable = ", ".join(name for name, other in case.boundary.items() if other.factors) or "none"
        raise CaseError(
            [f"boundary.{side}: is {table.type}, only sides with dashpots can be calibrated; here: {usable}"]
        )
    if table.is_interface:
        raise CaseError([f"boundary.{side}.rock: gives the factors of this side, which needs no calibration"])
    motion = motion or default_motion(case, side)
    _must_move(case, side, motion)
    return motion


def default_motion(case: DiskCase, side: str) -> Motion:
    """S where the normal motion is held, or if only S waves run between this side and the opposite one."""
    driven = {motion for end in (side, OPPOSITE[side]) for motion in case.side(end).waves}
    held = "xy"[normal_axis(side)] in case.motion.held
    return "s" if held or driven == {"s"} else "p"


def _must_move(case: DiskCase, side: str, motion: Motion) -> None:
    name = "xy"[axis_of_motion(side, motion)]
    if name in case.motion.held:
        raise CaseError([f"motion.held: holds {name}, the motion of {motion.upper()} waves at the side {side}"])


def _with_beta(case: DiskCase, side: str, motion: Motion, beta: float) -> DiskCase:
    table = case.boundary[side].with_factors({motion: beta})
    return replace(case, boundary={**case.boundary, side: table})
