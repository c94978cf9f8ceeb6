"""Exact reflection of a wave by an absorbing end of a bar, for the wave's own spectrum, its nodes, bonds and steps.

It is the largest difference of the velocity from a bar that goes on beyond this end, over the largest velocity of that
bar, at any node and in any step of the run. So it includes reflections of the shortest waves, which sharp pulses and
forces on single nodes contain, and their reflection at the other end. Short waves are slow: the longer a run is, the
more of them return.

Both bars are stepped (linear_steps.py) under a unit value of the wave in one step, and the motion is convolved with the
wave's values. Where this would take too long, a bar is represented by `CELLS` of the range at this end, with the load
or the wave at its other end, and a run by as many ways along it: a longer bar returns less, as short waves disperse.
Changes of bonds are not included.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from dembound.bar.layer_echo import WIDEST
from dembound.bar.linear_steps import LinearSteps
from dembound.bar.scene import BarScene, build_bar
from dembound.boundaries.matched_layer import MatchedLayer
from dembound.casefile.bar import BarCase

CELLS = 128
"""Cells of a bar that represents a longer one; more if a load is on more than half as many nodes."""

LONGEST = 1000
"""Nodes of a layer up to which this is computed."""

WORK, KEPT = 3e7, 4e6
"""Most bonds times steps, some 0.5 s, and velocities of all nodes and steps: 32 MB."""

BEYOND = 0.6
"""Cells of the bar that goes on, over the cells that a wave passes in the time for which it is followed."""

FADED = 0.25
"""Last part of this time in which remaining motion is faded out if the run goes on: a sudden end would be a force."""

LONG = 2**20
"""Number of steps of a wave's values that are included."""

SAMPLES = 2**22
"""Values that are convolved at once."""

ROUNDING = 1e-12
"""Bound of the rounding errors of a run of some 10⁴ steps, over its largest motion."""


@dataclass(frozen=True)
class Returned:
    """The reflection of an end.

    shares : by wave the largest reflected motion over the largest motion of the wave, including `ROUNDING`. within :
    time (s) after the wave for which it was followed, infinite for the whole run.
    """

    shares: dict[str, float]
    within: float = math.inf


def returned_of_waves(scene: BarScene, side: str, time_step: float) -> Returned:
    """The reflection of every wave in use by an end; empty where it is not computed.

    Nothing is computed for ends that do not absorb, where a wave enters through dashpots, and for very long bonds and
    layers.
    """
    case, layer = scene.case, scene.layers.get(side)
    end = case.side(side)
    absorbs = end.is_artificial and 0 not in end.prescribed(0) and (layer is not None or not end.waves)
    longest = max([0, *(each.layer.nodes for each in scene.layers.values())])
    if not absorbs or case.method.largest_horizon > WIDEST or longest > LONGEST:
        return Returned({})
    own, part = scene, scene.rod.end(side)
    courant, reach = time_step * part.speed / part.spacing, max(1, case.method.largest_horizon)
    run = steps = whole = math.ceil(case.run.duration / time_step) + 1
    opens = any(given.interface == "contact" for given in case.bar.range)
    if opens or run * (BEYOND * courant * run + own.count) * reach > WORK or run * own.count > KEPT:
        own = build_bar(_short(case, side))
        ways = case.run.duration / case.bar.travel_time
        whole = min(run, math.ceil((ways * own.count + 4.0 * longest) / courant) + 1)
        steps = int(min(whole, math.sqrt(WORK / (BEYOND * courant * reach)), KEPT / own.count))
    endless = build_bar(_layered(own.case, side))
    beyond = endless.layers[side].endless(BEYOND * steps * time_step)
    bars = LinearSteps(own, own.layers, time_step), LinearSteps(endless, {**own.layers, side: beyond}, time_step)
    shares = {}
    known = {name: pushes for name, pushes in _pushes(own).items() if name}
    for name, pushes in known.items():
        both = [[bar.after(*push, steps) for bar in bars] for push in pushes.values()]
        signals = [_signal(own.case, name, time_step, 0.5 * time_step * prescribed) for prescribed in pushes]
        if steps < run:
            past = np.clip((np.arange(steps) / steps - 1.0) / FADED + 1.0, 0.0, 1.0)
            both = [[np.cos(0.5 * np.pi * past)[:, None] ** 2 * each for each in pair] for pair in both]
        last = min(run, len(signals[0]) + steps)
        arrived = _largest([there for _, there in both], signals, last)
        returned = _largest([here - there for here, there in both], signals, last)
        if arrived > 0.0:
            shares[name] = returned / arrived + ROUNDING
    return Returned(shares, math.inf if steps == whole else case.run.duration * steps / whole)


def _short(case: BarCase, side: str) -> BarCase:
    """The case of a bar of some cells of the range at this end."""
    cells = max([CELLS, *(2 * load.nodes for load in case.load)])
    part = case.bar.end(side)
    return replace(case, monitor=(), bar=part.model_copy(update={"length": cells * part.length / part.cells}))


def _layered(case: BarCase, side: str) -> BarCase:
    """The case with a layer at this end."""
    if case.side(side).layer:
        return case
    layer = MatchedLayer(type="matched_layer", nodes=max(4, 2 * case.method.horizon_beyond))
    return replace(case, boundary={**case.boundary, side: layer})


def _pushes(scene: BarScene) -> dict[str, dict[bool, tuple[np.ndarray, np.ndarray]]]:
    """By wave in use the forces (n,) N of its value 1, and separately the motions (n,) m/s that it prescribes.

    Signals of types from other packages that are not the velocity of a wave have the name "".
    """
    supports, waves = scene.supports, scene.case.wave
    found: dict[str, dict[bool, tuple[np.ndarray, np.ndarray]]] = {}
    for row, drive, number in zip(supports.drive_row, supports.drive, supports.drive_signal, strict=True):
        name = next((name for name, wave in waves.items() if wave.velocity == supports.signals[number]), "")
        prescribed = bool(supports.prescribed[row])
        push = found.setdefault(name, {}).setdefault(prescribed, (np.zeros(scene.count), np.zeros(scene.count)))
        push[prescribed][supports.node[row]] += drive
    return found


def _signal(case: BarCase, name: str, step: float, ahead: float) -> np.ndarray:
    """Values (k,) of a wave at whole steps plus `ahead` s, from its start until it is over or the run is."""
    wave = case.wave[name]
    first = step * math.floor(min(wave.start, case.run.duration) / step)
    count = min(math.ceil((min(wave.duration(), case.run.duration) - first) / step), LONG) + 1
    return np.asarray(wave.velocity(first + ahead + step * np.arange(count)))


def _largest(motions: list[np.ndarray], signals: list[np.ndarray], last: int) -> float:
    """Largest velocity (mean of two half steps) up to a step under the sum of signals (k,).

    motions : for each signal the velocities (s, n) under a value of 1 in one step.
    """
    from scipy.fft import next_fast_len

    samples = next_fast_len(len(motions[0]) + len(signals[0]), real=True)
    mean = 0.5 * (1.0 + np.exp(-2j * np.pi * np.arange(samples // 2 + 1) / samples))
    spectra = [mean * np.fft.rfft(signal, samples) for signal in signals]
    most, at_once = 0.0, max(1, SAMPLES // samples)
    for k in range(0, motions[0].shape[1], at_once):
        pairs = zip(motions, spectra, strict=True)
        moved = sum(np.fft.rfft(motion[:, k : k + at_once].T, samples) * spectrum for motion, spectrum in pairs)
        most = max(most, float(np.abs(np.fft.irfft(moved, samples)[:, :last]).max()))
    return most
