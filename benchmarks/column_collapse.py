"""Columns of disks that collapse onto a rough floor, by a program of its own beside `dembound run`.

    python benchmarks/column_collapse.py [--aspects 0.5 1 2 4] [--radius 0.05] [--picture FILE]

A column of width 2 m and height 2a m stands between a wall and a gate, which is lifted at 20 m/s. The program is numpy
alone: disks with linear springs, Coulomb's friction, resistance to rolling and dashpots, walls of segments, its own
search for neighbours, and the leapfrog. It shares with the run only the numbers of the case, the disks at rest with the
forces of their contacts, and the time step. Compared are x95, x99, the centre of the moved mass and the profile of the
deposit, beside the run-out of columns of grains in channels, (r∞ − r₀)/r₀ = 1.2 a, from a = 2.3 on 1.9 a^(2/3)
(Lube et al., Phys. Rev. E 72, 041301, 2005).
"""

import argparse
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from timing import machine, show, small_option, write

WIDTH, DENSITY, EMOD, KRATIO, FRIC, RR_FRIC, DP = 2.0, 2000.0, 2e7, 2.0, 0.5, 1.0, 0.2
"""Of the column, m; of the material, SI units."""

GRAVITY, LIFT = 9.81, 20.0
"""Acceleration, m/s², and velocity of the gate, m/s."""

COLUMN, COLUMNS = 0.25, 120
"""Width (m) and number of the columns of a profile."""

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


class Deposit(NamedTuple):
    """x95 and x99 (m) of the moved mass, its centre (2,) m, and the heights (k,) m of the deposit by x."""

    x95: float
    x99: float
    centre: np.ndarray
    profile: np.ndarray

    @classmethod
    def of(cls, begun: np.ndarray, place: np.ndarray, radius: np.ndarray) -> "Deposit":
        """The deposit of disks from places (2, n) m; heights are area over the width of columns."""
        moved = np.hypot(*(place - begun)) > 2.0 * radius.mean()
        mass = radius[moved] ** 2
        right = moved & (place[0] > begun[0])
        x, own = place[0, right], radius[right] ** 2
        order = np.argsort(x)
        share = np.cumsum(own[order]) / own.sum()
        x95, x99 = (float(x[order][np.searchsorted(share, each)]) for each in (0.95, 0.99))
        column = np.clip(place[0] / COLUMN, 0.0, COLUMNS - 1).astype(int)
        heights = np.bincount(column, np.pi * radius**2, minlength=COLUMNS) / COLUMN
        return cls(x95, x99, np.average(place[:, moved], axis=1, weights=mass), heights)


def lines_of(aspect: float, radius: float) -> list[np.ndarray]:
    """The floor, with teeth as wide as a mean disk, the wall behind the column, and the gate (m)."""
    near_box, pitch = 1.2 * radius, 2.0 * radius
    teeth = np.arange(-2, int((WIDTH + 3.0 * aspect * WIDTH + 4.0) / pitch) + 1)
    x = np.repeat(pitch * teeth, 2)[:-1] + np.tile([0.0, 0.5 * pitch], len(teeth))[:-1]
    floor = np.stack([x, -near_box - np.where(np.arange(len(x)) % 2, 0.25 * pitch, 0.0)], axis=1)
    top, low = 2.0 * aspect * WIDTH + 1.0, -near_box - 0.5 * pitch
    upright = [np.array([[at, low], [at, top]]) for at in (-near_box, WIDTH + near_box)]
    return [floor, *upright]


def run_of(
    aspect: float, radius: float, seed: int, folder: Path, duration: float = 20.0
) -> tuple[Program, Deposit, float, dict[str, Any]]:
    """What `dembound run` makes of a column: the program in its first state, its deposit, step (s) and summary.

    It ends at rest, or after a duration (s).
    """
    import h5py

    import dembound

    floor, back, gate = (line.tolist() for line in lines_of(aspect, radius))
    size = [WIDTH, aspect * WIDTH]
    case = dembound.case(
        packing={"pattern": "B", "size": size, "radius": radius, "radius_ratio": 1.5, "brick": size, "seed": seed},
        material={"density": DENSITY, "law": "linearpbond", "emod": EMOD, "pb_emod": 0.0, "kratio": KRATIO}
        | {"fric": FRIC, "rr_fric": RR_FRIC, "dp_nratio": DP},
        wall=[
            {"name": "floor", "points": floor, "fric": FRIC, "dp_nratio": DP},
            {"name": "back", "points": back, "fric": FRIC, "dp_nratio": DP},
            {"name": "gate", "points": gate, "velocity": [0.0, LIFT], "until": (gate[1][1] + 1.0) / LIFT},
        ],
        load=[{"name": "weight", "acceleration": [0.0, -GRAVITY]}],
        static={"ratio": 1e-4},
        run={"duration": duration} | ({"until": "rest"} if duration > 2.0 else {}),
        output={"pictures": False, "paraview": "none", "contacts": True},
    )
    found = dembound.run(case, folder)
    with h5py.File(found.folder / "run.h5") as file:
        packed, radii = file["particles/position"][:].T, file["particles/radius"][:]
        settled = packed + file["static/displacement"][:, :2].T
        last = max(file["snapshots"])
        end = settled + file[f"snapshots/{last}/displacement"][:, :2].T
        pairs, shear = (file[f"snapshots/0000/contacts/{name}"][:] for name in ("particles", "shear_force"))
        step = float(file.attrs["time_step"])
    program = Program(packed, settled, radii, lines_of(aspect, radius), pairs, shear)
    return program, Deposit.of(settled, end, radii), step, found.summary


def rows(options: argparse.Namespace) -> Iterator[dict[str, Any]]:
    """Rows of the table: what the run gives, and in per cent how much less the other program gives."""
    for aspect in options.aspects:
        for seed in options.seeds:
            with tempfile.TemporaryDirectory() as folder:
                program, own, step, summary = run_of(aspect, options.radius, seed, Path(folder))
            begun, disks, debris = program.place.copy(), len(program.radius), summary["debris"]
            for number in range(summary["steps"]):
                program.advance(step * number, step)
            other = Deposit.of(begun, program.place, program.radius)
            pairs = zip((own.x95, own.x99, *own.centre), (other.x95, other.x99, *other.centre), strict=True)
            differences = [100.0 * (one / two - 1.0) for one, two in pairs]
            ends = WIDTH + 1.2 * options.radius
            yield {
                "aspect": aspect,
                "seed": seed,
                "disks": disks,
                "x99": own.x99,
                "run_out": own.x99 / ends - 1.0,
                "published": float(published(aspect)),
                **dict(zip(("dx95", "dx99", "dx", "dy"), differences, strict=True)),
                "profile": 100.0 * float(np.abs(own.profile - other.profile).sum() / other.profile.sum()),
                "rest": debris["kinetic"] / disks / debris["fall"],
                "profiles": (own.profile.tolist(), other.profile.tolist()),
            }


def published(aspect: float | np.ndarray) -> np.ndarray:
    """Run-out of columns of grains over their width, by height over width (Lube et al. 2005)."""
    return np.where(np.asarray(aspect) <= 2.3, 1.2 * aspect, 1.9 * aspect ** (2.0 / 3.0))


def draw(found: Sequence[dict[str, Any]], path: Path) -> None:
    """Profiles of both programs, and run-out beside the published scaling."""
    import matplotlib.pyplot as plt

    figure, (left, right) = plt.subplots(1, 2, figsize=(9.0, 3.4), layout="constrained", width_ratios=(3, 2))
    at = COLUMN * (np.arange(COLUMNS) + 0.5)
    aspects = sorted({row["aspect"] for row in found}, reverse=True)
    for number, aspect in enumerate(aspects):
        rows, color = [row for row in found if row["aspect"] == aspect], f"C{number}"
        own, other = np.moveaxis([row["profiles"] for row in rows], 1, 0)
        left.fill_between(at, own.min(axis=0), own.max(axis=0), step="mid", color=color, alpha=0.2, lw=0.0)
        left.step(at, own.mean(axis=0), where="mid", color=color, label=f"a = {aspect:g}")
        left.step(at, other.mean(axis=0), where="mid", color=color, ls=":")
        run_out = np.array([row["run_out"] for row in rows])
        spread = [[run_out.mean() - run_out.min()], [run_out.max() - run_out.mean()]]
        right.errorbar(aspect, run_out.mean(), spread, fmt="o", color=color, capsize=3.0)
    left.plot([], [], "k:", label="program in numpy alone")
    left.set(xlabel="x (m)", ylabel="height (m)", xlim=(0.0, 1.1 * max(row["x99"] for row in found)), ylim=(0.0, None))
    left.set_title("Deposits: mean and range of seeds", fontsize="medium")
    left.legend()
    for label, low, high in (("Lube et al. (2005)", 0.0, 2.3), (None, 2.3001, 1.1 * max(2.3, *aspects))):
        heights = np.linspace(low, high, 50)
        right.plot(heights, published(heights), "k", label=label)
    right.set(xlabel="a, height over width (–)", ylabel="run-out, (x99 − r₀)/r₀ (–)")
    right.set_title("Run-out: mean and range of seeds", fontsize="medium")
    right.legend()
    figure.savefig(path, dpi=110)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--aspects", nargs="+", type=float, default=[0.5, 1.0, 2.0, 4.0], help="heights over width")
    parser.add_argument("--seeds", nargs="+", type=int, default=[1])
    parser.add_argument("--radius", type=float, default=0.05, help="mean radius of the disks, m")
    parser.add_argument("--picture", type=Path, help="file of the picture")
    parser.add_argument("--json", type=Path, default=Path("results/benchmarks/column_collapse.json"))
    small_option(parser, aspects=[1.0], radius=0.15)
    options = parser.parse_args()
    found = list(rows(options))
    columns = {"a": "{aspect:g}", "seed": "{seed}", "disks": "{disks:,}", "x99, m": "{x99:.3f}"}
    columns |= {"(x99 − r₀)/r₀": "{run_out:.2f}", "published": "{published:.2f}"}
    columns |= {"x95, %": "{dx95:.2f}", "x99, %": "{dx99:.2f}", "x, %": "{dx:.2f}", "y, %": "{dy:.2f}"}
    show("Columns", columns | {"profile, %": "{profile:.1f}", "kinetic a disk": "{rest:.1e}"}, found)
    write(options.json, {"machine": machine(), "rows": found})
    if options.picture:
        draw(found, options.picture)
