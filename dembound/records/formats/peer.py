"""AT2, VT2 and DT2 files of the PEER databases: four lines of header, then the values of one component."""

import re
from collections.abc import Sequence

from dembound.records.channel import Record
from dembound.records.formats.format import Format
from dembound.records.formats.source import COUNT, DECIMAL, Source

UNITS = re.compile(
    r"\s*(accel|veloc|displ)\w*\s+time\s+(?:series|history)\s+in\s+units\s+of\s+([^\s.,;]+)", re.IGNORECASE
)
SAMPLES = (rf"NPTS\s*=\s*{COUNT}\b.*?DT\s*=\s*({DECIMAL})", rf"^\s*{COUNT}\s+({DECIMAL})\s")
"""As "NPTS=  5000, DT=   .0050 SEC", and before 2006 "5000  .0050  NPTS, DT"."""


class Peer(Format):
    """Second line: event, station and component; third line: quantity and unit; fourth line: number and time step."""

    name = "PEER AT2/VT2/DT2"

    def recognises(self, lines: Sequence[str]) -> bool:
        """Whether the third line has a quantity and its unit."""
        return len(lines) > 2 and UNITS.match(lines[2]) is not None

    def read(self, source: Source) -> Record:
        """The component of the file."""
        stated = UNITS.match(source.lines[2])
        assert stated is not None
        found = source.found("|".join(SAMPLES), 3, 4, "NPTS and DT")
        count, step = (text for text in found.groups() if text is not None)
        title = source.lines[1].strip()
        unit = source.measured(stated[2])
        channel = source.channel(title.rpartition(",")[2].strip(), unit, source.free(4, int(count)), float(step))
        return Record(f"PEER {stated[1][0].upper()}T2", title, (channel,))
