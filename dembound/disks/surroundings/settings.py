"""Settings of the continuum round a body: given in the case, or chosen from its waves and loads."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from dembound.boundaries.edge import normal_axis
from dembound.casefile.disks import DiskCase
from dembound.continuum import sizing
from dembound.continuum.axis import Around
from dembound.continuum.layer import Absorption
from dembound.continuum.medium import Ground, Layered, Unlike, layered
from dembound.disks.surroundings.near_fields import extents, lasting_time, near_fields, signals_of
from dembound.errors import CaseError
from dembound.table import Box

FLAT = 5.0
"""Length of ground over its height from which on elements are about as wide as high.

Elements twice as wide as high amplify noise in ground 9 times as wide as high, with ν = 0.25, but not in ground 5 times
as wide."""

MOST_ALONG = 100_000
"""Largest number of elements along a side."""

ROUNDING = 1e-9
"""Part of an element by which a number of elements may differ from a whole one."""


TALLEST = 2.0
"""Largest height of elements over their width in fast layers: noise grows in elements seven times as high as wide."""

WIDER = (1.3, 1.6, 2.0, 2.5, 3.0)
"""Widths of the outer absorbing elements at left and right of layered ground, over those beside the body.

There both axes are stretched (continuum/layer.py), and what this returns falls with the depth over the length of the
waves in the fast layers; slow waves are absorbed before they reach wide elements. Returned motion round a force along
x on the surface, 40 m from the layers, over all motion, with layers of 200 on 350 on 700 m/s, a Ricker wavelet of 5 Hz
and elements 10 m wide:

| elements at each side, depth over width | part .1 | .05 | .03 | 0 (noise grows) |
|---|---|---|---|---|
| 6 equal ones, 6 | 1.41 % | .83 % | .54 % | .06 % |
| 10 equal ones, 10 | .59 | | | |
| 6 of 1 to 3.1, each 1.25 times the one before, 11.3 | .64 | .52 | | |
| 8 of which five are wider, 13.4 | .29 | | | |
| 10 of which five are twice as wide, 14.5 | .21 | .12 | | .04 |

With eight: 200 on 700, 200 on 350 on 700, 200 on 260 m/s .14 to .30 %, forces along x or y; a slow layer between rocks
.28 % (y) and 1.14 % (x, on the rock). By number of equal ones before the five: 2 .33, 3 .28, 4 .23, 5 .20 % (y).

With half the part noise decays for 30,000 steps at a ratio of speeds of 1.5 if c_p/c_s is 5, and of 2 if it is 2, but
grows at 2 and 3.5: the part of .1 stays."""

SLIVER = 0.1
"""Part of an element: joints of layers nearer to an edge of the box lie on it."""


class Settings(NamedTuple):
    """All settings of a continuum.

    order : of the elements. element : largest side, m; least : smallest useful side, m, 0 if the largest is
    given. margin, layers : numbers of elements. absorption : R0, α and τ. damping : of the ties. taller : by layer of
    the ground from the bottom up, how many times as high as `element` its elements may be; empty: all as high. beside :
    widths of the absorbing elements at left and right, outwards, over the others; empty: `layers` equal ones.
    """

    order: int
    element: float
    least: float
    margin: int
    layers: int
    absorption: Absorption
    damping: float
    taller: tuple[float, ...] = ()
    beside: tuple[float, ...] = ()

    @property
    def absorbing_at(self) -> Around:
        """Numbers of absorbing elements at all four sides."""
        beside = len(self.beside) or self.layers
        return Around(beside, beside, self.layers, self.layers)

    @property
    def depth_beside(self) -> float:
        """Depth of the layers at left and right, over the width of the elements beside the body."""
        return sum(self.beside) or self.layers

    @property
    def given(self) -> dict[str, float]:
        """These settings as keys of the table, to fix them in a case whatever its waves."""
        own = {"element": self.element, "margin": self.margin, "layers": self.layers}
        return own | {"reflection": self.absorption.reflection}

    def side(self, length: float) -> float:
        """Side (m) of elements that divide a length (m) into equal parts."""
        count = max(math.ceil(length / self.element - ROUNDING), 1)
        if self.least > 0.0:
            count = min(count, max(math.floor(length / self.least + ROUNDING), 1))
        return length / count

    def sides(self, width: float, height: float) -> tuple[float, float]:
        """Width and height (m) of elements that divide a width and height (m) into equal parts.

        In flat ground they are about as wide as high: layers of elements longer than deep amplify noise there.
        """
        wide, high = self.side(width), self.side(height)
        if max(width, height) <= FLAT * min(width, height):
            return wide, high
        shorter = self._replace(element=min(wide, high))
        return shorter.side(width), shorter.side(height)


def _taller(
    case: DiskCase, ground: Layered | Unlike, settings: Settings, box: Box, sides: Sequence[str]
) -> tuple[float, ...]:
    """`Settings.taller` of layered ground, none where a largest side is given or waves have no spectrum."""
    keys, signals = case.outside, signals_of(case)
    if not ground.joints or keys.element or not signals:
        return ()
    fields = near_fields(case, ground, box, sides)
    near = min((field.largest_side(keys.order, keys.accuracy) for field in fields), default=math.inf)
    media = ground.between_joints if isinstance(ground, Unlike) else [(each,) for each in ground.media]
    found = []
    for beside in media:
        enough = min(near, *(sizing.element_size(signals, each, keys.order, keys.accuracy) for each in beside))
        found.append(min(max(enough / settings.element, 1.0), TALLEST))
    return tuple(found)


def settings_of(case: DiskCase, medium: Ground, diameter: float, box: Box, sides: Sequence[str]) -> Settings:
    """Settings that a case gives for the continuum on some sides of a box (left, bottom, right, top; m).

    diameter : mean one of the disks, m.

    Raises CaseError if no size is given and nothing in the case makes waves.
    """
    keys, lasting = case.outside, lasting_time(case)
    least = 0.0 if keys.element else least_element(case, diameter)
    chosen = Settings(
        order=keys.order,
        element=keys.element or max(_element(case, medium, box, sides), least),
        least=least,
        margin=keys.margin or 1,
        layers=keys.layers or sizing.layer_count(keys.order, keys.accuracy * (0.5 if lasting else 1.0)),
        absorption=Absorption(keys.reflection or sizing.reflection(keys.accuracy), keys.shift, keys.delay),
        damping=keys.damping,
    )
    if (ground := layered(medium)).joints:
        taller = _taller(case, ground, chosen, box, sides)
        chosen = chosen._replace(taller=taller, beside=(1.0,) * chosen.layers + WIDER)
    if keys.margin is None:
        inner = sizing.inner_length(lasting, sizing.fastest(medium), keys.shift, keys.accuracy)
        requested = [1, _margin(chosen, box, sides, inner) if lasting > 0.0 else 1]
        requested += [margin_below_surface(chosen, each, medium, keys.accuracy) for each in buried(case, box, sides)]
        chosen = chosen._replace(margin=max(requested))
    return chosen


class Buried(NamedTuple):
    """A hole or force beside a side: its depth below the free surface and distance from the side, m.

    size : width and height of the body, m.
    """

    depth: float
    beside: float
    size: tuple[float, float]

    def error(self, settings: Settings, medium: Ground, margin: int) -> float:
        """Velocity error by surface reflections that run along layers beyond `margin` elements."""
        beyond = (margin + sizing.WITHIN * settings.depth_beside) * settings.sides(*self.size)[0]
        speeds = sizing.slowest(medium) / sizing.fastest(medium)
        return sizing.grazing_error(self.depth, speeds, settings.absorption.reflection, self.beside + beyond)


def buried(case: DiskCase, box: Box, sides: Sequence[str]) -> list[Buried]:
    """The holes and forces of a case below its free surface, beside each of the sides left and right of a box, m."""
    surface = case.box[3]
    if "top" in sides and case.reaches_surface:
        return []
    places = [0.5 * (low + high) for low, high in extents(case)]
    edges = [box[2 * (side == "right")] for side in sides if normal_axis(side) == 0]
    size = box[2] - box[0], box[3] - box[1]
    return [Buried(surface - y, abs(x - edge), size) for x, y in places for edge in edges if y < surface]


def margin_below_surface(settings: Settings, source: Buried, medium: Ground, accuracy: float) -> int:
    """Number of elements beside a box with which layers absorb surface reflections to an accuracy; at least 1."""
    speeds = sizing.slowest(medium) / sizing.fastest(medium)
    offset = sizing.offset(source.depth, speeds, settings.absorption.reflection, accuracy)
    elements = (offset - source.beside) / settings.sides(*source.size)[0]
    elements -= sizing.WITHIN * settings.depth_beside
    return max(math.ceil(elements - ROUNDING), 1)


def _margin(settings: Settings, box: Box, sides: Sequence[str], inner: float) -> int:
    """Number of elements beside a box with which a length (m) fits between the layers of one axis; at least 1."""
    requested, element = [], settings.sides(box[2] - box[0], box[3] - box[1])
    for axis in (0, 1):
        length, beyond = box[2 + axis] - box[axis], sum(normal_axis(side) == axis for side in sides)
        if beyond:
            requested.append(math.ceil((inner - length) / (beyond * element[axis]) - ROUNDING))
    return max(min(requested), 1)


def expected_tops(case: DiskCase, box: Box) -> tuple[float, float] | None:
    """Heights (m) of the free surface left and right of a box of a case that reaches it, before subtracting skins.

    None: both as high as the box.
    """
    if not case.floors or case.box[3] - box[3] > ROUNDING * case.size[1]:
        return None
    left, right = (case.floors[side].height if side in case.floors else box[3] for side in ("left", "right"))
    return left, right


def least_element(case: DiskCase, diameter: float) -> float:
    """Smallest useful side (m) of elements beside disks of this mean diameter, m."""
    return sizing.least_size(case.outside.order, diameter, is_random=not case.packing.is_lattice)


def _element(case: DiskCase, medium: Ground, box: Box, sides: Sequence[str]) -> float:
    """Largest side (m) of elements that suits the waves, and the fields beside forces and holes.

    Without waves a static stage frees the walls of holes, which move as if pressed; without holes nothing moves.
    """
    keys, signals = case.outside, signals_of(case)
    of_fields = [field.largest_side(keys.order, keys.accuracy) for field in near_fields(case, medium, box, sides)]
    if signals:
        return min([sizing.element_size(signals, medium, keys.order, keys.accuracy), *of_fields])
    if case.static is None:
        nothing = "the case has no wave or load to choose it from"
        raise CaseError([f"outside.element: is absent, but {nothing}; give the largest side of elements, m"])
    return min([0.25 * (box[2] - box[0]), 0.25 * (box[3] - box[1]), *of_fields])
