"""Debris: the mass that has moved, how far it has run out, the pieces that have come off, and when all is at rest.

The moved mass are the disks of the body more than a mean diameter from where they were at the start of the run, without
those that have fallen out of the scene (`watches.far_below`). The fragments are the pieces that intact bonds hold
together and no side holds.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from dembound.disks.scene import DiskScene
from dembound.disks.watches import far_below
from dembound.motion.endings import RestRule
from dembound.motion.trackers import Every, Run

LEAST = 100
"""Disks that must have gone to a side for a run-out there: of fewer, 1 % is no disk or the farthest one alone."""

WAYS = {"left": -1.0, "right": 1.0}
"""Signs of x on the way to a side."""

RUN_OUT = {"x95": "m", "x99": "m", "angle": "degrees"}
"""Numbers of a run-out, with their units."""

AT_REST = 1e-3
"""Kinetic energy over that of the fall below which debris is at rest."""

STEPS = 256
"""Steps between two looks at the kinetic energy, at which the loop returns anyway."""


def pieces(count: int, pairs: np.ndarray, broken: np.ndarray) -> np.ndarray:
    """Number (count,) of the piece of each disk; pieces are connected by pairs (k, 2) that are not broken (b, 2)."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    listed, gone = (np.sort(each.astype(np.int64), axis=1) @ [count, 1] for each in (pairs, broken))
    pairs = pairs[~np.isin(listed, gone)]
    joined = coo_matrix((np.ones(len(pairs), np.int8), tuple(pairs.T)), shape=(count, count))
    return connected_components(joined, directed=False)[1]


@dataclass(frozen=True, eq=False)
class Fragments:
    """The fragments of a body.

    number : (f,) of each, one more than that of its first disk, ascending: the part of a fragment with its first disk
    keeps the number as it breaks. of_disk : (n,) the number of the fragment of each disk, 0 for no fragment.
    disks, mass, diameter : (f,) of each: number of disks, kg/m, and √(4A/π) m with the area A of its disks over the
    solid fraction of the packing. body : mass of the whole body, kg/m.
    """

    number: np.ndarray
    of_disk: np.ndarray
    disks: np.ndarray
    mass: np.ndarray
    diameter: np.ndarray
    body: float

    def describe(self) -> dict[str, float]:
        """Number of fragments of two disks or more, `diameter` of the largest (m), share of the body's mass.

        Also `singles`, the share of single disks in the mass of all fragments, and `d50` and `d80` (m), up to which are
        the diameters of 50 and 80 % of that mass; all are 0 without fragments.
        """
        several, mass = self.disks > 1, float(self.mass.sum())
        sieved = {f"d{share}": _below(self.diameter, self.mass, share / 100.0) if mass else 0.0 for share in (50, 80)}
        return {
            "count": int(np.count_nonzero(several)),
            "largest": float(self.diameter.max(initial=0.0)),
            "share": mass / self.body,
            "singles": float(self.mass[~several].sum()) / mass if mass > 0.0 else 0.0,
        } | sieved


class Debris:
    """Measures the debris of a scene.

    Parameters
    ----------
    scene : the whole one.
    """

    def __init__(self, scene: DiskScene) -> None:
        self.body = slice(scene.column_count, scene.disk_count)
        self._places, self._mass = scene.assembly.positions[self.body], scene.mass[self.body]
        self._diameter, self._deep = scene.ground.brick.mean_diameter, far_below(scene)
        self._bonds, self._count = scene.bonds, scene.disk_count
        self._area = np.pi * (scene.cell_fraction * scene.assembly.radii**2) / scene.ground.brick.solid_fraction
        self._breaks = np.isin(np.arange(scene.disk_count), scene.bonds)
        self._breaks[: scene.column_count] = False
        sides = (edge.nodes for side, edge in scene.sides.items() if not scene.case.side(side).is_free)
        self._held = np.concatenate([np.zeros(0, np.int64), *sides])

    def is_inside(self, displacement: np.ndarray) -> np.ndarray:
        """Whether each disk of the body (b,) is still in the scene, at displacements (b, 2) m."""
        return self._places[:, 1] + displacement[:, 1] >= self._deep

    def moved(self, displacement: np.ndarray) -> np.ndarray:
        """Whether each disk of the body (b,) is of the moved mass, at displacements (b, 2) m since the start."""
        return (np.hypot(*displacement.T) > self._diameter) & self.is_inside(displacement)

    def run_out(self, displacement: np.ndarray) -> dict[str, Any]:
        """The moved mass at displacements (b, 2) m since the start.

        `mass` (kg/m), its `share` of the body and its `centre` (2,) m; by side, of those of its disks that went there:
        `x95` and `x99` (m), beyond which are the centres of 5 and 1 % of their mass, and the `angle` (degrees) of the
        line down from the old crest to their front, Heim's Fahrböschung. The crest is the upper corner of the mass at
        the start, behind and above which 1 % of it lay; the front is x99 at the mean height of what is beyond x95. What
        is not known is nan: the centre of nothing, and the run-out of fewer than `LEAST` disks.
        """
        moved = self.moved(displacement)
        mass, begun, gone = self._mass[moved], self._places[moved], displacement[moved]
        centre = np.average(begun + gone, axis=0, weights=mass) if len(mass) else np.full(2, np.nan)
        found: dict[str, Any] = {"mass": float(mass.sum()), "share": float(mass.sum() / self._mass.sum())}
        ways = {side: sign * gone[:, 0] > 0.0 for side, sign in WAYS.items()}
        sides = {side: _run_out(WAYS[side], mass[way], begun[way], gone[way]) for side, way in ways.items()}
        return found | {"centre": centre} | sides

    def fragments(self, broken: np.ndarray) -> Fragments | None:
        """The fragments once the bonds of pairs (k, 2) of disks have broken; None for a body without bonds.

        Disks that never had a bond belong to none.
        """
        if not self._breaks.any():
            return None
        piece = pieces(self._count, self._bonds, broken)
        off = self._breaks & ~np.isin(piece, piece[self._held])
        _, first, number = np.unique(piece[off], return_index=True, return_inverse=True)
        numbers, of_disk = 1 + np.flatnonzero(off)[first], np.zeros(self._count, np.int32)
        of_disk[off] = numbers[number]
        mass = np.bincount(number, self._mass[off[self.body]])
        area = np.bincount(number, self._area[off])
        sizes = np.bincount(number), mass, np.sqrt(4.0 * area / np.pi)
        return Fragments(numbers, of_disk, *sizes, float(self._mass.sum()))


def _run_out(sign: float, mass: np.ndarray, begun: np.ndarray, gone: np.ndarray) -> dict[str, float]:
    """The run-out of disks (k,) that went one way, from their places (k, 2) m at the start; see `Debris.run_out`."""
    if len(mass) < LEAST:
        return dict.fromkeys(RUN_OUT, np.nan)
    along, height = sign * (begun + gone)[:, 0], (begun + gone)[:, 1]
    x95, x99 = (_below(along, mass, share) for share in (0.95, 0.99))
    front = along >= x95
    foot = float(np.average(height[front], weights=mass[front]))
    behind, top = _below(sign * begun[:, 0], mass, 0.01), _below(begun[:, 1], mass, 0.99)
    return {"x95": sign * x95, "x99": sign * x99, "angle": float(np.degrees(np.arctan2(top - foot, x99 - behind)))}


def _below(values: np.ndarray, mass: np.ndarray, share: float) -> float:
    """The value up to which a share of the mass lies."""
    order = np.argsort(values, kind="stable")
    up_to = np.cumsum(mass[order])
    return float(values[order][np.searchsorted(up_to, share * up_to[-1])])


class Rest(Every):
    """Finds when debris has come to rest, and ends the run then if it is asked to.

    At rest the kinetic energy of the body is below `AT_REST` times the energy of the fall, which is the largest work so
    far of the steady loads on the moved mass. What has not fallen is not at rest.

    Parameters
    ----------
    scene : the whole scene, which is stepped. rule : how long it must be at rest, and from when. ends : whether the run
    then ends.
    """

    name = "rest"
    evolving = ("due", "fall", "_moving")

    def __init__(self, scene: DiskScene, rule: RestRule, time_step: float, *, ends: bool) -> None:
        super().__init__(STEPS)
        self._debris, self._ends = Debris(scene), ends
        self._force = scene.steady_load[:2, self._debris.body].T
        self._hold, self._earliest = (rule.hold / time_step, rule.earliest / time_step)
        self._inertia = np.array([scene.mass, scene.mass, scene.inertia])[:, self._debris.body]
        self.fall, self.kinetic, self._moving = 0.0, 0.0, -1

    def see(self, run: Run) -> None:
        """Compare the energies (J/m) now, without those of disks that have fallen out of the scene."""
        state, debris = run.state, self._debris
        gone = (state.displacement - state.datum)[:2, debris.body].T
        moved, inside = debris.moved(gone), debris.is_inside(gone)
        self.fall = max(self.fall, float(np.sum(self._force[moved] * gone[moved])))
        each = self._inertia * state.velocity[:, debris.body] ** 2
        self.kinetic = 0.5 * float(np.sum(each[:, inside]))
        if self.kinetic >= AT_REST * self.fall:
            self._moving = state.step
        if self._ends and self._is_at_rest(state.step):
            run.stopped = True

    def _is_at_rest(self, step: int) -> bool:
        return step - max(self._moving, self._earliest) >= self._hold

    def describe(self, run: Run) -> dict[str, float | None]:
        """Energies of the fall and of motion now (J/m), and the time `rest` (s) from which the debris has been at rest.

        The time is that of the last look at which it was not; None if nothing fell, or it has not been so for long
        enough.
        """
        self.see(run)
        rest = run.time_step * self._moving if self._is_at_rest(run.state.step) else None
        return {"fall": self.fall, "kinetic": self.kinetic, "rest": rest}
