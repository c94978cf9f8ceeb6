"""Columns of disks that collapse onto a rough floor, by a program of its own beside `dembound run`.

    python benchmarks/column_collapse.py [--aspects 0.5 1 2 4] [--radius 0.05] [--picture FILE]

A column of width 2 m and height 2a m stands between a wall and a gate, which is lifted at 20 m/s. The program
(loose_disks.py) shares with the run only the numbers of the case, the disks at rest with the forces of their contacts,
and the time step. Compared are x95, x99, the centre of the moved mass and the profile of the
deposit, beside the run-out of columns of grains in channels, (r∞ − r₀)/r₀ = 1.2 a, from a = 2.3 on 1.9 a^(2/3)
(Lube et al., Phys. Rev. E 72, 041301, 2005).
"""

import argparse
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from loose_disks import DENSITY, DP, EMOD, FRIC, GRAVITY, KRATIO, LIFT, RR_FRIC, Program
from timing import machine, show, small_option, write

WIDTH = 2.0
"""Of the column, m."""

COLUMN, COLUMNS = 0.25, 120
"""Width (m) and number of the columns of a profile."""


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
