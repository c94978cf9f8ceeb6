"""The tables in the case file of one kind of body."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from pydantic import TypeAdapter

from dembound.boundaries import SIDES
from dembound.casefile.model import Case
from dembound.casefile.types import WaveTable

Tables = Mapping[str, Any]
"""The tables of a case by name; one that is invalid is None."""

WAVE: TypeAdapter[Any] = TypeAdapter(WaveTable)


@dataclass(frozen=True)
class Schema:
    """The tables of one kind of case, by the names of its fields.

    Attributes
    ----------
    case : the class of such cases.
    noun : "disks" or the like, for messages.
    new : the command that writes such a case.
    marks : tables of which a file of this kind has at least one, and a file of a kind named later has none.
    tables : those that occur once.
    side : type of [boundary.SIDE]; sides : the names of the sides.
    lists : those that may occur any number of times.
    problems : finds mistakes between tables, from the tables and the file's data. optional : those that may be absent.
    staged : those that may be absent and have their own sides: the table, and the type of its boundary.SIDE.
    completed : the tables of a file with keys that follow from other tables, and what these lack for that. completing :
    by table, the list from whose entries they follow where each gives them.
    """

    case: type[Case]
    noun: str
    new: str
    marks: tuple[str, ...]
    tables: Mapping[str, TypeAdapter[Any]]
    side: TypeAdapter[Any]
    lists: Mapping[str, TypeAdapter[Any]]
    problems: Callable[[Tables, Mapping[str, Any]], Iterator[str]]
    sides: tuple[str, ...] = SIDES
    optional: Mapping[str, TypeAdapter[Any]] = field(default_factory=dict)
    staged: Mapping[str, tuple[TypeAdapter[Any], TypeAdapter[Any]]] = field(default_factory=dict)
    completed: Callable[[Tables], tuple[Tables, list[str]]] = lambda data: (data, [])
    completing: Mapping[str, str] = field(default_factory=dict)

    @property
    def keys(self) -> list[str]:
        """All keys allowed at the top level of a file, in the order of messages."""
        last = ("run", "output", "chart", "sweep")
        first = [key for key in self.tables if key not in last]
        return ["title", *first, "boundary", *self.staged, *self.optional, "wave", *self.lists, *last]
