"""The ``[output]`` table."""

from typing import Literal

from dembound.table import Table, quantity

MOST_SNAPSHOTS = 10_000
"""Largest number of snapshots: they make a movie of minutes, and each is a file for ParaView.

Most commands go through all snapshots of a record, which takes 1 ms each and more.
"""

ParaView = Literal["vtu", "vtkhdf", "both", "none"]
"""Formats of snapshots for ParaView: a VTU file each with a PVD file of their times, one VTKHDF file, both, or none."""


class Output(Table):
    """What a run records and writes."""

    history_interval: float = quantity(
        0.0, unit="s", help="time between two samples of the histories; 0: every step", ge=0.0
    )
    side_interval: float = quantity(
        0.0,
        unit="s",
        help="time between two samples of the sides; 0: every eighth step, or history_interval if that is longer",
        ge=0.0,
    )
    energy_interval: float = quantity(
        0.0, unit="s", help="time between two entries of the energy ledger; 0: a hundred over the run", ge=0.0
    )
    snapshots: int = quantity(
        1,
        unit="1",
        means="count",
        help="number of whole-scene snapshots, evenly spaced, the last at the end; [static] adds one at rest; 0: none",
        ge=0,
        le=MOST_SNAPSHOTS,
    )
    stress: bool = quantity(False, unit="1", help="whether snapshots hold the stress of every particle")
    contacts: bool = quantity(False, unit="1", help="whether snapshots hold the forces of every contact and bond")
    paraview: ParaView = quantity(
        "vtu",
        unit="1",
        help='snapshots for ParaView: "vtu", a file for each; "vtkhdf", one file of all; "both"; "none"',
    )
    peaks: bool = quantity(False, unit="1", help="whether the largest speed of every particle in the run is kept")
    load_factor: bool = quantity(
        False, unit="1", help="whether the factor of the waves is found up to which the elastic law of disks holds"
    )
    estimate: bool = quantity(False, unit="1", help="whether the errors of the run are estimated when it is over")
    pictures: bool = quantity(True, unit="1", help="whether pictures are drawn when the run is over")
