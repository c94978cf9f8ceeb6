"""Formats of files of ground motion, one module each, and the function that reads a file of any of them.

Another package registers its formats, derived from `Format`, under the entry point group "dembound.records".
"""

import re
from dataclasses import replace
from pathlib import Path

from dembound.errors import CaseError
from dembound.gauge.reading.scope import content_of, decoded
from dembound.records.channel import Record
from dembound.records.formats.cosmos import Cosmos
from dembound.records.formats.geonet import Geonet
from dembound.records.formats.networks import Cwb, Esm, Knet, Nsmn, Unam
from dembound.records.formats.numbers import MOTIONS, Flaw, Unknown
from dembound.records.formats.peer import Peer
from dembound.records.formats.seismic import is_sac_in_numbers, read_binary
from dembound.records.formats.smc import Smc
from dembound.records.formats.source import USUAL, Format, Reading, Source
from dembound.records.formats.text_columns import TextColumns
from dembound.records.formats.volumes import Volumes
from dembound.table import with_registered
from dembound.waves.unit_names import unit_named

TYPES: tuple[type[Format], ...] = (Geonet, Volumes, Cosmos, Knet, Smc, Esm, Cwb, Nsmn, Unam, Peer)
REGISTERED: tuple[type[Format], ...] = with_registered("dembound.records", Format, TYPES)
FORMATS: list[Format] = [*(form() for form in REGISTERED), TextColumns()]
"""All formats; the last one is tried on files that no other one recognises."""


def read_record(path: Path, given: Reading = Reading()) -> Record:  # noqa: B008  # frozen
    """Read a file of ground motion, whose content, not its name, gives the format.

    Parameters
    ----------
    path : the file.
    given : what is known beside its header.

    Raises CaseError, in one line, for a file that cannot be read, is of no known format, is damaged, may be read in
    two ways, or contradicts its header.
    """
    named = None if given.unit is None else unit_named(given.unit)
    if given.unit is not None and (named is None or named.quantity not in MOTIONS):
        raise CaseError([f"--unit: is {given.unit}, must be one of {USUAL}"])
    content = content_of(path)
    text = decoded(content).rstrip("\0\x1a\r\n\t ")
    lines = re.split(r"\r*\n|\r", text)
    source = Source(path, lines, given)
    form = FORMATS[-1] if given.is_of_text else next(form for form in FORMATS if form.recognises(source.lines))
    seismic = "\0" in text or (is_sac_in_numbers(lines) and not given.is_of_text)
    name = "SAC or MiniSEED" if seismic else form.name
    try:
        record = read_binary(content, source) if seismic else form.read(source)
        if given.unit is not None and len(source.quantities) > 1:
            raise Flaw(f"--unit: is {given.unit}, but the channels are different quantities; leave it out")
    except Flaw as flaw:
        known = f"; known formats: {', '.join(known.name for known in FORMATS)}" if isinstance(flaw, Unknown) else ""
        raise CaseError([f'"{path}", read as {name}: {flaw}{known}']) from None
    return replace(record, remarks=(*record.remarks, *dict.fromkeys(source.remarks)), chosen=tuple(source.chosen))
