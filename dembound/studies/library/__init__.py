"""Responses of a linear scene to small inputs, from whose sums follow its histories under any record.

The motion of disks under the elastic law is linear in the inputs from outside. A record of velocities x_k at times kΔ,
joined by straight lines, is the sum of triangles x_k·hat(t − kΔ), so its histories are

    u(t) = u_rest(t) + Σ_k x_k h(t − kΔ),

with the response h to one triangle, from one run, and the motion u_rest without waves, under steady loads. Where Δ is a
whole number of time steps this is no approximation: a direct run differs by rounding. A band-limited record is such a
sum if Δ is that of its points, 1/16 of its samples', or a whole fraction of it; a larger Δ keeps sinc²(fΔ) of it.
"""

from dembound.studies.library.build import build_library
from dembound.studies.library.library import Library, Record, RecordTimes, read_records
from dembound.studies.library.response import (
    LoadFactor,
    case_of,
    load_factor,
    record_warnings,
    watched_contacts,
    write_response,
)

__all__ = [
    "Library",
    "LoadFactor",
    "Record",
    "RecordTimes",
    "build_library",
    "case_of",
    "load_factor",
    "read_records",
    "record_warnings",
    "watched_contacts",
    "write_response",
]
