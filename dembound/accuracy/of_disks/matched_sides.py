"""Reflection of plane waves along the normal of a side by its dashpots, on the packing of a case, without a run.

A coarser lattice with dashpots of half cells reflects (β0 − β)/(β0 + β) of such waves, next to nothing at β0. It gets
the β with which it reflects as much as the side of the case, whose reflection is due to random packings, single rows of
whole cells, and factors that are not calibrated.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from dembound.accuracy.watch import begins
from dembound.boundaries import Motion
from dembound.disks.beyond.frequencies import frequencies_of
from dembound.disks.matching import factors_in, homogenised_beta, require_dashpots_alone
from dembound.disks.reflection.bricks import end_scene
from dembound.disks.reflection.meter import Meter
from dembound.disks.scene import DiskScene, with_boundaries
from dembound.errors import CaseError

FREQUENCIES = 3
"""Number of frequencies of the case's waves, of equal energy each, over which energies are averaged."""

_MEASURED: dict[tuple[object, ...], dict[Motion, float]] = {}
"""Energies found in this process: on random bricks they take seconds, and choices differ in few of their sides."""


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


def reflected(scene: DiskScene, side: str, time_step: float) -> dict[Motion, Reflected]:
    """Reflection of P and S waves along the normal by a side with dashpots, without its springs.

    Waves that cannot run are left out; where the packing has no such wave at the frequencies of the case, the
    reflection of its homogenised stiffness is given.
    """
    case = scene.case
    table = case.side(side).dashpots_alone()
    end = end_scene(replace(case, boundary={**case.boundary, side: table}), side)
    require_dashpots_alone(end, side)
    matched, wide = ({m: homogenised_beta(each, side, m) for m in table.factors} for each in (scene, end))
    known = {motion: factor for motion, factor in factors_in(scene, side).items() if math.isfinite(matched[motion])}
    # sides of narrow bodies have more disks for their length than those of a periodic one
    equal = {motion: factor * wide[motion] / matched[motion] for motion, factor in known.items()}
    end = with_boundaries(
        end, replace(end.case, boundary={**end.case.boundary, side: table.with_factors(equal).at_rest()})
    )
    measured = _energies(scene, end, side, time_step)
    found: dict[Motion, Reflected] = {}
    for motion, factor in known.items():
        simple = (matched[motion] - factor) / (matched[motion] + factor)
        size = math.sqrt(measured[motion]) if motion in measured else abs(simple)
        found[motion] = Reflected(min(size, 1.0), simple)
    return found


def _energies(scene: DiskScene, end: DiskScene, side: str, time_step: float) -> dict[Motion, float]:
    """Shares of reflected energy, means over the case's frequencies; unknown ones are left out.

    On random packings in continuous time: steps change the amplitude by 1e-4, disks reflect a hundred times as much.
    """
    case = end.case
    step = time_step if case.packing.is_lattice else 0.0
    frequencies = frequencies_of(scene.case, scene.ground, FREQUENCIES)
    packing = case.packing.model_copy(update={"origin": (0.0, 0.0)})
    key = side, step, *frequencies, *map(repr, (packing, case.material, case.motion, case.side(side)))
    if key not in _MEASURED:
        _MEASURED[key] = _measured(end, side, step, frequencies)
    return _MEASURED[key]


def _measured(end: DiskScene, side: str, step: float, frequencies: np.ndarray) -> dict[Motion, float]:
    """Mean shares of reflected energy; empty where the side cannot be measured."""
    try:
        meter = Meter.of(side, step, end)
        found = meter.measure(
            frequencies, [0.0], report=lambda each: begins(f"reflection at the {side} side, {each:.3g} Hz")
        )[0]
    except CaseError:
        return {}
    means = {kind: float(np.nanmean(found.total(kind))) for kind in found.kinds if np.isfinite(found.total(kind)).any()}
    return {kind: share for kind, share in means.items() if math.isfinite(share)}


def factor_for(share: float) -> float:
    """β over the matched β with which dashpots reflect this share of the velocity."""
    return (1.0 - share) / (1.0 + share)
