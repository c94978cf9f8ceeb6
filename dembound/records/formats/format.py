"""The base of every format of files of ground motion."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import ClassVar

from dembound.records.channel import Record
from dembound.records.formats.source import Source


class Format(ABC):
    """A format of text files; derived ones are registered under the entry point group "dembound.records"."""

    name: ClassVar[str]
    """As messages print it, with its versions."""

    @abstractmethod
    def recognises(self, lines: Sequence[str]) -> bool:
        """Whether the lines of a file, at least one, begin as those of this format."""

    @abstractmethod
    def read(self, source: Source) -> Record:
        """The channels of a file that is recognised; raises `Flaw` for what cannot be read."""
