"""Errors of the motion at places in a body by its continuum, RMS over RMS: central values by formula.

Five parts, of which the first two depend on the place:

- *elements* return a wave of the frequency f in full from f_p on, whose slowest waves have `PASSED` nodes in their
  length, and (f/f_p)^`STEEP` of it below;
- *ties* return (kD)² of a wave at normal incidence (`lattice_errors`), 1/cos θ as much at an angle. The returned wave
  has spread over a longer way than the motion it is compared with, once over every side;
  on a free surface there is `SURFACE` times as much of both beside a load on it;
- *layers* return `KEPT` of R0, and have an error of their own for motion that varies over no less than the length of
  the ground within them, such as the displacement that stays after a pulse;
- the *fields* of forces and holes beside elements and ties (`near_field`);
- *random bricks* beyond the disks would scatter waves, `BRICKS` k²LD with the length L of a brick.

Random packings scatter waves, a uniform continuum does not. Of waves that enter through a continuum holes scatter a
part, and only that part leaves again; the displacement left behind belongs to the waves, and causes no error of layers.
All this is measured on 60 scenes (benchmarks/continuum_errors.py).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from dembound.boundaries.edge import normal_axis
from dembound.continuum import sizing
from dembound.continuum.medium import Medium
from dembound.continuum.sizing import Signal
from dembound.disks.scene import DiskScene
from dembound.disks.sources import place_of
from dembound.disks.surroundings.continuum import Surroundings
from dembound.disks.surroundings.near_fields import near_fields, signals_of
from dembound.disks.surroundings.settings import ROUNDING
from dembound.formulas.cause import CONTINUUM, MOTIONS, Cause

PASSED, STEEP, RETURNED = 4.5, 8.0, 0.5
"""Nodes in the length of the shortest wave that elements pass on, the power of f above which they return less, and the
part of what they return that reaches a place."""

TIES = 0.35
"""Part of what ties return that reaches a place, beside a source as far away as its image in one side."""

FLATTEST = 0.15
"""Least cosine of the angle at which waves meet a side that counts."""

SURFACE, SHALLOW = 1.6, 0.125
"""Factor of errors by elements, ties and bricks on a free surface beside a load on it, where Rayleigh waves run,
which are slower and have more of the high frequencies; and depth over the mean length of waves down to which it
applies."""

KEPT = 0.45
"""Part of R0 that layers return in all, as waves reach them at all angles."""

LAYERS, STEEPEST = 0.4, 1e-4
"""Part of `sizing.LAYER_ERRORS`, which are bounds, that layers have with this R0; it grows as the square of log R0."""

SCATTERED = 0.5
"""Part of waves that enter through a continuum that leaves through it again."""

BRICKS = 0.06
"""Waves that random bricks would scatter to a place if they went on beyond the disks, over k²LD (`unevenness`). The
largest true errors of velocities and displacements in 25 boxes were 0.3 to 2.4 times this with all other parts,
most of which were small: forces in the ground and on it, blasts, a tunnel under waves; patterns B and C, 15
seeds, bricks of 8 to 16 D. Under an oblique wave velocities beside a pipe had 5 times as much."""

UNEVEN = 0.002
"""Error of displacements round a load in a random packing, whose stiffness varies from place to place."""

CONTINUUM_FACTOR = 2.2
"""95 % of the true errors are at most this factor times the computed ones (benchmarks/continuum_errors.py): 2.0
times for 455 rows with 0.01 % and more, 2.1 times for the 296 with 0.1 % and more. The largest are 3.4 times as
large, beside a hole in pattern C, else 2.6. Errors of displacements below 0.01 % under waves are overestimated,
up to a hundred times."""


def causes_of_continuum(scene: DiskScene, places: Mapping[str, np.ndarray]) -> Iterator[Cause]:
    """Errors of the continuum beyond sides, at places (2,) m of monitors."""
    if scene.outside is None:
        return
    if (sizes := expected_errors(scene, places)) is None:
        reason = "its elements are judged by the highest frequency of waves, and a wave that jumps has none"
        if scene.outside.body.is_stretched_along:
            reason = "its layers stretch both axes, as its ground is strongly anisotropic, and return a part of motion"
        yield Cause.unknown(CONTINUUM, reason)
        return
    parts = {name: dict(zip(MOTIONS, each, strict=True)) for name, each in sizes.items()}
    words = "by the formulas of its elements, layers and ties"
    yield Cause(CONTINUUM, words, parts, factor=CONTINUUM_FACTOR)
    if _contacts_open(scene):
        reason = "open contacts make disks softer than it, whose stiffness is that of closed ones"
        yield Cause.unknown(f"{CONTINUUM} beside contacts", reason)


def _contacts_open(scene: DiskScene) -> bool:
    """Whether contacts beside a continuum may be open, at rest or under a wave.

    Without stress disks just touch. A static stage leaves the contacts of a lattice closed; in a random packing it
    opens some: in pattern B 10 % under a locked-in stress that has relaxed upwards, where waves 40 m long in a box
    of 15 m have an error of 13 %, but 1 % with contacts closed for good, or with a tenth of their stiffness; 1.9 %
    under weight, and 67 % without stress.
    """
    case = scene.case
    at_rest = case.static is not None and case.packing.is_lattice
    return scene.has_history and scene.ground.moduli.emod > 0.0 and not at_rest


def expected_errors(scene: DiskScene, places: Mapping[str, np.ndarray]) -> dict[str, tuple[float, float]] | None:
    """Errors of velocities and of displacements by a continuum, RMS over RMS, at places (2,) m by name.

    None without a continuum, for waves that jump, and for layers stretched along, which return an unknown part.
    Displacements have longer waves than velocities, of which elements and ties return less; waves longer than the run
    count as one length.
    """
    outside, signals = scene.outside, signals_of(scene.case)
    if outside is None or not signals or any(map(sizing.jumps, signals)) or outside.body.is_stretched_along:
        return None
    lowests = (math.inf, 1.0 / scene.case.run.duration)
    parts = [_parts(scene, outside, signals, lowest) for lowest in lowests]
    if scene.case.load and not scene.case.packing.is_lattice:
        parts[1] = parts[1]._replace(alike=math.hypot(parts[1].alike, UNEVEN))
    bricks = [BRICKS * unevenness(scene, signals, lowest) for lowest in lowests]
    leaving, depth = 1.0 if scene.case.load else SCATTERED, _shallow(outside, signals)
    fields, found = [_near_errors(scene, outside, places, lowest) for lowest in lowests], {}
    for name, place in places.items():
        source = _source(scene, place)
        spread = 1.0 if source is None else _spread(scene, outside, source, place)
        more = SURFACE if source is not None and _both_shallow(scene, outside, depth, source, place) else 1.0
        returned = (math.hypot(each.alike, more * each.elements, more * spread * each.ties) for each in parts)
        velocity, displacement = (
            math.hypot(leaving * part, more * uneven, near[name])
            for part, uneven, near in zip(returned, bricks, fields, strict=True)
        )
        found[name] = velocity, displacement
    return found


def largest_element(outside: Surroundings) -> float:
    """The largest side of the elements of a continuum, m, without those that absorb beside layers."""
    return max(side for _, side in elements_by_layer(outside))


def elements_by_layer(outside: Surroundings) -> list[tuple[Medium, float]]:
    """The layers that a continuum has elements in, from the bottom up, each with the largest side (m) of these.

    Wider ones that absorb beside layers are left out.
    """
    body, mesh = outside.body, outside.body.mesh
    sizes, layer = mesh.element_sizes.max(axis=1), body.layer
    if outside.settings.beside:
        sizes = np.where(mesh.absorbs[:, 0], 0.0, sizes)
    each = [(medium, sizes[layer == number]) for number, medium in enumerate(body.ground.media)]
    return [(medium, float(own.max())) for medium, own in each if own.any()]


def coarsest(outside: Surroundings) -> tuple[Medium, float]:
    """The layer with the fewest elements to a wavelength, and the largest side (m) of these."""
    return min(elements_by_layer(outside), key=lambda each: sizing.slowest(each[0]) / each[1])


def near_error(scene: DiskScene, outside: Surroundings) -> float:
    """Error of elements beside forces and holes, where it is largest."""
    fields = near_fields(scene.case, outside.body.medium, outside.box, outside.sides)
    return max((field.error(outside.settings.order, largest_element(outside)) for field in fields), default=0.0)


def _near_errors(
    scene: DiskScene, outside: Surroundings, places: Mapping[str, np.ndarray], lowest: float
) -> dict[str, float]:
    """Errors of elements and ties beside forces and holes at places (2,) m by name; lowest : see `sizing.energies`."""
    order, side, diameter = outside.settings.order, largest_element(outside), scene.ground.brick.mean_diameter
    fields = near_fields(scene.case, outside.body.medium, outside.box, outside.sides, lowest)
    largest = [(field, math.hypot(field.error(order, side), field.of_ties(diameter))) for field in fields]
    return {
        name: max((field.part_at(place) * error for field, error in largest), default=0.0)
        for name, place in places.items()
    }


class _Parts(NamedTuple):
    """Errors by elements, by ties beside a single side, and those that are the same at all places."""

    elements: float
    ties: float
    alike: float


def _parts(scene: DiskScene, outside: Surroundings, signals: Sequence[Signal], lowest: float) -> _Parts:
    """The parts of the error; lowest : Hz, see `sizing.energies`."""
    settings, mesh, (medium, side) = outside.settings, outside.body.mesh, coarsest(outside)
    passed = settings.order * sizing.slowest(medium) / (PASSED * side)
    long = sizing.fastest(outside.body.medium) / (2.0 * math.pi * mesh.inner)
    elements, lasting = 0.0, 0.0
    for signal in signals:
        frequency, energy = sizing.energies(signal, lowest)
        returned = np.minimum(1.0, (frequency / passed) ** STEEP)
        elements = max(elements, math.sqrt(float(energy @ returned**2 / energy.sum())))
        lasting = max(lasting, math.sqrt(float(energy[frequency < long].sum() / energy.sum())))
    reflection = settings.absorption.reflection
    steep = (math.log(reflection) / math.log(STEEPEST)) ** 2
    layers = LAYERS * sizing.layer_error(settings.order, settings.layers) * steep * lasting
    alike = KEPT * reflection
    alike = math.hypot(alike, layers) if scene.case.load else alike * (1.0 - lasting**2)
    return _Parts(RETURNED * elements, TIES * lattice_errors(scene, signals, lowest)[0], alike)


def _source(scene: DiskScene, place: np.ndarray) -> np.ndarray | None:
    """The middle (2,) m of the load that is nearest to a place; None where waves come from far away, or everywhere."""
    boxes = [place_of(scene.case, load) for load in scene.case.load if load.wave is not None]
    middles = [0.5 * np.array([x0 + x1, y0 + y1]) for x0, y0, x1, y1 in boxes if math.isfinite(x0)]
    return min(middles, key=lambda middle: float(np.hypot(*(place - middle))), default=None)


def _spread(scene: DiskScene, outside: Surroundings, source: np.ndarray, place: np.ndarray) -> float:
    """Waves returned by ties at a place over those that a single side returns to a source beside it.

    A wave spreads as 1/√(way), so that with the way r from the source and that over its image in a side, r′, it is
    √(r/r′)/cos θ from each side; contributions of several sides add as squares.
    """
    diameter = scene.ground.brick.mean_diameter
    way = max(float(np.hypot(*(place - source))), diameter)
    planes = dict(zip(("left", "bottom", "right", "top"), outside.box, strict=True))
    total = 0.0
    for side in outside.sides:
        axis = normal_axis(side)
        ray = place - source
        ray[axis] = 2.0 * planes[side] - source[axis] - place[axis]
        longer = max(float(np.hypot(*ray)), diameter)  # a place beyond a side may be where the image is
        total += way / longer / max(abs(float(ray[axis])) / longer, FLATTEST) ** 2
    return math.sqrt(total)


def _shallow(outside: Surroundings, signals: Sequence[Signal]) -> float:
    """Depth (m) down to which places count as on the surface."""
    spectra = [sizing.energies(signal) for signal in signals]
    mean = min(float(frequency @ energy / energy.sum()) for frequency, energy in spectra)
    return SHALLOW * sizing.slowest(outside.body.medium) / mean


def _both_shallow(scene: DiskScene, outside: Surroundings, depth: float, source: np.ndarray, place: np.ndarray) -> bool:
    """Whether a source and a place are on a free surface, above a depth (m) below it."""
    surface = scene.case.size[1]
    is_free = "top" not in outside.sides or outside.box[3] < (1.0 - ROUNDING) * surface
    return is_free and bool(min(source[1], place[1]) > surface - depth)


def unevenness(scene: DiskScene, signals: Sequence[Signal], lowest: float = math.inf) -> float:
    """k²LD, RMS over the energy of velocities, to which scattering by uneven bricks is proportional; 0 on lattices.

    k : wave number of the slowest waves, none shorter than a brick; L, D : length of a random brick and mean diameter
    of its disks. The largest over signals. lowest : frequency (Hz) from which on the energy is that of displacements,
    see `sizing.energies`.
    """
    if scene.case.packing.is_lattice:
        return 0.0
    assert scene.outside is not None
    speed, brick = sizing.slowest(scene.outside.body.medium), scene.ground.brick
    length, found = float(max(brick.size)), [0.0]
    for signal in signals:
        frequency, energy = sizing.energies(signal, lowest)
        k = 2.0 * math.pi * np.minimum(frequency / speed, 1.0 / length)
        squares = (k**2 * length * brick.mean_diameter) ** 2
        found.append(math.sqrt(float(energy @ squares / energy.sum())))
    return max(found)


def lattice_errors(scene: DiskScene, signals: Sequence[Signal], lowest: float = math.inf) -> tuple[float, float]:
    """Error of velocities by reflection of ties, and by the lag of waves over the scene's longer side L, RMS over RMS.

    Half of a lattice's bond has the impedance ρc/cos(kD/2), so that a continuum beyond it returns (kD)²/16; the ties'
    dashpots, `damping` times ρc_pD, add (kD)²·(damping/8) c/c_p. Waves on the lattice lag by the phase kL(kD)²/24. For
    the slowest waves, of the speed c; the largest over signals. lowest : frequency (Hz) from which on errors are those
    of displacements, see `sizing.energies`.
    """
    outside = scene.outside
    assert outside is not None
    speed = sizing.slowest(outside.body.medium)
    diameter, length = scene.ground.brick.mean_diameter, max(scene.case.size)
    returned = 1.0 / 16.0 + 0.25 * outside.wall.lag * speed / diameter
    found = []
    for signal in signals:
        frequency, energy = sizing.energies(signal, lowest)
        k = 2.0 * math.pi * frequency / speed
        square = (k * diameter) ** 2
        errors = [returned * square, k * length * square / 24.0]
        found.append([math.sqrt(float(np.sum(energy * np.minimum(e, 1.0) ** 2) / energy.sum())) for e in errors])
    ties, across = np.max(found, axis=0).tolist()
    return ties, across
