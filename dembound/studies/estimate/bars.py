"""The error of a bar: what its ends, its nodes and its steps add to the motion at its monitors.

Up to the first change of its bonds a bar is linear, and its motion is known at every frequency, without a run:

- own: the bar as it is stepped, with its own ends (chain.py).
- endless: the same nodes and steps, but beyond an absorbing end the bar goes on, and the wave that enters there is the
  one that the case gives.
- exact time: the endless one, but with Δt = 0.
- exact: rods without nodes (rods.py), whose absorbing ends take all. The stress of a node at an end is that of the
  plane half a spacing inside, and is compared with the exact one there.

Own less endless is the error of the ends, endless less exact time that of the time step, the rest that of the grid. So
all ways of a wave, there and back, are included, and so are ends that are softer than the bar, and what is lost at
interfaces between ranges.

Whether the bar is linear is seen in the record itself: at a monitor whose record is not that of `own`, nothing is said.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from dembound.bar.layer_echo import WIDEST
from dembound.bar.scene import build_bar
from dembound.bar.stability import choose_step
from dembound.casefile.bar import BarCase
from dembound.studies.estimate.bar_motions import Motions
from dembound.studies.estimate.causes import Cause, Recorded
from dembound.studies.estimate.window import Window

UNEXPLAINED = 1.0 / 3.0
"""Largest difference of a record from the linear bar, over its estimated error, with which this is given."""

SMALLEST = 1e-3
"""RMS of this difference over that of the record below which it does not matter."""

HOW = "from the waves of the linear bar at each frequency"
"""How its errors are found."""


def causes_of_bar(
    case: BarCase, recorded: Mapping[str, Recorded], budget: float = 0.1, until: float = math.inf
) -> tuple[list[Cause], list[str], float]:
    """Causes of the errors of a bar, a line for everything that is not estimated, and their cost.

    recorded : of the run, by monitor. budget : share of the run's work that may be spent; nothing is run for a bar, and
    the cost is 0. until : s, first break or change of the bar: later errors are not estimated, and are 0 here.
    """
    refused = _refused(case)
    if refused or not recorded:
        return [], refused, 0.0
    times = {name: each.time for name, each in recorded.items()}
    scene = build_bar(case)
    step = choose_step(scene)[0]
    last = min(until, max(float(time[-1]) for time in times.values()))
    window = Window.up_to(last, step)
    motion = Motions(case, scene, window, times)
    own, endless, exact_time, exact = motion.own(), motion.endless(step), motion.endless(0.0), motion.exact()
    parts = {"grid": (exact_time, exact), "time step": (endless, exact_time)}
    if motion.absorbing:
        parts["sides"] = (own, endless)
    lines = [_after(until)] if until < max(float(time[-1]) for time in times.values()) else []
    known = []
    for name, each in recorded.items():
        line = _differs(name, each, own[name], exact[name], until)
        lines += [line] if line else []
        known += [] if line else [name]
    causes = [
        Cause(cause, HOW, {name: _errors(recorded[name], of[name], less[name], until) for name in known})
        for cause, (of, less) in parts.items()
    ]
    return (causes if known else []), lines, 0.0


def _refused(case: BarCase) -> list[str]:
    """Why nothing can be estimated; empty if something can."""
    bar = case.bar
    if any(given.interface == "contact" for given in bar.range):
        return ["errors of a bar with contacts, which open and close"]
    if any(given.velocity for given in bar.range):
        return ["errors of a bar whose ranges move at the start"]
    if case.method.largest_horizon > WIDEST:
        return [f"errors of a bar with a horizon above {WIDEST} spacings"]
    return []


def _after(until: float) -> str:
    return f"errors after {until:g} s, when the bar breaks or changes; a break depends on the nodes near it"


def _differs(
    name: str, recorded: Recorded, own: Mapping[str, np.ndarray], exact: Mapping[str, np.ndarray], until: float
) -> str:
    """A line if the record is not that of a linear bar; empty otherwise."""
    worst, before = 0.0, recorded.time <= until
    for quantity, values in recorded.values.items():
        seen = values[before, 0]
        size = float(np.linalg.norm(seen))
        rest = float(np.linalg.norm(seen - own[quantity][before]))
        error = float(np.linalg.norm((own[quantity] - exact[quantity])[before]))
        if rest > max(SMALLEST * size, UNEXPLAINED * error):
            worst = max(worst, rest / size if size > 0.0 else math.inf)
    if worst == 0.0:
        return ""
    return f"errors at {name}, whose record differs by {100.0 * worst:.2g} % from that of a bar that does not change"


def _errors(
    recorded: Recorded, of: Mapping[str, np.ndarray], less: Mapping[str, np.ndarray], until: float
) -> dict[str, np.ndarray]:
    """Quantity -> error (k, c), along the bar, 0 later than `until`."""
    errors = {}
    for quantity, values in recorded.values.items():
        errors[quantity] = np.zeros_like(values, dtype=float)
        errors[quantity][:, 0] = np.where(recorded.time <= until, of[quantity] - less[quantity], 0.0)
    return errors
