"""Mappings by names of monitors or sides, whose errors for other names list the existing ones."""

from collections.abc import Collection, Mapping
from typing import TypeVar

from dembound.casefile.messages import choices, show
from dembound.errors import NameMissingError

T = TypeVar("T")


class Named(dict[str, T]):
    """Values by the names of monitors or sides; another name raises NameMissingError with the existing names.

    what : they are names of; where : the file they are in.
    """

    def __init__(self, values: Mapping[str, T], what: str, where: str = "") -> None:
        super().__init__(values)
        self._what, self._where = what, where

    def __missing__(self, name: str) -> T:
        raise missing(self._what, name, self, self._where)


def missing(what: str, name: str, known: Collection[str], where: str = "") -> NameMissingError:
    """The error for an unknown name."""
    there = f"must be one of {choices(str(name), list(known))}" if known else "there are none"
    return NameMissingError([f"{what}: is {show(name)}, {there}"], where)
