"""E, ν and the first crack of samples by static solves, beside what `dembound test ucs` or `tension` measured.

    python first_crack.py RESULTS_OF_A_TEST …      (for instance results/granite_ucs; smooth ends)

The disks that the platens hold are moved along y, and all others come to rest, contacts open in tension and slip at
their friction, as in dembound/disks/material/first_crack.py for an endless packing. E and ν are slopes over the mean
strains of the middle half of the sample, as in the test.
"""

import csv
import sys
from pathlib import Path

import numpy as np
from scipy.sparse import diags
from scipy.sparse.linalg import splu

from dembound.casefile.disks import DiskCase
from dembound.disks.material.constants import strength_of
from dembound.disks.material.first_crack import ROUNDS, SETTLED
from dembound.disks.material.homogenise import Network
from dembound.disks.scene import DiskScene, build
from dembound.kinds import loads
from dembound.laws import Stiffness
from dembound.laws.law import touching
from dembound.results.recording import GAUGE


def solve(scene: DiskScene, sense: float) -> dict[str, float]:
    """Young's modulus and first crack (Pa), and Poisson's ratio; sense : +1 tension, −1 compression."""
    ground, assembly, material = scene.ground, scene.assembly, scene.case.material
    brick, of, moduli = ground.brick, assembly.contact_type, ground.moduli
    first, second = brick.radii[brick.pairs].T
    closed = touching(first, second, np.hypot(*brick.vectors.T))[of]
    springs = ground.law.springs(moduli, first, second)
    each = {name: value[of] for name, value in vars(springs).items()}
    own = ground.stiffness.of(of)
    count, width = len(assembly.radii), float(assembly.size[0])
    bottom, top = (scene.edges[side].nodes for side in ("bottom", "top"))
    height = float(assembly.positions[top, 1].mean() - assembly.positions[bottom, 1].mean())
    held = np.concatenate([count + bottom, count + top, [bottom[0]]])  # and one motion along x
    given = np.concatenate([-np.ones(len(bottom)), np.ones(len(top)), [0.0]]) * 0.5 * sense * height
    free = np.setdiff1d(np.arange(3 * count), held)
    limits = strength_of(material)
    normal, shear, before = closed * 1.0, closed * 1.0, np.inf
    found: dict[str, float] = {}
    for _ in range(ROUNDS):
        stiffness = Stiffness(
            normal * each["contact_normal"] + each["bond_normal"],
            shear * each["contact_shear"] + each["bond_shear"],
            each["bending"],
            own.arm_i,
            own.arm_j,
        )
        network = Network(count, assembly.pairs, brick.vectors[of], stiffness)
        ways, k = network.motion_matrix(), diags(network.springs)
        motion = np.zeros(3 * count)
        motion[held] = given
        rows = ways[:, free].T @ k
        motion[free] = splu((rows @ ways[:, free]).tocsc()).solve(-(rows @ (ways @ motion)))
        elongations = ways @ motion
        stretch, slip, turn = elongations.reshape(3, -1)
        forces = (ways.T @ (k @ elongations))[count : 2 * count]
        stress = 0.5 * (forces[top].sum() - forces[bottom].sum()) / width  # tension positive, per unit strain
        pulled = each["bond_normal"] * stretch / each["area"]
        bent = np.abs(each["bending"] * turn) * 1.5 / each["bond_radius"] ** 2
        sheared = np.abs(each["bond_shear"] * slip) / each["area"] + limits.tan_fa * pulled
        crack = abs(stress) * min(limits.tension / (pulled + bent).max(), limits.cohesion / sheared.max())
        axial, lateral = _strains(assembly.positions, motion.reshape(3, -1)[:2].T)
        found = {"first_crack": crack, "young": stress / axial, "poisson": -lateral / axial}
        if abs(crack / before - 1.0) < SETTLED:
            break
        before = crack
        normal = closed * (stretch < 0.0)
        pressed = moduli.fric * each["contact_normal"] * np.maximum(-stretch, 0.0)
        needed = np.abs(each["contact_shear"] * slip)
        shear = normal * np.divide(pressed, needed, out=np.ones_like(needed), where=needed > pressed)
    return found


def _strains(positions: np.ndarray, motion: np.ndarray) -> tuple[float, float]:
    low, high = positions.min(axis=0), positions.max(axis=0)
    from_middle = positions - 0.5 * (low + high)
    inside = (np.abs(from_middle) < 0.5 * GAUGE * (high - low)).all(axis=1)
    places = np.column_stack([np.ones(np.count_nonzero(inside)), from_middle[inside]])
    slopes = np.linalg.lstsq(places, motion[inside], rcond=None)[0][1:]
    return float(slopes[1, 1]), float(slopes[0, 0])


if __name__ == "__main__":
    print("run                  E GPa (static)       ν (static)           first crack MPa (static)")
    for folder in map(Path, sys.argv[1:]):
        with open(folder / "test.csv", encoding="utf-8", newline="") as file:
            for row in csv.DictReader(file):
                text = (folder / "cases" / f"{row['run']}.toml").read_text(encoding="utf-8")
                case = loads(text, folder, row["run"])
                assert isinstance(case, DiskCase)
                static = solve(build(case), 1.0 if folder.name.endswith("tension") else -1.0)
                pairs = [(float(row[name]), static[name]) for name in ("young", "poisson", "first_crack")]
                words = [
                    f"{a / unit:8.4g} ({b / unit:.4g}, {a / b - 1.0:+.2%})"
                    for (a, b), unit in zip(pairs, (1e9, 1.0, 1e6), strict=True)
                ]
                print(f"{folder.name} {row['run']}: " + "  ".join(words), flush=True)
