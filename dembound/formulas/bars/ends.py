"""Exact reflection by absorbing ends of a bar, also by matched layers, for the spectrum of a wave."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.lib.stride_tricks import as_strided

from dembound.bar.layers import EndLayer
from dembound.bar.scene import BarScene, build_bar
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


class LinearSteps:
    """A bar with its bonds at the start, and layers beyond its ends, in steps of Δt (s).

    Attributes
    ----------
    first : number of the bar's first node among all, which are numbered from left to right. count : of the bar's nodes.
    """

    def __init__(self, scene: BarScene, layers: Mapping[str, EndLayer], step: float) -> None:
        bonds = scene.case.method.begin(scene.rod)
        left, right = (layers[side].layer.nodes if side in layers else 0 for side in ("left", "right"))
        self.first, self.count, self._step = left, scene.count, step
        nodes = left + scene.count + right
        own = slice(left, left + scene.count)
        reach = max([1, bonds.horizon, *(len(each.inner) for each in layers.values())])
        self._gain, self._bond_keep = np.zeros((reach, nodes)), np.ones((reach, nodes))
        self._gain[: bonds.horizon, own] = step * bonds.bond
        self._gain[0, left : left + scene.count - 1] += step * bonds.spring
        mass, damping, self._ground, decay = np.ones(nodes), np.zeros(nodes), np.zeros(nodes), np.zeros(nodes)
        mass[own], damping[own] = scene.mass, scene.rod.drag_rate * scene.mass
        supports = scene.supports
        along = supports.component == 0
        held = left + supports.node[along]
        damping[held], self._ground[held] = supports.damping[along], supports.stiffness[along]
        for side, layer in layers.items():
            end, outwards = (left, -1) if side == "left" else (left + scene.count - 1, 1)
            self._lay(layer, end + outwards * (np.arange(layer.count) - (len(layer.inner) - 1)), outwards)
            beyond = end + outwards * np.arange(1, layer.layer.nodes + 1)
            mass[beyond], damping[beyond] = layer.mass, layer.mass * layer.drag_rate
            decay[beyond] = layer.node_rates[len(layer.inner) :]
            self._ground[beyond] = layer.ground[len(layer.inner) :]
        half = 0.5 * step
        lost, slowed = half * decay, half * damping
        moves = np.ones(nodes)
        moves[held[supports.prescribed[along]]] = 0.0
        self._keep = moves * (1.0 - lost) * (mass - slowed) / ((1.0 + lost) * (mass + slowed))
        self._mobility = moves * step / ((1.0 + lost) * (mass + slowed))

    def _lay(self, layer: EndLayer, place: np.ndarray, outwards: int) -> None:
        """Add the bonds of a layer; place : the numbers of its nodes and of the bar nodes that it is bonded to."""
        half = 0.5 * self._step
        for row, (stiffness, rate) in enumerate(zip(layer.bonds, layer.bond_rates, strict=True)):
            begins = np.flatnonzero(stiffness > 0.0)
            here = place[begins] if outwards > 0 else place[begins + row + 1]
            self._gain[row, here] += self._step * stiffness[begins] / (1.0 + half * rate[begins])
            self._bond_keep[row, here] = (1.0 - half * rate[begins]) / (1.0 + half * rate[begins])

    def after(self, force: np.ndarray, motion: np.ndarray, steps: int) -> np.ndarray:
        """Velocities (steps, n) m/s of the bar's nodes after forces (n,) N, and motions (n,) m/s, of the first step.

        motion : of nodes whose motion is prescribed, 0 for others.
        """
        reach, nodes = self._gain.shape
        own = slice(self.first, self.first + self.count)
        padded, pulled = np.zeros(nodes + reach), np.zeros((reach, nodes + reach))
        v, u, f = padded[:nodes], np.zeros(nodes), pulled[:, reach:]
        # row p − 1 of `ahead` has v at i + p, of `behind` the force of the bond that begins at i − p
        ahead = as_strided(padded[1:], (reach, nodes), (padded.itemsize, padded.itemsize), writeable=False)
        row, column = pulled.strides
        behind = as_strided(pulled[:, reach - 1 :], (reach, nodes), (row - column, column), writeable=False)
        found = np.empty((steps, self.count))
        for number in range(steps):
            f *= self._bond_keep
            f += self._gain * (ahead - v)
            pull = f.sum(axis=0) - behind.sum(axis=0) - self._ground * u
            if number == 0:
                pull[own] += force
            v *= self._keep
            v += self._mobility * pull
            if number == 0:
                v[own] += motion
            u += self._step * v
            found[number] = v[own]
        return found


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
