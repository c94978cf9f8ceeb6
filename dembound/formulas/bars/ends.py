"""Exact reflection by absorbing ends of a bar, also by matched layers, for the spectrum of a wave."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from dembound.bar.layers import EndLayer
from dembound.bar.scene import BarScene, build_bar
from dembound.bar.stability import LinearSteps
from dembound.boundaries.boundary import Layer
from dembound.boundaries.matched_layer import MatchedLayer
from dembound.casefile.bar.model import BarCase

LONG = Layer(nodes=1500, power=3.0, reflection=1e-12)
"""A layer whose own reflection is negligible."""

BETWEEN = 100
"""Nodes between the layers."""

RUNS = 0.01
"""Smallest amplitude of the wave at the layer, over the motion under the force."""

WIDEST = 30
"""Longest bonds, in spacings, for which the reflection is computed; the time grows with the square."""


def returned(layer: EndLayer, frequency: float, time_step: float) -> float:
    """Velocity of the reflected wave over that of the arriving wave, at a frequency (Hz); time_step s.

    nan for frequencies at which no wave runs along the bar, and for bonds longer than `WIDEST`.
    """
    angle = math.pi * frequency * time_step
    if len(layer.inner) > WIDEST or not 0.0 < angle < 0.5 * math.pi:
        return math.nan
    long = replace(layer, layer=LONG)
    echo, endless = (_response(long, right, angle, time_step) for right in (layer, long))
    source, seen, end = LONG.nodes + BETWEEN // 2, LONG.nodes + 3 * BETWEEN // 4, LONG.nodes + BETWEEN
    if abs(endless[end]) < RUNS * abs(endless[source]):
        return math.nan
    lost = abs(endless[end] / endless[seen])  # by attenuation, on the way to the end, and on the way back
    return float(abs(echo[seen] / endless[seen] - 1.0) / lost**2)


def _response(left: EndLayer, right: EndLayer, angle: float, time_step: float) -> np.ndarray:
    """Complex velocities of all nodes from the left layer's outer end on, under a force halfway between the layers."""
    from scipy.linalg import solve_banded

    reach, nodes = len(left.inner), left.layer.nodes + BETWEEN + right.layer.nodes + 1
    change, mean = 2j / time_step * np.sin(angle), np.cos(angle)
    drag, place = left.drag_rate, np.arange(nodes, dtype=float)
    bands = np.zeros((2 * reach + 1, nodes), dtype=complex)
    rates = _rates(left, right, place)
    bands[reach] = left.mass * (change + (rates + drag) * mean + rates * drag * mean**2 / change)
    for p, stiffness in enumerate(left.stiffness, start=1):
        bond = stiffness / (change + _rates(left, right, place[:-p] + 0.5 * p) * mean)
        bands[reach, :-p] += bond
        bands[reach, p:] += bond
        bands[reach - p, p:] -= bond
        bands[reach + p, :-p] -= bond
    force = np.zeros(nodes, dtype=complex)
    force[left.layer.nodes + BETWEEN // 2] = 1.0
    return solve_banded((reach, reach), bands, force)


def _rates(left: EndLayer, right: EndLayer, place: np.ndarray) -> np.ndarray:
    """Rates of decay (1/s) at places from the left layer's outer end, in spacings."""
    first, last = left.layer.nodes, left.layer.nodes + BETWEEN
    of_left = left.layer.rates(first - place, left.spacing, left.speed)
    return of_left + right.layer.rates(place - last, right.spacing, right.speed)


CELLS = 128
"""Cells of a bar that represents a longer one; more if a load is on more than half as many nodes."""

LONGEST = 1000
"""Nodes of a layer up to which this is computed."""

LEAST = 0.05
"""Least Courant number that is stepped: with 0.005 to 0.05 the reflections of 20-cell pulses by layers and dashpots
differ by at most 0.4 %, for they approach their limit with its square."""

WORK, KEPT = 6e7, 4e6
"""Most bonds times steps in all motions, some 0.5 s, and values that are convolved in all, as long."""

BEYOND = 0.6
"""Cells of the bar that goes on, over the cells that a wave passes in the time for which it is followed."""

FADED = 0.25
"""Last part of this time in which remaining motion is faded out if the run goes on: a sudden end would be a force."""

FEWEST, FINER = 9, 16
"""Fewest nodes, of which both ends are two, at which a long wave is convolved; values that are averaged in a step."""

SAMPLES = 2**19
"""Values that are convolved at once."""

ROUNDING = 1e-12
"""Bound of the rounding errors of a run of some 10⁴ steps, over its largest motion."""


@dataclass(frozen=True)
class Returned:
    """The reflection of an end.

    shares : by wave the largest reflected motion over the largest motion of the wave, including `ROUNDING`. within :
    time (s) after the wave for which it was followed, infinite for the whole run. part : share of the bar's nodes at
    which it was sought; below 1 for waves of many steps. unknown : waves of too many steps, or shorter than some.
    """

    shares: dict[str, float]
    within: float = math.inf
    part: float = 1.0
    unknown: tuple[str, ...] = ()


def returned_of_waves(scene: BarScene, side: str, time_step: float) -> Returned:
    """The reflection of every wave in use by an end; empty where it is not computed.

    Nothing is computed for ends that do not absorb, where a wave enters through dashpots, and for very long bonds and
    layers.
    """
    case = scene.case
    longest = max([0, *(each.layer.nodes for each in scene.layers.values())])
    if not _absorbs(scene, side) or case.method.largest_horizon > WIDEST or longest > LONGEST:
        return Returned({})
    own, part = scene, scene.rod.end(side)
    given, time_step = time_step, max(time_step, LEAST * part.spacing / part.speed)
    courant, reach = time_step * part.speed / part.spacing, max(1, case.method.largest_horizon)
    known = {name: pushes for name, pushes in _pushes(scene).items() if name}
    motions = sum(map(len, known.values())) * sum(_absorbs(scene, each) for each in scene.edges)
    work, kept = 0.5 * WORK / max(1, motions), KEPT / max(1, motions)
    run = steps = whole = math.ceil(case.run.duration / time_step) + 1
    opens = any(given.interface == "contact" for given in case.bar.range)
    if opens or run * (BEYOND * courant * run + own.count) * reach > work or run * own.count > kept:
        own = build_bar(_short(case, side))
        ways = case.run.duration / case.bar.travel_time
        whole = min(run, math.ceil((ways * own.count + 4.0 * longest) / courant) + 1)
        steps = int(min(whole, math.sqrt(work / (BEYOND * courant * reach)), kept / own.count))
    endless = build_bar(_layered(own.case, side))
    beyond = endless.layers[side].endless(BEYOND * steps * time_step)
    bars = LinearSteps(own, own.layers, time_step), LinearSteps(endless, {**own.layers, side: beyond}, time_step)
    shares, fewest, unknown = {}, own.count, []
    for name, pushes in _pushes(own).items():
        if name not in known:
            continue
        count, least = _length(own.case, name, time_step), 4.0 * time_step * (time_step > given)
        if FEWEST * (steps + count) > 2.0 * kept or case.wave[name].duration() - case.wave[name].start < least:
            unknown.append(name)
            continue
        spread = math.ceil(own.count * (steps + count) / (2.0 * kept))
        some = np.unique(np.append(np.arange(0, own.count, spread), own.count - 1))
        fewest = min(fewest, len(some))
        both = [[bar.after(*push, steps)[:, some] for bar in bars] for push in pushes.values()]
        finer = min(FINER, round(time_step / given))
        signals = [_signal(own.case, name, time_step, 0.5 * time_step * each, count, finer) for each in pushes]
        if steps < run:
            past = np.clip((np.arange(steps) / steps - 1.0) / FADED + 1.0, 0.0, 1.0)
            both = [[np.cos(0.5 * np.pi * past)[:, None] ** 2 * each for each in pair] for pair in both]
        last = min(run, count + steps)
        arrived = _largest([there for _, there in both], signals, last)
        returned = _largest([here - there for here, there in both], signals, last)
        if arrived > 0.0:
            shares[name] = returned / arrived + ROUNDING
    within = math.inf if steps == whole else case.run.duration * steps / whole
    return Returned(shares, within, fewest / own.count, tuple(unknown))


def _absorbs(scene: BarScene, side: str) -> bool:
    """Whether an end is to absorb waves, without a wave that enters through dashpots."""
    end = scene.case.side(side)
    return end.is_artificial and 0 not in end.prescribed(0) and (side in scene.layers or not end.waves)


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


def _first(case: BarCase, name: str, step: float) -> float:
    """Time (s) of the last whole step before a wave starts."""
    return step * math.floor(min(case.wave[name].start, case.run.duration) / step)


def _length(case: BarCase, name: str, step: float) -> int:
    """Number of steps from a wave's start until it is over or the run is."""
    until = min(case.wave[name].duration(), case.run.duration)
    return math.ceil((until - _first(case, name, step)) / step) + 1


def _signal(case: BarCase, name: str, step: float, ahead: float, count: int, finer: int) -> np.ndarray:
    """Values (count,) of a wave at whole steps plus `ahead` s, from its start; means of `finer` values round them."""
    parts = step * ((np.arange(finer) + 0.5) / finer - 0.5)
    times = _first(case, name, step) + ahead + step * np.arange(count)
    return sum((np.asarray(case.wave[name].velocity(times + part)) for part in parts), np.zeros(count)) / finer


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
