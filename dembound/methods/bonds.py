"""The bonds of a bar, which methods create and change.

Local springs join neighbours, peridynamic bonds join nodes in zones. The coverage of a plane between two nodes is the
share of the stress that bonds carry across it; a local spring there carries the rest, 1 − coverage. So any zone can be
combined with local springs: forces act in pairs, and rest and uniform strain are not disturbed at the seam.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from dembound.errors import CaseError
from dembound.laws.peridynamic import Family, damage, families, micromodulus

if TYPE_CHECKING:
    from dembound.kernels.tables import BarBonds

_EVOLVING = ("spring", "bond", "spring_broken", "bond_broken", "spring_limit", "triggers")
"""The arrays of bonds that change."""

TINY = 1e-12
"""Tolerance in comparisons of coverage, for rounding."""


@dataclass(frozen=True)
class Rod:
    """The data of a bar for methods: n nodes, spacing m, section m², Young's modulus Pa, critical stretch.

    Nodes at the ends have half the volume of the others.
    """

    count: int
    spacing: float
    section: float
    modulus: float
    critical_stretch: float

    @property
    def spring(self) -> float:
        """Stiffness EA/Δx of a whole local spring, N/m."""
        return self.modulus * self.section / self.spacing

    @cached_property
    def volumes(self) -> np.ndarray:
        """(n,) m³."""
        volumes = np.full(self.count, self.section * self.spacing)
        volumes[[0, -1]] *= 0.5
        return volumes

    def bond_rows(self, horizon: int, influence: np.ndarray | None = None) -> np.ndarray:
        """Stiffness (m, n) N/m of all possible peridynamic bonds: c_m V_i V_{i+p} w_p/(pΔx) (L eqs 4, 8 and 9).

        Row p − 1 has the bonds between i and i + p. influence : (m,) factors of the micromodulus c_m by length of the
        bonds, scaled to keep Young's modulus; by default equal for all.

        Raises CaseError for a negative influence, and where all are zero.
        """
        rows = np.zeros((horizon, self.count))
        if horizon > 0:
            family = families((self.count,), horizon)
            (first, second), apart = family.pairs.T, family.offset[:, 0]
            c_m = micromodulus(self.modulus, horizon * self.spacing, 1, self.section)
            both = self.volumes[first] * self.volumes[second]
            rows[apart - 1, first] = c_m * both * family.factor / (apart * self.spacing)
        if influence is not None:
            if np.min(influence) < 0.0 or not np.max(influence) > 0.0:
                raise CaseError(["method: gives no bond a stiffness above 0, take a larger horizon"])
            rows *= np.reshape(influence, (horizon, 1)) * (1.0 / _influenced(horizon, influence))
        return rows


def _influenced(horizon: int, influence: np.ndarray) -> float:
    """Young's modulus over the bar's own when the micromodulus is multiplied by influence (m,)."""
    weights = np.arange(1.0, horizon + 1.0)
    weights[-1] *= 0.5  # half of an outermost node's volume lies within the horizon
    return float(np.sum(np.asarray(influence) * weights) / weights.sum())


class Bonds:
    """Local springs and peridynamic bonds of a bar, at first only local springs.

    Parameters
    ----------
    rod : the bar.
    horizon : m of the zones; 0: without zones, springs trigger at the critical stretch. complement : whether local
    springs carry the rest of the stress; else a plane has either springs or bonds. trigger_ratio : share of the
    critical stretch at which local springs trigger the method. influence : (m,) factors of the micromodulus by length
    of the bonds, see `Rod.bond_rows`.

    Attributes
    ----------
    spring, spring_limit, triggers, spring_broken : (n − 1,) of local springs, bond, bond_broken : (m, n) of bonds; they
    are the arrays of kernels.tables.BarBonds. zones : (first, one beyond last) node of every zone, from left to right.
    """

    def __init__(
        self,
        rod: Rod,
        horizon: int,
        *,
        complement: bool = True,
        trigger_ratio: float = 1.0,
        influence: np.ndarray | None = None,
    ) -> None:
        self.rod = rod
        self.horizon = horizon
        self.complement = complement
        self.trigger_ratio = trigger_ratio
        self.zones: list[tuple[int, int]] = []
        self._rows = rod.bond_rows(horizon, influence)
        planes = rod.count - 1
        self.spring = np.full(planes, rod.spring)
        self.bond = np.zeros_like(self._rows)
        self.spring_broken = np.full(planes, -1)
        self.bond_broken = np.full(self.bond.shape, -1)
        self.spring_limit = np.zeros(planes)
        self.triggers = np.ones(planes, dtype=np.bool_)
        self._most_carried = self._carried_share(self._rows)
        self._set_limits(np.zeros(planes))

    def add_zone(self, first: int, last: int) -> None:
        """Make nodes first to last − 1 a zone of peridynamics, joined with adjacent zones and with near ends."""
        first, last = max(0, first), min(self.rod.count, last)
        first = 0 if first <= self.horizon else first  # no remainder shorter than a family is left at an end
        last = self.rod.count if self.rod.count - last <= self.horizon else last
        apart = [zone for zone in self.zones if zone[1] < first or zone[0] > last]
        joined = [zone for zone in self.zones if zone not in apart]
        zone = (min([first, *(a for a, _ in joined)]), max([last, *(b for _, b in joined)]))
        self.zones = sorted([*apart, zone])
        for row in range(self.horizon):
            chosen = slice(zone[0], max(zone[0], zone[1] - row - 1))
            whole = self.bond_broken[row, chosen] < 0
            self.bond[row, chosen] = np.where(whole, self._rows[row, chosen], 0.0)
        carried = self._carried_share(np.where(self.laid, self._rows, 0.0))
        left = 1.0 - carried if self.complement else (carried == 0.0).astype(float)
        left[(np.abs(left) < TINY) | (self.spring_broken >= 0)] = 0.0
        self.spring[:] = self.rod.spring * left
        self._set_limits(carried)

    @property
    def shares(self) -> tuple[float, ...]:
        """Shares of the stress under uniform strain that bonds of one, two … spacings carry in the middle of the bar.

        Local springs have one spacing. Their number is the length of the longest bonds there; see
        `exact.dispersion.Lattice`.
        """
        middle = self.rod.count // 2
        stiffness = np.zeros(max(self.horizon, 1))
        stiffness[: self.horizon] = self.bond[:, middle - self.horizon // 2] if self.horizon else 0.0
        stiffness[0] += self.spring[middle]
        shares = stiffness * np.arange(1, len(stiffness) + 1) ** 2 / self.rod.spring
        return tuple(np.trim_zeros(shares, "b").tolist())

    def soften_ends(self) -> None:
        """Halve the springs at both ends, as half volumes do in peridynamics with m = 1."""
        self.spring[[0, -1]] *= 0.5

    def triggered(self, u: np.ndarray) -> np.ndarray:
        """Springs (a,) that trigger the method at displacements u (n,) m."""
        return np.flatnonzero(self.triggers & (self.spring > 0.0) & (np.diff(u) >= self.spring_limit))

    def stop_triggering(self) -> None:
        """From now on break springs at the critical stretch without calling the method."""
        self.triggers[:] = False
        self.spring_limit[:] = self._elongation

    @property
    def laid(self) -> np.ndarray:
        """(m, n) which bonds exist or have existed."""
        return (self.bond > 0.0) | (self.bond_broken >= 0)

    @property
    def alive(self) -> int:
        """Number of intact springs and bonds."""
        return int(np.count_nonzero(self.spring)) + int(np.count_nonzero(self.bond))

    def stiffness(self) -> np.ndarray:
        """The bar's stiffness matrix in N/m as lower bands (max(m, 1) + 1, n): row d has the entries K[i + d, i]."""
        bands = np.zeros((max(self.horizon, 1) + 1, self.rod.count))
        bands[1, :-1] -= self.spring
        bands[1 : self.horizon + 1] -= self.bond
        for d, band in enumerate(bands[1:], start=1):
            bands[0, :-d] -= band[:-d]
            bands[0, d:] -= band[:-d]
        return bands

    def damage(self, step: int | None = None) -> np.ndarray:
        """Local damage φ (n,) at the end of a step, by default the last (L eq. 7).

        A local spring replaces the bonds that are left out on its side of a node.
        """
        last = np.iinfo(np.int64).max if step is None else step
        first, second = self._family.pairs.T
        row = self._family.offset[:, 0] - 1
        whole = (self.spring_broken < 0) | (self.spring_broken > last)
        intact = np.column_stack([whole[first], whole[second - 1]])
        if self.horizon > 0:
            broken = self.bond_broken[row, first]
            laid = self.laid[row, first]
            intact[laid] = ((broken < 0) | (broken > last))[laid, None]
        volumes = self.rod.volumes[self._family.pairs[:, ::-1]]
        factor = self._family.factor
        if self.horizon > 0:
            factor = factor * (self._rows[row, first] > 0.0)  # those without stiffness are no bonds and do not break
        return damage(self._family.pairs, factor[:, None] * volumes, intact, self.rod.count)

    def breaks(self, since: int) -> tuple[np.ndarray, np.ndarray]:
        """What broke in step `since` or later: steps (b,) and pairs of nodes (b, 2), in the order of the steps."""
        planes = np.flatnonzero(self.spring_broken >= since)
        rows, first = np.nonzero(self.bond_broken >= since)
        steps = np.concatenate([self.spring_broken[planes], self.bond_broken[rows, first]])
        pairs = np.concatenate([np.stack([planes, planes + 1], axis=1), np.stack([first, first + rows + 1], axis=1)])
        order = np.argsort(steps, kind="stable")
        return steps[order], pairs[order]

    def memory(self) -> dict[str, np.ndarray]:
        """All arrays that change during a run, by name."""
        kept = {name: getattr(self, name) for name in _EVOLVING}
        return kept | {"zones": np.array(self.zones, dtype=np.int64).reshape(-1, 2)}

    def recall(self, memory: Mapping[str, np.ndarray]) -> None:
        """Restore what `memory` has returned for the same bar."""
        for name in _EVOLVING:
            getattr(self, name)[...] = memory[name]
        self.zones = [(int(first), int(last)) for first, last in memory["zones"]]

    def arrays(self, supported: np.ndarray, density: float, step: float, drag_rate: float = 0.0) -> BarBonds:
        """All arrays for the kernels.

        supported (k,) are nodes that the support table moves; density kg/m³; step Δt in s; drag_rate 1/s of dashpots
        that attenuate, see case.bar.bar.Bar.
        """
        from dembound.kernels.tables import BarBonds

        plain, mixed = self._ranges(supported)
        part = 0.5 * drag_rate * step
        keep = (1.0 - part) / (1.0 + part)
        mass = density * self.rod.volumes
        mobility = step / mass
        mobility[supported] = 0.0
        whole = step / (density * self.rod.section * self.rod.spacing)
        return BarBonds(
            spring=self.spring,
            spring_limit=self.spring_limit,
            triggers=self.triggers,
            bond=self.bond,
            bond_limit=np.arange(1, self.horizon + 1) * self._elongation,
            spring_broken=self.spring_broken,
            bond_broken=self.bond_broken,
            plain=plain,
            plain_push=(0.5 * (1.0 + keep)) * whole * self.rod.spring,
            plain_limit=self.trigger_ratio * self._elongation,
            mixed=mixed,
            section=self.rod.section,
            mobility=(0.5 * (1.0 + keep)) * mobility,
            keep=keep,
            drag=drag_rate * mass if drag_rate > 0.0 else np.zeros(0),
            space=np.zeros(self.rod.count + self.horizon + 1),
            mean=np.zeros(self.rod.count),
            before=np.empty(len(supported)),
            reached=np.zeros(1, dtype=np.int64),
        )

    def _ranges(self, supported: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Ranges of plain nodes (r, 2); others (q, 4), with number of bond lengths and whether there are springs."""
        mixed, plain_spring = 1, (self.spring == self.rod.spring) & self.triggers
        label = np.full(self.rod.count, mixed)
        label[1:-1][plain_spring[:-1] & plain_spring[1:]] = 0
        label[supported] = mixed
        for number, (first, last) in enumerate(self.zones, start=mixed + 1):
            label[first:last] = number
        edges = np.concatenate([[0], np.flatnonzero(np.diff(label)) + 1, [self.rod.count]])
        runs = np.stack([edges[:-1], edges[1:], label[edges[:-1]]], axis=1)
        plain, others = runs[runs[:, 2] == 0, :2], runs[runs[:, 2] > 0]
        lengths = np.where(others[:, 2] > mixed, self.horizon, 0)
        held = [self.spring[max(0, first - 1) : last].any() for first, last, _ in others]
        return np.ascontiguousarray(plain), np.column_stack([others[:, :2], lengths, held]).astype(np.int64)

    @cached_property
    def _family(self) -> Family:
        """The nodes' families, of one spacing without a horizon."""
        return families((self.rod.count,), max(self.horizon, 1))

    @property
    def _elongation(self) -> float:
        """Elongation (m) of a spring at the critical stretch."""
        return self.rod.critical_stretch * self.rod.spacing

    def _carried_share(self, rows: np.ndarray) -> np.ndarray:
        """Share (n − 1,) of the stress under uniform strain that bonds of stiffness rows (m, n) carry across planes."""
        through = np.zeros(self.rod.count)
        for p, row in enumerate(rows, start=1):
            through += np.convolve(row * p * self.rod.spacing, np.ones(p))[: self.rod.count]  # p of them cross a plane
        return through[:-1] / (self.rod.modulus * self.rod.section)

    def _set_limits(self, carried: np.ndarray) -> None:
        """Set which springs trigger the method, and the largest elongation of each."""
        self.triggers[:] = (carried < self._most_carried - TINY) | (self.horizon == 0)
        self.spring_limit[:] = np.where(self.triggers, self.trigger_ratio, 1.0) * self._elongation
