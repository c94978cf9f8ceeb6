"""Mappings by the names of what results have, which answer other names with those there are."""

from collections.abc import Collection, Iterable, Mapping
from typing import SupportsIndex, TypeVar, overload

from dembound.casefile.messages import choices, show
from dembound.errors import NameMissingError, NumberMissingError

T = TypeVar("T")


class Named(dict[str, T]):
    """Values by the names of monitors or sides; another name raises NameMissingError, with those there are.

    what : they are names of; where : the file they are in.
    """

    def __init__(self, values: Mapping[str, T], what: str, where: str = "") -> None:
        super().__init__(values)
        self._what, self._where = what, where

    def __missing__(self, name: str) -> T:
        raise missing(self._what, name, self, self._where)


class Numbered(list[T]):
    """Values by their numbers; another number raises NumberMissingError, an IndexError, with those there are.

    what : they are; where : the file they are in.
    """

    def __init__(self, values: Iterable[T], what: str, where: str = "") -> None:
        super().__init__(values)
        self._what, self._where = what, where

    @overload
    def __getitem__(self, number: SupportsIndex) -> T: ...
    @overload
    def __getitem__(self, number: slice) -> list[T]: ...
    def __getitem__(self, number: SupportsIndex | slice) -> T | list[T]:
        try:
            return super().__getitem__(number)
        except IndexError:
            there = f"they are 0 to {len(self) - 1}" if self else "there are none"
            raise NumberMissingError([f"{self._what}: there is no {number}, {there}"], self._where) from None


def missing(what: str, name: str, known: Collection[str], where: str = "") -> NameMissingError:
    """The error for a name that is not among those known."""
    there = f"must be one of {choices(str(name), list(known))}" if known else "there are none"
    return NameMissingError([f"{what}: is {show(name)}, {there}"], where)
