"""The walls of a scene as a part without nodes of its own, and the disks near them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from dembound.casefile.disks.wall import Wall
from dembound.disks.body import DiskBody
from dembound.kernels import wall_contacts as contacts
from dembound.kernels import walls as kernel
from dembound.kernels.common import CHUNKS, LIST_ENDS
from dembound.kernels.tables import Unloading, Walls
from dembound.motion.part import NO_CRACKS, Cracks, Part
from dembound.motion.state import Arrays, State

SKIN = 1.0
"""Distance from walls, in mean diameters, up to which disks are listed; others are only looked at after as much motion.

A list takes as long as a few steps, and disks in it some 10 ns each."""

ROWS = 1024
"""Steps of which forces on walls are kept for the record; the loop returns within a quarter of them."""

MOST_RANGES = 4096
"""Largest number of ranges along an axis by which segments near a disk are found."""


class Touching(NamedTuple):
    """Contacts of disks with walls: disk (m,) ascending, and kept (m, MOST, KEPT), see kernels/wall_contacts.py."""

    disk: np.ndarray
    kept: np.ndarray


def path_of(scene: DiskBody, steps: int, time_step: float) -> np.ndarray:
    """Displacements (rows, w, 2) m of walls before each step (s), of which the last two are equal.

    Velocities are those in the middle of steps; none of walls that follow disks.
    """
    walls, waves = scene.case.wall, scene.case.wave
    if not any(wall.is_driven or wall.moves for wall in walls):
        return np.zeros((1, len(walls), 2))
    times = (np.arange(steps) + 0.5) * time_step
    velocity = np.zeros((steps + 1, len(walls), 2))
    for number, wall in enumerate(walls):
        own = velocity[:-1, number]
        if wall.velocity is not None:
            own[:] = wall.velocity
        for axis, name in wall.waves.items():
            own[:, axis] = waves[name].velocity(times)
        if wall.until is not None:
            own[times > wall.until] = 0.0
        if wall.moves and not follows(scene, wall):
            own[:] = _of_ground(scene, wall, times)
    return np.concatenate([np.zeros((1, len(walls), 2)), time_step * np.cumsum(velocity, axis=0)])


def bottom_waves(scene: DiskBody) -> dict[int, str]:
    """Names of the waves of the velocity of a driven bottom, by axis; empty where it does not prescribe it."""
    bottom = scene.case.side("bottom")
    held = bottom.prescribed(1)
    return {axis: name for axis, name in enumerate(bottom.waves_by_axis(1)) if name is not None and axis in held}


def follows(scene: DiskBody, wall: Wall) -> bool:
    """Whether a wall moves as disks of a free-field column do."""
    return wall.moves is not None and not bottom_waves(scene) and scene.case.incident is None


def _of_ground(scene: DiskBody, wall: Wall, times: np.ndarray) -> np.ndarray:
    """Velocities (k, 2) m/s at times (k,) s of a wall that moves as the bottom, or as the undisturbed ground."""
    if waves := bottom_waves(scene):
        found = [scene.case.wave[waves[axis]].velocity(times) if axis in waves else 0.0 * times for axis in (0, 1)]
        return np.stack(found, axis=1)
    x, y = wall.place
    assert scene.outside is not None
    assert scene.ground_waves is not None
    surface = scene.outside.free_surface
    place = np.array([[x, y if surface is None or scene.outside.levels else min(y, surface[0])]])
    return np.asarray(scene.ground_waves.motion("velocity", times, place)[:, 0, :2])


def leaders(scene: DiskBody) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The disks of free-field columns that walls follow: first of each wall (w + 1,), slots and shares (f,).

    Those less than a diameter above and below the place, weighted by mass and so that the mean is that at its height;
    at the ends of a column where that does not reach there.
    """
    counts, slots, shares = [0], [], []
    for wall in scene.case.wall:
        counts.append(0)
        if follows(scene, wall):
            x, y = wall.place
            disks = np.arange(scene.disk_count)[scene.seams[-1 if x > scene.case.middle else 0].disks]
            up = scene.assembly.positions[disks, 1]
            away = np.abs(up - np.clip(y, up.min(), up.max())) / scene.ground.brick.mean_diameter
            near = np.flatnonzero(away < 1.0)
            weight = (1.0 - away[near]) * scene.mass[disks[near]]
            slots.append(scene.layout.slot[disks[near]])
            shares.append(weight / weight.sum())
            counts[-1] = len(near)
    joined = (np.concatenate([[], *each]) for each in (slots, shares))
    slot, share = next(joined).astype(np.int64), next(joined)
    return np.cumsum(counts), slot, share


@dataclass(frozen=True, eq=False)
class Lines:
    """The segments of all walls: ends (s, 4) m, x and y of both, and the number (s,) of the wall of each."""

    ends: np.ndarray
    wall: np.ndarray

    @classmethod
    def of(cls, walls: Sequence[Wall]) -> Lines:
        """The segments of walls, in their order."""
        lines = [np.array(wall.line) for wall in walls]
        ends = np.concatenate([np.hstack([line[:-1], line[1:]]) for line in lines])
        return cls(ends, np.repeat(np.arange(len(lines)), [len(line) - 1 for line in lines]))

    def ranges(self, shift: np.ndarray, reach: float) -> tuple[int, float, float, np.ndarray, np.ndarray]:
        """Ranges along the longer axis of all segments, shifted by (s, 2) m, and those that reach into each.

        Axis, low end and width (m), and start (b + 1,) of the members of each in member (e,), ascending. reach : m, of
        a segment beyond its ends.
        """
        ends = self.ends.reshape(-1, 2, 2) + shift[:, None]
        axis = int(np.ptp(ends, axis=(0, 1)).argmax())
        low, high = ends[..., axis].min(axis=1) - reach, ends[..., axis].max(axis=1) + reach
        count = int(np.clip(len(ends), 1, MOST_RANGES))
        begin, width = float(low.min()), float(high.max() - low.min()) / count
        first, last = ((np.floor((each - begin) / width)).astype(np.int64) for each in (low, high))
        last = np.minimum(last, count - 1)
        each = last - first + 1
        member = np.repeat(np.arange(len(ends)), each)
        range_of = np.repeat(first, each) + np.arange(len(member)) - np.repeat(np.cumsum(each) - each, each)
        order = np.argsort(range_of, kind="stable")
        start = np.concatenate([[0], np.cumsum(np.bincount(range_of, minlength=count))])
        return axis, begin, width, start, member[order]


class WallPart(Part):
    """The walls that the disks of a body touch.

    Parameters
    ----------
    scene : the scene. time_step : s. fastest : (chunks,) m/s of the body's disks after a step, as its law notes them.
    displacement : (3, n) m and rad, at the start. touching : contacts of an earlier stage; None: there are none.
    stand : whether walls stand still, as in a static stage.
    """

    name = "walls"
    nodes = slice(0, 0)
    law_name = "walls"
    evolving = ("_moved", "_way", "_step")

    def __init__(
        self,
        scene: DiskBody,
        time_step: float,
        fastest: np.ndarray,
        displacement: np.ndarray,
        touching: Touching | None = None,
        *,
        stand: bool,
    ) -> None:
        walls, case = scene.case.wall, scene.case
        self._scene = scene
        self._lines = Lines.of(walls)
        steps = 1 if stand else int(np.ceil(case.run.duration / time_step)) + 2
        self._path = np.zeros((1, len(walls), 2)) if stand else path_of(scene, steps, time_step)
        self._record = np.zeros((ROWS, len(walls), 4))
        self._moved, self._way, self._step = np.zeros(2), np.zeros(2), np.zeros(1, dtype=np.int64)
        friction, rolling = np.array([[wall.fric, wall.rr_fric] for wall in walls]).T.copy()
        self._constant = dict(zip(("follow", "leader", "share"), leaders(scene), strict=True)) | {
            "ends": self._lines.ends,
            "wall": self._lines.wall,
            "given": np.array([[wall.kn or 0.0, wall.ks or 0.0] for wall in walls]),
            "friction": friction,
            "rolling": rolling,
            "dashpot": np.array([2.0 * wall.dp_nratio for wall in walls]),
            "fastest": fastest,
            "lost": np.zeros((CHUNKS, kernel.LOST)),
            "total": np.zeros((CHUNKS, len(walls), 2)),
            "path": self._path,
            "record": self._record,
        }
        known = touching or Touching(np.zeros(0, dtype=np.int64), np.zeros((0, contacts.MOST, contacts.KEPT)))
        slots = scene.layout.slot[known.disk]
        order = np.argsort(slots)
        self._list(scene.layout.spread(displacement), 0, slots[order], known.kept[order])

    @cached_property
    def _disks(self) -> dict[str, np.ndarray]:
        """Slot, place, radius, mass, stiffness and kratio of all disks of the body, in ascending slots."""
        scene, own = self._scene, self._scene.parts["body"]
        slot = scene.layout.slot[own]
        order = np.argsort(slot)
        disks = np.arange(own.start, own.stop)[order]
        place = scene.assembly.positions[disks]
        moduli = [each.moduli for each in scene.inside.materials]
        layer = scene.inside.layer_of(place)
        kn, kratio = (np.array(each)[layer] for each in ([2.0 * m.emod for m in moduli], [m.kratio for m in moduli]))
        found = {"slot": slot[order], "place": np.ascontiguousarray(place.T), "radius": scene.assembly.radii[disks]}
        return found | {"mass": scene.mass[disks], "spring": kn, "kratio": kratio}

    def _list(self, u: np.ndarray, step: int, slots: np.ndarray, kept: np.ndarray) -> None:
        """List the disks near walls before a step, at displacements (3, slots).

        kept : (m, …) contacts of the disks in slots (m,), ascending.
        """
        disks, lines, nothing = self._disks, self._lines, np.zeros(0, dtype=np.int64)
        shift = self.place(step)[lines.wall]
        reach = SKIN * self._scene.ground.brick.mean_diameter
        bins = lines.ranges(shift, reach + float(disks["radius"].max()))
        counts = np.zeros(len(disks["slot"]), dtype=np.int64)
        columns = (u, disks["slot"], disks["place"], disks["radius"], reach, bins, lines.ends, shift, counts)
        contacts.near_disks(*columns, nothing)
        segment = np.zeros(int(counts.sum()), dtype=np.int64)
        if segment.size:
            contacts.near_disks(*columns, segment)
        near = np.flatnonzero(counts)
        own = np.zeros((len(near), contacts.MOST, contacts.KEPT))
        there = np.isin(slots, disks["slot"][near])
        own[np.searchsorted(disks["slot"][near], slots[there])] = kept[there]
        self._way[:] = 0.0, reach
        self._walls = self._listed(near, np.concatenate([[0], np.cumsum(counts[near])]), segment, own)

    def _listed(self, near: np.ndarray, start: np.ndarray, segment: np.ndarray, kept: np.ndarray) -> Walls:
        """The arrays for the kernels with a list of the disks (m,), by number among those of the body."""
        of = {name: np.ascontiguousarray(values[..., near]) for name, values in self._disks.items()}
        edges = np.arange(CHUNKS + 1) * self._scene.layout.count // CHUNKS
        return Walls(
            **of,
            **self._constant,
            bound=np.searchsorted(of["slot"], edges).astype(np.int64),
            start=start,
            segment=segment,
            kept=kept,
            force=np.zeros((3, len(near))),
            load=np.zeros((3, len(near))),
            moved=self._moved,
            way=self._way,
            step=self._step,
        )

    def law(self) -> Walls:
        """The walls with the disks listed near them; they are the first law, as others move disks by their forces."""
        return self._walls

    @property
    def unloading(self) -> Unloading:
        """The law that takes their forces off steady loads again; it must be the last one."""
        return Unloading(self._walls.slot, self._walls.load)

    def react(self, why: int, steps: int, state: State) -> None:
        """List disks anew once they may have come from outside the list."""
        if why == LIST_ENDS and self._way[0] >= self._way[1]:
            self._list(state.u, state.step, self._walls.slot, self._walls.kept)

    def stored(self, u: np.ndarray) -> tuple[float, float]:
        """Energy (J) in the springs of contacts at the last forces, and none in bonds."""
        return float(kernel.energy_stored(self._walls)), 0.0

    def take_cracks(self, steps: int) -> Cracks:
        """None: walls have no bonds."""
        return NO_CRACKS

    @property
    def supplied(self) -> float:
        """Work (J) of the walls that move, up to the last whole step."""
        return float(self._moved[1])

    @property
    def touching(self) -> Touching:
        """The contacts of the last step, by disk."""
        touch = self._walls.kept[:, 0, contacts.PUSH] > 0.0
        disk = self._scene.layout.node[self._walls.slot[touch]]
        order = np.argsort(disk)
        return Touching(disk[order], self._walls.kept[touch][order])

    def samples(self, steps: np.ndarray) -> np.ndarray:
        """Displacement (m) and force (N), along x and y, of and on each wall (k, w, 4) in some of the last steps."""
        return self._record[steps % ROWS]

    @property
    def _rows_now(self) -> list[int]:
        """Rows of the path that the next step reads: before the last step, after it, and the end."""
        return [min(int(self._step[0]) + more, len(self._path) - 1) for more in (0, 1, len(self._path))]

    def place(self, step: int) -> np.ndarray:
        """Displacement (w, 2) m of each wall before a step."""
        return self._path[min(step, len(self._path) - 1)]

    def push(self, displacement: np.ndarray) -> None:
        """Compute the forces of walls on disks at rest at displacements (3, n)."""
        u = self._scene.layout.spread(displacement)
        kernel.push(self._walls, u, u, np.zeros_like(u), 0, 0.0, np.zeros((2, 7)))

    @property
    def sizes(self) -> np.ndarray:
        """Sizes (m,) N of the last forces of walls on the disks near them."""
        return np.asarray(np.hypot(*self._walls.force[:2]))

    def add_forces(self, force: np.ndarray) -> None:
        """Add the last forces of walls on disks to those of all nodes, force (3, n)."""
        force[:, self._scene.layout.node[self._walls.slot]] += self._walls.force

    def saved_arrays(self) -> Arrays:
        """The list of disks with their contacts, for a checkpoint."""
        listed = {name: getattr(self._walls, name) for name in ("slot", "start", "segment", "kept", "force")}
        return {**super().saved_arrays(), **listed, "path": self._path[self._rows_now]}

    def restore(self, saved: Arrays) -> None:
        """Restore the arrays returned by `saved_arrays` in another run of the same case."""
        super().restore(saved)
        self._path[self._rows_now] = saved["path"]
        near = np.searchsorted(self._disks["slot"], saved["slot"])
        self._walls = self._listed(near, *(saved[name].copy() for name in ("start", "segment", "kept")))
        self._walls.force[...] = saved["force"]
