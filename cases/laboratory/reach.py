"""Draws docs/pictures/laboratory_reach.png: the Poisson's ratios that packings have, by kratio, and their contacts.

    python reach.py [FOLDER]      (default: the current folder)

It takes a minute. Also prints the numbers of docs/tasks/laboratory.md on ten seeds of a brick.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from dembound.casefile.disks.material import Material
from dembound.disks.material.case_material import make_packed_material
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.material.targets import moduli_of
from dembound.packings.brick import Brick
from dembound.packings.edged_brick import EdgedBrick
from dembound.packings.random_brick import RandomBrick
from dembound.packings.square import Square
from dembound.plot.style import COLOURS, new_figure, save, styled

RATIOS = np.logspace(-1.0, 3.0, 25)
PRESSURES = np.array([1e-5, 3e-5, 1e-4, 3e-4, 1e-3, 8e-3])
SEEDS = range(3)
MODULUS = 30e9
"""Pa, of contacts and of bonds."""

RANDOM = {"radius": 0.5, "radius_ratio": 1.5, "brick": [20.8, 20.8], "bricks": [1, 1]}
PATTERNS = {
    "B": lambda seed: RandomBrick(**RANDOM, seed=seed),
    "B, packed at 1e-5 of the modulus": lambda seed: RandomBrick(**RANDOM, seed=seed, confining_stress=1e-5 * MODULUS),
    "C": lambda seed: EdgedBrick(**RANDOM, seed=seed, edge_radius=0.52),
    "A, mean over directions": lambda seed: Square(radius=0.5, bricks=(1, 1)),
}


def ground(brick: Brick, **keys: object) -> PackedMaterial:
    """A brick with contacts and bonds of equal moduli, and friction."""
    given = {"emod": MODULUS, "pb_emod": MODULUS, "fric": 0.5, **keys}
    return make_packed_material(brick, Material(density=2600.0, **given), ())


def poisson(made: PackedMaterial) -> list[float]:
    """Poisson's ratio of the solid at each kratio."""
    each = (replace(made, moduli=replace(made.moduli, kratio=float(k), pb_kratio=float(k))) for k in RATIOS)
    return [moduli_of(one.material_tensor, "isotropic", by_waves=False).poisson("strain") for one in each]


@styled
def reach() -> Figure:
    """Poisson's ratio over kratio by pattern, and contacts per disk and largest ν over the pressure of packing."""
    figure = new_figure(10.0, 4.2)
    left, right = figure.subplots(1, 2)
    for colour, (name, pack) in zip(COLOURS, PATTERNS.items(), strict=False):
        seeds = SEEDS if name[0] != "A" else range(1)
        curves = np.array([poisson(ground(pack(seed).pack(MODULUS))) for seed in seeds])
        left.fill_between(RATIOS, curves.min(axis=0), curves.max(axis=0), color=colour, alpha=0.3, linewidth=0.0)
        left.plot(RATIOS, curves.mean(axis=0), color=colour, label=name)
        print(f"{name}: ν {curves.min():.3f} to {curves.max():.3f}")
    left.set(xscale="log", xlabel="kratio = pb_kratio", ylabel="Poisson's ratio ν (plane strain)", ylim=(-0.5, 0.5))
    left.legend(loc="lower right")
    bricks = [
        [RandomBrick(**RANDOM, seed=s, confining_stress=p * MODULUS).pack(MODULUS) for s in SEEDS] for p in PRESSURES
    ]
    contacts = np.array([[brick.coordination for brick in each] for each in bricks])
    largest = np.array([[max(poisson(ground(brick))) for brick in each] for each in bricks])
    for p, z, nu in zip(PRESSURES, contacts, largest, strict=True):
        print(f"pressure {p:g}: {z.mean():.3f} contacts per disk, largest ν {nu.mean():.3f}")
    right.plot(PRESSURES, largest.mean(axis=1), color=COLOURS[0], marker="o")
    for p, z, nu in zip(PRESSURES, contacts.mean(axis=1), largest.mean(axis=1), strict=True):
        right.annotate(f"{z:.2f}", (p, nu), textcoords="offset points", xytext=(4.0, 6.0))
    right.set(
        **{"xscale": "log", "xlim": (6e-6, 2e-2), "ylim": (0.35, 0.5)},
        xlabel="confining stress over contact modulus",
        ylabel="largest ν of B (numbers: contacts per disk)",
    )
    return figure


def ten_seeds() -> None:
    """Print what is found for E = 62 GPa and ν = 0.24 in ten bricks."""
    made = [
        ground(RandomBrick(**RANDOM, seed=seed).pack(MODULUS), emod=None, pb_emod=None, young=62e9, poisson=0.24)
        for seed in range(10)
    ]
    found = [moduli_of(one.material_tensor, "isotropic", by_waves=False) for one in made]
    off = max(max(abs(one.young("strain") / 62e9 - 1.0), abs(one.poisson("strain") / 0.24 - 1.0)) for one in found)
    for name in ("emod", "kratio"):
        values = np.array([getattr(one.moduli, name) for one in made])
        print(
            f"{name}: {values.mean():.4g}, deviation {values.std(ddof=1):.2g}, {values.min():.4g} to {values.max():.4g}"
        )
    print(f"E and ν within {off:.1e}")


if __name__ == "__main__":
    ten_seeds()
    save(reach(), Path(sys.argv[1] if len(sys.argv) > 1 else ".") / "laboratory_reach.png", None)
