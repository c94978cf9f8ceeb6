"""The base of all boundary types, and of those that are driven by waves."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np

from dembound.boundaries.edge import BoundaryMedium, Edge, Factor, Motion, axis_of_motion
from dembound.boundaries.support import SupportBuilder, Waves
from dembound.table import Box, Table, quantity


@dataclass(frozen=True)
class Layer:
    """Nodes beyond an end that absorb.

    nodes : their number N; power : p of the profile; reflection : R0, the theoretical reflection from the layer's outer
    end.
    """

    nodes: int
    power: float
    reflection: float

    def rates(self, depth: np.ndarray, spacing: float, speed: float) -> np.ndarray:
        """Rates of decay d (1/s), of any shape, at depths below the end in spacings (m), for waves of a speed (m/s).

        d = (p + 1) c ln(1/R0)/(2L) (x/L)^p, L = NΔx: with it a wave decays by √R0 on the way to the outer end.
        """
        length = self.nodes * spacing
        largest = (self.power + 1.0) * speed * math.log(1.0 / self.reflection) / (2.0 * length)
        return largest * (np.maximum(depth, 0.0) / self.nodes) ** self.power


BoundaryType = type["Boundary"]
"""A type of sides."""

Place = tuple[Edge, BoundaryMedium]
"""A side's place: its particles, and the medium that it represents."""


class Boundary(Table):
    """What acts on a side; without a table it is free.

    Attributes
    ----------
    for_bars : whether an end of a bar may have this type.
    for_static : whether a side may have it during the static stage, in which no wave runs.
    is_free : whether no forces act on the side.
    is_periodic : whether the side is connected to the opposite side.
    is_mirror : whether the side is a mirror plane.
    is_outside : whether the ground beyond the side is a continuum that is computed, too.
    may_halve : whether the side's particles may be half cells.
    needs_column : whether the side needs a free-field column.
    beyond_dashpots : text for reports, naming what `dashpots_alone` leaves out.

    Notes
    -----
    A type is a subclass with a literal `type`, its keys, and the method `support`. The defaults of the other members
    are those of a side without waves, dashpots and prescribed motion.
    """

    for_bars: ClassVar[bool] = False
    for_static: ClassVar[bool] = False
    is_free: ClassVar[bool] = False
    is_periodic: ClassVar[bool] = False
    is_mirror: ClassVar[bool] = False
    is_outside: ClassVar[bool] = False
    may_halve: ClassVar[bool] = False
    needs_column: ClassVar[bool] = False
    beyond_dashpots: ClassVar[str] = ""

    type: str

    def part_of(self, edge: Edge) -> Edge:
        """The part of an edge on which the side acts; by default all of it."""
        return edge

    def support(self, edge: Edge, medium: BoundaryMedium, waves: Waves, supports: SupportBuilder) -> None:
        """Fill rows of the support table for the particles of an edge; by default none.

        medium : the medium that the side represents; waves : those of the case by name.
        """

    def problems(self, side: str, tables: Mapping[str, Any]) -> Iterator[str]:
        """Mistakes of the table of `side` that depend on other tables, one line each.

        tables : those of the case by name, None for one that is invalid; ``boundary`` contains those of the sides.
        """
        yield from ()

    def prescribed(self, normal_axis: int) -> tuple[int, ...]:
        """Components (0 x, 1 y, 2 rotation) whose motion the side prescribes, given the axis of its normal."""
        return ()

    @property
    def waves(self) -> Mapping[Motion, str]:
        """The waves that drive the side: kind -> name; by default none.

        Calibration of a side with waves and dashpots assumes that the waves enter by the force 2βρcD·v_i (Z eq. 6).
        """
        return {}

    def waves_by_axis(self, normal_axis: int) -> tuple[str | None, str | None]:
        """Wave names for x and y motion, given the axis of the side's normal; None for none."""
        p, s = self.waves.get("p"), self.waves.get("s")
        return (p, s) if normal_axis == 0 else (s, p)

    @property
    def factors(self) -> Mapping[Motion, Factor]:
        """The factors β of the side's dashpots as given: kind of wave -> β or "matched"; by default it has none."""
        return {}

    def factors_at(self, edge: Edge, medium: BoundaryMedium) -> dict[Motion, float]:
        """The factors β of the side's dashpots as numbers; "matched" is 1 where the motion is held."""
        matched = medium.matched(edge) if "matched" in self.factors.values() else {}
        return {
            motion: factor if factor != "matched" else 1.0 if math.isnan(matched[motion]) else matched[motion]
            for motion, factor in self.factors.items()
        }

    def with_numbers(self, edge: Edge, medium: BoundaryMedium) -> Self:
        """The side with the factors β that it has at an edge as numbers."""
        return self.with_factors(self.factors_at(edge, medium))

    def with_factors(self, factors: Mapping[Motion, Factor]) -> Self:
        """The side with other factors β of its dashpots, by kind of wave: the keys beta_p and beta_s."""
        return self.model_copy(update={f"beta_{motion}": beta for motion, beta in factors.items()})

    def on_whole_side(self) -> Self:
        """The side as it is where it acts; only of some sides it does so on a range of particles alone."""
        return self

    @property
    def is_artificial(self) -> bool:
        """Whether the side represents ground or rock beyond it; by default true if that is a continuum."""
        return self.is_outside

    @property
    def is_interface(self) -> bool:
        """Whether other rock begins at the side, so that the waves it returns are no error; by default not."""
        return False

    @property
    def may_move(self) -> bool:
        """Whether the side may be moved away: by default true of artificial sides through which no waves enter."""
        return self.is_artificial and not self.waves

    @property
    def absorber(self) -> str:
        """Name of the region beyond the side that reflects next to nothing; empty where waves may come back."""
        return "a continuum" if self.is_outside else "a matched layer" if self.layer else ""

    @property
    def absorbs(self) -> bool:
        """Whether the side absorbs at least part of the waves that reach it."""
        return bool(self.factors or self.absorber)

    @property
    def layer(self) -> Layer | None:
        """The absorbing layer of nodes beyond an end of a bar; by default none."""
        return None

    @property
    def half_cells(self) -> bool:
        """Whether the side's particles are half cells, see half_mass.py."""
        return False

    def with_half_cells(self, half: bool) -> Self:
        """The side with half cells or with whole ones; unchanged if it may not have half cells."""
        return self

    def equal_supports(self, own: Place, other: Place) -> "Boundary | None":
        """The side at one place with supports as strong per length as those of this table at another place.

        Springs, dampers and forces of waves are compared. None, the default, if the type does not compute it: the table
        is then used unchanged if it is as strong, and refused otherwise.
        """
        return None

    def own_keys(self, *kinds: BoundaryType) -> dict[str, Any]:
        """The keys that are given and belong to some kinds of sides, but for the type."""
        keys = {key for kind in kinds for key in kind.model_fields} - {"type"}
        return self.model_dump(include=keys, exclude_unset=True)

    def driven_by(self, waves: Mapping[Motion, str]) -> Self:
        """The side with other waves: kind -> name."""
        keys = {f"wave_{motion}": waves.get(motion) for motion in ("p", "s")}
        return self.model_copy(update=keys)

    def at_rest(self) -> "Boundary":
        """The side without its waves."""
        return self.driven_by({}) if self.waves else self

    def dashpots_alone(self) -> "Boundary":
        """The side used to calibrate β for plane waves at normal incidence: without springs and columns."""
        return self

    def stiffest(self, side: str, box: Box) -> "Boundary":
        """The side with its largest stiffness everywhere, independent of its position.

        side : its name; box : left, bottom, right and top of the disks, m.
        """
        return self

    def describe(self, edge: Edge, medium: BoundaryMedium) -> dict[str, Any]:
        """The side in numbers for reports: key -> value, SI units; matched_p and matched_s are β0, null where held.

        The default includes the numbers among the keys of all classes that do not define this method.
        """
        matched = medium.matched(edge) if self.factors else {}
        own = {
            key: getattr(self, key)
            for each in type(self).__mro__
            if issubclass(each, Table) and "describe" not in vars(each)
            for key in each.model_fields
            if not any(key in base.model_fields for base in each.__bases__ if issubclass(base, Table))
        }
        numbers = {key: value for key, value in own.items() if isinstance(value, float) or type(value) is int}
        return (
            numbers
            | {f"beta_{motion}": factor for motion, factor in self.factors_at(edge, medium).items()}
            | {f"matched_{motion}": None if math.isnan(matched[motion]) else matched[motion] for motion in self.factors}
        )


class Drivable(Boundary):
    """A side that may name waves by type: P moves along the side's normal, S across it.

    Positive velocities point along +x and +y on every side. Both waves may be given together.
    """

    wave_p: str | None = quantity(None)
    """wave that moves along the side's normal"""
    wave_s: str | None = quantity(None)
    """wave that moves across the side's normal"""

    def problems(self, side: str, tables: Mapping[str, Any]) -> Iterator[str]:
        """Waves along a direction in which nothing can move."""
        yield from super().problems(side, tables)
        held = tables["motion"].held if tables.get("motion") else ()
        for motion in self.waves:
            if (direction := "xy"[axis_of_motion(side, motion)]) in held:
                yield f"boundary.{side}.wave_{motion}: drives {direction}, which motion.held holds for every particle"

    @property
    def waves(self) -> Mapping[Motion, str]:
        """The waves that are given."""
        named: dict[Motion, str | None] = {"p": self.wave_p, "s": self.wave_s}
        return {motion: name for motion, name in named.items() if name is not None}


class Driven(Drivable):
    """A side that needs at least one wave."""

    def mistakes(self) -> Iterator[str]:
        """No wave."""
        yield from super().mistakes()
        if not self.waves:
            yield "names no wave; give wave_p (along the normal), wave_s (across it) or both"
