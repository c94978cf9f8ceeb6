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
from dembound.records.formats.csmip import Csmip
from dembound.records.formats.format import Format
from dembound.records.formats.knet import Knet
from dembound.records.formats.peer import Peer
from dembound.records.formats.smc import Smc
from dembound.records.formats.source import MOTIONS, USUAL, Flaw, Source
from dembound.records.formats.text_columns import TextColumns
from dembound.table import with_registered
from dembound.waves.unit_names import unit_named

TYPES: tuple[type[Format], ...] = (Peer, Csmip, Cosmos, Knet, Smc)
REGISTERED: tuple[type[Format], ...] = with_registered("dembound.records", Format, TYPES)
FORMATS: list[Format] = [*(form() for form in REGISTERED), TextColumns()]
"""All formats; the last one is tried on files that no other one recognises."""


def read_record(path: Path, unit: str | None = None) -> Record:
    """Read a file of ground motion, whose content, not its name, gives the format.

    Parameters
    ----------
    path : the file.
    unit : of the values, in place of the unit of the same quantity in the header or where the header has none.

    Raises CaseError, in one line, for a file that cannot be read, is of no known format, or is damaged.
    """
    given = None if unit is None else unit_named(unit)
    if unit is not None and (given is None or given.quantity not in MOTIONS):
        raise CaseError([f"--unit: is {unit}, must be one of {USUAL}"])
    source = Source(path, re.split(r"\r\n|\n|\r", decoded(content_of(path)).rstrip("\x1a\r\n\t ")), unit)
    form = next(form for form in FORMATS if form.recognises(source.lines))
    try:
        record = form.read(source)
    except Flaw as flaw:
        raise CaseError([f'"{path}", read as {form.name}: {flaw}']) from None
    except CaseError as error:
        known = ", ".join(known.name for known in FORMATS)
        raise CaseError([f"{error.problems[0]}; known formats: {known}"]) from None
    return replace(record, remarks=(*record.remarks, *dict.fromkeys(source.remarks)))
