"""Loose disks that fall over walls, in numpy alone, as a second program beside `dembound run`.

Linear springs, Coulomb's friction, resistance to rolling and dashpots, walls of segments, its own search for
neighbours, and the leapfrog.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

DENSITY, EMOD, KRATIO, FRIC, RR_FRIC, DP = 2000.0, 2e7, 2.0, 0.5, 1.0, 0.2
"""Of the material, SI units."""

GRAVITY, LIFT = 9.81, 20.0
"""Acceleration, m/s², and velocity of the gate, m/s."""

MOST = 10_000_000
"""More than there are disks, cells and segments: factor by which two numbers become one name."""


class Contacts(NamedTuple):
    """Pairs of disks near each other: first, second (p,), with the length of the contact at rest (m) and its memory.

    memory : (2, p), sliding (m) and rolling (rad) held by springs.
    """

    first: np.ndarray
    second: np.ndarray
    rest: np.ndarray
    memory: np.ndarray


class Program:
    """Disks over walls, in time.

    Parameters
    ----------
    packed : (2, n) m, where overlapping disks just touch. place : (2, n) m. radius : (n,) m. lines : of walls, (p, 2) m
    each, the last one the gate, which is smooth.
    pairs, shear : (b, 2) disks in contact at rest, and (b,) N on the first of each, a quarter turn from the way to the
    second.
    """

    def __init__(
        self,
        packed: np.ndarray,
        place: np.ndarray,
        radius: np.ndarray,
        lines: Sequence[np.ndarray],
        pairs: np.ndarray,
        shear: np.ndarray,
    ) -> None:
        self.packed, self.place, self.radius = packed, place.copy(), radius
        self.walls = np.concatenate([np.hstack([line[:-1], line[1:]]) for line in lines])
        number = np.repeat(np.arange(len(lines)), [len(line) - 1 for line in lines])
        self.number = np.arange(len(self.walls)) + number  # of the first vertex, so that walls share none
        self.velocity = np.zeros((3, len(radius)))
        self.mass = DENSITY * np.pi * radius**2
        self.inertia = 0.5 * self.mass * radius**2
        self.skin = 0.25 * radius.mean()
        key = np.sort(pairs, axis=1) @ [len(radius), 1]
        order = np.argsort(key)
        self.known = key[order], np.stack([shear[order] * KRATIO / EMOD, np.zeros(len(pairs))])
        self.on_walls = np.zeros(0, np.int64), np.zeros(0)
        self.list()

    def list(self) -> None:
        """List the pairs within the skin, with the memory that they have."""
        self.listed = self.place.copy()
        first, second = near(self.place, 2.0 * self.radius.max() + 2.0 * self.skin)
        first, second = np.minimum(first, second), np.maximum(first, second)
        key = first * len(self.radius) + second
        order = np.argsort(key)
        first, second, key = first[order], second[order], key[order]
        both = self.radius[first] + self.radius[second]
        rest = np.minimum(both, np.hypot(*(self.packed[:, second] - self.packed[:, first])))
        memory = remembered(*self.known, key)
        self.known = key, memory
        self.contacts = Contacts(first, second, rest, memory)
        ends = self.walls.T.reshape(2, 2, -1)
        reach = (self.radius + self.skin)[:, None]
        close = np.ones((len(self.radius), len(self.walls)), dtype=bool)
        for c in (0, 1):
            place, low, high = self.place[c][:, None], ends[:, c].min(axis=0), ends[:, c].max(axis=0)
            high[-1] = np.inf if c == 1 else high[-1]  # the gate is lifted
            close &= (place > low - reach) & (place < high + reach)
        self.disk, self.segment = np.nonzero(close)

    def advance(self, time: float, step: float) -> None:
        """One step (s) at a time (s)."""
        if np.max(np.hypot(*(self.place - self.listed))) > self.skin:
            self.list()
        force = np.zeros_like(self.velocity)
        force[1] = -GRAVITY * self.mass
        self._push_pairs(force, step)
        self._push_walls(force, time, step)
        self.velocity[:2] += step * force[:2] / self.mass
        self.velocity[2] += step * force[2] / self.inertia
        self.place += step * self.velocity[:2]

    def _push_pairs(self, force: np.ndarray, step: float) -> None:
        first, second, rest, memory = self.contacts
        way = self.place[:, second] - self.place[:, first]
        away = np.hypot(*way)
        overlap = rest - away
        closed = np.flatnonzero(overlap > 0.0)
        slid, rolled = memory[:, closed]
        memory[...] = 0.0
        i, j, overlap = first[closed], second[closed], overlap[closed]
        normal = way[:, closed] / away[closed]
        side = np.stack([-normal[1], normal[0]])
        moving = self.velocity[:2, j] - self.velocity[:2, i]
        turning = self.velocity[2]
        push = EMOD * overlap
        pair_mass = self.mass[i] * self.mass[j] / (self.mass[i] + self.mass[j])
        drag = -2.0 * DP * np.sqrt(pair_mass * EMOD) * (moving * normal).sum(axis=0)
        total = push + np.maximum(drag, -push)
        surface = (moving * side).sum(axis=0) - turning[i] * self.radius[i] - turning[j] * self.radius[j]
        stiff = EMOD / KRATIO
        slid = np.clip(slid + step * surface, -FRIC * push / stiff, FRIC * push / stiff)
        arm = self.radius[i] * self.radius[j] / (self.radius[i] + self.radius[j])
        limit = RR_FRIC * push / (stiff * arm)
        rolled = np.clip(rolled + step * (turning[j] - turning[i]), -limit, limit)
        memory[:, closed] = slid, rolled
        pull = -total * normal + stiff * slid * side
        moment = stiff * arm**2 * rolled
        for c in (0, 1):
            force[c] += np.bincount(i, pull[c], len(self.radius)) - np.bincount(j, pull[c], len(self.radius))
        shear = stiff * slid
        force[2] += np.bincount(i, self.radius[i] * shear + moment, len(self.radius))
        force[2] += np.bincount(j, self.radius[j] * shear - moment, len(self.radius))

    def _push_walls(self, force: np.ndarray, time: float, step: float) -> None:
        """Faces push; a vertex only if neither of its segments does; a contact is known by its segment or vertex."""
        disk, segment = self.disk, self.segment
        gate = segment == len(self.walls) - 1
        ends = self.walls[segment].T.copy()
        ends[1::2, gate] += LIFT * time
        along = ends[2:] - ends[:2]
        where = ((self.place[:, disk] - ends[:2]) * along).sum(axis=0) / (along**2).sum(axis=0)
        way = self.place[:, disk] - ends[:2] - np.clip(where, 0.0, 1.0) * along
        away = np.hypot(*way)
        overlap = self.radius[disk] - away
        touching = np.flatnonzero((overlap > 0.0) & (away > 0.0))
        is_face = ((where > 0.0) & (where < 1.0))[touching]
        own = MOST * disk[touching] + self.number[segment[touching]]
        vertex, faces = own + (where[touching] >= 1.0), own[is_face]
        keep = is_face | ~(np.isin(vertex, faces) | np.isin(vertex - 1, faces))
        names = 2 * np.where(is_face, own, vertex) + ~is_face
        names, chosen = np.unique(names[keep], return_index=True)  # a vertex is of two segments
        kept = touching[keep][chosen]
        slid = remembered(*self.on_walls, names)
        i, normal = disk[kept], way[:, kept] / away[kept]
        side = np.stack([-normal[1], normal[0]])
        moving = self.velocity[:2, i] - np.stack([np.zeros(len(kept)), np.where(gate[kept], LIFT, 0.0)])
        push = 2.0 * EMOD * overlap[kept]
        drag = -2.0 * DP * np.sqrt(self.mass[i] * 2.0 * EMOD) * (moving * normal).sum(axis=0)
        drag[gate[kept]] = 0.0
        most = np.where(gate[kept], 0.0, FRIC) * push / (2.0 * EMOD / KRATIO)
        surface = (moving * side).sum(axis=0) - self.velocity[2, i] * self.radius[i]
        slid = np.clip(slid + step * surface, -most, most)
        self.on_walls = names, slid
        shear = 2.0 * EMOD / KRATIO * slid
        pull = (push + np.maximum(drag, -push)) * normal - shear * side
        for c in (0, 1):
            force[c] += np.bincount(i, pull[c], len(self.radius))
        force[2] += np.bincount(i, self.radius[i] * shear, len(self.radius))


def remembered(names: np.ndarray, values: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Values (…, w) of the wanted names, of ascending ones (k,) with values (…, k); 0 for others."""
    if len(names) == 0:
        return np.zeros((*values.shape[:-1], len(wanted)))
    at = np.minimum(np.searchsorted(names, wanted), len(names) - 1)
    return np.where(names[at] == wanted, values[..., at], 0.0)


def near(place: np.ndarray, reach: float) -> tuple[np.ndarray, np.ndarray]:
    """Pairs of places (2, n) m nearer than `reach` (m), each once, by cells of that size."""
    cell = np.floor(place / reach).astype(np.int64)
    key = cell[0] * MOST + cell[1]
    order = np.argsort(key)
    ordered, pairs = key[order], []
    for across, up in ((0, 0), (0, 1), (1, -1), (1, 0), (1, 1)):
        wanted = key + across * MOST + up
        low, high = (np.searchsorted(ordered, wanted, side=side) for side in ("left", "right"))
        count = high - low
        first = np.repeat(np.arange(len(key)), count)
        second = order[np.repeat(low, count) + np.arange(len(first)) - np.repeat(np.cumsum(count) - count, count)]
        pairs.append(np.stack([first, second])[:, first < second if (across, up) == (0, 0) else slice(None)])
    first, second = np.concatenate(pairs, axis=1)
    close = np.hypot(*(place[:, first] - place[:, second])) < reach
    return first[close], second[close]
