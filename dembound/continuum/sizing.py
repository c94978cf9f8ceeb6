"""The settings of a continuum that the waves of a case need for a given error, and the numbers of its mesh."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from dembound.continuum.medium import Ground, layered
from dembound.continuum.mesh import Mesh
from dembound.waves.wave import Wave

SHARE = 1e-3
"""Share of the energy of a wave's velocity above its cut-off frequency."""

LEAST_SPACING = 1.25
"""Smallest mean spacing of nodes in diameters: finer elements gain nothing, as the disks themselves disperse."""

LEAST_LATTICE, LEAST_RANDOM = 0.31, 0.7
"""Smallest side of elements over their order squared, in diameters, of a lattice and of random packings.

Nodes at the ends of an element of high order are close together and light, and with random packings the ties also act
on the gradients there: steps are 15 to 45 % shorter with elements of this side than with large ones, with sides 0.6
times as long by a half, and in random packings to a quarter.
"""

NODES = {3: 7.0, 4: 6.0, 5: 6.0, 6: 6.0}
"""By order: nodes per wavelength of the shortest S wave that elements still transmit.

Elements reflect shorter waves, so the error of a pulse is the root of the share of its energy in them. From errors of
cosine pulses between 17 % and 0.02 % follow 3 to 5 nodes with any order. Ricker wavelets, which have hardly any shorter
waves, need as many as are given here for an error of 0.1 %."""

WITHIN = 0.4
"""Part of the depth of layers that is added to the distance from the source where waves run along the layers.

Measured with a tunnel (radius 20 m, ν = 0) 75, 150 and 225 m below the surface, layers that begin 10 to 90 m beside a
box of 60 m round it, and pulses of 0.1, 0.25 and 0.5 s, both P and S: errors of 13 to 0.1 % are 0.4 to 2.4 times those
of `grazing_error`."""

FLATTEST = 0.9
"""Largest required cosine of the angle of incidence: a distance of two depths to the side."""

LAYER_ERRORS = {
    3: {2: 4.3e-2, 3: 7e-3, 4: 1.4e-3, 5: 4e-4, 6: 2e-4},
    4: {2: 7e-3, 3: 4e-4, 4: 9e-5, 6: 3e-5},
    5: {2: 8e-4, 3: 6e-5, 4: 2e-5},
    6: {2: 1e-4, 3: 5e-5},
}
"""By order and number of absorbing elements: error of displacements, which is larger than that of velocities.

The error does not depend on the length of the waves: layers of 0.2 to 3 wavelengths of S waves at the cut-off frequency
have the same errors. R0 is 1e-4, or 1e-5 if it gives the smaller error."""

LASTING = 2e-5
"""Missing displacement at a time t under a force that stays, over (α0 t)².

The shift α0 of the layers' poles makes them reflect frequencies below α0. Measured to 12 s with L_inner from 80 m to
360 m and α0 of 0.1 and 0.3 times c_p/(2 L_inner), α0 t = 3 to 22, compared with a margin of 480 m: 0.02 % to 1.0 %.
Three elements of order 4 add up to 0.1 %, and more with a smaller α0; four add nothing to that."""

POINTS_IN_TIME = 64
"""Samples of a wave in a period of its highest frequency."""

LONGER = 8
"""Length over which spectra are taken, over the length of the wave."""


class Signal(NamedTuple):
    """A source signal of waves: the velocity of a side, or a force."""

    wave: Wave
    is_force: bool


def energies(signal: Signal, lowest: float = math.inf) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies (m,) Hz and the energies (m,) of velocities at them, in any unit.

    The body waves of a force in a plane medium have velocities of √ω times its spectrum. Only the rise of a wave that
    stays constant is included. lowest : frequency (Hz) above which the energies are those of displacements, which are
    (lowest/frequency)² times as large.
    """
    frequency, energy = _of_velocities(signal)
    return frequency, energy / (1.0 + (frequency / lowest) ** 2)


@lru_cache(maxsize=8)
def _of_velocities(signal: Signal) -> tuple[np.ndarray, np.ndarray]:
    """The energies of velocities, see `energies`; kept, as long records take tenths of a second."""
    wave = signal.wave
    length = (wave.peak_time() if wave.stays else wave.duration()) - wave.start
    samples = 2 ** math.ceil(math.log2(min(max(POINTS_IN_TIME * length * wave.highest_frequency(), 2**12), 2**18)))
    step = length / samples
    velocity = wave.velocity(wave.start + step * np.arange(-1, samples + 1))
    spectrum = np.abs(np.fft.rfft(np.diff(velocity), LONGER * samples)) ** 2
    frequency = np.fft.rfftfreq(LONGER * samples, step)
    change = 2.0 * np.sin(math.pi * frequency[1:] * step)  # of a step from sample to sample
    return frequency[1:], spectrum[1:] / change**2 * (frequency[1:] if signal.is_force else 1.0)


def jumps(signal: Signal) -> bool:
    """Whether a signal's wave is discontinuous."""
    return not math.isfinite(signal.wave.highest_frequency())


@lru_cache(maxsize=256)
def cutoff(signal: Signal, share: float = SHARE) -> float:
    """Frequency (Hz) above which a given share of the energy of velocities lies; infinite for a wave that jumps."""
    if jumps(signal):
        return math.inf
    frequency, energy = energies(signal)
    below = np.cumsum(energy)
    return float(frequency[min(np.searchsorted(below, (1.0 - share) * below[-1]), len(frequency) - 1)])


@lru_cache(maxsize=64)
def slowest(ground: Ground) -> float:
    """Speed (m/s) of the slowest plane waves of all directions, in the slowest of layers."""
    ways = [(math.cos(angle), math.sin(angle)) for angle in np.linspace(0.0, math.pi, 37)]
    return min(float(medium.plane_waves(way)[0][0]) for medium in layered(ground).media for way in ways)


def fastest(ground: Ground) -> float:
    """Speed (m/s) of P waves along the axis along which they are faster, in the fastest of layers."""
    return max(medium.normal_speed(axis) for medium in layered(ground).media for axis in (0, 1))


def shortest_wave(signals: Sequence[Signal], medium: Ground, share: float = SHARE) -> float:
    """Length (m) of the slowest waves at the highest of the frequencies above which signals have a share of energy."""
    return slowest(medium) / max(cutoff(signal, share) for signal in signals)


@lru_cache(maxsize=256)
def mean_frequency(signal: Signal, lowest: float = math.inf) -> float:
    """RMS frequency (Hz) of velocities, infinite for a wave that jumps.

    lowest : the result is for displacements in a run as long as 1/lowest: RMS velocity over 2π times RMS displacement.
    A force has the spectrum of `energies`.
    """
    if jumps(signal):
        return math.inf
    wave, of_velocity = signal.wave, math.isinf(lowest)
    if signal.is_force or (of_velocity and wave.stays):
        frequency, energy = energies(signal, lowest)
        return math.sqrt(float(frequency**2 @ energy / energy.sum()))
    end = wave.start + wave.duration() if of_velocity else 1.0 / lowest
    begin = min(wave.start, end)
    count = math.ceil(POINTS_IN_TIME * (end - begin) * wave.highest_frequency())
    time = np.linspace(begin, end, min(max(count, 2**10), 2**18))
    velocity, step = wave.velocity(time), time[1] - time[0]
    rate, values = (np.diff(velocity) / step, velocity) if of_velocity else (velocity, np.cumsum(velocity) * step)
    size = float(np.linalg.norm(values))
    return float(np.linalg.norm(rate)) / (2.0 * math.pi * size) if size > 0.0 else 0.0


def wave_number(signals: Sequence[Signal], medium: Ground, lowest: float = math.inf) -> float:
    """The largest RMS wave number (1/m) of the slowest waves of signals, 0 without any; lowest : see `energies`."""
    frequencies = [mean_frequency(signal, lowest) for signal in signals]
    return 2.0 * math.pi * max(frequencies, default=0.0) / slowest(medium)


def element_size(signals: Sequence[Signal], medium: Ground, order: int, accuracy: float) -> float:
    """Largest side (m) of elements that transmit all but a share accuracy² of the energy of waves."""
    return order * shortest_wave(signals, medium, accuracy**2) / NODES[order]


def least_size(order: int, diameter: float, *, is_random: bool) -> float:
    """Smallest useful side (m) of elements beside disks of this mean diameter, m; is_random : for a random packing."""
    return max(order * LEAST_SPACING, order**2 * (LEAST_RANDOM if is_random else LEAST_LATTICE)) * diameter


def layer_count(order: int, accuracy: float) -> int:
    """Number of absorbing elements behind each other for at most half of `accuracy`, or the largest measured number."""
    errors = LAYER_ERRORS[order]
    return min((count for count, error in errors.items() if error <= 0.5 * accuracy), default=max(errors))


def inner_length(time: float, speed: float, shift: float, accuracy: float) -> float:
    """Least value (m) of the larger side within the layers for which `missing` is half of `accuracy` at a time (s).

    speed : of P waves, m/s. shift : of the layers, see layer.py.
    """
    return 0.5 * shift * speed * time * math.sqrt(LASTING / (0.5 * accuracy))


def missing(time: float, speed: float, shift: float, inner: float) -> float:
    """Share of the displacement that is missing at a time (s) of a lasting force: the inverse of `inner_length`."""
    return LASTING * (0.5 * shift * speed * time / inner) ** 2


def offset(depth: float, ratio: float, reflection: float, accuracy: float) -> float:
    """Least distance sideways (m) at which layers absorb reflections of a free surface, see `grazing_error`.

    The distance counts from a hole or force at a depth (m) below the surface.
    """
    share = min(math.log(accuracy) / math.log(reflection) * ratio, FLATTEST)
    return depth * share / math.sqrt(1.0 - share**2)


def grazing_error(depth: float, ratio: float, reflection: float, beside: float) -> float:
    """Velocity error at layers at a horizontal distance `beside` (m) from a hole or force at a depth (m): cf. `offset`.

    Waves reflected by the free surface meet the layers at an angle θ with cos θ = beside/√(beside² + depth²), and S
    waves keep R0^(cos θ/ratio). ratio : of the slowest speed to the fastest.
    """
    return float(reflection ** (beside / math.hypot(beside, depth) / ratio))


def reflection(accuracy: float) -> float:
    """R0: a tenth of the accuracy, as waves lose less of their amplitude at oblique incidence.

    Displacements in the body then have an error of a twentieth of the accuracy.
    """
    return 0.1 * accuracy


def element_error(
    signals: Sequence[Signal], medium: Ground, order: int, side: float, lowest: float = math.inf
) -> float:
    """Error of velocities with elements of this side (m), for the worst signal: the inverse of `element_size`.

    lowest : frequency (Hz) above which it is the error of displacements, see `energies`.
    """
    passed = order * slowest(medium) / (NODES[order] * side)
    errors = [1.0]
    if not any(jumps(signal) for signal in signals):
        spectra = [energies(signal, lowest) for signal in signals]
        errors = [math.sqrt(float(energy[f > passed].sum() / energy.sum())) for f, energy in spectra]
    return max(errors)


def layer_error(order: int, layers: int) -> float:
    """Error of displacements with this number of absorbing elements, or with the next smaller measured number."""
    errors = LAYER_ERRORS[order]
    return errors[max(count for count in errors if count <= layers)]


@dataclass(frozen=True)
class GridSizes:
    """Numbers of the nodes and elements of a mesh, how many elements absorb, and their order."""

    nodes: int
    elements: int
    absorbing: int
    order: int

    @classmethod
    def of(cls, mesh: Mesh) -> GridSizes:
        """The numbers of a mesh, computed without its arrays, so that any number of elements is possible."""
        nodes = elements = elastic = 1
        left_out_nodes = left_out = 0 if mesh.box is None else 1
        for axis, cells in enumerate(mesh.cells):
            nodes *= mesh.order * cells + (not mesh.periodic[axis])
            elements *= cells
            elastic *= cells - sum(mesh.layer.along(axis))
            if mesh.box is not None:
                first, last = mesh.box[axis], mesh.box[2 + axis]
                left_out *= last - first
                left_out_nodes *= mesh.order * (last - first) - 1 + (first == 0) + (last == cells)
        absorbing = elements - elastic
        if mesh.levels is not None and mesh.box is not None:
            beside = mesh.box[0], mesh.cells[0] - mesh.box[2]
            for level, columns, layer in zip(mesh.levels, beside, mesh.layer.along(0), strict=True):
                above = mesh.cells[1] - level
                left_out += columns * above
                left_out_nodes += mesh.order * above * (mesh.order * columns + (columns > 0))  # with the box's side
                absorbing -= layer * above
        return cls(nodes - left_out_nodes, elements - left_out, absorbing, mesh.order)

    @classmethod
    def all_of(cls, meshes: Sequence[Mesh]) -> GridSizes:
        """The sums of the numbers of several meshes of one order."""
        each = [cls.of(mesh) for mesh in meshes]
        nodes, elements, absorbing = (
            sum(getattr(sizes, name) for sizes in each) for name in ("nodes", "elements", "absorbing")
        )
        return cls(nodes, elements, absorbing, each[0].order)

    @property
    def counts(self) -> dict[str, float]:
        """Numbers of all things that take memory, see `motion.memory.BYTES`."""
        row, rim = float(self.order + 1), 4 * self.order * self.elements
        every = {"element": self.elements, "row": row * self.elements, "point": row**2 * self.elements, "rim": rim}
        layers = {"absorbing_row": row * self.absorbing, "absorbing_point": row**2 * self.absorbing}
        return {"node": self.nodes} | every | layers
