"""Reflection of plane waves along the normal of a side by its dashpots, springs and half cells."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from dembound.boundaries.description import reflected
from dembound.boundaries.edge import BoundaryMedium, Edge, Motion, axis_of_motion
from dembound.disks.matching import Held, homogenised_beta, require_dashpots_alone
from dembound.disks.reflection.bricks import end_scene
from dembound.disks.reflection.meter import Meter
from dembound.disks.scene import DiskScene, with_boundaries
from dembound.disks.sides import media_of
from dembound.disks.surroundings.frequencies import frequencies_of
from dembound.errors import CaseError
from dembound.interrupts import look

FREQUENCIES = 3
"""Number of frequencies of the case's waves, of equal energy each, over which energies are averaged."""


DISKS = 10_000
"""Disks of bricks times frequencies that are measured at most, some four seconds; of larger bricks one frequency is."""


@dataclass(frozen=True)
class Reflected:
    """Reflected over incident velocity of plane waves along the normal of a side.

    size : RMS over the frequencies of the case. dashpots : the part in phase, by the stiffness of dashpots alone,
    positive where they are too soft.
    """

    size: float
    dashpots: float

    @property
    def signed(self) -> float:
        """The size with the sign of the part in phase."""
        return math.copysign(self.size, self.dashpots)

    @property
    def out_of_phase(self) -> float:
        """Part of the size in quadrature to the dashpots, as reflected by excess mass at the side."""
        return math.sqrt(max(self.size**2 - self.dashpots**2, 0.0))


class Reflections:
    """Reflections by sides with dashpots, each measured once: on random bricks that takes seconds.

    Parameters
    ----------
    begins : is told in words what is measured, before; by default only looks for requests to end.
    """

    def __init__(self, begins: Callable[[str], None] = lambda what: look()) -> None:
        self._begins = begins
        self._measured: dict[tuple[object, ...], dict[Motion, float]] = {}

    def of(self, scene: DiskScene, side: str, time_step: float) -> dict[Motion, Reflected]:
        """Reflection of P and S waves along the normal by a side with dashpots, without its springs.

        Waves that cannot run are left out; where the packing has no such wave at the frequencies of the case, the
        reflection of its homogenised stiffness is given. Along several layers it is the mean of energies.
        """
        parts = media_of(scene, side)
        found = [(part.length, self._in_layer(scene, side, part, medium, time_step)) for part, medium in parts]
        if len(found) == 1:
            return found[0][1]
        return {motion: _mean([(length, each[motion]) for length, each in found]) for motion in found[0][1]}

    def _in_layer(
        self, scene: DiskScene, side: str, part: Edge, medium: BoundaryMedium, time_step: float
    ) -> dict[Motion, Reflected]:
        """Reflection by a part of a side beside one medium; see `of`."""
        case = scene.case.uniform_at(float(part.positions[:, 1].mean()))
        table = case.side(side).dashpots_alone()
        end = end_scene(replace(case, boundary={**case.boundary, side: table}), side)
        require_dashpots_alone(end, side)
        matched, wide = medium.matched(part), {m: homogenised_beta(end, side, m) for m in table.factors}
        own = scene.case.side(side).factors_at(part, medium)
        known = {motion: factor for motion, factor in own.items() if math.isfinite(matched[motion])}
        # sides of narrow bodies have more disks for their length than those of a periodic one
        equal = {motion: factor * wide[motion] / matched[motion] for motion, factor in known.items()}
        boundary = {**end.case.boundary, side: table.with_factors(equal).at_rest()}
        end = with_boundaries(end, replace(end.case, boundary=boundary))
        measured = self._energies(scene, end, side, time_step)
        found: dict[Motion, Reflected] = {}
        for motion, factor in known.items():
            simple = (matched[motion] - factor) / (matched[motion] + factor)
            size = math.sqrt(measured[motion]) if motion in measured else abs(simple)
            found[motion] = Reflected(min(size, 1.0), simple)
        return found

    def _energies(self, scene: DiskScene, end: DiskScene, side: str, time_step: float) -> dict[Motion, float]:
        """Shares of reflected energy, means over the case's frequencies; unknown ones are left out.

        On random packings in continuous time: steps change the amplitude by 1e-4, disks reflect a hundred times as
        much.
        """
        case = end.case
        step = time_step if case.packing.is_lattice else 0.0
        most = max(1, DISKS // len(scene.ground.brick.radii))
        frequencies = frequencies_of(scene.case, scene.ground, min(FREQUENCIES, most))
        packing = case.packing.model_copy(update={"origin": (0.0, 0.0)})
        key = side, step, *frequencies, *map(repr, (packing, case.materials, case.motion, case.side(side)))
        if key not in self._measured:
            self._measured[key] = self._measure(end, side, step, frequencies)
        return self._measured[key]

    def _measure(self, end: DiskScene, side: str, step: float, frequencies: np.ndarray) -> dict[Motion, float]:
        """Mean shares of reflected energy; empty where the side cannot be measured."""
        try:
            meter = Meter.of(side, step, end)
            found = meter.measure(
                frequencies, [0.0], report=lambda each: self._begins(f"reflection at the {side} side, {each:.3g} Hz")
            )[0]
        except CaseError:
            return {}
        totals = {kind: found.total(kind) for kind in found.kinds}
        means = {kind: float(np.nanmean(total)) for kind, total in totals.items() if np.isfinite(total).any()}
        return {kind: share for kind, share in means.items() if math.isfinite(share)}


def _mean(parts: Sequence[tuple[float, Reflected]]) -> Reflected:
    """The reflection of a side whose parts, of these lengths, reflect differently: RMS, with the mean part in phase."""
    lengths, each = zip(*parts, strict=True)
    size = math.sqrt(np.average([one.size**2 for one in each], weights=lengths))
    return Reflected(size, float(np.average([one.dashpots for one in each], weights=lengths)))


def factor_for(share: float) -> float:
    """β over the matched β with which dashpots reflect this share of the velocity."""
    return (1.0 - share) / (1.0 + share)


def sent_back(scene: DiskScene, side: str, motion: Motion, frequency: float, part: int = 0) -> float:
    """|R|, reflected over incident amplitude of plane waves along the normal of a side, at a frequency (Hz).

    From the impedances of dashpots, springs, and of the half of whole cells that lies beyond the last half of the
    packing, over the packing's impedance. At frequency nan of dashpots only. nan where the motion is held.
    part : number in `media_of`.
    """
    (edge, medium), held = media_of(scene, side)[part], Held.of(scene, side, part)
    axis = axis_of_motion(side, motion)
    own = medium.density * medium.running_speeds[0 if motion == "p" else 1]
    if not own > 0.0:
        return math.nan
    impedance = complex(held.damping[axis])
    if math.isfinite(frequency):
        omega = 2.0 * math.pi * frequency
        half = 0.0 if scene.case.side(side).half_cells else 0.5 * medium.density * float(edge.diameters.mean())
        impedance += 1j * omega * half - 1j * float(held.stiffness[axis]) / omega
    return abs(reflected(impedance / own, 1.0))
