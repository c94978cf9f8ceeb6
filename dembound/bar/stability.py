"""The steps of a bar: their length, limit and cost, the infinite row of its nodes, and the front of its waves.

Bars at rest, in which noise is stepped, show whether a step is stable.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from itertools import product

import numpy as np

from dembound.bar.body import ROUNDING
from dembound.bar.scene import BarScene, build_bar
from dembound.casefile.bar.model import BarCase
from dembound.errors import CaseError
from dembound.exact.bar import Lattice, usual_shares
from dembound.methods.bonds import Bonds
from dembound.methods.rod import Range
from dembound.motion.part import System
from dembound.motion.paths import Front, Source
from dembound.motion.stability import Trial, at_rest, left_out

STEP, BOND, LAYER_BOND = 250.0, 0.45, 6.0
"""Nanoseconds of a step in any case, of a spring or bond (benchmarks/bar_rate.py), and of a bond in a layer: 0.3 µs for
40 nodes (docs/evidence/bar_ends.md).
"""


def time_per_step(scene: BarScene) -> float:
    """Nanoseconds of a step of a bar with its first bonds."""
    layers = sum(len(each.inner) * each.count for each in scene.layers.values())
    return STEP + BOND * scene.case.method.begin(scene.rod).alive + LAYER_BOND * layers


BELOW = 0.99
"""Largest share of the limit where its highest mode would grow: an opening contact leaves 3.5/N of a front's velocity.

The closer to 1, the shorter fronts ring: over 240 cells 1.2 % of the stress is left at 0.999, 0.6 % of it at 0.99 and
2.4 % at 0.9; at 0.999 the swings of repeated impacts on 50 cells are half as large as their fronts.
"""

SUDDEN = 0.2
"""Swing of springs over the largest load above which a bar may not run at the limit: at `BELOW` fronts overshoot so."""

FORESEEN = 1_000_000
"""Most steps of a run for which swings by loads are computed, within half a second and 100 MB."""


def own_step(scene: BarScene, limit: float) -> float:
    """The time step (s) of the case: a share of the stability limit (s), or the given step, even above the limit.

    It is shortened to `BELOW` of the limit where the bar may not run at the limit itself.
    """
    step = _given_step(scene, limit)
    is_near = BELOW * limit < step <= limit * (1.0 + ROUNDING)
    return BELOW * limit if is_near and not is_bounded_at_limit(scene) else step


def _given_step(scene: BarScene, limit: float) -> float:
    """The time step (s) that the case gives; limit : s."""
    run = scene.case.run
    if run.courant is not None:
        return run.courant * unit_step(scene)
    return float(run.time_step) if isinstance(run.time_step, float | int) else run.safety * limit


def is_bounded_at_limit(scene: BarScene) -> bool:
    """Whether the motion is d'Alembert's at the limit: local springs, one Δx/c in all ranges, no contacts.

    And no loads so sudden that springs swing by more than `SUDDEN` of them within the run.
    """
    return _is_exact(scene) and _swing(scene) <= SUDDEN


def _is_exact(scene: BarScene) -> bool:
    """Whether waves are exact at the limit: local springs, one Δx/c in all ranges, and no contacts."""
    bonds = scene.case.method.begin(scene.rod)
    steps = [part.spacing / part.speed for part in scene.rod.ranges]
    is_local = not bonds.zones and np.array_equal(bonds.spring, scene.rod.springs)
    return is_local and not scene.rod.touching and max(steps) <= min(steps) * (1.0 + ROUNDING)


def _swing(scene: BarScene) -> float:
    """Largest swing of a spring's force in a run at the limit, over that of the loads; 0 where no swing can grow."""
    rod, supports, step = scene.rod, scene.supports, unit_step(scene)
    if not scene.case.load or not all(scene.case.side(side).is_free for side in scene.edges):
        return 0.0
    from scipy.signal import lfilter  # imported here, as it takes a second and other bars do not need it

    forces = supports.sample(step * np.arange(min(round(scene.case.run.duration / step), FORESEEN)), 0.0)
    driven = forces @ (-1.0) ** supports.node
    driven[1::2] *= -1.0
    most, mass = np.abs(forces).sum(axis=1).max(initial=0.0), rod.mass.sum()
    rest = 0.5 * step * (rod.drag_rate @ rod.mass) / mass
    sums = lfilter([1.0], [1.0 + rest, -2.0, 1.0 - rest], driven)  # ΣS, of which attenuation takes a part in each step
    return float(2.0 * rod.mass.max() / mass * np.abs(sums).max() / most) if most > 0.0 else 0.0


def shortened_in_words(scene: BarScene, time_step: float) -> str:
    """A line that the given step is shortened to time_step (s); empty if it is not."""
    run, limit = scene.case.run, time_step / BELOW
    given = _given_step(scene, limit)
    if own_step(scene, limit) == given:
        return ""
    step = f"time_step: is {given:g} s, shortened to {time_step:.6g} s"
    if run.time_step == "auto":
        step = f"safety: is {run.safety:g}, shortened to {BELOW:g}"
    if run.courant is not None:
        step = f"courant: is {run.courant:g}, shortened to {time_step / unit_step(scene):.6g}"
    cause = "contacts that open" if scene.rod.touching else "so sudden loads" if _is_exact(scene) else "fronts"
    return f"run.{step}, {BELOW:g} of the stability limit: at the limit {cause} leave swings that grow with every step"


def choose_step(scene: BarScene) -> tuple[float, float]:
    """Time step to run with and its stability limit (s) at every stage of the bar's method, exact to rounding.

    The step may be given by its Courant number. Raises CaseError when the case gives a step above the limit.
    """
    limit = scene.step_limit()
    step = own_step(scene, limit)
    if step > limit * (1.0 + ROUNDING):
        courant = scene.case.run.courant
        if courant is None:
            raise CaseError([f"run.time_step: is {step:g} s, must not be above the stability limit {limit:.6g} s"])
        most = limit / unit_step(scene)
        raise CaseError([f"run.courant: is {courant:g}, must not be above {most:.6g}, the stability limit"])
    return step, limit


def unit_step(scene: BarScene) -> float:
    """The time step (s) at a Courant number of 1, in the range where this is shortest."""
    return min(part.spacing / part.speed for part in scene.rod.ranges)


def trials_of_bar(case: BarCase) -> tuple[list[Trial], list[str]]:
    """For every stage of its method a bar with its bonds, and a sentence on how it differs from the case.

    Raises the errors of building a scene.
    """
    scene = build_bar(at_rest(case))
    step, cost = own_step(scene, scene.step_limit()), time_per_step(scene)
    stages = case.method.stages(scene.rod)
    found = []
    for index, bonds in enumerate(stages):

        def system(time_step: float, index: int = index) -> System:
            return scene.system(time_step, case.method.stages(scene.rod)[index])

        name = case.method.name if len(stages) == 1 else f"{case.method.type}, stage {index + 1}"
        found.append(Trial(name, scene, scene.stable_step(bonds), step, system, is_linear=True, step_cost=cost))
    stays = ["the method stays at each stage"] if len(stages) > 1 else []
    return found, [f"{scene.count:,} nodes, the whole bar", *left_out(case), *stays]


DIGITS = 12
"""Digits of the share of stress that bonds of one length carry; further digits are rounding errors."""


def lattice_of(bonds: Bonds, part: Range, time_step: float) -> Lattice:
    """The infinite row of nodes with the bonds of the middle of a range; time_step s."""
    shares = tuple(round(share, DIGITS) for share in bonds.shares(part))
    horizon = len(shares)
    usual = shares == tuple(round(share, DIGITS) for share in usual_shares(horizon))
    return Lattice(horizon, part.spacing, time_step, part.speed, None if usual else shares)


def even_lattices(stages: Iterable[Bonds], ranges: Iterable[Range], time_step: float) -> Iterator[Lattice]:
    """The infinite rows of all stages of a method in all ranges; time_step s.

    Stages in which a zone of other bonds ends in the middle of a range are left out, as the row is not uniform there.
    """
    for bonds, part in product(stages, ranges):
        if math.isclose(sum(bonds.shares(part)), 1.0, rel_tol=10.0**-DIGITS):
            yield lattice_of(bonds, part, time_step)


def carrying_lattices(scene: BarScene, time_step: float) -> list[Lattice]:
    """For every range the infinite row of nodes in which waves run before the method reacts; time_step s."""
    bonds = scene.case.method.begin(scene.rod)
    return [lattice_of(bonds, part, time_step) for part in scene.rod.ranges]


def sources_of_bar(case: BarCase) -> list[Source]:
    """Driven and loaded ends and moving ranges; a load spread over several nodes starts at the innermost one.

    A range that moves at the start sends waves from when it meets the next one until its own wave has returned once.
    """
    bar = case.bar
    speed = min(part.speed for part in bar.parts)
    places = {"left": 0.0, "right": bar.length}
    sources = [
        Source((places[side], 0.0, places[side], 0.0), case.wave[name].start, case.wave[name].duration(), speed)
        for side, waves in case.driving.items()
        for name in waves.values()
    ]
    for load in case.load:
        wave, end = case.wave[load.wave], bar.end(load.side)
        wide = (load.nodes - 1) * end.length / end.cells
        low, high = (0.0, wide) if load.side == "left" else (bar.length - wide, bar.length)
        sources.append(Source((low, 0.0, high, 0.0), wave.start, wave.duration(), speed))
    gaps = sum(given.gap for given in bar.range)
    for given, part, start in zip(bar.range, bar.parts, bar.starts, strict=False):
        if given.velocity != 0.0:
            over = gaps / abs(given.velocity) + 2.0 * part.length / part.speed
            sources.append(Source((start, 0.0, start + part.length, 0.0), 0.0, over, speed))
    return sources


SAMPLES = 400
"""Wave numbers at which group speeds are computed, per spacing of the horizon."""


def front_of_bar(scene: BarScene, time_step: float) -> Front:
    """The fastest waves of a bar that is stepped by time_step (s), at any stage of its method.

    With bonds up to m spacings Δx long, phase speeds are c(1 − (kΔx)²((m² + 1)/2 − ν²)/24): a row of nodes bonded to
    neighbours only that has the same dispersion has at most the spacing Δx√((m² + 1)/2).
    """
    ranges = scene.rod.ranges
    speed = max(part.speed for part in ranges)
    for row in even_lattices(scene.case.method.stages(scene.rod), ranges, time_step):
        groups = row.group_velocity(row.shortest * np.linspace(0.0, 1.0, SAMPLES * row.horizon, endpoint=False))
        speed = max(speed, float(np.nanmax(groups)))
    horizon = scene.case.method.largest_horizon
    return Front(speed, max(part.spacing for part in ranges) * float(np.sqrt(0.5 * (horizon**2 + 1))))
