"""Soil on rock under a measured record: velocities and response spectra of the surface beside exact columns.

The ground of DEEPSOIL's examples 2a (undamped) and 4 (damping ratios of 5 and 2 %): 20 m of 500 m/s and 20 kN/m³ on
rock of 760 m/s and 25 kN/m³, one disk wide between periodic sides, under component 90 of the record CLC as outcrop.
Exact motions are those of layers on a half-space (dembound/exact/column.py) between the planes where the mass of the
half cells begins and ends: of the modulus of the run, and of ρc²(1 + 2iξ), as equivalent-linear programs have it. The
rock of the run is a dashpot, undamped.

    python benchmarks/soil_on_rock.py
"""

import argparse
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np
import tomli_w
from timing import small_option

from dembound.api import run
from dembound.casefile.disks import DiskCase
from dembound.disks.scene import build
from dembound.exact.column import Column, Layer
from dembound.formulas.disks.entry import mass_begins
from dembound.kinds import loads
from dembound.kinds.disks.incident_wave import Level
from dembound.spectra import response_spectrum, slope

GRAVITY = 9.81
SOIL, ROCK = 20e3 / GRAVITY, 25e3 / GRAVITY
SOIL_DAMPING, ROCK_DAMPING = 0.05, 0.02
"""Damping ratios ξ of example 4."""

BAND, FREQUENCY = [0.3, 30.0], 6.25
"""Band of constant Q, and frequency at which speeds hold, the soil's first resonance, Hz."""

RECORD = Path(__file__).parents[1] / "cases" / "records" / "clc_90.csv"
PERIODS = np.geomspace(0.05, 5.0, 80)
"""Periods of response spectra, s."""


class Errors(NamedTuple):
    """RMS error of the velocity over its RMS, and largest relative error of the response spectrum from 0.05 s on.

    Beside a column with the modulus of the run, and beside the hysteretic one.
    """

    velocity: float
    spectrum: float
    hysteretic_velocity: float
    hysteretic_spectrum: float


def column(diameter: float, damped: bool, duration: float) -> str:
    """The case of a column of disks of a diameter (m), run for a duration (s)."""
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
        "run": {"duration": duration},
        "output": {"snapshots": 0, "pictures": False},
    }
    if damped:
        tables["material"]["quality_factor"] = 0.5 / SOIL_DAMPING
        tables["damping"] = {"band": BAND, "frequency": FREQUENCY, "mechanisms": 4}
    return tomli_w.dumps(tables)


def errors(case: DiskCase, time: np.ndarray, found: np.ndarray) -> Errors:
    """Of the velocity (n,) m/s of the uppermost disk at times (n,) s."""
    scene, step = build(case), float(time[1] - time[0])
    ground = Level.of(scene, "bottom", "s")
    damped = ground.is_damped
    (soil,) = ground.layers
    rock = Layer(1.0, ROCK, 760.0, 0.5 / ROCK_DAMPING)
    depth = case.packing.radius - mass_begins(scene, "top")
    incident = case.wave["record"].velocity(time)
    same, hysteretic = (
        each.history(incident, step, depth)
        for each in (
            Column([soil, rock]),
            Column([Layer(soil.thickness, SOIL, 500.0, soil.quality), rock], "hysteretic" if damped else "elastic"),
        )
    )
    every = max(1, int(PERIODS[0] / (32.0 * step)))
    spectrum, *exact = (
        response_spectrum(slope(each[::every], every * step), every * step, PERIODS).pseudo_acceleration
        for each in (found, same, hysteretic)
    )
    parts = [
        (float(np.linalg.norm(found - each) / np.linalg.norm(each)), float(np.abs(spectrum / other - 1.0).max()))
        for each, other in zip((same, hysteretic), exact, strict=True)
    ]
    return Errors(*parts[0], *parts[1])


def errors_of(diameter: float, damped: bool, folder: Path, duration: float = 61.0) -> Errors:
    """Of a run with disks of a diameter (m), by default under the whole record; duration : s."""
    case = loads(column(diameter, damped, duration))
    history = run(case, folder / f"{diameter:g}_{damped}").histories["surface"]
    return errors(case, history["time"], history["velocity"][:, 0])


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    small_option(parser)
    options = parser.parse_args()
    print("                    same modulus (%)       hysteretic (%)")
    print("ground    disks (m)  velocity  spectrum    velocity  spectrum")
    with TemporaryDirectory() as folder:
        for damped in (False, True):
            for diameter in (1.0, 0.5, 0.25)[: 1 if options.small else None]:
                found = [100.0 * each for each in errors_of(diameter, damped, Path(folder))]
                print(
                    f"{'damped' if damped else 'undamped':8}  {diameter:9g}  {found[0]:8.3g}  {found[1]:8.3g}"
                    f"    {found[2]:8.3g}  {found[3]:8.3g}"
                )


if __name__ == "__main__":
    main()
