"""SAC and MiniSEED files, by ObsPy where it is installed: their values have no unit that can be relied on."""

import io
import warnings
from collections.abc import Sequence

from dembound.records.channel import Record
from dembound.records.formats.numbers import Flaw, Unknown, number_of
from dembound.records.formats.source import USUAL, Source

FORMATS = ("MSEED", "SAC", "SACXY")
"""Names of the formats in ObsPy; the last one is SAC in numbers."""

UNDEFINED = "-12345"
"""Of header variables of SAC that are not set."""


def is_sac_in_numbers(lines: Sequence[str]) -> bool:
    """Whether lines begin with a header of SAC in numbers: five in a line, some of them not set."""
    first = lines[0].split()
    return len(first) == 5 and None not in map(number_of, first) and any(UNDEFINED in line for line in lines[:14])


def read_binary(content: bytes, source: Source) -> Record:
    """The channels of a file that is no text.

    source : whose unit must be given, as SAC does not state any and MiniSEED has counts. Raises Flaw without ObsPy, for
    files of other formats, and for channels with gaps.
    """
    try:
        from obspy import read
    except ImportError:
        raise Flaw("is no text; SAC and MiniSEED need ObsPy: install dembound[seismology]") from None
    for form in FORMATS:
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                stream = read(io.BytesIO(content), format=form).merge(method=-1)
            break
        except Exception:  # of any kind, by damaged files
            continue
    else:
        raise Unknown("is neither text nor SAC nor MiniSEED")
    if source.given.unit is None:
        raise Flaw(f"states no unit of the values; give it by --unit: {USUAL}; counts must be converted before")
    names = [trace.stats.channel for trace in stream]
    if split := next((name for name in names if names.count(name) > 1), None):
        raise Flaw(f"has gaps in channel {split}; keep the samples before or behind them alone")
    channels = [
        source.channel(name, source.measured(""), trace.data.astype(float), float(trace.stats.delta))
        for name, trace in zip(names, stream, strict=True)
    ]
    first = stream[0].stats
    return Record({"MSEED": "MiniSEED"}.get(form, form), f"{stream[0].id}, {first.starttime}", tuple(channels))
