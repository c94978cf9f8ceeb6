"""Soil on rock under a measured record: velocities and response spectra of the surface beside the exact column.

The ground of DEEPSOIL's example 2a, 20 m of 500 m/s and 20 kN/m³ on rock of 760 m/s and 25 kN/m³, undamped, one disk
wide between periodic sides, under component 90 of the record CLC as outcrop. The exact motion is that of layers on a
half-space (dembound/exact/column.py) between the planes where the mass of the half cells begins and ends.

    python benchmarks/soil_on_rock.py
"""

import argparse
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import tomli_w

from dembound.api import run
from dembound.disks.entry import mass_begins
from dembound.disks.scene import build
from dembound.disks.within import Level
from dembound.exact.column import Column, Layer
from dembound.kinds import loads
from dembound.spectra.response import response_spectrum, slope

GRAVITY = 9.81
SOIL, ROCK = 20e3 / GRAVITY, 25e3 / GRAVITY
RECORD = Path(__file__).parents[1] / "cases" / "records" / "clc_90.csv"
PERIODS = np.geomspace(0.1, 5.0, 60)
"""Periods of response spectra, s."""


def column(diameter: float) -> str:
    """The case of a column of disks of a diameter (m)."""
    rock = {"density": ROCK, "p_wave_speed": 1500.0, "s_wave_speed": 760.0}
    tables = {
        "packing": {"pattern": "A", "radius": 0.5 * diameter, "size": [diameter, 20.0]},
        "material": {"density": SOIL, "p_wave_speed": 500.0 * 2.0**0.5, "fric": 0.5},
        "boundary": {
            "left": {"type": "periodic"},
            "right": {"type": "periodic"},
            "bottom": {"type": "viscous_input", "half_mass": True, "rock": rock, "wave_s": "record"},
        },
        "wave": {"record": {"type": "file", "path": str(RECORD), "motion": "outcrop"}},
        "monitor": [{"name": "surface", "position": [0.5 * diameter, 20.0 - 0.5 * diameter]}],
        "run": {"duration": 61.0},
        "output": {"snapshots": 0, "pictures": False},
    }
    return tomli_w.dumps(tables)


def errors(diameter: float, folder: Path) -> tuple[float, float]:
    """RMS error of the velocity of the surface over its RMS, and largest relative error of its response spectrum."""
    case = loads(column(diameter))
    scene = build(case)
    ground = Level.of(scene, "bottom", "s")
    history = run(case, folder / f"{diameter:g}").histories["surface"]
    time, found = history["time"], history["velocity"][:, 0]
    step = float(time[1] - time[0])
    depth = 0.5 * diameter - mass_begins(scene, "top")
    exact = Column([Layer(ground.height, SOIL, ground.speed), Layer(1.0, ROCK, 760.0)]).history(
        case.wave["record"].velocity(time), step, depth
    )
    every = max(1, int(PERIODS[0] / (32.0 * step)))
    spectra = [
        response_spectrum(slope(each[::every], every * step), every * step, PERIODS).pseudo_acceleration
        for each in (found, exact)
    ]
    rms = float(np.linalg.norm(found - exact) / np.linalg.norm(exact))
    return rms, float(np.abs(spectra[0] / spectra[1] - 1.0).max())


def main() -> None:
    """Print the table."""
    argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter, prog="benchmarks/soil_on_rock.py"
    ).parse_args()
    print("disks (m)  velocity, RMS (%)  response spectrum from 0.1 s on, largest (%)")
    with TemporaryDirectory() as folder:
        for diameter in (1.0, 0.5, 0.25):
            rms, largest = errors(diameter, Path(folder))
            print(f"{diameter:9g}  {100.0 * rms:17.3g}  {100.0 * largest:.3g}")


if __name__ == "__main__":
    main()
