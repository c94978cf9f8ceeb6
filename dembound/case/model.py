"""The case itself: all tables of one file, as far as every kind of body has them."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeVar

from dembound.boundaries import Boundary, Free, Motion
from dembound.case.output import Output
from dembound.case.run import Run
from dembound.errors import CaseError
from dembound.waves import Wave


@dataclass(frozen=True, kw_only=True)
class Case:
    """One validated case file. Build it with `kinds.load` or `kinds.loads`, which check what it cannot.

    Attributes
    ----------
    title : one line for pictures and reports; may be empty.
    boundary : side -> table, in the order left, right, bottom, top; an absent side is free.
    wave : name -> table.
    load, monitor : in the order of the file.
    run, output : the tables of these names.
    name : the file's name without folder and ending.
    text : the TOML text the case was read from.
    folder : where relative paths in the case start.

    Two cases are equal when their tables are; name, text and folder do not count.
    """

    title: str
    boundary: Mapping[str, Boundary]
    wave: Mapping[str, Wave]
    load: tuple[Any, ...]
    monitor: tuple[Any, ...]
    run: Run
    output: Output
    name: str = field(compare=False)
    text: str = field(compare=False, repr=False)
    folder: Path = field(compare=False)

    def side(self, name: str) -> Boundary:
        """The table of a side; one that is absent is free."""
        return self.boundary.get(name, FREE)

    @property
    def driving(self) -> dict[str, dict[Motion, str]]:
        """The waves that drive sides: side -> kind of wave -> name."""
        return {side: dict(table.waves) for side, table in self.boundary.items() if table.waves}


FREE = Free()

K = TypeVar("K", bound=Case)


def as_kind(case: Case, kind: type[K], otherwise: str) -> K:
    """The case, if it is of a kind; else raises CaseError with the message `otherwise`."""
    if not isinstance(case, kind):
        raise CaseError([otherwise], case.name)
    return case
