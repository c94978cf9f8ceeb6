"""The histories of a specimen as a table (CSV)."""

from pathlib import Path

import numpy as np

from dembound.files import replacing
from dembound.gauge.hopkinson.specimen import Specimen

HEAD = (
    "time (s),stress 3 waves (Pa),stress 2 waves (Pa),stress 1 wave (Pa),strain 3 waves,strain 1 wave,"
    "strain rate 3 waves (1/s),strain rate 1 wave (1/s),front over back force,in equilibrium"
)
"""Names of the columns."""


def write_specimen(found: Specimen, path: Path) -> None:
    """Write one line per sample; the last column is 1 in equilibrium."""
    columns = (
        found.time,
        found.stress,
        found.front,
        found.back,
        found.strain,
        found.one_wave_strain,
        found.rate,
        found.one_wave_rate,
        found.ratio,
        found.in_equilibrium.astype(float),
    )
    with replacing(path) as file:
        np.savetxt(file, np.column_stack(columns), delimiter=",", header=HEAD, comments="", fmt="%.9g")
