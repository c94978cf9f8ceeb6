"""The bonds of a bar, which methods create and change.

Local springs join neighbours, peridynamic bonds join nodes in zones. The coverage of a plane between two nodes is the
share of the stress that bonds carry across it; a local spring there carries the rest, 1 − coverage. So any zone can be
combined with local springs: forces act in pairs, and the seam disturbs neither rest nor uniform strain. Bonds join
nodes of the same range; at a bonded interface local springs carry what bonds across it would.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from dembound.laws.peridynamic import Family, damage, families
from dembound.methods.opening import RISE, Opening
from dembound.methods.rod import Range, Rod

if TYPE_CHECKING:
    from dembound.kernels.tables import BarBonds

_EVOLVING = ("spring", "bond", "spring_broken", "bond_broken", "spring_limit", "triggers", "closed")
"""Names of the arrays of bonds that change."""

TINY = 1e-12
"""Tolerance in comparisons of coverage, for rounding."""


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
    are the arrays of kernels.tables.BarBonds. closed : (c,) whether each contact has ever been closed. opening : the
    bonds that open, in a bar with a fracture energy. zones : (first, one beyond last) node of every zone, from left to
    right.
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
        self.opening = Opening(rod.ranges, rod.count, horizon)
        self.trigger_ratio = min(trigger_ratio, RISE) if self.opening.has_rates else trigger_ratio
        self.zones: list[tuple[int, int]] = []
        self.influence = influence
        self._rows = rod.bond_rows(horizon, influence)
        planes = rod.count - 1
        self.spring = rod.springs.copy()
        self.bond = np.zeros_like(self._rows)
        self.spring_broken = np.full(planes, -1)
        self.bond_broken = np.full(self.bond.shape, -1)
        self.spring_limit = np.zeros(planes)
        self.triggers = np.ones(planes, dtype=np.bool_)
        self.closed = np.zeros(len(rod.touching), dtype=np.bool_)
        self._most_carried = self._carried_share(self._rows)
        self._set_limits(np.zeros(planes))

    def add_zone(self, first: int, last: int) -> None:
        """Make nodes first to last − 1 a zone of peridynamics, joined with adjacent zones and with near ends.

        A zone ends where its range does; one that extends over several ranges becomes a zone in each.
        """
        opened = self.opening.of(self.spring, self.bond)
        for part in self.rod.ranges:
            low, high = max(part.first, first), min(part.last + 1, last)
            if low < high - 1:
                self._add_zone(part, low, high)
        carried = self._carried_share(np.where(self.laid, self._rows, 0.0))
        left = np.where(self._complemented, 1.0 - carried, carried == 0.0)
        left[(np.abs(left) < TINY) | (self.spring_broken >= 0)] = 0.0
        self.spring[:] = self.rod.springs * left
        self.opening.put(opened, self.spring, self.bond)
        self._set_limits(carried)

    def _add_zone(self, part: Range, first: int, last: int) -> None:
        """Make nodes first to last − 1 of a range a zone with bonds."""
        first = part.first if first - part.first <= self.horizon else first  # no remainder shorter than a family
        last = part.last + 1 if part.last + 1 - last <= self.horizon else last
        here = [(a, b) for a, b in self.zones if part.first <= a and b - 1 <= part.last]
        touching = [(a, b) for a, b in here if b >= first and a <= last]
        zone = (min([first, *(a for a, _ in touching)]), max([last, *(b for _, b in touching)]))
        self.zones = sorted([*(other for other in self.zones if other not in touching), zone])
        for row in range(self.horizon):
            chosen = slice(zone[0], max(zone[0], zone[1] - row - 1))
            whole = self.bond_broken[row, chosen] < 0
            self.bond[row, chosen] = np.where(whole, self._rows[row, chosen], 0.0)

    @cached_property
    def _complemented(self) -> np.ndarray:
        """Planes (n − 1,) where springs carry the rest of the stress: all, or those near springs beyond the ends."""
        chosen = np.full(self.rod.count - 1, self.complement)
        for left, right in self.rod.bonded:
            chosen[max(left.first, left.last - self.horizon) : min(right.last, right.first + self.horizon)] = True
        for near in self._near_springs_beyond():
            chosen[near] = True
        return chosen

    def _near_springs_beyond(self) -> Iterator[slice]:
        """The planes near ends beyond which a layer has local springs."""
        left, right = self.rod.end("left"), self.rod.end("right")
        if left.beyond[0] == 1:
            yield slice(left.first, min(left.last, left.first + self.horizon))
        if right.beyond[1] == 1:
            yield slice(max(right.first, right.last - self.horizon), right.last)

    def shares(self, part: Range) -> tuple[float, ...]:
        """Shares of the stress under uniform strain that bonds of one, two … spacings carry in the middle of a range.

        Local springs have one spacing. There are as many shares as the longest bonds there have spacings; see
        `exact.bar.Lattice`.
        """
        middle = part.first + (part.cells + 1) // 2
        stiffness = np.zeros(max(self.horizon, 1))
        stiffness[: self.horizon] = self.bond[:, middle - self.horizon // 2] if self.horizon else 0.0
        stiffness[0] += self.spring[middle]
        shares = stiffness * np.arange(1, len(stiffness) + 1) ** 2 / part.spring
        return tuple(np.trim_zeros(shares, "b").tolist())

    def soften_ends(self) -> None:
        """Halve the springs at all ends, as half volumes do in peridynamics with m = 1.

        Bonded interfaces, and ends with a layer beyond, are left out.
        """
        bonded = {left.last for left, _ in self.rod.bonded}
        for part in self.rod.ranges:
            planes = (part.first, part.first), (part.last, part.last - 1)
            for (node, plane), reach in zip(planes, part.beyond, strict=True):
                self.spring[plane] *= 1.0 if node in bonded or reach > 0 else 0.5

    def triggered(self, u: np.ndarray) -> np.ndarray:
        """Springs (a,) that trigger the method at displacements u (n,) m."""
        return np.flatnonzero(self.triggers & (self.spring > 0.0) & (np.diff(u) >= self.spring_limit))

    def stop_triggering(self) -> None:
        """Break springs at the critical stretch from now on, without calling the method."""
        self.triggers[:] = False
        self.spring_limit[:] = self.rod.elongation

    @property
    def laid(self) -> np.ndarray:
        """(m, n) which bonds exist or have existed."""
        return (self.bond > 0.0) | (self.bond_broken >= 0)

    @property
    def springs(self) -> np.ndarray:
        """Mask (n − 1,) of local springs with stiffness, now or under compression as in cracks of a fracture energy."""
        opened = np.zeros_like(self.spring)
        self.opening.put(np.ones(len(self.opening)), opened, np.zeros_like(self.bond))
        return (self.spring > 0.0) | (opened > 0.0)

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

        A local spring replaces the bonds that are left out on its side of a node. Opening bonds count with the
        remaining share of their fracture energy.
        """
        springs, bonds = self._left(step)
        first, second = self._family.pairs.T
        row = self._family.apart - 1
        left = np.column_stack([springs[first], springs[second - 1]])
        if self.horizon > 0:
            laid = self.laid[row, first]
            left[laid] = bonds[row, first][laid, None]
        volumes = self.rod.volumes[self._family.pairs[:, ::-1]]
        stiffness = self._rows[row, first] if self.horizon > 0 else self.rod.springs[first]
        factor = self._family.factor * (stiffness > 0.0)  # those without stiffness are no bonds and do not break
        return damage(self._family.pairs, factor[:, None] * volumes, left, self.rod.count)

    def breaks(self, since: int) -> tuple[np.ndarray, np.ndarray]:
        """Bonds that broke in step `since` or later: steps (b,) and pairs of nodes (b, 2), in order of the steps."""
        planes = np.flatnonzero(self.spring_broken >= since)
        rows, first = np.nonzero(self.bond_broken >= since)
        steps = np.concatenate([self.spring_broken[planes], self.bond_broken[rows, first]])
        pairs = np.concatenate([np.stack([planes, planes + 1], axis=1), np.stack([first, first + rows + 1], axis=1)])
        order = np.argsort(steps, kind="stable")
        return steps[order], pairs[order]

    def begun(self) -> tuple[np.ndarray, np.ndarray]:
        """Bonds that broke or began to open so far: steps (b,) and pairs of nodes (b, 2)."""
        if len(self.opening) == 0:
            return self.breaks(0)
        first = self.opening["first"]
        return self.opening["began"], np.stack([first, first + np.maximum(self.opening["row"] + 1, 1)], axis=1)

    def saved_arrays(self) -> dict[str, np.ndarray]:
        """All arrays that change during a run, by name."""
        kept = {name: getattr(self, name) for name in _EVOLVING}
        return kept | self.opening.saved_arrays() | {"zones": np.array(self.zones, dtype=np.int64).reshape(-1, 2)}

    def restore(self, saved: Mapping[str, np.ndarray]) -> None:
        """Restore the arrays returned by `saved_arrays` for the same bar."""
        for name in _EVOLVING:
            getattr(self, name)[...] = saved[name]
        self.opening.restore(saved)
        self.zones = [(int(first), int(last)) for first, last in saved["zones"]]

    def arrays(self, supported: np.ndarray, step: float, through: np.ndarray | None = None) -> BarBonds:
        """All arrays for the kernels; supported (k,) are nodes that the support table moves; step Δt in s.

        through : of layers beyond the ends, see kernels.tables.BarLayers.
        """
        from dembound.kernels.tables import BarBonds, BarContacts

        rod = self.rod
        plain, mixed = self._runs(supported)
        parts = [next(part for part in rod.ranges if first < part.last) for first, _ in plain]
        of_zones = [next(part for part in rod.ranges if last - 1 <= part.last) for _, last in self.zones]
        lengths = np.arange(1, self.horizon + 1)
        rest = 0.5 * rod.drag_rate * step
        keep = (1.0 - rest) / (1.0 + rest)
        push = step / np.array([part.density * part.section * part.spacing for part in parts])
        mobility = step / rod.mass
        mobility[supported] = 0.0
        touching = rod.touching
        contacts = BarContacts(
            left=np.array([left.last for left, _ in touching], dtype=np.int64),
            gap=np.array([right.gap for _, right in touching], dtype=np.float64),
            closed=self.closed,
            before=np.zeros(len(touching)),
            push=np.zeros(len(touching)),
        )
        return BarBonds(
            spring=self.spring,
            spring_limit=self.spring_limit,
            triggers=self.triggers,
            bond=self.bond,
            bond_limit=np.outer([part.elongation for part in of_zones], lengths),
            spring_broken=self.spring_broken,
            bond_broken=self.bond_broken,
            zones=np.array(self.zones, dtype=np.int64).reshape(-1, 2),
            plain=plain,
            plain_push=(0.5 * (1.0 + keep[plain[:, 0]])) * push * np.array([part.spring for part in parts]),
            plain_keep=keep[plain[:, 0]],
            plain_limit=self.trigger_ratio * np.array([part.elongation for part in parts]),
            mixed=mixed,
            mixed_keep=keep[mixed[:, 0]],
            sections=rod.sections,
            mobility=(0.5 * (1.0 + keep)) * mobility,
            drag=rod.drag_rate * rod.mass if rod.drag_rate.any() else np.zeros(0),
            contacts=contacts,
            through=np.zeros(0) if through is None else through,
            space=np.zeros(rod.count + self.horizon + 1),
            mean=np.zeros(rod.count),
            before=np.empty(len(supported)),
            reached=np.zeros(1, dtype=np.int64),
            softening=self.opening.bundle,
        )

    def _runs(self, supported: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Runs of plain nodes (r, 2), and of other nodes (q, 3) with a flag for springs; each in one range.

        A node that two ranges share, or at which one begins or ends, is not plain.
        """
        count = self.rod.count
        whole = (self.spring == self.rod.springs) & self.triggers
        plain, begins = np.zeros(count, dtype=np.bool_), np.zeros(count + 1, dtype=np.bool_)
        plain[1:-1] = whole[:-1] & whole[1:]
        plain[supported] = False
        for part in self.rod.ranges:
            plain[[part.first, part.last]] = False
            begins[[part.first, part.first + 1]] = part.first > 0
        for first, last in self.zones:
            plain[first:last] = False
            begins[[first, last]] = True
        begins[[0, -1]] = True
        begins[1:-1] |= plain[1:] != plain[:-1]
        edges = np.flatnonzero(begins)
        runs, is_plain = np.stack([edges[:-1], edges[1:]], axis=1), plain[edges[:-1]]
        springs = self.springs
        held = [springs[max(0, first - 1) : last].any() for first, last in runs]
        return runs[is_plain], np.column_stack([runs, held])[~is_plain].astype(np.int64)

    def _left(self, step: int | None) -> tuple[np.ndarray, np.ndarray]:
        """Share (n − 1,) and (m, n) of springs and bonds that was left at the end of a step, by default the last."""
        last = np.iinfo(np.int64).max if step is None else step
        springs, bonds = (((b < 0) | (b > last)).astype(float) for b in (self.spring_broken, self.bond_broken))
        if step is None:
            self.opening.put(self.opening.left, springs, bonds)
        return springs, bonds

    @cached_property
    def _family(self) -> Family:
        """The nodes' families, of one spacing without a horizon."""
        return families(self.rod.count, max(self.horizon, 1))

    def _carried_share(self, rows: np.ndarray) -> np.ndarray:
        """Share (n − 1,) of the stress under uniform strain that bonds of stiffness rows (m, n) carry across planes."""
        carried = np.zeros(self.rod.count - 1)
        for part in self.rod.ranges:
            carried[part.planes] = part.carried_share(rows[:, part.nodes]) + part.carried_beyond(self.influence)
        return carried

    def _set_limits(self, carried: np.ndarray) -> None:
        """Set which springs trigger the method, and the largest elongation of each."""
        self.triggers[:] = (carried < self._most_carried - TINY) | (self.horizon == 0)
        self.spring_limit[:] = np.where(self.triggers, self.trigger_ratio, 1.0) * self.rod.elongation
