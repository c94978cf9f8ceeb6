"""The ``[[wall]]`` tables: rigid lines that disks touch."""

import math
from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import Any, Literal

from pydantic import PrivateAttr

from dembound.casefile.disks.surface import points_in_file
from dembound.casefile.disks.targets import with_history
from dembound.casefile.messages import counted, numbered
from dembound.casefile.types import LAWS
from dembound.holes.polygon import Points
from dembound.table import FileName, Table, quantity
from dembound.waves import Wave

MOST_POINTS = 100_000
"""Largest number of points of a wall."""

Velocity = tuple[float, float]


class Wall(Table):
    """A rigid line that disks touch from both sides, also beyond the box of disks: PFC's wall.

    Without a velocity, waves or ``moves``, and in a static stage, it stands.

    Notes
    -----
    Validation passes the case file's folder, and texts in place of files, as for waves of type "file".
    """

    name: FileName = quantity()
    """name in messages and results"""
    points: Points | str = quantity(unit="m", means="place")
    """points [[x, y], …], or a text file of x and y; the first one again at the end closes it"""
    fric: float = quantity(0.0, means="friction coefficient", ge=0.0)
    """friction coefficient between disks and wall"""
    rr_fric: float = quantity(0.0, means="friction coefficient", ge=0.0)
    """resistance to rolling: moment of at most this times R N; needs fric"""
    kn: float | None = quantity(None, unit="N/m", gt=0.0)
    """normal stiffness of a contact; absent: 2·emod of the material"""
    ks: float | None = quantity(None, unit="N/m", gt=0.0)
    """shear stiffness of a contact; absent: kn over the material's kratio"""
    dp_nratio: float = quantity(0.0, means="share", ge=0.0, le=1.0)
    """normal dashpot of a contact over the critical one"""
    velocity: Velocity | None = quantity(None, unit="m/s", means="velocity")
    """constant velocity [vx, vy]"""
    wave_x: str | None = quantity(None)
    """wave of its velocity along x"""
    wave_y: str | None = quantity(None)
    """wave of its velocity along y"""
    moves: Literal["incident"] | None = quantity(None)
    """"incident": it moves as a bottom of given velocity, else as the free field at the place `at`"""
    at: tuple[float, float] | None = quantity(None, unit="m", means="place")
    """place in the ground whose motion it has; absent: the middle of its box"""
    until: float | None = quantity(None, unit="s", gt=0.0)
    """time at which it stops; absent: it moves to the end of the run"""

    _line: Points = PrivateAttr(default=())
    _text: str = PrivateAttr(default="")

    def model_post_init(self, context: Mapping[str, Any] | None) -> None:
        """Reads its points, if they are in a file."""
        if isinstance(self.points, str):
            self._line, self._text = points_in_file(self.points, context or {}, "points")
        else:
            self._line = self.points

    def mistakes(self) -> Iterator[str]:
        """Mistakes in the points and the motion."""
        if not 2 <= len(self._line) <= MOST_POINTS:
            yield f"points: has {counted(len(self._line), 'point')}, must have 2 to {MOST_POINTS:,}"
        for number, (one, two) in enumerate(pairwise(self._line), start=1):
            if one == two:
                yield f"points: has point {number} twice in a row, at ({one[0]:.6g}, {one[1]:.6g}) m; leave one out"
        for key in ("wave_x", "wave_y"):
            if self.velocity is not None and getattr(self, key) is not None:
                yield f"{key}: is not allowed together with velocity"
        for key in ("velocity", "wave_x", "wave_y", "until") if self.moves else ():
            if getattr(self, key) is not None:
                yield f"{key}: is not allowed together with moves"
        if self.at is not None and self.moves is None:
            yield 'at: is of a wall that moves as the ground; give moves = "incident"'
        if self.until is not None and not self.is_driven and not self.moves:
            yield "until: is of a wall that moves; give velocity, wave_x or wave_y"
        if self.rr_fric > 0.0 and self.fric == 0.0:
            yield "rr_fric: is of disks that roll, but with fric = 0 they slide"

    @property
    def line(self) -> Points:
        """Its points, m."""
        return self._line

    @property
    def files(self) -> dict[str, str]:
        """Text of the file of its points, by its path, if it has one."""
        return {self.points: self._text} if isinstance(self.points, str) else {}

    @property
    def waves(self) -> dict[int, str]:
        """Names of the waves of its velocity, by axis."""
        return {axis: name for axis, name in enumerate((self.wave_x, self.wave_y)) if name is not None}

    @property
    def is_driven(self) -> bool:
        """Whether it moves by a velocity or waves of its own."""
        return self.velocity is not None or bool(self.waves)

    def stops(self, waves: Mapping[str, Wave]) -> float:
        """Time (s) from which it does not move by velocity or waves, those of the case by name; infinite if never."""
        ends = [waves[name].duration() for name in self.waves.values()]
        return min(max(ends, default=math.inf), math.inf if self.until is None else self.until)

    @property
    def place(self) -> tuple[float, float]:
        """Place (m) whose free field it moves with: as given, or the middle of its box."""
        (left, right), (bottom, top) = ((min(each), max(each)) for each in zip(*self._line, strict=True))
        return self.at or (0.5 * (left + right), 0.5 * (bottom + top))


def wall_problems(tables: Mapping[str, Any]) -> Iterator[str]:
    """What walls do not go with; a table that is invalid on its own is None."""
    material, layers, output = tables["material"], tables["layer"], tables["output"]
    if tables["wall"] and output and output.estimate:
        yield "output.estimate: is true, but errors beside walls are not known; leave [[wall]] or the estimate out"
    for place, wall in numbered("wall", tables["wall"]):
        if material and not LAWS[material.law].has_history:
            yield (
                f'{place}: material.law is "{material.law}", under which contacts never open, so that disks cannot '
                f"leave a wall; give law = {with_history()}"
            )
        if wall.moves and not _knows_ground(tables):
            yield (
                f'{place}.moves: is "incident", but the motion of the ground beyond is not known; give boundary.bottom '
                'a wave, with type "velocity" or beside sides of type "free_field" or "outside", or give [incident]'
            )
        for side, table in tables["boundary"].items():
            if table and table.is_periodic and side in ("left", "bottom"):
                yield f'{place}: boundary.{side} is "periodic", and a wall is not repeated; leave one of them out'
        if material and wall.kn is None and not _gives_stiffness(material, layers):
            yield f"{place}.kn: is missing; the contacts of material have no emod from which it follows"


def _knows_ground(tables: Mapping[str, Any]) -> bool:
    """Whether the motion of the ground beyond is known: of a bottom with a velocity, or of a free field under waves."""
    sides = tables["boundary"]
    if "bottom" in sides and sides["bottom"] is None:
        return True  # invalid on its own
    bottom = sides.get("bottom")
    lateral = [sides[side] for side in ("left", "right") if sides.get(side)]
    beyond = bottom is not None and bottom.is_outside
    beside = any(table.needs_column or (beyond and table.is_outside) for table in lateral)
    driven = bottom is not None and bool(bottom.waves) and (beside or bool(bottom.prescribed(1)))
    return driven or tables["incident"] is not None


def _gives_stiffness(material: Any, layers: Any) -> bool:
    """Whether contacts have a linear stiffness, from which that of a wall follows."""
    law = LAWS[material.law]
    zero = any(each.emod == 0.0 for each in (material, *filter(None, layers)))
    return law.starts_elastic and not zero and material.contact_share > 0.0
