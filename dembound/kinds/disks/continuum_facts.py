"""The continuum round a body in words: its elements, the errors to expect, its share of the cost, and warnings.

No setting reduces errors by the disks themselves: dispersion, and copies of bricks.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import product

import numpy as np

from dembound.boundaries.edge import normal_axis
from dembound.casefile.disks.layer import OutsideTable
from dembound.casefile.messages import counted
from dembound.continuum import sizing
from dembound.continuum.layer import RETURNED
from dembound.continuum.sizing import Signal
from dembound.disks import step_cost
from dembound.disks.material import packing_waves
from dembound.disks.scene import DiskScene
from dembound.disks.surroundings.continuum import Surroundings
from dembound.disks.surroundings.near_fields import lasting_time, signals_of
from dembound.disks.surroundings.settings import ROUNDING, buried, least_element, margin_below_surface
from dembound.formulas.disks.continuum import coarsest, elements_by_layer, largest_element, lattice_errors, near_error
from dembound.words import Entries, percent, with_unit

LEAST_SHOWN = 1e-5
"""Share of the velocity reflected by copies below which it is not printed."""


def packing_facts(scene: DiskScene, signals: Sequence[Signal]) -> Entries:
    """Facts about a scene with a continuum and signals that do not jump."""
    yield "dispersion of the disks", _dispersion(scene, signals)
    if copies := _copies(scene, signals):
        yield "copies of the brick", copies


def _dispersion(scene: DiskScene, signals: Sequence[Signal]) -> str:
    """Text on the error by dispersion of the lattice."""
    accuracy = scene.case.outside.accuracy
    ties, across = lattice_errors(scene, signals)
    more = f"; more than outside.accuracy = {percent(accuracy)}" if max(ties, across) > accuracy else ""
    return (
        f"ties return up to {percent(ties)} of the velocity of what meets them, and waves change by {percent(across)} "
        f"over the scene's length{more}"
    )


def _copies(scene: DiskScene, signals: Sequence[Signal]) -> str:
    """Text on waves reflected by copies of a random brick; empty if negligible."""
    case, ground = scene.case, scene.ground
    if case.packing.is_lattice:
        return ""
    if len(ground.brick.radii) > packing_waves.MOST_DISKS:
        return f"send back short waves, not computed for bricks of more than {packing_waves.MOST_DISKS:,} disks"
    axes = sorted({normal_axis(side) for side in case.driving})
    found = packing_waves.sent_back(ground, signals, case.size, axes if axes and not case.load else (0, 1))
    share, accuracy = found.share, case.outside.accuracy
    beyond = f"waves above {with_unit(found.highest, 'Hz')}, which have {percent(found.above)} of the energy"
    if share < LEAST_SHOWN:
        return f"send back {beyond}, by a part that is not computed" if found.above > 0.0 else ""
    more = f"; more than outside.accuracy = {percent(accuracy)}, shorter bricks send back less"
    return (
        f"send back up to {percent(share)} of the velocity over the ground's length, which a continuum does not"
        f"{f', and a part that is not computed of {beyond}' if found.above > 0.0 else ''}"
        f"{more if share > accuracy else ''}"
    )


SHOWN = 5e-4
"""Depth (m) of a skin below which it is printed as zero."""

QUIET_STEPS, FLAT = 10_000, 31.0
"""Steps up to which noise has not been seen to grow, and width over height up to which it was seen to decay, with ν =
0.25 and 0.4 and elements as wide as high, see `Settings.sides`."""

LARGE = 0.01
"""Error of the smallest useful elements, above which there is a warning."""

LEEWAY = 1.05
"""Factor by which an error may exceed the accuracy without a warning: spectra are sums over steps of the frequency."""

LOW = (0.0, 2.0, 3.0, 4.0), (0.0, 0.82, 0.97, 1.0)
"""Heights of rows of elements in the fastest layer, in diameters, and time steps with these over those without.

Measured with a layer of 2 to 10 D between slower ones and between equal ones, disks of pattern A; 3 D in B: 0.95."""

STRETCHED = f"up to about {percent(RETURNED)}"
"""What layers stretched along return, in words."""

ANGLES = (0.0, 45.0, 60.0)
"""Angles of incidence (degrees) for which reflections are printed."""


def continuum_facts(scene: DiskScene) -> Entries:
    """Facts about the continuum of a scene that has one."""
    outside = scene.outside
    assert outside is not None
    signals = signals_of(scene.case)
    yield "continuum", _elements(outside)
    if signals:
        yield "continuum waves", _waves(scene, outside, signals)
    if outside.levels:
        yield "ground beyond", _levels(outside)
    if any(abs(depth) >= SHOWN for depth in outside.skins.values()):
        yield (
            "its free edges",
            ", ".join(f"{depth:.3f} m inside the {side} side" for side, depth in outside.skins.items()),
        )
    for foot in scene.feet[:1]:
        column = "column" if len(scene.feet) == 1 else "column of each side"
        yield f"below the {column}", f"{_elements(foot)}; through it waves enter and leave"
    yield "absorbing layers", _layers(outside, signals)
    yield "continuum cost", _cost(scene)
    if signals and not any(sizing.jumps(signal) for signal in signals):
        yield from packing_facts(scene, signals)


def _elements(outside: Surroundings) -> str:
    """Numbers of nodes, elements and ties in words."""
    mesh = outside.body.mesh
    absorbing = 100.0 * float(mesh.absorbs.any(axis=1).mean())
    width, height = (_from_to(sizes) for sizes in mesh.element_sizes.T)
    return (
        f"{outside.count:,} nodes in {len(mesh.elements):,} elements of order {mesh.order}, {width} m × "
        f"{height} m, {absorbing:.0f} % of which absorb; joined to disks at "
        f"{counted(len(outside.wall.element), 'place')}"
    )


def _from_to(sizes: np.ndarray) -> str:
    """The least and the largest of some sizes (m), one number if they are equal."""
    return "–".join(dict.fromkeys(f"{size:.4g}" for size in (sizes.min(), sizes.max())))


def _levels(outside: Surroundings) -> str:
    """Heights of the ground beyond left and right sides where it is lower, and where the continuum ends there."""
    return ", ".join(
        f"up to y = {level.floor:.4g} m at the {side}" + _less(level.floor - level.surface)
        for side, level in outside.levels.items()
    )


def _less(depth: float) -> str:
    """In words how far a continuum ends below or above a floor; empty if it ends there."""
    if abs(depth) < SHOWN:
        return ""
    return f" (the continuum {abs(depth):.3f} m {'below' if depth > 0.0 else 'above'} that)"


def _waves(scene: DiskScene, outside: Surroundings, signals: Sequence[Signal]) -> str:
    """Nodes in the shortest wave and the error of the elements."""
    order, (medium, side) = outside.settings.order, coarsest(outside)
    if any(sizing.jumps(signal) for signal in signals):
        shortest = side * sizing.NODES[order] / order
        return f"begin or end at once; elements return those shorter than {shortest:.3g} m"
    length = sizing.shortest_wave(signals, medium)
    beyond = sizing.slowest(medium) / length
    error = max(sizing.element_error(signals, medium, order, side), near_error(scene, outside))
    each = [order * sizing.slowest(own) / (largest * beyond) for own, largest in elements_by_layer(outside)[::-1]]
    at = " at the right and then the left" if scene.case.is_unlike else ""
    layers = "" if len(each) == 1 else f" of each layer from above{at}, the shortest"
    return (
        f"{', '.join(f'{count:.3g}' for count in each)} nodes in the shortest wavelength{layers}, {length:.3g} m "
        f"({100.0 * sizing.SHARE:g} % of the energy is above {beyond:.3g} Hz); error of velocities at most "
        f"{percent(min(error, 1.0))}{_as_small(scene, error)}"
    )


def _as_small(scene: DiskScene, error: float) -> str:
    """A note that elements are too large for the accuracy, as smaller ones shorten the step; or empty."""
    keys = scene.case.outside
    if keys.element is not None or error <= LEEWAY * keys.accuracy:
        return ""
    least = least_element(scene.case, scene.ground.brick.mean_diameter)
    return f", above outside.accuracy, as elements smaller than {least:.3g} m shorten the time step"


def _layers(outside: Surroundings, signals: Sequence[Signal]) -> str:
    """Begin, depth and reflection of the layers, in words."""
    settings, mesh = outside.settings, outside.body.mesh
    low, high = mesh.between_layers
    left, right, bottom, top = mesh.sides
    distances = left - low[0], high[0] - right, bottom - low[1], high[1] - top
    deep = np.ravel([axis.thickness for axis in mesh.axes])
    there = [number for number in range(4) if deep[number] > 0.0]
    begin, depth = (" and ".join(dict.fromkeys(f"{of[number]:.4g}" for number in there)) for of in (distances, deep))
    count = f"{settings.layers} elements" + (f" ({len(settings.beside)} left and right)" if settings.beside else "")
    angles = ", ".join(f"{angle:g}" for angle in ANGLES)
    p, s = (", ".join(f"{100.0 * each:.2g}" for each in returned) for returned in _reflections(outside, signals))
    floor = sizing.layer_error(settings.order, settings.layers)
    if outside.body.is_stretched_along:
        returned = f"they stretch both axes, as the ground is very anisotropic, and return {STRETCHED} of the motion"
    else:
        returned = f"at {angles}° they return at most {p} % of P and {s} % of S waves"
    return (
        f"begin {begin} m beyond the sides and are {depth} m deep, {count}, and keep "
        f"{percent(settings.absorption.reflection)} of P waves there and back; {returned}, the elements "
        f"themselves about {percent(floor)}"
    )


def _reflections(outside: Surroundings, signals: Sequence[Signal]) -> tuple[list[float], list[float]]:
    """Reflections of P and S waves at `ANGLES`, at the lowest dominant frequency; the largest over axes."""
    body = outside.body
    lowest = min((signal.wave.dominant_frequency() for signal in signals), default=math.inf)
    found = []
    for side, medium in product(outside.sides, body.ground.media):
        axis, profile = normal_axis(side), body.profile(side)
        if profile is not None:
            slow, fast = medium.plane_waves((1.0 - axis, float(axis)))[0].tolist()
            frequency = lowest if 0.0 < lowest < math.inf else fast / body.mesh.inner
            found.append([[profile.expected_reflection(frequency, a, c) for a in ANGLES] for c in (fast, slow)])
    p, s = np.max(found, axis=0).tolist()
    return p, s


def _cost(scene: DiskScene) -> str:
    """Shares of a step's time, in words."""
    costs = step_cost.times_of_scene(scene)
    whole = sum(costs.values())
    shares = [f"{name} {100.0 * cost / whole:.0f} %" for name, cost in costs.items() if cost > 0.0]
    return f"of the stepping about: {', '.join(shares)}"


def continuum_warnings(scene: DiskScene, steps: float) -> Iterator[str]:
    """Settings given in the case that are poorer than its accuracy, and layers that may amplify noise in many steps."""
    outside, keys = scene.outside, scene.case.outside
    if outside is None:
        return
    asked = f"outside.accuracy = {percent(keys.accuracy)}"
    yield from _poor_elements(scene, outside, keys, asked)
    yield from _thin_layers(scene, outside, keys)
    settings, order = outside.settings, keys.order
    if (error := sizing.layer_error(order, settings.layers)) > keys.accuracy:
        enough = sizing.layer_count(order, keys.accuracy)
        yield (
            f"outside.layers: {settings.layers} elements of order {order} return about {percent(error)} of the "
            f"displacement, more than {asked}; {enough} are enough"
        )
    if settings.absorption.reflection > keys.accuracy:
        yield (
            f"outside.reflection: is {settings.absorption.reflection:g}, above {asked}; give at most "
            f"{sizing.reflection(keys.accuracy):g}"
        )
    if outside.body.is_stretched_along and keys.accuracy < RETURNED:
        yield (
            f"outside: in such anisotropic ground waves grow in usual layers; those it needs return {STRETCHED} of the "
            f"motion, more than {asked}, and less with more outside.layers; with kratio and pb_kratio of 0.5 or "
            "more, or pattern B, usual ones do"
        )
    yield from _lasting(scene, outside, keys, asked)
    yield from _from_the_surface(scene, outside, keys, asked)
    if steps > QUIET_STEPS and _is_flat(outside):
        yield (
            f"outside: the layers of such flat ground may amplify noise in tens of thousands of steps, this run has "
            f"{steps:,.0f}; a larger outside.margin helps, and runs that gain energy are stopped"
        )


def _is_flat(outside: Surroundings) -> bool:
    """Whether the ground within the layers, which is not periodic, is very flat."""
    mesh = outside.body.mesh
    shorter, longer = sorted(axis.inner for axis in mesh.axes)
    return not any(mesh.periodic) and longer > FLAT * shorter


def _poor_elements(scene: DiskScene, outside: Surroundings, keys: OutsideTable, asked: str) -> Iterator[str]:
    """Warnings about elements too large for waves or nearby sources, or too small for the disks.

    The returned share is the part of the spectrum with fewer than `sizing.NODES` nodes per wavelength.
    `expected_errors` at monitors are smaller: half of it arrives there, and for longer waves it falls gradually.
    """
    order, (medium, side) = keys.order, coarsest(outside)
    signals = signals_of(scene.case)
    error = sizing.element_error(signals, medium, order, side) if signals else 0.0
    if keys.element is None:
        if error > max(LEEWAY * keys.accuracy, LARGE):
            yield (
                f"outside: elements of {side:.4g} m, the smallest useful ones beside these disks, return short waves, "
                f"about {percent(error)} of the velocity of all that meets them, more than {asked}; the disks disperse "
                "these waves, too: take smaller disks, or longer waves"
            )
        return
    if error > LEEWAY * keys.accuracy:
        enough = sizing.element_size(signals, medium, order, keys.accuracy)
        needed = max(enough, least_element(scene.case, scene.ground.brick.mean_diameter))
        if needed < side:
            yield (
                f"outside.element: elements of {side:.4g} m return short waves, about {percent(error)} of the "
                f"velocity of all that meets them, more than {asked}; {needed:.3g} m are small enough"
            )
    if (error := near_error(scene, outside)) > LEEWAY * keys.accuracy:
        yield (
            f"outside.element: elements of {largest_element(outside):.4g} m are too large beside a load or hole, with "
            f"an error of about {percent(min(error, 1.0))}, more than {asked}"
        )
    least = least_element(scene.case, scene.ground.brick.mean_diameter)
    if (smallest := float(outside.body.mesh.element_sizes.min())) < (1.0 - ROUNDING) * least:
        yield (
            f"outside.element: elements of {smallest:.4g} m shorten the time step, and below {least:.3g} m nothing is "
            "gained, as the disks themselves disperse shorter waves"
        )


def _thin_layers(scene: DiskScene, outside: Surroundings, keys: OutsideTable) -> Iterator[str]:
    """Warnings about layers in which a low row of elements shortens the time step, see `LOW`."""
    body, diameter, case = outside.body, scene.ground.brick.mean_diameter, scene.case
    names = [name for side in case.sides_of_ground for name in case.beside(side).layer_names[::-1]]
    heights = body.mesh.element_sizes[:, 1]
    for number, (name, medium) in enumerate(zip(names, body.ground.media, strict=False)):
        height = float(heights[body.layer == number].min(initial=math.inf))
        slower = sizing.fastest(body.medium) / medium.normal_speed(1)
        part = float(np.interp(slower * height / diameter, *LOW))
        if keys.element is None and part * LEEWAY < 1.0:
            yield (
                f"layer: a row of elements {height:.3g} m high beside layer {name} shortens the time step to about "
                f"{part:.2g} of that with rows of {LOW[0][-1] * diameter / slower:.3g} m; move the joints of this "
                "layer, or the lower side of the disks"
            )


def _lasting(scene: DiskScene, outside: Surroundings, keys: OutsideTable, asked: str) -> Iterator[str]:
    """A warning about a margin that is too small for a force that stays."""
    lasting, body = lasting_time(scene.case), outside.body
    speed = sizing.fastest(body.medium)
    error = sizing.missing(lasting, speed, keys.shift, body.mesh.inner)
    if error > keys.accuracy:
        inner = sizing.inner_length(lasting, speed, keys.shift, keys.accuracy)
        yield (
            f"outside.margin: under a load that stays for {lasting:.3g} s about {percent(min(error, 1.0))} of the "
            f"displacement will be missing, more than {asked}; {inner:.4g} m within the layers are enough, now "
            f"{body.mesh.inner:.4g} m"
        )


def _from_the_surface(scene: DiskScene, outside: Surroundings, keys: OutsideTable, asked: str) -> Iterator[str]:
    """A warning about a margin that is too small for surface reflections along the layers."""
    settings, medium, axis = outside.settings, outside.body.medium, outside.body.mesh.axes[0]
    sources = buried(scene.case, outside.box, outside.sides)
    error = max((each.error(settings, medium, settings.margin) for each in sources), default=0.0)
    if keys.margin is not None and error > LEEWAY * keys.accuracy:
        enough = max(margin_below_surface(settings, each, medium, keys.accuracy) for each in sources)
        yield (
            f"outside.margin: waves that the free surface sends back run along layers "
            f"{keys.margin * axis.sizes[axis.layer[0]]:.4g} m beside the disks, and about {percent(error)} of their "
            f"velocity returns from these, more than {asked}; {enough} elements are enough"
        )
