"""The case of a record: everything that is needed to run it again."""

import tomllib
from pathlib import Path

import tomli_w

from dembound.casefile import Case
from dembound.errors import CaseError
from dembound.kinds import loads
from dembound.results.reader import open_record, text_of


def recorded_case(record: Path) -> Case:
    """The case of a record, with the files that it refers to, all read from the record.

    A settled state of another run (``static.from``) is not used, as it is not in the record; the body settles itself,
    with the same result.

    Raises CaseError if there is no record with a case.
    """
    with open_record(record) as file:
        if "case" not in file.attrs or "inputs" not in file:
            raise CaseError([f"{record}: has no case that could be run again"])
        text, name = text_of(file.attrs["case"]), text_of(file.attrs["name"])
        files = {text_of(given.attrs["path"]): given[()].tobytes().decode() for given in file["inputs"].values()}
    data = tomllib.loads(text)
    if data.get("static", {}).pop("from", None) is not None:
        text = tomli_w.dumps(data)
    return loads(text, name=name, files=files)


def recorded_beginning(record: Path) -> float | None:
    """The duration (s) for which the run of a record was begun, if it was continued to another time; else None."""
    with open_record(record) as file:
        if "regular_steps" not in file.attrs:
            return None
        return float(file.attrs["regular_steps"] * file.attrs["time_step"])
